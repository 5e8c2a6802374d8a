"""What a teach table does, stage by stage: the instructions of its module, which play-back sends as well.

The first place is approached axis by axis with absolute moves; from there every move is coordinated and counted from
the place before it, in whole counts of both axes, so that nothing adds up. Where X and Y have different counts per
unit, places are the nearest ones that are whole in both; what is missing is carried into the next move.
"""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Iterator
from enum import StrEnum
from fractions import Fraction

from codegen.bows import Point, through_ends
from codegen.document import Document
from codegen.fields import NONE, Dimension, PerAxisText, base_letter
from codegen.instructions import (
    CircularPath,
    Instruction,
    LinearPath,
    Output,
    SingleAxisMove,
    Wait,
    WaitForCondition,
)
from codegen.instructions.flow import InputLevel
from codegen.instructions.io import Level, OutputMode
from codegen.instructions.motion import MoveMode, WaitFor
from codegen.instructions.path_parts import Piece, Shape, Stretch, Turn
from codegen.instructions.waits import WaitKind
from codegen.numbers import decimal, nearest, plain
from codegen.paths import in_axes, mirrored
from codegen.program import Program, Step
from codegen.setup import Setup
from codegen.teach import BYTE, Row, Table, counts_of, exact

AXES = "XY"
ANGLE_PLACES = 4  # decimals of a degree; the controller's grain is 1/256 degree (commands.md, CR)


class Kind(StrEnum):
    """What a stage is."""

    APPROACH = "approach"
    PATH = "path"
    WAIT = "wait"
    OUTPUT = "output"
    PAUSE = "pause"


@dc.dataclass(frozen=True)
class Stage:
    """One thing after the other: rows (from 0, both included), instructions, and where a move of it ends, in counts."""

    kind: Kind
    first: int
    last: int
    instructions: tuple[Instruction, ...]
    end: tuple[int, int] | None = None
    slack: int = 0  # counts that the end of an arc may be away from there


def stages(table: Table, setup: Setup) -> tuple[Stage, ...]:
    """A correct table as stages."""
    return tuple(_Stages(table, setup).run())


def module(table: Table, setup: Setup, name: str) -> Document:
    """The table as a program of its own that any program for this machine can import."""
    instructions = [each for stage in stages(table, setup) for each in stage.instructions]
    steps = tuple(Step(f"t{number}", each) for number, each in enumerate(instructions, 1))
    words = f"Taught: {sum(row.moves for row in table.rows)} places of X and Y."
    return Document(program=Program(name=name, description=words, main=steps), setup=setup)


class _Stages:
    """Walks the rows and keeps in mind where the axes are by then."""

    def __init__(self, table: Table, setup: Setup) -> None:
        self.table, self.setup = table, setup
        self.base = base_letter(setup, AXES)
        scales = [setup.axis(letter).scale for letter in AXES]
        self.grain = [scale / setup.axis(self.base).scale for scale in scales]  # counts of the axis in one of the path
        self.whole = [grain.denominator for grain in self.grain]  # counts of the path that are whole in the axis
        self.scales = scales
        self.at: tuple[Fraction, Fraction] | None = None  # counts

    def run(self) -> Iterator[Stage]:
        chain: list[int] = []
        for number, row in enumerate(self.table.rows):
            if row.moves and self.at is None:
                yield self._approach(number, row)
            elif row.moves:
                chain.append(number)
            if chain and not row.through:
                yield from self._path(chain)
                chain = []
            yield from self._standing(number, row)

    # ------------------------------------------------------------------- moves

    def _approach(self, number: int, row: Row) -> Stage:
        end = counts_of(row, self.setup)
        self.at = (Fraction(end[0]), Fraction(end[1]))
        moves = tuple(
            SingleAxisMove(
                axis=letter, mode=MoveMode.TO, position=text, speed=row.speed, acceleration=row.acceleration,
                deceleration=row.deceleration, wait=WaitFor.NOTHING,
            )
            for letter, text in zip(AXES, (row.x, row.y), strict=True)
        )  # fmt: skip
        return Stage(Kind.APPROACH, number, number, (*moves, WaitForCondition(kind=WaitKind.MOTION, axes=AXES)), end)

    def _path(self, chain: list[int]) -> Iterator[Stage]:
        """Moves without a stop between them are one path; those without a way are left out."""
        assert self.at is not None, "the first place was approached"
        origin, pieces, rows = self.at, [], []
        for number in chain:
            row = self.table.rows[number]
            piece, there = self._piece(row, origin, self.at)
            if piece is not None:
                pieces.append(piece)
                rows.append(row)
                self.at = there
        if not pieces:
            return
        end = int(self.at[0]), int(self.at[1])
        yield Stage(Kind.PATH, chain[0], chain[-1], (self._instruction(pieces, rows),), end, self._slack(pieces[-1]))

    def _slack(self, last: Piece) -> int:
        """Both angles of an arc are whole grains, its radius whole counts."""
        if last.shape is not Shape.ARC:
            return 0
        counts = float(exact(last.radius)) * float(max(self.scales))
        return math.ceil(counts * math.radians(2 / 256) + 2 * float(max(self.grain)))

    def _instruction(self, pieces: list[Piece], rows: list[Row]) -> Instruction:
        first = rows[0]
        own = [
            dc.replace(piece, speed="" if row.speed == first.speed else row.speed)
            for piece, row in zip(pieces, rows, strict=True)
        ]
        if any(piece.shape is Shape.ARC for piece in own):
            path: CircularPath | LinearPath = CircularPath(axes=AXES, segments=tuple(own))
        else:
            path = LinearPath(axes=AXES, segments=tuple(Stretch(to=each.to, speed=each.speed) for each in own))
        return dc.replace(path, speed=first.speed, acceleration=first.acceleration, deceleration=first.deceleration)

    def _piece(
        self, row: Row, origin: tuple[Fraction, Fraction], at: tuple[Fraction, Fraction]
    ) -> tuple[Piece | None, tuple[Fraction, Fraction]]:
        """A line or an arc of the path, and where it leads; none where it is there already."""
        target = counts_of(row, self.setup)
        ways = zip(target, origin, self.grain, self.whole, strict=True)
        whole = [nearest((end - start) / grain / step) * step for end, start, grain, step in ways]
        x, y = (start + count * grain for start, count, grain in zip(origin, whole, self.grain, strict=True))
        if (x, y) == at:
            return None, at
        if row.sweep:
            return self._arc(row, at, (x, y)), (x, y)
        return Piece(to=self._texts(whole)), (x, y)

    def _texts(self, counts: list[int]) -> PerAxisText:
        x, y = (plain(self.setup.from_counts(Dimension.DISTANCE, self.base, count)) for count in counts)
        return (x, y, *NONE[2:])

    def _arc(self, row: Row, at: tuple[Fraction, Fraction], there: tuple[Fraction, Fraction]) -> Piece:
        bow = through_ends(self._units(at), self._units(there), float(exact(row.sweep)))
        start, sweep = in_axes(bow.angle, bow.sweep, mirrored(self.setup, AXES))  # the same way there and back
        return Piece(
            shape=Shape.ARC,
            radius=decimal(Fraction(bow.radius), 9),
            start=decimal(Fraction(start), ANGLE_PLACES),
            sweep=decimal(Fraction(abs(sweep)), ANGLE_PLACES),
            turn=Turn.CCW if sweep > 0 else Turn.CW,
        )

    def _units(self, counts: tuple[Fraction, Fraction]) -> Point:
        x, y = (float(count / scale) for count, scale in zip(counts, self.scales, strict=True))
        return x, y

    # ----------------------------------------------------------- standing still

    def _standing(self, number: int, row: Row) -> Iterator[Stage]:
        """What a row does when its move has ended: wait, output, pause."""
        if row.wait:
            level = InputLevel.HIGH if exact(row.wait) > 0 else InputLevel.LOW
            wait = WaitForCondition(kind=WaitKind.INPUT, input=plain(abs(exact(row.wait))), level=level)
            yield Stage(Kind.WAIT, number, number, (wait,))
        if row.output:
            yield Stage(Kind.OUTPUT, number, number, (output_of(row.output),))
        if row.pause:
            yield Stage(Kind.PAUSE, number, number, (Wait(time=row.pause, exactly=True),))


def output_of(text: str) -> Output:
    """`3` on, `-3` off, `0x0F` all at once (SSC manual l.2792)."""
    if BYTE.match(text):
        return Output(mode=OutputMode.PORT, byte=str(int(text, 16)))
    level = Level.ON if exact(text) > 0 else Level.OFF
    return Output(mode=OutputMode.CHANNEL, output=plain(abs(exact(text))), level=level)


def drawn(table: Table, setup: Setup) -> list[Point]:
    """The way of the table in user units, for pictures: ends of lines, points on arcs."""
    points: list[Point] = []
    for row in table.rows:
        if not row.moves:
            continue
        here = (float(exact(row.x)), float(exact(row.y)))
        if row.sweep and points and points[-1] != here and exact(row.sweep):
            bow = through_ends(points[-1], here, float(exact(row.sweep)))
            points += bow.points(bow.radius / 500)
        else:
            points.append(here)
    return points
