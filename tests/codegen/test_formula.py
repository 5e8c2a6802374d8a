"""The neutral expression tree: worked out in Python, it is what the controller makes of the emitted text."""

from __future__ import annotations

from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from codegen.expressions import (
    Bad,
    Binary,
    Expression,
    Function,
    Group,
    Negative,
    Number,
    Variable,
    depth,
    parse_expression,
    write,
)
from codegen.formula import Unknown, evaluate, fill
from codegen.generate import code
from codegen.instructions import MathematicalEquation
from codegen.instructions.math import Equation
from tests.codegen.modes.bench import MACHINE
from tests.device.simulator.bench import Bench
from tests.long import count

VALUES = {"A": Fraction(7), "B": Fraction(-5, 2), "C": Fraction(3, 4)}
LARGEST = 2**24  # far from where 48 bits end
EXACT = ("ABS", "INT", "FRAC", "RND")


@st.composite
def trees(draw: st.DrawFn, deep: int = 3) -> Expression:
    """Sums, products, comparisons and functions that the controller works out without rounding."""
    kind = draw(st.integers(0, 7 if deep else 1))
    if kind == 0:
        return Number(Fraction(draw(st.integers(-80, 80)), 4))
    if kind == 1:
        return Variable(draw(st.sampled_from(sorted(VALUES))))
    if kind == 2:
        return Function(draw(st.sampled_from(EXACT)), draw(trees(deep=deep - 1)))
    if kind == 3:
        return Negative(Group(draw(trees(deep=deep - 1))))
    operator = draw(st.sampled_from(["+", "-", "*", "&", "|", "<", ">", "=", "<=", ">=", "<>"]))
    return Binary(operator, Group(draw(trees(deep=deep - 1))), Group(draw(trees(deep=deep - 1))))


def exact(tree: Expression) -> Fraction | None:
    """The value, where neither it nor anything in it needs more than the controller's bits."""
    try:
        value = evaluate(tree, VALUES)
    except Unknown:
        return None
    return value if abs(value) < LARGEST and (value * 65536).denominator == 1 else None


@given(st.lists(trees(), min_size=20, max_size=20))
def test_python_and_the_controller_agree(found: list[Expression]) -> None:
    """Each tree is typed into Mathematical Equation; the emitted line runs; the value is read over the port."""
    bench = Bench("ssc1")
    for name, value in VALUES.items():
        bench.ask(f"{name}={float(value)}")
    for tree in found[: count(5, 20)]:
        wanted, text = exact(tree), write(tree)
        if wanted is None or isinstance(parse_expression(text), Bad) or depth(tree) > 4:
            continue
        lines = code(MathematicalEquation(equations=(Equation(variable="R", expression=text),)), MACHINE)
        if not lines or len(lines[0]) > 70:
            continue
        bench.ask(lines[0])
        shown = Fraction(bench.ask("MG R{F10.4}"))
        assert abs(shown - wanted) <= Fraction(1, 20000), text  # the nearest of four digits; a tie has two of them


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("@SQR[16]+1", 5.0),
        ("@SIN[30]*10", 5.0),
        ("@COS[60]", 0.5),
        ("1/8", 0.125),
        ("@RND[2.5]", 3),
        ("@INT[-2.7]", -2),
    ],
)
def test_functions(text: str, value: float) -> None:
    tree = parse_expression(text)
    assert not isinstance(tree, Bad)
    assert abs(float(evaluate(tree, {})) - value) < 1e-9
    bench = Bench("ssc1")
    assert abs(float(bench.ask(f"MG {text}{{F10.4}}")) - value) < 0.001


def test_a_column_is_filled_by_its_row() -> None:
    assert fill("N*2.5", 4) == ("0", "2.5", "5", "7.5")
    assert fill("(N*N)/4", 3) == ("0", "0.25", "1")
    assert fill("1/N", 3) == Bad("this divides by zero (row 1)")
    assert fill("@SIN[N*90]", 3) == ("0", "1", "0")


@pytest.mark.parametrize("text", ["LEN*2", "_TPX", "TIME", "POS[3]", "N+", "12,5"])
def test_what_is_not_known_here_is_told(text: str) -> None:
    found = fill(text, 3)
    assert isinstance(found, Bad) and found.message
