"""The usual laws of motion of cams: how a slave goes from one position to another without a jerk.

Each is the way `s` from 0 to 1 over the part `u` of the master from 0 to 1, at rest at both ends.
"""

from __future__ import annotations

import math
from enum import StrEnum
from fractions import Fraction

from codegen.numbers import decimal, plain


class Law(StrEnum):
    """In the order of the list that offers them."""

    CYCLOIDAL = "cycloidal"
    MODIFIED_SINE = "modified_sine"
    POLYNOMIAL = "polynomial"
    STRAIGHT = "straight"


LAW_WORDS = {
    Law.CYCLOIDAL: "Cycloidal",
    Law.MODIFIED_SINE: "Modified sine",
    Law.POLYNOMIAL: "3-4-5 polynomial",
    Law.STRAIGHT: "Straight line",
}
LAW_HELP = {
    Law.CYCLOIDAL: "Smoothest start and end; top speed 2 times, acceleration 6.28 times that of an even rise.",
    Law.MODIFIED_SINE: "Lowest top speed of the three (1.76 times) with an acceleration without jumps (5.53 times).",
    Law.POLYNOMIAL: "10u³ - 15u⁴ + 6u⁵; top speed 1.88 times, acceleration 5.77 times that of an even rise.",
    Law.STRAIGHT: "Even speed; it begins and ends with a jump of the speed. From and to the same place it is a dwell.",
}


def way(law: Law, u: float) -> float:
    """How much of the way is done after the part `u` of the master's."""
    match law:
        case Law.CYCLOIDAL:
            return u - math.sin(2 * math.pi * u) / (2 * math.pi)
        case Law.POLYNOMIAL:
            return u**3 * (10 + u * (6 * u - 15))
        case Law.MODIFIED_SINE:
            return _modified_sine(u)
        case Law.STRAIGHT:
            return u


def _modified_sine(u: float) -> float:
    """An eighth of a quick sine at each end, three quarters of a slow one between."""
    turn = math.pi * u
    if u < 1 / 8:
        above = turn - math.sin(4 * turn) / 4
    elif u <= 7 / 8:
        above = 2 + turn - 9 / 4 * math.sin((4 * turn + math.pi) / 3)
    else:
        above = 4 + turn - math.sin(4 * turn) / 4
    return above / (4 + math.pi)


def rise(law: Law, count: int, start: Fraction, end: Fraction, places: int) -> tuple[str, ...]:
    """`count` evenly spaced positions from `start` to `end`, both exact, those between with that many decimals."""
    cells = [decimal(start + (end - start) * Fraction(way(law, n / (count - 1))), places) for n in range(1, count - 1)]
    return (plain(start), *cells, plain(end)) if count > 1 else (plain(end),)
