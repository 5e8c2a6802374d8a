"""The group Program Flow."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from codegen.expressions import Bad, Negative, parse_expression, write
from codegen.fields import Dimension, value_of
from codegen.instructions.flow import (
    End,
    EndOf,
    InputLevel,
    Jump,
    JumpIf,
    JumpKind,
    Label,
    Repeat,
    RepeatMode,
    Subroutine,
    Wait,
)
from codegen.instructions.motion import WaitFor
from codegen.instructions.waits import Clock, Finished, Moving, Place, WaitForCondition, WaitKind
from codegen.twoletter.calls import BODY, Assign, Mark, Statement, Value, by_axis, for_axes, numbers, simple, target
from codegen.twoletter.emit.build import Build, is_false, raw
from codegen.twoletter.emit.motion import wait_for
from codegen.units import in_counts

PASSING = {Place.PASSED: "AP", Place.FORWARD: "MF", Place.REVERSE: "MR"}


def label(label: Label, build: Build) -> Iterator[Statement]:
    yield Mark(label.name)


def wait(wait: Wait, build: Build) -> Iterator[Statement]:
    """A number of samples."""
    samples = wait.samples(build.setup)
    if samples is not None:
        yield numbers("WT", samples)
        return
    factor = build.setup.factor(Dimension.TIME, "") * (Fraction(1024, 1000) if wait.exactly else 1)
    tree = parse_expression(wait.time)
    assert not isinstance(tree, Bad), "only correct instructions are emitted"
    yield numbers("WT", write(in_counts(tree, factor, lambda operand: None)))


def jump(jump: Jump, build: Build) -> Iterator[Statement]:
    """To a label or a subroutine, with its condition."""
    name = "JP" if jump.kind is JumpKind.GO else "JS"
    match jump.when:
        case JumpIf.ALWAYS:
            yield target(name, jump.target)
        case JumpIf.INPUT:
            level = 1 if jump.level is InputLevel.HIGH else 0
            yield target(name, jump.target, f"@IN[{build.setup.input_number(jump.input)}]={level}")
        case JumpIf.CONDITION:
            yield target(name, jump.target, raw(jump.condition))


def repeat(repeat: Repeat, build: Build) -> Iterator[Statement]:
    """A loop: a counter or a condition, and a jump back."""
    start, counter = build.loop()
    match repeat.mode:
        case RepeatMode.COUNT if isinstance(value_of(repeat.count), Fraction):
            yield Assign(counter, raw(repeat.count))
            yield Mark(start)
            yield BODY
            yield Assign(counter, f"{counter}-1")
            yield target("JP", start, f"{counter}>0")
        case RepeatMode.COUNT:
            finish, _ = build.loop()
            yield Assign(counter, raw(repeat.count))
            yield Mark(start)
            yield target("JP", finish, f"{counter}<=0")
            yield BODY
            yield Assign(counter, f"{counter}-1")
            yield target("JP", start)
            yield Mark(finish)
        case RepeatMode.UNTIL:
            yield Mark(start)
            yield BODY
            yield target("JP", start, is_false(repeat.until))
        case RepeatMode.WHILE:
            finish, _ = build.loop()
            yield Mark(start)
            yield target("JP", finish, is_false(repeat.condition))
            yield BODY
            yield target("JP", start)
            yield Mark(finish)
        case RepeatMode.FOREVER:
            yield Mark(start)
            yield BODY
            yield target("JP", start)


def subroutine(subroutine: Subroutine, build: Build) -> Iterator[Statement]:
    yield Mark(subroutine.label)
    yield BODY


def end(end: End, build: Build) -> Iterator[Statement]:
    """Each kind of subroutine has its own end."""
    match end.of:
        case EndOf.SUBROUTINE:
            yield simple("EN")
        case EndOf.ERROR:
            yield numbers("RE", int(end.keep))
        case EndOf.INPUT:
            yield numbers("RI", int(end.keep))
        case EndOf.COMMUNICATION:
            yield numbers("EN", int(end.keep), int(end.restore))


def wait_for_condition(wait: WaitForCondition, build: Build) -> Iterator[Statement]:
    """One trippoint."""
    match wait.kind:
        case WaitKind.POSITION:
            yield _position(wait, build)
        case WaitKind.SPEED:
            yield for_axes("AS", "S" if wait.moving is Moving.PATH else wait.speed_axis)
        case WaitKind.CLOCK:
            yield _clock(wait, build)
        case WaitKind.MOTION:
            axes = "S" if wait.moving is Moving.PATH else wait.axes
            until = WaitFor.PROFILE if wait.finished is Finished.PROFILE else WaitFor.POSITION
            yield from wait_for(until, axes, wait.time_out, build)
        case WaitKind.INPUT:
            number = build.setup.input_number(wait.input) or 0
            yield numbers("AI", number if wait.level is InputLevel.HIGH else -number)


def _position(wait: WaitForCondition, build: Build) -> Statement:
    match wait.place:
        case Place.PASSED | Place.FORWARD | Place.REVERSE:
            position = build.value(wait.position, Dimension.POSITION, wait.axis)
            return by_axis(PASSING[wait.place], {wait.axis: position})
        case Place.START:
            distance = build.value(wait.distance, Dimension.DISTANCE, wait.axis)
            return by_axis("AD", {wait.axis: distance if isinstance(distance, str) else _size(distance)})
        case Place.LAST:
            return by_axis("AR", {wait.axis: build.value(wait.distance, Dimension.DISTANCE, wait.axis)})
        case Place.PATH:
            return numbers("AV", build.value(wait.path, Dimension.DISTANCE, wait.axis))


def _size(value: int | Fraction) -> Value:
    return -value if value < 0 else value


def _clock(wait: WaitForCondition, build: Build) -> Statement:
    if wait.clock is Clock.NOW:
        return numbers("AT", 0)
    time = build.value(wait.time, Dimension.TIME, "")
    if wait.clock is Clock.AFTER:
        return numbers("AT", time)
    if not isinstance(time, str):
        return numbers("AT", -time)
    tree = parse_expression(time)
    assert not isinstance(tree, Bad), "what was written can be read"
    return numbers("AT", write(Negative(tree)))
