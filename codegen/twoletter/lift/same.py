"""When two pieces of code are the same: up to spacing, brackets that change nothing, and places spelled out."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction
from typing import TypeVar

from codegen.compiled import code
from codegen.generate import Listing
from codegen.instructions import Instruction
from codegen.models import Model
from codegen.setup import Setup
from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.facts import is_host_comment
from codegen.twoletter.nodes import (
    EXPRESSIONS,
    Argument,
    Assign,
    Axes,
    Binary,
    Broken,
    Command,
    Comment,
    Element,
    Empty,
    Expression,
    Formatted,
    Function,
    Group,
    Label,
    Line,
    Negative,
    Nothing,
    Number,
    SegmentSpeed,
    Statement,
    Target,
)
from codegen.twoletter.parse import parse
from codegen.twoletter.rows import Takes

T = TypeVar("T", bound=Expression)
AXES = "XYZW"
ALL_AXES = ("BG", "AM", "MC", "AS", "SH", "MO", "HM", "FE", "FI", "AL", "CM")  # no letter: the only axis
ENDS = ("EN", "RE", "RI")  # an empty place is 0: EN,1 is EN 0,1 (dmc-1412-1414.txt l.3579, l.5371)
ZERO = ("RE", "RI", "ZS")  # no number: 0 (the table's default)


def bare(expression: Expression) -> Expression:
    """The expression without brackets: its tree says already in which order it is worked out."""
    match expression:
        case Group(inner):
            return bare(inner)
        case Negative(operand):
            return dataclasses.replace(expression, operand=bare(operand))
        case Binary(_, left, right):
            return dataclasses.replace(expression, left=bare(left), right=bare(right))
        case Function(_, argument):
            return dataclasses.replace(expression, argument=bare(argument))
        case Element(_, index) if index is not None:
            return dataclasses.replace(expression, index=bare(index))
        case _:
            return expression


def _bare_argument(argument: Argument) -> Argument:
    match argument:
        case SegmentSpeed(value):
            return dataclasses.replace(argument, value=bare(value))
        case Formatted(expression):
            return dataclasses.replace(argument, expression=bare(expression))
        case Target(_, line) if line is not None:
            return dataclasses.replace(argument, line=bare(line))
        case _ if isinstance(argument, EXPRESSIONS):
            return bare(argument)
        case _:
            return argument


def plain(statements: Iterable[Statement], model: Model) -> list[Statement]:
    """Statements for comparing: every axis on its own, what is understood written out, remarks left out."""
    return [part for each in statements for part in _plain(each, model)]


def _plain(statement: Statement, model: Model) -> Iterator[Statement]:
    match statement:
        case Nothing():
            return
        case Comment(mark) if mark != "NO":
            return
        case Comment(mark, text):
            yield Comment(mark, " ".join(text.split()))
        case Assign(target, value):
            place = bare(target) if isinstance(target, Element) else target
            yield dataclasses.replace(statement, target=place, value=bare(value))  # type: ignore[arg-type]
        case Command():
            whole = dataclasses.replace(
                statement,
                arguments=tuple(map(_bare_argument, statement.arguments)),
                index=None if statement.index is None else bare(statement.index),
            )
            yield from _by_axis(_written_out(whole, model))
        case _:
            yield statement


def _written_out(command: Command, model: Model) -> Command:
    """`BG` of a one-axis controller is `BG X`, `RE` is `RE 0`, `EN,1` is `EN 0,1`, `II 1` is `II 1,1`."""
    arguments = command.arguments
    if not arguments and len(model.axes) == 1 and command.name in ALL_AXES:
        return dataclasses.replace(command, arguments=(Axes(model.axes),))
    if not arguments and command.name == "ST" and model.family == "dmc141x":  # motion only (l.2814)
        return dataclasses.replace(command, arguments=(Axes(model.axes),))
    if not arguments and command.name in ZERO:
        return dataclasses.replace(command, arguments=(Number(0, "0"),))
    if command.name in ENDS:
        written = (Number(0, "0") if isinstance(each, Empty) else each for each in arguments)
        return dataclasses.replace(command, arguments=tuple(written))
    if command.name == "II" and len(arguments) == 1 and isinstance(arguments[0], Number) and arguments[0].scaled:
        return dataclasses.replace(command, arguments=(arguments[0], arguments[0]))
    return command


def _by_axis(command: Command) -> Iterator[Command]:
    """`PR 1,2` sets what `PR 1` and `PR ,2` set one after the other."""
    row = COMMANDS.get(command.name)
    if row is None or row.takes is not Takes.AXIS_NUMBERS or command.axis is not None:
        yield command
        return
    given = [place for place, argument in enumerate(command.arguments) if not isinstance(argument, Empty)]
    if len(given) < 2 or not all(isinstance(command.arguments[place], EXPRESSIONS) for place in given):
        yield command
        return
    for place in given:
        yield dataclasses.replace(command, arguments=(*[Empty()] * place, command.arguments[place]))


def statements_of(lines: Iterable[str]) -> list[Statement]:
    """The statements of some lines."""
    text = "\n".join(lines)
    return [statement for _, statement in parse(text).statements()] if text else []


def makes(instructions: Sequence[Instruction], wanted: Sequence[Statement], setup: Setup) -> bool:
    """Whether instructions write exactly these statements."""
    lines: list[str] = []
    for each in instructions:
        made = code(each, setup)
        if not made:
            return False
        lines += made
    return plain(statements_of(lines), setup.limits) == plain(wanted, setup.limits)


def same_program(source: str, listing: Listing, model: Model) -> bool:
    """Whether a listing is the source: what the frame of a program adds (its label, its EN) may come in between."""
    wanted = _program(source, model)
    at = 0
    for line in listing.lines:
        parts = line.parts or (line,)
        for part in parts:
            for statement in _program(part.text, model):
                if at < len(wanted) and statement == wanted[at]:
                    at += 1
                elif part.step or not _of_the_frame(statement):
                    return False
    return at == len(wanted)


def _of_the_frame(statement: Statement) -> bool:
    return isinstance(statement, Label) or statement == Command("EN")


def _program(text: str, model: Model) -> list[Statement]:
    lines = (line for line in parse(text).lines if not is_host_comment(line) and not refused(line, model))
    return plain((statement for line in lines for statement in line.statements), model)


def refused(line: Line, model: Model) -> bool:
    """Whether no program can hold the line: it is kept in a step of its own, which says what is wrong with it."""
    return len(line.text) > model.columns or any(isinstance(each, Broken) for each in line.statements)


def exact(number: Number) -> Fraction:
    """A literal as it was written; a hexadecimal one as the controller holds it."""
    text = number.text.strip()
    try:
        return Fraction(text)
    except ValueError:
        return Fraction(number.scaled, 65536)
