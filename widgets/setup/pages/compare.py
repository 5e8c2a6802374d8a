"""Setup and controller side by side: every value that differs, and which of the two counts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from enum import StrEnum

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QComboBox, QHBoxLayout, QHeaderView, QPushButton, QTableWidget, QTableWidgetItem, QWidget

from codegen.setup_differences import Difference, Key
from widgets.parts.look import look
from widgets.setup.pages.page import Page, Shown, say


class Choice(StrEnum):
    """What happens with a value that differs."""

    LEAVE = "leave"
    SEND = "send"
    TAKE = "take"


CHOICE_WORDS = {
    Choice.LEAVE: "Leave both",
    Choice.SEND: "Send the setup's",
    Choice.TAKE: "Take the controller's",
}
HEADS = ("Axis", "Setting", "In this setup", "In the controller", "With Done")
NOT_READ = (
    "Nothing was read yet. “Setup from controller” reads what a connected controller holds; it changes nothing there."
)


def choices_of(row: Difference) -> tuple[Choice, ...]:
    """What can be chosen for a value."""
    send = (Choice.SEND,) if row.states else ()
    take = (Choice.TAKE,) if row.tells else ()
    return (Choice.LEAVE, *send, *take)


class ComparePage(Page):
    """A table of what differs. `chosen` carries key and choice, `all_chosen` a choice for every row."""

    title = "Controller values"
    help_page = "Setup: Controller values"
    chosen = Signal(object, object)
    all_chosen = Signal(object)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.said = self.words("")
        self.table = QTableWidget(0, len(HEADS))
        self.table.setAccessibleName("Values that differ between setup and controller")
        self.table.setHorizontalHeaderLabels(list(HEADS))
        self.table.setEditTriggers(QTableWidget.EditTrigger.NoEditTriggers)
        self.table.setSelectionBehavior(QTableWidget.SelectionBehavior.SelectRows)
        self.table.setTabKeyNavigation(False)
        self.table.verticalHeader().hide()
        self.table.verticalHeader().setDefaultSectionSize(look().control + 16)
        header = self.table.horizontalHeader()
        header.setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        header.setDefaultAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        for column in (2, 3):
            header.setSectionResizeMode(column, QHeaderView.ResizeMode.Stretch)
        self.table.setMinimumHeight(320)
        self.boxes: dict[Key, QComboBox] = {}
        self.send_all, self.take_all = QPushButton("Send all of the setup"), QPushButton("Take all from the controller")
        self.leave_all = QPushButton("Leave all")
        bar = QHBoxLayout()
        for button, choice in (
            (self.take_all, Choice.TAKE),
            (self.send_all, Choice.SEND),
            (self.leave_all, Choice.LEAVE),
        ):
            button.clicked.connect(lambda _=False, choice=choice: self.all_chosen.emit(choice))
            bar.addWidget(button)
        bar.addStretch(1)
        self.column.addLayout(bar)
        self.column.addWidget(self.table, 1)
        self._rows: tuple[Difference, ...] = ()

    def refresh(self, shown: Shown) -> None:
        if not shown.readings:
            self.show_rows((), {}, "")

    def show_rows(self, rows: Sequence[Difference], choices: Mapping[Key, Choice], who: str) -> None:
        """Rows with what was chosen for each; `who`: what was read, and when."""
        if [row.key for row in rows] != [row.key for row in self._rows]:
            self._build(rows)
        self._rows = tuple(rows)
        for number, row in enumerate(rows):
            for column, text in enumerate((row.axis, f"{row.title} ({row.command})", row.setup, row.controller)):
                self._say(number, column, text)
            box = self.boxes[row.key]
            offered = choices_of(row)
            if tuple(box.itemData(each) for each in range(box.count())) != offered:
                box.clear()
                for choice in offered:
                    box.addItem(CHOICE_WORDS[choice], choice)
            box.setCurrentIndex(max(0, box.findData(choices.get(row.key, Choice.LEAVE))))
        for button in (self.send_all, self.take_all, self.leave_all):
            button.setEnabled(bool(rows))
        self.table.setVisible(bool(rows))
        count = len(rows)
        differ = f"{count} value{'s differ' if count != 1 else ' differs'}" if count else "Setup and controller agree"
        say(self.said, f"{differ}. {who}" if who else NOT_READ)

    def _build(self, rows: Sequence[Difference]) -> None:
        self.table.setRowCount(len(rows))
        self.boxes = {}
        for number, row in enumerate(rows):
            box = QComboBox()
            box.setAccessibleName(f"{row.title} of {row.axis}: what to do")
            box.setMinimumHeight(look().control)
            box.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
            box.activated.connect(lambda _, key=row.key, box=box: self.chosen.emit(key, Choice(box.currentData())))
            self.boxes[row.key] = box
            self.table.setCellWidget(number, len(HEADS) - 1, box)

    def _say(self, row: int, column: int, text: str) -> None:
        item = self.table.item(row, column)
        if item is None:
            self.table.setItem(row, column, QTableWidgetItem(text))
        elif item.text() != text:
            item.setText(text)
