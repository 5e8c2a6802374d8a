"""What pictures in dialogs share: a frame, and the same mouse (wheel zooms, drag pans, double click fits)."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import (
    QAction,
    QContextMenuEvent,
    QGuiApplication,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QWheelEvent,
)
from PySide6.QtWidgets import QMenu, QSizePolicy, QWidget

from widgets.parts.look import look

CLOSEST = 40.0  # times
NOTCH = 1.2  # zoom for one notch of the wheel
RING = 2  # px, of the focus


class Canvas(QWidget):
    """Paints itself through `draw`; `zoom` and `shift` say how the person looks at it (1 and 0: all of it)."""

    def __init__(self, name: str) -> None:
        super().__init__()
        self.zoom = 1.0
        self.shift = QPointF()
        self._grabbed: QPointF | None = None
        self.setAccessibleName(name)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)

    def sizeHint(self) -> QSize:
        """No more than there is room."""
        return self.minimumSize()

    # ---- what a picture does of its own

    def draw(self, painter: QPainter) -> None:
        """Paints the picture inside its frame."""
        raise NotImplementedError

    def grab_at(self, place: QPointF) -> bool:
        """Whether something of the picture was taken hold of; else the drag pans."""
        return False

    def drag_to(self, place: QPointF) -> None:
        """What was taken hold of is pulled there."""

    def let_go(self) -> None:
        """It is let go."""

    # ---- looking

    def fit(self) -> None:
        """All of it is shown."""
        self.zoom, self.shift = 1.0, QPointF()
        self.update()

    def zoom_at(self, place: QPointF, factor: float) -> None:
        """Closer or further; what is under the mouse stays there."""
        new = min(max(self.zoom * factor, 1.0), CLOSEST)
        middle = QPointF(self.width() / 2, self.height() / 2)
        away = place - middle
        self.shift = away - (away - self.shift) * (new / self.zoom)
        self.zoom = new
        if new == 1.0:
            self.shift = QPointF()
        self.update()

    def seen(self, place: QPointF) -> QPointF:
        """Where a place of the whole picture is on the screen."""
        middle = QPointF(self.width() / 2, self.height() / 2)
        return middle + (place - middle) * self.zoom + self.shift

    # ---- Qt

    def paintEvent(self, event: QPaintEvent) -> None:
        """Ground, frame, picture, focus ring."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(look().colour("line"))
        painter.setBrush(look().colour("surface"))
        painter.drawRect(QRectF(self.rect()).adjusted(0.5, 0.5, -0.5, -0.5))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setFont(look().small_font())
        painter.save()
        painter.setClipRect(self.rect().adjusted(1, 1, -1, -1))
        self.draw(painter)
        painter.restore()
        if self.hasFocus():
            painter.setPen(QPen(look().colour("focus"), RING))
            painter.drawRect(QRectF(self.rect()).adjusted(1, 1, -1, -1))

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Zooms about the mouse."""
        notches = event.angleDelta().y() / 120
        if notches:
            self.zoom_at(event.position(), NOTCH**notches)
        event.accept()

    def mousePressEvent(self, event: QMouseEvent) -> None:
        if event.button() is Qt.MouseButton.LeftButton and not self.grab_at(event.position()):
            self._grabbed = event.position() - self.shift

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if not event.buttons() & Qt.MouseButton.LeftButton:
            return
        if self._grabbed is None:
            self.drag_to(event.position())
        elif self.zoom > 1.0:
            self.shift = event.position() - self._grabbed
            self.update()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        if event.button() is Qt.MouseButton.LeftButton:
            if self._grabbed is None:
                self.let_go()
            self._grabbed = None

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        if event.button() is Qt.MouseButton.LeftButton:
            self.fit()

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        menu = QMenu(self)
        for words, call in (("Copy picture", self.copy), ("Fit", self.fit)):
            action = QAction(words, menu)
            action.triggered.connect(call)
            menu.addAction(action)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        menu.popup(event.globalPos())

    def copy(self) -> None:
        """The picture as it is on the screen, to the clipboard."""
        QGuiApplication.clipboard().setPixmap(self.grab())

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """+ and - zoom, Home fits, Ctrl+C copies."""
        middle = QPointF(self.width() / 2, self.height() / 2)
        key = event.key()
        if key in (Qt.Key.Key_Plus, Qt.Key.Key_Minus):
            self.zoom_at(middle, NOTCH if key == Qt.Key.Key_Plus else 1 / NOTCH)
        elif key == Qt.Key.Key_Home:
            self.fit()
        elif key == Qt.Key.Key_C and event.modifiers() == Qt.KeyboardModifier.ControlModifier:
            self.copy()
        else:
            super().keyPressEvent(event)
