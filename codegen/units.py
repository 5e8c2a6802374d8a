"""Expressions in user units, turned into counts."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

from codegen.expressions import Binary, Expression, Function, Group, Negative, Number, Operand, constant, walk

LARGEST_FACTOR = 32767  # larger ones could overflow the controller's numbers
ONE_PART = Fraction(1, 1_000_000)  # what a written factor may be wrong by


def in_counts(tree: Expression, factor: Fraction, factor_of: Callable[[Operand], Fraction | None]) -> Expression:
    """An expression in user units as one in counts: `LEN` becomes `LEN*4000`.

    Live values of the controller are counts already (`factor_of` tells how many to a unit). Where they stand
    alone, in sums and with plain factors they stay as they are, which is exact; elsewhere they are turned into
    user units first: `LEN*_TPX` becomes `(LEN*(_TPX/4000))*4000`.
    """
    if not any(isinstance(node, Operand) and factor_of(node) is not None for node in walk(tree)):
        return times(tree, factor)
    match tree:
        case Operand():
            return times(tree, factor / (factor_of(tree) or factor))
        case Group(inner=inner):
            return in_counts(inner, factor, factor_of)
        case Negative(operand=inner):
            return Negative(in_counts(inner, factor, factor_of))
        case Binary(operator="+" | "-" as sign, left=left, right=right):
            return Binary(sign, in_counts(left, factor, factor_of), in_counts(right, factor, factor_of))
        case Binary(operator="*" | "/" as sign, left=left, right=Number() as number):
            return Binary(sign, in_counts(left, factor, factor_of), number)
        case Binary(operator="*", left=Number() as number, right=right):
            return Binary("*", in_counts(right, factor, factor_of), number)
        case _:
            return times(_in_units(tree, factor_of), factor)


def _in_units(tree: Expression, factor_of: Callable[[Operand], Fraction | None]) -> Expression:
    """The tree with every live value turned from counts into user units."""
    match tree:
        case Operand():
            factor = factor_of(tree)
            return tree if factor is None or factor == 1 else Binary("/", tree, Number(factor))
        case Group(inner=inner):
            return Group(_in_units(inner, factor_of))
        case Negative(operand=inner):
            return Negative(_in_units(inner, factor_of))
        case Function(name=name, argument=argument):
            return Function(name, _in_units(argument, factor_of))
        case Binary(operator=operator, left=left, right=right):
            return Binary(operator, _in_units(left, factor_of), _in_units(right, factor_of))
        case _:
            return tree


def times(tree: Expression, factor: Fraction) -> Expression:
    """`tree` multiplied by a number, written so that the controller's 1/65536 loses as little as possible."""
    if factor == 1:
        return tree
    known = constant(tree)
    if known is not None:
        return Number(known * factor)
    inner = tree.inner if isinstance(tree, Group) else tree
    if isinstance(inner, Negative):
        return Negative(times(inner.operand, factor))
    if factor.numerator == 1 and factor.denominator <= LARGEST_FACTOR:
        return Binary("/", inner, Number(Fraction(factor.denominator)))
    if _is_exact(factor) or factor.numerator > LARGEST_FACTOR or factor.denominator > LARGEST_FACTOR:
        return Binary("*", inner, Number(factor))
    return Binary("/", Binary("*", inner, Number(Fraction(factor.numerator))), Number(Fraction(factor.denominator)))


def _is_exact(factor: Fraction) -> bool:
    """Whether a factor survives being kept in steps of 1/65536."""
    kept = Fraction(round(factor * 65536), 65536)
    return abs(kept - factor) <= abs(factor) * ONE_PART
