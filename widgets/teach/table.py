"""The teach table on the screen: a row for each entry, units in its headings, edited by keys as a spreadsheet."""

from __future__ import annotations

from typing import Any

from PySide6.QtCore import QAbstractTableModel, QEvent, QModelIndex, QPersistentModelIndex, Qt, Signal
from PySide6.QtGui import QFontMetrics, QKeyEvent, QKeySequence
from PySide6.QtWidgets import QAbstractItemView, QTableView, QWidget

from codegen.fields import fields_of
from codegen.setup import Setup
from codegen.teach import COLUMNS, USUAL, Row, Table, Wrong, cell_problem, label_of, shown_text, typed_text, unit_row
from widgets.parts.look import look

Index = QModelIndex | QPersistentModelIndex
ROW_HEIGHT = 26
LONGEST_WORD = 8  # characters of a heading in one line
NARROWEST = 40  # px


class TeachModel(QAbstractTableModel):
    """`typed` tells row, column and text of an edit that may stand there; `refused` why one may not."""

    typed = Signal(int, str, str)
    refused = Signal(str)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.table, self.setup = Table(), Setup()
        self.playing = -1
        self._wrong: dict[tuple[int, str], str] = {}

    def show_table(self, table: Table, setup: Setup, wrong: tuple[Wrong, ...]) -> None:
        """Another table; the view keeps its place where the row is still there."""
        fewer, more = len(self.table) - len(table), len(table) - len(self.table)
        if fewer > 0:
            self.beginRemoveRows(QModelIndex(), len(table), len(self.table) - 1)
        elif more > 0:
            self.beginInsertRows(QModelIndex(), len(self.table), len(table) - 1)
        self.table, self.setup = table, setup
        self._wrong = {(each.row, each.column): each.sentence for each in reversed(wrong)}
        if fewer > 0:
            self.endRemoveRows()
        elif more > 0:
            self.endInsertRows()
        self._all_changed()
        self.headerDataChanged.emit(Qt.Orientation.Horizontal, 0, len(COLUMNS) - 1)

    def show_playing(self, row: int) -> None:
        """The row that is played back now; below 0: none."""
        if row != self.playing:
            self.playing = row
            self._all_changed()

    def _all_changed(self) -> None:
        if len(self.table):
            self.dataChanged.emit(self.index(0, 0), self.index(len(self.table) - 1, len(COLUMNS) - 1))

    def rowCount(self, parent: Index | None = None) -> int:
        return 0 if parent is not None and parent.isValid() else len(self.table)

    def columnCount(self, parent: Index | None = None) -> int:
        return 0 if parent is not None and parent.isValid() else len(COLUMNS)

    def flags(self, index: Index) -> Qt.ItemFlag:
        return Qt.ItemFlag.ItemIsEnabled | Qt.ItemFlag.ItemIsSelectable | Qt.ItemFlag.ItemIsEditable

    def data(self, index: Index, role: int = Qt.ItemDataRole.DisplayRole) -> Any:
        row, column = index.row(), COLUMNS[index.column()]
        text = getattr(self.table.rows[row], column)
        if role in (Qt.ItemDataRole.DisplayRole, Qt.ItemDataRole.EditRole):
            return shown_text(text)
        if role == Qt.ItemDataRole.TextAlignmentRole:
            return int(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        if role == Qt.ItemDataRole.AccessibleTextRole:
            return f"Row {row + 1}, {label_of(column)}: {shown_text(text)}"
        if role == Qt.ItemDataRole.ToolTipRole:
            return self._wrong.get((row, column)) or fields_of(Row)[column].help
        if role == Qt.ItemDataRole.ForegroundRole:
            if (row, column) in self._wrong:
                return look().colour("fault")
            return None if text else look().colour("quiet")
        if role == Qt.ItemDataRole.BackgroundRole and row == self.playing:
            return look().colour("executing")
        return None

    def setData(self, index: Index, value: Any, role: int = Qt.ItemDataRole.EditRole) -> bool:
        column, text = COLUMNS[index.column()], str(value)
        if typed_text(text) == getattr(self.table.rows[index.row()], column):
            return True
        if problem := cell_problem(column, text, self.setup):
            self.refused.emit(f"Row {index.row() + 1}: {problem}. The cell keeps what it had.")
            return False
        self.typed.emit(index.row(), column, text)
        return True

    def headerData(self, section: int, orientation: Qt.Orientation, role: int = Qt.ItemDataRole.DisplayRole) -> Any:
        if role == Qt.ItemDataRole.DisplayRole:
            if orientation is Qt.Orientation.Vertical:
                return str(section + 1)
            label = label_of(COLUMNS[section])
            words = label.replace(" ", "\n") if len(label) > LONGEST_WORD else label
            return f"{words}\n{unit_row(self.table)[section]}"
        if role == Qt.ItemDataRole.ToolTipRole and orientation is Qt.Orientation.Horizontal:
            return fields_of(Row)[COLUMNS[section]].help
        return None


class TeachView(QTableView):
    """`asked` tells what a key means: insert, delete, clear, undo, redo."""

    asked = Signal(str)

    def __init__(self, model: TeachModel, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setModel(model)
        self.setAccessibleName("Teach table")
        self.setProperty("role", "dense")
        self.setSelectionMode(QAbstractItemView.SelectionMode.ExtendedSelection)
        self.setTabKeyNavigation(False)
        self.setWordWrap(False)
        triggers = QAbstractItemView.EditTrigger
        self.setEditTriggers(triggers.DoubleClicked | triggers.EditKeyPressed | triggers.AnyKeyPressed)
        rows, columns = self.verticalHeader(), self.horizontalHeader()
        rows.setDefaultSectionSize(ROW_HEIGHT)
        rows.setSectionResizeMode(rows.ResizeMode.Fixed)
        columns.setSectionResizeMode(columns.ResizeMode.Interactive)
        columns.setStretchLastSection(False)
        columns.setMinimumSectionSize(NARROWEST)
        columns.setFont(look().small_font())
        columns.setHighlightSections(False)
        self.setMinimumHeight(ROW_HEIGHT * 7 + 56)
        self.show_columns(False)

    def show_columns(self, all_of_them: bool) -> None:
        """The columns of the manual, or those of recorded ways too."""
        for number, column in enumerate(COLUMNS):
            self.setColumnHidden(number, not all_of_them and column not in USUAL)

    def fit_columns(self) -> None:
        """As wide as heading, unit and numbers are; the usual header keeps more room than a dock has."""
        small, body, model = QFontMetrics(look().small_font()), QFontMetrics(look().body_font()), self.model()
        assert isinstance(model, TeachModel)
        for number, column in enumerate(COLUMNS):
            heading = str(model.headerData(number, Qt.Orientation.Horizontal)).split("\n")
            texts = {shown_text(getattr(row, column)) for row in model.table.rows}
            widths = [small.horizontalAdvance(text) + 16 for text in heading]
            widths += [body.horizontalAdvance(text) + 12 for text in texts]
            self.setColumnWidth(number, max(NARROWEST, *widths))

    @property
    def chosen(self) -> list[int]:
        """Rows with a selected cell; the present one where nothing is selected."""
        rows = sorted({index.row() for index in self.selectedIndexes()})
        return rows or ([self.currentIndex().row()] if self.currentIndex().isValid() else [])

    @property
    def cells(self) -> list[tuple[int, str]]:
        """Selected cells that are shown."""
        found = [(each.row(), COLUMNS[each.column()]) for each in self.selectedIndexes()]
        return [(row, column) for row, column in found if not self.isColumnHidden(COLUMNS.index(column))]

    def go_to(self, row: int, column: int = 0) -> None:
        """The present cell, in view."""
        if 0 <= row < self.model().rowCount():
            self.setCurrentIndex(self.model().index(row, column))
            self.scrollTo(self.currentIndex())

    def event(self, event: QEvent) -> bool:
        """Undo and redo are those of this table while it has the keyboard, not the program's."""
        if event.type() is QEvent.Type.ShortcutOverride and isinstance(event, QKeyEvent):
            keys = QKeySequence.StandardKey
            if event.matches(keys.Undo) or event.matches(keys.Redo):
                event.accept()
                return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """As in the tables of dialogs."""
        control = bool(event.modifiers() & Qt.KeyboardModifier.ControlModifier)
        key, asked = event.key(), ""
        if event.matches(QKeySequence.StandardKey.Undo):
            asked = "undo"
        elif event.matches(QKeySequence.StandardKey.Redo):
            asked = "redo"
        elif key == Qt.Key.Key_Insert or (control and key == Qt.Key.Key_Plus):
            asked = "insert"
        elif control and key == Qt.Key.Key_Minus:
            asked = "delete"
        elif key in (Qt.Key.Key_Delete, Qt.Key.Key_Backspace):
            asked = "clear"
        elif key in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and self.state() is not self.State.EditingState:
            if self.currentIndex().isValid():
                self.edit(self.currentIndex())
            return
        if asked:
            self.asked.emit(asked)
            return
        super().keyPressEvent(event)
