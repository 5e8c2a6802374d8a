"""Assignments in loops that only wait (`#A;V=_TPX;JP#A,V<1000`): what they read, and what conditions then depend on."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from codegen.twoletter.evaluate import constant
from codegen.twoletter.functions import PURE
from codegen.twoletter.nodes import (
    Assign,
    Binary,
    Element,
    Expression,
    Function,
    Group,
    Keyword,
    Negative,
    Number,
    Operand,
    String,
    Variable,
)
from device.simulator.twoletter.looking import Restless, looks

if TYPE_CHECKING:
    from device.simulator.twoletter.unit import Unit

MOST: Final = 16  # forms of one condition


@dataclass(frozen=True, slots=True)
class Write:
    """A variable that is set to what can always be worked out."""

    name: str
    value: Expression
    reads: frozenset[str]  # other variables
    adds: int | None = None  # a counter: what is added each time, in 1/65536


def write_of(statement: Assign, unit: Unit) -> Write | None:
    """What an assignment sets; None for elements, and for values that may be refused or tell of other commands."""
    if not isinstance(statement.target, Variable) or not _harmless(statement.value, unit):
        return None
    name, adds = statement.target.name, _added(statement.target.name, statement.value)
    reads = frozenset(variables(statement.value)) - ({name} if adds is not None else set())
    return None if name in reads else Write(name, statement.value, reads, adds)


def _added(name: str, value: Expression) -> int | None:
    """What V=V+2 and the like add."""
    match value:
        case Binary("+" | "-" as operator, Variable(first), second) if first == name:
            number = constant(second)
            return -number if number is not None and operator == "-" else number
        case Binary("+", first, Variable(second)) if second == name:
            return constant(first)
    return None


def _harmless(value: Expression, unit: Unit) -> bool:
    """Has a value whatever the numbers in it come to, and reading it changes nothing."""
    match value:
        case Number() | Variable():
            return True
        case String():
            return constant(value) is not None
        case Element(_, index):
            return index is not None and constant(index) is not None
        case Keyword(name):
            return name == "TIME" or looks(value, unit) is not None
        case Group(inner) | Negative(inner):
            return _harmless(inner, unit)
        case Function(name, argument) if name in PURE:
            return _harmless(argument, unit)
        case Function(_, argument):
            return constant(argument) is not None and looks(value, unit) is not None
        case Operand(name, _):
            return name != "XQ" and looks(value, unit) is not None
        case Binary(operator, left, right):
            divides = operator[0] == "/" and not constant(right)
            return not divides and _harmless(left, unit) and _harmless(right, unit)
    return False


def variables(expression: object) -> Iterator[str]:
    """The variables that an expression reads."""
    if isinstance(expression, Variable):
        yield expression.name
    elif dataclasses.is_dataclass(expression):
        for each in dataclasses.fields(expression):
            yield from variables(getattr(expression, each.name))


def forms(condition: Expression, writes: Mapping[str, Write]) -> list[Expression]:
    """The condition with any of the variables as they stand, or as what they are set to; Restless: too many.

    Whenever the condition is worked out, each variable in it was set before the leap or within it, so that one of
    these forms is what it comes to.
    """
    found = [condition]
    for expression in found:
        for name in sorted(set(variables(expression)) & writes.keys()):
            if writes[name].adds is not None:
                raise Restless  # a counter ends its loop by itself
            form = _replaced(expression, name, writes[name].value)
            if form not in found:
                found.append(form)
        if len(found) > MOST:
            raise Restless
    return found


def _replaced(expression: Expression, name: str, value: Expression) -> Expression:
    match expression:
        case Variable(found):
            return value if found == name else expression
        case Group(inner):
            return dataclasses.replace(expression, inner=_replaced(inner, name, value))
        case Negative(inner):
            return dataclasses.replace(expression, operand=_replaced(inner, name, value))
        case Function(_, argument):
            return dataclasses.replace(expression, argument=_replaced(argument, name, value))
        case Element(_, index) if index is not None:
            return dataclasses.replace(expression, index=_replaced(index, name, value))
        case Binary(_, left, right):
            return dataclasses.replace(
                expression, left=_replaced(left, name, value), right=_replaced(right, name, value)
            )
    return expression


def rounds(writes: Mapping[str, Write]) -> int:
    """After so many rounds every variable holds what it would; Restless: one depends on itself."""

    def depth(name: str, above: frozenset[str]) -> int:
        if name in above:
            raise Restless
        below = writes[name].reads & writes.keys()
        return 1 + max((depth(each, above | {name}) for each in below), default=0)

    return max((depth(name, frozenset()) for name in writes), default=0)
