"""Replacing a controller: the steps in their order, each with what it needs and a button where the studio can help."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QDialog, QGridLayout, QLabel, QPushButton, QVBoxLayout, QWidget

from widgets.panel import set_text
from widgets.parts.foot import foot
from widgets.parts.look import look


@dataclass(frozen=True)
class ReplaceStep:
    """What is to be done, and the button that does it (or none)."""

    words: str
    button: str = ""


STEPS = (
    ReplaceStep("If the old controller still answers, back it up first. Else take the newest back-up of it, or a file.",
                "Back up now"),
    ReplaceStep("Switch the machine off and secure it. Note the jumpers and address switches of the old controller, "
                "set the new one alike, and move the plugs over."),
    ReplaceStep("Switch on with the drives disabled and the emergency stop pressed, then connect.", "Connect…"),
    ReplaceStep("Restore the back-up. Another model is refused with what does not fit; the motors stay off.",
                "Restore…"),
    ReplaceStep("Release the emergency stop. With a low torque limit, check that each motor turns the right way and "
                "stops at its limit switches; then set the torque limit back."),
    ReplaceStep("Home the machine, run the program slowly, then burn it; write the setup to the EEPROM. "
                "Only what is burned is there after the next power-up.", "Burn…"),
    ReplaceStep("Compare file, controller and EEPROM, and take a fresh back-up with a note.", "Compare…"),
)  # fmt: skip


WIDTH = 472  # px of the words


class Replacing(QDialog):
    """Not modal: the list stays open beside everything else."""

    pressed = Signal(str)  # the text of a button

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle("Replace controller")
        self.setProperty("helpPage", "Back up, restore, replace")
        self.setModal(False)
        self.state = QLabel()
        self.state.setWordWrap(True)
        self.state.setProperty("role", "note")
        heading = QLabel("From the old controller to a new one that does the same")
        heading.setProperty("role", "title")
        grid = QGridLayout()
        grid.setHorizontalSpacing(16)
        grid.setVerticalSpacing(12)
        grid.setColumnStretch(1, 1)
        self.buttons: dict[str, QPushButton] = {}
        for number, step in enumerate(STEPS):
            self._add(grid, number, step)
        shut = QPushButton("Close")
        shut.setAutoDefault(False)
        shut.clicked.connect(self.accept)
        column = QVBoxLayout(self)
        column.setContentsMargins(24, 16, 24, 16)
        column.setSpacing(16)
        column.addWidget(heading)
        column.addWidget(self.state)
        column.addLayout(grid)
        column.addWidget(foot(away=shut))
        self.setMinimumWidth(680)

    def show_state(self, words: str, reasons: dict[str, str]) -> None:
        """Which back-up and which controller it is about, and which buttons are grey, with the reason."""
        set_text(self.state, words)
        for text, button in self.buttons.items():
            reason = reasons.get(text, "")
            button.setEnabled(not reason)
            button.setToolTip(reason)

    def texts(self) -> Sequence[str]:
        """The steps as they are shown."""
        return [step.words for step in STEPS]

    def _add(self, grid: QGridLayout, number: int, step: ReplaceStep) -> None:
        words = QLabel(step.words)
        words.setWordWrap(True)
        words.setFixedSize(WIDTH, words.heightForWidth(WIDTH) + 8)  # a grid reckons with too few lines
        grid.addWidget(QLabel(str(number + 1)), number, 0, Qt.AlignmentFlag.AlignTop)
        words.setAlignment(Qt.AlignmentFlag.AlignTop)
        grid.addWidget(words, number, 1)
        if step.button:
            button = QPushButton(step.button)
            button.setMinimumHeight(look().control)
            button.setAutoDefault(False)
            button.clicked.connect(lambda: self.pressed.emit(step.button))
            self.buttons[step.button] = button
            grid.addWidget(button, number, 2, Qt.AlignmentFlag.AlignTop)
