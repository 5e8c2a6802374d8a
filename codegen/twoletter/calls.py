"""Statements of two-letter code as values: a Call refuses unknown commands and bad values when it is made."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import TypeAlias

from codegen.numbers import plain
from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.fixed import scaled
from codegen.twoletter.rows import Field, Row, Takes

AXES = "XYZW"
Value: TypeAlias = int | Fraction | str  # a number, or the text of an expression
_LETTERS = {Takes.AXES: "XYZW", Takes.AXES_S: "XYZWS", Takes.PLANE: "XYZWN", Takes.AXIS: "XYZW"}


class BadCall(ValueError):
    """A call the command table does not allow: a mistake of an emitter."""


@dataclass(frozen=True, slots=True)
class Call:
    """One command with its arguments as they are written."""

    name: str
    arguments: str = ""

    def __post_init__(self) -> None:
        if self.name not in COMMANDS:
            raise BadCall(f"there is no command {self.name}")

    @property
    def text(self) -> str:
        if self.arguments.startswith("["):
            return f"{self.name}{self.arguments}"
        return f"{self.name} {self.arguments}" if self.arguments else self.name


@dataclass(frozen=True, slots=True)
class Mark:
    """A label."""

    label: str

    @property
    def text(self) -> str:
        return f"#{self.label}"


@dataclass(frozen=True, slots=True)
class Assign:
    """`V=expression`"""

    target: str
    expression: str

    @property
    def text(self) -> str:
        return f"{self.target}={self.expression}"


@dataclass(frozen=True, slots=True)
class Raw:
    """Code written by the person, one line."""

    text: str


class Body:
    """Where the steps of a container go."""

    text = ""


BODY = Body()
Statement: TypeAlias = Call | Mark | Assign | Raw | Body


def written(value: Value) -> str:
    """A value as it stands in the code."""
    if isinstance(value, Fraction):
        return plain(value)
    return str(value)


def _row(name: str, *shapes: Takes) -> Row:
    row = COMMANDS.get(name)
    if row is None:
        raise BadCall(f"there is no command {name}")
    if row.takes not in shapes:
        raise BadCall(f"{name} takes {row.takes.value}")
    return row


def _checked(name: str, row: Row | Field, value: Value) -> str:
    if not isinstance(value, str) and not row.accepts(scaled(value), None):
        raise BadCall(f"{name} {written(value)} is outside {row.low} to {row.high}")
    return written(value)


def by_axis(name: str, values: Mapping[str, Value]) -> Call:
    """`PR ,8000`: a number at the place of each axis that has one."""
    row = _row(name, Takes.AXIS_NUMBERS, Takes.ONE_AXIS_NUMBER)
    if not values or any(letter not in AXES for letter in values):
        raise BadCall(f"{name} needs values for axes, not {dict(values)}")
    if row.takes is Takes.ONE_AXIS_NUMBER and len(values) > 1:
        raise BadCall(f"{name} takes one axis at a time")
    places = [_checked(name, row, values[letter]) if letter in values else "" for letter in AXES]
    return Call(name, ",".join(places).rstrip(","))


def for_axes(name: str, letters: str) -> Call:
    """`BG XY`; no letters mean all axes."""
    row = _row(name, Takes.AXES, Takes.AXES_S, Takes.PLANE, Takes.AXIS)
    allowed = _LETTERS[row.takes]
    if any(letter not in allowed for letter in letters) or len(set(letters)) < len(letters):
        raise BadCall(f"{name} takes the axes {allowed}, not {letters}")
    return Call(name, letters)


def segment(name: str, values: Mapping[int, Value], speed: Value | None = None) -> Call:
    """`VP 1000,2000<500`, `LI ,5`: values by their place, and the speed of this segment."""
    row = _row(name, Takes.SEGMENT, Takes.SEGMENT_AXES)
    rows: tuple[Field | Row, ...] = row.fields or (row,) * len(AXES)
    places = [_checked(name, rows[place], values[place]) if place in values else "" for place in range(len(rows))]
    behind = "" if speed is None else f"<{_checked('VS', COMMANDS['VS'], speed)}"
    return Call(name, ",".join(places).rstrip(",") + behind)


def entry(name: str, index: int, values: Mapping[str, Value]) -> Call:
    """`ET[3]=,1500`: one entry of a table, a number at the place of each axis that has one."""
    row = _row(name, Takes.TABLE)
    places = [_checked(name, row, values[letter]) if letter in values else "" for letter in AXES]
    return Call(name, f"[{index}]=" + ",".join(places).rstrip(","))


def numbers(name: str, *values: Value | None) -> Call:
    """`OB 3,A>5`: numbers with a meaning of their own; None leaves a place empty."""
    row = _row(name, Takes.NUMBERS)
    rows: tuple[Field | Row, ...] = row.fields or (row,)
    if len(values) > len(rows):
        raise BadCall(f"{name} takes at most {len(rows)} numbers")
    places = ["" if value is None else _checked(name, rows[place], value) for place, value in enumerate(values)]
    return Call(name, ",".join(places).rstrip(","))


def target(name: str, label: str, *more: Value) -> Call:
    """`JP #A,V>5`"""
    _row(name, Takes.TARGET)
    return Call(name, ",".join((f"#{label}", *map(written, more))))


def listed(name: str, *items: str) -> Call:
    """`DM A[10],B[20]`, `MG "text",V`: items in their own notation."""
    _row(
        name,
        Takes.DIMENSIONS,
        Takes.DEALLOCATE,
        Takes.MESSAGE,
        Takes.INPUT,
        Takes.ARRAYS,
        Takes.SOURCES,
        Takes.TEXT,
        Takes.MASTER,
    )
    return Call(name, ",".join(items))


def simple(name: str) -> Call:
    """A command without arguments."""
    return Call(name)
