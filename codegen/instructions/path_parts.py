"""What paths are made of: lines and arcs, their speeds and ends, and what a machine asks of them."""

# ruff: noqa: RUF009  (value() declares a field as dataclasses.field does)

from __future__ import annotations

import dataclasses as dc
from collections.abc import Sequence
from enum import StrEnum
from fractions import Fraction

from codegen.fields import (
    AXES,
    NONE,
    Choice,
    Dimension,
    Flag,
    Number,
    PathQuantity,
    PerAxis,
    PerAxisText,
    Quantity,
    Smoothing,
    base_letter,
    value,
    value_of,
)
from codegen.instructions.instruction import Instruction
from codegen.paths import SHARPEST, corners, legs, turns_of
from codegen.setup import Setup

LONGEST_ARC = 450_000_000  # radius in counts times sweep in degrees (commands.md 7)
WIDEST_SCALE = 65535  # ES (commands.md, coordinated)


class Shape(StrEnum):
    LINE = "line"
    ARC = "arc"


class Turn(StrEnum):
    CCW = "ccw"
    CW = "cw"


class Ending(StrEnum):
    STOP = "stop"
    CONTINUE = "continue"


class Measured(StrEnum):
    POINTS = "points"
    STEPS = "steps"


_LINE = {"shape": Shape.LINE}
_ARC = {"shape": Shape.ARC}
FIRST = {"continues": False}
_LAST = {"ending": Ending.STOP}
SEGMENT_SPEED = PathQuantity(
    label="Speed",
    dimension=Dimension.SPEED,
    positive=True,
    required=False,
    least_counts=2,
    help="Speed of this segment; empty: that of the path.",
)


@dc.dataclass(frozen=True, kw_only=True)
class Piece:
    """A line or an arc of a path in a plane."""

    sentence = "[line to {to}|arc of radius {radius} from {start} by {sweep} {turn}][ at {speed}]"

    shape: Shape = value(
        Choice(
            label="Shape", kind=Shape, words={Shape.LINE: "Line", Shape.ARC: "Arc"}, help="A straight line or an arc."
        ),
        Shape.LINE,
    )
    to: PerAxisText = value(
        PerAxis(
            label="To",
            of=Quantity(label="To", dimension=Dimension.DISTANCE),
            when=_LINE,
            help="Where the line ends, measured from the start of the path; an empty axis stays where it is.",
        ),
        NONE,
    )
    radius: str = value(
        PathQuantity(
            label="Radius",
            dimension=Dimension.DISTANCE,
            positive=True,
            least_counts=10,
            most_counts=6_000_000,
            when=_ARC,
            help="Radius of the arc.",
        ),
        "",
    )
    start: str = value(
        Number(
            label="Start angle",
            low=-32000,
            high=32000,
            suffix="deg",
            when=_ARC,
            help="Where on its circle the arc begins: 0° lies along the first axis, counter-clockwise counts up.",
        ),
        "0",
    )
    sweep: str = value(
        Number(
            label="Sweep angle",
            low=0.01,
            high=32000,
            suffix="deg",
            when=_ARC,
            help="How far the arc goes round.",
        ),
        "90",
    )
    turn: Turn = value(
        Choice(
            label="Direction",
            kind=Turn,
            words={Turn.CCW: "CCW", Turn.CW: "CW"},
            phrases={Turn.CCW: "counter-clockwise", Turn.CW: "clockwise"},
            when=_ARC,
            help="Which way round the arc goes: CCW counter-clockwise, CW clockwise.",
        ),
        Turn.CCW,
    )
    speed: str = value(SEGMENT_SPEED, "")


@dc.dataclass(frozen=True, kw_only=True)
class Stretch:
    """One straight segment of several axes."""

    sentence = "{to}[ at {speed}]"

    to: PerAxisText = value(
        PerAxis(
            label="Displacement",
            of=Quantity(label="Displacement", dimension=Dimension.DISTANCE),
            help="How far each axis goes, or where to: as Displacements says. Empty: the axis does not move.",
        ),
        NONE,
    )
    speed: str = value(SEGMENT_SPEED, "")


CONTINUES = Flag(
    label="Continue the last path",
    phrase="Continue the path",
    off_phrase="Path",
    help="Goes on with the path of the instruction before, which ends with “continue”.",
)
SPEED = PathQuantity(
    label="Speed",
    dimension=Dimension.SPEED,
    positive=True,
    required=False,
    least_counts=2,
    help="Speed along the path; empty keeps the present one.",
)
ACCELERATION = PathQuantity(
    label="Acceleration",
    dimension=Dimension.ACCELERATION,
    positive=True,
    required=False,
    when=FIRST,
    help="How quickly the path speeds up; empty keeps the present one.",
)
DECELERATION = PathQuantity(
    label="Deceleration",
    dimension=Dimension.ACCELERATION,
    positive=True,
    required=False,
    when=FIRST,
    help="How quickly the path slows down; empty keeps the present one.",
)
SMOOTHING = Smoothing(
    label="Smoothing", axis="", when=FIRST, help="0 (none) to 255 (most) rounds the corners of the speed profile."
)
ENDING = Choice(
    label="End of move",
    kind=Ending,
    words={Ending.STOP: "Stop", Ending.CONTINUE: "Continue"},
    phrases={Ending.STOP: "", Ending.CONTINUE: "to be continued"},
    help="Stop at the end, or go on with the path of the next path instruction.",
)
BEGIN = Flag(
    label="Begin now", off_phrase="prepared but not begun", when=_LAST, help="Off: a Begin Motion starts the path."
)
WAIT = Flag(
    label="Wait until finished",
    phrase="wait until the profile has ended",
    when={"ending": Ending.STOP, "begin": True},
    help="Hold the program until the profile of the path has ended.",
)
RAMPS = "[ at {speed}][, accelerating at {acceleration}][, decelerating at {deceleration}][, smoothing {smoothing}]"
END_OF_PATH = "[, {ending}][, {begin}][, then {wait}]"


class OnAPath:
    """What all path instructions ask of the machine."""

    axes: str
    speed: str
    continues: bool
    ending: Ending

    def path_problem(self, setup: Setup, rows: Sequence[Piece | Stretch]) -> tuple[str, str] | None:
        """Axes that cannot share a path on this machine, or rows that name other axes."""
        if problem := units_problem(setup, self.axes):
            return "axes", problem
        for number, row in enumerate(rows):
            others = [each for each, text in zip(AXES, row.to, strict=True) if text and each not in self.axes]
            if others and (not isinstance(row, Piece) or row.shape is Shape.LINE):
                return "segments", f"Segments, row {number + 1}: {others[0]} is no axis of this path"
            if row.speed and not self.speed:
                return "speed", f"Speed is missing: row {number + 1} has its own, the others need that of the path"
        if len(rows) > 511 and (self.continues or self.ending is Ending.CONTINUE):
            return "segments", "More than 511 segments must begin and end in one instruction"
        return None


def units_problem(setup: Setup, letters: str) -> str | None:
    """Why axes cannot share a path: one speed along it needs one unit."""
    first = setup.axis(letters[0])
    for letter in letters[1:]:
        axis = setup.axis(letter)
        if axis.symbol != first.symbol:
            return f"{letters[0]} has the unit {first.symbol} and {letter} {axis.symbol}: a path needs one unit"
    return None


def ellipse(setup: Setup, letters: str) -> tuple[int, int] | None:
    """The numbers of `ES` that make circles of two axes with different counts per unit; None where none do."""
    ratio = setup.axis(letters[0]).scale / setup.axis(letters[1]).scale
    if max(ratio.numerator, ratio.denominator) <= WIDEST_SCALE:
        return ratio.numerator, ratio.denominator
    close = ratio.limit_denominator(WIDEST_SCALE if ratio <= 1 else max(int(WIDEST_SCALE / ratio), 1))
    exact = close and abs(close / ratio - 1) <= Fraction(1, 1_000_000) and close.numerator <= WIDEST_SCALE
    return (close.numerator, close.denominator) if exact else None


class InAPlane(OnAPath):
    """What paths of lines and arcs share."""

    segments: tuple[Piece, ...]

    def plane_problem(self) -> tuple[str, str] | None:
        """What is wrong with the axes and the pieces, on any machine."""
        if len(self.axes) != 2:
            return "axes", "Axes: choose the two axes of the plane"
        for number, row in enumerate(self.segments):
            if row.shape is Shape.LINE and not any(row.to):
                return "segments", f"Segments, row {number + 1}: the line goes nowhere"
        return next(
            (
                ("segments", f"Segments, row {number + 1}: enter both axes, because it is not known where the path is")
                for number in legs(self).unknown
            ),
            None,
        ) or next(
            (("segments", f"Segments, row {number + 1}: the line has no length") for number in legs(self).empty), None
        )

    def arc_problem(self, setup: Setup) -> tuple[str, str] | None:
        """Arcs longer than the controller takes, scales it cannot join."""
        if ellipse(setup, self.axes) is None:
            text = f"The counts per unit of {self.axes[0]} and {self.axes[1]} are in no ratio the controller can use"
            return "axes", text
        for number, row in enumerate(self.segments):
            radius, sweep = value_of(row.radius), value_of(row.sweep)
            if row.shape is Shape.ARC and isinstance(radius, Fraction) and isinstance(sweep, Fraction):
                counts = setup.counts(Dimension.DISTANCE, base_letter(setup, self.axes), radius)
                if counts * sweep > LONGEST_ARC:
                    return "segments", f"Segments, row {number + 1}: the arc is longer than the controller takes"
        return None


def corner_advice(path: Instruction, setup: Setup) -> tuple[str, str] | None:
    """Says where the path turns sharply at full speed."""
    found = corners(turns_of(path, setup), SHARPEST)
    if not found:
        return None
    number, angle = found[0]
    more = f" (and {len(found) - 1} more)" if len(found) > 1 else ""
    return "segments", f"Row {number + 1} turns by {angle:.0f}° at full speed{more}: round the corner, or stop there"
