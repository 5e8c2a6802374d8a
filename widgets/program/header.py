"""Name and description of the program, edited in place, and the switch Program | Both | Code."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QButtonGroup, QHBoxLayout, QLabel, QLineEdit, QPushButton, QWidget

from codegen.program import Program
from widgets.parts.look import look

MODES = {"program": "Program", "both": "Both", "code": "Code"}


class Header(QWidget):
    """Emits what was typed."""

    named = Signal(str)
    described = Signal(str)
    mode_chosen = Signal(str)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.name = self._line("Program name", "Name of the program", 160)
        self.label = QLabel()
        self.label.setProperty("role", "code")
        self.label.setFont(look().code_font())
        self.label.setToolTip("The label the controller knows the program by: the first seven letters and digits")
        self.description = self._line("Description", "What it does, for the reader", 0)
        self.name.textEdited.connect(self.named)
        self.description.textEdited.connect(self.described)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(8)
        row.addWidget(self.name)
        row.addWidget(self.label)
        row.addWidget(self.description, 1)
        row.setStretchFactor(self.name, 1)
        switch = QHBoxLayout()
        switch.setSpacing(4)
        row.addLayout(switch)
        self.group = QButtonGroup(self)
        self.modes: dict[str, QPushButton] = {}
        for mode, words in MODES.items():
            button = QPushButton(words)
            button.setCheckable(True)
            button.setProperty("role", "segment")
            button.setMinimumHeight(look().control)
            button.setAccessibleName(f"Show {words.lower()}")
            button.clicked.connect(lambda _=False, mode=mode: self.mode_chosen.emit(mode))
            self.group.addButton(button)
            self.modes[mode] = button
            switch.addWidget(button)

    def show_program(self, program: Program, label: str) -> None:
        """Shows name, label and description; what is being typed stays."""
        if program.name != self.name.text():
            self.name.setText(program.name)
        if program.description != self.description.text():
            self.description.setText(program.description)
            self.description.setCursorPosition(0)
        if label != self.label.text():
            self.label.setText(label)

    def show_mode(self, mode: str) -> None:
        """Which of the three is on."""
        self.modes[mode].setChecked(True)

    def _line(self, name: str, hint: str, width: int) -> QLineEdit:
        line = QLineEdit()
        line.setAccessibleName(name)
        line.setPlaceholderText(hint)
        line.setToolTip(hint)
        line.setMinimumHeight(look().control)
        if width:
            line.setMaximumWidth(width)
        line.setMinimumWidth(88 if width else 28)
        return line
