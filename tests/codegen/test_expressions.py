"""Expressions of dialog fields: grouping, reading, user units."""

from __future__ import annotations

from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from codegen.expressions import (
    Bad,
    Binary,
    Element,
    Expression,
    Function,
    Group,
    Negative,
    Number,
    Operand,
    Variable,
    children,
    depth,
    parse_expression,
    walk,
    write,
)
from codegen.units import in_counts

POSITIONS = frozenset({"TP", "RP"})


def expressions() -> st.SearchStrategy[Expression]:
    leaves = st.one_of(
        st.integers(0, 5000).map(lambda number: Number(Fraction(number, 4))),
        st.sampled_from(["LEN", "A", "n", "COUNT"]).map(Variable),
        st.sampled_from(["TP", "RP", "TE"]).map(lambda name: Operand(name, "X")),
    )

    def grow(inner: st.SearchStrategy[Expression]) -> st.SearchStrategy[Expression]:
        return st.one_of(
            st.builds(Binary, st.sampled_from("+-*/&|"), inner, inner),
            st.builds(Group, inner),
            st.builds(Negative, st.sampled_from(["LEN", "A"]).map(Variable)),
            st.builds(Function, st.sampled_from(["SIN", "ABS"]), inner),
            st.builds(Element, st.just("POS"), inner),
        )

    return st.recursive(leaves, grow, max_leaves=6)


def bare(tree: Expression) -> Expression:
    """The tree without brackets of the person, to compare readings."""
    match tree:
        case Group(inner=inner):
            return bare(inner)
        case Binary(operator=operator, left=left, right=right):
            return Binary(operator, bare(left), bare(right))
        case Function(name=name, argument=argument):
            return Function(name, bare(argument))
        case Element(name=name, index=index):
            return Element(name, bare(index))
        case Negative(operand=inner):
            return Negative(bare(inner))
        case _:
            return tree


@given(expressions())
def test_what_is_written_reads_the_same(tree: Expression) -> None:
    if depth(tree) > 4:
        return
    again = parse_expression(write(tree))
    assert not isinstance(again, Bad), write(tree)
    assert bare(again) == bare(tree)


@given(st.text(max_size=30))
def test_any_text_is_read_or_refused(text: str) -> None:
    tree = parse_expression(text)
    assert isinstance(tree, Bad) or write(tree)


@pytest.mark.parametrize(
    ("text", "readings"),
    [
        ("A+B*2", "group it with brackets: (A+B)*2 or A+(B*2)"),
        ("A*2+B", "group it with brackets: (A*2)+B or A*(2+B)"),
        ("A-B+C", "group it with brackets: (A-B)+C or A-(B+C)"),
        ("LEN/2*3", "group it with brackets: (LEN/2)*3 or LEN/(2*3)"),
    ],
)
def test_two_operators_offer_both_readings(text: str, readings: str) -> None:
    tree = parse_expression(text)
    assert isinstance(tree, Bad) and tree.message == readings
    for reading in readings.removeprefix("group it with brackets: ").split(" or "):
        assert not isinstance(parse_expression(reading), Bad)


@pytest.mark.parametrize(
    "text", ["A+B+C", "(A+B)*2", "A>B+5", "(A<B)&(C<D)", "@SIN[A+2]*5", "POS[I+1]", "-A", "-5*A", '"AB"', 'P1ST="X"']
)
def test_clear_expressions(text: str) -> None:
    assert not isinstance(parse_expression(text), Bad)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("A<B&C<D", "put each comparison in brackets: (A<B)&(B<C)"),
        ("A<B<C", "put each comparison in brackets: (A<B)&(B<C)"),
        ("A,5", "a comma has no place here; the decimal sign is a point"),
        ("(A+B", "')' is missing"),
        ("A+B)", "a bracket is closed that was not opened"),
        (
            "@FOO[5]",
            "there is no function @FOO; there are @ABS, @AN, @COM, @COS, @FRAC, @IN, @INT, @OUT, @RND, @SIN, @SQR",
        ),
        ("A+", "something is missing at the end"),
        ("--5", "two signs stand next to each other: keep one"),  # a slip that would turn the direction round
        ("+-5", "two signs stand next to each other: keep one"),
        ("A*(-+B)", "two signs stand next to each other: keep one"),
        ("", "an expression is missing"),
        ("LONGVARIABLE", "the name LONGVARIABLE is longer than 8 characters"),
        ("(((((A)))))", "the controller understands at most 4 brackets inside each other"),
    ],
)
def test_problems(text: str, message: str) -> None:
    assert parse_expression(text) == Bad(message)


def factor_of(operand: Operand) -> Fraction | None:
    return {"X": Fraction(4000), "Y": Fraction(2000)}[operand.suffix] if operand.name in POSITIONS else None


@pytest.mark.parametrize(
    ("typed", "sent"),
    [
        ("LEN", "LEN*4000"),
        ("LEN*2", "LEN*2*4000"),
        ("(LEN+1)*2", "(LEN+1)*2*4000"),
        ("LEN+1", "(LEN+1)*4000"),
        ("_TPX", "_TPX"),
        ("_TPX+LEN", "_TPX+(LEN*4000)"),
        ("_TPX+0.5", "_TPX+2000"),
        ("2*_TPX", "_TPX*2"),
        ("_TPY", "_TPY*2"),
        ("LEN*_TPX", "LEN*(_TPX/4000)*4000"),
        ("@ABS[_TPX]", "@ABS[_TPX/4000]*4000"),
        ("-LEN", "-(LEN*4000)"),
        ("_TEX", "_TEX*4000"),
    ],
)
def test_user_units(typed: str, sent: str) -> None:
    tree = parse_expression(typed)
    assert not isinstance(tree, Bad)
    assert write(in_counts(tree, Fraction(4000), factor_of)) == sent


def worth(tree: Expression, live: Fraction) -> Fraction:
    """An expression worked out exactly, with LEN 3, A 7 and live positions of `live` counts."""
    match tree:
        case Number(value=value):
            return value
        case Variable(name=name):
            return Fraction({"LEN": 3, "A": 7, "n": 2, "COUNT": 5}[name])
        case Operand():
            return live
        case Group(inner=inner):
            return worth(inner, live)
        case Negative(operand=inner):
            return -worth(inner, live)
        case Binary(operator=operator, left=left, right=right):
            one, other = worth(left, live), worth(right, live)
            if operator == "/":
                return one / other if other else Fraction(0)
            return {"+": one + other, "-": one - other, "*": one * other}[operator]
        case _:
            raise AssertionError(tree)


ARITHMETIC = st.recursive(
    st.one_of(
        st.integers(1, 50).map(lambda number: Number(Fraction(number, 2))),
        st.sampled_from(["LEN", "A"]).map(Variable),
        st.just(Operand("TP", "X")),
    ),
    lambda inner: st.one_of(st.builds(Binary, st.sampled_from("+-*"), inner, inner), st.builds(Group, inner)),
    max_leaves=5,
)


@given(ARITHMETIC, st.sampled_from([Fraction(637), Fraction(4000), Fraction("39.37"), Fraction(1), Fraction(1, 8)]))
def test_user_units_are_the_same_value(tree: Expression, scale: Fraction) -> None:
    """counts(expression) is the expression in units, worked out, times the scale: exactly."""
    in_units = worth(_with_live_in_units(tree, scale), Fraction(10001))
    counts = in_counts(tree, scale, lambda operand: scale)
    assert worth(counts, Fraction(10001)) == in_units * scale


def _with_live_in_units(tree: Expression, scale: Fraction) -> Expression:
    match tree:
        case Operand():
            return Binary("/", tree, Number(scale))
        case Group(inner=inner):
            return _with_live_in_units(inner, scale)
        case Binary(operator=operator, left=left, right=right):
            return Binary(operator, _with_live_in_units(left, scale), _with_live_in_units(right, scale))
        case _:
            return tree


def test_walk_finds_everything() -> None:
    tree = parse_expression("(A+POS[I])*@SIN[_TPX]")
    assert not isinstance(tree, Bad)
    found = [type(node).__name__ for node in walk(tree)]
    assert found == ["Binary", "Group", "Binary", "Variable", "Element", "Variable", "Function", "Operand"]
    assert children(Number(Fraction(1))) == ()
