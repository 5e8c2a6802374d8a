"""Formatter: canonical spacing, the round trip, and numbers as the controller prints them."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from codegen.twoletter.fixed import ONE, read_number, scaled
from codegen.twoletter.format import format_line, format_number, format_scaled, format_source, format_statement
from codegen.twoletter.nodes import Broken, Foreign
from codegen.twoletter.parse import parse, parse_line
from tests.codegen.twoletter.strategies import SOURCES, STATEMENTS


@given(STATEMENTS)
def test_the_strategy_makes_valid_statements(text: str) -> None:
    broken = [each for each in parse_line(text).statements if isinstance(each, Broken | Foreign)]
    assert not [each for each in broken if each.rule not in ("too-deep", "line-too-long", "number-too-big")]


@given(SOURCES)
def test_formatting_keeps_the_meaning(text: str) -> None:
    tree = parse(text)
    once = format_source(tree)
    assert parse(once) == tree
    assert format_source(parse(once)) == once


@given(STATEMENTS)
def test_compact_text_means_the_same(text: str) -> None:
    for statement in parse_line(text).statements:
        assert parse_line(format_statement(statement, compact=True)).statements == (statement,) or isinstance(
            statement, Broken | Foreign
        )


@pytest.mark.parametrize(
    ("text", "canonical"),
    [
        ("PR6370", "PR 6370"),
        ("BGX", "BG X"),
        ("JP#A,X<10", "JP #A,X<10"),
        ('MG"text",V1 {F4.2}', 'MG "text",V1{F4.2}'),
        ('MG {P2} "TYPE X" {N}', 'MG {P2}"TYPE X"{N}'),
        ("MG {^07},{^255}", "MG {^7},{^255}"),  # l.3709
        ("PR LEN *4000", "PR LEN*4000"),  # l.3511
        ("OB 3, @IN [1]&@IN [2]", "OB 3,@IN[1]&@IN[2]"),  # l.3918
        ("JP# DONE,N>300", "JP #DONE,N>300"),  # l.3464
        ("X = N * 10 + S", "X=N*10+S"),  # l.1911
        ("ET[N] = X", "ET[N]=X"),
        ("BGA", "BG X"),
        ("II,,5", "II ,,5"),  # l.3973
        ("CI ,2", "CI ,2"),
        ("XERR[N] =", "XERR[N]="),
        ("PRX=-1*(_BZX)", "PRX=-1*(_BZX)"),  # l.783
        ("TP{F2.2}", "TP {F2.2}"),  # l.3814
        ("LI 1000 , 2000 < 500", "LI 1000,2000<500"),
        ("JG SPEED;BG;", "JG SPEED;BG;"),  # l.3071
        ("NO  ABSOLUTE / ^ MOVE ", "NO ABSOLUTE / ^ MOVE"),
        ("REM  SIMPLE; MOVE", "REM SIMPLE; MOVE"),
        ("' a note", "'a note"),
        ("AI+1", "AI 1"),
        ("V1=$FF", "V1=$FF"),
        ("WT.5", "WT .5"),
        ("bg 5", "bg 5"),
    ],
)
def test_canonical_spacing(text: str, canonical: str) -> None:
    assert format_line(parse_line(text)) == canonical


# Lines of dmc-1412-1414.txt; the sign column is a blank (l.3770-3877, 3668-3680).
@pytest.mark.parametrize(
    ("value", "digits", "decimals", "shown"),
    [
        (21, 10, 0, " 0000000021"),  # l.3770
        (21, 4, 0, " 0021"),
        (150, 2, 0, " 99"),  # l.3785
        (-150, 2, 0, "-99"),
        (4.1, 5, 2, " 00004.10"),  # l.3674
        (999999.999, 5, 2, " 99999.99"),  # l.3680
        (10, 10, 4, " 0000000010.0000"),  # l.3842
        (10, 2, 2, " 10.00"),
        (10, 1, 0, " 9"),  # l.3857
        (10, 4, 2, " 0010.00"),  # l.3867
        (-5, 2, 2, "-05.00"),  # l.3816
        (7650.2, 10, 4, " 0000007650.2000"),  # l.3354
        (-9, 10, 0, "-0000000009"),  # l.3795
        (99.996, 2, 2, " 99.99"),
        (-0.001, 3, 1, " 000.0"),
        (0.5, 0, 1, " .5"),
        (2.5, 3, 0, " 003"),
        (-2.5, 3, 0, "-003"),
    ],
)
def test_decimal_numbers(value: float, digits: int, decimals: int, shown: str) -> None:
    assert format_number(scaled(value), digits, decimals) == shown


@pytest.mark.parametrize(
    ("value", "digits", "decimals", "shown"),
    [
        (21, 4, 0, "$0015"),  # l.3782
        (-5, 4, 2, "$FFFB.00"),  # l.3820
        (5, 4, 2, "$0005.00"),
        (10, 2, 2, "$0A.00"),  # l.3853
        (10, 4, 2, "$000A.00"),  # l.3869
        (0.5, 2, 2, "$00.80"),
        (200, 2, 0, "$7F"),
        (-200, 2, 0, "$80"),
        (-1, 8, 0, "$FFFFFFFF"),
    ],
)
def test_hexadecimal_numbers(value: float, digits: int, decimals: int, shown: str) -> None:
    assert format_number(scaled(value), digits, decimals, hexadecimal=True) == shown


def test_leading_zeros_go() -> None:  # l.3803
    assert [format_number(scaled(value), 10, 0, leading_zeros=False) for value in (-9, 5, 0, 7)] == [
        "-9",
        " 5",
        " 0",
        " 7",
    ]
    assert format_number(scaled(10), 10, 4, leading_zeros=False) == " 10.0000"


@given(st.integers(-(1 << 47), (1 << 47) - 1), st.integers(0, 10), st.integers(0, 4))
def test_printed_numbers_have_their_width_and_value(value: int, digits: int, decimals: int) -> None:
    shown = format_number(value, digits, decimals)
    assert len(shown) == 1 + digits + (decimals + 1 if decimals else 0)
    fits = abs(value) / ONE < 10**digits - 1
    if fits and digits:
        assert abs(float(shown.replace(" ", "")) - value / ONE) <= 0.5 / 10**decimals + 1e-9


@given(st.integers(-(1 << 47), (1 << 47) - 1))
def test_the_shortest_literal_reads_back(value: int) -> None:
    assert read_number(format_scaled(value)) == value
