"""The course of an axis along a table: position, speed and acceleration, by time or by the place of a master.

Between two rows the controller goes straight, so a speed belongs to a stretch and an acceleration to a row: the change
of the speed there, spread over one row.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import accumulate, pairwise
from typing import TYPE_CHECKING

from codegen.fields import Dimension
from codegen.numbers import parse_number, shown

if TYPE_CHECKING:
    from codegen.setup import Setup


@dataclass(frozen=True, slots=True)
class Course:
    """One axis in user units; `speed` has one value less than the others."""

    letter: str
    at: tuple[Fraction, ...]  # ms, or places of the master
    position: tuple[Fraction, ...]
    speed: tuple[Fraction, ...]
    acceleration: tuple[Fraction, ...]

    def fastest(self) -> tuple[int, Fraction]:
        """The stretch with the greatest speed, and that speed."""
        return _greatest(self.speed)

    def hardest(self) -> tuple[int, Fraction]:
        """The row with the greatest acceleration, and that."""
        return _greatest(self.acceleration)


def _greatest(values: Sequence[Fraction]) -> tuple[int, Fraction]:
    return max(enumerate(map(abs, values)), key=lambda pair: pair[1], default=(0, Fraction(0)))


def in_time(letter: str, steps: Sequence[Fraction], lasting: Sequence[Fraction]) -> Course:
    """From rest to rest by steps that last so many ms each."""
    seconds = [each / 1000 for each in lasting]
    speed = tuple(step / each for step, each in zip(steps, seconds, strict=True))
    before, after = (Fraction(0), *speed), (*speed, Fraction(0))
    spread = [(one + other) / 2 for one, other in zip((seconds[0], *seconds), (*seconds, seconds[-1]), strict=True)]
    change = tuple((new - old) / each for old, new, each in zip(before, after, spread, strict=True))
    zero = Fraction(0)
    return Course(letter, (zero, *accumulate(lasting)), (zero, *accumulate(steps)), speed, change)


def along_master(
    letter: str, positions: Sequence[Fraction], first: Fraction, cycle: Fraction, master_speed: Fraction
) -> Course:
    """Evenly spaced over one cycle of a master at an even speed; the cycle begins again behind its end."""
    apart = cycle / (len(positions) - 1)
    lasting = apart / master_speed
    speed = tuple((after - before) / lasting for before, after in pairwise(positions))
    around = (speed[-1], *speed, speed[0])
    change = tuple((after - before) / lasting for before, after in pairwise(around))
    return Course(letter, tuple(first + apart * n for n in range(len(positions))), tuple(positions), speed, change)


def too_much(course: Course, setup: Setup, because: str = "", *, steps: bool = False) -> str | None:
    """The sentence for a speed or an acceleration above what the setup and the controller allow.

    A row of steps is a stretch; else it is a point between two of them.
    """
    letter = course.letter
    most = setup.bounds(Dimension.SPEED, letter)[1]
    row, speed = course.fastest()
    if speed > most:
        unit = setup.unit_text(Dimension.SPEED, letter)
        where = f"In row {row + 1}" if steps else f"From row {row + 1} to {row + 2}"
        return f"{where} {letter} goes at {shown(speed)} {unit}{because}, top is {shown(most)} {unit}"
    if parse_number(setup.axis(letter).maximum_acceleration) is None:
        return None  # the controller asks for none: a table is no profile
    most = setup.bounds(Dimension.ACCELERATION, letter)[1]
    row, hard = course.hardest()
    if hard > most:
        unit = setup.unit_text(Dimension.ACCELERATION, letter)
        where = f"At row {row + 1}" if not steps or row < len(course.speed) else "At the end"
        return f"{where} {letter} accelerates by {shown(hard)} {unit}{because}, top is {shown(most)} {unit}"
    return None
