"""Saved points: a name and the place of each axis in its unit, as they are kept in a file of their own."""

from __future__ import annotations

import dataclasses as dc
import json
from collections.abc import Iterable, Mapping

from codegen.fields import Dimension
from codegen.numbers import parse_number, plain
from codegen.setup import Setup

KIND, VERSION = "twoletter points", 1
LONGEST = 40  # characters of a name
AXES = "XYZW"


class PointsUnreadable(Exception):
    """The text is the sentence to show."""


@dc.dataclass(frozen=True)
class Place:
    """Where one axis is: a number as text, with its unit, so that it is never read in another one."""

    axis: str
    number: str
    unit: str


@dc.dataclass(frozen=True)
class Point:
    """A place of the machine that a person gave a name."""

    name: str
    places: tuple[Place, ...]

    @property
    def words(self) -> str:
        """ "X 12.5 mm, Y 3 mm"."""
        return ", ".join(f"{each.axis} {each.number} {each.unit}" for each in self.places)


def point_at(name: str, counts: Mapping[str, int], setup: Setup) -> Point:
    """A point where the axes are, from counts."""
    places = []
    for axis, number in sorted(counts.items(), key=lambda each: AXES.index(each[0])):
        unit = setup.unit_text(Dimension.POSITION, axis)
        places.append(Place(axis, plain(setup.from_counts(Dimension.POSITION, axis, number)), unit))
    return Point(name.strip(), tuple(places))


def counts_of(point: Point, setup: Setup, letters: str) -> dict[str, int] | str:
    """Where the axes go, counts; or why this machine cannot go there."""
    found = {}
    for place in point.places:
        if place.axis not in letters:
            return f"“{point.name}” has a place of axis {place.axis}; the setup or the controller has no such axis."
        unit = setup.unit_text(Dimension.POSITION, place.axis)
        if unit != place.unit:
            now = f"axis {place.axis} is set up in “{unit}” now"
            return f"“{point.name}” was saved in “{place.unit}”, and {now}. Save it again."
        number = parse_number(place.number)
        if number is None:
            return f"“{point.name}”: “{place.number}” is no number. Save it again."
        found[place.axis] = setup.counts(Dimension.POSITION, place.axis, number)
    return found


def name_problem(name: str, taken: Iterable[str]) -> str:
    """Why a point cannot be called so, or nothing; small and capital letters make no difference."""
    text = name.strip()
    if not text:
        return "Write a name for the point."
    if len(text) > LONGEST or not text.isprintable():
        return f"A name has at most {LONGEST} printable characters."
    if text.casefold() in {each.casefold() for each in taken}:
        return f"There is a point “{text}” already; choose another name, or delete that one first."
    return ""


def dumps(points: Iterable[Point]) -> str:
    """The text of the file."""
    rows = [{"name": each.name, "places": [dc.asdict(place) for place in each.places]} for each in points]
    return json.dumps({"kind": KIND, "version": VERSION, "points": rows}, indent=1, ensure_ascii=False) + "\n"


def loads(text: str) -> tuple[Point, ...]:
    """What a file holds; PointsUnreadable for anything that is not whole."""
    try:
        found = json.loads(text)
        if found["kind"] != KIND:
            raise PointsUnreadable("This file holds no saved points.")
        if found["version"] > VERSION:
            raise PointsUnreadable("These points were saved by a newer version of the program.")
        points = tuple(
            Point(row["name"], tuple(Place(each["axis"], each["number"], each["unit"]) for each in row["places"]))
            for row in found["points"]
        )
    except (ValueError, KeyError, TypeError) as error:
        raise PointsUnreadable(f"The saved points are damaged ({error}).") from error
    texts = [text for point in points for place in point.places for text in (point.name, place.number, place.unit)]
    axes = [place.axis for point in points for place in point.places]
    if not all(isinstance(each, str) for each in texts) or not all(each in tuple(AXES) for each in axes):
        raise PointsUnreadable("The saved points are damaged (an axis or a number is none).")
    return points
