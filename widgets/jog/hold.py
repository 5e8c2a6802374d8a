"""A button that means something only while it is down, and who holds: one of mouse, keys, stick and pad."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, QSize, Qt, QTimer, Signal
from PySide6.QtGui import QFocusEvent, QHideEvent, QKeyEvent
from PySide6.QtWidgets import QPushButton, QSizePolicy, QWidget

from widgets.parts.look import look

RENEW_MS = 50  # safety.md 4
HOLDING = (Qt.Key.Key_Space, Qt.Key.Key_Return, Qt.Key.Key_Enter)


class Holder(QObject):
    """Who holds now: mouse, keys, stick or pad, never two of them; says every 50 ms that it still does."""

    renewed = Signal(str)
    released = Signal(str)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.owner = ""
        self._beat = QTimer(self, interval=RENEW_MS)
        self._beat.setTimerType(Qt.TimerType.PreciseTimer)
        self._beat.timeout.connect(self.renew)

    def begin(self, owner: str) -> bool:
        """Takes hold; False where another one holds."""
        if self.owner:
            return False
        self.owner = owner
        self._beat.start()
        return True

    def renew(self) -> None:
        """Still held."""
        if self.owner:
            self.renewed.emit(self.owner)

    def let_go(self, owner: str = "") -> None:
        """This one lets go; without a name whoever it is."""
        if self.owner and owner in ("", self.owner):
            self._beat.stop()
            released, self.owner = self.owner, ""
            self.released.emit(released)


class HoldButton(QPushButton):
    """`began` on press, `ended` on release, lost focus, hiding, disabling: whatever comes first, once."""

    began = Signal()
    ended = Signal()

    def __init__(self, text: str, parent: QWidget | None = None) -> None:
        super().__init__(text, parent)
        self.held = False
        self.setAutoRepeat(False)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.pressed.connect(self._begin)
        self.released.connect(self.let_go)

    def sizeHint(self) -> QSize:
        return super().sizeHint().expandedTo(QSize(72, look().space["touch"]))

    def let_go(self) -> None:
        """Nothing is held any more."""
        if self.held:
            self.held = False
            self.ended.emit()

    def _begin(self) -> None:
        if not self.held and self.isEnabled():
            self.held = True
            self.began.emit()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Space and Enter hold; the repetition of the keyboard is no new press."""
        if event.key() in HOLDING:
            if not event.isAutoRepeat():
                self.setDown(True)
                self._begin()
            return
        super().keyPressEvent(event)

    def keyReleaseEvent(self, event: QKeyEvent) -> None:
        if event.key() in HOLDING:
            if not event.isAutoRepeat():
                self.setDown(False)
                self.let_go()
            return
        super().keyReleaseEvent(event)

    def focusOutEvent(self, event: QFocusEvent) -> None:
        self.setDown(False)
        self.let_go()
        super().focusOutEvent(event)

    def hideEvent(self, event: QHideEvent) -> None:
        self.let_go()
        super().hideEvent(event)

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() is QEvent.Type.EnabledChange and not self.isEnabled():
            self.let_go()
