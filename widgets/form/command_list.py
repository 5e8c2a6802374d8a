"""Beside hand-written code: all commands of the controller, to search, read about and put in."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QLabel, QLineEdit, QListWidget, QListWidgetItem, QVBoxLayout, QWidget

from codegen.instructions import Instruction
from codegen.models import model
from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.rows import Row
from widgets.form.offers import Offers
from widgets.parts.look import look

NAME = Qt.ItemDataRole.UserRole


class CommandList(QWidget):
    """Enter or a double click emits the example of the marked command."""

    picked = Signal(str)

    def __init__(self, offers: Offers, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.search = QLineEdit()
        self.search.setPlaceholderText("Search commands")
        self.search.setAccessibleName("Search commands")
        self.search.setMinimumHeight(look().control)
        self.search.textChanged.connect(self._filter)
        self.list = QListWidget()
        self.list.setAccessibleName("Commands")
        self.list.setMinimumHeight(look().control * 4)
        self.list.currentItemChanged.connect(lambda item, _: self._show(item))
        self.list.itemActivated.connect(lambda item: self.picked.emit(COMMANDS[item.data(NAME)].example))
        self.about = QLabel("Pick a command to read about it; Enter puts its example into the code.")
        self.about.setWordWrap(True)
        self.about.setProperty("role", "quiet")
        self.about.setMinimumHeight(96)
        self.about.setAlignment(Qt.AlignmentFlag.AlignTop)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        for widget in (self.search, self.list, self.about):
            column.addWidget(widget)
        family = model(offers.setup.model).family
        for name, row in COMMANDS.items():
            if row.program and family in row.families:
                item = QListWidgetItem(f"{name}   {row.title}")
                item.setData(NAME, name)
                self.list.addItem(item)
        self.list.setMinimumWidth(self.list.sizeHintForColumn(0) + 24)  # and a scroll bar

    def show_instruction(self, instruction: Instruction) -> None:
        """The list does not depend on what is typed."""

    def _show(self, item: QListWidgetItem | None) -> None:
        if item is not None:
            self.about.setText(_words(COMMANDS[item.data(NAME)]))

    def _filter(self, text: str) -> None:
        words = text.lower().split()
        first: QListWidgetItem | None = None
        for number in range(self.list.count()):
            item = self.list.item(number)
            row = COMMANDS[item.data(NAME)]
            everything = f"{item.text()} {row.help}".lower()
            item.setHidden(not all(word in everything for word in words))
            exact = item.data(NAME).lower() == text.lower().strip()
            if not item.isHidden() and (first is None or exact):
                first = item
        if words and first is not None:
            self.list.setCurrentItem(first)


def _words(row: Row) -> str:
    return f"{row.help}\nTakes: {row.takes.value}\nExample: {row.example}"
