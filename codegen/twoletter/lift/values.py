"""Numbers and expressions of a source as they are typed into the fields of a dialog."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction

from codegen.fields import AXES, Dimension, PerAxisText
from codegen.numbers import plain
from codegen.setup import Setup
from codegen.twoletter.checks.numbers import operator_order, reading
from codegen.twoletter.lift.same import exact
from codegen.twoletter.nodes import EXPRESSIONS, Argument, Axes, Binary, Command, Empty, Number, String

MOST_PLACES = 9  # decimals that are tried for a value in user units


def text_of(argument: Argument | None, setup: Setup, dimension: Dimension | None = None, letter: str = "") -> str:
    """What is typed for a value, in user units; "" where nothing would write it again."""
    if isinstance(argument, Number):
        return _number(exact(argument), setup, dimension, letter)
    if argument is None or isinstance(argument, String) or not isinstance(argument, EXPRESSIONS):
        return ""
    if dimension is not None and (factor := setup.factor(dimension, letter)) != 1:
        match argument:
            case Binary("*", left, Number() as number) if exact(number) == factor:
                return text_of(left, setup)
        return ""
    if any(operator_order(argument)):  # read otherwise by people: it stays as it is, with the warning
        return ""
    return reading(argument)


def _number(number: Fraction, setup: Setup, dimension: Dimension | None, letter: str) -> str:
    factor = setup.factor(dimension, letter) if dimension is not None else Fraction(1)
    if dimension is None or factor == 1:
        return plain(number)
    for places in range(MOST_PLACES + 1):
        typed = round(number / factor, places)
        if setup.counts(dimension, letter, typed) == number:
            return plain(typed)
    return ""


def arguments_by_axis(command: Command) -> Mapping[str, Argument]:
    """The arguments of a command that has one for each axis."""
    given = zip(AXES, command.arguments, strict=False)
    return {letter: argument for letter, argument in given if not isinstance(argument, Empty)}


def per_axis(command: Command, setup: Setup, dimension: Dimension | None = None) -> PerAxisText | None:
    """The values of a command at the places of their axes; None where one cannot be typed."""
    if len(command.arguments) > len(AXES) or command.axis is not None:
        return None
    given = arguments_by_axis(command)
    texts = {letter: text_of(argument, setup, dimension, letter) for letter, argument in given.items()}
    if not texts or not all(texts.values()):
        return None
    return in_places(texts)


def in_places(texts: Mapping[str, str]) -> PerAxisText:
    """One text for each axis, "" where there is none."""
    x, y, z, w = (texts.get(letter, "") for letter in AXES)
    return x, y, z, w


def number_of(argument: Argument | None) -> Fraction | None:
    """A plain number."""
    return exact(argument) if isinstance(argument, Number) else None


def whole_numbers(arguments: Sequence[Argument]) -> list[int | None] | None:
    """Plain whole numbers with None at empty places; None when there is anything else."""
    found: list[int | None] = []
    for argument in arguments:
        number = number_of(argument)
        if isinstance(argument, Empty):
            found.append(None)
        elif number is None or number.denominator != 1:
            return None
        else:
            found.append(int(number))
    return found


def one_number(command: Command) -> str:
    """The only argument, where it is a plain number."""
    arguments = command.arguments
    number = number_of(arguments[0]) if len(arguments) == 1 else None
    return "" if number is None else plain(number)


def letters_of(command: Command, setup: Setup) -> str:
    """The axes a command names; all of a one-axis controller when it names none."""
    if not command.arguments:
        return setup.letters if len(setup.letters) == 1 else ""
    first = command.arguments[0]
    return first.letters if isinstance(first, Axes) and len(command.arguments) == 1 else ""
