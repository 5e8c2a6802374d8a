"""How one machine is configured: controller model, axes with their units and limits, names, connection."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Mapping
from fractions import Fraction
from functools import lru_cache
from typing import Any

from codegen import conversion
from codegen.conversion import CALIBRATED_US, Sent
from codegen.fields import AXES, Context, Dimension, Number, Text, fields_of, is_shown, value
from codegen.models import MODELS, Model
from codegen.numbers import parse_number, plain
from codegen.setup_axis import (
    ENCODER_WORDS,
    MOTOR_WORDS,
    SYMBOLS,
    Axis,
    EncoderType,
    MotorType,
    Unit,
    ratio_of,
)
from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.nodes import Broken
from codegen.twoletter.parse import parse

__all__ = [
    "ENCODER_WORDS",
    "MOTOR_WORDS",
    "SYMBOLS",
    "Axis",
    "EncoderType",
    "Finding",
    "MotorType",
    "Setup",
    "Unit",
    "never_set_up",
    "ratio_of",
    "setup_problems",
    "setup_values",
]


@dc.dataclass(frozen=True, kw_only=True)
class Setup:
    """One machine: what a technician enters once and every program uses."""

    name: str = value(Text(label="Machine", required=False, help="A name for this machine."), "")
    model: str = value(Text(label="Controller", help="The type of the controller."), "ssc4")
    axes: tuple[Axis, Axis, Axis, Axis] = (Axis(), Axis(), Axis(), Axis())
    input_names: tuple[str, ...] = ("",) * 8
    output_names: tuple[str, ...] = ("",) * 8
    sample_us: str = value(
        Number(label="Loop rate", low=250, high=20000, suffix="µs", literal=True, help="Period of the control loop."),
        "1000",
    )
    address: str = ""
    baud: str = ""
    serial_number: str = ""
    plate: str = ""  # what the type plate says: `SSC47`, or the part number
    notes: str = value(Text(label="Notes", required=False, lines=True, help="Anything worth knowing."), "")

    def __hash__(self) -> int:
        known: int | None = self.__dict__.get("_known_hash")
        if known is None:
            known = hash(tuple(getattr(self, field.name) for field in dc.fields(self)))
            object.__setattr__(self, "_known_hash", known)
        return known

    def __getstate__(self) -> dict[str, Any]:
        return {name: kept for name, kept in self.__dict__.items() if name != "_known_hash"}

    # ---------------------------------------------------------- the controller

    @property
    def limits(self) -> Model:
        """What the controller model can do."""
        return MODELS[self.model]

    @property
    def letters(self) -> str:
        """The axes of the controller."""
        return self.limits.axes

    @property
    def inputs(self) -> int:
        return self.limits.inputs

    @property
    def outputs(self) -> int:
        return self.limits.outputs

    def axis(self, letter: str) -> Axis:
        """The axis of that letter (also one the controller has not)."""
        return self.axes[AXES.index(letter)]

    def with_axis(self, letter: str, axis: Axis) -> Setup:
        """A setup with one axis replaced."""
        x, y, z, w = (axis if each == letter else old for each, old in zip(AXES, self.axes, strict=True))
        return dc.replace(self, axes=(x, y, z, w))

    def is_command(self, name: str) -> bool:
        """Whether two letters are a command of the controller."""
        return name in COMMANDS

    def code_problem(self, text: str) -> str | None:
        """What is wrong with two-letter code, in one sentence."""
        return _code_problem(text, self.model)

    # ------------------------------------------------------------ names of I/O

    def input_number(self, text: str) -> int | None:
        return _channel(text, self.input_names)

    def output_number(self, text: str) -> int | None:
        return _channel(text, self.output_names)

    @staticmethod
    def channel_text(text: str, names: tuple[str, ...], number: int | None) -> str:
        """An input or output as the sentence says it: its number, with its name where it has one."""
        if number is None or not 1 <= number <= len(names) or not names[number - 1]:
            return text
        return f"{number} ({names[number - 1]})"

    # -------------------------------------------------------------- conversion

    @property
    def sample(self) -> Fraction:
        """The loop rate in µs."""
        return abs(parse_number(self.sample_us) or Fraction(CALIBRATED_US))

    def converts(self, dimension: Dimension) -> bool:
        """Whether values of this dimension are converted before they are sent."""
        return dimension not in (Dimension.VOLTS, Dimension.NUMBER)

    def factor(self, dimension: Dimension, letter: str) -> Fraction:
        """What a value in the user's unit is multiplied with to get what the controller counts."""
        return conversion.factor(self, dimension, letter)

    def counts(self, dimension: Dimension, letter: str, number: Fraction) -> int:
        """A value as it is sent: rounded to the controller's resolution, never above a maximum."""
        return conversion.sent(self, dimension, letter, number).counts

    def sent(self, dimension: Dimension, letter: str, number: Fraction) -> Sent:
        """As `counts`, and whether rounding changed the value by more than 0.1 %."""
        return conversion.sent(self, dimension, letter, number)

    def from_counts(self, dimension: Dimension, letter: str, counts: int | Fraction) -> Fraction:
        """What a sent value means in the user's unit."""
        return Fraction(counts) / self.factor(dimension, letter)

    def bounds(self, dimension: Dimension, letter: str) -> tuple[Fraction, Fraction]:
        """Lowest and highest value in the user's unit that axis and controller allow."""
        return conversion.bounds(self, dimension, letter)

    def unit_text(self, dimension: Dimension, letter: str) -> str:
        """The unit of a dimension: `in`, `in/s`, `ms`."""
        match dimension:
            case Dimension.TIME:
                return "ms"
            case Dimension.VOLTS:
                return "V"
            case Dimension.NUMBER:
                return ""
            case Dimension.SPEED:
                return f"{self._symbol(letter)}/s"
            case Dimension.ACCELERATION:
                return f"{self._symbol(letter)}/s²"
            case _:
                return self._symbol(letter)

    def _symbol(self, letter: str) -> str:
        """Of an axis the controller lacks nothing is known."""
        return self.axis(letter).symbol if letter and letter in self.letters else "units"


def _channel(text: str, names: tuple[str, ...]) -> int | None:
    number = parse_number(text)
    if number is not None:
        return int(number) if number.denominator == 1 else None
    return next((place + 1 for place, name in enumerate(names) if name and name == text.strip()), None)


@lru_cache(maxsize=2048)
def _code_problem(text: str, model: str) -> str | None:
    limits = MODELS[model]
    lines = text.split("\n")
    for number, line in enumerate(lines):
        where = f"line {number + 1}: " if len(lines) > 1 else ""
        if len(line) > limits.columns:
            return f"{where}longer than the {limits.columns} characters of this controller"
        if not line.isascii() or not line.isprintable():
            return f"{where}the controller knows plain characters only"
    for number, statement in parse(text).statements():
        if isinstance(statement, Broken):
            where = f"line {number + 1}: " if len(lines) > 1 else ""
            return f"{where}{statement.rule}: {statement.text.strip()}"
    return None


@dc.dataclass(frozen=True, slots=True)
class Finding:
    """Something to put right: which field, one sentence, and how bad it is ("error" or "warning").

    `rule` names what was found where that is more than a wrong field, as the rules of the source checker do.
    """

    field: str
    message: str
    severity: str = "error"
    axis: str = ""
    step: str = ""
    rule: str = ""

    @property
    def code(self) -> str:
        """What to look it up by."""
        return self.rule or self.field or "step"


@lru_cache(maxsize=64)
def setup_problems(setup: Setup) -> tuple[Finding, ...]:
    """What is wrong or unfinished in a setup."""
    if setup.model not in MODELS:
        return (Finding("model", f"Controller: there is no model '{setup.model}'"),)
    found: list[Finding] = []
    rate = fields_of(setup)["sample_us"].problem(setup.sample_us, Context(setup))
    if rate:
        found.append(Finding("sample_us", rate))
    for letter in setup.letters:
        found += _axis_problems(setup, letter)
    for names, field in ((setup.input_names, "input_names"), (setup.output_names, "output_names")):
        given = [name for name in names if name]
        for name in dict.fromkeys(name for name in given if given.count(name) > 1):
            found.append(Finding(field, f"The name '{name}' is used twice"))
        found += [Finding(field, f"The name '{name}' is a number") for name in given if parse_number(name) is not None]
    return tuple(found)


def _axis_problems(setup: Setup, letter: str) -> list[Finding]:
    axis = setup.axis(letter)
    found: list[Finding] = []
    for name, field in fields_of(axis).items():
        problem = field.problem(getattr(axis, name), Context(setup, letter)) if is_shown(axis, name) else None
        if problem:
            found.append(Finding(name, f"Axis {letter}: {problem}", "error", letter))
    if not axis.is_set_up:
        found.append(Finding("counts_per_unit", never_set_up(setup, letter), "warning", letter))
    low, high = parse_number(axis.reverse_limit), parse_number(axis.forward_limit)
    if low is not None and high is not None and low >= high:
        text = f"Axis {letter}: the reverse limit {plain(low)} must lie below the forward limit {plain(high)}"
        found.append(Finding("forward_limit", text, "error", letter))
    return found


def never_set_up(setup: Setup, letter: str) -> str:
    """The sentence for a scale nobody entered."""
    return f"Axis {letter}: the scale was never set up (1 count is taken as 1 {setup.axis(letter).symbol})"


def setup_values(setup: Setup) -> Mapping[str, Any]:
    """All values of a setup by name, for files."""
    return {field.name: getattr(setup, field.name) for field in dc.fields(setup)}
