"""All unsaved work that was left behind: one line each, to recover or to throw away."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QSize, Signal
from PySide6.QtWidgets import (
    QDialog,
    QLabel,
    QListWidget,
    QListWidgetItem,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from widgets.parts.foot import foot

WORDS = (
    "This work was not saved when the studio ended unexpectedly. Recover opens it, still unsaved; "
    "the rest stays in this list and is offered again at the next start."
)

HEIGHT = 32  # px of a line


class UnsavedWork(QDialog):
    """Not modal. What is chosen goes up by its place in the list; the owner shows what is left."""

    recover_wanted = Signal(int)
    forget_wanted = Signal(int)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle("Recover unsaved work?")
        self.setModal(False)
        self.setProperty("helpPage", "Program window#Work that was not saved")
        heading, words = QLabel("Recover unsaved work?"), QLabel(WORDS)
        heading.setProperty("role", "title")
        words.setWordWrap(True)
        self.list = QListWidget()
        self.list.setAccessibleName("Unsaved work, newest first")
        self.recover, self.forget, self.later = QPushButton("Recover"), QPushButton("Throw away"), QPushButton("Later")
        self.recover.setProperty("role", "primary")
        self.recover.setDefault(True)
        self.forget.setToolTip("Asks first: what is thrown away cannot be brought back.")
        self.recover.clicked.connect(lambda: self.recover_wanted.emit(self.list.currentRow()))
        self.list.itemActivated.connect(lambda _: self.recover_wanted.emit(self.list.currentRow()))
        self.forget.clicked.connect(lambda: self.forget_wanted.emit(self.list.currentRow()))
        self.later.clicked.connect(self.reject)
        column = QVBoxLayout(self)
        column.setContentsMargins(24, 24, 24, 16)
        column.setSpacing(12)
        for widget in (heading, words, self.list):
            column.addWidget(widget)
        column.addWidget(foot(self.recover, away=self.later, left=(self.forget,)))
        self.resize(640, 360)

    def show_work(self, lines: Sequence[str]) -> None:
        """What there is, newest first; closes when nothing is left."""
        row = max(0, min(self.list.currentRow(), len(lines) - 1))
        self.list.clear()
        for line in lines:
            item = QListWidgetItem(line)
            item.setSizeHint(QSize(0, HEIGHT))
            item.setToolTip(line)  # a long path is cut
            self.list.addItem(item)
        self.list.setCurrentRow(row)
        if not lines:
            self.accept()
