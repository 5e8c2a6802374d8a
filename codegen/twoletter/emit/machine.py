"""Settings of motors, encoders, loops and limits."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from math import ceil, floor

from codegen.conversion import LARGEST
from codegen.fields import AXES, OFF, Dimension, PerAxisText, value_of
from codegen.instructions.limits import FollowingError, Integrator, MotorDisable, PositionLimits, TorqueLimit
from codegen.instructions.machine import (
    AnalogFeedback,
    ArmLatch,
    Burned,
    DedicatedInputs,
    DefinePosition,
    Drive,
    Encoder,
    Motor,
    Polarity,
    PositionFormat,
    Power,
    Register,
    WriteEeprom,
)
from codegen.instructions.servo import DualLoop, FeedForward, Offset, PidGains
from codegen.numbers import decimal, parse_number
from codegen.setup import EncoderType, MotorType
from codegen.twoletter.calls import Statement, Value, by_axis, for_axes, numbers, simple
from codegen.twoletter.emit.build import Build, raw

MAIN_CODES = {
    EncoderType.QUADRATURE: 0,
    EncoderType.PULSE: 1,
    EncoderType.QUADRATURE_REVERSED: 2,
    EncoderType.PULSE_REVERSED: 3,
}
AUXILIARY_STEP = 4  # the code of the auxiliary encoder counts in steps of 4
MOTOR_CODES = {
    MotorType.SERVO: Fraction(1),
    MotorType.SERVO_REVERSED: Fraction(-1),
    MotorType.STEPPER_LOW: Fraction(2),
    MotorType.STEPPER_HIGH: Fraction(-2),
    MotorType.STEPPER_LOW_REVERSED: Fraction(5, 2),
    MotorType.STEPPER_HIGH_REVERSED: Fraction(-5, 2),
}


def _given(texts: PerAxisText) -> Iterator[tuple[str, str]]:
    return ((letter, text.strip()) for letter, text in zip(AXES, texts, strict=True) if text.strip())


def _switches(name: str, texts: PerAxisText) -> Statement:
    return by_axis(name, {letter: int(text == "on") for letter, text in _given(texts)})


def _plain(name: str, texts: PerAxisText, places: int = 4) -> Iterator[Statement]:
    """Numbers without a unit of the axis; nothing when none is given."""
    values: dict[str, Value] = {}
    for letter, text in _given(texts):
        number = value_of(text)
        values[letter] = Fraction(decimal(number, places)) if isinstance(number, Fraction) else raw(text)
    if values:
        yield by_axis(name, values)


def analog_feedback(feedback: AnalogFeedback, build: Build) -> Iterator[Statement]:
    yield _switches("AF", feedback.axes)


def arm_latch(latch: ArmLatch, build: Build) -> Iterator[Statement]:
    yield for_axes("AL", latch.axes)


def define_position(define: DefinePosition, build: Build) -> Iterator[Statement]:
    name = "DP" if define.register is Register.MAIN else "DE"
    yield by_axis(name, build.by_axis(define.position, Dimension.POSITION))


def drive(drive: Drive, build: Build) -> Iterator[Statement]:
    yield for_axes("SH" if drive.power is Power.ENABLE else "MO", drive.axes)


def encoder(encoder: Encoder, build: Build) -> Iterator[Statement]:
    """Both kinds in one code; what is not given comes from the setup."""
    codes: dict[str, Value] = {}
    for letter, main, auxiliary in zip(AXES, encoder.main, encoder.auxiliary, strict=True):
        if main or auxiliary:
            axis = build.setup.axis(letter)
            first, second = EncoderType(main or axis.main_encoder), EncoderType(auxiliary or axis.aux_encoder)
            codes[letter] = MAIN_CODES[first] + AUXILIARY_STEP * MAIN_CODES[second]
    yield by_axis("CE", codes)


def motor(motor: Motor, build: Build) -> Iterator[Statement]:
    types: dict[str, Value] = {letter: MOTOR_CODES[MotorType(text)] for letter, text in _given(motor.types)}
    if types:
        yield by_axis("MT", types)
    if motor.off:
        yield for_axes("MO", motor.off)


def position_format(shape: PositionFormat, build: Build) -> Iterator[Statement]:
    """The controller's switch removes the zeros: 1 is without."""
    digits = int(parse_number(shape.digits) or 0) * (-1 if shape.hexadecimal else 1)
    yield numbers("PF", f"{digits}.{raw(shape.decimals)}")
    yield numbers("LZ", int(not shape.leading_zeros))


def write_eeprom(burn: WriteEeprom, build: Build) -> Iterator[Statement]:
    yield simple("BN" if burn.what is Burned.PARAMETERS else "BV")


def dedicated_inputs(inputs: DedicatedInputs, build: Build) -> Iterator[Statement]:
    levels = (1 if each is Polarity.HIGH else -1 for each in (inputs.limit, inputs.home, inputs.latch))
    yield numbers("CN", *levels)


def dual_loop(loop: DualLoop, build: Build) -> Iterator[Statement]:
    yield _switches("DV", loop.axes)


def feed_forward(gains: FeedForward, build: Build) -> Iterator[Statement]:
    yield from _plain("FV", gains.velocity)
    yield from _plain("FA", gains.acceleration)


def offset(offset: Offset, build: Build) -> Iterator[Statement]:
    yield from _plain("OF", offset.offset)


def pid_gains(gains: PidGains, build: Build) -> Iterator[Statement]:
    yield from _plain("KP", gains.proportional)
    yield from _plain("KI", gains.integral, 7)
    yield from _plain("KD", gains.derivative)


def following_error(limit: FollowingError, build: Build) -> Iterator[Statement]:
    yield by_axis("ER", build.by_axis(limit.error, Dimension.ERROR))


def integrator(limit: Integrator, build: Build) -> Iterator[Statement]:
    """A negative limit freezes the integrator during a move."""
    sign = "-" if limit.freeze else ""
    x, y, z, w = (sign + text.strip() if text.strip() else "" for text in limit.limit)
    yield from _plain("IL", (x, y, z, w))


def motor_disable(disable: MotorDisable, build: Build) -> Iterator[Statement]:
    yield _switches("OE", disable.axes)


def position_limits(limits: PositionLimits, build: Build) -> Iterator[Statement]:
    """Rounded inwards, so that no count lies beyond; the widest values switch a limit off."""
    for name, texts, off in (("FL", limits.forward, LARGEST), ("BL", limits.reverse, -LARGEST - 1)):
        counts: dict[str, Value] = {}
        for letter, text in _given(texts):
            if text.lower() == OFF:
                counts[letter] = off
            else:
                exact = (parse_number(text) or Fraction(0)) * build.setup.axis(letter).scale
                counts[letter] = floor(exact) if name == "FL" else ceil(exact)
        if counts:
            yield by_axis(name, counts)


def torque_limit(limit: TorqueLimit, build: Build) -> Iterator[Statement]:
    yield from _plain("TL", limit.limit)
