"""The voltages at the analog inputs."""

from __future__ import annotations

import math
from collections.abc import Sequence

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QGridLayout, QLabel, QWidget

from widgets.panel import set_text, show_role

COLUMNS = 4


class Voltages(QWidget):
    """Number and voltage of each; `show_volts` is its setter."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._grid = QGridLayout(self)
        self._grid.setContentsMargins(8, 0, 8, 0)
        self._grid.setHorizontalSpacing(8)
        self._grid.setVerticalSpacing(4)
        for column in range(COLUMNS):
            self._grid.setColumnStretch(2 * column + 1, 1)
        self._cells: list[tuple[QLabel, QLabel]] = []

    def show_count(self, count: int) -> None:
        """How many the model has."""
        while len(self._cells) < count:
            place = len(self._cells)
            cells = QLabel(str(place + 1)), QLabel("?")
            cells[0].setProperty("role", "quiet")
            cells[1].setAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
            for column, label in enumerate(cells):
                self._grid.addWidget(label, place // COLUMNS, 2 * (place % COLUMNS) + column)
            self._cells.append(cells)
        for number, cells in enumerate(self._cells):
            for label in cells:
                label.setVisible(number < count)

    def show_volts(self, values: Sequence[tuple[float, bool]]) -> None:
        """Each voltage, and whether it is older than it should be."""
        for (_, label), (volts, stale) in zip(self._cells, values, strict=False):
            set_text(label, volts_words(volts))
            show_role(label, "quiet" if stale else "")

    def words(self) -> list[str]:
        """What is shown now, a line each."""
        there = [cells for cells in self._cells if not cells[0].isHidden()]
        return [f"analog input {number.text()}, {volts.text()} V" for number, volts in there]


def volts_words(volts: float) -> str:
    """ "-0.284", millivolts; "?" where it is not known. The sign of nothing is not shown."""
    return f"{round(volts, 3) + 0.0:.3f}" if math.isfinite(volts) else "?"
