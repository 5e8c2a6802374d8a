"""The cells of a table as Qt shows them: in front where each row is, then one column for each axis."""

from __future__ import annotations

from typing import Any

from PySide6.QtCore import QAbstractTableModel, QModelIndex, QPersistentModelIndex, Qt

from codegen.sheets import INTERVAL, Cells, Sheet, cell_problem, positions
from widgets.parts.look import look

Index = QModelIndex | QPersistentModelIndex
ROOT = QModelIndex()
LEAD = 1  # columns before those of the table


class GridModel(QAbstractTableModel):
    """Shows; changes go through the editor, which keeps the history."""

    def __init__(self, sheet: Sheet) -> None:
        super().__init__()
        self.sheet = sheet
        self.cells: Cells = ()
        self.added_up = False  # steps are shown as the positions they lead to
        self._positions: dict[int, tuple[str, ...]] = {}

    def show_cells(self, cells: Cells, sheet: Sheet) -> None:
        """Other cells; only what differs is painted again where the size stays."""
        same = len(cells) == len(self.cells) and self._wide(cells, sheet) == self.columnCount()
        if not same:
            self.beginResetModel()
        self.cells, self.sheet, self._positions = cells, sheet, {}
        if not same:
            self.endResetModel()
            return
        if cells:
            self.dataChanged.emit(self.index(0, 0), self.index(len(cells) - 1, self.columnCount() - 1))
        self.headerDataChanged.emit(Qt.Orientation.Horizontal, 0, self.columnCount() - 1)

    def show_added_up(self, on: bool) -> None:
        """Positions instead of steps, or steps again."""
        self.added_up = on
        self.show_cells(self.cells, self.sheet)

    def adds_up(self, column: int) -> bool:
        """Whether a column of the table shows positions just now."""
        return self.added_up and column < len(self.sheet.columns) and self.sheet.columns[column].letter != INTERVAL

    def text(self, row: int, column: int) -> str:
        """What a cell of the table shows."""
        if not self.adds_up(column):
            return self.cells[row][column]
        if column not in self._positions:
            self._positions[column] = positions(self.cells, column)
        return self._positions[column][row]

    # ---- for Qt

    @staticmethod
    def _wide(cells: Cells, sheet: Sheet) -> int:
        return LEAD + max(len(sheet.columns), len(cells[0]) if cells else 0)

    def rowCount(self, parent: Index = ROOT) -> int:
        return 0 if parent.isValid() else len(self.cells)

    def columnCount(self, parent: Index = ROOT) -> int:
        return 0 if parent.isValid() else self._wide(self.cells, self.sheet)

    def flags(self, index: Index) -> Qt.ItemFlag:
        """What leads the rows is only read."""
        able = Qt.ItemFlag.ItemIsEnabled | Qt.ItemFlag.ItemIsSelectable
        return Qt.ItemFlag.ItemIsEnabled if index.column() < LEAD else able | Qt.ItemFlag.ItemIsEditable

    def headerData(self, section: int, orientation: Qt.Orientation, role: int = Qt.ItemDataRole.DisplayRole) -> Any:
        if role != Qt.ItemDataRole.DisplayRole:
            return None
        if orientation is Qt.Orientation.Vertical:
            return section + 1
        if section < LEAD:
            return self.sheet.lead
        columns = self.sheet.columns
        return columns[section - LEAD].heading if section - LEAD < len(columns) else "not used"

    def data(self, index: Index, role: int = Qt.ItemDataRole.DisplayRole) -> Any:
        row, column = index.row(), index.column() - LEAD
        if role == Qt.ItemDataRole.TextAlignmentRole:
            return int(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        if column < 0:
            if role == Qt.ItemDataRole.ForegroundRole:
                return look().colour("quiet")
            leads = self.sheet.leads
            return (leads[row] if row < len(leads) else "") if role == Qt.ItemDataRole.DisplayRole else None
        if role in (Qt.ItemDataRole.DisplayRole, Qt.ItemDataRole.EditRole):
            return self.text(row, column)
        problem = cell_problem(self.sheet, column, self.cells[row][column])
        if role == Qt.ItemDataRole.ToolTipRole:
            return f"Row {row + 1}: {problem}" if problem else None
        if role == Qt.ItemDataRole.BackgroundRole and problem:
            return look().colour("warning_ground")
        return None
