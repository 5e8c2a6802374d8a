"""Values of expressions: closures over integers counting 1/65536, as the controller counts.

Decisions (inferred where the manuals are silent): results wrap in 48 bits of two's complement; products and
quotients are cut towards zero to 1/65536; dividing by zero is error 6; `&` and `|` work on all 48 bits.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Protocol

from codegen.twoletter.fixed import HIGHEST, LOWEST, ONE, STRING_BYTES, string_value, wrap
from codegen.twoletter.fixed import as_integer as as_integer
from codegen.twoletter.functions import PURE
from codegen.twoletter.nodes import (
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

OUT_OF_RANGE = 6
VARIABLE_ERROR = 9
STRING_TOO_LONG = 52
INDEX_INVALID = 56


class EvaluationError(Exception):
    """The expression has no value: the controller's error code."""

    def __init__(self, code: int) -> None:
        super().__init__(code)
        self.code = code


class Names(Protocol):
    """What names stand for; all values count 1/65536, `index` is a plain integer."""

    def variable(self, name: str) -> int: ...

    def element(self, name: str, index: int) -> int: ...

    def operand(self, name: str, suffix: str) -> int: ...

    def keyword(self, name: str) -> int: ...

    def function(self, name: str, argument: int) -> int:
        """@IN, @OUT and @AN; the other functions never get here."""
        ...


Evaluator = Callable[[Names], int]
Operation = Callable[[int, int], int]


def product(left: int, right: int) -> int:
    exact = left * right
    return exact >> 16 if exact >= 0 else -(-exact >> 16)


def multiply(left: int, right: int) -> int:
    return wrap(product(left, right))


def divide(left: int, right: int) -> int:
    if right == 0:
        raise EvaluationError(OUT_OF_RANGE)
    quotient = (abs(left) << 16) // abs(right)
    return wrap(quotient if (left < 0) == (right < 0) else -quotient)


def _divide_down(left: int, right: int) -> int:
    if right == 0:
        raise EvaluationError(OUT_OF_RANGE)
    return wrap((left << 16) // right)


def _with_zero(operation: Operation, by_zero: Operation) -> Operation:
    """A division where another controller does something else about zero."""
    return lambda left, right: operation(left, right) if right else by_zero(left, right)


def _variable_error(left: int, right: int) -> int:
    raise EvaluationError(VARIABLE_ERROR)


def _largest(left: int, right: int) -> int:
    return LOWEST if left < 0 else HIGHEST


def limited(value: int) -> int:
    """The nearest number of six bytes: overflow of a controller that stops at the limit."""
    return max(LOWEST, min(HIGHEST, value))


OPERATIONS: dict[str, Operation] = {
    "+": lambda left, right: wrap(left + right),
    "-": lambda left, right: wrap(left - right),
    "*": multiply,
    "/": divide,
    "+~": lambda left, right: limited(left + right),  # no source has these: see the simulator's arithmetic.py
    "-~": lambda left, right: limited(left - right),
    "*~": lambda left, right: limited(product(left, right)),
    "*_": lambda left, right: wrap(left * right >> 16),
    "*~_": lambda left, right: limited(left * right >> 16),
    "/_": _divide_down,
    "/9": _with_zero(divide, _variable_error),
    "/9_": _with_zero(_divide_down, _variable_error),
    "/^": _with_zero(divide, _largest),
    "/^_": _with_zero(_divide_down, _largest),
    "&": lambda left, right: left & right,
    "|": lambda left, right: left | right,
    "<": lambda left, right: ONE if left < right else 0,
    ">": lambda left, right: ONE if left > right else 0,
    "=": lambda left, right: ONE if left == right else 0,
    "<=": lambda left, right: ONE if left <= right else 0,
    ">=": lambda left, right: ONE if left >= right else 0,
    "<>": lambda left, right: ONE if left != right else 0,
}


def evaluate(expression: Expression, names: Names) -> int:
    """The value of the expression, counting 1/65536; raises EvaluationError."""
    return compile_expression(expression)(names)


@lru_cache(maxsize=8192)
def compile_expression(expression: Expression) -> Evaluator:
    """A function that works the expression out; constant parts are worked out once."""
    known = constant(expression)
    if known is not None:
        return lambda names: known
    return _COMPILERS[type(expression)](expression)


def constant(expression: Expression) -> int | None:
    """The value of an expression that needs no names; None when it does (or has none)."""
    match expression:
        case Number(scaled):
            return scaled
        case String(text):
            return string_value(text) if len(text) <= STRING_BYTES else None
        case Group(inner):
            return constant(inner)
        case Negative(inner):
            value = constant(inner)
            return None if value is None else wrap(-value)
        case Function(name, argument) if name in PURE:
            value = constant(argument)
            return None if value is None else PURE[name](value)
        case Binary(operator, left, right):
            return _constant_binary(operator, constant(left), constant(right))
        case _:
            return None


def _constant_binary(operator: str, left: int | None, right: int | None) -> int | None:
    if left is None or right is None or (operator[0] == "/" and right == 0):
        return None
    return OPERATIONS[operator](left, right)


def _string(node: String) -> Evaluator:
    def too_long(names: Names) -> int:
        raise EvaluationError(STRING_TOO_LONG)

    return too_long


def _variable(node: Variable) -> Evaluator:
    name = node.name
    return lambda names: names.variable(name)


def _element(node: Element) -> Evaluator:
    name = node.name
    if node.index is None:

        def no_index(names: Names) -> int:
            raise EvaluationError(INDEX_INVALID)

        return no_index
    index = compile_expression(node.index)
    return lambda names: names.element(name, index(names) >> 16)


def _operand(node: Operand) -> Evaluator:
    name, suffix = node.name, node.suffix
    return lambda names: names.operand(name, suffix)


def _keyword(node: Keyword) -> Evaluator:
    name = node.name
    return lambda names: names.keyword(name)


def _function(node: Function) -> Evaluator:
    argument = compile_expression(node.argument)
    name = node.name
    pure = PURE.get(name)
    if pure is None:
        return lambda names: names.function(name, argument(names))
    return lambda names: pure(argument(names))


def _negative(node: Negative) -> Evaluator:
    inner = compile_expression(node.operand)
    return lambda names: wrap(-inner(names))


def _group(node: Group) -> Evaluator:
    return compile_expression(node.inner)


def _sum(left: Evaluator, right: Evaluator) -> Evaluator:
    def add(names: Names) -> int:
        value = left(names) + right(names)
        return value if LOWEST <= value <= HIGHEST else wrap(value)

    return add


def _difference(left: Evaluator, right: Evaluator) -> Evaluator:
    def subtract(names: Names) -> int:
        value = left(names) - right(names)
        return value if LOWEST <= value <= HIGHEST else wrap(value)

    return subtract


_INLINE: dict[str, Callable[[Evaluator, Evaluator], Evaluator]] = {
    "+": _sum,
    "-": _difference,
    "&": lambda left, right: lambda names: left(names) & right(names),
    "|": lambda left, right: lambda names: left(names) | right(names),
    "<": lambda left, right: lambda names: ONE if left(names) < right(names) else 0,
    ">": lambda left, right: lambda names: ONE if left(names) > right(names) else 0,
    "=": lambda left, right: lambda names: ONE if left(names) == right(names) else 0,
    "<=": lambda left, right: lambda names: ONE if left(names) <= right(names) else 0,
    ">=": lambda left, right: lambda names: ONE if left(names) >= right(names) else 0,
    "<>": lambda left, right: lambda names: ONE if left(names) != right(names) else 0,
}


def _binary(node: Binary) -> Evaluator:
    left, right = compile_expression(node.left), compile_expression(node.right)
    inline = _INLINE.get(node.operator)
    if inline is not None:
        return inline(left, right)
    operation = OPERATIONS[node.operator]
    return lambda names: operation(left(names), right(names))


_COMPILERS: dict[type, Callable[..., Evaluator]] = {
    String: _string,
    Variable: _variable,
    Element: _element,
    Operand: _operand,
    Keyword: _keyword,
    Function: _function,
    Negative: _negative,
    Group: _group,
    Binary: _binary,
}
