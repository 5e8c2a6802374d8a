"""The Bode plot of axis and loop, with two handles: crossover and phase margin, by mouse and by keys.

Import it late: pyqtgraph takes longer to load than the first window may take to open.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
import pyqtgraph
from PySide6.QtCore import QEvent, Qt, Signal
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QVBoxLayout, QWidget

from device.tuning.loop import Bode
from widgets.parts.look import look
from widgets.parts.pieces import Pieces
from widgets.parts.plot import Plot
from widgets.tuner.plots import stroke

HERTZ = 2 * math.pi  # rad/s
HERTZ_TICKS = [digit * 10.0**decade for decade in range(-2, 4) for digit in (1, 2, 5)]
KEY_RATIO, KEY_DEGREES = 1.02, 1.0  # of one arrow key
LEAST_PHASE, MOST_PHASE = 5.0, 85.0  # degrees that can be asked for
LOWEST_PHASE = -270.0  # degrees; what lies below says nothing and takes the room of the handle
GRIP = 13.0  # px of the grip on a handle


class Handle(pyqtgraph.InfiniteLine):  # type: ignore[misc]
    """A line to drag, with a grip and its value beside it."""

    def __init__(self, upright: bool) -> None:
        super().__init__(
            angle=90 if upright else 0, movable=True, label=" ",
            labelOpts={"position": 0.9 if upright else 0.06, "movable": False},
        )  # fmt: skip
        self.addMarker("o", 0.5, GRIP)
        self.setCursor(Qt.CursorShape.SizeHorCursor if upright else Qt.CursorShape.SizeVerCursor)
        self.dress()

    def dress(self) -> None:
        """In the colours of now."""
        now = look()
        self.setPen(stroke(now.colour("accent"), False, 1.6))
        self.setHoverPen(stroke(now.colour("accent"), False, 3.0))
        self.label.setColor(now.colour("surface"))
        self.label.fill = pyqtgraph.mkBrush(now.colour("accent"))
        self.label.setFont(now.small_font())
        self.label.update()

    def put(self, place: float) -> None:
        """Where it stands from now on, without telling anybody."""
        self.blockSignals(True)
        self.setValue(place)
        self.blockSignals(False)

    def tell(self, words: str) -> None:
        """What stands beside it."""
        self.label.setFormat(words)
        self.label.updatePosition()


class BodePart(Plot):
    """One of the two diagrams: Ctrl with arrows moves a handle, with Shift ten times as far."""

    moved = Signal(int, int)  # steps of the crossover, steps of the margin

    def keyPressEvent(self, event: QKeyEvent) -> None:
        held, key = event.modifiers(), Qt.Key(event.key())
        aside = {Qt.Key.Key_Left: -1, Qt.Key.Key_Right: 1}.get(key, 0)
        up = {Qt.Key.Key_Down: -1, Qt.Key.Key_Up: 1}.get(key, 0)
        if held & Qt.KeyboardModifier.ControlModifier and (aside or up):
            far = 10 if held & Qt.KeyboardModifier.ShiftModifier else 1
            self.moved.emit(aside * far, up * far)
            return
        super().keyPressEvent(event)


class BodePlot(QWidget):
    """Gain and phase of axis and loop; the upright line is the crossover, the level one the phase margin."""

    target_wanted = Signal(float, float)  # crossover in rad/s, phase margin in degrees

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self._shown: Bode | None = None
        self._crossover, self._margin = 0.0, 0.0
        self._followed: list[tuple[BodePart, list[bool]]] = []  # what follows its curves again after a drag
        self.making = Pieces(self._pieces())

    def _pieces(self) -> Iterator[None]:
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        self.gain = BodePart("Bode plot, gain", parent=self)
        column.addWidget(self.gain, 1)
        yield
        self.phase = BodePart("Bode plot, phase", parent=self)
        column.addWidget(self.phase, 1)
        self.phase.setXLink(self.gain)
        yield
        for plot in (self.gain, self.phase):
            plot.setLogMode(x=True, y=False)
            plot.getAxis("bottom").setTicks([[(math.log10(each), f"{each:g}") for each in HERTZ_TICKS]])
            plot.moved.connect(self._by_key)
            plot.setAccessibleDescription(
                "Ctrl with left and right moves the crossover, with up and down the phase margin; Shift: ten times."
            )
        self._make_curves()
        yield
        self._make_handles()
        yield
        self.dress()
        self._draw()

    def show_bode(self, bode: Bode | None) -> None:
        """Another loop, or none."""
        first, self._shown = self._shown is None and bode is not None, bode
        self._draw()
        if first:
            self.gain.fit()
            self.phase.fit()

    def show_target(self, crossover: float, phase: float) -> None:
        """Where the handles stand: rad/s and degrees."""
        self._crossover, self._margin = crossover, phase
        for line in (self.crossover, self.below):
            line.put(math.log10(max(crossover, 1e-6) / HERTZ))
        self.margin.put(phase - 180.0)
        self._tell()

    @property
    def _asked(self) -> tuple[float, float]:
        """Where the handles stand now."""
        return 10 ** float(self.crossover.value()) * HERTZ, float(self.margin.value()) + 180.0

    def _tell(self) -> None:
        crossover, phase = self._asked
        self.crossover.tell(f"{crossover / HERTZ:.3g} Hz")
        self.margin.tell(f"{phase:.0f}°")

    def _along(self, moved: Handle, other: Handle) -> None:
        """The crossover is one line in two diagrams."""
        if other.value() != moved.value():
            other.put(float(moved.value()))
        self._tell()

    def _hold(self) -> None:
        """While a handle is dragged the scales stand still: it would run away from the mouse."""
        if not self._followed:
            self._followed = [(plot, plot.getViewBox().autoRangeEnabled()) for plot in (self.gain, self.phase)]
            for plot, _ in self._followed:
                plot.getViewBox().disableAutoRange()

    # ---- drawn

    def _make_curves(self) -> None:
        """Everything once; what changes are the values, which is quicker than drawing anew."""
        self.gain.addLegend(offset=(-8, 8))
        self.curves = {
            name: (self.gain.plot(name=name), self.phase.plot()) for name in ("Axis", "Loop")
        }  # gain and phase of each
        self.gain.name_sides("", "Gain, dB")
        self.phase.name_sides("Frequency, Hz", "Phase, °")

    def _make_handles(self) -> None:
        self._levels = [pyqtgraph.InfiniteLine(pos=level, angle=0) for level in (0.0, -180.0)]
        self.gain.addItem(self._levels[0])
        self.phase.addItem(self._levels[1])
        room = pyqtgraph.InfiniteLine(pos=MOST_PHASE - 180.0, angle=0, pen=pyqtgraph.mkPen(None))  # for the handle
        self.phase.addItem(room)
        self.crossover, self.below, self.margin = Handle(True), Handle(True), Handle(False)
        self.below.label.setVisible(False)  # its value stands beside the upper one
        self.margin.setBounds((LEAST_PHASE - 180.0, MOST_PHASE - 180.0))
        self.gain.addItem(self.crossover)
        for handle in (self.below, self.margin):
            self.phase.addItem(handle)
        for line, other in ((self.crossover, self.below), (self.below, self.crossover)):
            line.sigPositionChanged.connect(lambda moved, other=other: self._along(moved, other))
        self.margin.sigPositionChanged.connect(lambda _: self._tell())
        for line in (self.crossover, self.below, self.margin):
            line.sigDragged.connect(lambda _: self._hold())
            line.sigPositionChangeFinished.connect(self._dragged)

    def dress(self) -> None:
        """In the colours of now."""
        now = look()
        for name, token, width in (("Axis", "quiet", 1.4), ("Loop", "axis_x", 2.2)):
            for curve in self.curves[name]:
                curve.setPen(stroke(now.colour(token), False, width))
        for level in self._levels:
            level.setPen(stroke(now.colour("border"), True, 1.0))
        for line in (self.crossover, self.below, self.margin):
            line.dress()
        legend = self.gain.getPlotItem().legend
        legend.setLabelTextColor(now.colour("text"))
        legend.setLabelTextSize(f"{now.fonts['small_points']:g}pt")
        for _, label in legend.items:
            label.setText(label.text)

    def _draw(self) -> None:
        for line in (self.crossover, self.below, self.margin):
            line.setVisible(self._shown is not None)
        if self._shown is None:
            for curve in (*self.curves["Axis"], *self.curves["Loop"]):
                curve.setData([], [])
            self.gain.setRange(xRange=(0.0, 2.7), yRange=(-60.0, 60.0))  # an empty plot has numbers, too
            self.phase.setRange(yRange=(LOWEST_PHASE, -90.0))
            return
        bode = self._shown
        seen = self._seen(bode)
        hertz = bode.frequency[seen] / HERTZ
        for values, name in ((bode.plant, "Axis"), (bode.loop, "Loop")):
            gain, phase = self.curves[name]
            gain.setData(hertz, 20 * np.log10(np.abs(values[seen]) + 1e-12))
            angle = _phase(values)[seen]
            phase.setData(hertz, np.where(angle < LOWEST_PHASE, np.nan, angle), connect="finite")
        for line in (self.crossover, self.below):
            line.setBounds((math.log10(hertz[0]), math.log10(hertz[-1])))
        self._tell()  # what is not seen is not told its value

    def _seen(self, bode: Bode) -> slice:
        """The part that matters: two decades around the crossover, up to where the sampling ends it."""
        middle = self._crossover or float(bode.frequency[len(bode.frequency) // 2])
        low, high = np.searchsorted(bode.frequency, (middle / 30.0, min(middle * 30.0, bode.frequency[-1] * 0.97)))
        return slice(int(low), max(int(high), int(low) + 2))

    # ---- moved by the person

    def _dragged(self, *_: Any) -> None:
        """Let go of a handle: the gains follow, and so do the scales."""
        for plot, (aside, up) in self._followed:
            plot.getViewBox().enableAutoRange(x=aside, y=up)
        self._followed = []
        if self._asked != (self._crossover, self._margin):
            self._crossover, self._margin = self._asked
            self.target_wanted.emit(self._crossover, self._margin)

    def _by_key(self, aside: int, up: int) -> None:
        if self._shown is None:
            return
        self.crossover.setValue(float(self.crossover.value()) + aside * math.log10(KEY_RATIO))
        self.margin.setValue(float(self.margin.value()) + up * KEY_DEGREES)
        self._dragged()

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() in (QEvent.Type.StyleChange, QEvent.Type.PaletteChange) and self.making.done:
            self.dress()


def _phase(values: np.ndarray) -> np.ndarray:
    """Degrees, unrolled, beginning between -360 and 0."""
    angle = np.degrees(np.unwrap(np.angle(values)))
    return angle - 360.0 * math.ceil(float(angle[0]) / 360.0) if len(angle) else angle
