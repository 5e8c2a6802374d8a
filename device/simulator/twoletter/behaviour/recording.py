"""Automatic capture into arrays (RA RD RC) and the position latch (AL RL)."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Final

from codegen.twoletter.fixed import ONE
from codegen.twoletter.nodes import Dimension, Operand
from device.simulator.twoletter.behaviour.following import numbers
from device.simulator.twoletter.behaviour.io import converted
from device.simulator.twoletter.behaviour.status import switches
from device.simulator.twoletter.state import AXES, CommandError, Recording, Strand

if TYPE_CHECKING:
    from device.simulator.twoletter.calls import Call
    from device.simulator.twoletter.unit import Unit

RUNNING, NOTHING_CHOSEN, UNDEFINED_ARRAY, BAD_SOURCE = 80, 81, 82, 57
TORQUE_FULL: Final = 32767  # what 10 V are recorded as (commands.md 4)
SWITCHES_RECORDED: Final = 0b11111 * ONE  # of TS only bits 0 to 4 are valid (dmc-1412-1414.txt l.3433)


def _idle(unit: Unit) -> Recording:
    record = unit.state.recording
    if record.interval:
        raise CommandError(RUNNING)
    return record


def record_arrays(unit: Unit, strand: Strand, call: Call) -> None:
    """RA: the arrays, in the order of RD's sources (dmc-1412-1414.txt l.3411)."""
    record = _idle(unit)
    names = [item.name for item in call.command.arguments if isinstance(item, Dimension)]
    if any(name not in unit.state.arrays for name in names):
        raise CommandError(UNDEFINED_ARRAY)
    if len(names) > unit.model.recorded_channels:
        raise CommandError(6)
    record.arrays = names


def record_data(unit: Unit, strand: Strand, call: Call) -> None:
    """RD: what goes into them."""
    record = _idle(unit)
    sources = [(item.name, item.suffix) for item in call.command.arguments if isinstance(item, Operand)]
    if any(name not in RECORDED for name, _ in sources):
        raise CommandError(BAD_SOURCE)
    record.sources = [(name, max(0, AXES.find(suffix or "X"))) for name, suffix in sources]


def record_start(unit: Unit, strand: Strand, call: Call) -> None:
    """RC n,m: every 2^n samples, m elements, round and round when m is negative; RC0 stops."""
    record, given = unit.state.recording, dict(numbers(unit, call))
    exponent = given.get(0, 0) // ONE
    if exponent == 0:
        record.interval = 0
        unit.changed = True
        return
    _idle(unit)
    channels = list(zip(record.arrays, record.sources, strict=False))
    if not channels:
        raise CommandError(NOTHING_CHOSEN)
    if any(name not in unit.state.arrays for name, _ in channels):
        raise CommandError(UNDEFINED_ARRAY)
    shortest = min(len(unit.state.arrays[name]) for name, _ in channels)
    count = given[1] // ONE if 1 in given else shortest
    if not 1 <= abs(count) <= shortest:
        raise CommandError(6)
    record.interval, record.index, record.count, record.circular = 1 << exponent, 0, abs(count), count < 0
    record.sample = unit.sample + 1
    unit.changed = True


def take(unit: Unit) -> None:
    """Records one element of every channel; called at the sample it is due."""
    record, arrays = unit.state.recording, unit.state.arrays
    for name, (source, axis) in zip(record.arrays, record.sources, strict=False):
        array = arrays.get(name)
        if array is None or record.index >= len(array):  # freed meanwhile
            record.interval = 0
            return
        array[record.index] = RECORDED[source](unit, axis)
    record.index += 1
    record.sample += record.interval
    if record.index >= record.count:
        record.index = 0 if record.circular else record.index
        record.interval = record.interval if record.circular else 0


def arm_latch(unit: Unit, strand: Strand, call: Call) -> None:
    """AL: the next edge of the latch input stores the position (dmc-1412-1414.txt l.2392)."""
    for axis in call.axes:
        unit.motion.arm_latch(axis)


def input_edge(unit: Unit, number: int, rising: bool) -> None:
    """An input has changed: latches whose edge it is capture."""
    if number in unit.model.latch_inputs and rising == (unit.state.switches[2] == 1):
        unit.motion.latch(number - 1)


RECORDED: Final[dict[str, Callable[[Unit, int], int]]] = {
    "DE": lambda unit, axis: unit.motion.auxiliary(axis) * ONE,
    "TP": lambda unit, axis: unit.motion.position(axis) * ONE,
    "TE": lambda unit, axis: unit.motion.error(axis) * ONE,
    "SH": lambda unit, axis: unit.motion.reference(axis) * ONE,
    "RL": lambda unit, axis: unit.motion.latched(axis) * ONE,
    "TI": lambda unit, axis: unit.inputs * ONE,
    "OP": lambda unit, axis: unit.state.outputs * ONE,
    "TS": lambda unit, axis: switches(unit, axis) & SWITCHES_RECORDED,
    "SC": lambda unit, axis: unit.motion.stop_code(axis) * ONE,
    "NO": lambda unit, axis: unit.motion.status_word(axis) * ONE,
    "TT": lambda unit, axis: round(unit.motion.torque(axis) / 10.0 * TORQUE_FULL) * ONE,
    "AF": lambda unit, axis: converted(unit.state.analog[axis]) if axis < len(unit.state.analog) else 0,
}
DOES: Final = {"RA": record_arrays, "RD": record_data, "RC": record_start, "AL": arm_latch}
READS: Final[dict[str, Callable[[Unit, int], int]]] = {
    "RC": lambda unit, axis: ONE if unit.state.recording.interval else 0,
    "RD": lambda unit, axis: unit.state.recording.index * ONE,
    "RL": lambda unit, axis: unit.motion.latched(axis) * ONE,
    "AL": lambda unit, axis: int(unit.motion.latch_armed(axis)) * ONE,
}
