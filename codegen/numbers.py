"""The one parser of numbers that people type, and the one way numbers are written into code and sentences.

Everything is exact (`Fraction`): 0.1 in means one tenth, so that rounding to counts is right.
"""

from __future__ import annotations

import re
from fractions import Fraction
from functools import lru_cache

_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)\Z", re.ASCII)
_EXPONENT = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)[eE][+-]?\d{1,2}\Z", re.ASCII)
_COMMA = re.compile(r"[+-]?\d*,\d+\Z", re.ASCII)
_BLANKS = re.compile(r"[+-]?\s*[\d.]+([ _'][\d.]+)*\Z", re.ASCII)
_LONGEST = 40  # characters; nothing a machine needs is longer


@lru_cache(maxsize=8192)
def parse_number(text: str) -> Fraction | None:
    """The number in `text` (blanks around it are allowed), or None when it is none."""
    text = text.strip()
    if len(text) > _LONGEST or _NUMBER.match(text) is None:
        return None
    return Fraction(text.rstrip("."))


def looks_like_number(text: str) -> bool:
    """Whether a number was meant and no expression."""
    text = text.strip().replace("−", "-")
    return any(pattern.match(text) for pattern in (_NUMBER, _EXPONENT, _COMMA, _BLANKS))


def number_problem(text: str) -> str | None:
    """Why `text` is no number, and what to write; None when it is one."""
    if parse_number(text) is not None:
        return None
    text = text.strip()
    if not text:
        return "a number is missing"
    if len(text) > _LONGEST:
        return "this number is too long"
    if _COMMA.match(text):
        return f"write {text.replace(',', '.')}"
    if parse_number(text.replace("−", "-")) is not None:
        return f"write {text.replace('−', '-')} with a plain minus"
    if _EXPONENT.match(text):
        return f"write {plain(Fraction(text))} without an exponent"
    joined = re.sub(r"[\s_']", "", text)
    if _BLANKS.match(text) and parse_number(joined) is not None:
        return f"write {joined} without blanks"
    return f"'{text}' is not a number"


def is_short_decimal(number: Fraction) -> bool:
    """Whether `number` ends after some decimals, so that it can be written exactly."""
    rest = number.denominator
    for prime in (2, 5):
        while rest % prime == 0:
            rest //= prime
    return rest == 1


def decimal(number: Fraction, places: int) -> str:
    """`number` rounded to at most `places` decimals, half away from zero, without closing zeros."""
    scaled = nearest(abs(number) * 10**places)
    whole, part = divmod(scaled, 10**places)
    digits = f"{part:0{places}d}".rstrip("0") if places else ""
    sign = "-" if number < 0 and scaled else ""
    return f"{sign}{whole}.{digits}" if digits else f"{sign}{whole}"


def plain(number: Fraction, places: int = 12) -> str:
    """`number` as an exact decimal where one exists, otherwise with `places` decimals."""
    if number.denominator == 1:
        return str(number.numerator)
    if not is_short_decimal(number):
        return decimal(number, places)
    return decimal(number, number.denominator.bit_length() - 1 or 1)


def shown(number: Fraction, figures: int = 6) -> str:
    """`number` as a person reads it: about `figures` figures in all, never less than its whole part."""
    before = len(str(abs(int(number)))) if abs(number) >= 1 else 0
    return decimal(number, max(figures - before, 0))


def nearest(number: Fraction) -> int:
    """The nearest whole number; a half goes away from zero."""
    twice = 2 * abs(number)
    whole = (twice.numerator + twice.denominator) // (2 * twice.denominator)
    return -whole if number < 0 else whole
