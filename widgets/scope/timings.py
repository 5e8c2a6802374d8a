"""What the tracks say: levels at the cursors in words, and how long, how often and how regularly each was on."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from PySide6.QtGui import QColor, QFontMetrics
from PySide6.QtWidgets import QHeaderView, QTableWidgetItem, QWidget

from widgets.parts.look import look
from widgets.scope.readings import DASH, seconds
from widgets.scope.table import Table

if TYPE_CHECKING:
    from device.bits import Signal
    from device.waves import Timing, Wave

HEADS = ("At A", "At B", "On for", "Edges", "Period")
WIDEST = ("not armed", "not armed", "9999.9 ms (99.9 %)", "99 ↑ 99 ↓", "9999.9 ms")
BESIDE = 12  # px beside a text
ABOVE = 13  # px of the height of a row that are not text
TIPS = (
    "The level at cursor A", "The level at cursor B", "How long it was on (a limit: active), and its share of the time",
    "How often it went on ↑ and off ↓", "From one going on to the next, on average; of few edges from off to off",
)  # fmt: skip


@dataclass(frozen=True, eq=False)
class Level:
    """One track as it is drawn and read."""

    signal: Signal
    colour: QColor
    wave: Wave

    def word(self, moment: float) -> str:
        """The level at a moment, as a person calls it."""
        on = self.wave.at(moment)
        return DASH if on is None else self.signal.bit.words[int(on)]


class Timings(Table):
    """A row for every track; Ctrl+C copies it as text."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(0, len(HEADS), "Readings of inputs, outputs and switches", parent)
        self.setHorizontalHeaderLabels(list(HEADS))
        for column, tip in enumerate(TIPS):
            self.horizontalHeaderItem(column).setToolTip(tip)
        # all of one line: to fit them, Qt would measure every row with each text that changes
        self.verticalHeader().setSectionResizeMode(QHeaderView.ResizeMode.Fixed)
        self._heads: list[tuple[str, str]] = []
        self._kind: tuple[object, ...] = ()
        self.hide()

    def show_levels(
        self, levels: Sequence[Level], cursors: Sequence[float] | None, shown: tuple[float, float]
    ) -> None:  # fmt: skip
        """`cursors` are the places of A and B, None without them; then what is `shown` is measured."""
        self.setVisible(bool(levels))
        heads = [(each.signal.label, each.colour.name()) for each in levels]
        if heads != self._heads:
            self._heads = heads
            self.setRowCount(len(levels))
            for row, (label, colour) in enumerate(heads):
                head = QTableWidgetItem(label)
                head.setForeground(QColor(colour))
                self.setVerticalHeaderItem(row, head)
        low, high = sorted(cursors) if cursors is not None else shown
        for row, level in enumerate(levels):
            at = [level.word(place) for place in cursors] if cursors is not None else ["", ""]
            for column, text in enumerate((*at, *_texts(level.wave.timing(low, high)))):
                self.write(row, column, text)
        for column in range(2):
            self.setColumnHidden(column, cursors is None)
        kind = (tuple(heads), cursors is None)
        if kind != self._kind:
            self._kind = kind
            metrics = QFontMetrics(look().digits_font(look().body_points))
            self.verticalHeader().setDefaultSectionSize(metrics.height() + ABOVE)
            for column, text in enumerate(WIDEST):  # of live ones the texts grow with the time
                self.setColumnWidth(column, metrics.horizontalAdvance(text) + BESIDE)

    def reading(self, column: str, label: str) -> str:
        """What stands in a track's row."""
        return self.text([head for head, _ in self._heads].index(label), HEADS.index(column))

    def words(self) -> str:
        """The table as text, for the clipboard."""
        shown = [head for column, head in enumerate(HEADS) if not self.isColumnHidden(column)]
        lines = ["\t".join(["", *shown])]
        lines += ["\t".join([label, *(self.reading(head, label) for head in shown)]) for label, _ in self._heads]
        return "\n".join(lines)


def _texts(timing: Timing) -> tuple[str, str, str]:
    if not math.isfinite(timing.on_s):
        return DASH, DASH, DASH
    share = f" ({100 * timing.on_s / timing.known_s:.3g} %)" if timing.known_s > 0 else ""
    edges = f"{timing.rises} ↑ {timing.falls} ↓" if timing.rises or timing.falls else "none"
    return f"{seconds(timing.on_s)}{share}", edges, seconds(timing.period_s)
