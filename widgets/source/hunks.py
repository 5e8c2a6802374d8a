"""Where two listings differ, as few changes as say it: lines that stay keep their colours and shapes."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from codegen.changes import longest_rising

MOST = 12  # changes; more are made as one


class Hunk(NamedTuple):
    """The old lines `start` … `end` (exclusive) become these."""

    start: int
    end: int
    lines: list[str]


def hunks(old: Sequence[str], new: Sequence[str]) -> list[Hunk]:
    """From the last to the first, so that each can be made without counting anew."""
    first = same(old, new)
    last = same(old[first:][::-1], new[first:][::-1])
    end, until = len(old) - last, len(new) - last
    if first == end and first == until:
        return []
    found = list(_between(old, new, first, end, first, until))
    return found[::-1] if 0 < len(found) <= MOST else [Hunk(first, end, list(new[first:until]))]


def same(one: Sequence[str], other: Sequence[str]) -> int:
    """How many lines are the same from the start."""
    count = 0
    for left, right in zip(one, other, strict=False):
        if left != right:
            break
        count += 1
    return count


def _between(old: Sequence[str], new: Sequence[str], start: int, end: int, at: int, until: int) -> Iterator[Hunk]:
    """Lines that stand once on both sides, in the order they keep, are what stayed."""
    then, now = Counter(old[start:end]), Counter(new[at:until])
    places = {line: place for place, line in enumerate(old[start:end], start) if then[line] == 1}
    once = [(places[line], place) for place, line in enumerate(new[at:until], at) if now[line] == 1 and line in places]
    stayed = [once[each] for each in longest_rising([there for there, _ in once])]
    for there, here in (*stayed, (end, until)):
        yield from _trimmed(old, new, (start, there), (at, here))
        start, at = there + 1, here + 1


def _trimmed(old: Sequence[str], new: Sequence[str], before: tuple[int, int], after: tuple[int, int]) -> Iterator[Hunk]:
    """Without equal lines at both ends; nothing where all are equal."""
    (start, end), (at, until) = before, after
    first = same(old[start:end], new[at:until])
    last = same(old[start + first : end][::-1], new[at + first : until][::-1])
    if start + first < end - last or at + first < until - last:
        yield Hunk(start + first, end - last, list(new[at + first : until - last]))
