"""What loops of a program do to the places of the axes: courses of stretches of steps, and which loops are certain."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple, TypeVar

FINEST = 10**15  # parts of a user unit that errors are added up in


@dc.dataclass(frozen=True, slots=True)
class Course:
    """What one run of some steps does to the places of the axes. Whole numbers: any grouping adds up to the same."""

    offs: tuple[tuple[str, int], ...] = ()  # what each axis is off by (sent minus wanted), in FINEST of a user unit
    known: frozenset[str] = frozenset()  # axes whose place is known behind it, whatever was before
    cuts: bool = False  # whether an expression is cut down, going back as well as forth
    calls: frozenset[str] = frozenset()  # subroutines


class Mark(NamedTuple):
    """Where the way of a program goes on elsewhere, or may be entered; `at`: which step of its stretch that is."""

    kind: str  # "label", "jump" (without condition), "end"
    name: str
    step: str = ""
    at: int = 0


Item = Course | Mark
STILL = Course()


def added(courses: Iterable[Course]) -> Course:
    """One after the other, or at different times of the same turn."""
    offs: dict[str, int] = {}
    known: frozenset[str] = frozenset()
    calls: frozenset[str] = frozenset()
    cuts = False
    for course in courses:
        for letter, off in course.offs:
            offs[letter] = offs.get(letter, 0) + off
        known |= course.known
        calls |= course.calls
        cuts = cuts or course.cuts
    return Course(tuple(offs.items()), known, cuts, calls)


def courses(items: Iterable[Item]) -> Course:
    """Everything among these items."""
    return added([item for item in items if isinstance(item, Course)])


T = TypeVar("T")


def loops(items: Sequence[tuple[Item, T]]) -> Iterator[tuple[Mark, T, Course]]:
    """The jumps that close a loop whose way is certain, and the course of one turn.

    Such a loop leads from a label back to it; a jump forward on the way passes only over what moves nothing. What
    lies behind another jump back is never reached from that label.
    """
    labels: dict[str, int] = {}
    for number, (item, _) in enumerate(items):
        if isinstance(item, Mark) and item.kind == "label":
            labels.setdefault(item.name, number)
    barrier = -1
    for number, (item, where) in enumerate(items):
        if not isinstance(item, Mark) or item.kind == "label":
            continue
        start = labels.get(item.name, number) if item.kind == "jump" else -1
        if start < number:
            turn = _turn(items, start, number, labels) if start > barrier else None
            if turn is not None:
                yield item, where, turn
            barrier = number


def _turn(items: Sequence[tuple[Item, T]], start: int, end: int, labels: Mapping[str, int]) -> Course | None:
    """From the label to the jump; None where the way is not certain."""
    passed: list[Course] = []
    number = start
    while number < end:
        item = items[number][0]
        if isinstance(item, Course):
            passed.append(item)
        elif item.kind == "jump":
            to = labels.get(item.name, end + 1)
            if to > end or courses([each for each, _ in items[number:to]]) != STILL:
                return None
            number = to
        number += 1
    return added(passed)
