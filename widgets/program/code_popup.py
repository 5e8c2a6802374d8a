"""View Code: the two-letter lines of one step, with their numbers."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeySequence, QShortcut
from PySide6.QtWidgets import QDialog, QLabel, QPushButton, QVBoxLayout, QWidget

from codegen.program import Step
from widgets.parts.foot import foot
from widgets.parts.look import look
from widgets.program.words import Words


class CodePopup(QDialog):
    """Small and not modal; Escape or Ctrl+D again closes it."""

    def __init__(self, words: Words, step: Step, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setModal(False)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle("Code")
        self.setProperty("helpPage", step.instruction.title)
        sentence = QLabel(words.english(step))
        sentence.setProperty("role", "sentence")
        sentence.setWordWrap(True)
        self.code = QLabel("\n".join(_numbered(words, step)) or _reason(words, step))
        self.code.setProperty("role", "code")
        self.code.setFont(look().code_font())
        self.code.setTextInteractionFlags(
            Qt.TextInteractionFlag.TextSelectableByMouse | Qt.TextInteractionFlag.TextSelectableByKeyboard
        )
        self.code.setAccessibleName("Code of the step")
        close = QPushButton("Close")
        close.setMinimumHeight(look().control)
        close.clicked.connect(self.accept)
        column = QVBoxLayout(self)
        column.setContentsMargins(16, 16, 16, 16)
        column.setSpacing(12)
        for widget in (sentence, self.code):
            column.addWidget(widget)
        column.addWidget(foot(away=close))
        self.setMinimumWidth(360)
        QShortcut(QKeySequence("Ctrl+D"), self, activated=self.accept)
        close.setFocus()


def _numbered(words: Words, step: Step) -> list[str]:
    listing = words.listing
    if listing is None or not step.enabled:
        return []
    return [f"{number:>4}  {listing.lines[number].text}" for number in words.lines_of(step.id)]


def _reason(words: Words, step: Step) -> str:
    if not step.enabled:
        return "Commented out: it adds no code."
    return words.problem(step) or "It adds no code."
