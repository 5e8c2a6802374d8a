"""What is different between the file, the controller's memory and its EEPROM, row by row (pure; None: not known)."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Iterator, Sequence
from difflib import SequenceMatcher
from itertools import groupby

PLACES = ("file", "controller", "EEPROM")


@dc.dataclass(frozen=True, slots=True)
class Line:
    """A line of code with the sentence of the instruction it comes from and that instruction's mark, where known."""

    text: str
    words: str = ""
    step: str = ""


Lines = tuple[Line, ...]
Triple = tuple[int | None, int | None, int | None]  # the places of one row in file, controller, EEPROM


@dc.dataclass(frozen=True, slots=True)
class Cell:
    """What one place has of a difference: its lines, and the same in words."""

    lines: tuple[str, ...] = ()
    words: tuple[str, ...] = ()
    first: int = -1  # where its first line stands

    @property
    def text(self) -> str:
        """The instructions in plain English; their code where nobody knows the words."""
        return "\n".join(self.words or self.lines)


@dc.dataclass(frozen=True, slots=True)
class Difference:
    """One place of the program that is not the same everywhere; a cell is None where nothing is known."""

    cells: tuple[Cell | None, Cell | None, Cell | None]

    def same(self, one: int, other: int) -> bool | None:
        """Whether two places agree here; None where one of them is not known."""
        left, right = self.cells[one], self.cells[other]
        return None if left is None or right is None else left.lines == right.lines

    def words(self, other: int, base: int = 0) -> str:
        """What the other place has otherwise than the base, as a sentence; nothing when they agree."""
        ours, theirs = self.cells[base], self.cells[other]
        if ours is None or theirs is None or ours.lines == theirs.lines:
            return ""
        name = PLACES[other]
        if not ours.lines:
            return f"Only in the {name}: {_joined(theirs)}"
        if not theirs.lines:
            return f"Missing in the {name}: {_joined(ours)}"
        return f"Changed: {_joined(ours)} – in the {name}: {_joined(theirs)}"


def _joined(cell: Cell) -> str:
    return "; ".join(cell.words or cell.lines)


def _taught(lines: Lines | None, file: Lines | None) -> Lines | None:
    """Lines with the words of the same lines in the file, where they have none of their own."""
    if lines is None or file is None:
        return lines
    found = list(lines)
    for ours, theirs in matches([line.text for line in lines], [line.text for line in file]):
        if not found[ours].words:
            found[ours] = dc.replace(file[theirs], text=found[ours].text)
    return tuple(found)


# ----------------------------------------------------------------------- matching


def matches(ours: Sequence[str], theirs: Sequence[str]) -> list[tuple[int, int]]:
    """Places of the lines that are the same on both sides, both rising."""
    left, right = [text.rstrip() for text in ours], [text.rstrip() for text in theirs]
    first = 0
    while first < min(len(left), len(right)) and left[first] == right[first]:
        first += 1
    last = 0
    while last < min(len(left), len(right)) - first and left[-1 - last] == right[-1 - last]:
        last += 1
    found = [(place, place) for place in range(first)]
    middle = SequenceMatcher(None, left[first : len(left) - last], right[first : len(right) - last], autojunk=False)
    for block in middle.get_matching_blocks():
        found += [(first + block.a + each, first + block.b + each) for each in range(block.size)]
    return found + [(len(left) - each, len(right) - each) for each in range(last, 0, -1)]


def rows(file: Sequence[str], controller: Sequence[str], eeprom: Sequence[str]) -> list[Triple]:
    """Every line of all three, in an order that keeps the order of each; what is the same stands in one row."""
    in_controller = dict(matches(file, controller))
    in_eeprom = dict(matches(file, eeprom))
    found: list[Triple] = []
    at_c = at_e = 0
    for place in range(len(file) + 1):
        to_c = _next(in_controller, place, len(file), len(controller))
        to_e = _next(in_eeprom, place, len(file), len(eeprom))
        if place < len(file) and place not in in_controller:
            to_c = at_c  # what stands in the gap comes in front of the next line that both have
        if place < len(file) and place not in in_eeprom:
            to_e = at_e
        found += _gap(controller, range(at_c, to_c), eeprom, range(at_e, to_e))
        at_c, at_e = to_c, to_e
        if place < len(file):
            c, e = in_controller.get(place), in_eeprom.get(place)
            found.append((place, c, e))
            at_c, at_e = at_c + (c is not None), at_e + (e is not None)
    return found


def _next(matched: dict[int, int], place: int, end: int, length: int) -> int:
    return length if place == end else matched.get(place, 0)


def _gap(controller: Sequence[str], c: range, eeprom: Sequence[str], e: range) -> list[Triple]:
    """Lines that the file does not have; those that controller and EEPROM share stand in one row."""
    pairs = matches([controller[n] for n in c], [eeprom[n] for n in e]) if c and e else []
    found: list[Triple] = []
    at_c, at_e = c.start, e.start
    for one, other in [(c.start + a, e.start + b) for a, b in pairs] + [(c.stop, e.stop)]:
        found += [(None, n, None) for n in range(at_c, one)] + [(None, None, n) for n in range(at_e, other)]
        if one < c.stop:
            found.append((None, one, other))
        at_c, at_e = one + 1, other + 1
    return found


# ---------------------------------------------------------------------- differences


def differences(file: Lines | None, controller: Lines | None, eeprom: Lines | None) -> tuple[Difference, ...]:
    """Where the three are not the same, in their order; none when everything that is known agrees."""
    sides = (file, _taught(controller, file), _taught(eeprom, file))
    texts = [[line.text for line in side or ()] for side in sides]
    there = [place for place, side in enumerate(sides) if side is not None]
    if len(there) < 2:
        return ()
    found: list[Difference] = []
    for agree, block in groupby(rows(*texts), lambda row: len({_at(texts, row, place) for place in there}) == 1):
        if not agree:
            found += _split(sides, list(block))
    return tuple(found)


def _at(texts: Sequence[Sequence[str]], row: Triple, place: int) -> str | None:
    number = row[place]
    return None if number is None else texts[place][number].rstrip()


def _split(sides: tuple[Lines | None, ...], block: list[Triple]) -> Iterator[Difference]:
    """One difference for each instruction where all places have as many of them, else one for the whole block."""
    chunks = [_chunks(side, block, place) if side is not None else None for place, side in enumerate(sides)]
    counts = {len(each) for each in chunks if each}
    whole = [None if each is None else [(lo, hi) for lo, _ in each[:1] for _, hi in each[-1:]] for each in chunks]
    parts = chunks if len(counts) == 1 else whole
    for number in range(max((len(each) for each in parts if each), default=0)):
        cells = [_cell(side, each, number) for side, each in zip(sides, parts, strict=True)]
        difference = Difference((cells[0], cells[1], cells[2]))
        if len({cell.lines for cell in cells if cell is not None}) > 1:
            yield difference


def _cell(side: Lines | None, chunks: list[tuple[int, int]] | None, number: int) -> Cell | None:
    if side is None or chunks is None:
        return None
    if number >= len(chunks):
        return Cell()
    first, end = chunks[number]
    lines = side[first:end]
    words = [
        word
        for _, group in groupby(lines, lambda line: (line.step, line.words))
        for each in (list(group),)
        for word in ([each[0].words] if each[0].words else [line.text for line in each])
    ]
    return Cell(tuple(line.text.rstrip() for line in lines), tuple(words), first)


def _chunks(side: Lines, block: list[Triple], place: int) -> list[tuple[int, int]]:
    """The lines of one place in a block, an instruction each: (first, end)."""
    numbers = [row[place] for row in block]
    there = [number for number in numbers if number is not None]
    found: list[tuple[int, int]] = []
    for number in there:
        line = side[number]
        if found and line.step and side[number - 1].step == line.step and found[-1][1] == number:
            found[-1] = (found[-1][0], number + 1)
        else:
            found.append((number, number + 1))
    return found
