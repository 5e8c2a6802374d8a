"""One axis of a machine: unit and scale, motor and encoders, gains and limits; ranges come from the command table."""

# ruff: noqa: RUF009  (value() declares a field as dataclasses.field does)

from __future__ import annotations

import dataclasses as dc
from enum import StrEnum
from fractions import Fraction
from math import ceil, floor
from typing import Any, ClassVar

from codegen.conversion import LARGEST
from codegen.fields import Choice, Context, Counts, Dimension, Flag, Limit, Number, Quantity, Smoothing, Text, value
from codegen.numbers import parse_number, plain
from codegen.twoletter.commands import COMMANDS


class Unit(StrEnum):
    """Units of length or angle a machine can be set up in."""

    INCH = "inch"
    FOOT = "foot"
    MM = "mm"
    CM = "cm"
    METRE = "m"
    DEGREE = "degree"
    COUNT = "count"
    OWN = "own"


SYMBOLS = {Unit.INCH: "in", Unit.FOOT: "ft", Unit.MM: "mm", Unit.CM: "cm", Unit.METRE: "m", Unit.DEGREE: "deg",
           Unit.COUNT: "counts"}  # fmt: skip
UNIT_WORDS = {unit: str(unit) for unit in Unit} | {Unit.OWN: "own unit"}


class MotorType(StrEnum):
    SERVO = "servo"
    SERVO_REVERSED = "servo_reversed"
    STEPPER_LOW = "stepper_low"
    STEPPER_HIGH = "stepper_high"
    STEPPER_LOW_REVERSED = "stepper_low_reversed"
    STEPPER_HIGH_REVERSED = "stepper_high_reversed"


class EncoderType(StrEnum):
    QUADRATURE = "quadrature"
    QUADRATURE_REVERSED = "quadrature_reversed"
    PULSE = "pulse"
    PULSE_REVERSED = "pulse_reversed"


MOTOR_WORDS = {
    MotorType.SERVO: "Servo",
    MotorType.SERVO_REVERSED: "Servo, reversed",
    MotorType.STEPPER_LOW: "Stepper, active low",
    MotorType.STEPPER_HIGH: "Stepper, active high",
    MotorType.STEPPER_LOW_REVERSED: "Stepper, active low, reversed",
    MotorType.STEPPER_HIGH_REVERSED: "Stepper, active high, reversed",
}
ENCODER_WORDS = {
    EncoderType.QUADRATURE: "Quadrature",
    EncoderType.QUADRATURE_REVERSED: "Quadrature, reversed",
    EncoderType.PULSE: "Pulse and direction",
    EncoderType.PULSE_REVERSED: "Pulse and direction, reversed",
}


def ratio_of(text: str) -> Fraction | None:
    """A number, or an exact quotient of two: `16000/3`; None when it is neither."""
    above, slash, below = text.partition("/")
    number, by = parse_number(above), parse_number(below) if slash else Fraction(1)
    return None if number is None or not by else number / by


@dc.dataclass(frozen=True, kw_only=True)
class Travel(Limit):
    """A software limit of the travel, sent rounded inwards."""

    forward: bool = True
    required: bool = False

    def counts(self, value: str, context: Context) -> Counts | None:
        number = parse_number(value)
        if number is None:
            return None
        exact = number * context.setup.axis(context.axis).scale
        return Counts(f"{floor(exact) if self.forward else ceil(exact)} counts")


@dc.dataclass(frozen=True, kw_only=True)
class Amount(Quantity):
    """A plain number in the unit of the axis; what is left empty stays as the controller has it."""

    literal: bool = True
    positive: bool = True
    required: bool = False


@dc.dataclass(frozen=True, kw_only=True)
class Ratio(Number):
    """Counts in one unit: a number above 0, or an exact quotient."""

    literal: bool = True
    required: bool = False
    warns: ClassVar[bool] = False

    def wrong(self, value: str, context: Context) -> str | None:
        number = ratio_of(value)
        return super().wrong(value if number is None else plain(number), context)

    def text(self, value: str, context: Context) -> str:
        return value.strip()


def _register(name: str, label: str, help: str, **more: Any) -> Number:
    """A number that goes into a register as it is: range and resolution of the command."""
    row = COMMANDS[name]
    low, high = float(row.low or 0), float(row.high or 0)
    step = str(Fraction(row.step or 0)) if row.step and row.unit != "V" else ""
    suffix = "V" if row.unit == "V" else ""
    return Number(
        label=label, help=help, low=low, high=high, step=step, suffix=suffix, literal=True, required=False, **more
    )


@dc.dataclass(frozen=True, kw_only=True)
class Axis:
    """Numbers are kept as typed; empty is "as the controller has it"."""

    unit: Unit = value(
        Choice(label="Unit", kind=Unit, words=UNIT_WORDS, help="The unit of positions and distances."), Unit.INCH
    )
    unit_name: str = value(
        Text(label="Own unit", most=12, when={"unit": Unit.OWN}, help="The name of your own unit, for example turns."),
        "",
    )
    counts_per_unit: str = value(
        Ratio(
            label="Counts per unit",
            help="Encoder counts (or steps) in one unit of travel; a quotient such as 16000/3 is kept exact.",
            low=0.000001,
            high=LARGEST,
        ),
        "",
    )
    motor: MotorType = value(
        Choice(label="Motor", kind=MotorType, words=MOTOR_WORDS, help="The kind of motor."), MotorType.SERVO
    )
    main_encoder: EncoderType = value(
        Choice(label="Main encoder", kind=EncoderType, words=ENCODER_WORDS, help="The encoder the loop is closed on."),
        EncoderType.QUADRATURE,
    )
    aux_encoder: EncoderType = value(
        Choice(label="Auxiliary encoder", kind=EncoderType, words=ENCODER_WORDS, help="The second encoder, if any."),
        EncoderType.QUADRATURE,
    )
    kp: str = value(_register("KP", "Proportional gain", "Stiffness of the loop."), "")
    ki: str = value(_register("KI", "Integral gain", "Removes a lasting error."), "")
    kd: str = value(_register("KD", "Derivative gain", "Damping of the loop."), "")
    fv: str = value(_register("FV", "Velocity feed-forward", "Volts in proportion to the speed."), "")
    fa: str = value(_register("FA", "Acceleration feed-forward", "Volts in proportion to the acceleration."), "")
    smoothing: str = value(
        Smoothing(label="Smoothing", help="Servo: 0 (none) to 255 (most). Stepper: 0.5 to 8, at first 2."), ""
    )
    forward_limit: str = value(
        Travel(
            label="Forward limit",
            dimension=Dimension.POSITION,
            help="Furthest position forward; off switches the limit off.",
        ),
        "",
    )
    reverse_limit: str = value(
        Travel(
            label="Reverse limit",
            dimension=Dimension.POSITION,
            forward=False,
            help="Furthest position backward; off switches the limit off.",
        ),
        "",
    )
    error_limit: str = value(
        Amount(label="Following error", dimension=Dimension.ERROR, help="Largest following error allowed."), ""
    )
    off_on_error: bool = value(
        Flag(label="Motor off on error", help="Switch the motor off when the following error is too large."), True
    )
    torque_limit: str = value(_register("TL", "Torque limit", "Largest motor command."), "")
    integrator_limit: str = value(
        _register("IL", "Integrator limit", "Largest integrator output; negative freezes it during moves."), ""
    )
    offset: str = value(_register("OF", "Offset", "Voltage added to the motor command."), "")
    mirrored: bool = value(
        Flag(label="Drawn the other way", help="Pictures of paths show this axis pointing left or down."), False
    )
    maximum_speed: str = value(
        Amount(label="Top speed", dimension=Dimension.SPEED, help="Fastest speed allowed; empty: the controller's."), ""
    )
    maximum_acceleration: str = value(
        Amount(
            label="Top acceleration",
            dimension=Dimension.ACCELERATION,
            help="Hardest acceleration and deceleration allowed; empty: the controller's.",
        ),
        "",
    )

    @property
    def scale(self) -> Fraction:
        """Counts in one unit; 1 when it was never set up, and where the unit is the count."""
        number = Fraction(1) if self.unit is Unit.COUNT else ratio_of(self.counts_per_unit)
        return number if number is not None and number > 0 else Fraction(1)

    @property
    def scale_problem(self) -> str | None:
        """Why the scale cannot be used; nothing may be converted with it then."""
        number = ratio_of(self.counts_per_unit)
        usable = not self.counts_per_unit.strip() or (number is not None and number > 0)
        return None if usable else "the counts per unit in the setup are no number above 0"

    @property
    def is_set_up(self) -> bool:
        """Whether somebody entered the scale (an axis in counts needs none)."""
        return self.unit is Unit.COUNT or self.counts_per_unit.strip() != ""

    @property
    def is_stepper(self) -> bool:
        return self.motor not in (MotorType.SERVO, MotorType.SERVO_REVERSED)

    @property
    def symbol(self) -> str:
        """The unit as it stands behind a number."""
        return SYMBOLS.get(self.unit) or self.unit_name or "units"
