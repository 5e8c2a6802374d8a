"""How far rounding to counts carries a repeated relative move away: judged over all turns of the loops."""

from __future__ import annotations

from fractions import Fraction

from codegen.expressions import Bad, Binary, Expression, Negative, Number, walk
from codegen.fields import AXES, Dimension, value_of
from codegen.instructions import Instruction, Repeat, SingleAxisMove
from codegen.instructions.flow import RepeatMode
from codegen.instructions.motion import MoveMode
from codegen.numbers import plain, shown
from codegen.program import Step, Steps
from codegen.setup import Setup


def turns(repeat: Repeat) -> Fraction:
    """How often a repeat runs; 1 when only the running program knows."""
    count = value_of(repeat.count)
    return count if repeat.mode is RepeatMode.COUNT and isinstance(count, Fraction) else Fraction(1)


def error(steps: Steps, setup: Setup, letter: str) -> Fraction:
    """What one run of the steps is off by on an axis, in user units (sent minus wanted)."""
    total = Fraction(0)
    for step in steps:
        move = step.instruction
        if not step.enabled:
            continue
        if isinstance(move, Repeat):
            total += turns(move) * error(step.body, setup, letter)
        elif isinstance(move, SingleAxisMove) and move.axis == letter:
            if move.mode is MoveMode.TO:
                return Fraction(0)  # an absolute move starts anew
            distance = value_of(move.distance)
            if move.mode is MoveMode.BY and isinstance(distance, Fraction):
                sent = setup.counts(Dimension.DISTANCE, letter, distance)
                total += setup.from_counts(Dimension.DISTANCE, letter, sent) - distance
    return total


def drift(step: Step, setup: Setup) -> str | None:
    """`This repeat drifts by 1.6 mm in 1000 turns`; None when it stays within a count."""
    if not isinstance(step.instruction, Repeat):
        return None
    count = turns(step.instruction)
    parts: list[str] = []
    for letter in setup.letters:
        if letter in AXES and abs(off := error(step.body, setup, letter) * count) * setup.axis(letter).scale >= 1:
            parts.append(f"{letter} by {shown(off, 4)} {setup.axis(letter).symbol}")
    if parts:
        return f"This repeat drifts: {', '.join(parts)} in {plain(count)} turns"
    if reverses(step.body):
        return "This repeat may drift: expressions are cut down to whole counts, going back as well as forth"
    return None


def cut(move: Instruction) -> str | None:
    """What to know of a relative move by an expression with a minus, which the controller rounds downwards."""
    if not isinstance(move, SingleAxisMove) or move.mode is not MoveMode.BY:
        return None
    distance = value_of(move.distance)
    if isinstance(distance, Fraction | Bad) or not any(map(_is_minus, walk(distance))):
        return None
    return "Distance: the controller rounds it down to whole counts, so going back may be one count longer than forth"


def reverses(steps: Steps) -> bool:
    """Whether one of the steps, or of those inside them, is such a move."""
    return any(step.enabled and (cut(step.instruction) or reverses(step.body)) for step in steps)


def _is_minus(node: Expression) -> bool:
    match node:
        case Negative() | Binary(operator="-"):
            return True
        case Number(value=number):
            return number < 0
        case _:
            return False
