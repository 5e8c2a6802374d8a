"""A few words side by side, as buttons: one of them is on, or any of them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QButtonGroup, QHBoxLayout, QPushButton, QSizePolicy, QWidget

from widgets.parts.look import look

STEPS = {Qt.Key.Key_Up: -1, Qt.Key.Key_Left: -1, Qt.Key.Key_Down: 1, Qt.Key.Key_Right: 1}


class Segment(QPushButton):
    """One of several buttons side by side; all four arrows walk along them."""

    walked = Signal(int)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Arrows go to the neighbour."""
        step = STEPS.get(Qt.Key(event.key()))
        if step is None:
            super().keyPressEvent(event)
        else:
            self.walked.emit(step)


class Buttons(QWidget):
    """A few words side by side; one of them (or, with `several`, any of them) is on."""

    changed = Signal(object)

    def __init__(self, choices: Sequence[tuple[Any, str]], *, several: bool, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.group = QButtonGroup(self)
        self.group.setExclusive(not several)
        self.buttons: dict[Any, Segment] = {}
        for key, words in choices:
            button = Segment(words)
            button.setCheckable(True)
            button.setMinimumHeight(look().control)
            button.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)
            button.setProperty("role", "segment")
            button.setAutoDefault(False)
            self.group.addButton(button)
            self.buttons[key] = button
            button.toggled.connect(self._toggled)
            button.walked.connect(lambda by, key=key: self._walk(key, by))
        row_of(self, *self.buttons.values(), space=4).addStretch(1)

    def focus_target(self) -> Segment:
        """The button the cursor goes to: the first that is on, else the first."""
        shown = list(self.buttons.values())
        return next((button for button in shown if button.isChecked()), shown[0])

    def chosen(self) -> list[Any]:
        """The words that are on, in order."""
        return [key for key, button in self.buttons.items() if button.isChecked()]

    def choose(self, keys: Sequence[Any]) -> None:
        """Switches exactly these on, without saying so."""
        exclusive = self.group.exclusive()
        self.group.setExclusive(False)
        for key, button in self.buttons.items():
            button.blockSignals(True)
            button.setChecked(key in keys)
            button.blockSignals(False)
        self.group.setExclusive(exclusive)
        if exclusive:  # Tab stops at the word that is on, arrows reach the others
            stop = self.focus_target()
            for button in self.buttons.values():
                policy = Qt.FocusPolicy.StrongFocus if button is stop else Qt.FocusPolicy.ClickFocus
                button.setFocusPolicy(policy)

    def _walk(self, key: Any, by: int) -> None:
        """The neighbour takes the focus; where only one can be on, it goes on."""
        keys = list(self.buttons)
        neighbour = self.buttons[keys[(keys.index(key) + by) % len(keys)]]
        neighbour.setFocus(Qt.FocusReason.TabFocusReason)
        if self.group.exclusive():
            neighbour.setChecked(True)

    def _toggled(self, on: bool) -> None:
        if on or not self.group.exclusive():
            self._say()

    def _say(self) -> None:
        raise NotImplementedError


def row_of(owner: QWidget, *widgets: QWidget, space: int = 8) -> QHBoxLayout:
    """Lays widgets side by side into `owner`."""
    row = QHBoxLayout(owner)
    row.setContentsMargins(0, 0, 0, 0)
    row.setSpacing(space)
    for widget in widgets:
        row.addWidget(widget)
    return row
