"""A way that was driven by hand, with its pauses, as few lines and arcs near every place that was seen.

Lengths are counts (or any one unit for both axes), times seconds. Ends of lines and arcs are places that were seen. An
arc is followed by a line, because a line ends on its count on a controller and an arc only near it.
"""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from functools import partial
from itertools import pairwise
from typing import NamedTuple

from codegen.bows import Bow, Point, distance_to_line, through_ends, through_point
from codegen.numbers import decimal
from codegen.setup import Setup
from codegen.teach import LONGEST_CHAIN, ON, Row, place_text

SHARPEST = 20.0  # degrees a path may turn without a stop
FEWEST_OF_AN_ARC = 4  # places; three lie on a circle whatever they are
FLATTEST = 2.0  # degrees; less is a line
MOST_OF_AN_ARC = 300.0  # degrees


class Seen(NamedTuple):
    """Where the axes were at a moment."""

    seconds: float
    x: float
    y: float


@dc.dataclass(frozen=True, slots=True)
class Leg:
    """A line (no sweep) or an arc to a place, and how long the axes stood there then."""

    end: Point
    sweep: float = 0.0
    pause_s: float = 0.0
    stops: bool = False


@dc.dataclass(frozen=True, slots=True)
class Way:
    """Where it begins, how long the axes stood there, and its legs."""

    start: Point
    legs: tuple[Leg, ...]
    pause_s: float = 0.0


def thinned(seen: Sequence[Seen], tolerance: float, least_pause_s: float = 0.3) -> Way:
    """The way through these places, in their order; it stands where the axes stood at least so long."""
    start, before, stretches = _stretches(seen, tolerance, least_pause_s)
    legs: list[Leg] = []
    for points, pause in stretches:
        legs += [Leg(end, sweep) for end, sweep in _legs(points, tolerance)]
        legs[-1] = Leg(legs[-1].end, legs[-1].sweep, pause, stops=True)
    return Way(start, tuple(legs), before)


def fitting(
    seen: Sequence[Seen], tolerance: float, setup: Setup, pace: Row, most: int
) -> tuple[tuple[Row, ...], float]:
    """At most so many rows, and the tolerance (counts) that they keep: the given one, or the first double that does."""
    furthest = max(math.dist(each[1:], seen[0][1:]) for each in seen)
    while True:
        rows = rows_of(thinned(seen, tolerance), setup, pace)
        if len(rows) <= most or tolerance > furthest:
            return rows, tolerance
        tolerance *= 2


def rows_of(way: Way, setup: Setup, pace: Row) -> tuple[Row, ...]:
    """The way (in counts) as rows with the speed and ramps of another row; sharp corners and pauses stop it.

    So does what a controller can hold of a path without a stop.
    """
    bare = Row(speed=pace.speed, acceleration=pace.acceleration, deceleration=pace.deceleration)
    rows = [_row(bare, way.start, setup, way.pause_s)]
    turns, chain = _corners(way), 0
    for number, leg in enumerate(way.legs):
        row = _row(bare, leg.end, setup, leg.pause_s)
        goes_on = not leg.stops and turns[number] <= SHARPEST and chain < LONGEST_CHAIN - 1
        chain = chain + 1 if goes_on else 0
        sweep = decimal(Fraction(leg.sweep), 4) if leg.sweep else ""
        rows.append(dc.replace(row, sweep=sweep, through=ON if goes_on else ""))
    return tuple(rows)


def _row(bare: Row, place: Point, setup: Setup, pause_s: float) -> Row:
    x, y = (place_text(setup, letter, round(counts)) for letter, counts in zip("XY", place, strict=True))
    return dc.replace(bare, x=x, y=y, pause=str(round(pause_s * 1000)) if pause_s else "")


def _corners(way: Way) -> list[float]:
    """By how many degrees the way turns behind each leg."""
    headings = []
    for start, end, bow in _pieces(way):
        if bow is None:
            both = (math.degrees(math.atan2(end[1] - start[1], end[0] - start[0])),) * 2
        else:
            turned = math.copysign(90, bow.sweep)
            both = (bow.angle + turned, bow.angle + bow.sweep + turned)
        headings.append(both)
    turns = [abs((after[0] - before[1] + 180) % 360 - 180) for before, after in pairwise(headings)]
    return [*turns, 180.0]


def distance(way: Way, point: Point) -> float:
    """From a place to the nearest point of the way."""
    pieces = list(_pieces(way))
    if not pieces:
        return math.dist(way.start, point)
    return min(_distance(start, end, bow, point) for start, end, bow in pieces)


def _pieces(way: Way) -> Iterator[tuple[Point, Point, Bow | None]]:
    for start, leg in pairwise([Leg(way.start), *way.legs]):
        yield start.end, leg.end, through_ends(start.end, leg.end, leg.sweep) if leg.sweep else None


def _distance(start: Point, end: Point, bow: Bow | None, point: Point) -> float:
    return distance_to_line(point, start, end) if bow is None else bow.distance(point)


# ---------------------------------------------------------------- where it stood


def _stretches(
    seen: Sequence[Seen], tolerance: float, least_pause_s: float
) -> tuple[Point, float, list[tuple[list[Point], float]]]:
    """Where it began and stood first; then places of each way without a stop, and the pause at its end."""
    start = (seen[0].x, seen[0].y)
    points, found, before = [start], list[tuple[list[Point], float]](), 0.0
    number = 0
    while number < len(seen):
        last = _stood_until(seen, number)
        place, stood = (seen[number].x, seen[number].y), seen[last].seconds - seen[number].seconds
        if place != points[-1]:
            points.append(place)
        if stood >= least_pause_s:
            if len(points) > 1:
                found.append((points, stood))
                points = [place]
            else:
                before += stood
        number = last + 1
    if len(points) > 1:
        found.append((points, 0.0))
    return start, before, found


def _stood_until(seen: Sequence[Seen], number: int) -> int:
    """The last reading in a row at the same place."""
    last = number
    while last + 1 < len(seen) and seen[last + 1][1:] == seen[number][1:]:
        last += 1
    return last


# ---------------------------------------------------------------- lines and arcs


def _legs(points: list[Point], tolerance: float) -> Iterator[tuple[Point, float]]:
    """The longest line or arc from where it is, again and again."""
    here, arc_allowed = 0, True
    while here < len(points) - 1:
        line = _furthest(points, here, partial(_is_line, points, here, tolerance))
        arc, sweep = _longest_arc(points, here, tolerance) if arc_allowed else (here, 0.0)
        if arc > line + 1:
            yield points[arc], sweep
            here, arc_allowed = arc, False
        else:
            yield points[line], 0.0
            here, arc_allowed = line, True


def _furthest(points: list[Point], here: int, fits: Callable[[int], bool]) -> int:
    """The last place that still fits: by doubling, then by halves. What it returns was tried itself."""
    good, step = here + 1, 2
    while here + step < len(points) and fits(here + step):
        good, step = here + step, step * 2
    low, high = good, min(here + step, len(points) - 1) + 1
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if fits(middle) else (low, middle)
    return low


def _is_line(points: list[Point], first: int, tolerance: float, last: int) -> bool:
    """All places lie near the line, and it goes forward: who turns round on a line has gone another way."""
    start, end = points[first], points[last]
    across, upward = end[0] - start[0], end[1] - start[1]
    length = math.hypot(across, upward)
    furthest = 0.0
    for place in points[first : last + 1]:
        if distance_to_line(place, start, end) > tolerance:
            return False
        along = ((place[0] - start[0]) * across + (place[1] - start[1]) * upward) / length if length else 0.0
        if along < furthest - tolerance:
            return False
        furthest = max(furthest, along)
    return True


def _longest_arc(points: list[Point], here: int, tolerance: float) -> tuple[int, float]:
    """How far an arc reaches, with room for the line behind it, and its sweep."""
    room = len(points) - 2
    if room - here < FEWEST_OF_AN_ARC:
        return here, 0.0

    def fits(last: int) -> bool:
        return last <= room and _arc(points, here, last, tolerance) is not None

    first = here + FEWEST_OF_AN_ARC
    if not fits(first):
        return here, 0.0
    last = max(_furthest(points, here, lambda end: end < first or fits(end)), first)
    bow = _arc(points, here, last, tolerance)
    return (last, bow.sweep) if bow is not None else (here, 0.0)


def _arc(points: list[Point], first: int, last: int, tolerance: float) -> Bow | None:
    """The arc through both ends and the middle one, when all places between lie near it in their order."""
    start, end = points[first], points[last]
    bow = through_point(start, points[(first + last) // 2], end)
    if bow is None or not FLATTEST < abs(bow.sweep) < MOST_OF_AN_ARC:
        return None
    before = 0.0
    for place in points[first + 1 : last]:
        share = bow.share(place)
        if not 0 <= share <= 1 or share < before or abs(math.dist(place, bow.centre) - bow.radius) > tolerance:
            return None
        if _bulge(bow, share - before) > tolerance:
            return None
        before = share
    return None if _bulge(bow, 1 - before) > tolerance else bow


def _bulge(bow: Bow, share: float) -> float:
    """How far the arc leaves the straight way between two places that follow each other."""
    return bow.radius * (1 - math.cos(math.radians(bow.sweep * share) / 2))
