"""A table as curves: position, speed and acceleration of every axis in it; points of the position can be dragged."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from fractions import Fraction
from itertools import pairwise
from typing import Any

from PySide6.QtCore import QPointF, QRectF, Qt, Signal
from PySide6.QtGui import QKeyEvent, QPainter, QPen

from codegen.courses import Course
from codegen.fields import Dimension
from codegen.instructions import ElectronicCam
from codegen.numbers import decimal, shown
from widgets.form.canvas import Canvas
from widgets.form.offers import Offers
from widgets.parts.look import look

PARTS = (0.5, 0.25, 0.25)  # of the height: position, speed, acceleration
LANES = ("position", "speed", "acceleration")
DIMENSIONS = (Dimension.POSITION, Dimension.SPEED, Dimension.ACCELERATION)
LEFT, RIGHT = 58, 10  # px beside the curves, for the numbers of the scale
DOT = 3.5
LIFT = 5  # px that the name of the positions stands above their highest dot
MOST_DOTS = 130  # more points are not drawn one by one
REACH = 9.0  # px from a point at which it is taken hold of


class CurvePicture(Canvas):
    """Three lanes, one above the other, each with its own scale; one colour an axis."""

    point_moved = Signal(str, int, str, bool)  # axis, row, new position as typed, whether that ends the drag
    row_wanted = Signal(int)

    def __init__(self, offers: Offers) -> None:
        super().__init__("Curves of the table")
        self.setup = offers.setup
        self.instruction: Any = None
        self.courses: tuple[Course, ...] = ()
        self.numbers: list[tuple[list[float], ...]] = []  # the same as floats, for painting
        self.marked = -1  # the point of the row the person is in
        self.held: tuple[int, int] | None = None  # which course, which point
        self._spans: tuple[tuple[float, float], ...] = ((0.0, 1.0),) * 3
        self._text = ""
        self.setMinimumSize(300, 304)

    # ---- what it is about

    def show_instruction(self, instruction: Any) -> None:
        """Another table."""
        self.instruction = instruction
        self.courses = instruction.courses(self.setup) if _is_drawn(instruction) else ()
        self.numbers = [
            tuple([float(each) for each in values] for values in (c.at, c.position, c.speed, c.acceleration))
            for c in self.courses
        ]
        if self.held is None:  # while something is dragged its scale stays
            self._spans = tuple(map(_span, ([c[lane + 1] for c in self.numbers] for lane in range(3))))
        self.setAccessibleDescription(self.words)
        self.setToolTip("Drag a point to move it; wheel: closer; double click: all of it" if self.courses else "")
        self.update()

    def mark_row(self, row: int) -> None:
        """The row of the table the person is in."""
        self.marked = row + self._offset if row >= 0 else -1
        self.update()

    @property
    def _offset(self) -> int:
        """Steps lead from one position to the next: the position of a row is the one behind it."""
        return 0 if isinstance(self.instruction, ElectronicCam) else 1

    @property
    def words(self) -> str:
        """What is drawn, or how something comes to be drawn."""
        if not self.courses:
            return "Position, speed and acceleration are drawn here once the table has rows of numbers."
        return "; ".join(map(self._about, self.courses)) + self._condition()

    def _about(self, course: Course) -> str:
        low, high = min(course.position), max(course.position)
        letter = course.letter
        speed, hard = course.fastest()[1], course.hardest()[1]
        return (
            f"{letter} {shown(low, 4)} to {shown(high, 4)} {self._unit(0, letter)}, "
            f"up to {shown(speed, 4)} {self._unit(1, letter)} and {shown(hard, 4)} {self._unit(2, letter)}"
        )

    def _condition(self) -> str:
        """For which speed of the master that holds."""
        cam = self.instruction
        if not isinstance(cam, ElectronicCam):
            return ""
        unit = self.setup.unit_text(Dimension.SPEED, cam.master)
        known = cam.master_speed(self.setup)
        return f", with {cam.master} at {shown(known or Fraction(1), 4)} {unit}"

    def _unit(self, lane: int, letter: str) -> str:
        return self.setup.unit_text(DIMENSIONS[lane], letter)

    # ---- where things are

    def _caption(self) -> int:
        return 3 * self.fontMetrics().height() + 4

    def _lane(self, lane: int) -> QRectF:
        """The room of a lane's curve."""
        whole = self.height() - self._caption()
        top = sum(PARTS[:lane]) * whole
        above = self.fontMetrics().height() + 1 + (0 if lane else LIFT)  # the name of the lane
        return QRectF(LEFT, top + above + 2, self.width() - LEFT - RIGHT, PARTS[lane] * whole - above - 9)

    def _at(self, lane: int) -> Callable[[float, float], QPointF]:
        """From values to the screen; only the length is zoomed."""
        room, (low, high) = self._lane(lane), self._spans[lane]
        first, last = self.numbers[0][0][0], self.numbers[0][0][-1]
        wide, span = (last - first) or 1.0, high - low

        def at(place: float, value: float) -> QPointF:
            x = room.left() + (place - first) / wide * room.width()
            return QPointF(self.seen(QPointF(x, 0)).x(), room.bottom() - (value - low) / span * room.height())

        return at

    def point(self, course: int, number: int) -> QPointF:
        """Where a point of the position is on the screen."""
        places, values = self.numbers[course][0], self.numbers[course][1]
        return self._at(0)(places[number], values[number])

    # ---- dragging

    def grab_at(self, place: QPointF) -> bool:
        """Takes hold of the nearest point that can be moved."""
        near = [
            (math.hypot(*(self.point(course, number) - place).toTuple()), course, number)
            for course in range(len(self.courses))
            for number in range(self._offset, len(self.numbers[course][1]))
        ]
        away, course, number = min(near, default=(REACH + 1, 0, 0))
        if away > REACH:
            return False
        self.held = course, number
        self.row_wanted.emit(number - self._offset)
        return True

    def drag_to(self, place: QPointF) -> None:
        """The point follows up and down."""
        if self.held is None:
            return
        room, (low, high) = self._lane(0), self._spans[0]
        value = low + (room.bottom() - place.y()) / room.height() * (high - low)
        self._move(*self.held, value, (high - low) / room.height(), last=False)

    def let_go(self) -> None:
        """The scale fits again."""
        if self.held is not None:
            course, number = self.held
            self.held = None
            self._move(course, number, self.numbers[course][1][number], (1e-9), last=True)
            self.show_instruction(self.instruction)

    def _move(self, course: int, number: int, value: float, grain: float, *, last: bool) -> None:
        """To a number with no more decimals than a pixel is worth."""
        places = max(0, min(9, math.ceil(-math.log10(grain))))
        text = decimal(Fraction(value), places)
        self.point_moved.emit(self.courses[course].letter, number - self._offset, text, last)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Left and right go from point to point, up and down move it (with Shift in small steps)."""
        steps = {Qt.Key.Key_Left: -1, Qt.Key.Key_Right: 1}
        lifts = {Qt.Key.Key_Up: 1, Qt.Key.Key_Down: -1}
        key = Qt.Key(event.key())
        if not self.courses or key not in (*steps, *lifts):
            super().keyPressEvent(event)
            return
        last = len(self.numbers[0][1]) - 1
        if key in steps:
            self.marked = min(max(self.marked + steps[key], self._offset), last)
            self.row_wanted.emit(self.marked - self._offset)
            self.update()
        elif self._offset <= self.marked <= last:
            low, high = self._spans[0]
            step = 10.0 ** (math.floor(math.log10(high - low)) - 2)
            if event.modifiers() & Qt.KeyboardModifier.ShiftModifier:
                step /= 10
            self._move(0, self.marked, self.numbers[0][1][self.marked] + lifts[key] * step, step / 10, last=True)

    # ---- painting

    def draw(self, painter: QPainter) -> None:
        """The lanes with their names, then the curves, then the words."""
        painter.setPen(look().colour("quiet"))
        wrap = int(Qt.TextFlag.TextWordWrap)
        if not self.courses:
            painter.drawText(self.rect().adjusted(12, 8, -12, -8), int(Qt.AlignmentFlag.AlignCenter) | wrap, self.words)
            return
        low = QRectF(8, self.height() - self._caption(), self.width() - 16, self._caption() - 2)
        painter.drawText(low, int(Qt.AlignmentFlag.AlignVCenter) | wrap, self.caption())
        for lane in range(3):
            self._scale(painter, lane)
            painter.save()
            painter.setClipRect(self._lane(lane).adjusted(-6, -6, 6, 6))
            for number in range(len(self.courses)):
                self._curve(painter, lane, number)
            painter.restore()

    def caption(self) -> str:
        """The marked point, else what the curves come to."""
        if not 0 <= self.marked < len(self.numbers[0][0]):
            return self.words
        course = self.courses[0]
        lead = self.instruction.sheet(self.setup).lead.partition(" ")
        where = f"{shown(course.at[self.marked], 5)} ms"
        if self._offset == 0:
            where = f"{lead[0]} {shown(course.at[self.marked], 5)} {lead[2]}"
        places = ", ".join(
            f"{each.letter} {shown(each.position[self.marked], 5)} {self._unit(0, each.letter)}"
            for each in self.courses
        )
        row = self.marked + 1 - self._offset
        return f"{f'Row {row}' if row else 'Start'}, at {where}: {places}. {self.words}"

    def _scale(self, painter: QPainter, lane: int) -> None:
        room, at = self._lane(lane), self._at(lane)
        first = self.numbers[0][0][0]
        low, high = self._spans[lane]
        painter.setPen(QPen(look().colour("line"), 1))
        zero = at(first, min(max(0.0, low), high)).y()
        for y in {zero, room.top(), room.bottom()} if lane == 0 else {zero}:
            painter.drawLine(QPointF(room.left(), y), QPointF(room.right(), y))
        painter.setPen(look().colour("quiet"))
        height = painter.fontMetrics().height()
        right = int(Qt.AlignmentFlag.AlignRight) | int(Qt.AlignmentFlag.AlignVCenter)
        for value in (low, high):
            y = at(first, value).y()
            painter.drawText(QRectF(2, y - height / 2, LEFT - 8, height), right, f"{value:.4g}")
        units = dict.fromkeys(self._unit(lane, each.letter) for each in self.courses)
        name = f"{LANES[lane]}, {' / '.join(units)}"
        above = QRectF(room.left(), room.top() - height - 2 - (0 if lane else LIFT), room.width(), height)
        painter.drawText(above, int(Qt.AlignmentFlag.AlignRight), name)

    def _curve(self, painter: QPainter, lane: int, number: int) -> None:
        places, *lanes = self.numbers[number]
        values, at = lanes[lane], self._at(lane)
        painter.setPen(QPen(look().axis(self.courses[number].letter), 1.8))
        if lane == 1:  # even from row to row
            stretches = zip(pairwise(places), values, strict=True)
            painter.drawPolyline([at(place, value) for ends, value in stretches for place in ends])
            return
        points = [at(place, value) for place, value in zip(places, values, strict=True)]
        painter.drawPolyline(points)
        if lane == 0:
            painter.setBrush(look().colour("surface"))
            for point in points if len(points) <= MOST_DOTS else ():
                painter.drawEllipse(point, DOT, DOT)
            if 0 <= self.marked < len(points):
                painter.setBrush(look().axis(self.courses[number].letter))
                painter.drawEllipse(points[self.marked], DOT + 1.5, DOT + 1.5)
            painter.setBrush(Qt.BrushStyle.NoBrush)


def _is_drawn(instruction: Any) -> bool:
    return not isinstance(instruction, ElectronicCam) or instruction.step == "define"


def _span(curves: Sequence[Sequence[float]]) -> tuple[float, float]:
    """Lowest and highest value, 0 among them, never the same."""
    values = [0.0, *(value for curve in curves for value in curve)]
    low, high = min(values), max(values)
    return (low, high) if high > low else (low - 0.5, high + 0.5)
