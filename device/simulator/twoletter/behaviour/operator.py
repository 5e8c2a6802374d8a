"""Operator data entry: characters as data instead of commands, and the communication interrupt CI."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Final

from codegen.twoletter.fixed import ONE, read_number, string_value
from device.simulator.twoletter.state import CommandError, Port, Strand

if TYPE_CHECKING:
    from device.simulator.twoletter.calls import Call
    from device.simulator.twoletter.unit import Unit

ENTER, ESCAPE, BACKSLASH = 0x0D, 0x1B, 0x5C
OFF, NOTHING, CHARACTER, TEXT, NUMBER = -1, 0, 1, 2, 3  # P1CD, P2CD: dmc-1412-1414.txt l.3541
KEPT_CHARACTERS: Final = 80


def interrupts(unit: Unit, strand: Strand, call: Call) -> None:
    """CI port 1,port 2,data mode of port 1 (dmc-1412-1414.txt l.3568)."""
    fields = call.row.fields_for(unit.model)
    given = [(place, value) for place, value in enumerate(call.values[:3]) if value is not None]
    if any(not fields[place].accepts(value, unit.model) for place, value in given):
        raise CommandError(6)
    for place, value in given:
        number = value // ONE
        if number < 0:
            clear(unit.state.ports[place])
            continue
        unit.state.interrupts[place] = number
        if place < 2:
            unit.state.comint_armed = True


def clear(port: Port) -> None:
    """CI -1: forgets what was received."""
    port.data_text.clear()
    port.last_text = b""
    port.data_status = NOTHING


def data_mode(unit: Unit, port: Port) -> bool:
    """Whether what comes in there is data: port 1 by CI while a program runs (l.3524), port 2 as a general port."""
    state = unit.state
    if port.number != 1:
        return state.port_two[2] == 0
    return state.interrupts[2] == 1 and (unit.profile.data_mode_alone or unit.running())


def character(unit: Unit, port: Port, byte: int) -> None:
    """One character of data."""
    if byte in (ESCAPE, BACKSLASH) and port.number == 1:
        unit.state.interrupts[2] = 0
        clear(port)
        return
    if byte == ENTER:
        port.last_text = bytes(port.data_text)
        port.data_text.clear()
        port.data_status = TEXT if read_number(port.last_text.decode("latin-1")) is None else NUMBER
    elif byte >= 0x10:  # the terminal's function keys are 22 to 26
        port.last_character = byte
        port.data_status = CHARACTER
        if len(port.data_text) < KEPT_CHARACTERS:
            port.data_text.append(byte)
    else:
        return
    interrupt(unit, port, byte)


def interrupt(unit: Unit, port: Port, byte: int) -> None:
    """CI's first two fields, whether the character is data or part of a command (dmc-1412-1414.txt l.3565-3576)."""
    wanted = unit.state.interrupts[port.number - 1]
    if unit.state.comint_armed and (wanted == 2 or (wanted == 1 and byte == ENTER)):
        unit.state.comint_due = True
        unit.changed = True


def _status(number: int) -> Callable[[Unit], int]:
    def read(unit: Unit) -> int:
        port = unit.state.ports[number - 1]
        if not data_mode(unit, port):
            return OFF * ONE
        return max(port.data_status, NOTHING) * ONE

    return read


def _last_character(number: int) -> Callable[[Unit], int]:
    return lambda unit: string_value(chr(unit.state.ports[number - 1].last_character))


def _last_text(number: int) -> Callable[[Unit], int]:
    def read(unit: Unit) -> int:
        port = unit.state.ports[number - 1]
        port.data_status = NOTHING
        return string_value(port.last_text.decode("latin-1"))

    return read


def _last_number(number: int) -> Callable[[Unit], int]:
    def read(unit: Unit) -> int:
        port = unit.state.ports[number - 1]
        port.data_status = NOTHING
        return read_number(port.last_text.decode("latin-1")) or 0

    return read


DOES: Final = {"CI": interrupts}
KEYWORDS: Final[dict[str, Callable[[Unit], int]]] = {
    f"P{number}{suffix}": reader(number)
    for number in (1, 2)
    for suffix, reader in (("CH", _last_character), ("ST", _last_text), ("NM", _last_number), ("CD", _status))
}
