"""A path as it is built: lines and arcs with their start and end, and the corners at which the axes would jerk."""

from __future__ import annotations

import math
from typing import Any

from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QPainter, QPainterPath, QPaintEvent, QPen
from PySide6.QtWidgets import QSizePolicy, QWidget

from codegen.paths import Drawn, path_of
from codegen.setup import Setup
from widgets.form.offers import Offers
from widgets.parts.look import look

EDGE = 22  # px kept free around the path, for the letters
DOT = 3.5


class PathPicture(QWidget):
    """Paints what plain numbers tell of a path of two axes; the rest it says in words."""

    def __init__(self, offers: Offers) -> None:
        super().__init__()
        self.setup: Setup = offers.setup
        self.path: tuple[Drawn, ...] = ()
        self.axes = ""
        self.segments = 0
        self.setMinimumSize(200, 136)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setAccessibleName("Picture of the path")

    def sizeHint(self) -> QSize:
        """No more than there is room."""
        return self.minimumSize()

    def show_instruction(self, instruction: Any) -> None:
        """Another path."""
        self.axes, self.segments = instruction.axes, len(instruction.segments)
        self.path = path_of(instruction, self.setup)
        self.setAccessibleDescription(self.words)
        self.setToolTip(self.words)
        self.update()

    @property
    def words(self) -> str:
        """Where the path ends, its corners, or why nothing is drawn."""
        if not self.path:
            return "Two axes and plain numbers are drawn here"
        end = ", ".join(
            f"{letter} {round(place, 4):g} {self.setup.axis(letter).symbol}"
            for letter, place in zip(self.axes, self.path[-1].end, strict=True)
        )
        corners = [f"{number}: {piece.corner:.0f}°" for number, piece in enumerate(self.path, 1) if piece.corner]
        turns = f"; corners at the start of segment {', '.join(corners)}" if corners else ""
        part = f"segments 1 to {len(self.path)}: " if len(self.path) < self.segments else ""
        return f"{part}ends at {end} from its start{turns}"

    # ---- painting

    def paintEvent(self, event: QPaintEvent) -> None:
        """Axes, path, ends, corners, words."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(look().colour("line"))
        painter.setBrush(look().colour("surface"))
        painter.drawRect(QRectF(self.rect()).adjusted(0.5, 0.5, -0.5, -0.5))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setFont(look().small_font())
        height = painter.fontMetrics().height()
        words = QRectF(6, self.height() - 2 * height - 4, self.width() - 12, 2 * height)
        painter.setPen(look().colour("quiet"))
        painter.drawText(words, int(Qt.AlignmentFlag.AlignBottom) | int(Qt.TextFlag.TextWordWrap), self.words)
        if self.path:
            self._path(painter, QRectF(EDGE, EDGE / 2, self.width() - 2 * EDGE, words.top() - EDGE))

    def _path(self, painter: QPainter, room: QRectF) -> None:
        line = _outline(self.path)
        box = line.boundingRect().united(QRectF(-1e-9, -1e-9, 2e-9, 2e-9))
        scale = min(room.width() / max(box.width(), 1e-9), room.height() / max(box.height(), 1e-9))
        flip_x, flip_y = (self.setup.axis(letter).mirrored for letter in self.axes)
        right, up = (-scale if flip_x else scale), (scale if flip_y else -scale)
        middle = box.center()

        def at(point: tuple[float, float]) -> QPointF:
            return QPointF(
                room.center().x() + (point[0] - middle.x()) * right, room.center().y() + (point[1] - middle.y()) * up
            )

        origin = at((0.0, 0.0))
        self._arrows(painter, origin, math.copysign(1, right), math.copysign(1, up))
        shape = QPainterPath()
        for number in range(line.elementCount()):
            element = line.elementAt(number)
            point = at((element.x, element.y))
            if number == 0:
                shape.moveTo(point)
            else:
                shape.lineTo(point)
        painter.setPen(QPen(look().colour("accent"), 2))
        painter.drawPath(shape)
        painter.setBrush(look().colour("surface"))
        painter.drawEllipse(origin, DOT, DOT)
        painter.setBrush(look().colour("accent"))
        painter.drawEllipse(at(self.path[-1].end), DOT, DOT)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(QPen(look().colour("warning"), 2))
        for piece in self.path:
            if piece.corner:
                painter.drawEllipse(at(piece.start), 2 * DOT, 2 * DOT)

    def _arrows(self, painter: QPainter, origin: QPointF, right: float, up: float) -> None:
        """The directions of the two axes, in their colours."""
        tips = (QPointF(26 * right, 0), QPointF(0, 26 * up))
        beside = (QPointF(0, -9 * up), QPointF(-9 * right, 0))  # the letters, where the path is not
        for letter, tip, aside in zip(self.axes, tips, beside, strict=True):
            painter.setPen(QPen(look().axis(letter), 1.5))
            painter.drawLine(origin, origin + tip)
            place = origin + tip + aside
            painter.drawText(QRectF(place.x() - 8, place.y() - 8, 16, 16), Qt.AlignmentFlag.AlignCenter, letter)


def _outline(path: tuple[Drawn, ...]) -> QPainterPath:
    """The path in user units, arcs as short chords."""
    line = QPainterPath(QPointF(*path[0].start))
    for piece in path:
        if piece.centre is None:
            line.lineTo(QPointF(*piece.end))
            continue
        steps = max(2, min(720, math.ceil(abs(piece.sweep) / 3)))
        for step in range(1, steps + 1):
            angle = math.radians(piece.angle + piece.sweep * step / steps)
            x, y = piece.centre
            line.lineTo(QPointF(x + piece.radius * math.cos(angle), y + piece.radius * math.sin(angle)))
    return line
