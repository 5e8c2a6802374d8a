"""Limit and home switches, motor and following error, axis by axis, each in a word."""

from __future__ import annotations

from PySide6.QtWidgets import QGridLayout, QLabel, QWidget

from widgets.display.readings import Switches
from widgets.panel import set_text, show_role

HEADS = ("Forward limit", "Reverse limit", "Home", "Motor", "Error")


class SwitchTable(QWidget):
    """One column an axis; `show_axis` is its setter."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._grid = QGridLayout(self)
        self._grid.setContentsMargins(8, 0, 0, 0)
        self._grid.setHorizontalSpacing(12)
        self._grid.setVerticalSpacing(4)
        self._cells: dict[str, tuple[QLabel, ...]] = {}
        self._shown: dict[str, Switches] = {}
        for row, head in enumerate(HEADS, start=1):
            label = QLabel(head)
            label.setProperty("role", "quiet")
            self._grid.addWidget(label, row, 0)

    def show_axes(self, letters: str) -> None:
        """Which axes there are."""
        for letter in tuple(self._cells):
            if letter not in letters:
                for label in self._cells.pop(letter):
                    label.hide()
                    label.deleteLater()
                self._shown.pop(letter, None)
        for column, letter in enumerate(letters, start=1):
            if letter not in self._cells:
                cells = tuple(QLabel(letter if row == 0 else "?") for row in range(len(HEADS) + 1))
                for row, label in enumerate(cells):
                    self._grid.addWidget(label, row, column)
                self._cells[letter] = cells
            self._grid.setColumnStretch(column, 1)

    def show_axis(self, letter: str, switches: Switches) -> None:
        """The words of one axis."""
        if self._shown.get(letter) == switches:
            return
        self._shown[letter] = switches
        words = (
            letter,
            _word(switches.forward, "! at limit", "○ free"),
            _word(switches.reverse, "! at limit", "○ free"),
            _word(switches.home, "● 1", "○ 0"),
            _word(switches.motor_on, "● on", "○ off"),
            _word(switches.error, "! too large", "○ none"),
        )
        for label, word in zip(self._cells[letter], words, strict=True):
            set_text(label, word)
            show_role(label, "fault" if word.startswith("!") else "quiet" if switches.stale else "")

    def words(self, letter: str) -> tuple[str, ...]:
        """What the column says now."""
        return tuple(label.text() for label in self._cells[letter])


def _word(value: bool | None, yes: str, no: str) -> str:
    return "?" if value is None else yes if value else no
