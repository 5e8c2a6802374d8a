"""Modes of what is printed and asked."""

from __future__ import annotations

from codegen.instructions import (
    ClearScreen,
    Print,
    UserInterface,
)
from codegen.instructions.operator import AnswerKind, ItemKind, Port, PrintItem, Shape
from codegen.instructions.tasks import Terminal
from tests.codegen.modes.bench import Mode, code
from tests.codegen.modes.oracles import both, prints, sees, silent


def text(words: str) -> PrintItem:
    return PrintItem(text=words)


def shown(expression: str, shape: Shape, **more: str) -> PrintItem:
    return PrintItem(kind=ItemKind.VALUE, expression=expression, shape=shape, **more)


SCREENS = (
    Mode(
        Print(items=(text("CUT "), shown("LEN", Shape.DECIMAL, digits="3", decimals="1"))),
        'Print "CUT ", LEN',
        prints("CUT  012.5\r\n"),
        first=(code("LEN=12.5"),),
    ),
    Mode(
        Print(port=Port.AUXILIARY, items=(shown("LEN", Shape.HEXADECIMAL, digits="4", decimals="0"),)),
        "Print LEN on the auxiliary port",
        both(prints("$00FF\r\n", 2), silent(1)),
        first=(code("CC 9600,0,0,0\nLEN=255"),),
    ),
    Mode(
        Print(items=(text("A"), PrintItem(kind=ItemKind.CHARACTER, character="66"), text("C")), same_line=True),
        'Print "A", character 66, "C", without a line end',
        sees(lambda b, a: a.sent[1] == "ABC"),
    ),
    Mode(
        Print(items=(shown("NAME", Shape.STRING, length="4"), shown("LEN", Shape.PLAIN))),
        "Print NAME, LEN",
        prints("WIRE 0000000002.5000\r\n"),  # VF 10.4
        first=(code('NAME="WIRE"\nLEN=2.5'),),
    ),
    Mode(
        ClearScreen(port=Port.AUXILIARY, terminal=Terminal.HANDHELD),
        "Clear the screen of the operator terminal on the auxiliary port",
        sees(lambda b, a: a.sent[2] == "\x1bE"),
        first=(code("CC 9600,0,0,0"),),
    ),
    Mode(
        ClearScreen(port=Port.MAIN, terminal=Terminal.ANSI),
        "Clear the screen of the terminal window",
        sees(lambda b, a: a.sent[1] == "\x1b[2J\x1b[H"),
    ),
    Mode(
        UserInterface(prompt="LENGTH?", variable="LEN"),
        'Ask "LENGTH?" and keep the answer in LEN',
        both(sees(lambda b, a: a["LEN"] == 3.5 and b["LEN"] == 1 and a.waited > 250), prints("LENGTH?")),
        first=(code("LEN=1"),),
        world=((0.4, "type", "3.5\\r"),),
    ),
    Mode(
        UserInterface(port=Port.AUXILIARY, prompt="NAME?", variable="WHO", answer=AnswerKind.TEXT, length="3"),
        'Ask "NAME?" on the auxiliary port and keep the answer in WHO (3 characters)',
        both(prints("NAME?", 2), sees(lambda b, a: a.typed("MG WHO{S6}") == "BOB")),
        first=(code('CC 9600,0,0,0\nWHO="X"'),),
        world=((0.4, "type2", "BOB\\r"),),
    ),
)

MODES = (*SCREENS,)
