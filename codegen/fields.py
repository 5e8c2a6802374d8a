"""Kinds of value an instruction can hold: what is wrong with a value, how it reads, what is sent for it.

Values are kept as the text the person typed ("" = not given); choices are members of a StrEnum, per-axis
values are four texts in the order X Y Z W.
"""

from __future__ import annotations

import dataclasses as dc
import re
from collections.abc import Mapping
from enum import StrEnum
from fractions import Fraction
from functools import lru_cache
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar

from codegen.expressions import KEYWORDS, NAME, Bad, Element, Expression, Variable, constant, parse_expression, write
from codegen.numbers import looks_like_number, number_problem, parse_number, plain

if TYPE_CHECKING:
    from codegen.setup import Setup

AXES = "XYZW"
PerAxisText = tuple[str, str, str, str]
NONE: PerAxisText = ("", "", "", "")


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


@dc.dataclass(frozen=True, slots=True)
class Context:
    """What a value needs to know beside itself: the machine, and the axis it belongs to ("" = none)."""

    setup: Setup
    axis: str = ""


@dc.dataclass(frozen=True, slots=True)
class Counts:
    """What is really sent for a quantity, and a warning when rounding changes it by more than 0.1 %."""

    text: str
    warning: str | None = None


@dc.dataclass(frozen=True, kw_only=True)
class Field:
    """One value of an instruction: its name in the dialog, its help, and when it is shown."""

    label: str
    help: str = ""
    when: Mapping[str, Any] = dc.field(
        default_factory=dict
    )  # {"mode": Mode.BY} or {"mode": (Mode.BY, Mode.TO)}: names of siblings
    required: bool = True
    warns: ClassVar[bool] = False  # whether rounding may change the value

    def empty(self, value: Any) -> bool:
        """Whether nothing has been entered."""
        return value in ("", (), NONE)

    def problem(self, value: Any, context: Context) -> str | None:
        """What is wrong with `value`, in one sentence that starts with the label."""
        if self.empty(value):
            return f"{self.label} is missing" if self.required else None
        return self.wrong(value, context)

    def wrong(self, value: Any, context: Context) -> str | None:
        """As `problem`, for a value that is not empty."""
        return None

    def text(self, value: Any, context: Context) -> str:
        """The value as the sentence says it."""
        return str(value)

    def counts(self, value: Any, context: Context) -> Counts | None:
        """What is sent to the controller where that differs from what is shown."""
        return None

    def unit(self, context: Context) -> str:
        """The unit shown behind the field."""
        return ""


def _numeric_problem(label: str, text: str) -> str | None:
    """What is wrong with a text that should be a number or an expression."""
    if parse_number(text) is not None:
        return None
    if looks_like_number(text):
        return f"{label}: {number_problem(text)}"
    tree = parse_expression(text)
    return f"{label}: {tree.message}" if isinstance(tree, Bad) else None


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


def _value_text(text: str) -> str:
    value = value_of(text)
    if isinstance(value, Fraction):
        return plain(value)
    return text.strip() if isinstance(value, Bad) else write(value)


@dc.dataclass(frozen=True, kw_only=True)
class Quantity(Field):
    """A measured value in the user's unit: a number or an expression."""

    dimension: Dimension
    axis: str = "axis"  # the sibling that names the axis; "" = none
    positive: bool = False  # must be above zero
    signed: bool = False  # a speed that may be negative
    literal: bool = False  # no expressions
    warns: ClassVar[bool] = True

    def wrong(self, value: str, context: Context) -> str | None:
        if problem := _numeric_problem(self.label, value):
            return problem
        number = value_of(value)
        if type(number) is not Fraction:
            return f"{self.label} must be a plain number" if self.literal else None
        return self.range_problem(number, context)

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
            too_small = self.positive and context.setup.counts(self.dimension, context.axis, number) == 0
            return f"{self.label} is too small: it would be sent as 0" if too_small else None
        return f"{self.label} must lie between {_bound(low)} and {_bound(high)}{behind}"

    def text(self, value: str, context: Context) -> str:
        unit = self.unit(context)
        shown = _value_text(value)
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
        if problem := _numeric_problem(self.label, value):
            return problem
        number = value_of(value)
        if type(number) is not Fraction:
            return f"{self.label} must be a plain number" if self.literal else None
        if self.whole and number.denominator != 1:
            return f"{self.label} must be a whole number"
        low, high = Fraction(str(self.low)), Fraction(str(self.high))
        if not low <= number <= high:
            return f"{self.label} must lie between {plain(low)} and {plain(high)}{self.suffix and ' ' + self.suffix}"
        return None

    def text(self, value: str, context: Context) -> str:
        return f"{_value_text(value)} {self.suffix}".rstrip()

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
class Choice(Field):
    """One of a few: values of `kind` stand in files, `words` are offered, `phrases` stand in the sentence."""

    kind: type[StrEnum]
    words: Mapping[Any, str] = dc.field(default_factory=dict)
    phrases: Mapping[Any, str] = dc.field(
        default_factory=dict
    )  # where the sentence says it in another way; "" says nothing

    def wrong(self, value: Any, context: Context) -> str | None:
        return None if value in tuple(self.kind) else f"{self.label}: '{value}' is not one of the choices"

    def text(self, value: Any, context: Context) -> str:
        return self.phrases.get(value, self.words.get(value, str(value)))


@dc.dataclass(frozen=True, kw_only=True)
class Flag(Field):
    """Yes or no; `phrase` and `off_phrase` are what the sentence says for them ("" = nothing)."""

    phrase: str = ""
    off_phrase: str = ""
    required: bool = False

    def empty(self, value: Any) -> bool:
        return value in ("",)

    def wrong(self, value: Any, context: Context) -> str | None:
        return None if value in (True, False, "on", "off") else f"{self.label} must be on or off"

    def text(self, value: Any, context: Context) -> str:
        return self.phrase if value in (True, "on") else self.off_phrase


@dc.dataclass(frozen=True, kw_only=True)
class AxisName(Field):
    """One axis of the controller."""

    servo_only: bool = False

    def wrong(self, value: str, context: Context) -> str | None:
        return axes_problem(value if len(value) == 1 else "?", self.label, context.setup, self.servo_only)


@dc.dataclass(frozen=True, kw_only=True)
class AxisSet(Field):
    """Some axes of the controller, in the order X Y Z W."""

    servo_only: bool = False

    def wrong(self, value: str, context: Context) -> str | None:
        if value != "".join(letter for letter in AXES if letter in value):
            return f"{self.label}: name each axis once, in the order X Y Z W"
        return axes_problem(value, self.label, context.setup, self.servo_only)

    def text(self, value: str, context: Context) -> str:
        return joined(tuple(value))


def joined(words: tuple[str, ...], last: str = "and") -> str:
    """`X, Y and Z`"""
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} {last} {words[-1]}" if words else ""


def axes_problem(letters: str, label: str, setup: Setup, servo_only: bool = False) -> str | None:
    """Why these axes cannot be used on this machine."""
    for letter in letters:
        if letter not in AXES:
            return f"{label}: choose one of the axes {', '.join(setup.letters)}"
        if letter not in setup.letters:
            return f"{label}: this controller has no axis {letter}"
        if servo_only and setup.axis(letter).is_stepper:
            return f"{label}: axis {letter} is a stepper, and this is for servo axes"
    return None


@dc.dataclass(frozen=True, kw_only=True)
class PerAxis(Field):
    """One value for each axis; an empty one leaves its axis alone."""

    of: Field
    servo_only: bool = False

    def wrong(self, value: PerAxisText, context: Context) -> str | None:
        found = (self.problem_of(value, letter, context) for letter in AXES)
        return next((problem for problem in found if problem), None)

    def problem_of(self, value: PerAxisText, letter: str, context: Context) -> str | None:
        """What is wrong with the value of one axis."""
        own = value[AXES.index(letter)]
        if own == "":
            return None
        if problem := axes_problem(letter, self.label, context.setup, self.servo_only):
            return problem
        problem = self.of.problem(own, Context(context.setup, letter))
        return f"{letter}: {problem}" if problem else None

    def given(self, value: PerAxisText) -> str:
        """Letters of the axes that have a value."""
        return "".join(letter for letter, text in zip(AXES, value, strict=True) if text != "")

    def text(self, value: PerAxisText, context: Context) -> str:
        parts = (
            f"{letter} {self.of.text(text, Context(context.setup, letter))}"
            for letter, text in zip(AXES, value, strict=True)
            if text != ""
        )
        return ", ".join(parts)


@dc.dataclass(frozen=True, kw_only=True)
class ExpressionField(Field):
    """Any expression, raw: positions and speeds in it are counts."""

    def wrong(self, value: str, context: Context) -> str | None:
        return _numeric_problem(self.label, value)

    def text(self, value: str, context: Context) -> str:
        return _value_text(value)


@dc.dataclass(frozen=True, kw_only=True)
class Condition(ExpressionField):
    """An expression that is true (not 0) or false (0)."""


@dc.dataclass(frozen=True, kw_only=True)
class Text(Field):
    """Free text."""

    lines: bool = False  # several lines
    most: int = 0  # most characters; 0 = no limit
    strings: ClassVar[bool] = True

    def wrong(self, value: str, context: Context) -> str | None:
        if not self.lines and "\n" in value:
            return f"{self.label} must be one line"
        if self.most and len(value) > self.most:
            return f"{self.label} may have at most {self.most} characters"
        if not all(character.isprintable() or character == "\n" for character in value):
            return f"{self.label} holds a character that cannot be shown"
        return None


@dc.dataclass(frozen=True, kw_only=True)
class MessageText(Text):
    """Text the controller sends: plain characters without the quotation mark."""

    def wrong(self, value: str, context: Context) -> str | None:
        if problem := super().wrong(value, context):
            return problem
        odd = next((character for character in value if not " " <= character <= "~" or character in '"\\'), None)
        return f"{self.label}: the controller cannot send {odd}" if odd else None

    def text(self, value: str, context: Context) -> str:
        return f'"{value}"'


@dc.dataclass(frozen=True, kw_only=True)
class Code(Field):
    """Two-letter code, one statement or several lines."""

    def wrong(self, value: str, context: Context) -> str | None:
        return context.setup.code_problem(value)

    def text(self, value: str, context: Context) -> str:
        return "; ".join(line.strip() for line in value.splitlines() if line.strip())


LABEL = re.compile(r"[A-Z][A-Z0-9]{0,6}\Z", re.ASCII)
SYSTEM_LABELS = ("AUTO", "ININT", "MCTIME", "POSERR", "LIMSWI", "CMDERR", "COMINT")


@dc.dataclass(frozen=True, kw_only=True)
class LabelName(Field):
    """A label without its `#`: a capital letter and up to six capitals or digits."""

    defines: bool = False

    def wrong(self, value: str, context: Context) -> str | None:
        if LABEL.match(value) is None:
            return f"{self.label} must be a letter and up to 6 letters or digits, in capitals"
        if self.defines and value in SYSTEM_LABELS:
            return f"{self.label}: {value} belongs to the controller; use Subroutine or Auto Execution"
        return None


@dc.dataclass(frozen=True, kw_only=True)
class VariableName(Field):
    """A variable, or with `elements` also one element of an array: `A[3]`."""

    elements: bool = False
    array: bool = False

    def wrong(self, value: str, context: Context) -> str | None:
        tree = parse_expression(value)
        if isinstance(tree, Element) and self.elements:
            return None
        if not isinstance(tree, Variable) or NAME.match(value) is None or value.upper() in KEYWORDS:
            return f"{self.label} must be a letter and up to 7 letters or digits"
        if len(value) == 2 and value.isupper() and context.setup.is_command(value):
            return f"{self.label}: {value} is a command of the controller; choose another name"
        if self.array and not value[0].isupper():
            return f"{self.label} must begin with a capital letter"
        return None


@dc.dataclass(frozen=True, kw_only=True)
class InputNumber(Field):
    """An input, by its number or by its name in the setup."""

    def wrong(self, value: str, context: Context) -> str | None:
        return _channel_problem(self.label, value, context.setup.input_number(value), context.setup.inputs)

    def text(self, value: str, context: Context) -> str:
        return context.setup.channel_text(value, context.setup.input_names, context.setup.input_number(value))


@dc.dataclass(frozen=True, kw_only=True)
class OutputNumber(Field):
    """An output, by its number or by its name in the setup."""

    def wrong(self, value: str, context: Context) -> str | None:
        return _channel_problem(self.label, value, context.setup.output_number(value), context.setup.outputs)

    def text(self, value: str, context: Context) -> str:
        return context.setup.channel_text(value, context.setup.output_names, context.setup.output_number(value))


def _channel_problem(label: str, value: str, number: int | None, count: int) -> str | None:
    if number is None:
        return f"{label}: '{value}' is neither a number nor a name of the setup"
    return None if 1 <= number <= count else f"{label} must lie between 1 and {count}"


@dc.dataclass(frozen=True, kw_only=True)
class ListOf(Field):
    """Rows of a small dataclass with fields of its own."""

    row: type[Any]
    most: int = 0


def value(field: Field, default: Any = "") -> Any:
    """Declares one value of an instruction: its field, and what a new instruction holds."""
    return dc.field(default=default, metadata={"field": field})


@lru_cache(maxsize=512)
def _fields_of(kind: type[Any]) -> Mapping[str, Field]:
    return MappingProxyType({each.name: each.metadata["field"] for each in dc.fields(kind) if "field" in each.metadata})


def fields_of(item: Any) -> Mapping[str, Field]:
    """The fields of an instruction, a row, an axis or a setup (class or instance), in dialog order."""
    return _fields_of(item if isinstance(item, type) else type(item))


def is_shown(item: Any, name: str) -> bool:
    """Whether the field is to be shown, by the values of its siblings."""
    when = fields_of(item)[name].when
    if not when:
        return True
    for sibling, wanted in when.items():
        present = getattr(item, sibling)
        if present not in wanted if isinstance(wanted, tuple) else present != wanted:
            return False
        if not is_shown(item, sibling):
            return False
    return True
