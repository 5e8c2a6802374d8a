"""MG and IN: what the controller says to its operator and asks of him."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Final, TypeAlias

from codegen.twoletter.evaluate import compile_expression
from codegen.twoletter.fixed import ONE, read_number, string_value
from codegen.twoletter.nodes import (
    Character,
    Command,
    Element,
    Formatted,
    NoLineEnd,
    String,
    Variable,
)
from codegen.twoletter.nodes import Port as PortItem
from device.simulator.twoletter import memory
from device.simulator.twoletter.state import CommandError, Port, Strand, Wait

if TYPE_CHECKING:
    from device.simulator.twoletter.compile import Code
    from device.simulator.twoletter.unit import Unit

Op: TypeAlias = Callable[[Strand], int]
NOT_MAIN, NO_VARIABLE = 71, 25


def message(command: Command, following: int, unit: Unit, code: Code | None) -> Op:
    """MG: its items one after the other, then CR LF unless {N} (dmc-1412-1414.txt l.3646)."""
    pieces: list[Callable[[], str]] = []
    port, line_end = 1, "\r\n"
    for item in command.arguments:
        if isinstance(item, PortItem):
            port = item.number
        elif isinstance(item, NoLineEnd):
            line_end = ""
        else:
            pieces.append(_piece(item, unit))

    def op(strand: Strand) -> int:
        text = "".join(piece() for piece in pieces) + line_end
        if isinstance(strand, Port) and strand.number == port and not unit.profile.typed_message_marked:
            unit.reply(port, text.encode("latin-1"))
        else:
            unit.unsolicited(port, text)
        return following

    return op


def _piece(item: object, unit: Unit) -> Callable[[], str]:
    if isinstance(item, String):
        text = item.text
        return lambda: text
    if isinstance(item, Character):
        character = chr(item.code)
        return lambda: character
    form = item.format if isinstance(item, Formatted) else None
    expression = item.expression if isinstance(item, Formatted) else item
    value, names = compile_expression(expression), unit.names
    return lambda: unit.formatted(value(names), form)


def ask(command: Command, following: int, unit: Unit, code: Code | None) -> Op:
    """IN: sends the prompt and waits for a number or a text; only thread 0 (dmc-1412-1414.txt l.3480)."""
    port = next((item.number for item in command.arguments if isinstance(item, PortItem)), 1)
    prompt = next((item.text for item in command.arguments if isinstance(item, String)), "")
    target, characters = _answer_place(command)
    index = compile_expression(target.index) if isinstance(target, Element) and target.index is not None else None
    name = target.name if target is not None else ""

    def op(strand: Strand) -> int:
        if strand.number != 0:
            raise CommandError(NOT_MAIN)
        if not name:
            raise CommandError(NO_VARIABLE)
        element = -1 if index is None else index(unit.names) // ONE
        if element >= 0:
            memory.element(unit.state, name, element)
        unit.unsolicited(port, prompt + ("\r\n" if unit.profile.prompt_ends_line else ""), ends=True)
        strand.wait = Wait("input", number=port, variable=name, element=element, characters=characters)
        unit.changed = True
        return following

    return op


def _answer_place(command: Command) -> tuple[Variable | Element | None, int]:
    for item in command.arguments:
        if isinstance(item, Formatted) and isinstance(item.expression, Variable | Element):
            return item.expression, item.format.digits or 6
        if isinstance(item, Variable | Element):
            return item, 0
    return None, 0


def answer_input(unit: Unit, wait: Wait, text: str) -> None:
    """Puts an answer to IN where it belongs; an empty one keeps the old value (SSC manual l.2390)."""
    if not text:
        if wait.element < 0 and wait.variable not in unit.state.variables:
            memory.set_variable(unit.state, unit.model, wait.variable, 0)
        return
    if wait.characters:
        value = string_value(text[: wait.characters])
    else:
        number = read_number(text)
        if number is None:
            raise CommandError(unit.profile.bad_input_code)
        value = number
    if wait.element >= 0:
        memory.set_element(unit.state, wait.variable, wait.element, value)
        return
    memory.set_variable(unit.state, unit.model, wait.variable, value)
    if wait.characters:
        unit.state.strings.add(wait.variable)
    else:
        unit.state.strings.discard(wait.variable)


COMPILES: Final = {"MG": message, "IN": ask}
