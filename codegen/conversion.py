"""From user units to what a controller counts: factors, rounding, and how far a value may go.

All arithmetic is exact; rounding happens once, to the resolution of the command (commands.md: SP even, AC in
steps of 1024), and never goes above a maximum or beyond a limit.
"""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache
from math import ceil, floor
from typing import TYPE_CHECKING, NamedTuple

from codegen.fields import Dimension
from codegen.numbers import parse_number

if TYPE_CHECKING:
    from codegen.setup import Setup

LARGEST = 2147483647  # counts; the widest position register
ACCELERATION_STEP = 1024  # counts/s²; dmc-1412-1414.txt, AC
FASTEST_ACCELERATION = 67107840  # counts/s²
SPEED_STEP = 2  # counts/s
CALIBRATED_US = 1000  # the loop rate at which speeds and accelerations are calibrated
LARGEST_ERROR = 32767  # counts


@lru_cache(maxsize=1024)
def factor(setup: Setup, dimension: Dimension, letter: str) -> Fraction:
    """What a value in the user's unit is multiplied with to get what the controller counts."""
    scale = setup.axis(letter).scale if letter else Fraction(1)
    slow = setup.sample / CALIBRATED_US
    match dimension:
        case Dimension.DISTANCE | Dimension.POSITION | Dimension.ERROR:
            return scale
        case Dimension.SPEED:
            return scale * slow
        case Dimension.ACCELERATION:
            return scale * slow * slow
        case Dimension.TIME:
            return 1 / slow
        case _:
            return Fraction(1)


class Sent(NamedTuple):
    """What is sent for a value, and whether rounding changed it by more than 0.1 %."""

    counts: int
    moved: bool


@lru_cache(maxsize=65536)
def sent(setup: Setup, dimension: Dimension, letter: str, number: Fraction) -> Sent:
    """Whole-number arithmetic on `above`/`below`, the exact counts: this runs for every value of a program."""
    counts_in_one = factor(setup, dimension, letter)
    above = number.numerator * counts_in_one.numerator
    below = number.denominator * counts_in_one.denominator
    match dimension:
        case Dimension.SPEED:
            size = abs(above) // (below * SPEED_STEP) * SPEED_STEP
            counts = -size if above < 0 else size
        case Dimension.ACCELERATION:
            counts = max(_nearest(above, below * ACCELERATION_STEP) * ACCELERATION_STEP, ACCELERATION_STEP)
            if counts * below > above:
                highest = bounds(setup, dimension, letter)[1] * counts_in_one
                counts = min(counts, int(highest / ACCELERATION_STEP) * ACCELERATION_STEP)
        case Dimension.ERROR:
            counts = above // below
        case _:
            counts = _nearest(above, below)
            if dimension is Dimension.POSITION and counts * below != above:
                low, high = bounds(setup, dimension, letter)
                counts = min(max(counts, ceil(low * counts_in_one)), floor(high * counts_in_one))
    return Sent(counts, abs(counts * below - above) * 1000 > abs(above))


def _nearest(above: int, below: int) -> int:
    """The whole number nearest to a quotient; a half goes away from zero."""
    size = (2 * abs(above) + below) // (2 * below)
    return -size if above < 0 else size


def _given(text: str, otherwise: Fraction) -> Fraction:
    number = parse_number(text)
    return otherwise if number is None else number


@lru_cache(maxsize=1024)
def bounds(setup: Setup, dimension: Dimension, letter: str) -> tuple[Fraction, Fraction]:
    """Lowest and highest value in the user's unit that axis and controller allow."""
    counts_in_one = factor(setup, dimension, letter)
    axis = setup.axis(letter or "X")
    widest = LARGEST / counts_in_one
    match dimension:
        case Dimension.POSITION:
            return max(_given(axis.reverse_limit, -widest), -widest), min(_given(axis.forward_limit, widest), widest)
        case Dimension.DISTANCE:
            low, high = parse_number(axis.reverse_limit), parse_number(axis.forward_limit)
            travel = widest if low is None or high is None else min(high - low, widest)
            return -travel, travel
        case Dimension.SPEED:
            fastest = setup.limits.stepper_max_counts_s if axis.is_stepper else setup.limits.servo_max_counts_s
            return Fraction(0), min(_given(axis.maximum_speed, fastest / counts_in_one), fastest / counts_in_one)
        case Dimension.ACCELERATION:
            hardest = FASTEST_ACCELERATION / counts_in_one
            return Fraction(0), min(_given(axis.maximum_acceleration, hardest), hardest)
        case Dimension.ERROR:
            return Fraction(0), LARGEST_ERROR / counts_in_one
        case Dimension.TIME:
            return Fraction(0), widest
        case Dimension.VOLTS:
            return Fraction("-9.9982"), Fraction("9.9982")
        case _:
            return Fraction(-LARGEST), Fraction(LARGEST)
