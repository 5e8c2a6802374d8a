"""MACHINE, SIMULATOR, REPLAY or OFFLINE: the word and the border that go with it."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QBrush, QColor, QPainter, QPainterPath, QPaintEvent, QPen, QPixmap
from PySide6.QtWidgets import QFrame, QSizePolicy, QWidget

from device.api import Kind
from widgets.parts.look import look

WORDS = {Kind.MACHINE: "MACHINE", Kind.SIMULATOR: "SIMULATOR", Kind.REPLAY: "REPLAY", Kind.OFFLINE: "OFFLINE"}
MEANING = {
    Kind.MACHINE: "A real controller: what you start here moves.",
    Kind.SIMULATOR: "The bundled simulator: nothing real moves.",
    Kind.REPLAY: "A recording is played back: nothing moves.",
    Kind.OFFLINE: "No controller: programs can be written and checked.",
}
BORDER = 5  # px


def paint_border(painter: QPainter, rect: QRectF, kind: Kind, radius: float = 4.0) -> None:
    """Machine: solid hazard stripes; simulator: dashes; replay: dots; offline: a thin line."""
    painter.save()
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    if kind is Kind.MACHINE:
        _hazard(painter, rect, radius)
    else:
        colour = look().colour("accent" if kind is Kind.SIMULATOR else "border")
        pen = QPen(colour, 2.0 if kind is not Kind.OFFLINE else 1.0)
        if kind is Kind.SIMULATOR:
            pen.setDashPattern([5.0, 3.0])
        elif kind is Kind.REPLAY:
            pen.setStyle(Qt.PenStyle.DotLine)
        painter.setPen(pen)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        inset = BORDER / 2 - 0.5
        painter.drawRoundedRect(rect.adjusted(inset, inset, -inset, -inset), radius, radius)
    painter.restore()


def _hazard(painter: QPainter, rect: QRectF, radius: float) -> None:
    ring = QPainterPath()
    ring.addRoundedRect(rect, radius + 2, radius + 2)
    inner = QPainterPath()
    inner.addRoundedRect(rect.adjusted(BORDER, BORDER, -BORDER, -BORDER), radius, radius)
    painter.fillPath(ring.subtracted(inner), _stripes(look().colour("hazard"), look().colour("hazard_dark")))


def _stripes(light: QColor, dark: QColor) -> QBrush:
    """Diagonal stripes, 8 px wide, without a seam."""
    side, scale = 16, 3
    tile = QPixmap(side * scale, side * scale)
    tile.fill(light)
    painter = QPainter(tile)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.scale(scale, scale)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(dark)
    for start in (-side, 0, side):
        painter.drawPolygon(
            [
                QPointF(start, side),
                QPointF(start + side, 0),
                QPointF(start + side + side / 2, 0),
                QPointF(start + side / 2, side),
            ]
        )
    painter.end()
    tile.setDevicePixelRatio(scale)
    return QBrush(tile)


class KindFrame(QFrame):
    """Around whatever moves something: the border of the kind with its word set into the top of it."""

    TOP = 20  # px above the content, for the word

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._kind = Kind.OFFLINE
        self.setContentsMargins(BORDER + 1, self.TOP, BORDER + 1, BORDER + 1)

    @property
    def text(self) -> str:
        """The word that is shown."""
        return WORDS[self._kind]

    def show_kind(self, kind: Kind) -> None:
        """Which word and border."""
        if kind is not self._kind:
            self._kind = kind
            self.setToolTip("")
            self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        if self.contentsRect().contains(event.rect()):
            return  # only what is inside has changed
        painter = QPainter(self)
        paint_border(painter, QRectF(self.rect()).adjusted(1, 7, -1, -1), self._kind)
        font = look().small_font()
        font.setBold(True)
        painter.setFont(font)
        width = painter.fontMetrics().horizontalAdvance(self.text) + 16
        word = QRectF(16, 0, width, 18)
        painter.fillRect(word, look().colour("window"))
        painter.setPen(look().colour("text"))
        painter.drawText(word, Qt.AlignmentFlag.AlignCenter, self.text)


class KindBadge(QWidget):
    """The word in its border, for the status bar and the head of panels."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._kind: Kind | None = None
        self.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)
        self.show_kind(Kind.OFFLINE)

    @property
    def text(self) -> str:
        """The word that is shown."""
        return WORDS[self._kind or Kind.OFFLINE]

    def show_kind(self, kind: Kind) -> None:
        """Which word and border."""
        if kind is self._kind:
            return
        self._kind = kind
        self.setAccessibleName(WORDS[kind].capitalize())
        self.setToolTip(MEANING[kind])
        self.updateGeometry()
        self.update()

    def sizeHint(self) -> QSize:
        return QSize(self.fontMetrics().horizontalAdvance(self.text) + 28, 28)

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        rect = QRectF(self.rect())
        paint_border(painter, rect, self._kind or Kind.OFFLINE)
        font = self.font()
        font.setBold(True)
        painter.setFont(font)
        painter.setPen(look().colour("text"))
        painter.drawText(rect, Qt.AlignmentFlag.AlignCenter, self.text)
