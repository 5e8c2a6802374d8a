"""The group Configuration: what is wired to the controller, and where positions begin."""

# ruff: noqa: RUF009  (value() declares a field as dataclasses.field does)

from __future__ import annotations

import dataclasses as dc
from enum import StrEnum

from codegen.fields import NONE, AxisSet, Choice, Dimension, Flag, Number, PerAxis, PerAxisText, Quantity, value
from codegen.instructions.instruction import Group, Instruction
from codegen.setup import ENCODER_WORDS, MOTOR_WORDS, EncoderType, MotorType

ON_OFF = Flag(label="On", phrase="on", off_phrase="off")


@dc.dataclass(frozen=True, kw_only=True)
class AnalogFeedback(Instruction):
    """Takes the position of an axis from an analog input."""

    title = "Analog Feedback"
    group = Group.CONFIGURATION
    section = "C"
    sentence = "Analog feedback: {axes}"
    help = (
        "Takes the position of an axis from its analog input instead of the encoder: X uses input 1, Y 2, Z 3, W 4; "
        "10 V are 2047 counts, -10 V are -2048. Send it before the motor is switched on."
    )

    axes: PerAxisText = value(
        PerAxis(label="Analog", of=ON_OFF, servo_only=True, help="On: analog input. Off: encoder."), NONE
    )

    @classmethod
    def example(cls) -> AnalogFeedback:
        return cls(axes=("on", "", "", ""))


@dc.dataclass(frozen=True, kw_only=True)
class ArmLatch(Instruction):
    """Waits for an edge that captures the position."""

    title = "Arm Latch"
    group = Group.CONFIGURATION
    section = "C"
    sentence = "Arm the position latch of {axes}"
    help = (
        "The next edge on input 1 (X), 2 (Y), 3 (Z) or 4 (W) captures the position within 25 µs, once. Read it with "
        "_RLX in an equation, and arm the latch again for the next one."
    )

    axes: str = value(AxisSet(label="Axes", help="The axes whose position is captured."), "X")

    @classmethod
    def example(cls) -> ArmLatch:
        return cls(axes="XY")


class Register(StrEnum):
    MAIN = "main"
    AUXILIARY = "auxiliary"


@dc.dataclass(frozen=True, kw_only=True)
class DefinePosition(Instruction):
    """Says where an axis is."""

    title = "Define Position"
    group = Group.CONFIGURATION
    section = "C"
    sentence = "The present {register} position is {position}"
    help = "Sets the present position, or that of the auxiliary encoder, to a value; nothing moves."

    register: Register = value(
        Choice(
            label="Encoder",
            kind=Register,
            words={Register.MAIN: "Main encoder", Register.AUXILIARY: "Auxiliary encoder"},
            phrases={Register.MAIN: "main encoder", Register.AUXILIARY: "auxiliary encoder"},
            help="The main encoder (and the commanded position), or the auxiliary one.",
        ),
        Register.MAIN,
    )
    position: PerAxisText = value(
        PerAxis(
            label="Position",
            of=Quantity(label="Position", dimension=Dimension.POSITION),
            help="What the present position is called from now on.",
        ),
        NONE,
    )

    @classmethod
    def example(cls) -> DefinePosition:
        return cls(position=("0", "", "", ""))


class Power(StrEnum):
    ENABLE = "enable"
    DISABLE = "disable"


@dc.dataclass(frozen=True, kw_only=True)
class Drive(Instruction):
    """Switches motors on or off."""

    title = "Drive"
    group = Group.CONFIGURATION
    section = "C/M"
    sentence = "{power} the drive of {axes}"
    help = (
        "Enable: the commanded position becomes the present one and the motor holds it. Disable: the motor is switched "
        "off, the position is still counted; a vertical axis may fall."
    )

    power: Power = value(
        Choice(
            label="Do",
            kind=Power,
            words={Power.ENABLE: "Enable", Power.DISABLE: "Disable"},
            help="Switch the motors on or off.",
        ),
        Power.ENABLE,
    )
    axes: str = value(AxisSet(label="Axes", help="The axes that are switched."), "X")

    @classmethod
    def example(cls) -> Drive:
        return cls(axes="XY")


@dc.dataclass(frozen=True, kw_only=True)
class Encoder(Instruction):
    """The kind of encoder of each axis."""

    title = "Encoder"
    group = Group.CONFIGURATION
    section = "C"
    sentence = "Encoders: [main {main}[; auxiliary {auxiliary}]|auxiliary {auxiliary}|…]"
    help = "Sets the kind of each encoder; what is left empty is taken from the machine's setup."

    main: PerAxisText = value(
        PerAxis(
            label="Main",
            of=Choice(label="Main", kind=EncoderType, words=ENCODER_WORDS),
            required=False,
            help="The encoder the loop is closed on.",
        ),
        NONE,
    )
    auxiliary: PerAxisText = value(
        PerAxis(
            label="Auxiliary",
            of=Choice(label="Auxiliary", kind=EncoderType, words=ENCODER_WORDS),
            required=False,
            help="The second encoder.",
        ),
        NONE,
    )

    def own_problem(self) -> tuple[str, str] | None:
        return ("main", "Choose an encoder for an axis") if self.main == self.auxiliary == NONE else None

    @classmethod
    def example(cls) -> Encoder:
        return cls(main=("quadrature_reversed", "", "", ""), auxiliary=("pulse", "", "", ""))


@dc.dataclass(frozen=True, kw_only=True)
class Motor(Instruction):
    """The kind of motor of each axis."""

    title = "Motor"
    group = Group.CONFIGURATION
    section = "C"
    sentence = "Motors: [{types}[; off at first: {off}]|off at first: {off}|…]"
    help = "Sets the kind of motor and its polarity, and which motors are off at first."

    types: PerAxisText = value(
        PerAxis(
            label="Type",
            of=Choice(label="Type", kind=MotorType, words=MOTOR_WORDS),
            required=False,
            help="Servo or stepper, and its polarity. Set it with the motor off.",
        ),
        NONE,
    )
    off: str = value(
        AxisSet(label="Off at first", required=False, help="Motors that stay off until Drive enables them."), ""
    )

    def own_problem(self) -> tuple[str, str] | None:
        return ("types", "Choose a type of motor for an axis") if self.types == NONE and not self.off else None

    @classmethod
    def example(cls) -> Motor:
        return cls(types=("servo_reversed", "", "", ""), off="X")


@dc.dataclass(frozen=True, kw_only=True)
class PositionFormat(Instruction):
    """How the controller shows positions."""

    title = "Position Format"
    group = Group.CONFIGURATION
    section = "C"
    sentence = "Show positions with {digits} digits and {decimals} decimals[, {hexadecimal}], {leading_zeros}"
    help = "Sets how positions are shown when the controller is asked for them; it changes no position."

    digits: str = value(
        Number(
            label="Digits", low=0, high=10, whole=True, literal=True, help="Before the point (hexadecimal: 1 to 8)."
        ),
        "10",
    )
    decimals: str = value(
        Number(label="Decimals", low=0, high=4, whole=True, literal=True, help="After the point."), "0"
    )
    hexadecimal: bool = value(Flag(label="Hexadecimal", phrase="hexadecimal", help="Show them in hexadecimal."), False)
    leading_zeros: bool = value(
        Flag(
            label="Leading zeros",
            phrase="with leading zeros",
            off_phrase="without leading zeros",
            help="Fill up with zeros in front.",
        ),
        True,
    )

    def own_problem(self) -> tuple[str, str] | None:
        if self.hexadecimal and self.digits.strip() in ("0", "9", "10"):
            return "digits", "Digits must lie between 1 and 8 for hexadecimal numbers"
        return None

    @classmethod
    def example(cls) -> PositionFormat:
        return cls(digits="6")


class Burned(StrEnum):
    PARAMETERS = "parameters"
    VARIABLES = "variables"


@dc.dataclass(frozen=True, kw_only=True)
class WriteEeprom(Instruction):
    """Keeps parameters or variables without power."""

    title = "Write to EEPROM"
    group = Group.CONFIGURATION
    section = "C/M"
    sentence = "Write the {what} to the EEPROM"
    help = (
        "Keeps the controller's parameters (about 250 ms) or the variables (up to 2 s) when it is switched off. It "
        "must not be interrupted. The program itself is kept by Burn, not by this."
    )

    what: Burned = value(
        Choice(
            label="What",
            kind=Burned,
            words={Burned.PARAMETERS: "parameters", Burned.VARIABLES: "variables"},
            help="Parameters such as speeds and gains, or the values of variables.",
        ),
        Burned.PARAMETERS,
    )

    @classmethod
    def example(cls) -> WriteEeprom:
        return cls()


class Polarity(StrEnum):
    LOW = "low"
    HIGH = "high"


POLARITY_WORDS = {Polarity.LOW: "active low", Polarity.HIGH: "active high"}


@dc.dataclass(frozen=True, kw_only=True)
class DedicatedInputs(Instruction):
    """At which level limit, home and latch inputs act."""

    title = "Dedicated Inputs"
    group = Group.IO
    section = "C"
    sentence = "Limit inputs {limit}, home inputs {home}, latch inputs {latch}"
    help = (
        "Sets the level at which limit, home and latch inputs act. Another home level turns the first homing direction "
        "round."
    )

    limit: Polarity = value(
        Choice(label="Limit", kind=Polarity, words=POLARITY_WORDS, help="Level of the limit inputs."), Polarity.LOW
    )
    home: Polarity = value(
        Choice(label="Home", kind=Polarity, words=POLARITY_WORDS, help="Level of the home inputs."), Polarity.LOW
    )
    latch: Polarity = value(
        Choice(label="Latch", kind=Polarity, words=POLARITY_WORDS, help="Edge of the latch inputs."), Polarity.LOW
    )

    @classmethod
    def example(cls) -> DedicatedInputs:
        return cls(home=Polarity.HIGH)
