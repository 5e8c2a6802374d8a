"""The editor of a table of numbers: a grid with rows, clipboard, files and filling; the value stays a text."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

from PySide6.QtCore import QModelIndex, Signal
from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import QGridLayout, QLabel, QPushButton, QSizePolicy, QVBoxLayout, QWidget

from codegen import fields, sheets
from codegen.numbers import parse_number, plain
from codegen.sheets import Cells, Sheet
from codegen.tables import LONGEST, BadTable
from widgets.form.fill_dialog import FillDialog, Filling
from widgets.form.grid_model import LEAD, GridModel
from widgets.form.grid_view import GridView
from widgets.form.offers import Offers
from widgets.parts.files import ask_open, ask_save
from widgets.parts.look import look

TABLES = "Tables (*.csv *.txt *.tsv)"
MOST_UNDONE = 200
LARGEST_FILE = 4_000_000  # bytes; more is no table for a controller
ACTIONS = (
    ("insert", "Insert", "A row above the selected one, half-way to it (Ins)"),
    ("append", "Add", "A row at the end"),
    ("delete", "Delete", "Takes the selected rows out (Ctrl+-)"),
    ("fill", "Fill…", "A column by a formula or a law of motion"),
    ("copy", "Copy", "The selected cells, or all, for a spreadsheet (Ctrl+C)"),
    ("paste", "Paste", "Cells of a spreadsheet, from the selected cell on; with all selected, instead of all (Ctrl+V)"),
    ("open", "Open…", "The table of a file (CSV) instead of this one"),
    ("save", "Save…", "This table as a file (CSV)"),
)  # fmt: skip


class GridEditor(QWidget):
    """`changed` brings the whole table as text; `row_changed` the row the person is in."""

    changed = Signal(object)
    row_changed = Signal(int)
    refused = Signal()  # `refusal` has changed: what stands in a cell and is no number

    def __init__(
        self, field: fields.Field, offers: Offers, *, narrow: bool = False, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.field = field
        self.across = 3 if narrow else 4  # buttons side by side
        self.sheet = Sheet((), "", (), LONGEST)
        self.letters: tuple[str, ...] | None = None  # of the columns, while this value is shown
        self.kept: dict[str, tuple[str, ...]] = {}  # columns of axes that were taken out of the table
        self.undone: list[Cells] = []
        self.redone: list[Cells] = []
        self.last_key: object = None
        self.refusal = ""
        self.text = ""
        self.model = GridModel(self.sheet)
        self.view = GridView(self.model, field.label)
        self.message = QLabel()
        self.message.setProperty("role", "warning")
        self.message.setWordWrap(True)
        self.message.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        self.message.hide()
        self.added_up = QPushButton("Show positions")
        self.added_up.setCheckable(True)
        self.added_up.setProperty("role", "segment")
        self.added_up.setToolTip("Shows where the axes are after each row, instead of how far they go in it")
        self.fill_dialog: FillDialog | None = None
        self.buttons = {name: self._button(words, about) for name, words, about in ACTIONS}
        self._lay_out()
        self._join()

    def _button(self, words: str, about: str) -> QPushButton:
        button = QPushButton(words)
        button.setToolTip(about)
        button.setProperty("role", "segment")
        return button

    def _lay_out(self) -> None:
        grid = QGridLayout()
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setSpacing(4)
        for number, button in enumerate(self.buttons.values()):
            button.setSizePolicy(QSizePolicy.Policy.MinimumExpanding, QSizePolicy.Policy.Fixed)
            grid.setColumnStretch(number % self.across, 1)
            grid.addWidget(button, number // self.across, number % self.across)
        for button in (*self.buttons.values(), self.added_up):
            button.setMinimumHeight(look().control)
            button.setAutoDefault(False)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(4)
        for widget in (self.added_up, self.view, self.message):
            column.addWidget(widget, 1 if widget is self.view else 0)
        column.addLayout(grid)

    def _join(self) -> None:
        doing: dict[str, Callable[[], None]] = {
            "insert": self.insert, "append": self.append, "delete": self.delete, "copy": self.copy, "paste": self.paste,
            "fill": self.fill, "open": self.open_file, "save": self.save_file, "undo": self.undo, "redo": self.redo,
            "cut": self.cut, "zero": self.zero, "edit": self.view.edit_current,
        }  # fmt: skip
        for name, button in self.buttons.items():
            button.clicked.connect(lambda _=False, name=name: doing[name]())
        self.view.asked.connect(lambda what: doing[what]())
        self.view.cells.typed.connect(self._typed)
        self.view.cells.told.connect(self._refuse)
        self.view.clicked.connect(lambda _: self.tell(""))
        self.view.selectionModel().currentRowChanged.connect(self._moved)
        self.added_up.toggled.connect(self.model.show_added_up)

    # ---- the value

    def value(self) -> str:
        return self.text

    def setValue(self, value: Any) -> None:
        """Another table; what was known of the columns belongs to the old one."""
        if value != self.text:
            self.undone.clear()
            self.redone.clear()
            self.tell("")
        self.text = value
        self.letters = None
        self.kept.clear()
        self._show()

    def show_item(self, item: Any, setup: Any) -> None:
        """The instruction the table belongs to: its columns, and where each row is."""
        self.sheet = item.sheet(setup)
        letters = tuple(column.letter for column in self.sheet.columns)
        before, self.letters = self.letters, letters
        self.added_up.setVisible(self.sheet.steps)
        if before is not None and before != letters and self.cells and len(self.cells[0]) == len(before):
            cells = sheets.with_columns(self.cells, before, letters, self.kept)
            self.kept.update({letter: tuple(row[n] for row in self.cells) for n, letter in enumerate(before)})
            self._take(cells)
            return
        self._show()

    def focus_target(self) -> QWidget:
        """The cells take the cursor."""
        return self.view

    @property
    def cells(self) -> Cells:
        """As they are shown."""
        return self.model.cells

    def _show(self) -> None:
        present = self.view.currentIndex()
        self.model.show_cells(sheets.cells_of(self.text, len(self.sheet.columns)), self.sheet)
        if not self.view.currentIndex().isValid():
            self.view.go_to(min(max(present.row(), 0), len(self.cells) - 1), max(present.column() - LEAD, 0))

    def _take(self, cells: Cells | BadTable, key: object = None) -> bool:
        """Other cells; changes with the same key are one step of undo. Or why there are none."""
        if isinstance(cells, BadTable):
            self.tell(cells.message)
            return False
        self.tell("")
        if key is None or key != self.last_key:
            self.undone = [*self.undone[-MOST_UNDONE:], self.cells]
            self.redone.clear()
        self.last_key = key
        self._set(cells)
        return True

    def _set(self, cells: Cells) -> None:
        self.text = sheets.text_of(cells)
        self.model.show_cells(cells, self.sheet)
        self.changed.emit(self.text)

    def _refuse(self, sentence: str) -> None:
        """A text in a cell that is no number: nothing is accepted before the person has seen that."""
        self.tell(sentence)
        self.refusal = sentence
        self.refused.emit()

    def tell(self, sentence: str) -> None:
        """What was refused; the next change takes it away."""
        if self.refusal:
            self.refusal = ""
            self.refused.emit()
        self.message.setText(f"! {sentence}" if sentence else "")
        self.message.setVisible(bool(sentence))

    def _moved(self, present: QModelIndex) -> None:
        self.tell("")
        self.row_changed.emit(present.row())

    # ---- cells

    def _typed(self, row: int, column: int, text: str) -> None:
        if text.strip() == self.model.text(row, column):
            self.tell("")
        elif self.model.adds_up(column):
            self._take(sheets.with_position(self.cells, row, column, parse_number(text) or Fraction(0)))
        else:
            self._take(sheets.with_cell(self.cells, row, column, text))

    def move_point(self, letter: str, row: int, text: str, last: bool) -> None:
        """A point of the picture was dragged: an axis is elsewhere in that row; `last` ends the drag."""
        column, place = self.sheet.column_of(letter), parse_number(text)
        if place is not None and 0 <= row < len(self.cells):
            change = sheets.with_position if self.sheet.steps else _with_place
            self._take(change(self.cells, row, column, place), ("drag", letter, row))
            self.view.go_to(row, column)
        if last:
            self.last_key = None

    def zero(self) -> None:
        """Selected cells are 0; intervals that need none are empty."""
        cells = self.cells
        for index in self.view.selectedIndexes():
            column = index.column() - LEAD
            if column >= 0 and not self.model.adds_up(column):
                empty = index.row() > 0 and sheets.cell_problem(self.sheet, column, "") is None
                cells = sheets.with_cell(cells, index.row(), column, "" if empty else "0")
        if cells != self.cells:
            self._take(cells)

    # ---- rows

    def insert(self) -> None:
        """A row above the present one."""
        at = max(self.view.currentIndex().row(), 0)
        self._add(at)

    def append(self) -> None:
        """A row at the end."""
        self._add(len(self.cells))

    def _add(self, at: int) -> None:
        if self._take(sheets.with_row(self.sheet, self.cells, at)):
            self.view.go_to(at, 0)

    def delete(self) -> None:
        """The selected rows go."""
        rows = self.view.rows_chosen()
        if rows and self._take(sheets.without_rows(self.cells, rows)):
            self.view.go_to(min(rows[0], len(self.cells) - 1), 0)

    # ---- clipboard and files

    def copy(self) -> None:
        """The selected cells as they are shown, or all of them."""
        rows, columns = self.view.rows_chosen(), self.view.columns_chosen()
        if len(self.view.selectedIndexes()) < 2:
            rows, columns = list(range(len(self.cells))), list(range(self.model.columnCount() - LEAD))
        texts = [[self.model.text(row, column) for column in columns] for row in rows]
        QGuiApplication.clipboard().setText(sheets.text_of(tuple(map(tuple, texts))))

    def cut(self) -> None:
        """Copies, and takes the rows out."""
        self.copy()
        self.delete()

    def paste(self) -> None:
        """All of it or nothing."""
        whole = len(self.view.selectedIndexes()) == len(self.cells) * (self.model.columnCount() - LEAD)
        if whole or not self.cells:
            self.replace_all(QGuiApplication.clipboard().text(), "Nothing was pasted")
            return
        if self.model.added_up:
            self.tell("Nothing was pasted: switch “Show positions” off first")
            return
        row, column = min(self.view.rows_chosen() or [0]), min(self.view.columns_chosen() or [0])
        text = QGuiApplication.clipboard().text()
        self._take(_told(sheets.pasted(self.sheet, self.cells, row, column, text), "Nothing was pasted"))

    def replace_all(self, text: str, otherwise: str) -> bool:
        """Another table instead of this one."""
        return self._take(_told(sheets.pasted(self.sheet, (), 0, 0, text), otherwise))

    def open_file(self) -> None:
        """A file is chosen, and read whole."""
        ask_open(self, "Open a table", TABLES, self.read_file)

    def read_file(self, path: Path) -> None:
        """The table of a file, or why it cannot be read."""
        try:
            data = path.read_bytes() if path.stat().st_size <= LARGEST_FILE else b""
            text = data.decode("utf-8-sig")
        except (OSError, UnicodeDecodeError) as error:
            why = error.strerror if isinstance(error, OSError) else "it is no text in UTF-8"
            self.tell(f"{path.name} was not read: {why}")
            return
        self.replace_all(text, f"{path.name} was not read")

    def save_file(self) -> None:
        """A name is asked for."""
        ask_save(self, "Save the table", TABLES, self.write_file, Path.home() / "table.csv", "csv")

    def write_file(self, path: Path) -> None:
        """With headings, semicolons and decimal points: `Open…` reads it anywhere."""
        try:
            path.write_text(sheets.csv_of(self.sheet, self.cells), encoding="utf-8", newline="\r\n")
        except OSError as error:
            self.tell(f"{path.name} was not written: {error.strerror}")

    # ---- filling

    def fill(self) -> None:
        """Opens the small dialog that fills a column; a second call brings it to the front."""
        if self.fill_dialog is None:
            self.fill_dialog = FillDialog(self)
            self.fill_dialog.wanted.connect(self._fill)
        columns = [each for each in self.sheet.columns if each.letter]
        rows, chosen = self.view.rows_chosen(), self.view.columns_chosen()
        present = self.sheet.columns[chosen[0]].letter if chosen and chosen[0] < len(self.sheet.columns) else ""
        first, last = (rows[0], rows[-1]) if len(rows) > 1 else (0, max(len(self.cells) - 1, 0))
        self.fill_dialog.show_for(columns, present, first, last, self.sheet)

    def _fill(self, filling: Filling) -> None:
        """One column of the table by what was chosen; laws are of positions."""
        column = self.sheet.column_of(filling.letter)
        texts = filling.texts
        if self.sheet.steps and filling.places:
            before = parse_number(sheets.positions(self.cells, column)[filling.first - 1]) if filling.first else None
            texts = sheets.as_steps(texts, before or Fraction(0))
        cells = self._long_enough(filling.first + len(texts))
        if self._take(_told(sheets.filled(self.sheet, cells, filling.first, column, texts), "Nothing was filled")):
            self.view.go_to(filling.first, column)

    def _long_enough(self, count: int) -> Cells:
        """With rows behind the last one, so that other columns have a value there too."""
        missing = min(count, self.sheet.most_rows) - len(self.cells)
        longer = sheets.with_row(self.sheet, self.cells, len(self.cells)) if missing > 0 else self.cells
        return self.cells if isinstance(longer, BadTable) or missing <= 0 else (*longer, *longer[-1:] * (missing - 1))

    # ---- undo

    def undo(self) -> None:
        """The table before the last change made here."""
        if self.undone:
            self.redone.append(self.cells)
            self._back(self.undone.pop())

    def redo(self) -> None:
        """What was undone last, again."""
        if self.redone:
            self.undone.append(self.cells)
            self._back(self.redone.pop())

    def _back(self, cells: Cells) -> None:
        self.last_key = None
        self.tell("")
        self._set(cells)


def _with_place(cells: Cells, row: int, column: int, place: Fraction) -> Cells:
    return sheets.with_cell(cells, row, column, plain(place))


def _told(cells: Cells | BadTable, otherwise: str) -> Cells | BadTable:
    return BadTable(f"{otherwise}: {cells.message}") if isinstance(cells, BadTable) else cells
