"""The bar that finds words in the program and replaces them; above the program, opened by Ctrl+F and Ctrl+H."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QFrame,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from widgets.parts.icons import icon
from widgets.parts.look import look

PLACES = {"both": "English and code", "english": "English", "code": "Code"}


class FindBar(QFrame):
    """Emits what is wanted; the program view searches."""

    changed = Signal()  # text, place or whole words
    step = Signal(int)  # 1 = the next one, -1 = the one before
    replace_wanted = Signal(bool)  # all of them
    closed = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setProperty("role", "card")
        self.setAccessibleName("Find and replace")
        self.setProperty("helpPage", "Program window")
        self.text = self._line("Find", "Find in the program")
        self.by = self._line("Replace with", "Replace with")
        self.place = QComboBox()
        self.place.setAccessibleName("Search in")
        self.place.setMinimumHeight(look().control)
        for key, words in PLACES.items():
            self.place.addItem(words, key)
        self.words = QCheckBox("Whole words")
        self.words.setToolTip("“5” is then not found in “50”")
        self.words.setChecked(True)
        self.said = QLabel()
        self.said.setProperty("role", "quiet")
        self.previous = self._button("", "up", "The one before (Shift+F3)", lambda: self.step.emit(-1))
        self.next = self._button("", "down", "The next one (F3, Enter)", lambda: self.step.emit(1))
        self.close_button = self._button("", "close", "Close (Esc)", self.closed.emit)
        self.one = self._button("Replace", "", "Replaces in the selected step", lambda: self.replace_wanted.emit(False))
        self.all = self._button("Replace all", "", "Replaces everywhere; one Undo takes it back", self._all)
        self._lay_out()
        self.text.textChanged.connect(lambda _: self.changed.emit())
        self.text.returnPressed.connect(lambda: self.step.emit(1))
        self.by.returnPressed.connect(lambda: self.replace_wanted.emit(False))
        self.place.currentIndexChanged.connect(lambda _: self.changed.emit())
        self.words.toggled.connect(lambda _: self.changed.emit())
        self.hide()

    def open(self, *, replacing: bool) -> None:
        """Shows the bar, with the line for replacing or without it."""
        self.replacing.setVisible(replacing)
        self.show()
        self.text.setFocus()
        self.text.selectAll()

    def show_found(self, words: str, *, can_replace: bool) -> None:
        """How many there are, or what came of it."""
        self.said.setText(words)
        for button in (self.previous, self.next, self.one, self.all):
            button.setEnabled(can_replace)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Escape closes."""
        if event.key() == Qt.Key.Key_Escape:
            self.closed.emit()
        else:
            super().keyPressEvent(event)

    # ---- inside

    def _all(self) -> None:
        self.replace_wanted.emit(True)

    def _lay_out(self) -> None:
        first, second = QHBoxLayout(), QHBoxLayout()
        for widget in (self.text, self.place, self.words, self.previous, self.next, self.close_button):
            first.addWidget(widget)
        first.setStretchFactor(self.text, 1)
        self.replacing = QWidget()
        self.replacing.setLayout(second)
        second.setContentsMargins(0, 0, 0, 0)
        for widget in (self.by, self.one, self.all):
            second.addWidget(widget)
        second.setStretchFactor(self.by, 1)
        column = QVBoxLayout(self)
        column.setContentsMargins(8, 4, 4, 4)
        column.setSpacing(4)
        column.addLayout(first)
        column.addWidget(self.replacing)
        column.addWidget(self.said)

    def _line(self, name: str, hint: str) -> QLineEdit:
        line = QLineEdit()
        line.setAccessibleName(name)
        line.setPlaceholderText(hint)
        line.setMinimumHeight(look().control)
        line.setClearButtonEnabled(True)
        return line

    def _button(self, text: str, picture: str, tip: str, action: Callable[[], None]) -> QPushButton:
        button = QPushButton(icon(picture), text) if picture else QPushButton(text)
        button.setMinimumHeight(look().control)
        button.setAutoDefault(False)
        button.setToolTip(tip)
        button.setAccessibleName(text or tip)
        button.clicked.connect(lambda: action())
        return button
