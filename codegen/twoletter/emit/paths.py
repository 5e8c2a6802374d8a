"""Paths of several axes: lines and arcs in a plane, straight segments of one to four axes, a tangent axis."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from math import sqrt

from codegen.expressions import Bad, Binary, Expression, Number, parse_expression, write
from codegen.fields import AXES, Dimension, base_letter, value_of
from codegen.instructions.path_parts import Ending, Measured, Piece, Shape, Turn, ellipse
from codegen.instructions.paths import CircularPath, LinearPath, TangentPath
from codegen.numbers import decimal, nearest, plain
from codegen.paths import Coordinate, legs, mirrored
from codegen.twoletter.calls import Mark, Statement, Value, by_axis, for_axes, numbers, segment, simple, target
from codegen.twoletter.emit.build import Build, raw
from codegen.twoletter.emit.motion import smoothing_ratio

ROOM = 511  # segments that can wait (commands.md, coordinated motion)
EARLY = 500  # a longer path begins after so many
REFILL = 100  # free places before the next ones are sent
ANGLE_PLACES = 4  # decimals; the grain is 1/256 degree
AnyPath = CircularPath | TangentPath | LinearPath


def circular_path(path: CircularPath, build: Build) -> Iterator[Statement]:
    yield from _whole(path, build, "VM", path.axes, _plane(path, build))


def tangent_path(path: TangentPath, build: Build) -> Iterator[Statement]:
    """A plane with a third axis; `TN` counts per degree."""
    yield from _whole(path, build, "VM", path.axes + path.tangent, _plane(path, build))


def linear_path(path: LinearPath, build: Build) -> Iterator[Statement]:
    """Two axes are a plane, as in the manual; other numbers use linear mode."""
    if len(path.axes) == 2:
        yield from _whole(path, build, "VM", path.axes, _lines(path, build))
    else:
        yield from _whole(path, build, "LM", path.axes, _steps(path, build))


def _whole(path: AnyPath, build: Build, mode: str, letters: str, calls: Iterator[Statement]) -> Iterator[Statement]:
    """Mode and parameters, segments, end, begin, wait: what belongs to this part of the path."""
    if not path.continues:
        yield for_axes(mode, letters)
        yield from _parameters(path, build, mode)
    turned = isinstance(path, TangentPath) and path.turn_first and not path.continues
    begun = False
    for number, call in enumerate(calls):
        if number >= EARLY and len(path.segments) > ROOM:
            if not begun:
                begun = True
                yield from _turned(path, turned)
                yield for_axes("BG", "S")
            if (number - EARLY) % REFILL == 0:
                yield from _room(build)
        yield call
    if path.ending is Ending.CONTINUE:
        yield from _turned(path, turned)
        return
    yield simple("LE" if mode == "LM" else "VE")
    if not begun:
        yield from _turned(path, turned)
        if not path.begin:
            return
        yield for_axes("BG", "S")
    if path.wait and path.begin:
        yield for_axes("AM", "S")


def _turned(path: AnyPath, turned: bool) -> Iterator[Statement]:
    """The tangent axis to the direction of the first segment, which the controller knows once it has that."""
    if turned and isinstance(path, TangentPath):
        yield by_axis("PA", {path.tangent: "_TN"})
        yield for_axes("BG", path.tangent)
        yield for_axes("AM", path.tangent)


def _room(build: Build) -> Iterator[Statement]:
    """Waits until the controller has places for the next segments."""
    label, _ = build.loop()
    yield Mark(label)
    yield target("JP", label, f"_LM<{REFILL}")


def _parameters(path: AnyPath, build: Build, mode: str) -> Iterator[Statement]:
    setup, base = build.setup, base_letter(build.setup, path.axes)
    if mode == "VM" and len({setup.axis(letter).scale for letter in setup.letters}) > 1:
        yield numbers("ES", *(ellipse(setup, path.axes) or (1, 1)))
    if isinstance(path, TangentPath):
        slope = value_of(path.turn_counts)
        assert isinstance(slope, Fraction), "only correct instructions are emitted"
        degree = Fraction(nearest(slope / 360 * 256), 256)
        yield numbers("TN", Fraction(decimal(degree, 8)), build.value(path.zero, Dimension.POSITION, path.tangent))
    if path.speed.strip():
        yield numbers("VS", _slowest(path, build) if mode == "LM" else build.value(path.speed, Dimension.SPEED, base))
    for name, text in (("VA", path.acceleration), ("VD", path.deceleration)):
        if text.strip():
            yield numbers(name, build.value(text, Dimension.ACCELERATION, base))
    if path.smoothing.strip():
        yield numbers("VT", smoothing_ratio(path.smoothing))


# ----------------------------------------------------------------------- speeds


def _speeds(path: AnyPath) -> list[str]:
    """What each segment says behind `<`: its own speed, or that of the path behind one with its own.

    The speed of a segment stays on the controller, and VS would act on segments that still wait.
    """
    found: list[str] = []
    present = "" if path.continues else path.speed.strip()
    for row in path.segments:
        wanted = row.speed.strip() or path.speed.strip()
        found.append(wanted if wanted != present else "")
        present = wanted
    return found


# ------------------------------------------------------------------ in a plane


def _plane(path: CircularPath | TangentPath, build: Build) -> Iterator[Statement]:
    base = base_letter(build.setup, path.axes)
    starts = [leg.start for leg in legs(path, build.setup).legs]
    for row, start, speed in zip(path.segments, starts, _speeds(path), strict=True):
        own = build.value(speed, Dimension.SPEED, base) if speed else None
        if row.shape is Shape.ARC:
            yield _arc(path, row, build, base, own)
            continue
        places = [row.to[AXES.index(letter)].strip() or _typed(at) for letter, at in zip(path.axes, start, strict=True)]
        values = {place: build.value(text, Dimension.DISTANCE, base) for place, text in enumerate(places)}
        yield segment("VP", values, own)


def _typed(place: Coordinate) -> str:
    """A place of the path as text: an axis that is not named stays there."""
    assert place is not None, "only correct instructions are emitted"
    return plain(place) if isinstance(place, Fraction) else place


def _arc(path: CircularPath | TangentPath, row: Piece, build: Build, base: str, speed: Value | None) -> Statement:
    """`CR radius,start,sweep`: angles of the picture turned into those of the axes."""
    first, second = mirrored(build.setup, path.axes)
    start, sweep = value_of(row.start), value_of(row.sweep)
    backwards = (row.turn is Turn.CW) != (first != second)
    if isinstance(start, Fraction):
        start = 180 - start if first else start
        begins: Value = Fraction(decimal(-start if second else start, ANGLE_PLACES))
    else:
        written = f"180-({raw(row.start)})" if first else raw(row.start)
        begins = f"-({written})" if second else written
    goes: Value
    if isinstance(sweep, Fraction):
        goes = Fraction(decimal(-sweep if backwards else sweep, ANGLE_PLACES))
    else:
        goes = f"-({raw(row.sweep)})" if backwards else raw(row.sweep)
    radius = build.value(row.radius, Dimension.DISTANCE, base)
    return segment("CR", {0: radius, 1: begins, 2: goes}, speed)


def _lines(path: LinearPath, build: Build) -> Iterator[Statement]:
    """Straight segments of two axes as points of their plane."""
    base = base_letter(build.setup, path.axes)
    places: list[str] = ["0", "0"]
    for row, speed in zip(path.segments, _speeds(path), strict=True):
        given = [row.to[AXES.index(letter)].strip() for letter in path.axes]
        if path.measured is Measured.STEPS:
            places = [_sum(before, step) if step else before for before, step in zip(places, given, strict=True)]
        else:
            places = [there or before for before, there in zip(places, given, strict=True)]
        own = build.value(speed, Dimension.SPEED, base) if speed else None
        values = {place: build.value(text, Dimension.DISTANCE, base) for place, text in enumerate(places)}
        yield segment("VP", values, own)


def _sum(first: str, second: str, sign: str = "+") -> str:
    """Two typed values as one text."""
    left, right = _tree(first), _tree(second)
    if isinstance(left, Number) and isinstance(right, Number):
        return write(Number(left.value + right.value if sign == "+" else left.value - right.value))
    if isinstance(left, Number) and not left.value and sign == "+":
        return second
    if isinstance(right, Number) and not right.value:
        return first
    return write(Binary(sign, left, right))


def _tree(text: str) -> Expression:
    number = value_of(text)
    if isinstance(number, Fraction):
        return Number(number)
    tree = parse_expression(text)
    assert not isinstance(tree, Bad), "only correct instructions are emitted"
    return tree


# ------------------------------------------------------------- linear segments


def _steps(path: LinearPath, build: Build) -> Iterator[Statement]:
    """Increments as differences of rounded places, so that they add up to the last place."""
    setup = build.setup
    exact = dict.fromkeys(path.axes, Fraction(0))
    sent = dict.fromkeys(path.axes, 0)
    before = dict.fromkeys(path.axes, "0")
    for row, speed in zip(path.segments, _ratios(path, build), strict=True):
        values: dict[int, Value] = {}
        for letter in path.axes:
            text = row.to[AXES.index(letter)].strip()
            if not text:
                continue
            step = text if path.measured is Measured.STEPS else _sum(text, before[letter], "-")
            before[letter] = text if path.measured is Measured.POINTS else before[letter]
            number = value_of(step)
            if isinstance(number, Fraction):
                exact[letter] += number
                place = setup.counts(Dimension.DISTANCE, letter, exact[letter])
                values[AXES.index(letter)] = place - sent[letter]
                sent[letter] = place
            else:
                values[AXES.index(letter)] = build.value(step, Dimension.DISTANCE, letter)
        yield segment("LI", values or {AXES.index(path.axes[0]): 0}, speed)


def _ratios(path: LinearPath, build: Build) -> Iterator[Value | None]:
    """The speed behind each segment; with different counts per unit it depends on the direction."""
    before: Value | None = None if path.continues or not path.speed.strip() else _slowest(path, build)
    for row, way in zip(path.segments, _ways(path), strict=True):
        wanted = row.speed.strip() or path.speed.strip()
        speed = _along(path, way, wanted, build) if wanted else None
        yield speed if speed != before else None
        before = speed


def _slowest(path: AnyPath, build: Build) -> Value:
    """The speed of the path in counts of its coarsest axis: never faster than what was asked."""
    return build.value(path.speed, Dimension.SPEED, base_letter(build.setup, path.axes))


def _along(path: LinearPath, way: list[Fraction] | None, text: str, build: Build) -> Value:
    """Counts/s along a segment: the speed times how many counts one unit of its way is."""
    setup, base = build.setup, base_letter(build.setup, path.axes)
    scales = [setup.axis(letter).scale for letter in path.axes]
    speed = value_of(text)
    if len(set(scales)) == 1 or way is None or not isinstance(speed, Fraction):
        return build.value(text, Dimension.SPEED, base)
    units = sum(each * each for each in way)
    counts = sum((each * scale) ** 2 for each, scale in zip(way, scales, strict=True))
    slow = setup.factor(Dimension.SPEED, base) / setup.axis(base).scale
    return max(int(float(speed * slow) * sqrt(counts / units)) // 2 * 2, 2)


def _ways(path: LinearPath) -> Iterator[list[Fraction] | None]:
    """How far each axis goes in each segment, in user units; None where an expression decides."""
    places: list[Fraction | None] = [Fraction(0)] * len(path.axes)
    for row in path.segments:
        way: list[Fraction | None] = []
        for column, letter in enumerate(path.axes):
            text = row.to[AXES.index(letter)].strip()
            number = value_of(text) if text else None
            there = number if isinstance(number, Fraction) else None
            if not text:
                way.append(Fraction(0))
            elif path.measured is Measured.STEPS:
                way.append(there)
            else:
                before = places[column]
                way.append(None if there is None or before is None else there - before)
                places[column] = there
        known = [each for each in way if each is not None]
        yield known if len(known) == len(way) and any(known) else None
