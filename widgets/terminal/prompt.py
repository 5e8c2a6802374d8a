"""The box of a program that waits for an answer (IN): only what is typed here, and STOP, is sent."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QFrame, QGridLayout, QLabel, QLineEdit, QPushButton, QWidget

from widgets.panel import set_text, show_role
from widgets.parts.look import look
from widgets.terminal.answers import Asked, answer_problem, answer_sent

if TYPE_CHECKING:
    from device.api import Prompt

UNKNOWN = "Number or text; empty keeps the old value"
STOPPED = "STOP was pressed: this question is not answered any more."


class PromptBox(QFrame):
    """Hidden until a prompt is pending; never steals the focus from a running edit."""

    answered = Signal(str)
    not_waiting = Signal()  # the person says that nothing is waiting

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._prompt: Prompt | None = None
        self._asked: Asked | None = None
        self._withdrawn: Prompt | None = None
        self.setProperty("role", "card")
        self.text, self.line, self.problem = QLabel(), QLineEdit(), QLabel()
        self.send, self.deny = QPushButton("Answer"), QPushButton("It is not waiting")
        self.text.setWordWrap(True)
        self.problem.setWordWrap(True)
        self.problem.setProperty("role", "problem")
        self.problem.hide()
        self.line.setAccessibleName("Answer to the program")
        self.line.setPlaceholderText(UNKNOWN)
        self.line.setFont(look().code_font())
        self.line.setMinimumWidth(240)
        self.send.setProperty("role", "primary")
        self.deny.setToolTip("Go on reading live values: I know that no program waits for an answer.")
        grid = QGridLayout(self)
        grid.setContentsMargins(12, 8, 12, 8)
        grid.addWidget(self.text, 0, 0, 1, 3)
        for column, widget in enumerate((self.line, self.send, self.deny)):
            grid.addWidget(widget, 1, column)
        grid.addWidget(self.problem, 2, 0, 1, 3)
        grid.setColumnStretch(0, 1)
        self.line.returnPressed.connect(self._answer)
        self.line.textChanged.connect(self._check)
        self.send.clicked.connect(self._answer)
        self.deny.clicked.connect(self.not_waiting)
        self.hide()

    def show_prompt(self, prompt: Prompt | None, asked: Asked | None = None) -> None:
        """The pending question, or None; `asked`: what it takes, as far as known."""
        if prompt is self._prompt:
            return
        again, self._prompt, self._asked = prompt == self._prompt and self._withdrawn is None, prompt, asked
        self._withdrawn = None
        if prompt is not None and not again:
            where = f" (line {', '.join(str(line) for line in prompt.lines)})" if prompt.lines else ""
            set_text(self.text, f"The program asks{where}:  {prompt.text.strip() or '(no text)'}")
            self.line.clear()
        self.line.setPlaceholderText(asked.words if asked is not None else UNKNOWN)
        self._check()
        self.setVisible(prompt is not None)

    def withdraw(self) -> None:
        """STOP was pressed: the question that is shown is never answered, also where the stop is not confirmed."""
        if self._prompt is not None and self._withdrawn is not self._prompt:
            self._withdrawn = self._prompt
            self.line.clear()
            self._check()

    @property
    def withdrawn(self) -> bool:
        """Whether the question that is shown was there when STOP was pressed."""
        return self._prompt is not None and self._withdrawn is self._prompt

    def _check(self) -> None:
        """Says what is wrong with the answer as it is typed."""
        problem = STOPPED if self.withdrawn else answer_problem(self.line.text(), self._asked)
        set_text(self.problem, problem)
        self.problem.setVisible(bool(problem))
        self.line.setEnabled(not self.withdrawn)
        self.send.setEnabled(not problem)
        self.send.setToolTip(problem or "Sends the answer (Enter)")
        show_role(self.line, "problem" if problem and not self.withdrawn else "")

    def _answer(self) -> None:
        if self._prompt is not None and self.send.isEnabled():
            text = answer_sent(self.line.text(), self._asked)
            self.line.clear()
            self.answered.emit(text)
