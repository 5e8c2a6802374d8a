"""Limit and home switches, motor, torque and latch, axis by axis, each in a word; and the error output of them all."""

from __future__ import annotations

from PySide6.QtWidgets import QGridLayout, QLabel, QWidget

from widgets.display.readings import Drive, Switches, error_output
from widgets.panel import set_text, show_role

HEADS = ("Forward limit", "Reverse limit", "Home", "Motor", "Amplifier", "Torque, V", "Error", "Latch", "Error output")
TIPS = {
    "Amplifier": "What the controller asks of the amplifier (AEN): on while the motor is on.",
    "Torque, V": "The motor command (TT), V.",
    "Error": "Whether the position error is above ER.",
    "Latch": "Off, armed, or tripped with the place it caught.",
    "Error output": "One line of the controller; it goes low while an axis has a position error above ER.",
}
BARE = Switches(), Drive()


class SwitchTable(QWidget):
    """One column an axis; `show_axis` is its setter."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._grid = QGridLayout(self)
        self._grid.setContentsMargins(8, 0, 0, 0)
        self._grid.setHorizontalSpacing(12)
        self._grid.setVerticalSpacing(4)
        self._cells: dict[str, tuple[QLabel, ...]] = {}
        self._shown: dict[str, tuple[Switches, Drive]] = {}
        self.output = QLabel("?")
        self.output.setToolTip(TIPS["Error output"])
        for row, head in enumerate(HEADS, start=1):
            label = QLabel(head)
            label.setProperty("role", "quiet")
            label.setToolTip(TIPS.get(head, ""))
            self._grid.addWidget(label, row, 0)
        self._grid.addWidget(self.output, len(HEADS), 1, 1, -1)

    @property
    def letters(self) -> str:
        """The axes that have a column."""
        return "".join(letter for letter in "XYZW" if letter in self._cells)

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
                cells = tuple(QLabel(text) for text in (letter, *("?" for _ in HEADS[:-1])))
                for row, label in enumerate(cells):
                    self._grid.addWidget(label, row, column)
                self._cells[letter] = cells
            self._grid.setColumnStretch(column, 1)

    def show_axis(self, letter: str, switches: Switches, drive: Drive = BARE[1]) -> None:
        """The words of one axis."""
        if self._shown.get(letter) == (switches, drive):
            return
        self._shown[letter] = switches, drive
        old = switches.stale
        words = (
            (letter, old),
            (_word(switches.forward, "! at limit", "○ free"), old),
            (_word(switches.reverse, "! at limit", "○ free"), old),
            (_word(switches.home, "● 1", "○ 0"), old),
            (_word(switches.motor_on, "● on", "○ off"), old),
            (_word(switches.motor_on, "● on", "○ off"), old),
            (drive.torque, drive.torque_stale),
            (_word(switches.error, "! too large", "○ none"), old),
            (drive.latch, drive.latch_stale),
        )
        for label, (word, stale) in zip(self._cells[letter], words, strict=True):
            _put(label, word, stale)
        self._show_output()

    def words(self, letter: str) -> tuple[str, ...]:
        """What the column says now."""
        return tuple(label.text() for label in self._cells[letter])

    def _show_output(self) -> None:
        each = [self._shown.get(letter, BARE)[0] for letter in self._cells]
        _put(self.output, _word(error_output(each), "! on (low)", "○ off"), any(switches.stale for switches in each))


def _put(label: QLabel, word: str, stale: bool) -> None:
    set_text(label, word)
    show_role(label, "fault" if word.startswith("!") and not stale else "quiet" if stale else "")


def _word(value: bool | None, yes: str, no: str) -> str:
    return "?" if value is None else yes if value else no
