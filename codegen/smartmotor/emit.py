"""What instructions are in SmartMotor code: P, V, A, G and X.

Speeds are counts per sample × 65536, accelerations counts per sample² × 65536, a sample is 245.76 µs
(smartmotor-4.76.txt, RSP: 24576 × 10 ns).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from fractions import Fraction
from typing import Any, TypeAlias

from codegen.fields import value_of
from codegen.instructions import (
    ALL,
    Comment,
    Instruction,
    MotionParameters,
    SingleAxisMove,
    StopMotion,
)
from codegen.instructions.motion import MoveMode, WaitFor, Which
from codegen.numbers import nearest
from codegen.setup import Setup

SAMPLE_S = Fraction(24576, 100_000_000)
FRACTIONS = 65536
Emitter: TypeAlias = Callable[[Any, Setup], Iterator[str]]


class NotYet(Exception):
    """A value this small emitter cannot write: one sentence."""


def _number(text: str, factor: Fraction) -> int:
    value = value_of(text)
    if not isinstance(value, Fraction):
        raise NotYet("Expressions are not written for a SmartMotor yet")
    return nearest(value * factor)


def _speed(text: str, setup: Setup) -> int:
    return _number(text, setup.axis("X").scale * SAMPLE_S * FRACTIONS)


def _acceleration(text: str, setup: Setup) -> int:
    return _number(text, setup.axis("X").scale * SAMPLE_S**2 * FRACTIONS)


def single_axis_move(move: SingleAxisMove, setup: Setup) -> Iterator[str]:
    """Acceleration, speed, target, go: `A=… V=… P=… G`."""
    scale = setup.axis("X").scale
    if move.acceleration:
        yield f"A={_acceleration(move.acceleration, setup)}"
    match move.mode:
        case MoveMode.AT:
            yield "MV"
            yield f"V={_speed(move.jog_speed, setup)}"
        case MoveMode.TO | MoveMode.BY:
            yield "MP"
            if move.speed:
                yield f"V={_speed(move.speed, setup)}"
            yield (
                f"P={_number(move.position, scale)}"
                if move.mode is MoveMode.TO
                else f"D={_number(move.distance, scale)}"
            )
    if move.begin:
        yield "G"
        if move.mode is not MoveMode.AT and move.wait is not WaitFor.NOTHING:
            yield "TWAIT"


def motion_parameters(parameters: MotionParameters, setup: Setup) -> Iterator[str]:
    """`A=…` and `V=…` of its one axis."""
    if parameters.acceleration[0]:
        yield f"A={_acceleration(parameters.acceleration[0], setup)}"
    if parameters.speed[0]:
        yield f"V={_speed(parameters.speed[0], setup)}"


def stop_motion(stop: StopMotion, setup: Setup) -> Iterator[str]:
    """`X` slows down and holds; with the program it ends as well."""
    yield "X"
    if stop.which is Which.EVERYTHING:
        yield "END"
    elif stop.wait:
        yield "TWAIT"


def comment(comment: Comment, setup: Setup) -> Iterator[str]:
    """A remark of the source."""
    yield from (f"'{line}" for line in comment.text.splitlines() if comment.in_code)


EMITTERS: Mapping[type[Instruction], Emitter] = {
    Comment: comment,
    MotionParameters: motion_parameters,
    SingleAxisMove: single_axis_move,
    StopMotion: stop_motion,
}
CANNOT: Mapping[type[Instruction], str] = {
    kind: "not written for a SmartMotor yet" for kind in ALL if kind not in EMITTERS
}


def lines(instruction: Instruction, setup: Setup) -> tuple[str, ...]:
    """What a correct instruction is in SmartMotor code."""
    return tuple(EMITTERS[type(instruction)](instruction, setup))
