"""What a field says of a text that might be put into it, for whoever helps to write it."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Callable
from fractions import Fraction
from typing import Any

from codegen import fields, read
from codegen.expressions import Operand
from codegen.setup import Setup
from codegen.twoletter.emit.build import Build


@dc.dataclass(frozen=True)
class Judge:
    """One field of one instruction: what is wrong with a text, what is sent for it, its unit and how it converts."""

    label: str
    unit: str
    problem: Callable[[str], str]
    counts: Callable[[str], str]
    factor: Callable[[Operand], Fraction]  # counts of a live value in one unit of the field; 1: it stays raw
    raw: bool  # positions and speeds are counts here


def judge_of(item: Any, name: str, axis: str, along: str, setup: Setup) -> Judge:
    """The judge of a field as the instruction stands now; `along`: the axes of the path it is a row of."""
    field = fields.fields_of(item)[name]
    inner = field.of if isinstance(field, fields.PerAxis) else field
    letter = axis or read.row_axis(field, along)
    converts = isinstance(inner, fields.Quantity) and setup.converts(inner.dimension)
    context = read.context_of(item, name, setup, letter)

    def with_text(text: str) -> Any:
        value: Any = text
        if axis:
            texts = list(getattr(item, name))
            texts[fields.AXES.index(axis)] = text
            value = tuple(texts)
        return dc.replace(item, **{name: value})

    def factor(operand: Operand) -> Fraction:
        found = Build(setup).factor(operand, context.axis[:1]) if converts else None
        return found or Fraction(1)

    return Judge(
        label=f"{field.label} {axis}".strip(),
        unit=read.unit_text(item, name, setup, letter),
        problem=lambda text: read.problem_of(with_text(text), name, setup, letter) or "",
        counts=lambda text: read.counts_text(with_text(text), name, setup, letter),
        factor=factor,
        raw=isinstance(inner, fields.ExpressionField),
    )
