"""Lengths and speeds along a path of several axes."""

from __future__ import annotations

import dataclasses as dc
from fractions import Fraction
from typing import TYPE_CHECKING

from codegen.fields.field import AXES, Context, Counts
from codegen.fields.numeric import Quantity, value_of

if TYPE_CHECKING:
    from codegen.setup import Setup


def base_letter(setup: Setup, letters: str) -> str:
    """The axis with the fewest counts in a unit: `ES` leaves it as it is, the path is counted in its counts."""
    known = [letter for letter in letters if letter in AXES]
    return min(known, key=lambda letter: setup.axis(letter).scale) if known else ""


@dc.dataclass(frozen=True, kw_only=True)
class PathQuantity(Quantity):
    """A quantity of all the axes of a path together; its context names them all."""

    axis: str = "axes"
    least_counts: int = 0  # fewest the controller takes, as it is sent; 0 = no such limit

    def wrong(self, value: str, context: Context) -> str | None:
        for letter in context.axis:
            if problem := self.scale_problem(value, Context(context.setup, letter)):
                return problem
        if problem := super().wrong(value, self.base(context)):
            return problem
        number = value_of(value)
        return self._narrower(number, context) if isinstance(number, Fraction) else None

    def _narrower(self, number: Fraction, context: Context) -> str | None:
        """No axis of the path may be asked for more than it can do."""
        for letter in context.axis:
            if problem := self.bounds_problem(number, Context(context.setup, letter)):
                return problem
        base = self.base(context)
        if (
            base.axis
            and self.least_counts
            and context.setup.counts(self.dimension, base.axis, number) < self.least_counts
        ):
            least = context.setup.from_counts(self.dimension, base.axis, self.least_counts)
            return f"{self.label} must be at least {float(least):.6g} {self.unit(context)}"
        return None

    def bounds_problem(self, number: Fraction, context: Context) -> str | None:
        """Why one axis cannot do it."""
        low, high = context.setup.bounds(self.dimension, context.axis)
        return None if low <= number <= high else super().range_problem(number, context)

    @staticmethod
    def base(context: Context) -> Context:
        """The context of the axis the path is counted in."""
        return Context(context.setup, base_letter(context.setup, context.axis))

    def text(self, value: str, context: Context) -> str:
        return super().text(value, self.base(context))

    def unit(self, context: Context) -> str:
        return super().unit(self.base(context))

    def counts(self, value: str, context: Context) -> Counts | None:
        return super().counts(value, self.base(context)) if context.axis else None
