"""The pure @functions on numbers counting 1/65536, worked out in integers: every machine gives the same bits."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from math import isqrt

from codegen.twoletter.fixed import ONE, wrap

_BITS = 64
_TURN = 360 * ONE
_QUARTER = 90 * ONE
_PI = 57952155664616982739  # pi * 2**64, rounded


@lru_cache(maxsize=4096)
def _sine_of_quarter(angle: int) -> int:
    """Sine of 0 to 90 degrees by its series with 64 bits of fraction, as the nearest 1/65536."""
    radians = _PI * angle // (180 * ONE)
    square = radians * radians >> _BITS
    term = total = radians
    factor = 2
    while term:
        term = (term * square >> _BITS) // (factor * (factor + 1))
        total += -term if factor % 4 == 2 else term
        factor += 2
    return (total + (1 << (_BITS - 17))) >> (_BITS - 16)


def sine(angle: int) -> int:
    """@SIN of degrees, nearest 1/65536 (dmc-1412-1414.txt l.3163)."""
    angle %= _TURN
    quarter, rest = divmod(angle, _QUARTER)
    value = _sine_of_quarter(_QUARTER - rest if quarter & 1 else rest)
    return -value if quarter >= 2 else value


def cosine(angle: int) -> int:
    """@COS of degrees."""
    return sine(angle + _QUARTER)


def integer_part(value: int) -> int:
    """@INT: the value without its fraction (towards zero, inferred)."""
    return value >> 16 << 16 if value >= 0 else -(-value >> 16 << 16)


def fraction_part(value: int) -> int:
    """@FRAC: what @INT leaves over; keeps the sign (inferred)."""
    return value - integer_part(value)


def rounded(value: int) -> int:
    """@RND: .5 goes up (l.3168)."""
    return (value + ONE // 2) >> 16 << 16


def square_root(value: int) -> int:
    """@SQR, nearest 1/65536; of a negative value the root of its magnitude (recall)."""
    squared = abs(value) << 16
    root = isqrt(squared)
    return root + 1 if squared - root * root > root else root


def complement(value: int) -> int:
    """@COM: the 32 integer bits inverted, fraction 0."""
    return ~(value >> 16) << 16


PURE: dict[str, Callable[[int], int]] = {
    "SIN": sine,
    "COS": cosine,
    "ABS": lambda value: wrap(abs(value)),
    "INT": integer_part,
    "FRAC": fraction_part,
    "RND": lambda value: wrap(rounded(value)),
    "SQR": square_root,
    "COM": complement,
}
