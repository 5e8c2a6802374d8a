"""Numbers as the controller holds them: 48-bit integers counting 1/65536, and the readers and writers of them."""

from __future__ import annotations

from fractions import Fraction

ONE = 65536  # the scaled value of 1
HIGHEST = (1 << 47) - 1  # 2147483647.99998
LOWEST = -(1 << 47)
_MASK = (1 << 48) - 1
_DIGITS = frozenset("0123456789")
_HEXADECIMAL_DIGITS = frozenset("0123456789ABCDEFabcdef")
_LONGEST_FRACTION = 18  # a tie between two multiples of 1/65536 has at most 17 decimals
STRING_BYTES = 6


def wrap(scaled: int) -> int:
    """The number in six bytes of two's complement: what overflows comes back at the other end (inferred)."""
    if LOWEST <= scaled <= HIGHEST:
        return scaled
    return ((scaled - LOWEST) & _MASK) + LOWEST


def as_integer(scaled: int) -> int:
    """The integer an argument of step 1 takes: rounded down (-0.5 is -1, dmc-1412-1414.txt l.1065)."""
    return scaled >> 16


def nearest(value: Fraction) -> int:
    """The nearest integer; halves go away from zero."""
    doubled = abs(value) * 2
    magnitude = (doubled.numerator // doubled.denominator + 1) // 2
    return -magnitude if value < 0 else magnitude


def scaled(value: int | float | Fraction) -> int:
    """A number of the outside world as the nearest multiple of 1/65536 (not limited)."""
    if isinstance(value, int):
        return value << 16
    return nearest(Fraction(value) * ONE)


def read_decimal(text: str) -> int | None:
    """`12`, `.5`, `-3.25` as a scaled number; None when it is no number or does not fit."""
    negative = text.startswith("-")
    whole, _, fraction = text.lstrip("+-" if negative else "+").partition(".")
    if not (whole or fraction) or not _DIGITS.issuperset(whole) or not _DIGITS.issuperset(fraction):
        return None
    whole = whole.lstrip("0")
    if len(whole) > 10:
        return None
    magnitude = int(whole or "0") << 16
    if fraction:
        fraction = fraction[:_LONGEST_FRACTION]
        unit = 10 ** len(fraction)
        magnitude += (int(fraction) * 2 * ONE + unit) // (2 * unit)
    value = -magnitude if negative else magnitude
    return value if LOWEST <= value <= HIGHEST else None


def read_hexadecimal(text: str) -> int | None:
    """`$FF`, `-$10`, `$0A.8`: eight digits are a 32-bit pattern (`$FF000000` is negative); None when it is none."""
    negative = text.startswith("-")
    whole, _, fraction = text.lstrip("-").removeprefix("$").partition(".")
    if not (whole or fraction) or not _HEXADECIMAL_DIGITS.issuperset(whole + fraction):
        return None
    whole = whole.lstrip("0")
    if len(whole) > 8 or len(fraction) > 4:
        return None
    pattern = int(whole or "0", 16) << 16 | int(fraction.ljust(4, "0"), 16)
    return wrap(-wrap(pattern) if negative else pattern)


def read_number(text: str) -> int | None:
    """A decimal or `$` hexadecimal number; None when it is none."""
    text = text.strip()
    return read_hexadecimal(text) if text.startswith(("$", "-$")) else read_decimal(text)


def string_value(text: str) -> int:
    """A string of up to six characters as a number: the first character in the top byte."""
    data = text.encode("latin-1", "replace")[:STRING_BYTES]
    return int.from_bytes(data.ljust(STRING_BYTES, b"\0"), "big", signed=True)


def string_text(value: int, count: int = STRING_BYTES) -> str:
    """The first `count` bytes of a number as text; bytes of 0 are not sent."""
    data = wrap(value).to_bytes(STRING_BYTES, "big", signed=True)[:count]
    return data.replace(b"\0", b"").decode("latin-1")


def places(value: int) -> tuple[int, int, bool]:
    """Digits, decimals and hexadecimal of a format number: `PF 6.2` is (6, 2, False), `VF-2.2` (2, 2, True)."""
    magnitude = abs(value)
    return magnitude >> 16, ((magnitude & 0xFFFF) * 10 + ONE // 2) // ONE, value < 0
