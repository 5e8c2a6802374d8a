"""From the fields of the jog panel to a planned move, in counts. Pure."""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from codegen import read
from codegen.by_hand import Arc, Line, OneAxis
from codegen.conversion import ACCELERATION_STEP, SPEED_STEP
from codegen.fields import AXES, Dimension, fields_of
from codegen.numbers import parse_number, plain
from codegen.points import Point, counts_of
from codegen.setup import Setup
from device import jog

RAMP_S = Fraction(1, 4)  # to the speed of a point or a stick


@dataclass(frozen=True)
class Pace:
    """Speed with its ramps as SP, AC and DC (or VS, VA, VD) take them."""

    speed: int
    acceleration: int
    deceleration: int


def problem_of(item: Any, setup: Setup, needed: tuple[str, ...] = ()) -> str:
    """The first thing wrong with the fields, or nothing; `needed` may not be empty even where others may."""
    for name, field in fields_of(item).items():
        wrong = read.problem_of(item, name, setup)
        if wrong:
            return wrong
        if name in needed and field.empty(getattr(item, name)):
            return f"{field.label} is missing"
    return ""


def missing(axes: str, letters: str) -> str:
    """Which of the axes the connected controller has not, as a sentence, or nothing."""
    return next((f"This controller has no axis {letter}." for letter in axes if letter not in letters), "")


def pace_of(item: OneAxis, setup: Setup) -> Pace:
    """Of one axis; the fields have no problem."""
    return Pace(
        setup.counts(Dimension.SPEED, item.axis, _number(item.speed)),
        setup.counts(Dimension.ACCELERATION, item.axis, _number(item.acceleration)),
        setup.counts(Dimension.ACCELERATION, item.axis, _number(item.deceleration)),
    )


def by(item: OneAxis, setup: Setup, sign: int) -> jog.Plan:
    """One increment, forward or back."""
    counts = sign * setup.counts(Dimension.DISTANCE, item.axis, _number(item.distance))
    pace = pace_of(item, setup)
    plan = jog.by(item.axis, counts, pace.speed, pace.acceleration, pace.deceleration)
    return dc.replace(plan, title=f"Move {item.axis} by {jog.told(counts, item.axis, setup)}")


def to(item: OneAxis, setup: Setup) -> jog.Plan:
    """To the place in the field."""
    pace = pace_of(item, setup)
    place = setup.counts(Dimension.POSITION, item.axis, _number(item.place))
    plan = jog.to(item.axis, place, pace.speed, pace.acceleration, pace.deceleration)
    return dc.replace(plan, title=f"Move {item.axis} to {jog.told(place, item.axis, setup)}")


def home(item: OneAxis, setup: Setup, routine: jog.Routine) -> jog.Plan:
    """One of the three routines, at the speed of the fields."""
    pace = pace_of(item, setup)
    return jog.home(item.axis, routine, pace.speed, pace.acceleration, pace.deceleration)


def pace_at(axis: str, speed: str, setup: Setup) -> Pace | str:
    """Of a kept speed, with ramps that reach it in a quarter of a second; or why it cannot be driven."""
    number = parse_number(speed)
    low, top = setup.bounds(Dimension.SPEED, axis)
    if number is None or number <= 0:
        return f"Axis {axis} has no such speed; keep one on the page of one axis."
    if not low <= number <= top:
        return f"Axis {axis}: {speed} is above its top speed, {plain(top)} {setup.unit_text(Dimension.SPEED, axis)}."
    least, most = setup.bounds(Dimension.ACCELERATION, axis)
    ramp = setup.counts(Dimension.ACCELERATION, axis, min(max(number / RAMP_S, least), most))
    ramp = max(ramp, ACCELERATION_STEP)
    return Pace(setup.counts(Dimension.SPEED, axis, number), ramp, ramp)


def to_point(point: Point, letters: str, speeds: Mapping[str, str], setup: Setup) -> jog.Plan | str:
    """To a saved point, every axis at its kept speed; or why not."""
    places = counts_of(point, setup, letters)
    if isinstance(places, str):
        return places
    paces = {}
    for axis in places:
        pace = pace_at(axis, speeds.get(axis, ""), setup)
        if isinstance(pace, str):
            return pace
        paces[axis] = (pace.speed, pace.acceleration, pace.deceleration)
    return jog.to_point(f"“{point.name}”", places, paces)


def line(item: Line, setup: Setup) -> jog.Plan | str:
    """A straight line; its speed is in units along it, so counts follow from where it goes."""
    problem = problem_of(item, setup)
    if problem:
        return problem
    units = {letter: parse_number(item.distances[AXES.index(letter)]) or Fraction(0) for letter in item.axes}
    counts = {letter: setup.counts(Dimension.DISTANCE, letter, units[letter]) for letter in item.axes}
    way = math.hypot(*(float(number) for number in units.values()))
    if len(item.axes) < 2 or way == 0:
        return "A line needs two axes, and an increment that is not 0."
    if len({setup.axis(letter).symbol for letter in item.axes}) > 1:
        return "The axes have different units; a speed along the line has none then."
    return jog.line(counts, *_along(item, math.hypot(*counts.values()) / way, setup))


def arc(item: Arc, setup: Setup) -> jog.Plan | str:
    """A part of a circle; both axes need the same counts per unit, else it would be an ellipse."""
    problem = problem_of(item, setup)
    if problem:
        return problem
    if len(item.axes) != 2:
        return "An arc needs two axes."
    first, second = (setup.axis(letter) for letter in item.axes)
    if first.scale != second.scale or first.symbol != second.symbol:
        return f"Axes {item.axes[0]} and {item.axes[1]} have different counts per unit; a circle would be an ellipse."
    radius = setup.counts(Dimension.DISTANCE, item.axes[0], _number(item.radius))
    start, sweep = float(_number(item.start)), float(_number(item.sweep))
    return jog.arc(item.axes, radius, start, sweep, *_along(item, float(first.scale), setup))


def _along(item: Line | Arc, counts_per_unit: float, setup: Setup) -> tuple[int, int, int]:
    """VS, VA and VD for a path with so many counts in a unit of its length."""
    base = float(setup.axis(item.axes[0]).scale)
    made = []
    for dimension, text, step in (
        (Dimension.SPEED, item.speed, SPEED_STEP),
        (Dimension.ACCELERATION, item.acceleration, ACCELERATION_STEP),
        (Dimension.ACCELERATION, item.deceleration, ACCELERATION_STEP),
    ):
        factor = float(setup.factor(dimension, item.axes[0])) / base  # a sample that is no millisecond changes it
        steps = float(_number(text)) * factor * counts_per_unit / step
        # a speed never above what was asked for, a ramp the nearest one, as the fields say
        made.append(step * (math.floor(steps + 1e-6) if dimension is Dimension.SPEED else max(1, round(steps))))
    return made[0], made[1], made[2]


def _number(text: str) -> Fraction:
    number = parse_number(text)
    if number is None:
        raise ValueError(f"{text} is no number")
    return number
