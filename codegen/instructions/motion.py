"""The group Motion."""

# ruff: noqa: RUF009  (value() declares a field as dataclasses.field does)

from __future__ import annotations

import dataclasses as dc
from enum import StrEnum

from codegen.fields import (
    NONE,
    AxisName,
    AxisSet,
    Choice,
    Dimension,
    Flag,
    PerAxis,
    PerAxisText,
    Quantity,
    Smoothing,
    value,
)
from codegen.instructions.configuration import ACCELERATION, DECELERATION, SPEED
from codegen.instructions.instruction import Group, Instruction
from codegen.numbers import parse_number
from codegen.setup import Setup


class MoveMode(StrEnum):
    BY = "by"
    TO = "to"
    AT = "at"


class WaitFor(StrEnum):
    NOTHING = "nothing"
    PROFILE = "profile"
    POSITION = "position"


WAIT_WORDS = {
    WaitFor.NOTHING: "Go on at once",
    WaitFor.PROFILE: "Wait until the profile has ended",
    WaitFor.POSITION: "Wait until in position",
}
WAIT_PHRASES = {
    WaitFor.NOTHING: "",
    WaitFor.PROFILE: "wait until the profile has ended",
    WaitFor.POSITION: "wait until in position",
}
_POSITIONING = {"mode": (MoveMode.BY, MoveMode.TO)}


@dc.dataclass(frozen=True, kw_only=True)
class SingleAxisMove(Instruction):
    """Moves one axis by a distance, to a position, or at a speed."""

    title = "Single Axis Move"
    group = Group.MOTION
    sentence = (
        "[Move {axis} by {distance}|Move {axis} to {position}|Run {axis} at {jog_speed}][ at {speed}]"
        "[, accelerating at {acceleration}][, decelerating at {deceleration}][, smoothing {smoothing}]"
        "[, {begin}][, then {wait}, at most {time_out}|, then {wait}]"
    )
    help = (
        "Moves one axis by a distance, to a position measured from home, or at a speed until it is stopped. "
        "The profile has ended when the commanded position has arrived; the load may still follow by a little."
    )

    axis: str = value(AxisName(label="Axis", help="The axis that moves."), "X")
    mode: MoveMode = value(
        Choice(
            label="Move",
            kind=MoveMode,
            words={MoveMode.BY: "By a distance", MoveMode.TO: "To a position", MoveMode.AT: "At a speed"},
            help="By a distance, to a position, or at a speed without an end.",
        ),
        MoveMode.BY,
    )
    distance: str = value(
        Quantity(
            label="Distance",
            dimension=Dimension.DISTANCE,
            when={"mode": MoveMode.BY},
            help="How far; the sign gives the direction.",
        ),
        "",
    )
    position: str = value(
        Quantity(
            label="Position",
            dimension=Dimension.POSITION,
            when={"mode": MoveMode.TO},
            help="Where to, measured from home.",
        ),
        "",
    )
    jog_speed: str = value(
        Quantity(
            label="Speed",
            dimension=Dimension.SPEED,
            signed=True,
            when={"mode": MoveMode.AT},
            help="How fast; the sign gives the direction.",
        ),
        "",
    )
    speed: str = value(
        Quantity(
            label="Speed",
            dimension=Dimension.SPEED,
            positive=True,
            required=False,
            when=_POSITIONING,
            help="Top speed of the move; empty keeps the present one.",
        ),
        "",
    )
    acceleration: str = value(
        Quantity(
            label="Acceleration",
            dimension=Dimension.ACCELERATION,
            positive=True,
            required=False,
            help="How quickly it speeds up; empty keeps the present one.",
        ),
        "",
    )
    deceleration: str = value(
        Quantity(
            label="Deceleration",
            dimension=Dimension.ACCELERATION,
            positive=True,
            required=False,
            help="How quickly it slows down; empty keeps the present one.",
        ),
        "",
    )
    smoothing: str = value(
        Smoothing(
            label="Smoothing",
            help="0 (none) to 255 (most) rounds the corners of the speed profile; on a stepper 0.5 to 8.",
        ),
        "",
    )
    begin: bool = value(
        Flag(
            label="Begin now",
            off_phrase="prepared but not begun",
            help="Off: a Begin Motion starts it, together with other axes.",
        ),
        True,
    )
    wait: WaitFor = value(
        Choice(
            label="Then",
            kind=WaitFor,
            words=WAIT_WORDS,
            phrases=WAIT_PHRASES,
            when={"mode": (MoveMode.BY, MoveMode.TO), "begin": True},
            help="Hold the program until the profile has ended, or until the encoder has arrived too.",
        ),
        WaitFor.PROFILE,
    )
    time_out: str = value(
        Quantity(
            label="At most",
            dimension=Dimension.TIME,
            most_counts=32767,
            axis="",
            literal=True,
            required=False,
            when={"wait": WaitFor.POSITION},
            help="Longest time to wait after the profile has ended; empty keeps the present one.",
        ),
        "",
    )

    @classmethod
    def example(cls) -> SingleAxisMove:
        return cls(distance="4", speed="2")


@dc.dataclass(frozen=True, kw_only=True)
class MotionParameters(Instruction):
    """Speed, acceleration and deceleration of several axes."""

    title = "Motion Parameters"
    group = Group.MOTION
    sentence = (
        "[<[Set {axis} to {speed}[, acceleration {acceleration}][, deceleration {deceleration}]"
        "|Set the acceleration of {axis} to {acceleration}[, deceleration {deceleration}]"
        "|Set the deceleration of {axis} to {deceleration}]>|Set motion parameters …]"
    )
    help = "Sets speed, acceleration and deceleration for the moves that follow; empty values keep what the axis has."

    speed: PerAxisText = value(PerAxis(label="Speed", of=SPEED, required=False, help="Top speed of moves."), NONE)
    acceleration: PerAxisText = value(
        PerAxis(label="Acceleration", of=ACCELERATION, required=False, help="How quickly the axis speeds up."), NONE
    )
    deceleration: PerAxisText = value(
        PerAxis(label="Deceleration", of=DECELERATION, required=False, help="How quickly it slows down."), NONE
    )

    def own_problem(self) -> tuple[str, str] | None:
        if self.speed == NONE and self.acceleration == NONE and self.deceleration == NONE:
            return "speed", "Enter a speed, an acceleration or a deceleration for an axis"
        return None

    @classmethod
    def example(cls) -> MotionParameters:
        return cls(speed=("2", "1", "", ""), acceleration=("64", "", "", ""))


class Which(StrEnum):
    AXES = "axes"
    PATH = "path"
    MOTION = "motion"
    EVERYTHING = "everything"


class Beginning(StrEnum):
    AXES = "axes"
    PATH = "path"


@dc.dataclass(frozen=True, kw_only=True)
class BeginMotion(Instruction):
    """Starts motion that was prepared before."""

    title = "Begin Motion"
    group = Group.MOTION
    sentence = "[Begin motion of {axes}|Begin {which}]"
    help = "Starts the prepared moves of some axes at the same moment, or the prepared path."

    which: Beginning = value(
        Choice(
            label="What",
            kind=Beginning,
            words={Beginning.AXES: "Axes", Beginning.PATH: "the path"},
            help="Moves of single axes, or the coordinated path.",
        ),
        Beginning.AXES,
    )
    axes: str = value(AxisSet(label="Axes", when={"which": Beginning.AXES}, help="The axes that start together."), "X")

    @classmethod
    def example(cls) -> BeginMotion:
        return cls(axes="XY")


@dc.dataclass(frozen=True, kw_only=True)
class StopMotion(Instruction):
    """Slows motion down to a stop."""

    title = "Stop Motion"
    group = Group.MOTION
    sentence = "[Stop {axes}|Stop {which}][, then {wait}]"
    help = "Slows axes or the path down to a stop, or everything, with or without the program."

    which: Which = value(
        Choice(
            label="What",
            kind=Which,
            words={
                Which.AXES: "Axes",
                Which.PATH: "the path",
                Which.MOTION: "all motion",
                Which.EVERYTHING: "all motion and the program",
            },
            help="Which motion stops.",
        ),
        Which.AXES,
    )
    axes: str = value(AxisSet(label="Axes", when={"which": Which.AXES}, help="The axes that stop."), "X")
    wait: bool = value(
        Flag(
            label="Wait until stopped",
            phrase="wait until it has stopped",
            when={"which": (Which.AXES, Which.PATH, Which.MOTION)},
            help="Hold the program until the profile has ended.",
        ),
        True,
    )

    @classmethod
    def example(cls) -> StopMotion:
        return cls()


INDEX_SPEED = 500  # counts/s; ssc-tol-o-motion.txt, Find Index


class Homing(StrEnum):
    SWITCH = "switch"
    EDGE = "edge"
    INDEX = "index"


class Direction(StrEnum):
    FORWARD = "forward"
    REVERSE = "reverse"


@dc.dataclass(frozen=True, kw_only=True)
class Home(Instruction):
    """Looks for the home switch, its edge, or the index pulse."""

    title = "Home"
    group = Group.MOTION
    sentence = (
        "{routine} of {axes}[ going {direction}]"
        "[ (<{axis}[ at {speed}][, accelerating at {acceleration}][, decelerating at {deceleration}]>)]"
        "[, {begin}][, then {wait}]"
    )
    help = (
        "Home: finds the switch, comes back slowly, then finds the index pulse; that place becomes position 0 "
        "(a stepper stays at the switch). Edge: stops behind the edge of the switch and sets no zero. Index: stops at "
        "the index pulse, which becomes 0; 500 counts/s or less is advised, and a high deceleration."
    )

    routine: Homing = value(
        Choice(
            label="Routine",
            kind=Homing,
            words={
                Homing.SWITCH: "Find home",
                Homing.EDGE: "Find the edge of the home switch",
                Homing.INDEX: "Find the index",
            },
            help="Home switch, edge of the home switch, or index pulse.",
        ),
        Homing.SWITCH,
    )
    axes: str = value(AxisSet(label="Axes", help="The axes that look for home."), "X")
    speed: PerAxisText = value(
        PerAxis(
            label="Speed",
            of=Quantity(label="Speed", dimension=Dimension.SPEED, positive=True),
            required=False,
            help="Speed of the search; empty keeps the present one.",
        ),
        NONE,
    )
    direction: Direction = value(
        Choice(
            label="Direction",
            kind=Direction,
            words={Direction.FORWARD: "forward", Direction.REVERSE: "backward"},
            when={"routine": Homing.INDEX},
            help="Direction of the search (the other routines decide by the state of the switch).",
        ),
        Direction.FORWARD,
    )
    acceleration: PerAxisText = value(
        PerAxis(label="Acceleration", of=ACCELERATION, required=False, help="Empty keeps the present one."), NONE
    )
    deceleration: PerAxisText = value(
        PerAxis(label="Deceleration", of=DECELERATION, required=False, help="A high one is advised."), NONE
    )
    begin: bool = value(
        Flag(label="Begin now", off_phrase="prepared but not begun", help="Off: a Begin Motion starts it."), True
    )
    wait: bool = value(
        Flag(
            label="Wait until finished",
            phrase="wait until it has ended",
            when={"begin": True},
            help="Hold the program until then.",
        ),
        True,
    )

    def own_problem(self) -> tuple[str, str] | None:
        for name in ("speed", "acceleration", "deceleration"):
            given: PerAxisText = getattr(self, name)
            for letter, text in zip("XYZW", given, strict=True):
                if text and letter not in self.axes:
                    return name, f"{letter} has a {name} but is not among the axes"
        if self.routine is Homing.INDEX:
            for letter, text in zip("XYZW", self.speed, strict=True):
                if letter in self.axes and not text:
                    return "speed", f"{letter}: Speed is missing (the index search needs it for its direction)"
        return None

    def own_warning(self, setup: Setup) -> tuple[str, str] | None:
        for letter, text in zip("XYZW", self.speed, strict=True):
            number = parse_number(text)
            if self.routine is Homing.INDEX and number is not None:
                counts = setup.counts(Dimension.SPEED, letter, number)
                if counts > INDEX_SPEED:
                    return (
                        "speed",
                        f"{letter}: {counts} counts/s may run past the index; {INDEX_SPEED} or less is advised",
                    )
        return None

    @classmethod
    def example(cls) -> Home:
        return cls(speed=("1", "", "", ""), deceleration=("128", "", "", ""))
