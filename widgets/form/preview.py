"""What an instruction will add: the sentence in plain English and the code beneath it."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QLabel, QVBoxLayout, QWidget

from widgets.form.cell import unbroken
from widgets.parts.look import look

UNBROKEN = 40  # characters
SHOWN = 8  # lines of code; more are counted


class Preview(QFrame):
    """A card with sentence and code, live while the form is filled in."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setProperty("role", "card")
        self.sentence = QLabel()
        self.sentence.setProperty("role", "sentence")
        self.sentence.setWordWrap(True)
        self.sentence.setAccessibleName("Sentence")
        self.code = QLabel()
        self.code.setProperty("role", "code")
        self.code.setFont(look().code_font())
        self.code.setWordWrap(True)
        self.code.setAccessibleName("Code")
        self.reason = QLabel()
        self.reason.setProperty("role", "quiet")
        self.reason.setWordWrap(True)
        self.advice = QLabel()
        self.advice.setProperty("role", "warning")
        self.advice.setWordWrap(True)
        self.advice.setAccessibleName("Advice")
        for label in (self.sentence, self.code, self.reason, self.advice):
            label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
            label.setTextFormat(Qt.TextFormat.PlainText)
        column = QVBoxLayout(self)
        column.setContentsMargins(12, 8, 12, 8)
        column.setSpacing(4)
        column.addWidget(self.sentence)
        column.addWidget(self.code)
        column.addWidget(self.reason)
        column.addWidget(self.advice)
        self.setMinimumHeight(64)

    def show_words(self, sentence: str, code: Sequence[str], problem: str, advice: Sequence[str] = ()) -> None:
        """Sentence and code; while something is wrong, a word on why there is no code; what to think of besides."""
        self.advice.setText("\n".join(f"△ {unbroken(each)}" for each in advice))
        self.advice.setVisible(bool(advice))
        self.sentence.setText(unbroken(sentence))
        self.code.setText("   ".join(map(_whole, code)) if len(code) <= SHOWN else _shortened(code))
        self.reason.setText(f"No code yet: {problem}" if problem else "" if code else "It adds no code.")
        self.code.setVisible(bool(code) and not problem)
        self.reason.setVisible(bool(self.reason.text()))


def _whole(line: str) -> str:
    """A line of code is not broken at its spaces, unless it is long."""
    return line.replace(" ", "\N{NO-BREAK SPACE}") if len(line) <= UNBROKEN else line


def _shortened(code: Sequence[str]) -> str:
    return "   ".join(map(_whole, code[:SHOWN])) + f"   … {len(code)} lines in all"
