"""Which bits of a channel are drawn as tracks: a menu that stays open while some are ticked."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QAction, QKeyEvent, QMouseEvent
from PySide6.QtWidgets import QMenu, QWidget

from device.bits import Signal as Track

Bits = tuple[int, ...] | None  # numbers of bits; none of them: one curve of the number; None: those that are worth it
USUAL, WHOLE = "Those that change or have a name", "One curve of the whole number"
LIVE_ONLY = "live only"


class BitMenu(QMenu):
    """A tick for each bit; the first one chosen takes the place of what is usual."""

    chosen = Signal(object)  # Bits

    def __init__(self, known: Sequence[Track], bits: Bits, parent: QWidget) -> None:
        super().__init__(parent)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setAccessibleName("Tracks of the channel")
        self._bits = bits
        self._usual, self._whole = self._add(USUAL), self._add(WHOLE)
        self._usual.triggered.connect(lambda: self._choose(None))
        self._whole.triggered.connect(lambda: self._choose(()))
        self.addSeparator()
        self._each: dict[int, QAction] = {}
        for each in known:
            action = self._add(each.label if each.bit.recorded else f"{each.label} ({LIVE_ONLY})")
            action.triggered.connect(partial(self._turn, each.bit.number))
            self._each[each.bit.number] = action
        self._tick()

    def _add(self, words: str) -> QAction:
        action = self.addAction(words.replace("&", "&&"))
        action.setCheckable(True)
        return action

    def _turn(self, number: int, *_: object) -> None:
        before = self._bits or ()
        after = tuple(each for each in before if each != number) if number in before else (*before, number)
        self._choose(tuple(sorted(after)) or None)

    def _choose(self, bits: Bits) -> None:
        self._bits = bits
        self._tick()
        self.chosen.emit(bits)

    def _tick(self) -> None:
        self._usual.setChecked(self._bits is None)
        self._whole.setChecked(self._bits == ())
        for number, action in self._each.items():
            action.setChecked(number in (self._bits or ()))

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        action = self.activeAction()
        if action in self._each.values():
            action.trigger()
        else:
            super().mouseReleaseEvent(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """The space bar ticks, Enter ticks and closes."""
        action = self.activeAction()
        if event.key() == Qt.Key.Key_Space and action in self._each.values():
            action.trigger()
        else:
            super().keyPressEvent(event)
