"""A stick on the screen: two axes, held by the mouse or by arrow keys, back in its middle when it is let go."""

from __future__ import annotations

import math

from PySide6.QtCore import QEvent, QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QFocusEvent, QHideEvent, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QSizePolicy, QWidget

from device.jog import DEAD_ZONE, deflection
from widgets.parts.look import look

WAYS = {
    Qt.Key.Key_Left: (-1.0, 0.0),
    Qt.Key.Key_Right: (1.0, 0.0),
    Qt.Key.Key_Up: (0.0, 1.0),
    Qt.Key.Key_Down: (0.0, -1.0),
}
FINE = 0.3  # of the speed, with Shift
KNOB, EDGE = 22, 18  # px: half the width of the knob; room around the ring for letters


class Stick(QWidget):
    """`moved` tells shares of the full speed (right and up are positive), (0, 0) when it is let go.

    It is let go on release, lost focus, hiding, disabling, a window that goes to the back, and when Shift is pressed
    or released while arrows are held: whoever held it has to press again.
    """

    moved = Signal(float, float)

    def __init__(self, parent: QWidget | None = None, *, dead: float = DEAD_ZONE) -> None:
        super().__init__(parent)
        self.dead = dead
        self._place = QPointF()  # of the knob, -1 to 1, up is positive
        self._letters = ("X", "Y")
        self._dragged = False
        self._keys: set[Qt.Key] = set()
        self._fine = False
        self._told = (0.0, 0.0)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.MinimumExpanding, QSizePolicy.Policy.MinimumExpanding)
        self.setAccessibleName("Stick")
        self.setToolTip("Drag the knob, or hold arrow keys while it has the focus; with Shift slowly.")

    # ---- what it tells

    @property
    def value(self) -> tuple[float, float]:
        """Shares of the full speed, each -1 to 1, behind the dead zone."""
        return self._told

    @property
    def held(self) -> bool:
        """Whether a hand is on it, moved or not."""
        return self._dragged or bool(self._keys)

    def show_axes(self, across: str, upward: str) -> None:
        """The letters of the axes; an empty one makes that way useless, and the knob stays on the other."""
        if (across, upward) != self._letters:
            self.let_go()
            self._letters = across, upward
            self.update()

    def let_go(self) -> None:
        """Back in the middle; goes on only after a new press."""
        self._dragged = False
        self._keys.clear()
        self._put(0.0, 0.0)

    # ---- hands

    def mousePressEvent(self, event: QMouseEvent) -> None:
        if event.button() is not Qt.MouseButton.LeftButton or self._keys:
            self.let_go()
            return
        self._dragged = True
        self._drag(event.position())

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if self._dragged:
            self._drag(event.position())

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        if event.button() is Qt.MouseButton.LeftButton:
            self.let_go()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        key, fine = Qt.Key(event.key()), bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
        if key is Qt.Key.Key_Shift and self._keys:
            self.let_go()
        elif key not in WAYS:
            super().keyPressEvent(event)
        elif not event.isAutoRepeat() and not self._dragged:
            self._fine = fine
            self._keys.add(key)
            self._lean()

    def keyReleaseEvent(self, event: QKeyEvent) -> None:
        key = Qt.Key(event.key())
        if key is Qt.Key.Key_Shift and self._keys:
            self.let_go()
        elif key not in WAYS:
            super().keyReleaseEvent(event)
        elif not event.isAutoRepeat():
            self._keys.discard(key)
            self._lean()

    def focusOutEvent(self, event: QFocusEvent) -> None:
        self.let_go()
        super().focusOutEvent(event)

    def hideEvent(self, event: QHideEvent) -> None:
        self.let_go()
        super().hideEvent(event)

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        gone = event.type() is QEvent.Type.ActivationChange and not self.isActiveWindow()
        if gone or (event.type() is QEvent.Type.EnabledChange and not self.isEnabled()):
            self.let_go()
        self.update()

    # ---- inside

    def _lean(self) -> None:
        """Where the held arrows push it."""
        across = sum(WAYS[key][0] for key in self._keys)
        upward = sum(WAYS[key][1] for key in self._keys)
        way = math.hypot(across, upward)
        reach = self.dead + (1.0 - self.dead) * (FINE if self._fine else 1.0)
        self._put(across / way * reach, upward / way * reach) if way else self._put(0.0, 0.0)

    def _drag(self, at: QPointF) -> None:
        middle, radius = QPointF(self.width() / 2, self.height() / 2), self._radius()
        across, upward = (at.x() - middle.x()) / radius, (middle.y() - at.y()) / radius
        way = max(1.0, math.hypot(across, upward))
        self._put(across / way, upward / way)

    def _put(self, across: float, upward: float) -> None:
        first, second = self._letters
        self._place = QPointF(across if first else 0.0, upward if second else 0.0)
        self.update()
        value = deflection(self._place.x(), self._place.y(), self.dead)
        if value != self._told:
            self._told = value
            self.moved.emit(*value)

    def _radius(self) -> float:
        return max(1.0, min(self.width(), self.height()) / 2 - KNOB - EDGE)

    def sizeHint(self) -> QSize:
        return QSize(220, 220)

    def minimumSizeHint(self) -> QSize:
        return QSize(150, 150)

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        radius, usable = self._radius(), self.isEnabled()
        painter.translate(self.width() / 2, self.height() / 2)
        painter.setPen(QPen(look().colour("focus" if self.hasFocus() else "border"), 2 if self.hasFocus() else 1.5))
        painter.setBrush(look().colour("sunken"))
        reach = radius + KNOB * 0.6
        painter.drawEllipse(QPointF(), reach, reach)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(QPen(look().colour("border"), 1, Qt.PenStyle.DotLine))
        painter.drawEllipse(QPointF(), radius * self.dead, radius * self.dead)
        self._letter(painter, self._letters[0], QPointF(reach + EDGE / 2 + 2, 0))
        self._letter(painter, self._letters[1], QPointF(0, -reach - EDGE / 2 - 1))
        knob = QPointF(self._place.x() * radius, -self._place.y() * radius)
        painter.setPen(QPen(look().colour("line" if not usable else "border"), 4))
        painter.drawLine(QPointF(), knob)
        painter.setPen(QPen(look().colour("border"), 1.5))
        painter.setBrush(look().colour("accent" if self.held and usable else "raised"))
        painter.drawEllipse(knob, KNOB, KNOB)

    def _letter(self, painter: QPainter, letter: str, at: QPointF) -> None:
        if not letter:
            return
        painter.setPen(look().axis(letter) if self.isEnabled() else look().colour("disabled"))
        painter.setFont(look().body_font())
        painter.drawText(QRectF(at.x() - 10, at.y() - 10, 20, 20), Qt.AlignmentFlag.AlignCenter, letter)
