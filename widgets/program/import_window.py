"""Before a module comes in: which of its names get new ones, and what is left out."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QAbstractItemView,
    QDialog,
    QHeaderView,
    QLabel,
    QPushButton,
    QTableWidget,
    QTableWidgetItem,
    QVBoxLayout,
    QWidget,
)

from codegen.modules import Rename
from widgets.parts.foot import foot
from widgets.parts.look import look

HEADINGS = ("Kind", "Name in the module", "Becomes", "")
KINDS = {"label": "Label or subroutine", "variable": "Variable or array"}


class ImportWindow(QDialog):
    """Not modal; nothing has happened yet while it is open."""

    confirmed = Signal(object)  # frozenset of the variables that are the same in both

    def __init__(self, words: str, renames: Sequence[Rename], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setModal(False)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle("Import module")
        self.setProperty("helpPage", "Program window")
        self._renames = tuple(renames)
        self.words = QLabel(words)
        self.words.setWordWrap(True)
        self.table = self._table()
        self.take, cancel = QPushButton("Import"), QPushButton("Cancel")
        self.take.setProperty("role", "primary")
        self.take.setDefault(True)
        self.take.clicked.connect(self._confirm)
        cancel.clicked.connect(self.reject)
        column = QVBoxLayout(self)
        column.setContentsMargins(16, 16, 16, 16)
        column.setSpacing(12)
        column.addWidget(self.words)
        column.addWidget(self.table, 1)
        column.addWidget(foot(self.take, away=cancel))
        self.table.setVisible(bool(renames))
        self.resize(640, 320 if renames else 160)

    def shared(self) -> frozenset[str]:
        """Variables that shall stay one and the same in both programs."""
        return frozenset(
            each.name for row, each in enumerate(self._renames) if each.kind == "variable" and not self._ticked(row)
        )

    def _ticked(self, row: int) -> bool:
        cell = self.table.item(row, 3)
        return cell is not None and cell.checkState() == Qt.CheckState.Checked

    def _confirm(self) -> None:
        shared = self.shared()
        self.accept()
        self.confirmed.emit(shared)

    def _table(self) -> QTableWidget:
        table = QTableWidget(len(self._renames), len(HEADINGS))
        table.setHorizontalHeaderLabels(list(HEADINGS))
        table.setAccessibleName("Names that get a new one")
        table.setAccessibleDescription("Space ticks a variable: renamed, or the same one in both programs")
        table.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        table.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        table.setTabKeyNavigation(False)
        table.verticalHeader().hide()
        table.verticalHeader().setDefaultSectionSize(look().control)
        table.horizontalHeader().setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        table.horizontalHeader().setStretchLastSection(True)
        for row, each in enumerate(self._renames):
            for column, text in enumerate((KINDS[each.kind], each.name, each.new)):
                table.setItem(row, column, QTableWidgetItem(text))
            table.setItem(row, 3, _choice(each))
        table.itemChanged.connect(self._changed)
        if self._renames:
            table.setCurrentCell(0, 3)
        return table

    def _changed(self, cell: QTableWidgetItem) -> None:
        """What becomes of a variable follows its tick."""
        if cell.column() == 3:
            each = self._renames[cell.row()]
            becomes = self.table.item(cell.row(), 2)
            if becomes is not None:
                becomes.setText(each.new if self._ticked(cell.row()) else f"{each.name} (the same one)")


def _choice(rename: Rename) -> QTableWidgetItem:
    cell = QTableWidgetItem("Rename it" if rename.kind == "variable" else "")
    flags = Qt.ItemFlag.ItemIsEnabled | Qt.ItemFlag.ItemIsSelectable
    if rename.kind == "variable":
        cell.setFlags(flags | Qt.ItemFlag.ItemIsUserCheckable)
        cell.setCheckState(Qt.CheckState.Checked)
        cell.setToolTip("Without the tick both programs use the same variable")
    else:
        cell.setFlags(flags)
    return cell
