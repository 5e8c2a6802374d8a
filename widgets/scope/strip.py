"""One scale of the scope's picture: curves with their names above them, or tracks with their names beside them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import pyqtgraph
from numpy.typing import NDArray
from PySide6.QtCore import Qt
from PySide6.QtGui import QColor, QKeyEvent, QPalette, QPixmap, QResizeEvent
from PySide6.QtWidgets import QLabel

from widgets.parts.look import look
from widgets.parts.plot import Plot
from widgets.scope.curve import DrawnCurve
from widgets.scope.lanes import Lanes

if TYPE_CHECKING:
    from widgets.scope.chart import Chart

FEW = 2500  # points of a curve that are drawn smooth; more are drawn quickly
WAY = 60  # heights of the picture that a smooth curve may go up and down
NAMED = 20  # px above the curves for their names
TITLED = 110  # px of height from which on a strip has titles at its sides
LEAST = 72  # px of height of a strip
FADED = 90  # opacity of an overlaid curve, of 255


@dataclass(frozen=True, eq=False)
class Line:
    """One curve as it is drawn: `group` chooses its strip."""

    label: str
    unit: str
    group: str
    colour: QColor
    x: NDArray[np.float64]
    y: NDArray[np.float64]
    dashed: bool = False
    faded: bool = False
    track: bool = False  # 0 and 1, in a lane of its own


class Strip(Plot):
    """One scale of the picture; what is done to its time is done to all."""

    def __init__(self, chart: Chart) -> None:
        self._chart = chart
        super().__init__("Curves", parent=chart)
        self.legend = QLabel(self)
        self.legend.setTextFormat(Qt.TextFormat.RichText)
        self.legend.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.legend.setAutoFillBackground(True)
        self.items: list[DrawnCurve] = []
        self.lanes = Lanes(self)
        self._pens: list[tuple[Any, ...]] = []
        self.setMinimumHeight(LEAST)

    def fit(self) -> None:
        self._chart.fit()
        self.fitted.emit()

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Where it is low, the numbers have the room of the titles; the names in their colours stay."""
        super().resizeEvent(event)
        if hasattr(self, "actions_"):  # not while it is being made
            self.show_titles()

    def show_titles(self) -> None:
        """The one at the side only where it is not cut; above the curves the names have room of their own."""
        side, titled = self.getAxis("left").label.boundingRect().width() + 2 * NAMED, self.height() >= TITLED
        above = self._show_legend(titled)
        self.getPlotItem().layout.setContentsMargins(1, 1 if self.lanes.labels else above, 1, 1)
        self.getAxis("left").showLabel(self.height() >= max(TITLED, side) and bool(self.getAxis("left").labelText))
        self.getAxis("bottom").showLabel(titled and bool(self.getAxis("bottom").labelText))

    def _show_legend(self, high: bool) -> int:
        """The names above the curves, in several rows where there is room for them; how high they are."""
        left = int(self.getAxis("left").width()) + 12
        wide, legend = max(self.width() - left - 8, 1), self.legend
        legend.setVisible(bool(legend.text()))
        legend.setWordWrap(False)
        one = legend.sizeHint()
        if one.width() <= wide or not high:
            legend.setGeometry(left, 4, min(one.width(), wide), one.height())
            return NAMED
        legend.setWordWrap(True)
        tall = legend.heightForWidth(wide)
        legend.setGeometry(left, 4, wide, tall)
        return NAMED + tall - one.height()

    def show_legend(self, text: str) -> None:
        """The names of the curves in their colours."""
        legend = self.legend
        if legend.text() == text:
            return
        legend.setText(text)
        legend.setFont(look().small_font())
        ground = look().colour("surface")
        ground.setAlpha(200)
        palette = legend.palette()
        palette.setColor(QPalette.ColorRole.Window, ground)
        legend.setPalette(palette)
        legend.raise_()
        self.show_titles()

    def show_left(self, width: int) -> None:
        """How wide the numbers at the side, or the names of tracks, are."""
        axis = self.getAxis("left")
        if axis.fixedWidth != width:
            axis.setWidth(width)
            self.show_titles()
        self.lanes.name(width)

    def fit_own(self) -> None:
        """This strip alone."""
        super().fit()

    def picture(self) -> QPixmap:
        return self._chart.grab()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if not self._chart.key(event):
            super().keyPressEvent(event)

    def show_lines(self, lines: Sequence[Line], few: bool = True) -> None:
        """Draws these and no others; what has not changed its looks is only given its values."""
        self.lanes.show(list(dict.fromkeys(line.label for line in lines if line.track)))
        self.setMinimumHeight(max(LEAST, self.lanes.least if self.lanes.labels else 0))
        while len(self.items) > len(lines):
            self.removeItem(self.items.pop())
            self._pens.pop()
        while len(self.items) < len(lines):
            self.items.append(DrawnCurve())
            self.addItem(self.items[-1])
            self._pens.append(())
        for place, (item, line) in enumerate(zip(self.items, lines, strict=True)):
            smooth = few and _smooth(line.y)
            looks = (line.colour.rgba(), line.dashed, line.faded, smooth)
            if looks != self._pens[place]:
                self._pens[place] = looks
                item.setPen(_pen(line, smooth))
                item.setZValue(-1 if line.faded else 0)
            item.give(line.x, self.lanes.raised(line.label, line.y) if line.track else line.y, smooth)


def _smooth(y: NDArray[np.float64]) -> bool:
    """Whether a curve is drawn with soft edges: those of a long way up and down would take too long."""
    if not 1 < len(y) <= FEW:
        return len(y) < 2
    height = float(np.ptp(y))
    return height == 0 or float(np.abs(np.diff(y)).sum()) <= WAY * height


def _pen(line: Line, smooth: bool) -> Any:
    colour = QColor(line.colour)
    if line.faded:
        colour.setAlpha(FADED)
    style = Qt.PenStyle.DashLine if line.dashed else Qt.PenStyle.SolidLine
    return pyqtgraph.mkPen(colour, width=1.6 if smooth else 1, style=style)
