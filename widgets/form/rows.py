"""A list inside a form: its entries in words, one of them open for editing; add, remove, move, clear."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtWidgets import QHBoxLayout, QLabel, QListWidget, QListWidgetItem, QPushButton, QVBoxLayout, QWidget

from codegen import fields, read
from widgets.form.offers import Offers
from widgets.parts.icons import icon
from widgets.parts.look import look

MOST_SHOWN = 6  # entries before the list scrolls
MANY = 4  # fields of an entry that stand beside the list instead of below it


class RowsEditor(QWidget):
    """The value is a tuple of frozen rows; `make_form` builds the form of one row."""

    changed = Signal(object)
    opened = Signal(int)  # the entry whose form is shown; -1: none

    def __init__(
        self, field: fields.ListOf, offers: Offers, make_form: Callable[..., Any], *, narrow: bool = False
    ) -> None:
        super().__init__()
        self.field = field
        self.offers = offers
        self.narrow = narrow
        self.rows: tuple[Any, ...] = ()
        members = fields.fields_of(field.row).values()
        high = len(members) >= MANY or any(isinstance(each, fields.PerAxis) for each in members)
        self.beside = high and not narrow
        self.list = QListWidget()
        self.list.setAccessibleName(field.label)
        self.list.setUniformItemSizes(True)
        self.list.currentRowChanged.connect(self._open)
        self.form = make_form(offers, dense=self.beside)
        self.form.edited.connect(self._edited)
        self.empty = QLabel(f"Nothing in the list yet: press Add for the first entry of “{field.label}”.")
        self.empty.setProperty("role", "quiet")
        self.empty.setWordWrap(True)
        self.buttons = {
            "add": self._button("Add", "add", self.add),
            "remove": self._button("Remove", "remove", self.remove),
            "up": self._button("", "up", lambda: self.shift(-1), "Up"),
            "down": self._button("", "down", lambda: self.shift(1), "Down"),
            "clear": self._button("Clear", "close", self.clear),
        }
        self._lay_out()
        self._show(-1)

    def _lay_out(self) -> None:
        """The entries with their buttons; the open one below them, or beside them when it has many fields."""
        bar = QHBoxLayout()
        bar.setSpacing(2 if self.narrow or self.beside else 4)
        for button in self.buttons.values():
            bar.addWidget(button)
        bar.addStretch(1)
        entries = QVBoxLayout()
        entries.setSpacing(8)
        for widget in (self.list, self.empty):
            entries.addWidget(widget)
        entries.addLayout(bar)
        beside = self.beside
        whole = QHBoxLayout(self) if beside else QVBoxLayout(self)
        whole.setContentsMargins(0, 0, 0, 0)
        whole.setSpacing(12 if beside else 8)
        whole.addLayout(entries, 1)
        whole.addWidget(self.form)
        self.below = entries if beside else None
        if beside:
            entries.addStretch(1)

    def put_below(self, widget: QWidget) -> None:
        """Something that belongs to the entries takes the room below their buttons."""
        assert self.below is not None, "only a list with its form beside it has room"
        self.below.takeAt(self.below.count() - 1)
        self.below.addWidget(widget, 1)

    @property
    def invitation(self) -> str:
        """What an empty list that must not be empty says."""
        return f"Add at least one entry to “{self.field.label}”"

    def value(self) -> tuple[Any, ...]:
        return self.rows

    def setValue(self, value: Any) -> None:
        if value != self.rows:
            self.rows = tuple(value)
            self._show(min(max(self.list.currentRow(), 0), len(self.rows) - 1))

    def show_offers(self, offers: Offers) -> None:
        """Other names for the open entry."""
        self.offers = offers
        self.form.show_offers(offers)

    def show_path(self, letters: str) -> None:
        """The axes that all entries move together."""
        if letters != self.form.path:
            self.form.show_path(letters)
            for number, row in enumerate(self.rows):
                self.list.item(number).setText(self._words(number + 1, row))

    # ---- what the buttons do

    def add(self) -> None:
        """A new entry behind the open one."""
        at = self.list.currentRow() + 1 if self.rows else 0
        self._change((*self.rows[:at], self.field.row(), *self.rows[at:]), at)
        self.form.focus_first()

    def remove(self) -> None:
        """Takes the open entry out."""
        at = self.list.currentRow()
        self._change(self.rows[:at] + self.rows[at + 1 :], min(at, len(self.rows) - 2))

    def shift(self, by: int) -> None:
        """Moves the open entry up or down."""
        at = self.list.currentRow()
        rows = list(self.rows)
        rows.insert(at + by, rows.pop(at))
        self._change(tuple(rows), at + by)

    def clear(self) -> None:
        """Empties the list."""
        self._change((), -1)

    # ---- inside

    def _change(self, rows: tuple[Any, ...], at: int) -> None:
        self.rows = rows
        self._show(at)
        self.changed.emit(rows)

    def _edited(self, row: Any) -> None:
        at = self.list.currentRow()
        self.rows = (*self.rows[:at], row, *self.rows[at + 1 :])
        self.list.item(at).setText(self._words(at + 1, row))
        self.changed.emit(self.rows)

    def _show(self, at: int) -> None:
        self.list.blockSignals(True)
        self.list.clear()
        for number, row in enumerate(self.rows, start=1):
            item = QListWidgetItem(self._words(number, row))
            item.setSizeHint(QSize(0, look().control))
            self.list.addItem(item)
        self.list.setCurrentRow(at)
        self.list.blockSignals(False)
        self._open(at)

    def _open(self, at: int) -> None:
        there = 0 <= at < len(self.rows)
        self.form.setVisible(there)
        self.list.setFixedHeight(look().control * max(2, min(len(self.rows), MOST_SHOWN)) + 4)
        self.list.setVisible(bool(self.rows))
        self.empty.setVisible(not self.rows)
        if there:
            self.form.show_item(self.rows[at])
        self.buttons["add"].setEnabled(not self.field.most or len(self.rows) < self.field.most)
        self.buttons["remove"].setEnabled(there)
        self.buttons["up"].setEnabled(there and at > 0)
        self.buttons["down"].setEnabled(there and at < len(self.rows) - 1)
        self.buttons["clear"].setEnabled(bool(self.rows))
        self.opened.emit(at if there else -1)

    def _words(self, number: int, row: Any) -> str:
        return f"{number}    {read.row_sentence(row, self.offers.setup, self.form.path)}"

    def _button(self, text: str, picture: str, action: Callable[[], None], name: str = "") -> QPushButton:
        short = self.narrow or (self.beside and text != "Add")
        button = QPushButton(icon(picture), "" if short else text)
        button.setToolTip(f"{name or text}: {self.field.label}")
        button.setMinimumHeight(look().control)
        if short:
            button.setProperty("role", "segment")  # less room beside the picture
        button.setAutoDefault(False)
        button.setAccessibleName(f"{name or text}: {self.field.label}")
        button.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        button.clicked.connect(lambda: action())
        return button
