"""Setup and controller side by side: where they differ, what is taken over, what is sent, in words."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Collection, Iterator, Mapping
from fractions import Fraction

from codegen.conversion import LARGEST
from codegen.fields import Context, fields_of
from codegen.models import Model
from codegen.numbers import shown
from codegen.setup import Setup
from codegen.setup_registers import GAIN, OF_FIELD, REGISTERS, Register, Value, factory, limit_registers
from codegen.twoletter.calls import by_axis
from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.fixed import ONE

Key = tuple[str, str]  # command, axis letter
Readings = Mapping[Key, Value]
NOT_SET = "not set"
LOOP = "TM"  # one for all axes


@dc.dataclass(frozen=True, slots=True)
class Difference:
    """One register of one axis: what the setup says, and what the controller holds."""

    command: str
    axis: str
    title: str
    setup: str
    controller: str
    states: bool  # whether the setup says anything that could be sent
    tells: bool = True  # whether the setup can take the controller's value over

    @property
    def key(self) -> Key:
        return self.command, self.axis


@dc.dataclass(frozen=True, slots=True)
class Line:
    """One line to send, what it does in words, and what it may do to the machine."""

    command: str
    axis: str
    text: str
    words: str
    caution: str
    motor_off: bool  # only with the motor of the axis off

    @property
    def key(self) -> Key:
        return self.command, self.axis


def expressions(model: Model) -> dict[Key, str]:
    """What is read of every register: operands, which change nothing."""
    commands = [*(each.command for each in REGISTERS), GAIN]
    known = [name for name in commands if COMMANDS[name].known_to(model) and COMMANDS[name].operand]
    found = {(name, letter): f"_{name}{letter}" for letter in model.axes for name in known}
    return found | {(LOOP, ""): f"_{LOOP}"}


def differences(setup: Setup, readings: Readings) -> tuple[Difference, ...]:
    """Every register whose reading is not what the setup states, axis by axis."""
    return tuple(
        difference(setup, register, letter, readings[register.command, letter])
        for letter in setup.letters
        for register in REGISTERS
        if (register.command, letter) in readings
        and differs(setup, register, letter, readings[register.command, letter])
    )


def differs(setup: Setup, register: Register, letter: str, found: Value) -> bool:
    """A field that is empty differs from everything but the value after a master reset."""
    if not register.counts_for(setup.axis(letter)):
        return False
    wanted = register.wanted(setup, letter)
    if wanted is None:
        return not register.ceiling and not register.same(factory(register.command), found)
    return not register.same(wanted, found)


def difference(setup: Setup, register: Register, letter: str, found: Value) -> Difference:
    """The two sides of one register, in words."""
    states = register.wanted(setup, letter) is not None
    mine = _field_words(setup, register, letter)
    theirs = register.taken(setup, letter, found)
    told = _field_words(theirs, register, letter) if not register.ceiling else _ceiling_words(register, found)
    return Difference(
        register.command,
        letter,
        register.title,
        f"at most {mine}" if register.ceiling and states else mine,
        _as_after_reset(told) if found == factory(register.command) else told,
        states,
        tells=not register.ceiling,
    )


def _as_after_reset(words: str) -> str:
    return f"{words[:-1]}, as after a reset)" if words.endswith(")") else f"{words} (as after a reset)"


def counts_text(register: Register, value: Value) -> str:
    """A register's own number, as it is sent."""
    if register.command in ("FL", "BL") and abs(Fraction(value, ONE)) >= LARGEST:
        return "off"
    return shown(Fraction(value, ONE), 10)


def _field_words(setup: Setup, register: Register, letter: str) -> str:
    """What the fields say, with their unit and the register's number."""
    words, wanted = _typed_words(setup, register, letter), register.wanted(setup, letter)
    code = "" if wanted is None else counts_text(register, wanted)
    return words if not code or code == words else f"{words} ({register.command} {code})"


def _typed_words(setup: Setup, register: Register, letter: str) -> str:
    """What the fields say, with their unit."""
    axis, context = setup.axis(letter), Context(setup, letter)
    parts = []
    for name in register.fields:
        field, held = fields_of(axis)[name], getattr(axis, name)
        if isinstance(held, bool):
            parts.append("yes" if held else "no")
        else:
            parts.append(NOT_SET if field.empty(held) else field.text(held, context))
    return " / ".join(parts)


def _ceiling_words(register: Register, found: Value) -> str:
    return f"{register.command} {counts_text(register, found)}"


def mark(setup: Setup, readings: Readings, name: str, letter: str) -> str:
    """What the controller holds otherwise for a field of an axis, for beside the field; nothing when it agrees."""
    for register in OF_FIELD.get(name, ()):
        found = readings.get((register.command, letter))
        if found is not None and differs(setup, register, letter, found):
            if register.ceiling:
                return _ceiling_words(register, found)
            return _typed_words(register.taken(setup, letter, found), register, letter)
    return ""


def take(setup: Setup, readings: Readings, keys: Collection[Key]) -> Setup:
    """The setup with the controller's values of these registers; the motor first, because others depend on it."""
    for register in REGISTERS:
        for letter in setup.letters:
            key = (register.command, letter)
            if key in keys and key in readings and register.counts_for(setup.axis(letter)):
                setup = register.taken(setup, letter, readings[key])
    return setup


def lines_to_send(setup: Setup, keys: Collection[Key]) -> tuple[Line, ...]:
    """What makes the controller hold these values of the setup, in the order of sending."""
    return tuple(
        line
        for register in REGISTERS
        for letter in setup.letters
        if (register.command, letter) in keys and (line := _line(setup, register, letter)) is not None
    )


def _line(setup: Setup, register: Register, letter: str) -> Line | None:
    if register.wanted(setup, letter) is None:
        return None
    number = register.stated(setup, letter)
    assert number is not None  # wanted says so
    text = by_axis(register.command, {letter: number}).text
    words = f"{register.title} of {letter}: {_field_words(setup, register, letter)}"
    caution = register.caution.format(axis=letter)
    return Line(register.command, letter, text, words, caution, register.motor_off)


def stated(setup: Setup) -> frozenset[Key]:
    """Everything the setup states."""
    return frozenset(
        (register.command, letter)
        for letter in setup.letters
        for register in REGISTERS
        if register.wanted(setup, letter) is not None
    )


def loop_words(setup: Setup, readings: Readings) -> str:
    """What is wrong where the controller's loop is not as fast as the setup says; speeds are converted with it."""
    found = readings.get((LOOP, ""))
    if found is None or found <= 0 or Fraction(found, ONE) == setup.sample:
        return ""
    return (
        f"The controller's loop takes {shown(Fraction(found, ONE), 7)} µs, the setup says {shown(setup.sample, 7)} µs: "
        "its speeds and accelerations are others than they look here."
    )


def stated_limits(setup: Setup) -> frozenset[Key]:
    """What the setup states of what protects the machine."""
    names = {each.command for each in limit_registers()}
    return frozenset(key for key in stated(setup) if key[0] in names)


def cautions(lines: Collection[Line]) -> Iterator[str]:
    """What sending may do to the machine, each thing once."""
    yield from dict.fromkeys(line.caution for line in lines if line.caution)
