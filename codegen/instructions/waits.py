"""The instruction Wait For Condition with its five kinds."""

# ruff: noqa: RUF009  (value() declares a field as dataclasses.field does)

from __future__ import annotations

import dataclasses as dc
from enum import StrEnum

from codegen.fields import AxisName, AxisSet, Choice, Dimension, InputNumber, Quantity, value
from codegen.instructions.flow import LEVEL_WORDS, InputLevel, samples_note
from codegen.instructions.instruction import Group, Instruction
from codegen.setup import Setup


class WaitKind(StrEnum):
    POSITION = "position"
    SPEED = "speed"
    CLOCK = "clock"
    MOTION = "motion"
    INPUT = "input"


class Place(StrEnum):
    PASSED = "passed"
    FORWARD = "forward"
    REVERSE = "reverse"
    START = "start"
    LAST = "last"
    PATH = "path"


class Moving(StrEnum):
    AXES = "axes"
    PATH = "path"


class Clock(StrEnum):
    NOW = "now"
    AFTER = "after"
    AGAIN = "again"


class Finished(StrEnum):
    PROFILE = "profile"
    POSITION = "position"


_POSITION = {"kind": WaitKind.POSITION}
_ABSOLUTE = (Place.PASSED, Place.FORWARD, Place.REVERSE)


@dc.dataclass(frozen=True, kw_only=True)
class WaitForCondition(Instruction):
    """Holds the program until something has happened."""

    title = "Wait For Condition"
    group = Group.FLOW
    sentence = (
        "[Wait until {axis} {place} {position}|Wait until {axis} has gone {distance} {place}"
        "|Wait until the path has gone {path} {place}"
        "|Wait until {speed_axis} is at speed|Wait until the clock shows {time}[, {clock}]|{clock}"
        "|Wait until the motion of {axes} {finished}, at most {time_out}|Wait until the motion of {axes} {finished}"
        "|Wait until {moving} {finished}|Wait until {moving} is at speed|Wait until all motion {finished}"
        "|Wait until input {input} is {level}]"
    )
    help = "Holds the program until a position, a speed, a time, the end of a motion, or an input has come."

    kind: WaitKind = value(
        Choice(
            label="Wait for",
            kind=WaitKind,
            words={
                WaitKind.POSITION: "Position",
                WaitKind.SPEED: "Speed",
                WaitKind.CLOCK: "Clock",
                WaitKind.MOTION: "End of motion",
                WaitKind.INPUT: "Input",
            },
            help="What the program waits for.",
        ),
        WaitKind.MOTION,
    )
    place: Place = value(
        Choice(
            label="Position",
            kind=Place,
            words={
                Place.PASSED: "Passes a position, in either direction",
                Place.FORWARD: "Passes a position going forward",
                Place.REVERSE: "Passes a position going backward",
                Place.START: "Distance from the start of the move",
                Place.LAST: "Distance from the last such wait",
                Place.PATH: "Distance along the path",
            },
            phrases={
                Place.PASSED: "passes",
                Place.FORWARD: "has gone forward to",
                Place.REVERSE: "has gone backward to",
                Place.START: "from the start of the move",
                Place.LAST: "from the last distance wait",
                Place.PATH: "since the start or the last such wait",
            },
            when=_POSITION,
            help="A position passed by the encoder, or a distance of the commanded move.",
        ),
        Place.PASSED,
    )
    axis: str = value(
        AxisName(
            label="Axis",
            when={"kind": WaitKind.POSITION, "place": (*_ABSOLUTE, Place.START, Place.LAST, Place.PATH)},
            help="The axis (for a path: the one whose unit the distance has).",
        ),
        "X",
    )
    position: str = value(
        Quantity(
            label="Position",
            dimension=Dimension.POSITION,
            when={"kind": WaitKind.POSITION, "place": _ABSOLUTE},
            help="The position, measured from home.",
        ),
        "",
    )
    distance: str = value(
        Quantity(
            label="Distance",
            dimension=Dimension.DISTANCE,
            when={"kind": WaitKind.POSITION, "place": (Place.START, Place.LAST)},
            help="The distance gone.",
        ),
        "",
    )
    path: str = value(
        Quantity(
            label="Distance",
            dimension=Dimension.DISTANCE,
            positive=True,
            when={"kind": WaitKind.POSITION, "place": Place.PATH},
            help="The distance gone along the path.",
        ),
        "",
    )
    moving: Moving = value(
        Choice(
            label="Of",
            kind=Moving,
            words={Moving.AXES: "Axes", Moving.PATH: "The path"},
            phrases={Moving.AXES: "", Moving.PATH: "the path"},
            when={"kind": (WaitKind.SPEED, WaitKind.MOTION)},
            help="Single axes, or the coordinated path.",
        ),
        Moving.AXES,
    )
    speed_axis: str = value(
        AxisName(
            label="Axis",
            when={"kind": WaitKind.SPEED, "moving": Moving.AXES},
            help="The axis whose profile reaches its speed.",
        ),
        "X",
    )
    clock: Clock = value(
        Choice(
            label="Clock",
            kind=Clock,
            words={
                Clock.NOW: "Start the clock now",
                Clock.AFTER: "Wait until a time after the start",
                Clock.AGAIN: "Wait until then, and start again",
            },
            phrases={
                Clock.NOW: "Start the clock",
                Clock.AFTER: "",
                Clock.AGAIN: "then start it again",
            },
            when={"kind": WaitKind.CLOCK},
            help="Times are counted from the moment the clock was started.",
        ),
        Clock.NOW,
    )
    time: str = value(
        Quantity(
            label="Time",
            dimension=Dimension.TIME,
            axis="",
            positive=True,
            when={"kind": WaitKind.CLOCK, "clock": (Clock.AFTER, Clock.AGAIN)},
            help="The time since the clock was started.",
        ),
        "",
    )
    axes: str = value(
        AxisSet(
            label="Axes",
            required=False,
            when={"kind": WaitKind.MOTION, "moving": Moving.AXES},
            help="The axes; none means all of them.",
        ),
        "X",
    )
    finished: Finished = value(
        Choice(
            label="Until",
            kind=Finished,
            words={Finished.PROFILE: "The profile has ended", Finished.POSITION: "In position"},
            phrases={Finished.PROFILE: "has ended", Finished.POSITION: "is in position"},
            when={"kind": WaitKind.MOTION},
            help="The commanded move is over, or the encoder has arrived too.",
        ),
        Finished.PROFILE,
    )
    time_out: str = value(
        Quantity(
            label="At most",
            dimension=Dimension.TIME,
            most_counts=32767,
            axis="",
            literal=True,
            required=False,
            when={"kind": WaitKind.MOTION, "moving": Moving.AXES, "finished": Finished.POSITION},
            help="Longest time to wait after the profile has ended; empty keeps the present one.",
        ),
        "",
    )
    input: str = value(
        InputNumber(label="Input", when={"kind": WaitKind.INPUT}, help="Its number, or its name in the setup."), "1"
    )
    level: InputLevel = value(
        Choice(label="Is", kind=InputLevel, words=LEVEL_WORDS, when={"kind": WaitKind.INPUT}, help="High or low."),
        InputLevel.HIGH,
    )

    def samples_note(self, setup: Setup) -> str:
        """What a time of the clock really is."""
        return samples_note(self.time, setup) if self.kind is WaitKind.CLOCK and self.clock is not Clock.NOW else ""

    def own_problem(self) -> tuple[str, str] | None:
        if self.kind is WaitKind.MOTION and self.moving is Moving.PATH and self.finished is Finished.POSITION:
            return "finished", "Until: a path can only be waited for until its profile has ended"
        if (
            self.kind is WaitKind.MOTION
            and self.time_out.strip()
            and not self.axes
            and self.finished is Finished.POSITION
        ):
            return "time_out", "At most: name the axes that have this time"
        return None

    @classmethod
    def example(cls) -> WaitForCondition:
        return cls(kind=WaitKind.INPUT)
