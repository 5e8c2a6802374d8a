"""A line above the program that says where new steps go, when that is not the end, and the way back."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QPushButton, QSizePolicy, QWidget

from widgets.parts.look import look


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
