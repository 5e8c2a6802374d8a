"""How far rounding to counts carries a repeated relative move away: judged over all turns of the loops."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from fractions import Fraction
from functools import lru_cache
from types import MappingProxyType

from codegen.expressions import Bad, Binary, Expression, Negative, Number, walk
from codegen.fields import AXES, Dimension, base_letter, value_of
from codegen.instructions import (
    CircularPath,
    ContourMode,
    DefinePosition,
    End,
    Home,
    IncrementalPosition,
    Instruction,
    Jump,
    Label,
    LinearPath,
    Repeat,
    SingleAxisMove,
    TangentPath,
    TwoLetterCode,
)
from codegen.instructions.flow import JumpIf, JumpKind, RepeatMode
from codegen.instructions.machine import Register
from codegen.instructions.motion import MoveMode
from codegen.instructions.path_parts import Measured
from codegen.laps import FINEST, Course, Item, Mark, added, courses
from codegen.numbers import plain, shown
from codegen.paths import legs
from codegen.program import Step, Steps
from codegen.read import problems
from codegen.setup import Setup
from codegen.twoletter.course import raw_items

MANY = Fraction(1000)  # turns of a loop without end that are looked at
SIMPLE = 10**6  # denominator of what a sum of them stood for: no scale has more
NONE: Mapping[str, Course] = MappingProxyType({})


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


def repeated(repeat: Repeat, body: Course) -> Course:
    """The course of a repeat from that of what it holds."""
    count = turns(repeat)
    offs = tuple([(letter, round(count * off)) for letter, off in body.offs if letter not in body.known])
    certain = repeat.mode in (RepeatMode.COUNT, RepeatMode.FOREVER, RepeatMode.UNTIL)  # it runs at least once
    return Course(offs, body.known if certain else frozenset(), body.cuts, body.calls)


def along(steps: Steps, setup: Setup, at: int = 0) -> tuple[Item, ...]:
    """Marks, and the courses between them; the first step is number `at` of its stretch."""
    items: list[Item] = []
    between: list[Course] = []
    for number, step in enumerate(steps, at):
        for item in _items(step, setup, number):
            if isinstance(item, Course):
                between.append(item)
                continue
            if between:
                items.append(added(between))
                between = []
            items.append(item)
    if between:
        items.append(added(between))
    return tuple(items)


def _items(step: Step, setup: Setup, number: int) -> Iterable[Item]:
    if not step.enabled:
        return ()
    match step.instruction:
        case Label(name=name):
            return (Mark("label", name),)
        case Jump(kind=JumpKind.CALL, target=name):
            return (Course(calls=frozenset({name})),)
        case Jump(when=JumpIf.ALWAYS, target=name):
            return (Mark("jump", name, step.id, number),)
        case End():
            return (Mark("end", ""),)
        case Repeat() as repeat:
            return (repeated(repeat, courses(along(step.body, setup))),)
        case TwoLetterCode(text=text):
            return raw_items(text, setup, step.id, number)
        case move if type(move) in MOVES:
            return (_course(move, setup),)
    return ()


def _course(move: Instruction, setup: Setup) -> Course:
    """The course of a single move; kept."""
    found: Course | None = move.recall("_drift", setup)
    if found is None:
        wrong = any(finding.severity == "error" for finding in problems(move, setup))  # it sends nothing
        letters = [] if wrong else [letter for letter in setup.letters if letter in AXES]
        offs = [(letter, round(off_by(move, setup, letter) * FINEST)) for letter in letters]
        known = frozenset(letter for letter in letters if anew(move, letter))
        found = Course(tuple([each for each in offs if each[1]]), known, cut(move) is not None)
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
    return judged("This repeat", courses(along(step.body, setup)), setup, turns(step.instruction))


def judged(
    words: str, turn: Course, setup: Setup, count: Fraction = MANY, called: Mapping[str, Course] = NONE
) -> str | None:
    """What to say of a loop with this course; nothing of axes that a called subroutine may put to a known place."""
    known = turn.known | _known_by_calls(turn.calls, called, setup)
    far = tuple([(letter, off) for letter, off in turn.offs if off and letter not in known])
    if far and (text := _far(far, setup, float(count))):
        return words + text
    if turn.cuts:
        return f"{words} may drift: expressions are cut down to whole counts, going back as well as forth"
    return None


def _known_by_calls(calls: frozenset[str], called: Mapping[str, Course], setup: Setup) -> frozenset[str]:
    """Of a subroutine that is not a step of the program, nothing is known: it may do it to every axis."""
    known: frozenset[str] = frozenset()
    waiting, seen = list(calls), set(calls)
    while waiting:
        course = called.get(waiting.pop())
        known |= frozenset(setup.letters) if course is None else course.known
        new = course.calls - seen if course is not None else frozenset()
        seen |= new
        waiting += new
    return known


@lru_cache(maxsize=4096)
def _far(offs: tuple[tuple[str, int], ...], setup: Setup, count: float) -> str:
    """` drifts: X by 1.6 mm in 1000 turns`; nothing where every axis is off by less than a count."""
    parts = []
    for letter, off in sorted(offs, key=lambda each: AXES.index(each[0])):
        axis, far = setup.axis(letter), Fraction(off, FINEST).limit_denominator(SIMPLE) * Fraction(count)
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
