"""Every bound of every field: what lies on it is accepted and sent, what lies beyond it is refused with the bound."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Iterator
from fractions import Fraction
from typing import Any

import pytest

from codegen.fields import AXES, Context, ListOf, Number, PerAxis, Quantity, Smoothing, Table, fields_of, is_shown
from codegen.instructions import ALL, Instruction
from codegen.numbers import plain
from codegen.read import problem_of
from tests.codegen.modes import MODES
from tests.codegen.modes.bench import ONE_UNIT

NUMBERS = [
    pytest.param(kind, name, field, id=f"{kind.__name__}.{name}")
    for kind in (*ALL, *(field.row for each in ALL for field in fields_of(each).values() if isinstance(field, ListOf)))
    for name, field in fields_of(kind).items()
    if isinstance(field.of if isinstance(field, PerAxis) else field, Number | Quantity)
]


def inner(field: Any) -> Any:
    """Of a per-axis field the kind of its values."""
    return field.of if isinstance(field, PerAxis) else field


def grain(field: Any) -> Fraction:
    """The smallest step a person would go beyond a bound."""
    whole = getattr(field, "whole", False) or getattr(field, "most_counts", 0)  # counts: less than one is rounded away
    return Fraction(1) if whole else Fraction(1, 1000)


def judged(field: Any, number: Fraction, letter: str = "X") -> str | None:
    """What the field says of a number on an axis."""
    text = plain(number)
    if isinstance(field, PerAxis):
        value = tuple(text if each == letter else "" for each in AXES)
        return field.problem(value, Context(ONE_UNIT))
    return field.problem(text, Context(ONE_UNIT, letter if isinstance(field, Quantity) else ""))


def bounds(field: Any) -> Iterator[tuple[Fraction, int]]:
    """Each bound with the direction that leads beyond it."""
    if isinstance(field, Number):
        low, high = Fraction(str(field.low)), Fraction(str(field.high))
    else:
        low, high = ONE_UNIT.bounds(field.dimension, "X")
        if field.signed:
            low = -high
        if field.most_counts:
            high = min(high, ONE_UNIT.from_counts(field.dimension, "X", field.most_counts))
    if not (isinstance(field, Quantity) and field.positive):
        yield low, -1
    yield high, 1


@pytest.mark.parametrize(("kind", "name", "field"), NUMBERS)
def test_the_bound_is_in_and_beyond_is_out(kind: type[Any], name: str, field: Any) -> None:
    for bound, away in bounds(inner(field)):
        inside = bound - away * grain(inner(field)) * (bound.denominator != 1)
        assert judged(field, inside) is None, plain(inside)
        beyond = judged(field, bound + away * grain(inner(field)) * 3)
        assert beyond is not None and inner(field).label in beyond, plain(bound)
        assert "\n" not in beyond and not beyond.endswith(".")


@pytest.mark.parametrize(("kind", "name", "field"), NUMBERS)
def test_text_and_commas_are_no_numbers(kind: type[Any], name: str, field: Any) -> None:
    for text in ("12,5", "1e3", "--5", "5 5", "", "A+B*2"):
        value = (text, "", "", "") if isinstance(field, PerAxis) else text
        letter = "X" if isinstance(inner(field), Quantity) else ""
        problem = field.problem(value, Context(ONE_UNIT, letter))
        optional = text == "" and not field.required
        assert (problem is None) == optional, text


@pytest.mark.parametrize("kind", [kind for kind in ALL if not kind.needs], ids=lambda kind: kind.__name__)
def test_an_axis_that_is_not_there_is_refused(kind: type[Instruction]) -> None:
    """On a controller of one axis no instruction accepts another axis."""
    one = dc.replace(ONE_UNIT, model="ssc1")
    for mode in MODES:
        if type(mode.does) is not kind:
            continue
        for name, field in fields_of(kind).items():
            value = getattr(mode.does, name)
            if not is_shown(mode.does, name) or field.empty(value):
                continue
            named = (
                "".join(each for each, text in zip(AXES, value, strict=True) if text)
                if isinstance(field, PerAxis)
                else value
            )
            if type(field).__name__ in ("AxisName", "AxisSet", "PerAxis") and set(named) - {"X"}:
                problem = problem_of(mode.does, name, one)
                assert problem is not None and "this controller has no axis" in problem


def test_every_table_has_its_most_rows() -> None:
    for kind in ALL:
        for field in fields_of(kind).values():
            if isinstance(field, Table):
                most = "\n".join(["1"] * min(field.most_rows, 3000))
                assert field.problem(most, Context(ONE_UNIT)) is None
                if field.most_rows < 3000:
                    assert field.problem(most + "\n1", Context(ONE_UNIT)) is not None


def test_smoothing_of_a_stepper_is_another_one() -> None:
    from tests.codegen.modes.bench import STEPPER

    field = Smoothing(label="Smoothing")
    for text, good in (("0.5", True), ("8", True), ("0.4", False), ("8.1", False), ("128", False)):
        assert (field.problem(text, Context(STEPPER, "Y")) is None) == good
