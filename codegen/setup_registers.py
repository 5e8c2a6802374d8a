"""Which registers of a controller the setup of an axis holds: what it states, and what a reading means for it.

Values count 1/65536, as the controller holds them. The order is that of sending: what the motor is, then what
protects it, then how it moves.
"""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Callable, Iterator, Mapping
from fractions import Fraction
from math import ceil, floor
from typing import Any, Literal

from codegen.conversion import LARGEST
from codegen.fields import OFF, Dimension
from codegen.numbers import decimal, parse_number, plain
from codegen.setup import Axis, EncoderType, MotorType, Setup
from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.emit.machine import AUXILIARY_STEP, MAIN_CODES, MOTOR_CODES
from codegen.twoletter.emit.motion import smoothing_ratio
from codegen.twoletter.fixed import ONE, scaled

Value = int  # in 1/65536
SMOOTH = 256  # steps of the smoothing filter
SHORT = 10**7  # a decimal of so many places is shown exact
PLACES = 16  # decimals after which every number of a controller has ended
Stated = Callable[[Setup, str], Fraction | None]
Told = Callable[[Setup, str, Fraction], dict[str, Any]]


@dc.dataclass(frozen=True, slots=True)
class Register:
    """One register: the fields of an axis that it holds, on which motors it counts, what sending it may do.

    A ceiling states the most: a controller's value below it is as right as the same value.
    """

    command: str
    fields: tuple[str, ...]
    stated: Stated
    told: Told
    caution: str = ""  # "{axis} may …"
    motor_off: bool = False  # may only be sent with the motor off
    drives: Literal["any", "servo", "stepper"] = "any"
    ceiling: bool = False
    protects: bool = False  # one of the System Limits (ssc-tol-o-motion.txt), or a maximum

    @property
    def title(self) -> str:
        return COMMANDS[self.command].title

    def counts_for(self, axis: Axis) -> bool:
        """Whether it means something for the motor of that axis."""
        return self.drives == "any" or axis.is_stepper == (self.drives == "stepper")

    def wanted(self, setup: Setup, letter: str) -> Value | None:
        """What the setup states, as the register keeps it; None where it states nothing."""
        if not self.counts_for(setup.axis(letter)):
            return None
        number = self.stated(setup, letter)
        return None if number is None else COMMANDS[self.command].stored(scaled(number))

    def same(self, wanted: Value, found: Value) -> bool:
        """Whether a reading is what was wanted, to the resolution of the register."""
        grain = max(int(Fraction(COMMANDS[self.command].step or 0) * ONE), 1)
        return abs(wanted - found) < grain or (self.ceiling and found < wanted)

    def taken(self, setup: Setup, letter: str, found: Value) -> Setup:
        """The setup with the controller's value of this register."""
        values = self.told(setup, letter, Fraction(found, ONE))
        return setup.with_axis(letter, dc.replace(setup.axis(letter), **values))


def factory(command: str) -> Value:
    """What the register holds after a master reset."""
    default = COMMANDS[command].default
    assert not isinstance(default, str)
    return COMMANDS[command].stored(scaled(default or 0))


def shortest(number: Fraction, fits: Callable[[Fraction], bool]) -> str:
    """The decimal with the fewest places that stands for the same thing; exact where one ends soon."""
    if SHORT % number.denominator == 0 and fits(number):
        return plain(number)
    return next((text for text in _nearby(number) if fits(Fraction(text))), decimal(number, PLACES))


def _nearby(number: Fraction) -> Iterator[str]:
    """Decimals of more and more places: the nearest one, and the next one away from zero (registers cut)."""
    sign = -1 if number < 0 else 1
    for places in range(PLACES + 1):
        yield decimal(number, places)
        yield decimal(sign * Fraction(ceil(abs(number) * 10**places), 10**places), places)


def _number(name: str, places: int = 4) -> Stated:
    """A number that is sent as it is, with the places the emitter writes."""

    def stated(setup: Setup, letter: str) -> Fraction | None:
        number = parse_number(getattr(setup.axis(letter), name))
        return None if number is None else Fraction(decimal(number, places))

    return stated


def _plain(command: str, name: str, places: int = 4) -> tuple[Stated, Told]:
    """A register that holds the number of a field."""
    row = COMMANDS[command]

    def told(setup: Setup, letter: str, found: Fraction) -> dict[str, Any]:
        kept = row.stored(scaled(found))
        return {name: shortest(found, lambda each: row.stored(scaled(Fraction(decimal(each, places)))) == kept)}

    return _number(name, places), told


def _travel(name: str, off: int, rounded: Callable[[Fraction], int]) -> tuple[Stated, Told]:
    """A software limit: in units, or off."""

    def stated(setup: Setup, letter: str) -> Fraction | None:
        text = getattr(setup.axis(letter), name).strip()
        if text.lower() == OFF:
            return Fraction(off)
        number = parse_number(text)
        return None if number is None else Fraction(rounded(number * setup.axis(letter).scale))

    def told(setup: Setup, letter: str, found: Fraction) -> dict[str, Any]:
        scale = setup.axis(letter).scale
        text = OFF if found == off else shortest(found / scale, lambda each: rounded(each * scale) == found)
        return {name: text}

    return stated, told


def _measured(name: str, dimension: Dimension) -> tuple[Stated, Told]:
    """A value in the unit of the axis, converted as the emitter converts it."""

    def stated(setup: Setup, letter: str) -> Fraction | None:
        number = parse_number(getattr(setup.axis(letter), name))
        return None if number is None else Fraction(setup.counts(dimension, letter, number))

    def told(setup: Setup, letter: str, found: Fraction) -> dict[str, Any]:
        units = setup.from_counts(dimension, letter, found)
        return {name: shortest(units, lambda each: setup.counts(dimension, letter, each) == found)}

    return stated, told


def _motor_stated(setup: Setup, letter: str) -> Fraction:
    return MOTOR_CODES[setup.axis(letter).motor]


def _motor_told(setup: Setup, letter: str, found: Fraction) -> dict[str, Any]:
    kinds: Mapping[Fraction, MotorType] = {code: kind for kind, code in MOTOR_CODES.items()}
    return {"motor": kinds.get(found, setup.axis(letter).motor)}


def _encoder_stated(setup: Setup, letter: str) -> Fraction:
    axis = setup.axis(letter)
    return Fraction(MAIN_CODES[axis.main_encoder] + AUXILIARY_STEP * MAIN_CODES[axis.aux_encoder])


def _encoder_told(setup: Setup, letter: str, found: Fraction) -> dict[str, Any]:
    kinds: Mapping[int, EncoderType] = {code: kind for kind, code in MAIN_CODES.items()}
    auxiliary, main = divmod(int(found), AUXILIARY_STEP)
    axis = setup.axis(letter)
    return {
        "main_encoder": kinds.get(main, axis.main_encoder),
        "aux_encoder": kinds.get(auxiliary, axis.aux_encoder),
    }


def _off_stated(setup: Setup, letter: str) -> Fraction:
    return Fraction(int(setup.axis(letter).off_on_error))


def _off_told(setup: Setup, letter: str, found: Fraction) -> dict[str, Any]:
    return {"off_on_error": found != 0}


def _smooth_stated(setup: Setup, letter: str) -> Fraction | None:
    text = setup.axis(letter).smoothing
    return None if parse_number(text) is None else smoothing_ratio(text)


def _smooth_told(setup: Setup, letter: str, found: Fraction) -> dict[str, Any]:
    return {"smoothing": str(SMOOTH - max(round(found * SMOOTH), 1))}


def _ceiling(name: str, dimension: Dimension) -> tuple[Stated, Told]:
    """Never more than the setup's maximum; what the controller holds does not change the setup."""
    stated, _ = _measured(name, dimension)
    return stated, lambda setup, letter, found: {}


RUNS_AWAY = "{axis} may run away when its motor is switched on again: try it with a low torque limit first"
OSCILLATES = "{axis} may jump or begin to oscillate while its motor is on"
MAY_STOP = "the motor of {axis} goes off when its following error is larger than this; a vertical axis may fall"
SINKS = "{axis} has less force from now on; a vertical axis may sink"

REGISTERS: tuple[Register, ...] = (
    Register("MT", ("motor",), _motor_stated, _motor_told, RUNS_AWAY, motor_off=True),
    Register("CE", ("main_encoder", "aux_encoder"), _encoder_stated, _encoder_told, RUNS_AWAY, motor_off=True),
    Register(
        "ER", ("error_limit",), *_measured("error_limit", Dimension.ERROR), MAY_STOP, drives="servo", protects=True
    ),
    Register("OE", ("off_on_error",), _off_stated, _off_told, MAY_STOP, drives="servo", protects=True),
    Register("TL", ("torque_limit",), *_plain("TL", "torque_limit"), SINKS, drives="servo", protects=True),
    Register("FL", ("forward_limit",), *_travel("forward_limit", LARGEST, floor), protects=True),
    Register("BL", ("reverse_limit",), *_travel("reverse_limit", -LARGEST - 1, ceil), protects=True),
    Register("IL", ("integrator_limit",), *_plain("IL", "integrator_limit"), SINKS, drives="servo", protects=True),
    Register("KP", ("kp",), *_plain("KP", "kp"), OSCILLATES, drives="servo"),
    Register("KI", ("ki",), *_plain("KI", "ki", 7), OSCILLATES, drives="servo"),
    Register("KD", ("kd",), *_plain("KD", "kd"), OSCILLATES, drives="servo"),
    Register("FV", ("fv",), *_plain("FV", "fv"), OSCILLATES, drives="servo"),
    Register("FA", ("fa",), *_plain("FA", "fa"), OSCILLATES, drives="servo"),
    Register("OF", ("offset",), *_plain("OF", "offset"), OSCILLATES, drives="servo"),
    Register("IT", ("smoothing",), _smooth_stated, _smooth_told, drives="servo"),
    Register("KS", ("smoothing",), *_plain("KS", "smoothing"), drives="stepper"),
    Register("SP", ("maximum_speed",), *_ceiling("maximum_speed", Dimension.SPEED), ceiling=True, protects=True),
    Register(
        "AC",
        ("maximum_acceleration",),
        *_ceiling("maximum_acceleration", Dimension.ACCELERATION),
        ceiling=True,
        protects=True,
    ),
    Register(
        "DC",
        ("maximum_acceleration",),
        *_ceiling("maximum_acceleration", Dimension.ACCELERATION),
        ceiling=True,
        protects=True,
    ),
)
BY_COMMAND: Mapping[str, Register] = {each.command: each for each in REGISTERS}
OF_FIELD: Mapping[str, tuple[Register, ...]] = {
    name: tuple(each for each in REGISTERS if name in each.fields)
    for name in dict.fromkeys(name for each in REGISTERS for name in each.fields)
}
GAIN = "GN"  # read only: ssc-tol-o-motion.txt l.1584, "not used for current version of controller"


def limit_registers() -> tuple[Register, ...]:
    """What protects the machine: travel, following error, force, top speed and acceleration."""
    return tuple(each for each in REGISTERS if each.protects)
