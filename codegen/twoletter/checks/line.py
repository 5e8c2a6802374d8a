"""Checks that need one line only: what the parser refused, and what the table says about each command."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache

from codegen.models import Model
from codegen.twoletter.checks.numbers import number_problems
from codegen.twoletter.checks.rules import RULES
from codegen.twoletter.commands import COMMANDS, FREE, FUNCTIONS, LATER
from codegen.twoletter.facts import expressions_of, is_host_comment, walk
from codegen.twoletter.format import format_argument
from codegen.twoletter.nodes import (
    Argument,
    Assign,
    Axes,
    Broken,
    Command,
    Empty,
    Foreign,
    Format,
    Function,
    Operand,
    Print,
    SegmentSpeed,
    Span,
    Statement,
    Variable,
)
from codegen.twoletter.parse import parse_line
from codegen.twoletter.problems import Problem
from codegen.twoletter.rows import BY_AXIS, Row, Takes

UNKNOWN = 1  # the error code of what is no command at all


@lru_cache(maxsize=16384)
def line_problems(text: str, model: Model) -> tuple[Problem, ...]:
    """The problems of one line, as if it were line 0."""
    line = parse_line(text)
    if is_host_comment(line):
        return ()
    problems = [*line_length(text, model), *plain_characters(text)]
    for statement in line.statements:
        problems += refused(text, statement, model)
        problems += known_values(statement, model)
        problems += assigned_command(statement, model)
        if isinstance(statement, Command):
            row = COMMANDS[statement.name]
            problems += known_command(statement, row, model)
            problems += valid_in_program(statement, row)
            problems += axis_form(statement, model)
            problems += axes_of_model(statement, row, model)
        problems += number_problems(statement, model)
    return tuple(problems)


def line_length(text: str, model: Model) -> Iterator[Problem]:
    """Characters of a stored line: 80 or 40."""
    if len(text) > model.columns:
        yield RULES["line-too-long"].problem(0, model.columns, len(text), length=len(text), limit=model.columns)


def plain_characters(text: str) -> Iterator[Problem]:
    """The first character that the line cannot carry."""
    for column, letter in enumerate(text):
        if not " " <= letter <= "~" and letter != "\t":
            yield RULES["plain-characters"].problem(0, column, column + 1, letter=letter)
            return


def refused(text: str, statement: Statement, model: Model) -> Iterator[Problem]:
    """What the parser did not understand, at the exact place; of a command that is not there, that it is not."""
    if not isinstance(statement, Broken | Foreign) or statement.rule == "line-too-long":
        return
    row = COMMANDS.get(text[statement.span.start : statement.span.start + 2])
    if row is not None and statement.code != UNKNOWN and not row.known_to(model):
        start = statement.span.start
        yield RULES["not-on-model"].problem(0, start, start + 2, text=row.name, model=model.title)
        return
    place = statement.place
    spot = text[place.start : place.end].strip()
    yield RULES[statement.rule].problem(
        0, place.start, place.end, statement.code, text=spot, where=LATER.get(spot, "later families")
    )


def assigned_command(statement: Statement, model: Model) -> Iterator[Problem]:
    """`VS=5` where VS is a command of this controller; where it is none it is a variable (l.3245)."""
    if not isinstance(statement, Assign | Print) or not isinstance(statement.target, Variable):
        return
    name, span = statement.target.name, statement.target.span
    if name in FREE and COMMANDS[name].known_to(model):
        yield RULES["assigned-command"].problem(0, span.start, span.end, 1, text=name)


def known_command(command: Command, row: Row, model: Model) -> Iterator[Problem]:
    """Commands this controller does not have."""
    if not row.known_to(model):
        start = command.span.start
        yield RULES["not-on-model"].problem(0, start, start + len(row.name), text=row.name, model=model.title)


def valid_in_program(command: Command, row: Row) -> Iterator[Problem]:
    """Commands that are only for the terminal."""
    if not row.program:
        start = command.span.start
        yield RULES["only-from-port"].problem(0, start, start + len(row.name), text=row.name)


def axis_form(command: Command, model: Model) -> Iterator[Problem]:
    """`PRX=5` belongs to the DMC-141x and later controllers."""
    if command.axis is None or model.family == "dmc141x":
        return
    value = format_argument(command.arguments[0]) if command.arguments else ""
    instead = f"{command.name} {',' * 'XYZW'.index(command.axis)}{value}"
    start = command.span.start
    yield RULES["axis-form"].problem(0, start, start + 3, text=command.name + command.axis, instead=instead)


def axes_of_model(command: Command, row: Row, model: Model) -> Iterator[Problem]:
    """Letters and places of axes the controller does not have."""
    if command.axis is not None and command.axis not in model.axes:
        yield _no_axis(command.axis, command.span, model)
    for number, argument in enumerate(command.arguments):
        if isinstance(argument, Axes):
            letters = argument.letters[-1] if row.takes is Takes.MASTER else argument.letters
            for letter in letters:
                if letter not in model.axes and letter not in "SN":
                    yield _no_axis(letter, argument.span, model)
        elif row.takes in BY_AXIS and _is_place(argument) and number >= row.places_for(model):
            yield _no_axis("XYZW"[number], argument.span, model)


def _is_place(argument: Argument) -> bool:
    return not isinstance(argument, Empty | Format | SegmentSpeed)


def _no_axis(axis: str, span: Span, model: Model) -> Problem:
    return RULES["axis-not-on-model"].problem(0, span.start, span.end, axis=axis, axes=" ".join(model.axes))


def known_values(statement: Statement, model: Model) -> Iterator[Problem]:
    """Operands, functions and names in expressions."""
    for expression in expressions_of(statement):
        for node in walk(expression):
            match node:
                case Operand(name, suffix):
                    yield from _operand(name, suffix, node.span, model)
                case Function(name):
                    if model.family not in FUNCTIONS[name].families:
                        yield RULES["undocumented-function"].problem(0, node.span.start, node.span.end, text=name)
                case Variable(name) if name in COMMANDS:
                    row = COMMANDS[name]
                    if row.operand and row.known_to(model):
                        yield RULES["name-is-command"].problem(0, node.span.start, node.span.end, name=name)


def _operand(name: str, suffix: str, span: Span, model: Model) -> Iterator[Problem]:
    row = COMMANDS.get(name) or COMMANDS["_" + name]
    if not row.known_to(model):
        yield RULES["not-on-model"].problem(0, span.start, span.end, 58, text="_" + name, model=model.title)
    elif suffix in ("X", "Y", "Z", "W") and suffix not in model.axes:
        yield _no_axis(suffix, span, model)
