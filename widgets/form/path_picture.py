"""A path as it is built: what is there so far, the open segment with its angles, the end, and corners at full speed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from PySide6.QtCore import QPointF, QRectF, Qt, Signal
from PySide6.QtGui import QKeyEvent, QMouseEvent, QPainter, QPainterPath, QPen

from codegen.numbers import shown
from codegen.paths import Drawn, chain, mirrored
from widgets.form.canvas import Canvas
from widgets.form.offers import Offers
from widgets.form.room import room
from widgets.parts.look import look

EDGE = 26  # px kept free around the path, for the letters
DOT = 3.5
ARROW = 26  # px, of an axis in the corner
CORNER = 36  # px beside the path, for the axes
SMALL, LARGE, ROOMY = (232, 142), (380, 280), 820  # px; the larger one where a dialog may be that high
Point = tuple[float, float]


class PathPicture(Canvas):
    """Paints what plain numbers tell of a path of two axes; the rest it says in words."""

    mirror_wanted = Signal(str)  # the axis whose arrow was clicked

    def __init__(self, offers: Offers) -> None:
        super().__init__("Picture of the path")
        self.offers = offers
        self.instruction: Any = None
        self.earlier: tuple[Drawn, ...] = ()
        self.path: tuple[Drawn, ...] = ()
        self.axes = ""
        self.open_row = -1
        self.letters: dict[str, QRectF] = {}  # where the axes can be clicked
        self.setMinimumSize(*(LARGE if room(self).height() > ROOMY else SMALL))
        self.setMouseTracking(True)

    # ---- what it is about

    def show_offers(self, offers: Offers) -> None:
        """Another place in the program, or another machine."""
        self.offers = offers
        if self.instruction is not None:
            self.show_instruction(self.instruction)

    def show_instruction(self, instruction: Any) -> None:
        """Another path."""
        self.instruction, self.axes = instruction, instruction.axes
        before = self.offers.standing.path if instruction.continues else ()
        if any(each.axes != self.axes for each in before):  # type: ignore[attr-defined]
            before = ()
        *earlier, self.path = chain((*before, instruction), self.offers.setup)
        self.earlier = tuple(piece for part in earlier for piece in part)
        if instruction.continues and not before:
            self.path = ()  # nobody knows where it goes on
        self.setAccessibleDescription(self.words)
        self.setToolTip("Click X or Y (or press the key) to turn the picture the way your machine stands")
        self.update()

    def mark_row(self, row: int) -> None:
        """The segment that is open for editing."""
        self.open_row = row
        self.update()

    @property
    def words(self) -> str:
        """Where the path ends, its corners, or why nothing is drawn."""
        if not self.path:
            going_on = self.instruction is not None and self.instruction.continues and len(self.axes) == 2
            return (
                "The path it goes on with is not known here"
                if going_on
                else "Two axes and plain numbers are drawn here"
            )
        corners = [f"{number}: {piece.corner:.0f}°" for number, piece in enumerate(self.path, 1) if piece.corner]
        turns = f"; corners at the start of segment {', '.join(corners)}" if corners else ""
        count = len(self.instruction.segments)
        part = f"segments 1 to {len(self.path)}: " if len(self.path) < count else ""
        return f"{part}ends at {self._place(self.path[-1].end)} from its start{self._absolute()}{turns}"

    def _place(self, point: Sequence[float | Fraction]) -> str:
        setup = self.offers.setup
        return ", ".join(
            f"{letter} {shown(Fraction(round(float(at), 6)).limit_denominator(10**6), 6)} {setup.axis(letter).symbol}"
            for letter, at in zip(self.axes, point, strict=True)
        )

    def _absolute(self) -> str:
        """Where that is on the machine, where the program tells."""
        from_ = [self.offers.standing.place(letter) for letter in self.axes]
        if any(at is None for at in from_):
            return ""
        ends = [float(at or 0) + by for at, by in zip(from_, self.path[-1].end, strict=True)]
        return f" (position {self._place(ends)})"

    # ---- turning the axes

    def letter_at(self, place: QPointF) -> str:
        """The axis whose arrow is there."""
        return next((letter for letter, box in self.letters.items() if box.contains(place)), "")

    def grab_at(self, place: QPointF) -> bool:
        letter = self.letter_at(place)
        if letter:
            self.mirror_wanted.emit(letter)
        return bool(letter)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """A hand over what can be clicked."""
        shape = Qt.CursorShape.PointingHandCursor if self.letter_at(event.position()) else Qt.CursorShape.ArrowCursor
        self.setCursor(shape)
        super().mouseMoveEvent(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """The letter of an axis turns it."""
        letter = event.text().upper()
        if letter and letter in self.axes and len(self.axes) == 2:
            self.mirror_wanted.emit(letter)
        else:
            super().keyPressEvent(event)

    # ---- painting

    def draw(self, painter: QPainter) -> None:
        """Axes, path, the open segment, ends, corners, words."""
        painter.setPen(look().colour("quiet"))
        bottom = int(Qt.AlignmentFlag.AlignBottom) | int(Qt.TextFlag.TextWordWrap)
        words = painter.boundingRect(QRectF(8, 4, self.width() - 16, self.height() - 8), bottom, self.words)
        painter.drawText(words, bottom, self.words)
        self.letters = {}
        if self.path:
            painter.save()
            painter.setClipRect(QRectF(1, 1, self.width() - 2, words.top() - 2))
            self._path(painter, QRectF(EDGE, EDGE / 2, self.width() - 2 * EDGE - CORNER, words.top() - EDGE))
            painter.restore()
            self._arrows(painter, QPointF(self.width() - CORNER, CORNER))

    def _path(self, painter: QPainter, inside: QRectF) -> None:
        whole = _outline((*self.earlier, *self.path))
        box = whole.boundingRect().united(QRectF(-1e-9, -1e-9, 2e-9, 2e-9))
        scale = min(inside.width() / max(box.width(), 1e-9), inside.height() / max(box.height(), 1e-9))
        flip_x, flip_y = mirrored(self.offers.setup, self.axes)
        right, up = (-scale if flip_x else scale), (scale if flip_y else -scale)
        middle = box.center()

        def at(point: Point) -> QPointF:
            away = QPointF((point[0] - middle.x()) * right, (point[1] - middle.y()) * up)
            return self.seen(inside.center() + away)

        if self.earlier:
            painter.setPen(QPen(look().colour("border"), 2))
            painter.drawPath(_on_screen(self.earlier, at))
        painter.setPen(QPen(look().colour("accent"), 2))
        painter.drawPath(_on_screen(self.path, at))
        if 0 <= self.open_row < len(self.path):
            self._open_segment(painter, self.path[self.open_row], at)
        painter.setPen(QPen(look().colour("accent"), 2))
        painter.setBrush(look().colour("surface"))
        painter.drawEllipse(at((0.0, 0.0)), DOT, DOT)
        painter.setBrush(look().colour("accent"))
        painter.drawEllipse(at(self.path[-1].end), DOT, DOT)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(QPen(look().colour("warning"), 2))
        for piece in self.path:
            if piece.corner:
                painter.drawEllipse(at(piece.start), 2 * DOT, 2 * DOT)

    def _open_segment(self, painter: QPainter, piece: Drawn, at: Any) -> None:
        """Bolder than the others; of an arc also centre, radius, start and sweep."""
        painter.setPen(QPen(look().colour("accent"), 4))
        painter.drawPath(_on_screen((piece,), at))
        if piece.centre is None:
            return
        painter.setPen(QPen(look().colour("quiet"), 1, Qt.PenStyle.DashLine))
        centre, start, end = at(piece.centre), at(piece.start), at(piece.end)
        zero = at((piece.centre[0] + piece.radius, piece.centre[1]))
        for tip in (start, end, zero):
            painter.drawLine(centre, tip)
        painter.setPen(QPen(look().colour("warning"), 1.5))
        painter.drawPath(_on_screen((_turn(piece, 0.35, 0.0, piece.angle),), at))
        painter.setPen(QPen(look().colour("accent"), 1.5))
        painter.drawPath(_on_screen((_turn(piece, 0.5, piece.angle, piece.sweep),), at))
        painter.setPen(look().colour("text"))
        row = self.instruction.segments[self.open_row]
        for words, place in (
            (f"R {row.radius}", at(_along(piece, 0.75, piece.angle))),
            (f"{row.start}°", at(_along(piece, 0.42, piece.angle / 2))),
            (f"{row.sweep}° {row.turn}", at(_along(piece, 0.62, piece.angle + piece.sweep / 2))),
        ):
            _label(painter, words, place)

    def _arrows(self, painter: QPainter, origin: QPointF) -> None:
        """The directions of the two axes, in their colours; a click on one turns it."""
        flips = mirrored(self.offers.setup, self.axes)
        ways = (QPointF(-1 if flips[0] else 1, 0), QPointF(0, 1 if flips[1] else -1))
        for letter, way in zip(self.axes, ways, strict=True):
            tip = origin + way * ARROW * 0.6
            painter.setPen(QPen(look().axis(letter), 2))
            painter.drawLine(origin, tip)
            side = QPointF(way.y(), way.x()) * 4
            painter.drawLine(tip, tip - way * 5 + side)
            painter.drawLine(tip, tip - way * 5 - side)
            place = origin + way * (ARROW + 2)
            box = QRectF(place.x() - 10, place.y() - 10, 20, 20)
            self.letters[letter] = box.united(QRectF(origin, tip).normalized().adjusted(-3, -3, 3, 3))
            painter.drawText(box, Qt.AlignmentFlag.AlignCenter, letter)


def _turn(piece: Drawn, part: float, begin: float, sweep: float) -> Drawn:
    """A small arc around the centre of an arc, to show an angle (degrees)."""
    assert piece.centre is not None
    radius = piece.radius * part
    ends = [_around(piece.centre, radius, angle) for angle in (begin, begin + sweep)]
    return Drawn(ends[0], ends[1], piece.centre, radius, begin, sweep)


def _along(piece: Drawn, part: float, angle: float) -> Point:
    assert piece.centre is not None
    return _around(piece.centre, piece.radius * part, angle)


def _around(centre: Point, radius: float, degrees: float) -> Point:
    angle = math.radians(degrees)
    return centre[0] + radius * math.cos(angle), centre[1] + radius * math.sin(angle)


def _label(painter: QPainter, words: str, place: QPointF) -> None:
    """Words on the ground of the picture, so that lines do not cross them."""
    box = painter.boundingRect(QRectF(place.x() - 60, place.y() - 9, 120, 18), Qt.AlignmentFlag.AlignCenter, words)
    painter.fillRect(box.adjusted(-2, 0, 2, 0), look().colour("surface"))
    painter.drawText(box, Qt.AlignmentFlag.AlignCenter, words)


def _on_screen(path: Sequence[Drawn], at: Any) -> QPainterPath:
    """An outline in user units as it is on the screen."""
    line = _outline(path)
    shape = QPainterPath()
    for number in range(line.elementCount()):
        element = line.elementAt(number)
        point = at((element.x, element.y))
        if number == 0:
            shape.moveTo(point)
        else:
            shape.lineTo(point)
    return shape


def _outline(path: Sequence[Drawn]) -> QPainterPath:
    """The path in user units, arcs as short chords."""
    line = QPainterPath(QPointF(*path[0].start))
    for piece in path:
        if piece.centre is None:
            line.lineTo(QPointF(*piece.end))
            continue
        steps = max(2, min(720, math.ceil(abs(piece.sweep) / 3)))
        for step in range(1, steps + 1):
            line.lineTo(QPointF(*_around(piece.centre, piece.radius, piece.angle + piece.sweep * step / steps)))
    return line
