"""Numbers as people type them."""

from __future__ import annotations

from decimal import Decimal
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from codegen.numbers import decimal, is_short_decimal, looks_like_number, nearest, number_problem, parse_number, plain


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("10", Fraction(10)),
        (" 12.5 ", Fraction(25, 2)),
        (".5", Fraction(1, 2)),
        ("5.", Fraction(5)),
        ("-0.1", Fraction(-1, 10)),
        ("+3", Fraction(3)),
        ("007", Fraction(7)),
    ],
)
def test_numbers(text: str, value: Fraction) -> None:
    assert parse_number(text) == value


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("12,5", "write 12.5"),
        ("-12,5", "write -12.5"),
        ("1e3", "write 1000 without an exponent"),
        ("1 000", "write 1000 without blanks"),
        ("1'000", "write 1000 without blanks"),
        ("−5", "write -5 with a plain minus"),
        ("", "a number is missing"),
        ("1" * 41, "this number is too long"),
    ],
)
def test_what_to_write_instead(text: str, problem: str) -> None:
    assert parse_number(text) is None
    assert number_problem(text) == problem


@pytest.mark.parametrize(
    "text", ["1.2.3", "1.000,5", "1,2,3", "0x10", "$10", "inf", "nan", "١٢", "1_000.0.0", "--5", "5-", "."]
)
def test_never_guessed(text: str) -> None:
    assert parse_number(text) is None
    assert number_problem(text)


def test_expressions_do_not_look_like_numbers() -> None:
    assert not any(map(looks_like_number, ("LEN", "LEN*2", "_TPX", "-LEN", "2*A", "@SIN[5]")))
    assert all(map(looks_like_number, ("5", "12,5", "1e3", "1 000")))


@given(st.decimals(allow_nan=False, allow_infinity=False, places=6, min_value=-(10**9), max_value=10**9))
def test_plain_is_exact(number: Decimal) -> None:
    assert parse_number(plain(Fraction(number))) == Fraction(number)


@given(st.fractions(min_value=-(10**6), max_value=10**6, max_denominator=10**6))
def test_nearest_is_nearest(number: Fraction) -> None:
    whole = nearest(number)
    assert abs(whole - number) <= Fraction(1, 2)
    if abs(whole - number) == Fraction(1, 2):
        assert abs(whole) > abs(number)


@given(st.text(max_size=20))
def test_any_text_is_a_number_or_has_a_problem(text: str) -> None:
    assert (parse_number(text) is None) == (number_problem(text) is not None)


def test_decimals() -> None:
    assert decimal(Fraction(1, 3), 3) == "0.333"
    assert decimal(Fraction(-5, 1000), 2) == "-0.01"
    assert decimal(Fraction(1, 1000), 2) == "0"
    assert decimal(Fraction(-1, 1000), 2) == "0"
    assert is_short_decimal(Fraction(1, 1024)) and not is_short_decimal(Fraction(1, 3))
