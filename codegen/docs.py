"""Help pages of the instructions, written from their rows."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

from codegen.fields import (
    AxisName,
    AxisSet,
    Choice,
    Condition,
    ExpressionField,
    Field,
    Flag,
    ListOf,
    Number,
    PerAxis,
    Quantity,
    Table,
    Text,
    fields_of,
)
from codegen.generate import code
from codegen.instructions import ALL, Instruction
from codegen.numbers import plain
from codegen.read import sentence
from codegen.setup import Axis, Setup
from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.nodes import Command
from codegen.twoletter.parse import parse_line

SECTIONS = {
    "C": "It belongs to the configuration.",
    "M": "It belongs to the main program or to a subroutine.",
    "C/M": "It may stand in the configuration or in the program.",
    "S": "It opens a subroutine.",
}
EXAMPLE_SETUP = Setup(axes=(Axis(counts_per_unit="4000"),) * 4)


def pages() -> dict[str, str]:
    """All help pages by title, in Markdown."""
    return {kind.title: page(kind) for kind in ALL}


def page(kind: type[Instruction]) -> str:
    """One help page in Markdown: what it is for, its fields, an example with its code."""
    parts = [f"# {kind.title}", f"*Group: {kind.group}.* {SECTIONS[kind.section]}", kind.help]
    if fields := fields_of(kind):
        parts.append("## Fields\n\n" + "\n".join(_field_line(name, field, kind) for name, field in fields.items()))
    parts.append(_example(kind.example()))
    return "\n\n".join(parts) + "\n"


def command_page(line: str, column: int) -> str:
    """The place in the help of the command at a column of a line of code: `Commands: Motion#PR`; "" without one."""
    for statement in parse_line(line).statements:
        if isinstance(statement, Command) and statement.span.start <= column <= statement.span.end:
            return f"Commands: {COMMANDS[statement.name].group}#{statement.name}:"
    return ""


def field_page(title: str, label: str) -> str:
    """The place in the help of a field of an instruction."""
    return f"{title}#{label}"


def _example(instruction: Instruction) -> str:
    lines = code(instruction, EXAMPLE_SETUP)
    listing = "\n".join(lines) if lines else "(no code)"
    commands = _commands(lines)
    text = f"## Example\n\n{sentence(instruction, EXAMPLE_SETUP)}\n\n```\n{listing}\n```"
    return f"{text}\n\n{commands}" if commands else text


def _commands(lines: tuple[str, ...]) -> str:
    names = dict.fromkeys(line[:2] for line in lines if line[:2] in COMMANDS and "=" not in line[:3])
    return "\n".join(f"- `{name}` {COMMANDS[name].title}" for name in names)


def _field_line(name: str, field: Field, kind: type[Any]) -> str:
    """`- **Distance** (a distance): How far. Shown when Move is "By a distance".`"""
    text = f"- **{field.label}** ({_kind_words(field)}): {field.help}"
    if field.when:
        text += " " + _when_words(field.when, kind)
    if isinstance(field, ListOf):
        rows = "\n".join("  " + _field_line(inner, each, field.row) for inner, each in fields_of(field.row).items())
        text += "\n" + rows
    return text


def _when_words(when: Mapping[str, Any], kind: type[Any]) -> str:
    conditions: list[str] = []
    for sibling, wanted in when.items():
        field = fields_of(kind)[sibling]
        values = wanted if isinstance(wanted, tuple) else (wanted,)
        words = " or ".join(f'"{_value_words(field, value)}"' for value in values)
        conditions.append(f"{field.label} is {words}")
    return f"Shown when {' and '.join(conditions)}."


def _value_words(field: Field, value: Any) -> str:
    if isinstance(field, Choice):
        return field.words.get(value, str(value))
    return "on" if value is True else "off" if value is False else str(value)


def _kind_words(field: Field) -> str:
    """What may be entered."""
    match field:
        case PerAxis(of=inner):
            return f"for each axis, {_kind_words(inner)}"
        case Quantity(dimension=dimension, literal=literal):
            return f"{dimension}, a number" if literal else f"{dimension}, a number or an expression"
        case Number(low=low, high=high, literal=literal):
            span = f"{plain(Fraction(str(low)))} to {plain(Fraction(str(high)))}" if high < 2**31 - 1 else "a number"
            return span if literal else f"{span}, or an expression"
        case Choice(kind=kind, words=words):
            return "; ".join(words.get(member, member.value) for member in kind)
        case Flag():
            return "on or off"
        case AxisName():
            return "one axis"
        case AxisSet():
            return "one or more axes"
        case Condition():
            return "a condition"
        case ExpressionField():
            return "an expression"
        case ListOf():
            return "rows"
        case Table():
            return "a table of plain numbers"
        case Text():
            return "text"
        case _:
            return "a name or number"
