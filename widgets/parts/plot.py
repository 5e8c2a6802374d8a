"""The one kind of diagram: house colours, and the same mouse everywhere (wheel zooms, drag pans, double click fits).

Import it late: pyqtgraph takes longer to load than the first window may take to open.
"""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import pyqtgraph
from PySide6.QtCore import QEvent, QLineF, QRectF, Qt, Signal
from PySide6.QtGui import (
    QAction,
    QColor,
    QContextMenuEvent,
    QFontMetrics,
    QGuiApplication,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPen,
    QPixmap,
)
from PySide6.QtWidgets import QMenu, QWidget

from widgets.parts.files import PICTURES, ask_save
from widgets.parts.inside import Inside
from widgets.parts.look import look
from widgets.parts.question import Question

TOP = 8  # px above the highest number at the side, half of which stands there
STEP = 0.1  # of the width, for an arrow key
ZOOM = 0.8  # for the plus key
GRID = 0.5  # how much of the line colour a grid line has; the rest is the ground's


class Grid(pyqtgraph.GraphicsObject):  # type: ignore[misc]
    """Lines at the large ticks, below everything; pyqtgraph's own see-through ones take longer than the curves."""

    def __init__(self, plot: Plot) -> None:
        super().__init__()
        self._plot = plot
        self.setZValue(-1000)
        self.colour = QColor()
        self.upward: list[float] | None = None  # where lines go across; None: at the large ticks
        self._asked: tuple[object, ...] = ()
        self._lines: list[QLineF] = []

    def boundingRect(self) -> QRectF:
        return QRectF(self._plot.getViewBox().viewRect())

    def viewRangeChanged(self) -> None:
        self.prepareGeometryChange()
        super().viewRangeChanged()

    def paint(self, painter: QPainter, *_: object) -> None:
        box = self._plot.getViewBox()
        (left, right), (low, high) = box.viewRange()
        pen = QPen(self.colour, 0)
        pen.setCosmetic(True)
        painter.setPen(pen)
        asked = (left, right, low, high, box.width(), box.height(), self.upward)
        if asked != self._asked:
            self._asked = asked
            across = _large_ticks(self._plot.getAxis("bottom"), left, right, box.width())
            upward = self.upward
            if upward is None:
                upward = _large_ticks(self._plot.getAxis("left"), low, high, box.height())
            self._lines = [QLineF(x, low, x, high) for x in across] + [QLineF(left, y, right, y) for y in upward]
        painter.drawLines(self._lines)


def _large_ticks(axis: Any, low: float, high: float, size: float) -> list[float]:
    """Where an axis has its large ticks."""
    if not high > low or size < 1:
        return []
    found: list[float] = []
    for _, places in axis.tickValues(low, high, size):
        found += map(float, places)
        if len(found) > 2:  # few large ones do with the next smaller
            break
    return found


class Plot(pyqtgraph.PlotWidget):  # type: ignore[misc]
    """A diagram that follows its data until the person looks elsewhere, and again once it is told to fit.

    It belongs to a parent from the start: left to the garbage collector, its items and its scene would go in any order.
    """

    fitted = Signal()
    panned = Signal()  # the person looks elsewhere from now on

    def __init__(
        self, name: str, equal: bool = False, *, parent: QWidget, item: pyqtgraph.PlotItem | None = None
    ) -> None:
        super().__init__(parent, plotItem=item or Inside())
        self.setAccessibleName(name)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.getPlotItem().layout.setContentsMargins(1, TOP, 1, 1)
        self.setAspectLocked(equal)
        self.grid = Grid(self)
        self.addItem(self.grid, ignoreBounds=True)
        self.getPlotItem().getViewBox().sigRangeChangedManually.connect(self._by_hand)
        self.actions_: dict[str, QAction] = {}
        for words, call in (("Copy picture", self.copy), ("Save picture…", self.save), ("Fit", self.fit)):
            action = QAction(words, self)
            action.triggered.connect(call)
            self.actions_[words] = action
        self.dress()

    def dress(self) -> None:
        """Takes the colours and fonts of the theme as it is now."""
        now = look()
        ground, line = now.colour("surface"), now.colour("line")
        self.setBackground(ground)
        self.grid.colour = QColor(*(
            round(one + GRID * (other - one))
            for one, other in zip(ground.getRgb()[:3], line.getRgb()[:3], strict=True)  # type: ignore[misc,arg-type]
        ))  # fmt: skip
        for side in ("left", "bottom"):
            axis = self.getAxis(side)
            axis.setPen(now.colour("line"))
            axis.setTextPen(now.colour("quiet"))
            axis.setTickFont(now.small_font())
            axis.label.setFont(now.small_font())
        self.getAxis("left").setWidth(QFontMetrics(now.small_font()).horizontalAdvance("-000 000") + 30)

    def name_sides(self, bottom: str, left: str) -> None:
        """What the two directions are, with their units as text: 12 mm stays 12 mm, never 0.012 m."""
        for side, words in (("bottom", bottom), ("left", left)):
            axis = self.getAxis(side)
            axis.setLabel(words, siPrefixEnableRanges=())
            axis.enableAutoSIPrefix(False)  # keeps the scale of this moment, which the line above has made 1

    def fit(self) -> None:
        """Everything is shown, and followed again."""
        self.getPlotItem().getViewBox().enableAutoRange()
        self.getPlotItem().getViewBox().updateAutoRange()
        self.fitted.emit()

    def copy(self) -> None:
        """The picture as it is on the screen, to the clipboard."""
        QGuiApplication.clipboard().setPixmap(self.picture())

    def picture(self) -> QPixmap:
        """As it is on the screen."""
        return self.grab()

    def save(self) -> None:
        """The picture into a file that the person chooses."""
        picture = self.picture()
        proposed = Path.home() / f"{self.accessibleName()}.png"
        ask_save(self.window(), "Save picture", PICTURES, partial(self._write, picture), proposed, "png")

    def _write(self, picture: QPixmap, path: Path) -> None:
        if not picture.save(str(path)):
            Question("The picture was not saved", f"{path} cannot be written; choose another folder.", [], self).show()

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() in (QEvent.Type.StyleChange, QEvent.Type.PaletteChange) and hasattr(self, "actions_"):
            self.dress()

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        if event.button() is Qt.MouseButton.LeftButton:
            self.fit()
            return
        super().mouseDoubleClickEvent(event)

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        menu = QMenu(self)
        menu.addActions(list(self.actions_.values()))
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        menu.popup(event.globalPos())

    def mousePressEvent(self, event: QMouseEvent) -> None:
        if event.button() is not Qt.MouseButton.RightButton:  # the right one opens the menu and nothing else
            super().mousePressEvent(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Arrows pan, + and - zoom, Home fits, Ctrl+C copies."""
        directions: dict[Any, tuple[float, float]] = {
            Qt.Key.Key_Left: (-STEP, 0), Qt.Key.Key_Right: (STEP, 0),
            Qt.Key.Key_Up: (0, STEP), Qt.Key.Key_Down: (0, -STEP),
        }  # fmt: skip
        box, key = self.getPlotItem().getViewBox(), event.key()
        if key in directions:
            (left, right), (low, high) = box.viewRange()
            aside, up = directions[Qt.Key(key)]
            box.translateBy(x=aside * (right - left), y=up * (high - low))
            self._by_hand()
        elif key in (Qt.Key.Key_Plus, Qt.Key.Key_Minus):
            factor = ZOOM if key == Qt.Key.Key_Plus else 1 / ZOOM
            box.scaleBy((factor, factor))
            self._by_hand()
        elif key == Qt.Key.Key_Home:
            self.fit()
        elif key == Qt.Key.Key_C and event.modifiers() == Qt.KeyboardModifier.ControlModifier:
            self.copy()
        else:
            QWidget.keyPressEvent(self, event)

    def _by_hand(self, *_: object) -> None:
        self.getPlotItem().getViewBox().disableAutoRange()
        self.panned.emit()
