"""Compiles program lines to small callables, each when it first runs: it does one command and says where to go on."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final, TypeAlias

from codegen.twoletter.commands import FREE
from codegen.twoletter.evaluate import compile_expression
from codegen.twoletter.nodes import (
    Assign,
    Broken,
    Command,
    Comment,
    Element,
    Foreign,
    Label,
    Nothing,
    Print,
    Statement,
    String,
    Variable,
)
from codegen.twoletter.parse import parse_line
from device.simulator.twoletter import memory
from device.simulator.twoletter.arithmetic import rewritten
from device.simulator.twoletter.calls import command_op
from device.simulator.twoletter.state import CommandError, Strand

if TYPE_CHECKING:
    from device.simulator.twoletter.unit import Unit

Op: TypeAlias = Callable[[Strand], int]
ASSIGNED: Final = re.compile(r"[A-Za-z0-9 \t]*[=\[]").match

__all__ = ["Code", "Op", "compile_line", "compile_program"]


@dataclass(slots=True)
class Code:
    """A compiled program: one op a command, in a row."""

    lines: tuple[str, ...] = ()
    ops: list[Op] = field(default_factory=list)
    line_of: list[int] = field(default_factory=list)
    start_of: list[int] = field(default_factory=list)  # line → its first op
    labels: dict[str, int] = field(default_factory=dict)  # name → op

    def line(self, pc: int) -> int:
        """The line of an op; the one behind the last for the end."""
        return self.line_of[pc] if pc < len(self.line_of) else len(self.lines)


def compile_program(lines: tuple[str, ...], unit: Unit) -> Code:
    """The whole program: labels and places now, each statement when it first runs, so a download ends quickly."""
    code = Code(lines=lines)
    for number, text in enumerate(lines):
        code.start_of.append(len(code.ops))
        for statement in parse_line(text, unit.profile.bracket_levels).statements:
            if isinstance(statement, Label):
                code.labels.setdefault(statement.name, len(code.ops))
            elif takes_time(statement):
                code.line_of.append(number)
                code.ops.append(_when_run(statement, len(code.ops), unit, code))
    code.ops.append(_off_the_end(unit))
    return code


def _when_run(statement: Statement, pc: int, unit: Unit, code: Code) -> Op:
    """Takes the place of an op until it is needed."""

    def op(strand: Strand) -> int:
        compiled = code.ops[pc] = compile_statement(statement, pc + 1, unit, code, from_port=False)
        return compiled(strand)

    return op


def compile_line(text: str, unit: Unit) -> list[Op]:
    """A line from a port; each op is one prompt."""
    found: list[Statement] = [
        item for item in parse_line(text, unit.profile.bracket_levels).statements if not isinstance(item, Nothing)
    ]
    found = found or [Nothing()]
    return [
        compile_statement(statement, index + 1, unit, None, from_port=True) for index, statement in enumerate(found)
    ]


def takes_time(statement: Statement) -> bool:
    """Labels and empty statements cost no command time."""
    return not isinstance(statement, Label | Nothing)


def compile_statement(statement: Statement, following: int, unit: Unit, code: Code | None, *, from_port: bool) -> Op:
    """One statement as an op that answers `following` or where it jumps to."""
    by_axis = unit.profile.axis_assignment == "command"
    if unit.worked_out or by_axis:
        statement = rewritten(statement, unit.worked_out, axis_assignments=by_axis)
    if isinstance(statement, Broken | Foreign):
        return _refuse(1 if _is_of_another_model(statement.text, unit) else statement.code)
    if isinstance(statement, Comment) and statement.mark != "NO":
        return _refuse(1)  # the host's comments mean nothing to a controller
    if isinstance(statement, Command):
        return command_op(statement, following, unit, code, from_port=from_port)
    if isinstance(statement, Assign | Print) and _is_command(statement.target, unit):
        return _refuse(1)
    if isinstance(statement, Assign):
        return _assign(statement, following, unit)
    if isinstance(statement, Print):
        return _print(statement, following, unit)
    if isinstance(statement, Label) and from_port:
        return _refuse(1)
    return lambda strand: following


def _is_command(target: object, unit: Unit) -> bool:
    """VS= where VS is a command of this controller; it is a variable where there is none (dmc-1412-1414.txt l.3245)."""
    return isinstance(target, Variable) and target.name in FREE and unit.rows[target.name].known_to(unit.model)


def _is_of_another_model(text: str, unit: Unit) -> bool:
    """A command that this controller does not know is never read far enough for its arguments to be wrong."""
    row = unit.rows.get(text[:2])
    return row is not None and not row.known_to(unit.model) and not ASSIGNED(text)


def _refuse(code: int) -> Op:
    def op(strand: Strand) -> int:
        raise CommandError(code)

    return op


def _off_the_end(unit: Unit) -> Op:
    def op(strand: Strand) -> int:
        raise CommandError(unit.profile.off_the_end_code)

    return op


def _assign(statement: Assign, following: int, unit: Unit) -> Op:
    is_text = isinstance(statement.value, String)
    if isinstance(statement.target, Element):
        return _assign_element(statement, statement.target, following, unit)
    name, names, model = statement.target.name, unit.names, unit.model
    value = compile_expression(statement.value)

    def op(strand: Strand) -> int:
        state = unit.state
        result = value(names)
        if name in state.variables:
            state.variables[name] = result
        else:
            memory.set_variable(state, model, name, result)
        if is_text:
            state.strings.add(name)
        elif state.strings:
            state.strings.discard(name)
        return following

    return op


def _assign_element(statement: Assign, target: Element, following: int, unit: Unit) -> Op:
    if target.index is None:
        return _refuse(memory.BAD_INDEX)
    name, names = target.name, unit.names
    index, value = compile_expression(target.index), compile_expression(statement.value)

    def op(strand: Strand) -> int:
        memory.set_element(unit.state, name, index(names) >> 16, value(names))
        return following

    return op


def _print(statement: Print, following: int, unit: Unit) -> Op:
    if not isinstance(statement.target, Variable | Element):
        return _refuse(1)
    value, names, form = compile_expression(statement.target), unit.names, statement.format

    def op(strand: Strand) -> int:
        unit.answer(strand, unit.formatted(value(names), form))
        return following

    return op
