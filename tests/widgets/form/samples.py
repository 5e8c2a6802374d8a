"""A valid value and another one for each kind of field, as a person would enter them."""

from __future__ import annotations

import dataclasses as dc
from typing import Any

from codegen import fields
from codegen.document import Document
from codegen.instructions import Instruction, Label, MathematicalEquation
from codegen.instructions.math import Equation
from codegen.program import Place, Program, Section, fresh, insert
from codegen.setup import Axis, Setup
from widgets.form.offers import Offers, offers_of


def machine(model: str = "ssc2") -> Setup:
    """637 counts an inch on X (the wire cutter), 1000 on the other axes."""
    setup = Setup(model=model)
    for letter in setup.letters:
        setup = setup.with_axis(letter, Axis(counts_per_unit="637" if letter == "X" else "1000"))
    return setup


def program(model: str = "ssc2") -> tuple[Program, Setup]:
    """A small program: the label A and the variable LEN."""
    made = Program(name="CUTTER")
    for instruction in (Label(name="A"), MathematicalEquation(equations=(Equation(variable="LEN", expression="4"),))):
        made = insert(made, [fresh(made, instruction)], Place(Section.MAIN, 9))
    return made, machine(model)


def offers() -> Offers:
    """What a small program offers."""
    return offers_of(Document(*program()))


def other_value(field: fields.Field, present: Any) -> Any:
    """A value of that kind that differs from the present one."""
    match field:
        case fields.PerAxis():
            inner = other_value(field.of, present[0])
            return ("on" if isinstance(field.of, fields.Flag) else str(inner), *present[1:])
        case fields.Choice():
            return next(each for each in field.kind if each != present)
        case fields.Flag():
            return not present
        case fields.AxisName():
            return "Y" if present == "X" else "X"
        case fields.AxisSet():
            return "XY" if present != "XY" else "Y"
        case fields.ListOf():
            return (*present, field.row())
        case fields.LabelName():
            return "B"
        case fields.VariableName():
            return "COUNT"
        case fields.InputNumber() | fields.OutputNumber():
            return "3" if present != "3" else "4"
        case fields.Text() | fields.Code():
            return f"{present}x"
        case _:
            return "2" if present != "2" else "3"


def with_value(instruction: Instruction, name: str, value: Any) -> Instruction:
    """The instruction with one value replaced."""
    return dc.replace(instruction, **{name: value})


def plain(text: str) -> str:
    """Text as it was before it was told where it may not be broken."""
    return text.replace("\N{WORD JOINER}", "").replace("\N{NO-BREAK SPACE}", " ")
