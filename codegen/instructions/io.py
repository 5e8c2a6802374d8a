"""The group I/O."""

# ruff: noqa: RUF009  (value() declares a field as dataclasses.field does)

from __future__ import annotations

import dataclasses as dc
from enum import StrEnum

from codegen.fields import Choice, Condition, Number, OutputNumber, value
from codegen.instructions.instruction import Group, Instruction


class OutputMode(StrEnum):
    CHANNEL = "channel"
    CONDITION = "condition"
    PORT = "port"


class Level(StrEnum):
    ON = "on"
    OFF = "off"


_ONE = (OutputMode.CHANNEL, OutputMode.CONDITION)


@dc.dataclass(frozen=True, kw_only=True)
class Output(Instruction):
    """Switches one output, or all of them at once."""

    title = "Output"
    group = Group.IO
    sentence = (
        "[Turn output {output} {level}|Turn output {output} on when {condition}, else off"
        "|Send {byte} to the output port]"
    )
    help = "Switches one output on or off, or by a condition, or sets all outputs at once (output 1 is the lowest bit)."

    mode: OutputMode = value(
        Choice(
            label="What",
            kind=OutputMode,
            words={
                OutputMode.CHANNEL: "One output",
                OutputMode.CONDITION: "One output by a condition",
                OutputMode.PORT: "All outputs",
            },
            help="One output, one output that follows a condition, or all outputs.",
        ),
        OutputMode.CHANNEL,
    )
    output: str = value(
        OutputNumber(label="Output", when={"mode": _ONE}, help="Its number, or its name in the setup."), "1"
    )
    level: Level = value(
        Choice(
            label="State",
            kind=Level,
            words={Level.ON: "on", Level.OFF: "off"},
            when={"mode": OutputMode.CHANNEL},
            help="On or off.",
        ),
        Level.ON,
    )
    condition: str = value(
        Condition(label="Condition", when={"mode": OutputMode.CONDITION}, help="The output is on when this is not 0."),
        "",
    )
    byte: str = value(
        Number(
            label="Value",
            low=0,
            high=255,
            whole=True,
            when={"mode": OutputMode.PORT},
            help="0 to 255: the sum of 1 for output 1, 2 for output 2, 4 for output 3 …",
        ),
        "",
    )

    @classmethod
    def example(cls) -> Output:
        return cls()
