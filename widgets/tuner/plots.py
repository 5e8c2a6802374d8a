"""Diagrams of the tuner: a step with its torque, and the Bode plot whose crossover and margin can be dragged.

Import it late: pyqtgraph takes longer to load than the first window may take to open.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pyqtgraph
from PySide6.QtCore import QEvent, Qt, Signal
from PySide6.QtGui import QColor, QPen
from PySide6.QtWidgets import QVBoxLayout, QWidget

from device.tuning.loop import Bode, Margins
from device.tuning.metrics import Response
from widgets.parts.look import look
from widgets.parts.plot import Plot

MS = 1000.0
HERTZ = 2 * math.pi  # rad/s
HERTZ_TICKS = [digit * 10.0**decade for decade in range(-2, 4) for digit in (1, 2, 5)]
OVERLAYS = ("axis_y", "axis_z", "axis_w", "group_math", "group_flow", "group_limits")


@dataclass(frozen=True, eq=False)
class Curve:
    """A response to draw; `quiet` ones lie behind, `predicted` ones are dashed."""

    response: Response
    name: str
    predicted: bool = False
    quiet: bool = False


class StepPlot(QWidget):
    """Commanded and actual position over the motor command; or the position error in place of the positions."""

    def __init__(self, position: Plot, torque: Plot, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.position, self.torque = position, torque
        self._curves: tuple[Curve, ...] = ()
        self._scale, self._unit, self._letter, self._limit, self.error = 1.0, "counts", "X", 10.0, False
        self.torque.setXLink(self.position)
        self.torque.setMaximumHeight(150)
        self.position.addLegend(offset=(-8, -8))
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(self.position, 3)
        column.addWidget(self.torque, 1)
        self.draw()

    def show_scale(self, scale: float, unit: str, letter: str) -> None:
        """Counts per unit of the axis, its name, its letter."""
        if (scale, unit, letter) != (self._scale, self._unit, self._letter):
            self._scale, self._unit, self._letter = scale, unit, letter
            self.draw()

    def show_curves(self, curves: Sequence[Curve], torque_limit: float) -> None:
        """The responses, the last one in front; torque at its limit is marked."""
        self._curves, self._limit = tuple(curves), torque_limit
        self.draw()

    def show_error(self, on: bool) -> None:
        """The position error in counts in place of the positions."""
        self.error = on
        self.draw()

    @property
    def names(self) -> tuple[str, ...]:
        """What is drawn."""
        return tuple(curve.name for curve in self._curves)

    def draw(self) -> None:
        """Everything anew, in the colours of now."""
        self.position.clear()
        self.torque.clear()
        unit = "counts" if self.error else self._unit
        self.position.name_sides("", f"{'Error' if self.error else 'Position'}, {unit}")
        self.torque.name_sides("Time, ms", "Torque, V")
        self._legend()
        for number, curve in enumerate(self._curves):
            self._draw(curve, number, number == len(self._curves) - 1)

    def _legend(self) -> None:
        legend = self.position.getPlotItem().legend
        legend.clear()
        legend.setLabelTextColor(look().colour("text"))
        legend.setLabelTextSize(f"{look().fonts['small_points']:g}pt")
        ground = QColor(look().colour("surface"))
        ground.setAlpha(220)
        legend.setBrush(ground)

    def _draw(self, curve: Curve, number: int, front: bool) -> None:
        response = curve.response
        times = np.arange(len(response.actual)) * response.period * MS
        begin = int(np.argmax(response.commanded != response.commanded[0])) if len(times) else 0
        times = times - times[max(begin - 1, 0)] if len(times) else times
        pen = _pen(_colour(self._letter, number, curve.quiet or not front), curve.predicted, 2.2 if front else 1.4)
        if self.error:
            item = self.position.plot(times, response.commanded - response.actual, pen=pen, name=curve.name)
        else:
            if front:
                commanded = _pen(look().colour("quiet"), False, 1.2)
                self.position.plot(times, response.commanded / self._scale, pen=commanded, name="Commanded")
            item = self.position.plot(times, response.actual / self._scale, pen=pen, name=curve.name)
        item.setZValue(10 if curve.predicted else 0)  # the dashes lie over what they predicted
        self.torque.plot(times, response.volts, pen=pen)
        at_limit = np.abs(response.volts) >= self._limit - 0.002
        if front and at_limit.any():
            self.torque.plot(
                times[at_limit], response.volts[at_limit], pen=None, symbol="s", symbolSize=6,
                symbolPen=look().colour("warning"), symbolBrush=look().colour("warning"),
            )  # fmt: skip

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() in (QEvent.Type.StyleChange, QEvent.Type.PaletteChange) and hasattr(self, "position"):
            self.draw()


class BodePlot(QWidget):
    """Gain and phase of plant and loop; the upright line is the crossover, the level one the phase margin."""

    target_wanted = Signal(float, float)  # crossover in rad/s, phase margin in degrees

    def __init__(self, gain: Plot, phase: Plot, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.gain, self.phase = gain, phase
        self._shown: tuple[Bode, Margins] | None = None
        self._crossover, self._margin = 0.0, 0.0
        self.crossover = pyqtgraph.InfiniteLine(angle=90, movable=True)
        self.margin = pyqtgraph.InfiniteLine(angle=0, movable=True)
        self.crossover.sigPositionChangeFinished.connect(self._dragged)
        self.margin.sigPositionChangeFinished.connect(self._dragged)
        self.phase.setXLink(self.gain)
        for plot in (self.gain, self.phase):
            plot.setLogMode(x=True, y=False)
            plot.getAxis("bottom").setTicks([[(math.log10(each), f"{each:g}") for each in HERTZ_TICKS]])
        self.gain.addLegend(offset=(-8, 8))
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(self.gain, 1)
        column.addWidget(self.phase, 1)
        self.draw()

    def show_bode(self, bode: Bode | None, margins: Margins | None) -> None:
        """Another loop, or none."""
        self._shown = (bode, margins) if bode is not None and margins is not None else None
        self.draw()

    def show_target(self, crossover: float, phase: float) -> None:
        """Where the handles stand: rad/s and degrees."""
        self._crossover, self._margin = crossover, phase
        for line, place in ((self.crossover, math.log10(max(crossover, 1e-6) / HERTZ)), (self.margin, phase - 180.0)):
            line.blockSignals(True)
            line.setValue(place)
            line.blockSignals(False)

    def draw(self) -> None:
        """Everything anew, in the colours of now."""
        now = look()
        self.gain.clear()
        self.phase.clear()
        self.gain.name_sides("", "Gain, dB")
        self.phase.name_sides("Frequency, Hz", "Phase, °")
        legend = self.gain.getPlotItem().legend
        legend.clear()
        legend.setLabelTextColor(now.colour("text"))
        legend.setLabelTextSize(f"{now.fonts['small_points']:g}pt")
        for line in (self.crossover, self.margin):
            line.setPen(_pen(now.colour("accent"), False, 1.6))
            line.setHoverPen(_pen(now.colour("accent"), False, 3.0))
        if self._shown is None:
            return
        bode, _ = self._shown
        seen = self._seen(bode)
        hertz = bode.frequency[seen] / HERTZ
        for values, name, token, width in (
            (bode.plant, "Axis", "quiet", 1.4),
            (bode.loop, "Loop", "axis_x", 2.2),
        ):
            pen = _pen(now.colour(token), False, width)
            self.gain.plot(hertz, 20 * np.log10(np.abs(values[seen]) + 1e-12), pen=pen, name=name)
            self.phase.plot(hertz, _phase(values)[seen], pen=pen)
        for plot, level in ((self.gain, 0.0), (self.phase, -180.0)):
            line = pyqtgraph.InfiniteLine(pos=level, angle=0, pen=_pen(now.colour("border"), True, 1.0))
            plot.addItem(line)
        self.gain.addItem(self.crossover)
        self.phase.addItem(self.margin)

    def _seen(self, bode: Bode) -> slice:
        """The part that matters: two decades around the crossover, up to where the sampling ends it."""
        middle = self._crossover or float(bode.frequency[len(bode.frequency) // 2])
        low, high = np.searchsorted(bode.frequency, (middle / 30.0, min(middle * 30.0, bode.frequency[-1] * 0.97)))
        return slice(int(low), max(int(high), int(low) + 2))

    def _dragged(self) -> None:
        """Let go of a handle: the gains follow."""
        crossover = 10 ** float(self.crossover.value()) * HERTZ
        phase = min(max(float(self.margin.value()) + 180.0, 5.0), 85.0)
        if (crossover, phase) != (self._crossover, self._margin):
            self._crossover, self._margin = crossover, phase
            self.target_wanted.emit(crossover, phase)

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() in (QEvent.Type.StyleChange, QEvent.Type.PaletteChange) and hasattr(self, "margin"):
            self.draw()


def _phase(values: np.ndarray) -> np.ndarray:
    """Degrees, unrolled, beginning between -360 and 0."""
    angle = np.degrees(np.unwrap(np.angle(values)))
    return angle - 360.0 * math.ceil(float(angle[0]) / 360.0) if len(angle) else angle


def _colour(letter: str, number: int, quiet: bool) -> QColor:
    if not quiet:
        return look().axis(letter)
    return look().colour(OVERLAYS[number % len(OVERLAYS)])


def _pen(colour: QColor, dashed: bool, width: float) -> QPen:
    pen: QPen = pyqtgraph.mkPen(colour, width=width)
    if dashed:
        pen.setStyle(Qt.PenStyle.DashLine)
    return pen
