"""Arcs known by their ends and their sweep: centre, reach, distance, points on them. Plain geometry, any unit."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

Point = tuple[float, float]
QUARTER = math.pi / 2


@dataclass(frozen=True)
class Bow:
    """An arc from `start` over `sweep` degrees, positive counter-clockwise, about `centre`."""

    start: Point
    end: Point
    centre: Point
    sweep: float

    @cached_property
    def radius(self) -> float:
        return math.dist(self.start, self.centre)

    @cached_property
    def angle(self) -> float:
        """Where on its circle it begins, degrees."""
        return math.degrees(math.atan2(self.start[1] - self.centre[1], self.start[0] - self.centre[0]))

    @property
    def extent(self) -> tuple[Point, Point]:
        """Lowest and highest place in both directions."""
        low, high = sorted((math.radians(self.angle), math.radians(self.angle + self.sweep)))
        quarters = range(math.ceil(low / QUARTER - 1e-12), math.floor(high / QUARTER + 1e-12) + 1)
        points = [self.start, self.end, *(self._at(n * QUARTER) for n in quarters)]
        across, upward = [x for x, _ in points], [y for _, y in points]
        return (min(across), max(across)), (min(upward), max(upward))

    def share(self, point: Point) -> float:
        """How far along the arc (0 to 1) the ray to a point crosses it; outside where it does not."""
        here = math.degrees(math.atan2(point[1] - self.centre[1], point[0] - self.centre[0]))
        way = (here - self.angle) * math.copysign(1, self.sweep) % 360
        whole = abs(self.sweep)
        behind = way - 360  # the same ray, before the start
        return (way if way - whole <= -behind else behind) / whole

    def distance(self, point: Point) -> float:
        """From a point to the arc."""
        if 0 <= self.share(point) <= 1:
            return abs(math.dist(point, self.centre) - self.radius)
        return min(math.dist(point, self.start), math.dist(point, self.end))

    def points(self, most_off: float) -> list[Point]:
        """Points on the arc, the start left out, so close that chords leave it by no more than this."""
        step = 2 * math.acos(max(1 - most_off / self.radius, -1.0)) if self.radius > 0 else math.pi
        count = max(1, min(math.ceil(math.radians(abs(self.sweep)) / max(step, 1e-3)), 720))
        angle, part = math.radians(self.angle), math.radians(self.sweep) / count
        return [*(self._at(angle + n * part) for n in range(1, count)), self.end]

    def _at(self, angle: float) -> Point:
        return self.centre[0] + self.radius * math.cos(angle), self.centre[1] + self.radius * math.sin(angle)


def through_ends(start: Point, end: Point, sweep: float) -> Bow:
    """The arc between two different places with this sweep, in degrees, neither 0 nor a whole turn."""
    across, upward = end[0] - start[0], end[1] - start[1]
    aside = 0.5 / math.tan(math.radians(sweep) / 2)  # of the centre, from the middle, to the left, in chords
    centre = (start[0] + across / 2 - aside * upward, start[1] + upward / 2 + aside * across)
    return Bow(start, end, centre, sweep)


def through_point(start: Point, middle: Point, end: Point) -> Bow | None:
    """The arc through three places, or None where they lie on a line or too close to a whole circle."""
    chord = math.dist(start, end)
    if not chord:
        return None
    across, upward = (end[0] - start[0]) / chord, (end[1] - start[1]) / chord
    along = (middle[0] - start[0]) * across + (middle[1] - start[1]) * upward
    left = -(middle[0] - start[0]) * upward + (middle[1] - start[1]) * across
    # the angle under which the ends are seen from the middle point is half of what the rest of the circle sweeps
    seen = math.atan2(chord * abs(left), left * left + along * (along - chord))
    sweep = 360 - 2 * math.degrees(seen)
    if not 0.5 < sweep < 350 or not left:
        return None
    return through_ends(start, end, math.copysign(sweep, -left))


def distance_to_line(point: Point, start: Point, end: Point) -> float:
    """From a point to the straight piece between two places."""
    across, upward = end[0] - start[0], end[1] - start[1]
    length = across * across + upward * upward
    share = ((point[0] - start[0]) * across + (point[1] - start[1]) * upward) / length if length else 0.0
    share = min(max(share, 0.0), 1.0)
    return math.dist(point, (start[0] + share * across, start[1] + share * upward))
