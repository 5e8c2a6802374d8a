"""Numbers and measured quantities: a number or an expression, with unit, range and rounding."""

from __future__ import annotations

import dataclasses as dc
from enum import StrEnum
from fractions import Fraction
from functools import lru_cache
from typing import TYPE_CHECKING, ClassVar

from codegen.expressions import (
    Bad,
    Element,
    Expression,
    Operand,
    String,
    Variable,
    constant,
    parse_expression,
    walk,
    write,
)
from codegen.fields.field import AXES, Context, Counts, Field
from codegen.numbers import looks_like_number, number_problem, parse_number, plain

if TYPE_CHECKING:
    from codegen.setup import Setup


class Dimension(StrEnum):
    """What a quantity measures; with the axis it decides unit, range and rounding."""

    DISTANCE = "distance"
    POSITION = "position"
    SPEED = "speed"
    ACCELERATION = "acceleration"
    ERROR = "error"
    TIME = "time"
    VOLTS = "volts"
    NUMBER = "number"


def numeric_problem(label: str, text: str, setup: Setup, strings: bool = False) -> str | None:
    """What is wrong with a text that should be a number or an expression."""
    if parse_number(text) is not None:
        return None
    if looks_like_number(text):
        return f"{label}: {number_problem(text)}"
    tree = parse_expression(text)
    if isinstance(tree, Bad):
        return f"{label}: {tree.message}"
    for node in walk(tree):
        if isinstance(node, String) and not strings:
            return f"{label} must be a number, no text"
        if isinstance(node, Variable) and len(node.name) == 2 and setup.is_command(node.name):
            return f"{label}: {node.name} is a command of the controller, no variable"
    return None


@lru_cache(maxsize=8192)
def value_of(text: str) -> Fraction | Expression | Bad:
    """A typed text as a number, or else as an expression."""
    number = parse_number(text)
    if number is not None:
        return number
    tree = parse_expression(text)
    if not isinstance(tree, Bad) and (known := constant(tree)) is not None:
        return known
    return tree


def value_text(text: str) -> str:
    value = value_of(text)
    if isinstance(value, Fraction):
        return text.strip() if "$" in text else plain(value)
    return text.strip() if isinstance(value, Bad) else write(value)


@dc.dataclass(frozen=True, kw_only=True)
class Quantity(Field):
    """A measured value in the user's unit: a number or an expression."""

    dimension: Dimension
    axis: str = "axis"  # the sibling that names the axis; "" = none
    positive: bool = False  # must be above zero
    signed: bool = False  # a speed that may be negative
    literal: bool = False  # no expressions
    most_counts: int = 0  # most the controller takes, as it is sent; 0 = no such limit
    warns: ClassVar[bool] = True

    def wrong(self, value: str, context: Context) -> str | None:
        if problem := numeric_problem(self.label, value, context.setup) or self.scale_problem(value, context):
            return problem
        number = value_of(value)
        if type(number) is not Fraction or (self.literal and parse_number(value) is None):  # "(5)" and "$10" are code
            return f"{self.label} must be a plain number" if self.literal else None
        return self.range_problem(number, context)

    def scale_problem(self, value: str, context: Context) -> str | None:
        """Why nothing can be converted on this axis, or on one that the expression reads."""
        letters = {context.axis}
        number = value_of(value)
        if not isinstance(number, Fraction | Bad):
            letters |= {node.suffix for node in walk(number) if isinstance(node, Operand)}
        for letter in sorted(letters & set(AXES)):
            if problem := context.setup.axis(letter).scale_problem:
                return f"Axis {letter}: {problem}"
        return None

    def range_problem(self, number: Fraction, context: Context) -> str | None:
        """Why a number is outside what axis and controller can do."""
        unit = self.unit(context)
        behind = f" {unit}" if unit else ""
        if self.positive and number <= 0:
            return f"{self.label} must be more than 0{behind}"
        low, high = context.setup.bounds(self.dimension, context.axis)
        if self.signed:
            low = -high
        if low <= number <= high:
            sent = context.setup.counts(self.dimension, context.axis, number)
            if self.most_counts and sent > self.most_counts:
                most = context.setup.from_counts(self.dimension, context.axis, self.most_counts)
                return f"{self.label} must be at most {_bound(Fraction(int(most)))}{behind}"
            too_small = self.positive and sent == 0
            return f"{self.label} is too small: it would be sent as 0" if too_small else None
        return f"{self.label} must lie between {_bound(low)} and {_bound(high)}{behind}"

    def text(self, value: str, context: Context) -> str:
        unit = self.unit(context)
        shown = value_text(value)
        if not unit:
            return shown
        compound = not isinstance(value_of(value), Fraction | Variable | Element | Bad) and not shown.startswith(
            ("_", "@")
        )
        return f"({shown}) {unit}" if compound else f"{shown} {unit}"

    def unit(self, context: Context) -> str:
        return context.setup.unit_text(self.dimension, context.axis)

    def counts(self, value: str, context: Context) -> Counts | None:
        number = value_of(value) if value else Bad("")
        if isinstance(number, Bad) or not context.setup.converts(self.dimension):
            return None
        if not isinstance(number, Fraction):
            factor = context.setup.factor(self.dimension, context.axis)
            written = write(number)
            return Counts(f"{written} × {_bound(factor)}") if factor != 1 else Counts(written)
        return self.exact_counts(number, context)

    def exact_counts(self, number: Fraction, context: Context) -> Counts:
        """The counts of a number, and how far rounding moved it."""
        sent = context.setup.sent(self.dimension, context.axis, number)
        warning = None
        if sent.moved:
            really = context.setup.from_counts(self.dimension, context.axis, sent.counts)
            warning = f"{self.label} will really be {_bound(really)} {self.unit(context)}".rstrip()
        return Counts(f"{sent.counts} {COUNTED.get(self.dimension, 'counts')}", warning)


COUNTED = {Dimension.SPEED: "counts/s", Dimension.ACCELERATION: "counts/s²", Dimension.TIME: "samples"}


def _bound(number: Fraction) -> str:
    return plain(number) if number.denominator == 1 else plain(Fraction(round(number, 6)))


@dc.dataclass(frozen=True, kw_only=True)
class Number(Field):
    """A plain number or an expression without a unit that needs an axis."""

    low: float = -2147483647
    high: float = 2147483647
    step: str = ""  # resolution of the controller, "0.125"
    suffix: str = ""  # unit shown behind the field
    literal: bool = False
    whole: bool = False
    warns: ClassVar[bool] = True

    def wrong(self, value: str, context: Context) -> str | None:
        if problem := numeric_problem(self.label, value, context.setup):
            return problem
        number = value_of(value)
        if type(number) is not Fraction or (self.literal and parse_number(value) is None):  # "(5)" and "$10" are code
            return f"{self.label} must be a plain number" if self.literal else None
        if self.whole and number.denominator != 1:
            return f"{self.label} must be a whole number"
        low, high = Fraction(str(self.low)), Fraction(str(self.high))
        if not low <= number <= high:
            return f"{self.label} must lie between {plain(low)} and {plain(high)}{self.suffix and ' ' + self.suffix}"
        return None

    def text(self, value: str, context: Context) -> str:
        return f"{value_text(value)} {self.suffix}".rstrip()

    def unit(self, context: Context) -> str:
        return self.suffix

    def counts(self, value: str, context: Context) -> Counts | None:
        number = value_of(value) if value else Bad("")
        if not self.step or not isinstance(number, Fraction):
            return None
        step = Fraction(self.step)
        sent = round(number / step) * step
        warning = None
        if abs(sent - number) * 1000 > abs(number):
            warning = f"{self.label} will really be {plain(sent)}"
        return Counts(plain(sent), warning)


@dc.dataclass(frozen=True, kw_only=True)
class Smoothing(Number):
    """How much the corners of a speed profile are rounded: 0 to 255, on a stepper 0.5 to 8."""

    high: float = 255
    low: float = 0
    literal: bool = True
    required: bool = False
    axis: str = "axis"

    def wrong(self, value: str, context: Context) -> str | None:
        if context.axis and context.setup.axis(context.axis).is_stepper:
            return Number(label=f"{self.label} of a stepper", low=0.5, high=8, literal=True).wrong(value, context)
        return super().wrong(value, context)


OFF = "off"


@dc.dataclass(frozen=True, kw_only=True)
class Limit(Quantity):
    """A position that limits the travel, or `off`; the limits of the setup do not bound it."""

    literal: bool = True
    warns: ClassVar[bool] = False

    def wrong(self, value: str, context: Context) -> str | None:
        return None if value.strip().lower() == OFF else super().wrong(value, context)

    def range_problem(self, number: Fraction, context: Context) -> str | None:
        most = LARGEST / context.setup.factor(self.dimension, context.axis)
        return None if abs(number) < most else f"{self.label} is further than the controller can count"

    def text(self, value: str, context: Context) -> str:
        return OFF if value.strip().lower() == OFF else super().text(value, context)

    def counts(self, value: str, context: Context) -> Counts | None:
        return None


LARGEST = 2147483647  # counts; the widest position register


@dc.dataclass(frozen=True, kw_only=True)
class ExpressionField(Field):
    """Any expression, raw: positions and speeds in it are counts."""

    def wrong(self, value: str, context: Context) -> str | None:
        return numeric_problem(self.label, value, context.setup, strings=True)

    def text(self, value: str, context: Context) -> str:
        return value_text(value)


@dc.dataclass(frozen=True, kw_only=True)
class Condition(ExpressionField):
    """An expression that is true (not 0) or false (0)."""
