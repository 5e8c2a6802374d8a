"""Values of expressions: fixed point, left to right, functions; examples of the manual by line."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from codegen.twoletter.evaluate import EvaluationError, compile_expression, constant, evaluate
from codegen.twoletter.fixed import (
    HIGHEST,
    LOWEST,
    ONE,
    as_integer,
    read_number,
    scaled,
    string_text,
    string_value,
    wrap,
)
from codegen.twoletter.functions import cosine, sine, square_root
from codegen.twoletter.nodes import Assign, Expression
from codegen.twoletter.parse import parse_line

NUMBERS = st.integers(LOWEST, HIGHEST)


class Given:
    """Names with fixed values; inputs 1 and 3 are high."""

    def __init__(self, **values: float) -> None:
        self.values = {name: scaled(value) for name, value in values.items()}

    def variable(self, name: str) -> int:
        """A variable, or error 57 where it was never set."""
        if name not in self.values:
            raise EvaluationError(57)
        return self.values[name]

    def element(self, name: str, index: int) -> int:
        """Elements hold ten times their index."""
        return index * 10 * ONE

    def operand(self, name: str, suffix: str) -> int:
        """Operands hold the letters' count."""
        return len(name + suffix) * ONE

    def keyword(self, name: str) -> int:
        """The clock stands at 1000."""
        return 1000 * ONE

    def function(self, name: str, argument: int) -> int:
        """Inputs 1 and 3 are high, analog inputs give their number in volts."""
        return argument if name == "AN" else ONE * (argument in (ONE, 3 * ONE))


def expression(text: str) -> Expression:
    """The tree of one expression."""
    statement = parse_line("R=" + text).statements[0]
    assert isinstance(statement, Assign), statement
    return statement.value


def value(text: str, **names: float) -> float:
    """The value of an expression as a float."""
    return evaluate(expression(text), Given(**names)) / ONE


@pytest.mark.parametrize(
    ("text", "names", "result"),
    [
        ("7.5*V1/2", {"V1": 4}, 15.0),  # l.3116
        ("V1+V3*V4", {"V1": 1, "V3": 2, "V4": 3}, 9.0),  # left to right, l.3112
        ("V1*V7<=V8*V2", {"V1": 2, "V7": 3, "V8": 4, "V2": 2}, 1.0),  # l.2928
        ("V1*V7<=V8*V2", {"V1": 3, "V7": 3, "V8": 4, "V2": 2}, 0.0),
        ("V1=V7*6", {"V1": 12, "V7": 2}, 1.0),  # l.2901
        ("(V1<V2)&(V3<V4)", {"V1": 1, "V2": 2, "V3": 3, "V4": 4}, 1.0),  # l.2914
        ("((V1<V2)&(V3<V4))|(V5<V6)", {"V1": 2, "V2": 1, "V3": 3, "V4": 4, "V5": 1, "V6": 2}, 1.0),
        ("@IN[1]&@IN[2]", {}, 0.0),  # l.3122
        ("@IN[1]&@IN[3]", {}, 1.0),
        ("_TP-(@COS[60]*40)", {}, -18.0),
        ("5*@SIN[POS]", {"POS": 30}, 2.5),  # l.3176
        ("-955*@SIN[90]+V1", {"V1": 1000}, 45.0),  # l.2022
        ("-V1/2", {"V1": 1}, -0.5),  # l.1065
        ("10-3-2", {}, 5.0),
        ("2+3*4", {}, 20.0),
        ("2+(3*4)", {}, 14.0),
        ("3>2>0", {}, 1.0),
        ("3<>3", {}, 0.0),
        ("$FF000000/$1000000", {}, -1.0),
        ("$FFFF&$FF00", {}, 65280.0),
        ("0.5|0.25", {}, 0.75),
        ("@COM[0]", {}, -1.0),
        ("@INT[-2.4]", {}, -2.0),
        ("@FRAC[2.25]", {}, 0.25),
        ("@RND[2.5]", {}, 3.0),
        ("@RND[-2.5]", {}, -2.0),
        ("@ABS[-2.5]", {}, 2.5),
        ("@SQR[2.25]", {}, 1.5),
        ("@AN[5]", {}, 5.0),
        ("POS[1.9]", {}, 10.0),
        ("POS[C+1]", {"C": 4}, 50.0),
        ("TIME-1", {}, 999.0),
        ("_TPX", {}, 3.0),
        ("1000000*1000000", {}, float(wrap(10**12 << 16) / ONE)),
    ],
)
def test_values(text: str, names: dict[str, float], result: float) -> None:
    assert value(text, **names) == result


def test_cosine_of_the_manual() -> None:  # l.3120: 40 * cosine of 45 degrees is 28.28
    assert round(value("@COS[45]*40"), 2) == 28.28


def test_a_string_is_taken_apart() -> None:  # l.3128-3155
    word = string_value("TESTME") / ONE
    names = {"LEN": word}
    flen = value("$10000*(@FRAC[LEN])", **names)
    letters = [
        value("(LEN&$FF000000)/$1000000", **names),
        value("(LEN&$00FF0000)/$10000", **names),
        value("(LEN&$0000FF00)/$100", **names),
        value("LEN&$000000FF", **names),
        value("(FLEN&$FF00)/$100", FLEN=flen),
        value("FLEN&$00FF", FLEN=flen),
    ]
    # letter 4 keeps the fraction's bits out because the mask has none
    assert "".join(chr(int(letter)) for letter in letters) == "TESTME"
    assert string_text(scaled(69), 4) == "E"  # three bytes of 0 are not sent


@pytest.mark.parametrize(("text", "code"), [("5/0", 6), ("5/(V1-V1)", 6), ("LEN", 57)])
def test_what_has_no_value(text: str, code: int) -> None:
    with pytest.raises(EvaluationError) as caught:
        value(text, V1=3)
    assert caught.value.code == code


@given(NUMBERS, NUMBERS)
def test_operations_are_fixed_point(left: int, right: int) -> None:
    class Pair(Given):
        def variable(self, name: str) -> int:
            """A or B."""
            return left if name == "A" else right

    def result(operator: str) -> int:
        return evaluate(expression(f"A{operator}B"), Pair())

    assert result("+") == wrap(left + right)
    assert result("-") == wrap(left - right)
    assert result("*") == wrap(math.trunc(Fraction(left * right, ONE)))
    assert result("&") == left & right
    assert result("|") == left | right
    assert result("<") == ONE * (left < right)
    assert result(">=") == ONE * (left >= right)
    if right:
        assert result("/") == wrap(math.trunc(Fraction(left * ONE, right)))


@given(st.integers())
def test_wrapping_keeps_48_bits(number: int) -> None:
    wrapped = wrap(number)
    assert LOWEST <= wrapped <= HIGHEST
    assert (wrapped - number) % (1 << 48) == 0


@given(NUMBERS)
def test_sine_is_the_nearest_there_is(angle: int) -> None:
    exact = math.sin(math.radians(angle % (360 * ONE) / ONE)) * ONE
    assert abs(sine(angle) - exact) <= 0.50001
    assert cosine(angle) == sine(angle + 90 * ONE)


@given(NUMBERS)
def test_square_root_is_the_nearest_there_is(number: int) -> None:
    root = square_root(number)
    assert abs(root**2 - (abs(number) << 16)) <= root


@given(st.decimals(min_value=-2147483647, max_value=2147483647, places=6))
def test_literals_are_the_nearest_multiple(number: object) -> None:
    read = read_number(f"{number:f}")
    assert read is not None
    assert abs(read - Fraction(str(number)) * ONE) <= Fraction(1, 2)


@pytest.mark.parametrize(
    ("text", "read"),
    [
        ("2147483648", None),
        ("-2147483648", LOWEST),
        ("2147483647.99999", HIGHEST),
        ("2147483647.999999", None),
        ("$FFFFFFFF", -ONE),
        ("-$10", -16 * ONE),
        ("$0A.8", 10 * ONE + ONE // 2),
        ("$123456789", None),
        ("1" * 5000, None),
        ("0." + "3" * 5000, 21845),
        ("", None),
        (".", None),
        ("$", None),
        ("12,5", None),
    ],
)
def test_reading_numbers(text: str, read: int | None) -> None:
    assert read_number(text) == read


def test_integers_of_arguments_are_floors() -> None:  # l.1065: PR -0.5 becomes -1
    assert [as_integer(scaled(number)) for number in (-0.5, 0.5, -1, 1.99)] == [-1, 0, -1, 1]


def test_constants_are_known_without_names() -> None:
    assert constant(expression("2*(3+4)")) == 14 * ONE
    assert constant(expression('"A"')) == 0x41 << 40
    assert constant(expression("V1+1")) is None
    assert constant(expression("1/0")) is None


def test_compiling_twice_gives_the_same_function() -> None:
    assert compile_expression(expression("A+1")) is compile_expression(expression("A + 1"))
