"""Checks of motion: commands that a moving axis refuses, interrupts without their routine."""

from __future__ import annotations

from collections.abc import Iterator

from codegen.twoletter.checks.rules import RULES
from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.evaluate import constant
from codegen.twoletter.facts import Facts
from codegen.twoletter.nodes import EXPRESSIONS, Axes, Command, Empty, Format, Label, Query
from codegen.twoletter.problems import Problem
from codegen.twoletter.rows import BY_AXIS, Row

SEQUENCE = "S"
_AXES = "XYZW"
_GOES_ELSEWHERE = frozenset({"JP", "JS", "EN", "RE", "RI", "ZS", "AB"})


def axes_named(command: Command, row: Row, model_axes: str) -> set[str]:
    """The axes a command sets or moves; S is the coordinated sequence."""
    if command.axis is not None:
        return {command.axis}
    if row.needs == "coordinated":
        return {SEQUENCE}
    if row.takes in BY_AXIS:
        places = zip(_AXES, command.arguments, strict=False)
        return {axis for axis, argument in places if not isinstance(argument, Empty | Query | Format)}
    letters = "".join(argument.letters for argument in command.arguments if isinstance(argument, Axes))
    return set(letters or model_axes)


def still_moving(facts: Facts) -> Iterator[Problem]:
    """PR, BG … of an axis begun a few statements before, with no wait, jump or label between (error 7 or 21)."""
    moving: set[str] = set()
    for placed in facts.statements:
        command = placed.statement
        if isinstance(command, Label):
            moving.clear()
        if not isinstance(command, Command):
            continue
        row = COMMANDS[command.name]
        axes = axes_named(command, row, facts.model.axes)
        if row.trippoint or command.name in _GOES_ELSEWHERE:
            moving.clear()
        elif not row.moving and row.moving_mode != "jog" and axes & moving and not _only_asks(command):
            again = row.moving_mode == "idle"
            yield RULES["still-moving"].problem(
                placed.line,
                command.span.start,
                command.span.end,
                21 if again else 7,
                text=command.name,
                axes=" ".join(sorted(axes & moving)),
            )
            moving.clear()
        if row.moving_mode == "idle":
            moving |= axes


def _only_asks(command: Command) -> bool:
    return any(isinstance(argument, Query) for argument in command.arguments)


def routine_missing(facts: Facts) -> Iterator[Problem]:
    """II without #ININT, CI with an interrupt but without #COMINT."""
    for line, command in facts.commands("II", "CI"):
        label = "ININT" if command.name == "II" else "COMINT"
        if label not in facts.labels and _interrupts(command):
            yield RULES["routine-missing"].problem(
                line, command.span.start, command.span.end, text=command.name, label=label
            )


def _interrupts(command: Command) -> bool:
    """Whether a constant argument asks for an interrupt (the third of CI is no interrupt)."""
    arguments = command.arguments[:2] if command.name == "CI" else command.arguments
    values = [constant(argument) for argument in arguments if isinstance(argument, EXPRESSIONS)]
    return any(value is not None and value > 0 for value in values)
