"""What is said to the operator, and asked."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence

from codegen.instructions import ClearScreen, Instruction, Print, UserInterface
from codegen.instructions.operator import AnswerKind, ItemKind, Port, PrintItem, Shape
from codegen.instructions.tasks import Terminal
from codegen.setup import Setup
from codegen.twoletter.lift.values import text_of
from codegen.twoletter.nodes import (
    EXPRESSIONS,
    Argument,
    Character,
    Command,
    Element,
    Formatted,
    NoLineEnd,
    Number,
    String,
    Variable,
)
from codegen.twoletter.nodes import Port as PortNode

SHAPES: Mapping[str, Shape] = {"F": Shape.DECIMAL, "$": Shape.HEXADECIMAL, "S": Shape.STRING}
SCREENS: Mapping[tuple[object, ...], Terminal] = {
    (27, "E"): Terminal.HANDHELD,
    (27, "[2J", 27, "[H"): Terminal.ANSI,
}


def _port(arguments: Sequence[Argument]) -> tuple[Port, Sequence[Argument]]:
    """The port, and what follows it."""
    if arguments and isinstance(arguments[0], PortNode):
        return Port.AUXILIARY if arguments[0].number == 2 else Port.MAIN, arguments[1:]
    return Port.MAIN, arguments


def message(statement: Command, setup: Setup) -> Instruction | None:
    """MG; escape sequences that clear a screen are told as such."""
    port, arguments = _port(statement.arguments)
    same_line = bool(arguments) and isinstance(arguments[-1], NoLineEnd)
    arguments = arguments[:-1] if same_line else arguments
    spelled = tuple(
        each.code if isinstance(each, Character) else each.text if isinstance(each, String) else None
        for each in arguments
    )
    if same_line and spelled in SCREENS:
        return ClearScreen(port=port, terminal=SCREENS[spelled])
    items = [_item(each, setup) for each in arguments]
    found = tuple(each for each in items if each is not None)
    if not found or len(found) < len(items):
        return None
    return Print(port=port, items=found, same_line=same_line)


def _item(argument: Argument, setup: Setup) -> PrintItem | None:
    match argument:
        case String(text):
            return PrintItem(kind=ItemKind.TEXT, text=text)
        case Character(code):
            return PrintItem(kind=ItemKind.CHARACTER, character=str(code))
        case Formatted(expression, form):
            text = text_of(expression, setup)
            item = PrintItem(kind=ItemKind.VALUE, expression=text, shape=SHAPES[form.kind])
            if form.kind == "S":
                return dataclasses.replace(item, length=str(form.digits or 6)) if text else None
            return dataclasses.replace(item, digits=str(form.digits), decimals=str(form.decimals)) if text else None
        case Number():
            return PrintItem(kind=ItemKind.VALUE, expression=text_of(argument, setup), shape=Shape.PLAIN)
        case _ if isinstance(argument, EXPRESSIONS):
            text = text_of(argument, setup)
            return PrintItem(kind=ItemKind.VALUE, expression=text, shape=Shape.PLAIN) if text else None
        case _:
            return None


def ask(statement: Command, setup: Setup) -> Instruction | None:
    """IN with a prompt and a variable, for a number or a text."""
    port, arguments = _port(statement.arguments)
    match arguments:
        case (String(text=prompt), Variable() | Element() as place):
            return UserInterface(port=port, prompt=prompt, variable=text_of(place, setup))
        case (String(text=prompt), Formatted(Variable() | Element() as place, form)) if form.kind == "S":
            return UserInterface(
                port=port,
                prompt=prompt,
                variable=text_of(place, setup),
                answer=AnswerKind.TEXT,
                length=str(form.digits or 6),
            )
    return None
