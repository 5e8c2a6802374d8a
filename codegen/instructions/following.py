"""The group Motion: stopping at once, moving on, following another axis."""

# ruff: noqa: RUF009  (value() declares a field as dataclasses.field does)

from __future__ import annotations

import dataclasses as dc
from enum import StrEnum

from codegen.fields import NONE, AxisName, AxisSet, Choice, Dimension, Number, PerAxis, PerAxisText, Quantity, value
from codegen.instructions.instruction import Group, Instruction


class Aborted(StrEnum):
    EVERYTHING = "everything"
    MOTION = "motion"


@dc.dataclass(frozen=True, kw_only=True)
class AbortMotion(Instruction):
    """Stops at once."""

    title = "Abort Motion"
    group = Group.MOTION
    sentence = "Abort {what}"
    help = (
        "Stops at once, without slowing down. Motors with off-on-error are switched off: a vertical axis may fall. "
        "Stop Motion slows down first."
    )

    what: Aborted = value(
        Choice(
            label="What",
            kind=Aborted,
            words={Aborted.EVERYTHING: "motion and program", Aborted.MOTION: "motion only"},
            help="Motion and the program, or motion only.",
        ),
        Aborted.EVERYTHING,
    )

    @classmethod
    def example(cls) -> AbortMotion:
        return cls(what=Aborted.MOTION)


@dc.dataclass(frozen=True, kw_only=True)
class IncrementalPosition(Instruction):
    """Moves a target while the axis is on its way."""

    title = "Incremental Position"
    group = Group.MOTION
    sentence = "Shift the target of {distance}"
    help = (
        "Moves the target of a move on while it runs, in the same direction only. While the axis stands it is a "
        "relative move; while it runs at a speed, the position jumps by this distance at once, without a ramp."
    )

    distance: PerAxisText = value(
        PerAxis(
            label="Distance", of=Quantity(label="Distance", dimension=Dimension.DISTANCE), help="How far it is shifted."
        ),
        NONE,
    )

    @classmethod
    def example(cls) -> IncrementalPosition:
        return cls(distance=("0.5", "", "", ""))


class Master(StrEnum):
    ENCODER = "encoder"
    COMMANDED = "commanded"
    AUXILIARY = "auxiliary"
    PATH = "path"


@dc.dataclass(frozen=True, kw_only=True)
class ElectronicGearing(Instruction):
    """Makes axes follow a master."""

    title = "Electronic Gearing"
    group = Group.MOTION
    sentence = "[Gear to {master} of {axis}: {ratio}|Gear to {master}: {ratio}]"
    help = (
        "Axes follow a master at a ratio of counts per count, at once and in both directions. A limit switch or Stop "
        "ends it. There is one master at a time; a path counts as forward."
    )

    master: Master = value(
        Choice(
            label="Master",
            kind=Master,
            words={
                Master.ENCODER: "the encoder",
                Master.COMMANDED: "the commanded position",
                Master.AUXILIARY: "the auxiliary encoder",
                Master.PATH: "the path",
            },
            help="What the axes follow.",
        ),
        Master.ENCODER,
    )
    axis: str = value(
        AxisName(
            label="Of",
            when={"master": (Master.ENCODER, Master.COMMANDED, Master.AUXILIARY)},
            help="The axis whose position leads.",
        ),
        "X",
    )
    ratio: PerAxisText = value(
        PerAxis(
            label="Ratio",
            of=Number(label="Ratio", low=-127.9999, high=127.9999),
            help="Counts of this axis for one count of the master; 0 lets it go.",
        ),
        NONE,
    )

    def own_problem(self) -> tuple[str, str] | None:
        if self.master in (Master.ENCODER, Master.COMMANDED) and self.ratio["XYZW".index(self.axis)]:
            return "ratio", f"{self.axis} cannot follow itself"
        return None

    @classmethod
    def example(cls) -> ElectronicGearing:
        return cls(ratio=("", "1.5", "", ""))


@dc.dataclass(frozen=True, kw_only=True)
class DisableGearing(Instruction):
    """Lets axes go that follow a master."""

    title = "Disable Electronic Gearing"
    group = Group.MOTION
    sentence = "Let {axes} no longer follow"
    help = "Ends the gearing of some axes; they stop where they are."

    axes: str = value(AxisSet(label="Axes", help="The axes that no longer follow."), "Y")

    @classmethod
    def example(cls) -> DisableGearing:
        return cls(axes="YZ")
