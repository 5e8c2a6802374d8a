"""Checks of numbers and expressions: ranges, resolution, and the order operators are worked out in."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from codegen.models import Model
from codegen.twoletter.checks.rules import RULES
from codegen.twoletter.commands import COMMANDS, FUNCTIONS
from codegen.twoletter.evaluate import constant
from codegen.twoletter.facts import expressions_of, walk
from codegen.twoletter.format import format_expression, format_scaled
from codegen.twoletter.nodes import (
    EXPRESSIONS,
    Binary,
    Command,
    Dimension,
    Expression,
    Function,
    SegmentSpeed,
    Span,
    Statement,
    Target,
)
from codegen.twoletter.problems import Problem
from codegen.twoletter.rows import BY_AXIS, Field, FunctionRow, Number, Row, Takes

_COMPARISONS = frozenset({"<", ">", "=", "<=", ">=", "<>"})
_STRENGTH = {"*": 4, "/": 4, "+": 3, "-": 3, "&": 2, "|": 1}
_WORTH_SAYING = 100  # a register that keeps the value to one part in this is not worth a warning


def number_problems(statement: Statement, model: Model) -> Iterator[Problem]:
    """All problems of the numbers in one statement."""
    for expression in expressions_of(statement):
        yield from operator_order(expression)
        for node in walk(expression):
            if isinstance(node, Binary):
                yield from divided_by_zero(node)
            elif isinstance(node, Function):
                yield from function_range(node, model)
    if isinstance(statement, Command):
        for place, value in places_of(statement, COMMANDS[statement.name], model):
            yield from in_range(place, value, model)


def places_of(command: Command, row: Row, model: Model) -> Iterator[tuple[Row | Field, Expression]]:
    """Each number of the argument list with what the table says about its place."""
    fields = row.fields_for(model)
    first = 1 if row.takes is Takes.TARGET else 0
    for number, argument in enumerate(command.arguments):
        match argument:
            case Dimension(_, size) if row.takes is Takes.DIMENSIONS and size is not None:
                yield row, size
            case SegmentSpeed(value):
                yield COMMANDS["VS"], value
            case Target() | Dimension():
                pass
            case _ if row.takes is Takes.AXES_OR_ONE or row.takes in (Takes.MESSAGE, Takes.INPUT):
                pass
            case _ if isinstance(argument, EXPRESSIONS):
                if fields and number - first < len(fields):
                    yield fields[number - first], argument
                elif not fields and (number == 0 or row.takes in BY_AXIS):
                    yield row, argument


def in_range(place: Row | Field, value: Expression, model: Model) -> Iterator[Problem]:
    """A constant outside the limits, or one the register cannot keep."""
    scaled = constant(value)
    if scaled is None:
        return
    if not place.accepts(scaled, model):
        yield _out_of_range(place, scaled, value.span, model)
        return
    stored = place.stored(scaled)
    if abs(stored - scaled) * _WORTH_SAYING > abs(scaled):
        yield RULES["rounded"].problem(
            0,
            value.span.start,
            value.span.end,
            what=place.name,
            step=format_number_of(place.step),
            value=format_scaled(scaled),
            stored=format_scaled(stored),
        )


def _out_of_range(place: Row | Field | FunctionRow, scaled: int, span: Span, model: Model) -> Problem:
    return RULES["out-of-range"].problem(
        0, span.start, span.end, value=format_scaled(scaled), what=place.name, range=range_text(place, model)
    )


def range_text(place: Row | Field | FunctionRow, model: Model) -> str:
    """`0 to 8000000 counts/s`, or the choices."""
    if place.choices:
        return "one of " + ", ".join(map(format_number_of, place.choices))
    if place.unit == "digits":
        return "0 to 10 digits (1 to 8 hexadecimal) and 0 to 4 decimals"
    low, high = place.range_for(model)
    if low is None and high is None:
        return place.unit
    limits = f"{format_number_of(low)} to {format_number_of(high)}"
    return f"{limits} {place.unit}".rstrip() + (" without 0" if 0 in place.never else "")


def format_number_of(value: Number | None) -> str:
    """A number of the table as text; None is an open end."""
    if value is None:
        return "any"
    return f"{value:.10g}" if isinstance(value, float) else str(value)


def function_range(node: Function, model: Model) -> Iterator[Problem]:
    """`@IN[9]`: inputs, outputs and analog inputs that do not exist."""
    row, value = FUNCTIONS[node.name], constant(node.argument)
    if not row.pure and value is not None and not row.accepts(value, model):
        yield _out_of_range(row, value, node.argument.span, model)


def divided_by_zero(node: Binary) -> Iterator[Problem]:
    """A constant divisor of 0."""
    if node.operator == "/" and constant(node.right) == 0:
        yield RULES["divided-by-zero"].problem(0, node.right.span.start, node.right.span.end)


def operator_order(expression: Expression) -> Iterator[Problem]:
    """Places where reading from left to right differs from how people read (one warning for each bracket level)."""
    for node in _levels(expression):
        operators = _chain(node)
        if any(operator in _COMPARISONS for operator in operators):
            if _comparisons_unclear(node):
                yield _reading("comparisons", node)
                continue
            operators = []
            for side in _sides(node):
                operators = _chain(side)
                if _grows(operators):
                    yield _reading("mixed-operators", side)
        elif _grows(operators):
            yield _reading("mixed-operators", node)


def _levels(expression: Expression) -> Iterator[Binary]:
    """The outermost operation of every bracket level."""
    waiting: list[tuple[Expression, bool]] = [(expression, True)]
    while waiting:
        node, outermost = waiting.pop()
        if isinstance(node, Binary):
            if outermost:
                yield node
            waiting += [(node.left, False), (node.right, False)]
        else:
            waiting += [(inner, True) for inner in _inside(node)]


def _inside(node: Expression) -> list[Expression]:
    inner = getattr(node, "inner", None) or getattr(node, "argument", None) or getattr(node, "index", None)
    inner = inner or getattr(node, "operand", None)
    return [inner] if inner is not None and not isinstance(inner, str) else []


def _chain(node: Expression) -> list[str]:
    """The operators of one bracket level, from left to right."""
    operators: list[str] = []
    while isinstance(node, Binary):
        operators.append(node.operator)
        node = node.left
    return operators[::-1]


def _grows(operators: list[str]) -> bool:
    """Whether a stronger operator follows a weaker one."""
    strengths = [_STRENGTH[operator] for operator in operators if operator in _STRENGTH]
    return any(later > earlier for earlier, later in pairwise(strengths))


def _sides(node: Binary) -> Iterator[Expression]:
    """The two sides of a comparison."""
    yield node.left
    yield node.right


def _comparisons_unclear(node: Binary) -> bool:
    """Two comparisons, or & and | beside one, on one bracket level."""
    count = 0
    logical = False
    waiting: list[Expression] = [node]
    while waiting:
        part = waiting.pop()
        if isinstance(part, Binary):
            count += part.operator in _COMPARISONS
            logical = logical or part.operator in "&|"
            waiting += [part.left, part.right]
    return count > 1 or logical


def _reading(rule: str, node: Expression) -> Problem:
    return RULES[rule].problem(0, node.span.start, node.span.end, reading=reading(node))


def reading(expression: Expression) -> str:
    """The expression with the brackets the controller means."""
    if not isinstance(expression, Binary):
        return format_expression(expression)
    left, right = (_bracketed(side) for side in (expression.left, expression.right))
    return f"{left}{expression.operator}{right}"


def _bracketed(side: Expression) -> str:
    return f"({reading(side)})" if isinstance(side, Binary) else format_expression(side)
