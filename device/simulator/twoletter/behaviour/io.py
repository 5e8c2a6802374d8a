"""Inputs and outputs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from codegen.twoletter.fixed import ONE
from device.simulator.twoletter.state import CommandError, Strand

if TYPE_CHECKING:
    from device.simulator.twoletter.calls import Call
    from device.simulator.twoletter.unit import Unit

CONVERTER_COUNTS: Final = 2048  # 12 bits over +/-10 V: 0.005 V a count (SSC manual l.1404)
CONVERTER_VOLTS: Final = 10


def converted(volts: int) -> int:
    """What the converter of the analog inputs makes of a voltage; both in 1/65536 V."""
    counts = (volts * CONVERTER_COUNTS * 2 + CONVERTER_VOLTS * ONE) // (2 * CONVERTER_VOLTS * ONE)
    counts = min(max(counts, -CONVERTER_COUNTS), CONVERTER_COUNTS - 1)
    return counts * CONVERTER_VOLTS * ONE // CONVERTER_COUNTS


def _set_output(unit: Unit, number: int, on: bool) -> None:
    if not 1 <= number <= unit.model.outputs:
        raise CommandError(6)
    bit = 1 << (number - 1)
    set_outputs(unit, unit.state.outputs | bit if on else unit.state.outputs & ~bit)


def set_outputs(unit: Unit, byte: int) -> None:
    """All outputs at once; the motion keeps a copy for its trace."""
    unit.state.outputs = byte
    unit.motion.set_outputs(byte)


def set_bit(unit: Unit, strand: Strand, call: Call) -> None:
    _set_output(unit, call.whole(0), True)


def clear_bit(unit: Unit, strand: Strand, call: Call) -> None:
    _set_output(unit, call.whole(0), False)


def output_bit(unit: Unit, strand: Strand, call: Call) -> None:
    """OB n,expression: on when it is not zero (dmc-1412-1414.txt l.3918)."""
    value = call.value(1)
    if value is None:
        raise CommandError(50)
    _set_output(unit, call.whole(0), value != 0)


def output_port(unit: Unit, strand: Strand, call: Call) -> None:
    value = call.value(0)
    if value is None:
        raise CommandError(50)
    if not 0 <= value >> 16 <= unit.model.op_max:
        raise CommandError(6)
    set_outputs(unit, value >> 16)


def input_interrupt(unit: Unit, strand: Strand, call: Call) -> None:
    """II first,last,mask; a range counts before the mask (dmc-1412-1414.txt l.3973)."""
    first, last, mask = call.value(0), call.value(1), call.value(2)
    count = unit.model.inputs
    if first is None:
        bits = call.whole(2) if mask is not None else 0
        if not 0 <= bits < 1 << count:
            raise CommandError(6)
    else:
        low = first >> 16
        high = low if last is None else last >> 16
        if not (0 <= low <= count and 0 <= high <= count):
            raise CommandError(6)
        bits = sum(1 << (number - 1) for number in range(max(low, 1), high + 1)) if low else 0
    unit.state.interrupt_mask = bits
    unit.state.interrupt_armed = bits != 0
    unit.changed = True


DOES: Final = {
    "SB": set_bit,
    "CB": clear_bit,
    "OB": output_bit,
    "OP": output_port,
    "II": input_interrupt,
}
READS: Final = {
    "OP": lambda unit, axis: unit.state.outputs * ONE,
    "TI": lambda unit, axis: unit.inputs * ONE,
}
