"""The whole comparison of file, controller and EEPROM: what differs, and the sentences that sum it up."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Mapping

from codegen.difference import Difference, Lines, differences
from codegen.difference_values import ValueDifference, Values, value_differences
from codegen.setup import Setup
from codegen.twoletter.slow_mark import FULL


@dc.dataclass(frozen=True)
class Burned:
    """What was written into the EEPROM from here, as far as that is known; `…_when` empty: never from here."""

    program: Lines | None = None
    name: str = ""
    program_when: str = ""
    parameters: Values | None = None
    parameters_when: str = ""
    variables: Mapping[str, int] | None = None
    variables_when: str = ""


@dc.dataclass(frozen=True)
class Held:
    """What the controller holds, as it was read."""

    program: Lines | None = None
    parameters: Values | None = None
    variables: Mapping[str, int] | None = None
    percent: int = FULL  # of the speed that was written


@dc.dataclass(frozen=True)
class Report:
    """Everything that differs; `summary` says it in sentences."""

    program: tuple[Difference, ...]
    settings: tuple[ValueDifference, ...]
    variables: tuple[ValueDifference, ...]
    summary: tuple[str, ...]

    @property
    def count(self) -> int:
        return len(self.program) + len(self.settings) + len(self.variables)


def report(file: Lines, wanted: Values, held: Held, burned: Burned, setup: Setup) -> Report:
    """Compares whatever is known of the three."""
    program = differences(file, held.program, burned.program)
    settings = tuple(value_differences(wanted, held.parameters, burned.parameters, setup))
    variables = tuple(value_differences(None, _named(held.variables), _named(burned.variables), setup))
    summary = (
        _controller(file, held, program),
        _eeprom(held, burned, program),
        _settings(wanted, held, burned, settings),
        _variables(held, burned, variables),
    )
    return Report(program, settings, variables, tuple(each for each in summary if each))


def _named(values: Mapping[str, int] | None) -> Values | None:
    return None if values is None else {(name, ""): value for name, value in values.items()}


def _controller(file: Lines, held: Held, found: tuple[Difference, ...]) -> str:
    if held.program is None:
        return "What the controller holds is not known: read it."
    if not held.program:
        return "There is no program in the controller."
    count = sum(1 for each in found if each.same(0, 1) is False)
    if held.percent < FULL:
        return f"The controller holds a program slowed to {held.percent} %: it differs in {places(count)}."
    if not count:
        return f"The controller holds exactly the open program ({len(file)} lines)."
    return f"The controller's program differs from the open one in {places(count)}."


def _eeprom(held: Held, burned: Burned, found: tuple[Difference, ...]) -> str:
    if burned.program is None:
        return "What program is in the EEPROM is not known: it cannot be read, and this studio has not burned it."
    when = f"as burned from here on {burned.program_when}"
    count = sum(1 for each in found if each.same(1, 2) is False)
    if held.program is None:
        return f"The EEPROM holds “{burned.name}” {when}, unless somebody else has burned it since."
    if not count:
        return f"The EEPROM holds the program that is in the controller, {when}."
    return (
        f"Not burned: the EEPROM holds “{burned.name}” {when}; it differs from the controller's program in "
        f"{places(count)} and is back after the next power-up."
    )


def _settings(wanted: Values, held: Held, burned: Burned, found: tuple[ValueDifference, ...]) -> str:
    if held.parameters is None:
        return ""
    compared = sum(1 for key in wanted if key in held.parameters)
    other = sum(1 for each in found if each.words(1))
    first = (
        f"{_of(other, 'value')} of the setup {'is' if other == 1 else 'are'} otherwise in the controller."
        if other
        else f"All {compared} values that the setup states are in the controller."
        if compared
        else "The setup states no values to compare."
    )
    if burned.parameters is None:
        return f"{first} Which values are in the EEPROM is not known."
    unburned = sum(1 for each in found if each.words(2, 1))
    when = f"burned on {burned.parameters_when}"
    return f"{first} " + (
        f"{_of(unburned, 'value')} in the EEPROM ({when}) {'differs' if unburned == 1 else 'differ'}."
        if unburned
        else f"The EEPROM has the same ({when})."
    )


def _variables(held: Held, burned: Burned, found: tuple[ValueDifference, ...]) -> str:
    if held.variables is None:
        return ""
    if not held.variables:
        return "No variable of the program has a value in the controller."
    if burned.variables is None:
        return f"{_of(len(held.variables), 'variable')} in the controller; a file keeps no values of variables."
    return (
        f"{_of(len(found), 'variable')} {'differs' if len(found) == 1 else 'differ'} from what was burned on "
        f"{burned.variables_when}."
        if found
        else f"The variables are as burned on {burned.variables_when}."
    )


def places(count: int) -> str:
    """ "one place", "3 places"."""
    return "one place" if count == 1 else f"{count} places"


def _of(count: int, what: str) -> str:
    return f"One {what}" if count == 1 else f"{count} {what}s"
