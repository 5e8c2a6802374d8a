"""The group Configuration."""

# ruff: noqa: RUF009  (value() declares a field as dataclasses.field does)

from __future__ import annotations

import dataclasses as dc
from enum import StrEnum

from codegen.fields import (
    NONE,
    Choice,
    Dimension,
    Flag,
    MessageText,
    Number,
    PerAxis,
    PerAxisText,
    Quantity,
    VariableName,
    value,
)
from codegen.instructions.instruction import Group, Instruction
from codegen.numbers import parse_number
from codegen.setup import Setup

ACCELERATION = Quantity(label="Acceleration", dimension=Dimension.ACCELERATION, positive=True)
DECELERATION = Quantity(label="Deceleration", dimension=Dimension.ACCELERATION, positive=True)
SPEED = Quantity(label="Speed", dimension=Dimension.SPEED)


@dc.dataclass(frozen=True, kw_only=True)
class AccelDecel(Instruction):
    """How hard each axis speeds up and slows down."""

    title = "Accel and Decel"
    group = Group.CONFIGURATION
    section = "C"
    sentence = (
        "[<[Accelerate {axis} at {acceleration}, decelerate at {deceleration}"
        "|Accelerate {axis} at {acceleration}|Decelerate {axis} at {deceleration}]>|Accelerate …]"
    )
    help = "Sets the acceleration and deceleration that moves use until an instruction changes them."

    acceleration: PerAxisText = value(
        PerAxis(label="Acceleration", of=ACCELERATION, required=False, help="How quickly the axis speeds up."), NONE
    )
    deceleration: PerAxisText = value(
        PerAxis(label="Deceleration", of=DECELERATION, required=False, help="How quickly it slows down."), NONE
    )

    def own_problem(self) -> tuple[str, str] | None:
        if self.acceleration == NONE and self.deceleration == NONE:
            return "acceleration", "Enter an acceleration or a deceleration for an axis"
        return None

    @classmethod
    def example(cls) -> AccelDecel:
        return cls(acceleration=("64", "", "", ""), deceleration=("64", "", "", ""))


@dc.dataclass(frozen=True, kw_only=True)
class AutoExecution(Instruction):
    """Starts the program when the controller is switched on."""

    title = "Auto Execution"
    group = Group.FLOW
    section = "C"
    sentence = "Start this program when the controller is switched on"
    help = "Once the program is burned, it starts at every power-up by itself, motion included."

    @classmethod
    def example(cls) -> AutoExecution:
        return cls()


class Declare(StrEnum):
    VARIABLE = "variable"
    ARRAY = "array"
    FORMAT = "format"
    FREE = "free"


class ValueKind(StrEnum):
    NUMBER = "number"
    TEXT = "text"


_VARIABLE = {"mode": Declare.VARIABLE}
_FORMAT = {"mode": Declare.FORMAT}


@dc.dataclass(frozen=True, kw_only=True)
class VariableArray(Instruction):
    """Declares a variable or an array, sets how they are shown, or frees an array."""

    title = "Variable and Array"
    group = Group.CONFIGURATION
    section = "C/M"
    sentence = (
        "[Variable {variable} = {number}|Variable {variable} = {text}|Array {array} with {size} elements"
        "|Show variables with {digits} digits and {decimals} decimals[{hexadecimal}]|Free array {freed}]"
    )
    help = "Declares a variable with its value or an array with its size, sets how values are shown, or frees an array."

    mode: Declare = value(
        Choice(
            label="What",
            kind=Declare,
            words={
                Declare.VARIABLE: "Declare a variable",
                Declare.ARRAY: "Declare an array",
                Declare.FORMAT: "How variables are shown",
                Declare.FREE: "Free an array",
            },
            help="What this instruction does.",
        ),
        Declare.VARIABLE,
    )
    variable: str = value(
        VariableName(label="Variable", when=_VARIABLE, help="Its name: up to 8 letters and digits."), ""
    )
    holds: ValueKind = value(
        Choice(
            label="Holds",
            kind=ValueKind,
            words={ValueKind.NUMBER: "a number", ValueKind.TEXT: "text"},
            when=_VARIABLE,
            help="A number, or a text of up to 6 characters.",
        ),
        ValueKind.NUMBER,
    )
    number: str = value(
        Number(
            label="First value",
            when={"mode": Declare.VARIABLE, "holds": ValueKind.NUMBER},
            help="The value it starts with.",
        ),
        "0",
    )
    text: str = value(
        MessageText(
            label="First text",
            most=6,
            when={"mode": Declare.VARIABLE, "holds": ValueKind.TEXT},
            help="The text it starts with.",
        ),
        "",
    )
    array: str = value(
        VariableName(label="Array", array=True, when={"mode": Declare.ARRAY}, help="Its name, a capital letter first."),
        "",
    )
    size: str = value(
        Number(
            label="Elements",
            low=1,
            high=8000,
            whole=True,
            literal=True,
            when={"mode": Declare.ARRAY},
            help="How many elements.",
        ),
        "100",
    )
    digits: str = value(
        Number(
            label="Digits",
            low=0,
            high=10,
            whole=True,
            literal=True,
            when=_FORMAT,
            help="Digits before the point (hexadecimal: 1 to 8).",
        ),
        "10",
    )
    decimals: str = value(
        Number(label="Decimals", low=0, high=4, whole=True, literal=True, when=_FORMAT, help="Digits after the point."),
        "4",
    )
    hexadecimal: bool = value(
        Flag(label="Hexadecimal", phrase=", hexadecimal", when=_FORMAT, help="Show them in hexadecimal, after a $."),
        False,
    )
    freed: str = value(
        VariableName(
            label="Array", array=True, when={"mode": Declare.FREE}, help="The array whose place is given back."
        ),
        "",
    )

    def own_problem(self) -> tuple[str, str] | None:
        if self.mode is Declare.FORMAT and self.hexadecimal and self.digits.strip() in ("0", "9", "10"):
            return "digits", "Digits must lie between 1 and 8 for hexadecimal numbers"
        return None

    def setup_problem(self, setup: Setup) -> tuple[str, str] | None:
        most = setup.limits.elements
        if self.mode is Declare.ARRAY and int(parse_number(self.size) or 0) > most:
            return "size", f"Elements must be at most {most} on the {setup.limits.title}"
        return None

    @classmethod
    def example(cls) -> VariableArray:
        return cls(variable="LEN", number="4")
