"""The group System Limits."""

# ruff: noqa: RUF009  (value() declares a field as dataclasses.field does)

from __future__ import annotations

import dataclasses as dc

from codegen.fields import NONE, Dimension, Flag, Limit, Number, PerAxis, PerAxisText, Quantity, value
from codegen.instructions.instruction import Group, Instruction
from codegen.instructions.machine import ON_OFF


@dc.dataclass(frozen=True, kw_only=True)
class FollowingError(Instruction):
    """How far the load may lag behind."""

    title = "Following Error"
    group = Group.LIMITS
    section = "C/M"
    sentence = "Allow a following error of {error}"
    help = (
        "The largest distance between commanded and actual position. Beyond it the error output acts, the position "
        "error subroutine is called, and the motor goes off where that is switched on."
    )

    error: PerAxisText = value(
        PerAxis(
            label="Error",
            of=Quantity(label="Error", dimension=Dimension.ERROR, positive=True),
            servo_only=True,
            help="Largest following error.",
        ),
        NONE,
    )

    @classmethod
    def example(cls) -> FollowingError:
        return cls(error=("0.25", "", "", ""))


@dc.dataclass(frozen=True, kw_only=True)
class Integrator(Instruction):
    """How strong the integrator may become."""

    title = "Integrator"
    group = Group.LIMITS
    section = "C/M"
    sentence = "Limit the integrator to {limit}[, {freeze}]"
    help = "Limits the voltage of the integrator; it can be frozen while the axis moves."

    limit: PerAxisText = value(
        PerAxis(
            label="Limit",
            of=Number(label="Limit", low=0, high=9.9982, suffix="V", literal=True),
            servo_only=True,
            help="Largest voltage of the integrator.",
        ),
        NONE,
    )
    freeze: bool = value(
        Flag(
            label="Freeze while moving", phrase="frozen while moving", help="Keep the integrator still during a move."
        ),
        False,
    )

    @classmethod
    def example(cls) -> Integrator:
        return cls(limit=("5", "", "", ""))


@dc.dataclass(frozen=True, kw_only=True)
class MotorDisable(Instruction):
    """Whether an error switches the motor off."""

    title = "Motor Disable Upon Error"
    group = Group.LIMITS
    section = "C/M"
    sentence = "Motor off on error: {axes}"
    help = (
        "On: too large a following error, an abort instruction or the abort input switches the motor off. In "
        "coordinated motion all axes of the path stop."
    )

    axes: PerAxisText = value(
        PerAxis(label="Off on error", of=ON_OFF, servo_only=True, help="Whether the motor is switched off."), NONE
    )

    @classmethod
    def example(cls) -> MotorDisable:
        return cls(axes=("on", "", "", ""))


@dc.dataclass(frozen=True, kw_only=True)
class PositionLimits(Instruction):
    """How far the axes may go."""

    title = "Position"
    group = Group.LIMITS
    section = "C/M"
    sentence = "Position limits: [forward {forward}[; reverse {reverse}]|reverse {reverse}|…]"
    help = "Sets how far the axes may go. Motion beyond slows down to a stop. Write off to switch a limit off."

    forward: PerAxisText = value(
        PerAxis(
            label="Forward",
            of=Limit(label="Forward", dimension=Dimension.DISTANCE),
            required=False,
            help="Furthest position forward, or off.",
        ),
        NONE,
    )
    reverse: PerAxisText = value(
        PerAxis(
            label="Reverse",
            of=Limit(label="Reverse", dimension=Dimension.DISTANCE),
            required=False,
            help="Furthest position backward, or off.",
        ),
        NONE,
    )

    def own_problem(self) -> tuple[str, str] | None:
        return ("forward", "Enter a limit for an axis") if self.forward == self.reverse == NONE else None

    @classmethod
    def example(cls) -> PositionLimits:
        return cls(forward=("10", "", "", ""), reverse=("off", "", "", ""))


@dc.dataclass(frozen=True, kw_only=True)
class TorqueLimit(Instruction):
    """How strong the motor command may become."""

    title = "Torque"
    group = Group.LIMITS
    section = "C/M"
    sentence = "Limit the motor command to {limit}"
    help = (
        "Limits the voltage of the motor command: 5 V of a drive with 10 V full scale are half of its torque or speed."
    )

    limit: PerAxisText = value(
        PerAxis(
            label="Limit",
            of=Number(label="Limit", low=0, high=9.9982, suffix="V", literal=True),
            servo_only=True,
            help="Largest motor command.",
        ),
        NONE,
    )

    @classmethod
    def example(cls) -> TorqueLimit:
        return cls(limit=("5", "", "", ""))
