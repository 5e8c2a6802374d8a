"""Random instructions, steps and programs for property tests, made from the fields themselves."""

from __future__ import annotations

import dataclasses as dc
from typing import Any

from hypothesis import strategies as st

from codegen.fields import (
    AXES,
    AxisName,
    AxisSet,
    Choice,
    Code,
    Condition,
    Dimension,
    ExpressionField,
    Field,
    Flag,
    InputNumber,
    LabelName,
    Limit,
    ListOf,
    MessageText,
    Number,
    OutputNumber,
    PerAxis,
    Quantity,
    Table,
    Text,
    VariableName,
    fields_of,
)
from codegen.instructions import ALL, Instruction
from codegen.program import Program, Step
from codegen.setup import Axis, Setup

SETUP = Setup(
    model="ssc4",
    axes=(Axis(counts_per_unit="637"), Axis(counts_per_unit="4000"), Axis(), Axis(counts_per_unit="39.37")),
)
EXPRESSIONS = st.sampled_from(
    [
        "LEN",
        "LEN*2",
        "(A+B)*2",
        "_TPX",
        "_TPX+LEN",
        "-LEN",
        "@ABS[A]",
        "POS[3]",
        "POS[I+1]",
        "A*_TPY",
        "2*_RPX",
        "LEN/3",
        "@SIN[A]*5",
    ]
)
CONDITIONS = st.sampled_from(["LEN>5", "(A<B)&(C<D)", "@IN[1]=0", "_TPX>=A+5", "A", 'P1ST="X"', "(A<>B)|(C=1)"])
LETTERS = st.text(st.sampled_from("ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"), min_size=0, max_size=6)
MESSAGE = st.text(st.characters(min_codepoint=32, max_codepoint=126, exclude_characters='"\\'), min_size=1, max_size=50)
CODE = st.sampled_from(["PR 1000", "SP 5000;BG X", "MG _TPX{F10.4}", "V=1\nV=V+1", "SH XY", "MO"])
NAMES = st.sampled_from(["LEN", "COUNT", "Result", "n", "A", "SPEED", "V1"])
SPANS = {
    Dimension.DISTANCE: (-900, 900),
    Dimension.POSITION: (-900, 900),
    Dimension.SPEED: (1, 900),
    Dimension.ACCELERATION: (100, 9000),
    Dimension.ERROR: (0, 9),
    Dimension.TIME: (1, 30000),
    Dimension.VOLTS: (-9, 9),
    Dimension.NUMBER: (-100, 100),
}


def decimals(low: float, high: float, whole: bool = False) -> st.SearchStrategy[str]:
    """Numbers as people type them."""
    if whole:
        return st.integers(int(low), int(high)).map(str)
    scaled = st.integers(int(low * 1000), int(high * 1000))
    return scaled.map(lambda number: f"{'-' if number < 0 else ''}{abs(number) // 1000}.{abs(number) % 1000:03d}")


def values(field: Field, plain_only: bool = False) -> st.SearchStrategy[Any]:
    """Valid values of a field; `plain_only` leaves expressions out, whose values only the controller knows."""
    if plain_only and isinstance(field, Quantity | Number):
        field = dc.replace(field, literal=True)
    match field:
        case Choice(kind=kind):
            return st.sampled_from(list(kind))
        case Flag():
            return st.booleans()
        case PerAxis(of=inner):
            one = st.one_of(st.just(""), texts(inner, plain_only))
            return st.tuples(one, one, one, one)
        case Quantity(dimension=dimension, literal=literal):
            low, high = SPANS[dimension]
            plain = decimals(0.5 if field.positive and low <= 0 else low, high)
            return plain if literal else st.one_of(plain, EXPRESSIONS)
        case Number(low=low, high=high, whole=whole, literal=literal):
            plain = decimals(low, min(high, 100000), whole)
            return plain if literal else st.one_of(plain, EXPRESSIONS)
        case AxisName():
            return st.sampled_from(AXES)
        case AxisSet():
            return st.sets(st.sampled_from(AXES), min_size=1).map(
                lambda letters: "".join(x for x in AXES if x in letters)
            )
        case Condition():
            return CONDITIONS
        case ExpressionField():
            return st.one_of(EXPRESSIONS, decimals(-100, 100))
        case Code():
            return CODE
        case MessageText(most=most):
            return MESSAGE.map(lambda text: text[: most or 50])
        case Table():
            return tables()
        case Text():
            return st.text(st.characters(min_codepoint=32, max_codepoint=126), max_size=60).map(str.strip)
        case LabelName():
            return LETTERS.map(lambda text: "L" + text)
        case VariableName(elements=True):
            return st.one_of(NAMES, st.just("POS[3]"))
        case VariableName():
            return st.sampled_from(["LEN", "POS", "A", "SPEED"])
        case InputNumber() | OutputNumber():
            return st.integers(1, 8).map(str)
        case ListOf(row=row):
            return st.lists(items(row, plain_only), min_size=1, max_size=6).map(tuple)
        case _:
            raise AssertionError(f"no values for {field}")


@st.composite
def tables(draw: st.DrawFn) -> str:
    """Tables of one to four columns, with small steps as they are real."""
    columns, rows = draw(st.integers(1, 4)), draw(st.integers(1, 9))
    cell = st.integers(-200, 200).map(lambda number: f"{number / 1000:.3f}")
    return "\n".join("\t".join(draw(cell) for _ in range(columns)) for _ in range(rows))


def texts(field: Field, plain_only: bool = False) -> st.SearchStrategy[str]:
    """Valid values for one axis of a per-axis field."""
    match field:
        case Flag():
            return st.sampled_from(["on", "off"])
        case Choice(kind=kind):
            return st.sampled_from([member.value for member in kind])
        case Limit():
            return st.one_of(st.just("off"), decimals(-900, 900))
        case _:
            return values(field, plain_only)


def items(kind: type[Any], plain_only: bool = False) -> st.SearchStrategy[Any]:
    """Instances of an instruction or a row, optional values left out now and then."""
    made = {}
    for name, field in fields_of(kind).items():
        strategy = values(field, plain_only)
        optional = not field.required and not isinstance(field, Flag | PerAxis | AxisSet)
        made[name] = st.one_of(st.just(""), strategy) if optional else strategy
    return st.builds(kind, **made)


def plain_items(kind: type[Any]) -> st.SearchStrategy[Any]:
    """Instances whose numbers are numbers."""
    return items(kind, plain_only=True)


def instructions() -> st.SearchStrategy[Instruction]:
    return st.sampled_from(ALL).flatmap(items)


LEAVES = [kind for kind in ALL if not kind.container]


@st.composite
def programs(draw: st.DrawFn, most: int = 8) -> Program:
    """Programs with nested repeats and subroutines; every id is its own."""
    number = iter(range(1, 10000))

    def steps(depth: int) -> tuple[Step, ...]:
        found = []
        for _ in range(draw(st.integers(0, most if depth == 0 else 3))):
            holds = depth < 3 and draw(st.integers(0, 3)) == 0
            kind = next(each for each in ALL if each.__name__ == "Repeat") if holds else draw(st.sampled_from(LEAVES))
            body = steps(depth + 1) if holds else ()
            found.append(
                Step(
                    f"s{next(number)}",
                    draw(items(kind)),
                    draw(st.sampled_from(["", "a note"])),
                    draw(st.booleans()),
                    body,
                )
            )
        return tuple(found)

    return Program(draw(st.text(max_size=12)), draw(st.text(max_size=12)), steps(0), steps(0), ())
