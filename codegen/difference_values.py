"""Settings and variables of file, controller and EEPROM beside each other; numbers count 1/65536."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Iterator, Mapping
from fractions import Fraction

from codegen.difference import PLACES
from codegen.fields import Dimension
from codegen.setup import Setup
from codegen.setup_differences import counts_text
from codegen.setup_registers import BY_COMMAND, REGISTERS
from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.fixed import ONE

Key = tuple[str, str]  # a register and its axis ("" = none); a variable and ""
Values = Mapping[Key, int]
LENGTHS = {"counts": Dimension.DISTANCE, "counts/s": Dimension.SPEED, "counts/s2": Dimension.ACCELERATION}


@dc.dataclass(frozen=True, slots=True)
class ValueDifference:
    """A value that is not the same everywhere; None where a place does not state it or is not known."""

    key: Key
    title: str
    cells: tuple[int | None, int | None, int | None]
    texts: tuple[str, str, str]

    def words(self, other: int, base: int = 0) -> str:
        """What the other place has otherwise than the base, as a sentence; nothing when they agree."""
        ours, theirs = self.cells[base], self.cells[other]
        if ours is None or theirs is None or ours == theirs:
            return ""
        return f"{self.title} is {self.texts[other]} in the {PLACES[other]}, {self.texts[base]} in the {PLACES[base]}"


def number_text(value: int) -> str:
    """As a person reads it, exact: at most 16 binary places are at most 16 decimal ones."""
    text = f"{abs(value) // ONE}.{abs(value) % ONE * 10**16 // ONE:016d}".rstrip("0").rstrip(".")
    return f"-{text}" if value < 0 else text


def resolution(name: str) -> int:
    """What a register tells apart: the controller rounds what it is given to such steps."""
    return max(int(Fraction(COMMANDS[name].step or 0) * ONE), 1)


def title_of(key: Key) -> str:
    """ "Proportional of X (KP)"; a variable by its name."""
    name, axis = key
    if name not in COMMANDS:
        return name
    return f"{COMMANDS[name].title}{f' of {axis}' if axis else ''} ({name})"


def register_text(key: Key, value: int, setup: Setup) -> str:
    """A value as the person set it up: "200 mm (200000 counts)", else the controller's own number with its unit."""
    name, axis = key
    unit = COMMANDS[name].unit if name in COMMANDS else ""
    plain = counts_text(BY_COMMAND[name], value) if name in BY_COMMAND else number_text(value)
    if unit == "flag":
        return "yes" if value else "no"
    if plain == "off" or unit in ("code", "ratio", ""):
        return plain
    if unit in LENGTHS and axis and axis in setup.letters and setup.axis(axis).is_set_up:
        there = setup.from_counts(LENGTHS[unit], axis, Fraction(value, ONE))
        return f"{float(there):.6g} {setup.unit_text(LENGTHS[unit], axis)} ({plain} {unit})"
    return f"{plain} {unit}"


def wanted(setup: Setup) -> Values:
    """What the setup states, register by register; a ceiling (top speed) is no value to compare."""
    return {
        (register.command, letter): value
        for register in REGISTERS
        for letter in setup.letters
        if not register.ceiling and (value := register.wanted(setup, letter)) is not None
    }


def value_differences(
    file: Values | None, controller: Values | None, eeprom: Values | None, setup: Setup
) -> Iterator[ValueDifference]:
    """The registers that differ by more than the controller tells apart, in the controller's order."""
    places = (file, controller, eeprom)
    keys = dict.fromkeys(key for place in (controller, eeprom, file) if place is not None for key in place)
    for key in keys:
        step = resolution(key[0]) if key[0] in COMMANDS else 1
        cells = [place.get(key) if place is not None else None for place in places]
        there = [cell for cell in cells if cell is not None]
        if there and max(there) - min(there) >= step:
            texts = ["" if cell is None else register_text(key, cell, setup) for cell in cells]
            yield ValueDifference(key, title_of(key), (cells[0], cells[1], cells[2]), (texts[0], texts[1], texts[2]))
