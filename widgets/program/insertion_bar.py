"""A line above the program that says where new steps go, when that is not the end, and the way back."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QPushButton, QSizePolicy, QWidget

from codegen.instructions import Subroutine
from codegen.program import end_of, find
from widgets.parts.look import look
from widgets.program.model import ProgramModel
from widgets.program.words import Words

if TYPE_CHECKING:
    from widgets.program.editing import Editing


class InsertionBar(QFrame):
    """Hidden while new steps simply go to the end."""

    left = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setProperty("role", "card")
        self.text = QLabel()
        self.text.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        self.button = QPushButton("Back to the end (Ctrl+Enter)")
        self.button.setMinimumHeight(look().control)
        self.button.clicked.connect(self.left)
        row = QHBoxLayout(self)
        row.setContentsMargins(12, 4, 4, 4)
        row.addWidget(self.text, 1)
        row.addWidget(self.button)
        self.hide()

    def show_text(self, text: str) -> None:
        """Shows the sentence; an empty one hides the bar."""
        self.text.setText(text)
        self.text.setToolTip(text)


def next_place(session: Editing, model: ProgramModel, words: Words) -> tuple[str, tuple[str, str]]:
    """Where new steps go when it is not the end: in words, and the row with the side of it that is marked."""
    name = session.before or session.open_body
    if name is None or name not in model.nodes:
        return "", ("", "")
    node, step = model.nodes[name], find(session.document.program, name)
    holds = session.before is None or isinstance(step.instruction, Subroutine)
    text = f"New steps go {'inside' if holds else 'before'}: {words.english(step)}"
    at = end_of(step).index if holds else 0
    if holds and at == len(node.children):
        return text, ("after", model.visible_of(node.children[-1].id if at else name))
    return text, ("before", model.visible_of(node.children[at].id if holds else name))
