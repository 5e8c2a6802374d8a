"""How far rounding to counts carries a repeated relative move away: judged over all turns of the loops."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable, Sequence
from fractions import Fraction
from functools import lru_cache

from codegen.expressions import Bad, Binary, Expression, Negative, Number, walk
from codegen.fields import AXES, Dimension, base_letter, value_of
from codegen.instructions import (
    CircularPath,
    ContourMode,
    DefinePosition,
    Home,
    IncrementalPosition,
    Instruction,
    Jump,
    Label,
    LinearPath,
    Repeat,
    SingleAxisMove,
    TangentPath,
)
from codegen.instructions.flow import JumpIf, JumpKind, RepeatMode
from codegen.instructions.machine import Register
from codegen.instructions.motion import MoveMode
from codegen.instructions.path_parts import Measured
from codegen.numbers import plain, shown
from codegen.paths import legs
from codegen.program import Step, Steps
from codegen.read import problems
from codegen.setup import Setup

MANY = Fraction(1000)  # turns of a loop without end that are looked at


def turns(repeat: Repeat) -> Fraction:
    """How often a repeat runs; 1 when only the running program knows, MANY when it never ends."""
    if repeat.mode is RepeatMode.FOREVER:
        return MANY
    count = value_of(repeat.count)
    return count if repeat.mode is RepeatMode.COUNT and isinstance(count, Fraction) else Fraction(1)


MOVES = frozenset(
    {
        SingleAxisMove,
        IncrementalPosition,
        ContourMode,
        LinearPath,
        CircularPath,
        TangentPath,
        Home,
        DefinePosition,
    }
)


class Sums:
    """What the steps beside each other are off by, added up once: any stretch of them costs a few look-ups.

    Sums are floats: they are far finer than the four digits that are shown, and made anew at every edit.
    """

    def __init__(self, steps: Steps, setup: Setup) -> None:
        self.steps = steps
        self.off: dict[str, tuple[list[int], list[float]]] = {}  # by axis: where it grows, and the sum up to there
        self.known: dict[str, list[int]] = {}  # by axis: where an absolute move puts it to a known place
        self.cuts: list[int] = []  # where an expression is cut down
        self.labels: dict[str, int] = {}
        for number, step in enumerate(steps):
            move = step.instruction
            kind = type(move)
            if kind in MOVES:
                if step.enabled:
                    self._add(number, move, setup)
            elif isinstance(move, Label) and step.enabled:
                self.labels.setdefault(move.name, number)
            elif isinstance(move, Repeat) and step.enabled:
                inside = Sums(step.body, setup)
                count = float(turns(move))
                self._grow(number, ((letter, count * off) for letter, off in inside.errors().items()))
                if inside.cuts:
                    self.cuts.append(number)

    def _add(self, number: int, move: Instruction, setup: Setup) -> None:
        offs, places, is_cut = _moves(move, setup)
        for letter in places:
            self.known.setdefault(letter, []).append(number)
        if offs:
            self._grow(number, offs)
        if is_cut:
            self.cuts.append(number)

    def _grow(self, number: int, offs: Iterable[tuple[str, float]]) -> None:
        for letter, off in offs:
            places, sums = self.off.setdefault(letter, ([], [0.0]))
            places.append(number)
            sums.append(sums[-1] + off)

    def errors(self, start: int = 0, end: int | None = None) -> dict[str, float]:
        """What one run of the steps is off by on each axis, in user units (sent minus wanted)."""
        last = len(self.steps) if end is None else end
        return {
            letter: sums[bisect_left(places, last)] - sums[bisect_left(places, start)]
            for letter, (places, sums) in self.off.items()
            if not _between(self.known.get(letter, ()), start, last)
        }

    def reverses(self, start: int = 0, end: int | None = None) -> bool:
        """Whether a distance among the steps is cut down to whole counts, going back as well as forth."""
        return _between(self.cuts, start, len(self.steps) if end is None else end)


def _between(places: Sequence[int], start: int, end: int) -> bool:
    """Whether one of the places, which go upwards, lies there."""
    return bisect_left(places, start) < bisect_left(places, end)


Moves = tuple[tuple[tuple[str, float], ...], str, bool]


def _moves(move: Instruction, setup: Setup) -> Moves:
    """What an instruction is off by on each axis, the axes whose place is known behind it, whether it is cut; kept."""
    found: Moves | None = move.recall("_drift", setup)
    if found is None:
        wrong = any(finding.severity == "error" for finding in problems(move, setup))  # it sends nothing
        letters = [] if wrong else [letter for letter in setup.letters if letter in AXES]
        offs = ((letter, off_by(move, setup, letter)) for letter in letters)
        known = "".join(letter for letter in letters if anew(move, letter))
        found = tuple((letter, float(off)) for letter, off in offs if off), known, cut(move) is not None
        move.remember("_drift", setup, found)
    return found


def anew(move: Instruction, letter: str) -> bool:
    """Whether an instruction leaves the axis at a known place, whatever was before."""
    match move:
        case SingleAxisMove(mode=MoveMode.TO):
            return move.axis == letter
        case Home():
            return letter in move.axes
        case DefinePosition(register=Register.MAIN):
            return bool(move.position[AXES.index(letter)])
    return False


def off_by(move: Instruction, setup: Setup, letter: str) -> Fraction:
    """What one relative move is off by, in user units."""
    match move:
        case SingleAxisMove(mode=MoveMode.BY) if move.axis == letter:
            return rounding(value_of(move.distance), setup, letter)
        case IncrementalPosition():
            text = move.distance[AXES.index(letter)]
            return rounding(value_of(text), setup, letter) if text.strip() else Fraction(0)
        case ContourMode() if letter in move.axes:
            place = move.axes.index(letter)
            return rounding(sum((steps[place] for _, steps in move.records()), Fraction(0)), setup, letter)
        case LinearPath() if letter in move.axes and len(move.axes) != 2:
            return _straight(move, setup, letter)
        case CircularPath() | TangentPath() | LinearPath() if letter in move.axes and not move.continues:
            return _in_a_plane(move, setup, letter)
    return Fraction(0)


def rounding(wanted: Fraction | Expression | Bad, setup: Setup, letter: str) -> Fraction:
    """What a distance is off by once it is counts; nothing is known of an expression."""
    if not isinstance(wanted, Fraction):
        return Fraction(0)
    sent = setup.counts(Dimension.DISTANCE, letter, wanted)
    return setup.from_counts(Dimension.DISTANCE, letter, sent) - wanted


def _straight(path: LinearPath, setup: Setup, letter: str) -> Fraction:
    """Increments add up to the rounded last place."""
    places = [value_of(row.to[AXES.index(letter)]) for row in path.segments if row.to[AXES.index(letter)].strip()]
    numbers = [place for place in places if isinstance(place, Fraction)]
    if not numbers or len(numbers) < len(places):
        return Fraction(0)
    return rounding(numbers[-1] if path.measured is Measured.POINTS else sum(numbers, Fraction(0)), setup, letter)


def _in_a_plane(path: CircularPath | TangentPath | LinearPath, setup: Setup, letter: str) -> Fraction:
    """Lines end at rounded places, arcs go on from there with a rounded radius; one scale counts for both axes."""
    base, column = base_letter(setup, path.axes), path.axes.index(letter)
    off = Fraction(0)
    for leg in legs(path, setup).legs:
        end, start = leg.end[column], leg.start[column]
        if not isinstance(end, Fraction) or not isinstance(start, Fraction):
            return Fraction(0)
        if leg.arc is None:
            off = rounding(end, setup, base)
        else:
            radius = Fraction(leg.arc.radius).limit_denominator(10**9)
            off += rounding(radius, setup, base) / radius * (end - start)
    return off


def drift(step: Step, setup: Setup) -> str | None:
    """`This repeat drifts by 1.6 mm in 1000 turns`; None when it stays within a count."""
    if not isinstance(step.instruction, Repeat):
        return None
    return _drift("This repeat", Sums(step.body, setup), 0, len(step.body), setup, turns(step.instruction))


def jump_drift(sums: Sums, number: int, setup: Setup) -> str | None:
    """The same of a loop that a jump without condition closes; the jump is the step of that number."""
    jump = sums.steps[number].instruction
    start = sums.labels.get(jump.target, number) if isinstance(jump, Jump) else number
    return _drift("This loop", sums, start, number, setup, MANY) if start < number else None


def closes_a_loop(jump: Instruction) -> bool:
    """Whether it is a jump without condition."""
    return isinstance(jump, Jump) and jump.kind is JumpKind.GO and jump.when is JumpIf.ALWAYS


def _drift(words: str, sums: Sums, start: int, end: int, setup: Setup, count: Fraction) -> str | None:
    if sums.off:
        found = tuple([(letter, round(off, 12)) for letter, off in sums.errors(start, end).items()])
        if found and (text := _far(found, setup, float(count))):
            return words + text
    if sums.cuts and sums.reverses(start, end):
        return f"{words} may drift: expressions are cut down to whole counts, going back as well as forth"
    return None


@lru_cache(maxsize=4096)
def _far(offs: tuple[tuple[str, float], ...], setup: Setup, count: float) -> str:
    """` drifts: X by 1.6 mm in 1000 turns`; nothing where every axis is off by less than a count."""
    parts = []
    for letter, off in sorted(offs, key=lambda each: AXES.index(each[0])):
        axis, far = setup.axis(letter), Fraction(off).limit_denominator(10**12) * Fraction(count)
        if abs(far) * axis.scale >= 1:
            parts.append(f"{letter} by {shown(far, 4)} {axis.symbol}")
    return f" drifts: {', '.join(parts)} in {plain(Fraction(count))} turns" if parts else ""


def cut(move: Instruction) -> str | None:
    """What to know of a relative move by an expression with a minus, which the controller rounds downwards."""
    if not isinstance(move, SingleAxisMove) or move.mode is not MoveMode.BY:
        return None
    distance = value_of(move.distance)
    if isinstance(distance, Fraction | Bad) or not any(map(_is_minus, walk(distance))):
        return None
    return "Distance: the controller rounds it down to whole counts, so going back may be one count longer than forth"


def _is_minus(node: Expression) -> bool:
    match node:
        case Negative() | Binary(operator="-"):
            return True
        case Number(value=number):
            return number < 0
        case _:
            return False
