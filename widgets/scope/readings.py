"""What the curves say: values at the cursors, and measurements of the stretch between them or of what is shown."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import Qt
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QHeaderView, QTableWidgetItem, QWidget

from device.curves import Measured, measure
from widgets.scope.table import Table

FIGURES = 5
LONGEST_HEAD = 14  # characters in one line
DASH = "–"
NO_BREAK = "\N{NO-BREAK SPACE}"
ROWS = (
    "At A", "At B", "B − A", "Least", "Most", "Mean", "RMS", "Peak to peak", "Rise 10–90 %", "Frequency",
    "Highest line",
)  # fmt: skip


OF_TIME = ("Least", "Mean", "RMS", "Peak to peak", "Rise 10–90 %", "Frequency")  # say nothing of a spectrum


@dataclass(frozen=True, eq=False)
class Column:
    """One curve as it is read, `x` ascending: `peak` is frequency and height of the highest line of its spectrum."""

    label: str
    unit: str
    colour: QColor
    x: NDArray[np.float64]
    y: NDArray[np.float64]
    peak: tuple[float, float] | None = None
    measured: Measured | None = None  # where its values are too many to be handed over: then `x` are those at both ends


def figure(number: float, unit: str = "") -> str:
    """A number as a person reads it, with its unit; a dash for none."""
    if not math.isfinite(number):
        return DASH
    text = f"{number + 0.0:.{FIGURES}g}"  # never -0
    text = f"{number:.0f}" if "e+" in text and abs(number) < 1e12 else text
    return f"{text} {unit}".strip()


def seconds(number: float) -> str:
    """A time: ms below a second."""
    if not math.isfinite(number):
        return DASH
    return f"{number * 1000:.5g} ms" if abs(number) < 1 else f"{number:.5g} s"


def at(x: NDArray[np.float64], y: NDArray[np.float64], place: float) -> float:
    """The value of the point nearest to a place, NaN outside."""
    if not len(x) or not x[0] <= place <= x[-1]:
        return math.nan
    after = min(int(np.searchsorted(x, place)), len(x) - 1)
    before = max(after - 1, 0)
    return float(y[before] if place - x[before] < x[after] - place else y[after])


class Readings(Table):
    """A column for every curve; Ctrl+C copies it as text."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(len(ROWS), 0, "Readings", parent)
        self.setVerticalHeaderLabels(list(ROWS))
        self.verticalHeader().setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        self.horizontalHeader().setDefaultAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        self._heads: list[tuple[str, str]] = []
        self._kind: tuple[object, ...] = ()

    def show_columns(
        self, columns: Sequence[Column], cursors: Sequence[float] | None, shown: tuple[float, float]
    ) -> None:
        """`cursors` are the places of A and B, None without them; then what is `shown` is measured."""
        heads = [(column.label, column.colour.name()) for column in columns]
        spectral = any(column.peak is not None for column in columns)
        kind = (tuple(heads), spectral, cursors is None)
        fresh, self._kind = kind != self._kind, kind
        if heads != self._heads:
            self._heads = heads
            self.setColumnCount(len(columns))
            for place, (label, colour) in enumerate(heads):
                head = QTableWidgetItem(label.replace(" ", "\n", 1) if len(label) > LONGEST_HEAD else label)
                head.setForeground(QColor(colour))
                self.setHorizontalHeaderItem(place, head)
        low, high = sorted(cursors) if cursors is not None else shown
        for place, column in enumerate(columns):
            inside = slice(np.searchsorted(column.x, low), np.searchsorted(column.x, high, side="right"))
            found = column.measured or measure(column.x[inside], column.y[inside])
            for row, text in enumerate(_texts(column, cursors, found)):
                self.write(row, place, text)
        for row in range(3):
            self.setRowHidden(row, cursors is None)
        for name in OF_TIME:
            self.setRowHidden(ROWS.index(name), spectral)
        self.setRowHidden(len(ROWS) - 1, not spectral)
        if fresh:
            self.resizeColumnsToContents()

    def words(self) -> str:
        """The table as text, for the clipboard."""
        rows = [row for row in range(self.rowCount()) if not self.isRowHidden(row)]
        lines = ["\t".join(["", *(label for label, _ in self._heads)])]
        for row in rows:
            lines.append("\t".join([ROWS[row], *(self.text(row, place) for place in range(self.columnCount()))]))
        return "\n".join(lines)

    def reading(self, row: str, label: str) -> str:
        """What stands in a row under a curve's name."""
        return self.text(ROWS.index(row), [head for head, _ in self._heads].index(label))


def apart_words(cursors: Sequence[float] | None, spectral: bool) -> str:
    """Where the cursors stand and what lies between them; nothing without them."""
    if cursors is None:
        return ""
    first, second = cursors
    apart = second - first
    if spectral:
        parts = [f"A {first:.5g} Hz", f"B {second:.5g} Hz", f"B − A {apart:.5g} Hz"]
    else:
        parts = [f"A {seconds(first)}", f"B {seconds(second)}", f"B − A {seconds(apart)}"]
        parts += [f"1/(B − A) {1 / abs(apart):.5g} Hz"] if apart else []
    return "   ".join(part.replace(" ", NO_BREAK) for part in parts)


def _texts(column: Column, cursors: Sequence[float] | None, found: Measured) -> tuple[str, ...]:
    unit = column.unit
    first, second = (at(column.x, column.y, place) for place in cursors) if cursors is not None else (math.nan,) * 2
    peak = f"{figure(column.peak[1], unit)} at {figure(column.peak[0], 'Hz')}" if column.peak is not None else ""
    return (
        figure(first, unit),
        figure(second, unit),
        figure(second - first, unit),
        figure(found.least, unit),
        figure(found.most, unit),
        figure(found.mean, unit),
        figure(found.rms, unit),
        figure(found.peak_to_peak, unit),
        seconds(found.rise_s),
        figure(found.frequency_hz, "Hz"),
        peak,
    )
