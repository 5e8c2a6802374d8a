"""Diagrams of the tuner: a step, or its error, with the torque that made it.

Import it late: pyqtgraph takes longer to load than the first window may take to open.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
import pyqtgraph
from PySide6.QtCore import QEvent, Qt, QTimer
from PySide6.QtGui import QColor, QPen
from PySide6.QtWidgets import QVBoxLayout, QWidget

from device.tuning.metrics import Response
from widgets.parts.look import look
from widgets.parts.pieces import Pieces, in_breaths
from widgets.parts.plot import Plot
from widgets.parts.turns import Turns

MS = 1000.0
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

    def __init__(self, turns: Turns, parent: QWidget) -> None:
        super().__init__(parent)
        self._curves: tuple[Curve, ...] = ()
        self._scale, self._unit, self._letter, self._limit, self.error = 1.0, "counts", "X", 10.0, False
        self._turns = turns
        self._later = QTimer(self, singleShot=True, interval=0)
        self._later.timeout.connect(self._draw_on)
        self._drawing: Iterator[None] = iter(())
        self.making = Pieces(self._pieces())

    def _pieces(self) -> Iterator[None]:
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        self.position = Plot("Step response", parent=self)
        column.addWidget(self.position, 3)
        yield
        self.torque = Plot("Motor command", parent=self)
        self.torque.setXLink(self.position)
        self.torque.setMaximumHeight(150)
        column.addWidget(self.torque, 1)
        yield
        self.position.addLegend(offset=(-8, -8))
        self.draw()

    def show_scale(self, scale: float, unit: str, letter: str) -> None:
        """Counts per unit of the axis, its name, its letter."""
        if (scale, unit, letter) != (self._scale, self._unit, self._letter):
            self._scale, self._unit, self._letter = scale, unit, letter
            self.draw()

    def show_curves(self, curves: Sequence[Curve], torque_limit: float) -> None:
        """The responses, the last one in front; torque at its limit is marked."""
        before, self._curves, self._limit = self._curves, tuple(curves), torque_limit
        if before or self._curves:
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
        """Everything anew, in the colours of now: a piece in each turn of the window, painted when all is there."""
        for plot in (self.position, self.torque):
            plot.setViewportUpdateMode(Plot.ViewportUpdateMode.NoViewportUpdate)
        self._drawing = in_breaths(self._drawn_anew())
        self._later.start()

    def _draw_on(self) -> None:
        if next(self._drawing, self) is self:
            self._turns.change((self.position, self.torque))
        else:
            self._later.start()

    def _drawn_anew(self) -> Iterator[None]:
        for plot in (self.position, self.torque):
            for item in plot.getPlotItem().listDataItems():
                plot.removeItem(item)
                yield
            empty(plot)
            yield
        unit = "counts" if self.error else self._unit
        self.position.name_sides("", f"{'Error' if self.error else 'Position'}, {unit}")
        self.torque.name_sides("Time, ms", "Volts")  # of the motor command; more words would be cut off
        yield
        self._legend()
        for number, curve in enumerate(self._curves):
            front = number == len(self._curves) - 1
            yield from self._draw(curve if front else alike(curve, self._curves[-1]), number, front)

    def _legend(self) -> None:
        legend = self.position.getPlotItem().legend
        legend.clear()
        legend.setVisible(bool(self._curves))
        legend.setLabelTextColor(look().colour("text"))
        legend.setLabelTextSize(f"{look().fonts['small_points']:g}pt")
        ground = QColor(look().colour("surface"))
        ground.setAlpha(220)
        legend.setBrush(ground)

    def _draw(self, curve: Curve, number: int, front: bool) -> Iterator[None]:
        yield
        response = curve.response
        times = np.arange(len(response.actual)) * response.period * MS
        begin = int(np.argmax(response.commanded != response.commanded[0])) if len(times) else 0
        times = times - times[max(begin - 1, 0)] if len(times) else times
        pen = stroke(_colour(self._letter, number, curve.quiet or not front), curve.predicted, 2.2 if front else 1.4)
        if self.error:
            item = self.position.plot(times, response.commanded - response.actual, pen=pen, name=curve.name)
        else:
            if front:
                commanded = stroke(look().colour("quiet"), False, 1.2)
                self.position.plot(times, response.commanded / self._scale, pen=commanded, name="Commanded")
                yield
            item = self.position.plot(times, response.actual / self._scale, pen=pen, name=curve.name)
        item.setZValue(10 if curve.predicted else 0)  # the dashes lie over what they predicted
        yield
        self.torque.plot(times, response.volts, pen=pen)
        at_limit = np.abs(response.volts) >= self._limit - 0.002
        if front and at_limit.any():
            self.torque.plot(
                times[at_limit], response.volts[at_limit], pen=None, symbol="s", symbolSize=6,
                symbolPen=look().colour("warning"), symbolBrush=look().colour("warning"),
            )  # fmt: skip

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() in (QEvent.Type.StyleChange, QEvent.Type.PaletteChange) and self.making.done:
            self.draw()


def alike(curve: Curve, front: Curve) -> Curve:
    """A response to the other side, mirrored, so that both can be compared."""
    own, other = curve.response, front.response
    if (own.commanded[-1] - own.commanded[0]) * (other.commanded[-1] - other.commanded[0]) >= 0:
        return curve
    turned = Response(own.period, -own.commanded, -own.actual, -own.volts)
    return replace(curve, response=turned, name=f"{curve.name}, mirrored")


def _colour(letter: str, number: int, quiet: bool) -> QColor:
    if not quiet:
        return look().axis(letter)
    return look().colour(OVERLAYS[number % len(OVERLAYS)])


def stroke(colour: QColor, dashed: bool, width: float) -> QPen:
    """For a curve or a line."""
    made: QPen = pyqtgraph.mkPen(colour, width=width)
    if dashed:
        made.setStyle(Qt.PenStyle.DashLine)
    return made


def empty(plot: Plot) -> None:
    """Nothing is drawn any more but the grid."""
    plot.clear()
    plot.addItem(plot.grid, ignoreBounds=True)
