"""Lines of code with their steps, and several statements on a line; what was packed once is found again."""

from __future__ import annotations

import dataclasses as dc
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from functools import lru_cache
from typing import Any, NamedTuple

from codegen.compiled import numbered


class Line(NamedTuple):
    """One line of code; `step` is the step it comes from ("" = the frame of the program).

    `problem` tells why a step could not be turned into code (then the line is a remark). `parts` are the
    lines that share this one in compact code.
    """

    text: str
    step: str = ""
    problem: str = ""
    parts: tuple[Any, ...] = ()

    @property
    def spans(self) -> tuple[tuple[int, int, str], ...]:
        """Where several statements share the line: (first column, column after it, step) of each."""
        found: list[tuple[int, int, str]] = []
        start = 0
        for part in self.parts:
            found.append((start, start + len(part.text), part.step))
            start += len(part.text) + 1
        return tuple(found)


@dc.dataclass(frozen=True, eq=False)
class Piece:
    """Some lines beside each other. Another piece is never the same: who keeps results asks for this very one."""

    lines: tuple[Line, ...]
    marked: tuple[tuple[int, int, int], ...] = ()  # line, and which of the numbers given out it holds: from, to

    @property
    def text(self) -> str:
        """All of it."""
        return "\n".join(line.text for line in self.lines)


@lru_cache(maxsize=1024)
def frame(*texts: str, step: str = "") -> Piece:
    """Lines around the steps."""
    return Piece(tuple(Line(text, step) for text in texts))


@lru_cache(maxsize=4096)
def filled(piece: Piece, numbers: tuple[str, ...]) -> Piece:
    """With the numbers that make generated labels unique."""
    lines = list(piece.lines)
    for place, start, end in piece.marked:
        line = lines[place]
        lines[place] = line._replace(text=numbered(line.text, numbers[start:end]))
    return Piece(tuple(lines))


@lru_cache(maxsize=64)
def parted(piece: Piece, place: int) -> tuple[Piece, Piece]:
    """In front of a line, and from there on."""
    return Piece(piece.lines[:place]), Piece(piece.lines[place:])


Places = Mapping[str, tuple[int, ...]]  # the lines of each step


@dc.dataclass(frozen=True, slots=True)
class Stack:
    """Finished lines beside each other, and which of them come from which step."""

    lines: tuple[Line, ...]
    places: Places


def places_of(lines: Iterable[Line]) -> Places:
    """The lines of each step, from 0."""
    found: defaultdict[str, list[int]] = defaultdict(list)
    for number, line in enumerate(lines):
        for step in dict.fromkeys(part.step for part in line.parts) if line.parts else (line.step,):
            found[step].append(number)
    return {step: tuple(numbers) for step, numbers in found.items()}


def stacked(pieces: Iterable[Piece]) -> list[Stack]:
    """A line for each statement."""
    return [_stacked(piece) for piece in pieces]


@lru_cache(maxsize=4096)
def _stacked(piece: Piece) -> Stack:
    return Stack(piece.lines, places_of(piece.lines))


def packed(pieces: Iterable[Piece], columns: int) -> list[Stack]:
    """Statements joined with `;` as far as a line goes; a label starts a line, a remark has one of its own."""
    found: list[Stack] = []
    group: tuple[Line, ...] = ()
    for piece in pieces:
        stack, group = _packed(piece, group, columns)
        found.append(stack)
    if group:
        found.append(_stacked(_of(group)))
    return found


@lru_cache(maxsize=64)
def _of(group: tuple[Line, ...]) -> Piece:
    return Piece((_joined(group),))


@lru_cache(maxsize=4096)
def _packed(piece: Piece, begun: tuple[Line, ...], columns: int) -> tuple[Stack, tuple[Line, ...]]:
    """The lines that are full after a piece, and what the next one begins with."""
    groups = list(_groups((*begun, *piece.lines), columns))
    last = groups[-1] if groups and not _is_remark(groups[-1][-1].text) else ()
    lines = tuple([_joined(group) for group in (groups[:-1] if last else groups)])
    return Stack(lines, places_of(lines)), last


def _groups(lines: Iterable[Line], columns: int) -> Iterator[tuple[Line, ...]]:
    group: list[Line] = []
    length = 0
    for line in lines:
        text = line.text
        remark = text[:1] in REMARKS and _is_remark(text)
        if group and (remark or text[:1] == "#" or length + 1 + len(text) > columns):
            yield tuple(group)
            group, length = [], 0
        length += len(text) + (1 if group else 0)
        group.append(line)
        if remark:
            yield tuple(group)
            group, length = [], 0
    if group:
        yield tuple(group)


REMARKS = frozenset("'NR")  # how one may begin


def _is_remark(text: str) -> bool:
    return text[:1] == "'" or text[:2] == "NO" or text[:3] == "REM"


def _joined(group: tuple[Line, ...]) -> Line:
    return group[0] if len(group) == 1 else Line(";".join([line[0] for line in group]), group[0][1], "", group)
