"""A table as curves: position, speed and acceleration of every axis in it, over one cycle or over the whole contour."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate, pairwise
from typing import Any

from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QSizePolicy, QWidget

from codegen.instructions import ContourMode
from codegen.tables import Grid, read_table
from widgets.form.offers import Offers
from widgets.parts.look import look

LANES = ("position", "speed", "acceleration")
Curve = tuple[float, ...]


def curves(column: Sequence[float], *, steps: bool) -> tuple[Curve, Curve, Curve]:
    """Position, its change from row to row, and the change of that; `steps`: the rows are changes already."""
    position = (0.0, *accumulate(column)) if steps else tuple(column)
    speed = tuple(after - before for before, after in pairwise(position))
    return position, speed, tuple(after - before for before, after in pairwise(speed))


class CurvePicture(QWidget):
    """Three lanes, one above the other, each with its own scale; one colour an axis."""

    def __init__(self, offers: Offers) -> None:
        super().__init__()
        self.found: dict[str, tuple[Curve, Curve, Curve]] = {}
        self.setMinimumSize(200, 130)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setAccessibleName("Curves of the table")

    def sizeHint(self) -> QSize:
        """No more than there is room."""
        return self.minimumSize()

    def show_instruction(self, instruction: Any) -> None:
        """Another table."""
        grid = read_table(instruction.table)
        letters = instruction.column_axes
        whole = isinstance(grid, Grid) and grid.columns == len(letters) and len(grid.rows) > 1
        self.found = {}
        if isinstance(grid, Grid) and whole:
            for number, letter in enumerate(letters):
                if letter:
                    column = [float(cell or 0) for cell in grid.column(number)]
                    self.found[letter] = curves(column, steps=isinstance(instruction, ContourMode))
        self.setAccessibleDescription(self.words)
        self.setToolTip(self.words)
        self.update()

    @property
    def words(self) -> str:
        """What is drawn, or how something comes to be drawn."""
        if not self.found:
            return "Position, speed and acceleration are drawn here once the table has two rows of numbers"
        ends = ", ".join(f"{letter} {min(lanes[0]):g} to {max(lanes[0]):g}" for letter, lanes in self.found.items())
        return f"Position ({ends}), speed and acceleration from row to row"

    # ---- painting

    def paintEvent(self, event: QPaintEvent) -> None:
        """The lanes with their names, then the curves."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(look().colour("line"))
        painter.setBrush(look().colour("surface"))
        painter.drawRect(QRectF(self.rect()).adjusted(0.5, 0.5, -0.5, -0.5))
        painter.setFont(look().small_font())
        if not self.found:
            painter.setPen(look().colour("quiet"))
            inside = QRectF(self.rect()).adjusted(8, 8, -8, -8)
            painter.drawText(inside, int(Qt.AlignmentFlag.AlignCenter) | int(Qt.TextFlag.TextWordWrap), self.words)
            return
        height = self.height() / len(LANES)
        for lane, name in enumerate(LANES):
            room = QRectF(8, lane * height + 4, self.width() - 16, height - 8)
            self._lane(painter, room, lane)
            corner = Qt.AlignmentFlag.AlignTop | Qt.AlignmentFlag.AlignRight
            painter.fillRect(painter.boundingRect(room, corner, name), look().colour("surface"))
            painter.setPen(look().colour("quiet"))
            painter.drawText(room, corner, name)

    def _lane(self, painter: QPainter, room: QRectF, lane: int) -> None:
        values = [value for lanes in self.found.values() for value in lanes[lane]]
        low, high = min([*values, 0.0]), max([*values, 0.0])
        span = (high - low) or 1.0
        painter.setPen(QPen(look().colour("line"), 1))
        zero = room.bottom() - (0 - low) / span * room.height()
        painter.drawLine(QPointF(room.left(), zero), QPointF(room.right(), zero))
        for letter, lanes in self.found.items():
            curve = lanes[lane]
            wide = room.width() / max(1, len(curve) - (lane == 0))
            points: list[QPointF] = []
            for number, value in enumerate(curve):
                y = room.bottom() - (value - low) / span * room.height()
                points.append(QPointF(room.left() + number * wide, y))
                if lane:  # constant from row to row
                    points.append(QPointF(room.left() + (number + 1) * wide, y))
            painter.setPen(QPen(look().axis(letter), 1.8))
            painter.drawPolyline(points)
