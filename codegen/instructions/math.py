"""The group Mathematical Equation."""

from __future__ import annotations

import dataclasses as dc

from codegen.fields import ExpressionField, ListOf, VariableName, value
from codegen.instructions.instruction import Group, Instruction


@dc.dataclass(frozen=True, kw_only=True)
class Equation:
    """One assignment."""

    sentence = "{variable} = {expression}"

    variable: str = value(
        VariableName(label="Variable", elements=True, help="A variable, or an element of an array: A[3]."), ""
    )
    expression: str = value(
        ExpressionField(
            label="Expression",
            help="Numbers, variables, functions and live values; positions and speeds are raw counts here.",
        ),
        "",
    )


@dc.dataclass(frozen=True, kw_only=True)
class MathematicalEquation(Instruction):
    """Works out values and keeps them in variables."""

    title = "Mathematical Equation"
    group = Group.MATH
    section = "M"
    sentence = "Set {equations}"
    help = "Works out one expression after the other and keeps the results in variables or array elements."

    equations: tuple[Equation, ...] = value(
        ListOf(label="Equations", row=Equation, most=40, help="Worked out one after the other."), (Equation(),)
    )

    @classmethod
    def example(cls) -> MathematicalEquation:
        return cls(equations=(Equation(variable="LEN", expression="LEN*2"),))
