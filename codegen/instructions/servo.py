"""The group Servo Settings."""

# ruff: noqa: RUF009  (value() declares a field as dataclasses.field does)

from __future__ import annotations

import dataclasses as dc

from codegen.fields import NONE, Flag, Number, PerAxis, PerAxisText, value
from codegen.instructions.instruction import Group, Instruction
from codegen.instructions.machine import ON_OFF


@dc.dataclass(frozen=True, kw_only=True)
class LoopRate(Instruction):
    """The period of the control loop."""

    title = "Loop Rate"
    group = Group.SERVO
    section = "C"
    sentence = "Run the control loop every {period}[, {external}]"
    help = (
        "Sets the period of the control loop. Speeds, accelerations and waits of the whole program are sent rescaled, "
        "so that they stay true; gains have to be tuned again."
    )

    period: str = value(
        Number(
            label="Period",
            low=250,
            high=20000,
            suffix="µs",
            step="125",
            literal=True,
            help="Microseconds; the shortest depends on the number of axes.",
        ),
        "1000",
    )
    external: bool = value(
        Flag(
            label="External clock",
            phrase="from an external clock",
            help="An external signal gives the beat instead of the controller.",
        ),
        False,
    )

    @classmethod
    def example(cls) -> LoopRate:
        return cls(period="500")


def _gain(label: str, high: float, step: str, help: str) -> PerAxis:
    gain = Number(label=label, low=0, high=high, step=step)
    return PerAxis(label=label, of=gain, servo_only=True, required=False, help=help)


@dc.dataclass(frozen=True, kw_only=True)
class DualLoop(Instruction):
    """Damping from the auxiliary encoder."""

    title = "Dual Loop"
    group = Group.SERVO
    section = "C/M"
    sentence = "Dual loop: {axes}"
    help = (
        "On: damping works on the auxiliary encoder, for machines with backlash between the motor and the main encoder."
    )

    axes: PerAxisText = value(
        PerAxis(label="Dual loop", of=ON_OFF, servo_only=True, help="On: damping from the auxiliary encoder."), NONE
    )

    @classmethod
    def example(cls) -> DualLoop:
        return cls(axes=("on", "", "", ""))


@dc.dataclass(frozen=True, kw_only=True)
class FeedForward(Instruction):
    """Help for the loop while the axis moves."""

    title = "Feed Forward"
    group = Group.SERVO
    section = "C/M"
    sentence = "Feed forward: [velocity {velocity}[; acceleration {acceleration}]|acceleration {acceleration}|…]"
    help = "Adds a voltage in proportion to the commanded speed and acceleration, so that the load lags less."

    velocity: PerAxisText = value(_gain("Velocity", 8191, "1", "Voltage in proportion to the speed."), NONE)
    acceleration: PerAxisText = value(
        _gain("Acceleration", 8191, "0.25", "Voltage in proportion to the acceleration."), NONE
    )

    def own_problem(self) -> tuple[str, str] | None:
        return ("velocity", "Enter a gain for an axis") if self.velocity == self.acceleration == NONE else None

    @classmethod
    def example(cls) -> FeedForward:
        return cls(velocity=("10", "", "", ""))


@dc.dataclass(frozen=True, kw_only=True)
class Offset(Instruction):
    """A steady voltage for the motor."""

    title = "Offset"
    group = Group.SERVO
    section = "C/M"
    sentence = "Offset of the motor command {offset}"
    help = "Adds a steady voltage to the motor command, against gravity or an offset of the drive."

    offset: PerAxisText = value(
        PerAxis(
            label="Offset",
            of=Number(label="Offset", low=-9.9982, high=9.9982, suffix="V"),
            servo_only=True,
            help="Voltage that is added.",
        ),
        NONE,
    )

    @classmethod
    def example(cls) -> Offset:
        return cls(offset=("0.5", "", "", ""))


@dc.dataclass(frozen=True, kw_only=True)
class PidGains(Instruction):
    """The gains of the control loop."""

    title = "PID Gains"
    group = Group.SERVO
    section = "C/M"
    sentence = (
        "PID gains: [proportional {proportional}[; integral {integral}][; derivative {derivative}]"
        "|integral {integral}[; derivative {derivative}]|derivative {derivative}|…]"
    )
    help = "Sets stiffness (proportional), the cure of a lasting error (integral) and damping (derivative) of the loop."

    proportional: PerAxisText = value(_gain("Proportional", 1023.875, "0.125", "Stiffness of the loop."), NONE)
    integral: PerAxisText = value(_gain("Integral", 2047.875, "0.0078125", "Removes a lasting error."), NONE)
    derivative: PerAxisText = value(_gain("Derivative", 4095.875, "0.125", "Damping of the loop."), NONE)

    def own_problem(self) -> tuple[str, str] | None:
        none = self.proportional == self.integral == self.derivative == NONE
        return ("proportional", "Enter a gain for an axis") if none else None

    @classmethod
    def example(cls) -> PidGains:
        return cls(proportional=("20", "", "", ""), derivative=("100", "", "", ""))
