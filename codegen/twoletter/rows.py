"""What a row of the command table is: everything known about one two-letter command, keyword or function."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from fractions import Fraction
from typing import Literal, Protocol

from codegen.models import Model
from codegen.twoletter.fixed import ONE, places, scaled

Number = int | float
Confidence = Literal["high", "medium", "low"]

SSC = frozenset({"ssc"})
DMC141X = frozenset({"dmc141x"})
BOTH = SSC | DMC141X

FRACTION = 1 / ONE  # the finest step there is
VOLT_STEP = 20 / ONE  # one step of the 16-bit converter over +/-10 V
MOST_DIGITS, MOST_HEXADECIMAL, MOST_DECIMALS = 10, 8, 4  # of PF and VF (dmc-1412-1414.txt l.3758)


class Takes(Enum):
    """The shape of a command's arguments."""

    NONE = "nothing"
    AXES = "axis letters (none: all axes)"
    AXES_S = "axis letters or S for the coordinated sequence (none: all axes)"
    AXES_OR_ONE = "axis letters, or 1 for the text"
    AXIS = "one axis letter, or N for none"
    PLANE = "two axis letters, then the tangent axis or N"
    MASTER = "one axis, DX..DW, CX..CW or S"
    AXIS_NUMBERS = "x,y,z,w: one number for each axis"
    ONE_AXIS_NUMBER = "one number at the place of its axis"
    NUMBERS = "numbers with a meaning of their own"
    SEGMENT_AXES = "x,y,z,w [< speed]"
    SEGMENT = "numbers [< speed]"
    TABLE = "[i]=x,y,z,w"
    TARGET = "#label or line number, then numbers"
    DIMENSIONS = "name[size],name[size]…"
    DEALLOCATE = "name[],name…, * or *[0]"
    ARRAYS = "name[],name[]…"
    SOURCES = "operands to record, such as _TPX"
    ARRAY_RANGE = "name[],first,last"
    MESSAGE = "text, values and formats"
    INPUT = '"prompt",variable'
    TEXT = "any text"
    OPERAND = "nothing: a value used in expressions"
    BYTES = "control characters"


BY_AXIS = frozenset({Takes.AXIS_NUMBERS, Takes.ONE_AXIS_NUMBER, Takes.SEGMENT_AXES, Takes.TABLE})


class Limits(Protocol):
    """What fields, rows and functions have in common: the limits of a number.

    `also` lists further values allowed, `never` values inside the range that are not.
    """

    @property
    def low(self) -> Number | None: ...
    @property
    def high(self) -> Number | None: ...
    @property
    def step(self) -> Number | None: ...
    @property
    def choices(self) -> tuple[Number, ...]: ...
    @property
    def also(self) -> tuple[Number, ...]: ...
    @property
    def never(self) -> tuple[Number, ...]: ...
    @property
    def high_from(self) -> str: ...
    @property
    def low_from(self) -> str: ...
    @property
    def below(self) -> int: ...
    @property
    def unit(self) -> str: ...


def bounds(row: Limits, model: Model | None, axis_is_stepper: bool = False) -> tuple[Number | None, Number | None]:
    """Lowest and highest value on that model, in the row's units; None where nothing is fixed."""
    low, high = row.low, row.high
    if model is None or model.family == "smartmotor":
        return low, high
    if row.high_from:
        high = getattr(model, row.high_from) - row.below
        if row.high_from == "servo_max_counts_s" and axis_is_stepper:
            high = model.stepper_max_counts_s
        if low is not None and low < -1:
            low = -high
    if row.low_from:
        low = getattr(model, row.low_from)
    return low, high


def within(row: Limits, value: int, model: Model | None, axis_is_stepper: bool = False) -> bool:
    """Whether the scaled value, rounded as the register rounds it, lies in the range and among the choices."""
    if row.choices:
        return value in [scaled(choice) for choice in row.choices]
    if row.unit == "digits":
        digits, decimals, hexadecimal = places(value)
        return decimals <= MOST_DECIMALS and digits <= (MOST_HEXADECIMAL if hexadecimal else MOST_DIGITS)
    if value in [scaled(extra) for extra in row.also]:
        return True
    if value in [scaled(hole) for hole in row.never]:
        return False
    low, high = bounds(row, model, axis_is_stepper)
    if row.step == 1:
        value = value >> 16 << 16
    return (low is None or value >= scaled(low)) and (high is None or value <= scaled(high))


def rounded(row: Limits, value: int) -> int:
    """What a register of that step keeps of a scaled value: step 1 rounds down, other steps towards zero."""
    step = row.step
    if not step or step <= FRACTION or value in [scaled(extra) for extra in row.also]:
        return value
    if step == 1:
        return value >> 16 << 16
    grain = Fraction(step) * ONE
    magnitude = abs(value) * grain.denominator // grain.numerator * grain.numerator // grain.denominator
    return -magnitude if value < 0 else magnitude


@dataclass(frozen=True, slots=True, kw_only=True)
class Field:
    """One named place of a list such as `m,n,o`."""

    name: str
    help: str
    low: Number | None = None
    high: Number | None = None
    step: Number | None = 1
    default: Number | None = None
    choices: tuple[Number, ...] = ()
    high_from: str = ""
    low_from: str = ""
    below: int = 0
    unit: str = ""
    also: tuple[Number, ...] = ()
    never: tuple[Number, ...] = ()
    optional: bool = True

    def range_for(self, model: Model, axis_is_stepper: bool = False) -> tuple[Number | None, Number | None]:
        return bounds(self, model, axis_is_stepper)

    def accepts(self, value: int, model: Model | None, axis_is_stepper: bool = False) -> bool:
        return within(self, value, model, axis_is_stepper)

    def stored(self, value: int) -> int:
        return rounded(self, value)


@dataclass(frozen=True, slots=True, kw_only=True)
class Row:
    """One command: what it takes, its limits, where it is valid, what it answers.

    `reply` is the format of `?` (None: no `?`), `high_from` names the field of Model that sets the top.
    `tells` marks commands that print the value themselves (TP).
    `burned`: among the parameters that BN keeps (the list is recalled; BP, BV keep other things).
    `moving_mode` says when it is still allowed while its axis moves: "jog" (in jog mode), "idle" (BG: error 21).
    `profile` tells which fact is recalled or inferred and may have to change when a real controller is asked.
    """

    name: str
    title: str
    group: str
    takes: Takes
    help: str
    example: str
    fields: tuple[Field, ...] = ()
    fields_141x: tuple[Field, ...] = ()
    minimum: int = 0
    most: int = 0
    low: Number | None = None
    high: Number | None = None
    step: Number | None = None
    default: Number | str | None = None
    choices: tuple[Number, ...] = ()
    also: tuple[Number, ...] = ()
    never: tuple[Number, ...] = ()
    high_from: str = ""
    low_from: str = ""
    below: int = 0
    unit: str = ""
    reply: str | None = None
    tells: bool = False
    operand: Literal["axis", "axis_s", "plain", "thread"] | None = None
    operand_help: str = ""
    moving: bool = True
    moving_mode: Literal["", "jog", "idle"] = ""
    program: bool = True
    port: bool = True
    trippoint: bool = False
    burned: bool = False
    families: frozenset[str] = BOTH
    needs: Literal["", "coordinated", "commutation"] = ""
    errors: tuple[int, ...] = ()
    confidence: Confidence = "high"
    profile: str = ""

    def known_to(self, model: Model) -> bool:
        """Whether that controller has the command."""
        if model.family not in self.families or self.name in model.missing:
            return False
        return not self.needs or bool(getattr(model, self.needs))

    def fields_for(self, model: Model | None) -> tuple[Field, ...]:
        """The named places of the argument list on that model."""
        if model is not None and model.family == "dmc141x" and self.fields_141x:
            return self.fields_141x
        return self.fields

    def places_for(self, model: Model | None) -> int:
        """How many places the argument list has at most on that model."""
        fields = self.fields_for(model)
        if self.takes in BY_AXIS and not (fields and self.fields_141x):
            return 4 if model is None else len(model.axes)
        return self.most or len(fields)

    def range_for(self, model: Model, axis_is_stepper: bool = False) -> tuple[Number | None, Number | None]:
        return bounds(self, model, axis_is_stepper)

    def accepts(self, value: int, model: Model | None, axis_is_stepper: bool = False) -> bool:
        return within(self, value, model, axis_is_stepper)

    def stored(self, value: int) -> int:
        return rounded(self, value)


@dataclass(frozen=True, slots=True, kw_only=True)
class KeywordRow:
    """A value without underscore, such as TIME or P1CH."""

    name: str
    title: str
    help: str
    example: str
    is_string: bool = False
    families: frozenset[str] = BOTH
    confidence: Confidence = "high"
    profile: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class FunctionRow:
    """An @function; `pure` ones depend on nothing but their argument."""

    name: str
    title: str
    help: str
    example: str
    pure: bool = True
    unit: str = ""
    low: Number | None = None
    high: Number | None = None
    step: Number | None = None
    choices: tuple[Number, ...] = ()
    high_from: str = ""
    low_from: str = ""
    below: int = 0
    also: tuple[Number, ...] = ()
    never: tuple[Number, ...] = ()
    families: frozenset[str] = BOTH
    confidence: Confidence = "high"
    profile: str = ""

    def accepts(self, value: int, model: Model | None) -> bool:
        """Whether the scaled argument is in range."""
        return within(self, value, model)

    def range_for(self, model: Model) -> tuple[Number | None, Number | None]:
        return bounds(self, model)


def table(rows: Sequence[Row]) -> dict[str, Row]:
    """The rows by name; two rows of one name are a fault of the table."""
    by_name = {row.name: row for row in rows}
    assert len(by_name) == len(rows), "two rows of one name"
    return by_name
