"""What an emitter may ask for beside the instruction: the machine, and names that are unique in the program."""

from __future__ import annotations

from fractions import Fraction

from codegen.expressions import Bad, Binary, Expression, Operand, parse_expression, write
from codegen.fields import AXES, Dimension, PerAxisText, value_of
from codegen.numbers import parse_number, plain
from codegen.setup import Setup
from codegen.twoletter.calls import Value
from codegen.twoletter.commands import COMMANDS
from codegen.units import in_counts

FIRST_NUMBER = 0xE000  # stands for a number that the last pass gives out (a private character of Unicode)
_DIMENSIONS = {"counts": Dimension.POSITION, "counts/s": Dimension.SPEED, "counts/s2": Dimension.ACCELERATION}


class Build:
    """Hands out unique names and converts values; one for each instruction that is emitted."""

    def __init__(self, setup: Setup) -> None:
        self.setup = setup
        self.given = 0

    def loop(self) -> tuple[str, str]:
        """A label and a counter variable of the same number, both unique in the program."""
        number = chr(FIRST_NUMBER + self.given)
        self.given += 1
        return f"R{number}", f"RC{number}"

    def value(self, text: str, dimension: Dimension, axis: str) -> Value:
        """A quantity as it is sent: rounded counts, or an expression that works them out."""
        number = value_of(text)
        if isinstance(number, Fraction):
            return self.setup.counts(dimension, axis, number)
        return self.expression(number, dimension, axis)

    def expression(self, tree: Expression | Bad, dimension: Dimension, axis: str) -> str:
        """An expression in user units as one in counts."""
        assert not isinstance(tree, Bad), "only correct instructions are emitted"
        return write(in_counts(tree, self.setup.factor(dimension, axis), lambda operand: self.factor(operand, axis)))

    def factor(self, operand: Operand, axis: str) -> Fraction | None:
        """Counts of a live value in one user unit; None for values that are no positions, speeds or accelerations."""
        dimension = _dimension(operand)
        if dimension is None:
            return None
        letter = operand.suffix if operand.suffix and operand.suffix in AXES else axis or "X"
        return self.setup.factor(dimension, letter)

    def by_axis(self, texts: PerAxisText, dimension: Dimension) -> dict[str, Value]:
        """The given values of a per-axis field by axis letter."""
        return {
            letter: self.value(text, dimension, letter)
            for letter, text in zip(AXES, texts, strict=True)
            if text.strip()
        }


def _dimension(operand: Operand) -> Dimension | None:
    row = COMMANDS.get(operand.name)
    return _DIMENSIONS.get(row.unit) if row is not None and row.operand else None


def is_counted(operand: Operand) -> bool:
    """Whether a live value is a position, speed or acceleration in counts."""
    return _dimension(operand) is not None


def raw(text: str) -> str:
    """A number or an expression as it is, positions and speeds in counts; every grouping in brackets."""
    number = parse_number(text)
    if number is not None:
        return plain(number)
    tree = parse_expression(text)
    assert not isinstance(tree, Bad), "only correct instructions are emitted"
    return write(tree)


def is_false(condition: str) -> str:
    """The condition turned round: `(A<B)=0`."""
    tree = parse_expression(condition)
    written = raw(condition)
    return f"({written})=0" if isinstance(tree, Binary) else f"{written}=0"
