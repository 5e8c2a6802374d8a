"""The STOP button: one size, one place, one meaning."""

from __future__ import annotations

from PySide6.QtCore import QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QFontMetricsF, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QAbstractButton, QSizePolicy, QWidget

from device.api import Kind, StopState
from widgets.parts.kind import BORDER, WORDS, paint_border
from widgets.parts.look import look

HELP = (
    "Stops all motion and all programs, ahead of everything else (F12). A second press aborts at once. "
    "It is not an emergency stop: keep the machine's own within reach."
)
# state: (headline, line below)
TEXTS = {
    StopState.READY: ("STOP", "ready"),
    StopState.STOPPING: ("STOP", "stopping…"),
    StopState.STOPPED: ("STOP", "stopped (confirmed)"),
    StopState.NOT_CONFIRMED: ("NOT CONFIRMED", "use the machine's emergency stop"),
    StopState.NO_LINK: ("STOP", "no link"),
}


class StopButton(QAbstractButton):
    """Acts when pressed, not when released; says what has become of the stop."""

    stop = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._kind = Kind.OFFLINE
        self._state = StopState.NO_LINK
        self.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setAccessibleName("Stop")
        self.setProperty("helpPage", "STOP")
        self.setToolTip(HELP)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.show_state(Kind.OFFLINE, StopState.NO_LINK)

    @property
    def words(self) -> tuple[str, str]:
        """Headline and the line below, as painted."""
        headline, below = TEXTS[self._state]
        if self._state is StopState.NOT_CONFIRMED:
            return headline, below
        below = "nothing to stop" if self._kind is Kind.REPLAY else below
        return headline, f"{WORDS[self._kind]} · {below}"

    def show_state(self, kind: Kind, state: StopState) -> None:
        """What is connected, and what has become of the last stop."""
        if (kind, state) == (self._kind, self._state) and self.accessibleDescription():
            return
        self._kind, self._state = kind, state
        self.setAccessibleDescription(" - ".join(self.words))
        self.update()

    def sizeHint(self) -> QSize:
        return QSize(272, 72)

    def minimumSizeHint(self) -> QSize:
        return self.sizeHint()

    def mousePressEvent(self, event: QMouseEvent) -> None:
        if event.button() == Qt.MouseButton.LeftButton:
            self.setDown(True)
            self.stop.emit()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        self.setDown(False)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() in (Qt.Key.Key_Space, Qt.Key.Key_Return, Qt.Key.Key_Enter):
            if not event.isAutoRepeat():
                self.stop.emit()
            return
        super().keyPressEvent(event)

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        rect = QRectF(self.rect())
        paint_border(painter, rect, self._kind)
        inner = rect.adjusted(BORDER + 1, BORDER + 1, -BORDER - 1, -BORDER - 1)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(self._ground())
        painter.drawRoundedRect(inner, 3, 3)
        if self.hasFocus():
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.setPen(QPen(self._ink(), 2))
            painter.drawRoundedRect(inner.adjusted(2.5, 2.5, -2.5, -2.5), 3, 3)
        self._paint_words(painter, inner)

    def _paint_words(self, painter: QPainter, inner: QRectF) -> None:
        painter.setPen(self._ink())
        headline, below = self.words
        font = look().body_font()
        font.setBold(True)
        font.setPointSizeF(19 if len(headline) < 8 else 14.5)
        painter.setFont(font)
        head = inner.adjusted(12, 5, -12, -24)
        if self._state is not StopState.NOT_CONFIRMED:
            painter.setBrush(self._ink())
            painter.setPen(Qt.PenStyle.NoPen)
            painter.drawRect(QRectF(head.left(), head.center().y() - 9, 18, 18))
            painter.setPen(self._ink())
            painter.drawText(head.adjusted(28, 0, 0, 0), Qt.AlignmentFlag.AlignVCenter, headline)
            self._paint_key(painter, head)
        else:
            painter.drawText(head, Qt.AlignmentFlag.AlignCenter, headline)
        line = inner.adjusted(8, 34, -8, -3)
        font.setBold(self._state is StopState.NOT_CONFIRMED)
        font.setPointSizeF(look().body_points)
        while QFontMetricsF(font).horizontalAdvance(below) > line.width() and font.pointSizeF() > 7:
            font.setPointSizeF(font.pointSizeF() - 0.5)
        painter.setFont(font)
        painter.drawText(line, Qt.AlignmentFlag.AlignCenter, below)

    def _paint_key(self, painter: QPainter, head: QRectF) -> None:
        """The key F12, drawn as a key."""
        font = look().body_font()
        font.setBold(True)
        painter.setFont(font)
        key = QRectF(head.right() - 40, head.center().y() - 12, 40, 24)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(QPen(self._ink(), 1.4))
        painter.drawRoundedRect(key, 4, 4)
        painter.drawText(key, Qt.AlignmentFlag.AlignCenter, "F12")

    def _ground(self) -> QColor:
        colour = look().colour("stop")
        if self._state is StopState.NO_LINK:
            return look().colour("sunken")
        return colour.darker(125) if self.isDown() else colour

    def _ink(self) -> QColor:
        if self._state is StopState.NO_LINK:
            return look().colour("quiet")
        return look().colour("stop_text")
