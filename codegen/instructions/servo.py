"""The group Servo Settings."""

from __future__ import annotations

import dataclasses as dc

from codegen.fields import Flag, Number, value
from codegen.instructions.instruction import Group, Instruction


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
