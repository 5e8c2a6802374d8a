"""The neutral expression tree worked out in Python: to fill the columns of tables.

Numbers stay exact fractions; the functions follow the controller's own definitions (commands.md 11).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from fractions import Fraction

from codegen.expressions import (
    Bad,
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
    children,
    parse_expression,
    write,
)
from codegen.numbers import plain

ROW = "N"  # what a formula calls the number of the row, from 0
ONE = 65536  # a controller's number counts 1/65536; & and | work on all its bits
PLACES = 9  # decimals of a filled cell whose number does not end


class Unknown(Exception):
    """A formula that has no value: one sentence."""


LIVE_FUNCTIONS = ("AN", "COM", "IN", "OUT")  # worked out by the controller alone


def leaves(tree: Expression) -> tuple[Expression, ...]:
    """The parts whose value only the running controller knows, each once."""
    if isinstance(tree, Variable | Element | Operand | Keyword):
        return (tree,)
    if isinstance(tree, Function) and tree.name in LIVE_FUNCTIONS:
        return (tree,)
    return tuple(dict.fromkeys(leaf for child in children(tree) for leaf in leaves(child)))


def evaluate(tree: Expression, values: Mapping[str, Fraction]) -> Fraction:
    """The value of a tree, with the values of its leaves by their spelling; comparisons give 1 or 0."""
    joins = isinstance(tree, Number | Group | Negative | Binary)
    if not joins and values and (known := values.get(write(tree))) is not None:
        return known
    match tree:
        case Number(value=value):
            return value
        case Group(inner=inner):
            return evaluate(inner, values)
        case Negative(operand=inner):
            return -evaluate(inner, values)
        case Variable(name=name):
            if name not in values:
                raise Unknown(f"{name} has no value here; use {', '.join(values) or 'numbers'}")
            return values[name]
        case Function(name=name, argument=argument):
            return _function(name, evaluate(argument, values))
        case Binary(operator=operator, left=left, right=right):
            return _joined(operator, evaluate(left, values), evaluate(right, values))
        case Element() | Operand() | Keyword() | String():
            raise Unknown("only numbers, N and functions can be worked out here")


def _joined(operator: str, left: Fraction, right: Fraction) -> Fraction:
    match operator:
        case "+":
            return left + right
        case "-":
            return left - right
        case "*":
            return left * right
        case "/":
            if right == 0:
                raise Unknown("this divides by zero")
            return left / right
        case "&":
            return Fraction(int(left * ONE) & int(right * ONE), ONE)
        case "|":
            return Fraction(int(left * ONE) | int(right * ONE), ONE)
        case "<":
            return Fraction(left < right)
        case ">":
            return Fraction(left > right)
        case "=":
            return Fraction(left == right)
        case "<=":
            return Fraction(left <= right)
        case ">=":
            return Fraction(left >= right)
        case _:
            return Fraction(left != right)


def _function(name: str, value: Fraction) -> Fraction:
    match name:
        case "ABS":
            return abs(value)
        case "INT":
            return Fraction(int(value))
        case "FRAC":
            return value - int(value)
        case "RND":
            return Fraction(math.floor(value + Fraction(1, 2)))
        case "SQR":
            return Fraction(math.sqrt(abs(value)))
        case "SIN":
            return Fraction(math.sin(math.radians(float(value % 360))))
        case "COS":
            return Fraction(math.cos(math.radians(float(value % 360))))
        case _:
            raise Unknown(f"@{name} has a value only on the controller")


def fill(formula: str, count: int, first: int = 0) -> tuple[str, ...] | Bad:
    """The cells of a column by a formula of `N`, the number of the row: `@SIN[N*3.6]*100`."""
    tree = parse_expression(formula)
    if isinstance(tree, Bad):
        return tree
    cells: list[str] = []
    for number in range(first, first + count):
        try:
            value = evaluate(tree, {ROW: Fraction(number)})
        except Unknown as unknown:
            return Bad(f"{unknown} (row {number + 1})")
        cells.append(plain(Fraction(round(value * 10**PLACES), 10**PLACES)))
    return tuple(cells)
