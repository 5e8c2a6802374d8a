"""The group Motion, and the settings moves use."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from math import ceil

from codegen.fields import Dimension, PerAxisText
from codegen.instructions.configuration import AccelDecel
from codegen.instructions.motion import (
    BeginMotion,
    Beginning,
    Direction,
    Home,
    Homing,
    MotionParameters,
    MoveMode,
    SingleAxisMove,
    StopMotion,
    WaitFor,
    Which,
)
from codegen.numbers import parse_number
from codegen.twoletter.calls import Statement, Value, by_axis, for_axes, simple
from codegen.twoletter.emit.build import Build

SMOOTHEST = Fraction("0.004")  # dmc-1412-1414.txt, IT: 0.004 is the most smoothing
COMMANDS_OF = {Homing.SWITCH: "HM", Homing.EDGE: "FE", Homing.INDEX: "FI"}


def single_axis_move(move: SingleAxisMove, build: Build) -> Iterator[Statement]:
    """Target, speed, ramps, begin, wait: in this order."""
    yield by_axis(*_target(move, build))
    if move.speed.strip() and move.mode is not MoveMode.AT:
        yield by_axis("SP", {move.axis: build.value(move.speed, Dimension.SPEED, move.axis)})
    if move.acceleration.strip():
        yield by_axis("AC", {move.axis: build.value(move.acceleration, Dimension.ACCELERATION, move.axis)})
    if move.deceleration.strip():
        yield by_axis("DC", {move.axis: build.value(move.deceleration, Dimension.ACCELERATION, move.axis)})
    if move.smoothing.strip():
        yield smoothing(move.axis, move.smoothing, build)
    if not move.begin:
        return
    yield for_axes("BG", move.axis)
    if move.mode is not MoveMode.AT:
        yield from wait_for(move.wait, move.axis, move.time_out, build)


def _target(move: SingleAxisMove, build: Build) -> tuple[str, dict[str, Value]]:
    match move.mode:
        case MoveMode.BY:
            return "PR", {move.axis: build.value(move.distance, Dimension.DISTANCE, move.axis)}
        case MoveMode.TO:
            return "PA", {move.axis: build.value(move.position, Dimension.POSITION, move.axis)}
        case MoveMode.AT:
            return "JG", {move.axis: build.value(move.jog_speed, Dimension.SPEED, move.axis)}


def smoothing(axis: str, text: str, build: Build) -> Statement:
    """Smoothing 0 … 255 as the filter of a servo axis; a stepper has its own, 0.5 … 8."""
    amount = parse_number(text) or Fraction(0)
    if build.setup.axis(axis).is_stepper:
        return by_axis("KS", {axis: amount})
    return by_axis("IT", {axis: smoothing_ratio(text)})


def smoothing_ratio(text: str) -> Fraction:
    """Smoothing 0 … 255 as IT and VT take it, 1 … 0.004."""
    amount = parse_number(text) or Fraction(0)
    # the controller rounds down to 1/256 (commands.md, IT), so the four decimals are rounded up
    return max(Fraction(ceil((256 - amount) / 256 * 10_000), 10_000), SMOOTHEST)


def wait_for(wait: WaitFor, axes: str, time_out: str, build: Build) -> Iterator[Statement]:
    """Wait for the end of the profile, or until in position."""
    if wait is WaitFor.PROFILE:
        yield for_axes("AM", axes)
    elif wait is WaitFor.POSITION:
        if time_out.strip():
            samples = build.value(time_out, Dimension.TIME, "")
            yield by_axis("TW", dict.fromkeys(axes, samples))
        yield for_axes("MC", axes)


def _ramps(acceleration: PerAxisText, deceleration: PerAxisText, build: Build) -> Iterator[Statement]:
    for name, texts in (("AC", acceleration), ("DC", deceleration)):
        if values := build.by_axis(texts, Dimension.ACCELERATION):
            yield by_axis(name, values)


def accel_decel(ramps: AccelDecel, build: Build) -> Iterator[Statement]:
    """Both ramps, all axes of one kind in one line."""
    yield from _ramps(ramps.acceleration, ramps.deceleration, build)


def motion_parameters(parameters: MotionParameters, build: Build) -> Iterator[Statement]:
    """Speeds, then ramps."""
    if speeds := build.by_axis(parameters.speed, Dimension.SPEED):
        yield by_axis("SP", speeds)
    yield from _ramps(parameters.acceleration, parameters.deceleration, build)


def begin_motion(begin: BeginMotion, build: Build) -> Iterator[Statement]:
    """Axes together, or the path."""
    yield for_axes("BG", begin.axes if begin.which is Beginning.AXES else "S")


def stop_motion(stop: StopMotion, build: Build) -> Iterator[Statement]:
    """A stop with ramps; without letters it ends the program too."""
    limits = build.setup.limits
    match stop.which:
        case Which.AXES:
            letters = stop.axes
        case Which.PATH:
            letters = "S"
        case Which.MOTION:
            letters = limits.axes + ("S" if limits.coordinated else "")
        case Which.EVERYTHING:
            yield simple("ST")
            if limits.family == "dmc141x":  # there a bare ST in a program stops motion only (commands.md, 11)
                yield simple("HX")
            return
    yield for_axes("ST", letters)
    if stop.wait:
        yield for_axes("AM", letters)


def home(home: Home, build: Build) -> Iterator[Statement]:
    """Speeds and ramps of the search, the routine, begin, wait."""
    speeds = build.by_axis(home.speed, Dimension.SPEED)
    if home.routine is Homing.INDEX:
        sign = -1 if home.direction is Direction.REVERSE else 1
        yield by_axis("JG", {letter: _signed(value, sign) for letter, value in speeds.items()})
    elif speeds:
        yield by_axis("SP", speeds)
    yield from _ramps(home.acceleration, home.deceleration, build)
    yield for_axes(COMMANDS_OF[home.routine], home.axes)
    if home.begin:
        yield for_axes("BG", home.axes)
        if home.wait:
            yield for_axes("AM", home.axes)


def _signed(value: Value, sign: int) -> Value:
    if sign > 0:
        return value
    return f"-({value})" if isinstance(value, str) else -value
