"""The shape of a path in user units: where each segment leads and where it turns, as far as plain numbers tell."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from codegen.fields import AXES, value_of

if TYPE_CHECKING:
    from codegen.setup import Setup

Point = tuple[float, ...]
SHARPEST = 1.0  # degrees a join may turn without being a corner
Coordinate = Fraction | str | None  # a number, an expression as typed, or not known


@dataclass(frozen=True, slots=True)
class Leg:
    """One segment of a path: its end by axis in the order of the path, None where nobody knows yet."""

    start: tuple[Coordinate, ...]
    end: tuple[Coordinate, ...]
    arc: Arc | None = None


@dataclass(frozen=True, slots=True)
class Arc:
    """An arc in the directions of the axes: degrees, positive sweep is counter-clockwise."""

    radius: float
    start: float
    sweep: float


@dataclass(frozen=True, slots=True)
class Legs:
    """All segments, and those that cannot be: rows whose end is unknown, rows without length."""

    legs: tuple[Leg, ...]
    unknown: tuple[int, ...] = ()
    empty: tuple[int, ...] = ()


def coordinate(text: str) -> Coordinate:
    """A typed number or expression; None for nothing."""
    if not text.strip():
        return None
    number = value_of(text)
    return number if isinstance(number, Fraction) else text.strip()


def mirrored(setup: Setup | None, axes: str) -> tuple[bool, bool]:
    """Which axes of a plane are drawn the other way round: angles are those of the picture."""
    if setup is None or len(axes) != 2:
        return False, False
    return setup.axis(axes[0]).mirrored, setup.axis(axes[1]).mirrored


def in_axes(start: float, sweep: float, flips: tuple[bool, bool]) -> tuple[float, float]:
    """Angles of the picture as angles of the axes."""
    first, second = flips
    if first:
        start, sweep = 180 - start, -sweep
    if second:
        start, sweep = -start, -sweep
    return start, sweep


def legs(path: Any, setup: Setup | None = None, start_at: tuple[Coordinate, ...] = ()) -> Legs:
    """The segments of a path instruction, from its own (0, 0); where it goes on, from a place known or not."""
    begins: Coordinate = None if path.continues else Fraction(0)
    known: list[Coordinate] = list(start_at) if start_at else [begins] * len(path.axes)
    in_steps = str(getattr(path, "measured", "points")) == "steps"
    found: list[Leg] = []
    unknown: list[int] = []
    empty: list[int] = []
    for number, row in enumerate(path.segments):
        start = tuple(known)
        arc = arc_of(row, mirrored(setup, path.axes)) if getattr(row, "shape", "line") == "arc" else None
        if getattr(row, "shape", "line") == "arc":
            known = list(_after_arc(start, arc))
        else:
            given = [coordinate(row.to[AXES.index(letter)]) for letter in path.axes]
            known = [_next(before, there, in_steps) for before, there in zip(start, given, strict=True)]
            if len(path.axes) == 2 and None in known and not in_steps:
                unknown.append(number)
            if _no_length(start, known, given, in_steps):
                empty.append(number)
        found.append(Leg(start, tuple(known), arc))
    return Legs(tuple(found), tuple(unknown), tuple(empty))


def _next(before: Coordinate, given: Coordinate, in_steps: bool) -> Coordinate:
    if given is None:
        return before
    if not in_steps:
        return given
    return before + given if isinstance(before, Fraction) and isinstance(given, Fraction) else None


def _no_length(start: tuple[Coordinate, ...], end: list[Coordinate], given: list[Coordinate], in_steps: bool) -> bool:
    if in_steps:
        return all(each is None or each == 0 for each in given)
    return all(each is not None and each == before for before, each in zip(start, end, strict=True))


def arc_of(row: Any, flips: tuple[bool, bool] = (False, False)) -> Arc | None:
    """The arc of a row, when all its values are plain numbers."""
    radius, start, sweep = (value_of(text) if text else None for text in (row.radius, row.start, row.sweep))
    if not (isinstance(radius, Fraction) and isinstance(start, Fraction) and isinstance(sweep, Fraction)):
        return None
    return Arc(float(radius), *in_axes(float(start), float(sweep) * (-1 if row.turn == "cw" else 1), flips))


def _after_arc(start: tuple[Coordinate, ...], arc: Arc | None) -> tuple[Coordinate, ...]:
    """Where an arc ends: centre = start - r (cos, sin) of its start angle."""
    first, second = start
    if arc is None or not isinstance(first, Fraction) or not isinstance(second, Fraction):
        return None, None
    begin, end = math.radians(arc.start), math.radians(arc.start + arc.sweep)
    x = float(first) + arc.radius * (math.cos(end) - math.cos(begin))
    y = float(second) + arc.radius * (math.sin(end) - math.sin(begin))
    return Fraction(round(x, 9)).limit_denominator(10**9), Fraction(round(y, 9)).limit_denominator(10**9)


# ------------------------------------------------------------------------ corners


def turns_of(
    path: Any, setup: Setup | None = None, start_at: tuple[Coordinate, ...] = ()
) -> list[tuple[Point | None, Point | None]]:
    """The direction (unit vector) in which each segment begins and ends; None where it is not known."""
    found: list[tuple[Point | None, Point | None]] = []
    for leg, row in zip(legs(path, setup, start_at).legs, path.segments, strict=True):
        if leg.arc is not None:
            turn = math.copysign(90.0, leg.arc.sweep)
            found.append((_heading(leg.arc.start + turn), _heading(leg.arc.start + leg.arc.sweep + turn)))
        else:
            step = _step(leg, row, path)
            found.append((step, step))
    return found


def _heading(degrees: float) -> Point:
    return math.cos(math.radians(degrees)), math.sin(math.radians(degrees))


def _step(leg: Leg, row: Any, path: Any) -> Point | None:
    if str(getattr(path, "measured", "points")) == "steps":
        given = [coordinate(row.to[AXES.index(letter)]) for letter in path.axes]
        way = [0.0 if each is None else float(each) for each in given if not isinstance(each, str)]
        if len(way) < len(given):
            return None
    else:
        way = [
            float(end - start)
            for start, end in zip(leg.start, leg.end, strict=True)
            if isinstance(start, Fraction) and isinstance(end, Fraction)
        ]
        if len(way) < len(leg.end):
            return None
    length = math.hypot(*way)
    return tuple(each / length for each in way) if length else None


def corners(turns: Iterable[tuple[Point | None, Point | None]], least: float) -> list[tuple[int, float]]:
    """Joins that turn by more than `least` degrees: (row that begins there, angle)."""
    found: list[tuple[int, float]] = []
    for number, ((_, before), (after, _)) in enumerate(pairwise(turns), 1):
        if before is None or after is None:
            continue
        angle = math.degrees(math.acos(max(-1.0, min(1.0, sum(a * b for a, b in zip(before, after, strict=True))))))
        if angle > least:
            found.append((number, angle))
    return found


# ------------------------------------------------------------------------ picture


@dataclass(frozen=True, slots=True)
class Drawn:
    """One segment for a picture, in user units of the plane; `centre` belongs to an arc (degrees)."""

    start: tuple[float, float]
    end: tuple[float, float]
    centre: tuple[float, float] | None = None
    radius: float = 0.0
    angle: float = 0.0
    sweep: float = 0.0
    corner: float = 0.0  # degrees the path turns at its beginning


def path_of(path: Any, setup: Setup) -> tuple[Drawn, ...]:
    """A path in a plane as far as plain numbers tell; nothing of a path of one, three or four axes."""
    return chain((path,), setup)[0]


def chain(paths: Sequence[Any], setup: Setup) -> tuple[tuple[Drawn, ...], ...]:
    """Path instructions that go on with each other, each as far as plain numbers tell."""
    found: list[tuple[Drawn, ...]] = []
    start: tuple[Coordinate, ...] = ()
    heading: Point | None = None
    for path in paths:
        if len(path.axes) != 2:
            found.append(())
            continue
        turns = turns_of(path, setup, start)
        sharp = dict(corners([(None, heading), *turns], SHARPEST))
        parts = legs(path, setup, start)
        found.append(tuple(_drawn(parts, {number - 1: angle for number, angle in sharp.items()})))
        start = parts.legs[-1].end if parts.legs else start
        heading = turns[-1][1] if turns else heading
    return tuple(found)


def _drawn(parts: Legs, sharp: dict[int, float]) -> Iterator[Drawn]:
    for number, leg in enumerate(parts.legs):
        points = (*leg.start, *leg.end)
        if not all(isinstance(each, Fraction) for each in points):
            return
        x, y, to_x, to_y = (float(each) for each in points if isinstance(each, Fraction))
        arc, corner = leg.arc, sharp.get(number, 0.0)
        if arc is None:
            yield Drawn((x, y), (to_x, to_y), corner=corner)
            continue
        angle = math.radians(arc.start)
        centre = (x - arc.radius * math.cos(angle), y - arc.radius * math.sin(angle))
        yield Drawn((x, y), (to_x, to_y), centre, arc.radius, arc.start, arc.sweep, corner)
