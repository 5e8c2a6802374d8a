"""The box of a program that waits for an answer (IN): only what is typed here, and STOP, is sent."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QLineEdit, QPushButton, QWidget

from widgets.panel import set_text
from widgets.parts.look import look

if TYPE_CHECKING:
    from device.api import Prompt


class PromptBox(QFrame):
    """Hidden until a prompt is pending; never steals the focus from a running edit."""

    answered = Signal(str)
    not_waiting = Signal()  # the person says that nothing is waiting

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._prompt: Prompt | None = None
        self.setProperty("role", "card")
        self.text, self.line = QLabel(), QLineEdit()
        self.send, self.deny = QPushButton("Answer"), QPushButton("It is not waiting")
        self.text.setWordWrap(True)
        self.line.setAccessibleName("Answer to the program")
        self.line.setPlaceholderText("Number or text; empty keeps the old value")
        self.line.setFont(look().code_font())
        self.line.setMaximumWidth(280)
        self.send.setProperty("role", "primary")
        self.deny.setToolTip("Go on reading live values: I know that no program waits for an answer.")
        row = QHBoxLayout(self)
        row.setContentsMargins(12, 8, 12, 8)
        row.addWidget(self.text, 1)
        row.addWidget(self.line)
        row.addWidget(self.send)
        row.addWidget(self.deny)
        self.line.returnPressed.connect(self._answer)
        self.send.clicked.connect(self._answer)
        self.deny.clicked.connect(self.not_waiting)
        self.hide()

    def show_prompt(self, prompt: Prompt | None) -> None:
        """The pending question, or None."""
        if prompt == self._prompt:
            return
        self._prompt = prompt
        if prompt is not None:
            asked = prompt.text.strip() or "(no text)"
            where = f" (line {', '.join(str(line) for line in prompt.lines)})" if prompt.lines else ""
            set_text(self.text, f"The program asks{where}:  {asked}")
            self.line.clear()
        self.setVisible(prompt is not None)

    def _answer(self) -> None:
        if self._prompt is not None:
            self.answered.emit(self.line.text())
            self.line.clear()
