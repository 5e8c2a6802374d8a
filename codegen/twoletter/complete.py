"""What can be typed at a place in a line, and what the command there takes: all from the table."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

from codegen.models import Model
from codegen.twoletter.checks.numbers import format_number_of, range_text
from codegen.twoletter.commands import ALL, COMMANDS, FUNCTIONS, KEYWORDS
from codegen.twoletter.facts import gather
from codegen.twoletter.nodes import Line, Source
from codegen.twoletter.rows import BY_AXIS, Row, Takes

Kind = Literal["command", "label", "variable", "array", "keyword", "function", "operand"]

_HOST_COMMENT = re.compile(r"[ \t]*(?:REM(?![A-Za-z0-9])|')").match
_WORD = re.compile(r"(?:#[ \t]*[A-Za-z0-9]*|[_@][A-Za-z0-9]*|[A-Za-z][A-Za-z0-9]*)\Z")
_OPENING = re.compile(r"[ \t]*([A-Z]{2})").match
_ASSIGNED = re.compile(r"[ \t]*([A-Za-z][A-Za-z0-9]*)[ \t]*(?:\[[^\]]*\][ \t]*)?=").match


@dataclass(frozen=True, slots=True)
class Candidate:
    """One thing that can be typed: it replaces the columns `start` to `end`."""

    text: str
    title: str
    help: str
    kind: Kind
    start: int
    end: int


@dataclass(frozen=True, slots=True)
class Parameter:
    """One place of a command's arguments."""

    name: str
    help: str
    range: str
    default: str


@dataclass(frozen=True, slots=True)
class ParameterHelp:
    """What the command at the cursor takes; `current` is the number of the place the cursor is in."""

    command: str
    title: str
    help: str
    takes: str
    example: str
    parameters: tuple[Parameter, ...]
    current: int


@dataclass(frozen=True, slots=True)
class Names:
    """Names of a source text, for completion."""

    labels: tuple[str, ...] = ()
    variables: tuple[str, ...] = ()
    arrays: tuple[str, ...] = ()


def names_of(lines: Iterable[Line], model: Model) -> Names:
    """The labels, variables and arrays a source uses."""
    facts = gather(Source(tuple(lines)), model)
    variables = dict.fromkeys(node.name for _, node in facts.assigned + facts.read)
    arrays = dict.fromkeys(node.name for _, node in facts.elements)
    return Names(tuple(facts.labels), tuple(variables), tuple(arrays))


def _statement_start(line: str, column: int) -> int | None:
    """Where the statement at the column begins; None inside quotes and comments."""
    if _HOST_COMMENT(line):
        return None
    start, quoted = 0, False
    for place, sign in enumerate(line[:column]):
        if sign == '"':
            quoted = not quoted
        elif sign == ";" and not quoted:
            start = place + 1
    opening = _OPENING(line, start)
    if quoted or (opening and opening[1] == "NO" and not _ASSIGNED(line, start) and column > opening.end()):
        return None
    return start


def complete(
    line: str, column: int, model: Model, names: Names | None = None, variables: Iterable[str] = ()
) -> list[Candidate]:
    """What fits at the column, best first; nothing inside quotes and comments."""
    start = _statement_start(line, column)
    if start is None:
        return []
    names = names or Names()
    head = line[start:column]
    match = _WORD.search(head)
    word = match[0] if match else ""
    begin = column - len(word)
    if not head[: len(head) - len(word)].strip():
        found = _commands(model) + _names(names, variables)
    elif word.startswith("#"):
        found = [("#" + each, "Label", "", "label") for each in names.labels]
    elif word.startswith("_"):
        found = _operands(model)
    elif word.startswith("@"):
        found = [
            (f"@{row.name}[", row.title, row.help, "function")
            for row in FUNCTIONS.values()
            if model.family in row.families
        ]
    else:
        found = _values(head, names, model, variables)
    typed = re.sub(r"\s", "", word).upper()
    return [
        Candidate(text, title, help_text, kind, begin, column)
        for text, title, help_text, kind in found
        if text.upper().startswith(typed) and text != word
    ]


_Found = tuple[str, str, str, Kind]


def _commands(model: Model) -> list[_Found]:
    """The commands of the model that can stand in a program."""
    return [
        (row.name, row.title, row.help, "command")
        for row in ALL
        if row.known_to(model) and row.program and row.takes not in (Takes.OPERAND, Takes.BYTES)
    ]


def _names(names: Names, extra: Iterable[str]) -> list[_Found]:
    found: list[_Found] = [(each, "Variable", "", "variable") for each in dict.fromkeys((*names.variables, *extra))]
    found += [(each + "[", "Array", "", "array") for each in names.arrays]
    return found


def _operands(model: Model) -> list[_Found]:
    """`_TPX` and its like, for every axis of the model."""
    found: list[_Found] = []
    for row in ALL:
        if row.operand is None or not row.known_to(model):
            continue
        name = row.name if row.name.startswith("_") else "_" + row.name
        suffixes = tuple(model.axes) if row.operand.startswith("axis") else ("",)
        if row.operand == "thread":
            suffixes = tuple(str(number) for number in range(model.threads))
        if row.operand == "axis_s" and model.coordinated:
            suffixes = (*suffixes, "S")
        found += [(name + suffix, row.title, row.operand_help or row.help, "operand") for suffix in suffixes]
    return found


def _values(head: str, names: Names, model: Model, variables: Iterable[str]) -> list[_Found]:
    """What can stand in an expression, or labels where a jump wants one."""
    opening = _OPENING(head)
    row = COMMANDS.get(opening[1]) if opening and not _ASSIGNED(head) else None
    found: list[_Found] = []
    if row is not None and row.takes is Takes.TARGET and "," not in head:
        found += [("#" + each, "Label", "", "label") for each in names.labels]
    if row is not None and row.takes in (Takes.AXES, Takes.AXES_S, Takes.NONE, Takes.AXIS, Takes.PLANE):
        return found
    found += _names(names, variables)
    found += [
        (each.name, each.title, each.help, "keyword") for each in KEYWORDS.values() if model.family in each.families
    ]
    found += [
        (f"@{each.name}[", each.title, each.help, "function")
        for each in FUNCTIONS.values()
        if model.family in each.families
    ]
    return found + _operands(model)


def parameter_help(line: str, column: int, model: Model) -> ParameterHelp | None:
    """What the command at the column takes; None where there is no command."""
    start = _statement_start(line, column)
    if start is None or (_ASSIGNED(line, start) and not line[start:].lstrip().startswith("ET[")):
        return None
    opening = _OPENING(line, start)
    row = COMMANDS.get(opening[1]) if opening else None
    if opening is None or row is None or column < opening.end():
        return None
    return help_of(row, model, _place(line[opening.end() : column]))


def help_of(row: Row, model: Model, current: int = 0) -> ParameterHelp:
    """Everything about a command's arguments on that model."""
    return ParameterHelp(row.name, row.title, row.help, row.takes.value, row.example, _parameters(row, model), current)


def _place(arguments: str) -> int:
    """The number of the comma list's place at the end of the text."""
    depth = place = 0
    quoted = False
    for sign in arguments:
        if sign == '"':
            quoted = not quoted
        elif quoted:
            continue
        elif sign in "([{":
            depth += 1
        elif sign in ")]}":
            depth -= 1
        elif sign == "," and depth <= 0:
            place += 1
    return place


def _parameters(row: Row, model: Model) -> tuple[Parameter, ...]:
    fields = row.fields_for(model)
    target = (Parameter("target", "label or line", "", ""),) if row.takes is Takes.TARGET else ()
    if fields:
        return target + tuple(
            Parameter(place.name, place.help, range_text(place, model), _text(place.default)) for place in fields
        )
    if row.takes in BY_AXIS:
        limits = range_text(row, model)
        return tuple(Parameter(axis, f"axis {axis}", limits, _text(row.default)) for axis in model.axes)
    if row.most and row.takes is Takes.NUMBERS:
        return (Parameter("n", row.help, range_text(row, model), _text(row.default)),)
    return target


def _text(value: object) -> str:
    if value is None:
        return ""
    return format_number_of(value) if isinstance(value, int | float) else str(value)
