"""Formats, switches, ports, arrays."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Final, TypeAlias

from codegen.twoletter.evaluate import compile_expression
from codegen.twoletter.fixed import ONE
from codegen.twoletter.nodes import Command, Dimension, Query
from device.simulator.motion import Register
from device.simulator.twoletter import memory
from device.simulator.twoletter.state import CommandError, Strand

if TYPE_CHECKING:
    from device.simulator.twoletter.calls import Call
    from device.simulator.twoletter.compile import Code
    from device.simulator.twoletter.unit import Unit

Op: TypeAlias = Callable[[Strand], int]


def number_format(unit: Unit, strand: Strand, call: Call) -> None:
    """PF m.n and VF m.n, also m,n; m from -8 (hexadecimal) to 10, n from 0 to 4 (dmc-1412-1414.txt l.3765)."""
    value = call.value(0)
    if value is None:
        raise CommandError(50)
    magnitude, sign = abs(value), -1 if value < 0 else 1
    decimals = (magnitude % ONE * 10 + ONE // 2) // ONE
    if call.value(1) is not None:
        decimals = call.whole(1)
    digits = sign * (magnitude // ONE)
    if not (-8 <= digits <= 10 and 0 <= decimals <= 4):
        raise CommandError(6)
    unit.state.settings[call.name] = sign * (magnitude // ONE * ONE + (decimals * ONE + 5) // 10)


def switches(unit: Unit, strand: Strand, call: Call) -> None:
    """CN limits,home,latch: -1 or 1 each; empty places keep theirs."""
    given = [(place, value) for place, value in enumerate(call.values[:3]) if value is not None]
    if any(value not in (ONE, -ONE) for _, value in given):
        raise CommandError(6)
    for place, value in given:
        unit.state.switches[place] = value // ONE
    unit.motion.set_limit_polarity(unit.state.switches[0] == 1)


def port_two(unit: Unit, strand: Strand, call: Call) -> None:
    """CC baud,handshake,mode,echo (dmc-1412-1414.txt l.1286)."""
    fields = call.row.fields_for(unit.model)
    for place, value in enumerate(call.values[:4]):
        if value is not None and not fields[place].accepts(value, unit.model):
            raise CommandError(6)
    for place, value in enumerate(call.values[:4]):
        if value is not None:
            unit.state.port_two[place] = value // ONE
    unit.open_port_two()


def copyright_text(unit: Unit, strand: Strand, call: Call) -> None:
    """CW: the copyright text; CW n,m decides about bit 7 and about a full FIFO (dmc-1412-1414.txt l.1333)."""
    if not call.command.arguments:
        unit.answer(strand, unit.profile.copyright)
        return
    fields = call.row.fields_for(unit.model)
    given = [(place, value) for place, value in enumerate(call.values[:2]) if value is not None]
    if any(not fields[place].accepts(value, unit.model) for place, value in given):
        raise CommandError(6)
    for place, value in given:
        unit.state.settings[("CW1", "CW2")[place]] = value // ONE


def _dimensions(command: Command) -> list[Dimension]:
    return [argument for argument in command.arguments if isinstance(argument, Dimension)]


def _free(command: Command, following: int, unit: Unit, read: Callable[[], int]) -> Op:
    def op(strand: Strand) -> int:
        unit.answer(strand, unit.formatted_reply(command.name, "5.0", read() * ONE, None))
        return following

    return op


def _asks(command: Command) -> bool:
    return any(isinstance(argument, Query) for argument in command.arguments)


def dimension(command: Command, following: int, unit: Unit, code: Code | None) -> Op:
    """DM name[size],…; DM? tells the free elements."""
    if _asks(command):
        return _free(command, following, unit, lambda: memory.free_elements(unit.state, unit.model))
    names = unit.names
    wanted = [
        (item.name, None if item.size is None else compile_expression(item.size)) for item in _dimensions(command)
    ]

    def op(strand: Strand) -> int:
        for name, size in wanted:
            if size is None:
                raise CommandError(55)
            count = size(names) // ONE
            if name in unit.state.arrays and 0 < count <= unit.model.elements:
                raise CommandError(unit.profile.dimension_again_code)
            memory.dimension(unit.state, unit.model, name, count)
        return following

    return op


def deallocate(command: Command, following: int, unit: Unit, code: Code | None) -> Op:
    """DA name[],name…; * all variables, *[0] all arrays; DA? tells how many arrays are free."""
    if _asks(command):
        return _free(command, following, unit, lambda: memory.free_arrays(unit.state, unit.model))
    items = _dimensions(command)

    def op(strand: Strand) -> int:
        state = unit.state
        for item in items:
            if item.name == "*":
                (state.arrays if item.is_array else state.variables).clear()
            elif item.is_array:
                missing = state.arrays.pop(item.name, None) is None
                if missing and unit.profile.deallocate_missing_code:  # else a program with DA can run again
                    raise CommandError(unit.profile.deallocate_missing_code)
            elif state.variables.pop(item.name, None) is None:
                raise CommandError(57)
        return following

    return op


def gain(unit: Unit, strand: Strand, call: Call) -> None:
    """GN and ZR, the old form of KP and KD: KD = GN ZR, KP = GN (1 - ZR)."""
    state = unit.state
    for axis, value in enumerate(call.values):
        if value is None:
            continue
        if not call.row.accepts(value, unit.model):
            raise CommandError(6)
        state.registers[call.name][axis] = call.row.stored(value)
        product = state.registers["GN"][axis] * state.registers["ZR"][axis] // ONE
        for name, register, result in (
            ("KD", Register.KD, product),
            ("KP", Register.KP, state.registers["GN"][axis] - product),
        ):
            state.registers[name][axis] = result
            unit.motion.set(axis, register, result / ONE)


COMPILES: Final = {"DM": dimension, "DA": deallocate}
DOES: Final = {
    "PF": number_format,
    "VF": number_format,
    "CN": switches,
    "CC": port_two,
    "CW": copyright_text,
    "GN": gain,
    "ZR": gain,
}
READS: Final = {
    "GN": lambda unit, axis: unit.state.registers["GN"][axis],
    "ZR": lambda unit, axis: unit.state.registers["ZR"][axis],
}
