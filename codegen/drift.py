"""How far rounding to counts carries a repeated relative move away: judged over all turns of the loops."""

from __future__ import annotations

from fractions import Fraction

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


def errors(steps: Steps, setup: Setup) -> dict[str, Fraction]:
    """What one run of the steps is off by on each axis, in user units (sent minus wanted)."""
    total: dict[str, Fraction] = {}
    known = set[str]()  # axes that an absolute move puts to a known place
    for step in steps:
        move = step.instruction
        if not step.enabled:
            continue
        if isinstance(move, Repeat):
            for letter, off in errors(step.body, setup).items():
                total[letter] = total.get(letter, Fraction(0)) + turns(move) * off
            continue
        offs, places = _moves(move, setup)
        known.update(places)
        for letter, off in offs:
            total[letter] = total.get(letter, Fraction(0)) + off
    return {letter: off for letter, off in total.items() if letter not in known}


def _moves(move: Instruction, setup: Setup) -> tuple[tuple[tuple[str, Fraction], ...], str]:
    """What an instruction is off by on each axis, and the axes whose place is known behind it; kept with it."""
    found: tuple[tuple[tuple[str, Fraction], ...], str] | None = move.recall("_drift", setup)
    if found is None:
        wrong = any(finding.severity == "error" for finding in problems(move, setup))  # it sends nothing
        letters = [] if wrong else [letter for letter in setup.letters if letter in AXES]
        offs = ((letter, off_by(move, setup, letter)) for letter in letters)
        found = tuple(pair for pair in offs if pair[1]), "".join(letter for letter in letters if anew(move, letter))
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
    return _drift("This repeat", step.body, setup, turns(step.instruction))


def jump_drift(steps: Steps, number: int, setup: Setup) -> str | None:
    """The same of a loop that a jump without condition closes; `steps[number]` is the jump."""
    jump = steps[number].instruction
    if not isinstance(jump, Jump) or jump.kind is not JumpKind.GO or jump.when is not JumpIf.ALWAYS:
        return None
    start = next((place for place, step in enumerate(steps[:number]) if _is_label(step, jump.target)), None)
    return None if start is None else _drift("This loop", steps[start:number], setup, MANY)


def _is_label(step: Step, name: str) -> bool:
    return step.enabled and isinstance(step.instruction, Label) and step.instruction.name == name


def _drift(words: str, body: Steps, setup: Setup, count: Fraction) -> str | None:
    parts: list[str] = []
    found = errors(body, setup)
    for letter in setup.letters:
        off = found.get(letter, Fraction(0)) * count
        if abs(off) * setup.axis(letter).scale >= 1:
            parts.append(f"{letter} by {shown(off, 4)} {setup.axis(letter).symbol}")
    if parts:
        return f"{words} drifts: {', '.join(parts)} in {plain(count)} turns"
    if reverses(body):
        return f"{words} may drift: expressions are cut down to whole counts, going back as well as forth"
    return None


def cut(move: Instruction) -> str | None:
    """What to know of a relative move by an expression with a minus, which the controller rounds downwards."""
    if not isinstance(move, SingleAxisMove) or move.mode is not MoveMode.BY:
        return None
    distance = value_of(move.distance)
    if isinstance(distance, Fraction | Bad) or not any(map(_is_minus, walk(distance))):
        return None
    return "Distance: the controller rounds it down to whole counts, so going back may be one count longer than forth"


def reverses(steps: Steps) -> bool:
    """Whether one of the steps, or of those inside them, is such a move."""
    return any(step.enabled and (cut(step.instruction) or reverses(step.body)) for step in steps)


def _is_minus(node: Expression) -> bool:
    match node:
        case Negative() | Binary(operator="-"):
            return True
        case Number(value=number):
            return number < 0
        case _:
            return False
