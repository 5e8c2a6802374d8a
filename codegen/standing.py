"""Where the axes stand before a step, and the path that is still open there, as far as the program tells.

A straight reading of the steps before: after a label, a loop or anything that moves by itself nothing is known until
the next move to a position. Places are in user units.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from codegen.fields import AXES, PerAxisText, value_of
from codegen.instructions import (
    CircularPath,
    DefinePosition,
    Execute,
    Group,
    Home,
    Instruction,
    Jump,
    Label,
    LinearPath,
    MotionParameters,
    Repeat,
    SingleAxisMove,
    TangentPath,
)
from codegen.instructions.flow import JumpKind
from codegen.instructions.machine import Register
from codegen.instructions.motion import Homing, MoveMode
from codegen.instructions.path_parts import Ending
from codegen.paths import chain
from codegen.program import Place, Program, Section, Step, children, place_of
from codegen.setup import Setup

Where = tuple[Fraction | None, ...]
UNKNOWN: Where = (None,) * len(AXES)
STILL = (Group.CONFIGURATION, Group.IO, Group.FLOW, Group.SERVO, Group.LIMITS, Group.MATH)  # they move nothing
PATHS = (CircularPath, TangentPath, LinearPath)


@dataclass(frozen=True, slots=True)
class Standing:
    """`places` of the axes before the path began; `path`: its instructions so far, the last one to be continued."""

    places: Where = UNKNOWN
    path: tuple[Instruction, ...] = ()

    def place(self, letter: str) -> Fraction | None:
        """Where an axis stands, None where nobody knows."""
        return self.places[AXES.index(letter)]


def standing_at(program: Program, place: Place, setup: Setup) -> Standing:
    """Before a place of the program; inside a loop or a subroutine only what its own steps tell."""
    before = children(program, place.parent)[: place.index]
    if place.parent == Section.MAIN:
        before = (*program.configuration, *before)
    return _after(before, setup)


def standing_before(program: Program, step_id: str, setup: Setup) -> Standing:
    """Before a step that is there."""
    return standing_at(program, place_of(program, step_id), setup)


def _after(steps: Iterable[Step], setup: Setup) -> Standing:
    now = Standing()
    for step in steps:
        if step.enabled:
            now = _then(now, step.instruction, setup)
    return now


def _then(now: Standing, done: Instruction, setup: Setup) -> Standing:
    """After one more step."""
    if isinstance(done, PATHS):
        return _path(now, done, setup)
    match done:
        case DefinePosition(register=Register.MAIN):
            return Standing(_given(now.places, done.position))
        case SingleAxisMove():
            return Standing(_moved(now.places, done))
        case Home():
            zero = Fraction(0) if done.routine is Homing.SWITCH else None
            return Standing(tuple(zero if letter in done.axes else at for letter, at in _pairs(now)))
        case MotionParameters() | Jump(kind=JumpKind.GO):
            return now
        case Label() | Repeat() | Jump() | Execute():
            return Standing()
        case _:
            return now if done.group in STILL else Standing()


def _pairs(now: Standing) -> Iterable[tuple[str, Fraction | None]]:
    return zip(AXES, now.places, strict=True)


def _given(places: Where, texts: PerAxisText) -> Where:
    """Axes that have a value are there, if it is a number."""
    return tuple(_number(text) if text.strip() else at for at, text in zip(places, texts, strict=True))


def _number(text: str) -> Fraction | None:
    number = value_of(text) if text.strip() else None
    return number if isinstance(number, Fraction) else None


def _moved(places: Where, move: SingleAxisMove) -> Where:
    at = places[AXES.index(move.axis)]
    new: Fraction | None = None
    if move.mode is MoveMode.TO:
        new = _number(move.position)
    elif move.mode is MoveMode.BY and at is not None and (by := _number(move.distance)) is not None:
        new = at + by
    return tuple(new if letter == move.axis else old for letter, old in zip(AXES, places, strict=True))


def _path(now: Standing, done: Any, setup: Setup) -> Standing:
    """An open path keeps the places it began at; a closed one moves them to its end."""
    goes_on = done.continues and now.path and now.path[-1].axes == done.axes  # type: ignore[attr-defined]
    path = (*now.path, done) if goes_on else (done,)
    if done.ending is Ending.CONTINUE:
        return Standing(now.places, path)
    parts = chain(path, setup) if not done.continues or goes_on else ()
    whole = bool(parts) and all(len(part) == len(each.segments) for part, each in zip(parts, path, strict=True))
    end = dict(zip(done.axes, parts[-1][-1].end, strict=True)) if whole and parts[-1] else {}
    places: list[Fraction | None] = []
    for letter, at in _pairs(now):
        by = end.get(letter)
        places.append(at if letter not in done.axes else None if at is None or by is None else at + Fraction(by))
    return Standing(tuple(places))
