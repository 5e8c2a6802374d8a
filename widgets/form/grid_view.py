"""The cells of a table on the screen: keys of a spreadsheet, and a number that is refused while it is typed."""

from __future__ import annotations

from PySide6.QtCore import QAbstractItemModel, QEvent, QModelIndex, QObject, QPersistentModelIndex, Qt, Signal
from PySide6.QtGui import QKeyEvent, QKeySequence
from PySide6.QtWidgets import (
    QAbstractItemView,
    QLineEdit,
    QStyledItemDelegate,
    QStyleOptionViewItem,
    QTableView,
    QWidget,
)

from codegen.sheets import cell_problem
from widgets.form.grid_model import LEAD, GridModel
from widgets.parts.look import look

Index = QModelIndex | QPersistentModelIndex
ROW_HEIGHT = 26  # px; a table is denser than a form
KEYS = {
    QKeySequence.StandardKey.Copy: "copy",
    QKeySequence.StandardKey.Cut: "cut",
    QKeySequence.StandardKey.Paste: "paste",
    QKeySequence.StandardKey.Undo: "undo",
    QKeySequence.StandardKey.Redo: "redo",
}


class CellDelegate(QStyledItemDelegate):
    """Types into a cell; what is no number is told at once and does not leave the cell."""

    typed = Signal(int, int, str)  # row, column of the table, text
    told = Signal(str)

    def createEditor(self, parent: QWidget, option: QStyleOptionViewItem, index: Index) -> QWidget:
        line = QLineEdit(parent)
        line.setFrame(False)
        line.setProperty("role", "cell")
        line.setAlignment(Qt.AlignmentFlag.AlignRight)
        line.setAccessibleName(f"Row {index.row() + 1}")
        place = QPersistentModelIndex(index)
        line.textEdited.connect(lambda text: self.told.emit(self._problem(place, text)))
        return line

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Enter with a text that is no number stays in the cell."""
        if isinstance(watched, QLineEdit) and event.type() == QEvent.Type.KeyPress and isinstance(event, QKeyEvent):
            leaves = event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter, Qt.Key.Key_Tab, Qt.Key.Key_Backtab)
            view = self.parent()
            if leaves and isinstance(view, QTableView) and self._problem(view.currentIndex(), watched.text()):
                self.told.emit(self._problem(view.currentIndex(), watched.text()))
                return True
            if leaves and event.modifiers() & Qt.KeyboardModifier.ControlModifier:
                self.commitData.emit(watched)  # at once: the dialog is about to be left
            if event.key() == Qt.Key.Key_Escape:
                self.told.emit("")
        return super().eventFilter(watched, event)

    def setModelData(self, editor: QWidget, model: QAbstractItemModel, index: Index) -> None:
        assert isinstance(editor, QLineEdit)
        if problem := self._problem(index, editor.text()):
            self.told.emit(f"{problem}; the cell keeps {index.data() or 'nothing'}")
        else:
            self.typed.emit(index.row(), index.column() - LEAD, editor.text())

    def _problem(self, index: Index, text: str) -> str:
        model = index.model()
        assert isinstance(model, GridModel)
        problem = cell_problem(model.sheet, index.column() - LEAD, text)
        return f"Row {index.row() + 1}: {problem}" if problem else ""


class GridView(QTableView):
    """Says what a key asks for: copy, paste, a new row; the editor does it."""

    asked = Signal(str)

    def __init__(self, model: GridModel, name: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setModel(model)
        self.setAccessibleName(name)
        self.setSelectionMode(QAbstractItemView.SelectionMode.ContiguousSelection)
        self.setEditTriggers(
            QAbstractItemView.EditTrigger.DoubleClicked
            | QAbstractItemView.EditTrigger.EditKeyPressed
            | QAbstractItemView.EditTrigger.AnyKeyPressed
        )
        self.setTabKeyNavigation(False)
        self.setWordWrap(False)
        self.cells = CellDelegate(self)
        self.setItemDelegate(self.cells)
        rows = self.verticalHeader()
        rows.setDefaultSectionSize(ROW_HEIGHT)
        rows.setSectionResizeMode(rows.ResizeMode.Fixed)
        columns = self.horizontalHeader()
        columns.setSectionResizeMode(columns.ResizeMode.Stretch)
        columns.setMinimumSectionSize(56)
        columns.setHighlightSections(False)
        self.setMinimumHeight(ROW_HEIGHT * 7 + look().control)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """As in a spreadsheet; Ctrl+Enter belongs to the dialog."""
        asked = next((what for keys, what in KEYS.items() if event.matches(keys)), "")
        control = bool(event.modifiers() & Qt.KeyboardModifier.ControlModifier)
        key = event.key()
        if key in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and control:
            event.ignore()
            return
        if key == Qt.Key.Key_Insert or (control and key == Qt.Key.Key_Plus):
            asked = "insert"
        elif control and key == Qt.Key.Key_Minus:
            asked = "delete"
        elif key in (Qt.Key.Key_Delete, Qt.Key.Key_Backspace):
            asked = "zero"
        elif key in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and self.state() is not self.State.EditingState:
            asked = "edit"
        if asked:
            self.asked.emit(asked)
            return
        super().keyPressEvent(event)

    def edit_current(self) -> None:
        """The cell opens for typing."""
        if self.currentIndex().isValid():
            self.edit(self.currentIndex())

    def rows_chosen(self) -> list[int]:
        """Rows with a selected cell, from top to bottom; the present one where nothing is selected."""
        rows = sorted({index.row() for index in self.selectedIndexes()})
        return rows or ([self.currentIndex().row()] if self.currentIndex().isValid() else [])

    def columns_chosen(self) -> list[int]:
        """Columns of the table with a selected cell."""
        columns = {index.column() - LEAD for index in self.selectedIndexes() if index.column() >= LEAD}
        present = self.currentIndex().column() - LEAD
        return sorted(columns) or ([max(present, 0)] if self.currentIndex().isValid() else [])

    def go_to(self, row: int, column: int) -> None:
        """The present cell, as if it had been clicked."""
        model = self.model()
        if 0 <= row < model.rowCount():
            self.setCurrentIndex(model.index(row, column + LEAD))

    def focus_target(self) -> QWidget:
        """The cells take the cursor."""
        return self
