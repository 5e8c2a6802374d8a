"""A table of numbers that are only read: Ctrl+C copies it as text."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QGuiApplication, QKeyEvent
from PySide6.QtWidgets import QAbstractItemView, QTableWidget, QTableWidgetItem, QWidget

from widgets.parts.look import look

LEAST = 22  # px: height of a row


class Table(QTableWidget):
    """What the tables of the scope have in common; `words` is theirs."""

    def __init__(self, rows: int, columns: int, name: str, parent: QWidget | None = None) -> None:
        super().__init__(rows, columns, parent)
        self.setAccessibleName(name)
        self.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.setAlternatingRowColors(True)
        self.setShowGrid(False)
        self.setWordWrap(False)
        self.verticalHeader().setMinimumSectionSize(LEAST)
        self.horizontalHeader().setHighlightSections(False)

    def words(self) -> str:
        """The table as text, for the clipboard."""
        raise NotImplementedError

    def text(self, row: int, column: int) -> str:
        """What stands there."""
        item = self.item(row, column)
        return item.text() if item is not None else ""

    def write(self, row: int, column: int, text: str) -> None:
        """A number, or a word; Qt is told only of what has changed."""
        item = self.item(row, column)
        if item is None:
            item = QTableWidgetItem()
            item.setTextAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
            item.setFont(look().digits_font(look().body_points))
            self.setItem(row, column, item)
        if item.text() != text:
            item.setText(text)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() == Qt.Key.Key_C and event.modifiers() == Qt.KeyboardModifier.ControlModifier:
            QGuiApplication.clipboard().setText(self.words())
            return
        super().keyPressEvent(event)
