"""Instructions of the group Program Flow that talk to a person: Print and User Interface."""

# ruff: noqa: RUF009  (value() declares a field as dataclasses.field does)

from __future__ import annotations

import dataclasses as dc
from enum import StrEnum

from codegen.fields import Choice, ExpressionField, Flag, ListOf, MessageText, Number, VariableName, value
from codegen.instructions.instruction import Group, Instruction


class Port(StrEnum):
    MAIN = "main"
    AUXILIARY = "auxiliary"


PORT_WORDS = {Port.MAIN: "Main port", Port.AUXILIARY: "Auxiliary port"}
PORT_PHRASES = {Port.MAIN: "", Port.AUXILIARY: "on the auxiliary port"}


class ItemKind(StrEnum):
    TEXT = "text"
    VALUE = "value"
    CHARACTER = "character"


class Shape(StrEnum):
    PLAIN = "plain"
    DECIMAL = "decimal"
    HEXADECIMAL = "hexadecimal"
    STRING = "string"


@dc.dataclass(frozen=True, kw_only=True)
class PrintItem:
    """One thing to print."""

    sentence = "[{text}|{expression}|character {character}]"

    kind: ItemKind = value(
        Choice(
            label="Item",
            kind=ItemKind,
            words={ItemKind.TEXT: "Text", ItemKind.VALUE: "Value", ItemKind.CHARACTER: "Character"},
            help="A text, a value, or one character by its number.",
        ),
        ItemKind.TEXT,
    )
    text: str = value(
        MessageText(label="Text", most=72, when={"kind": ItemKind.TEXT}, help="What is printed, word for word."), ""
    )
    expression: str = value(
        ExpressionField(
            label="Value", when={"kind": ItemKind.VALUE}, help="A variable, a live value or an expression."
        ),
        "",
    )
    shape: Shape = value(
        Choice(
            label="Shown as",
            kind=Shape,
            words={
                Shape.PLAIN: "as variables are shown",
                Shape.DECIMAL: "decimal number",
                Shape.HEXADECIMAL: "hexadecimal number",
                Shape.STRING: "text",
            },
            when={"kind": ItemKind.VALUE},
            help="The format of the value.",
        ),
        Shape.PLAIN,
    )
    digits: str = value(
        Number(
            label="Digits",
            low=1,
            high=10,
            whole=True,
            literal=True,
            when={"shape": (Shape.DECIMAL, Shape.HEXADECIMAL)},
            help="Digits before the point.",
        ),
        "5",
    )
    decimals: str = value(
        Number(
            label="Decimals",
            low=0,
            high=4,
            whole=True,
            literal=True,
            when={"shape": (Shape.DECIMAL, Shape.HEXADECIMAL)},
            help="Digits after the point.",
        ),
        "2",
    )
    length: str = value(
        Number(
            label="Characters",
            low=1,
            high=6,
            whole=True,
            literal=True,
            when={"shape": Shape.STRING},
            help="How many characters.",
        ),
        "6",
    )
    character: str = value(
        Number(
            label="Character",
            low=1,
            high=255,
            whole=True,
            literal=True,
            when={"kind": ItemKind.CHARACTER},
            help="Its number, 1 to 255: 13 is the line end, 7 the bell.",
        ),
        "13",
    )


@dc.dataclass(frozen=True, kw_only=True)
class Print(Instruction):
    """Sends texts and values to a terminal."""

    title = "Print"
    group = Group.FLOW
    sentence = "Print {items}[ {port}][, {same_line}]"
    help = "Sends texts, values and single characters to the operator's terminal or to the studio."

    port: Port = value(
        Choice(label="Port", kind=Port, words=PORT_WORDS, phrases=PORT_PHRASES, help="Where it is sent."), Port.MAIN
    )
    items: tuple[PrintItem, ...] = value(
        ListOf(label="Items", row=PrintItem, joint=", ", most=40, help="What is printed, in this order."), ()
    )
    same_line: bool = value(
        Flag(label="No line end", phrase="without a line end", help="The next print goes on in the same line."), False
    )

    @classmethod
    def example(cls) -> Print:
        return cls(
            items=(PrintItem(text="Length "), PrintItem(kind=ItemKind.VALUE, expression="LEN", shape=Shape.DECIMAL))
        )


class AnswerKind(StrEnum):
    NUMBER = "number"
    TEXT = "text"


@dc.dataclass(frozen=True, kw_only=True)
class UserInterface(Instruction):
    """Asks the operator for a value."""

    title = "User Interface"
    group = Group.FLOW
    sentence = "Ask {prompt}[ {port}] and keep the answer in {variable}[ ({length} characters)]"
    help = (
        "Prints a question and waits for the answer, which goes into a variable; an empty answer keeps the old value. "
        "Only the program's main thread can ask."
    )

    port: Port = value(
        Choice(label="Port", kind=Port, words=PORT_WORDS, phrases=PORT_PHRASES, help="Where the operator is."),
        Port.MAIN,
    )
    prompt: str = value(MessageText(label="Question", most=60, help="What the operator reads."), "")
    variable: str = value(VariableName(label="Variable", elements=True, help="Where the answer is kept."), "")
    answer: AnswerKind = value(
        Choice(
            label="Answer",
            kind=AnswerKind,
            words={AnswerKind.NUMBER: "a number", AnswerKind.TEXT: "text"},
            help="A number, or a text of up to 6 characters.",
        ),
        AnswerKind.NUMBER,
    )
    length: str = value(
        Number(
            label="Characters",
            low=1,
            high=6,
            whole=True,
            literal=True,
            when={"answer": AnswerKind.TEXT},
            help="How many characters.",
        ),
        "6",
    )

    @classmethod
    def example(cls) -> UserInterface:
        return cls(prompt="Length", variable="LEN")
