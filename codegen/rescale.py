"""Changing the unit or the scale of a machine under a program: keep the lengths, or keep the counts.

A number that would not end soon is written with twelve decimals, rounded so that the same counts are sent: away from
zero, because speeds and errors are cut towards it; a limit of the travel outwards, because that is rounded inwards.
"""

from __future__ import annotations

import dataclasses as dc
from fractions import Fraction
from math import ceil, floor
from typing import Any, Literal

from codegen.document import Document
from codegen.expressions import Bad, write
from codegen.fields import (
    AXES,
    OFF,
    Dimension,
    ListOf,
    PathQuantity,
    PerAxis,
    PerAxisText,
    Quantity,
    Table,
    fields_of,
    value_of,
)
from codegen.numbers import plain
from codegen.program import Section, Steps, with_section
from codegen.setup import Axis, Setup
from codegen.tables import Grid, read_table, write_table
from codegen.twoletter.emit.build import is_counted
from codegen.units import in_counts

IN_UNITS = (Dimension.DISTANCE, Dimension.POSITION, Dimension.SPEED, Dimension.ACCELERATION, Dimension.ERROR)
AXIS_VALUES = ("forward_limit", "reverse_limit", "error_limit", "maximum_speed", "maximum_acceleration")
FORWARD, REVERSE = ("forward", "forward_limit"), ("reverse", "reverse_limit")
PLACES = 10**12
Keep = Literal["units", "counts"]


def with_setup(document: Document, setup: Setup, keep: Keep = "units") -> Document:
    """The document on another setup; `counts` rewrites typed numbers so that the machine does what it did."""
    if keep == "units":
        return dc.replace(document, setup=setup)
    factors = {letter: document.setup.axis(letter).scale / setup.axis(letter).scale for letter in AXES}
    program = document.program
    for section in Section:
        program = with_section(program, section, _steps(program.section(section), factors))
    for letter in AXES:
        old = document.setup.axis(letter)
        setup = setup.with_axis(letter, _axis(setup.axis(letter), old, factors[letter]))
    return dc.replace(document, program=program, setup=setup)


def _steps(steps: Steps, factors: dict[str, Fraction]) -> Steps:
    return tuple(
        dc.replace(step, instruction=_item(step.instruction, factors), body=_steps(step.body, factors))
        for step in steps
    )


def _item(item: Any, factors: dict[str, Fraction], letters: str = "") -> Any:
    """An instruction or a row with its typed numbers in the new units; a row is told the axes of its path."""
    new: dict[str, Any] = {}
    for name, field in fields_of(item).items():
        value = getattr(item, name)
        match field:
            case PathQuantity():
                new[name] = scaled_text(value, _along(getattr(item, field.axis, letters), factors))
            case Quantity(dimension=dimension) if dimension in IN_UNITS:
                letter = getattr(item, field.axis, "") if field.axis else ""
                new[name] = scaled_text(value, factors.get(letter, Fraction(1)))
            case PerAxis(of=Quantity(dimension=dimension)) if dimension in IN_UNITS:
                new[name] = _per_axis(value, factors, name)
            case ListOf():
                own = getattr(item, field.axes) if field.axes else ""
                new[name] = tuple(_item(row, factors, own) for row in value)
            case Table():
                new[name] = _table(value, [factors.get(letter, Fraction(1)) for letter in item.column_axes])
    return dc.replace(item, **new) if new else item


def _along(letters: str, factors: dict[str, Fraction]) -> Fraction:
    """What a value of several axes is multiplied with: that of its first axis (a path has one unit)."""
    return factors.get(letters[:1], Fraction(1))


def _table(text: str, factors: list[Fraction]) -> str:
    """A table of numbers, column by column; one that cannot be read stays as it was typed."""
    grid = read_table(text)
    if not isinstance(grid, Grid) or grid.columns != len(factors) or all(factor == 1 for factor in factors):
        return text
    rows = [
        ["" if cell is None else _written(cell * factor) for cell, factor in zip(row, factors, strict=True)]
        for row in grid.rows
    ]
    return write_table(rows)


def _per_axis(texts: PerAxisText, factors: dict[str, Fraction], name: str) -> PerAxisText:
    x, y, z, w = (
        text if text.strip().lower() == OFF else scaled_text(text, factors[letter], name)
        for letter, text in zip(AXES, texts, strict=True)
    )
    return x, y, z, w


def scaled_text(text: str, factor: Fraction, name: str = "") -> str:
    """A typed number times `factor`; in an expression everything but live values, which convert themselves."""
    value = value_of(text)
    if factor == 1 or isinstance(value, Bad):
        return text
    if isinstance(value, Fraction):
        return _written(value * factor, name)
    return write(in_counts(value, factor, lambda operand: factor if is_counted(operand) else None))


def _written(number: Fraction, name: str = "") -> str:
    """A number that the same counts are sent for, in the field of that name."""
    if PLACES % number.denominator == 0:
        return plain(number)
    up = name in FORWARD or (name not in REVERSE and number > 0)
    return plain(Fraction((ceil if up else floor)(number * PLACES), PLACES))


def _axis(new: Axis, old: Axis, factor: Fraction) -> Axis:
    """Limits that were not changed by hand keep their counts."""
    kept = (name for name in AXIS_VALUES if getattr(new, name) == getattr(old, name))
    rewritten: dict[str, Any] = {name: _axis_text(name, getattr(new, name), factor) for name in kept}
    return dc.replace(new, **rewritten)


def _axis_text(name: str, text: str, factor: Fraction) -> str:
    return text if text.strip().lower() == OFF else scaled_text(text, factor, name)
