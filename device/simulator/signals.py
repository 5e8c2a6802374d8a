"""The outside world by name: what a stimulus file, the panel or a test does to the machine."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

from codegen.twoletter.fixed import scaled
from device.simulator.twoletter.behaviour.recording import input_edge
from device.simulator.twoletter.behaviour.trippoints import input_changed
from device.simulator.twoletter.state import AXES

if TYPE_CHECKING:
    from device.simulator.simulation import Simulation

PER_AXIS: Final = ("fls", "rls", "home", "aux", "aux_speed", "position", "load")
TYPED: Final = {"type": 1, "type2": 2}


def names(simulation: Simulation) -> list[str]:
    """Every signal of this model."""
    model = simulation.model
    return [
        *(f"in{number}" for number in range(1, model.inputs + 1)),
        *(f"an{number}" for number in range(1, model.analog_inputs + 1)),
        *(f"{name}_{axis.lower()}" for axis in model.axes for name in PER_AXIS),
        "abort",
        "reset",
        *TYPED,
    ]


def apply(simulation: Simulation, signal: str, value: float | str) -> None:
    """One signal takes a value; KeyError says which signals there are."""
    if signal not in names(simulation):
        raise KeyError(f"no signal {signal!r} on {simulation.model.name}; there are {' '.join(names(simulation))}")
    if signal in TYPED:
        text = str(value).replace("\\r", "\r").replace("\\n", "\n")
        simulation.receive(TYPED[signal], text.encode("latin-1", "replace"))
        return
    number = float(value)
    if not math.isfinite(number):
        raise ValueError(f"{signal}: not a number: {value}")
    if signal == "abort":
        _abort(simulation, number != 0)
    elif signal == "reset":
        _reset(simulation, number != 0)
    elif "_" in signal:
        name, _, letter = signal.rpartition("_")
        _axis_signal(simulation, name, AXES.index(letter.upper()), number)
    elif signal.startswith("in"):
        _input(simulation, int(signal[2:]), number != 0)
    else:
        _analog(simulation, int(signal[2:]), number)


def _input(simulation: Simulation, number: int, level: bool) -> None:
    unit, bit = simulation.unit, 1 << (number - 1)
    state = unit.state
    if bool(state.inputs & bit) != level:
        input_edge(unit, number, level)
    state.inputs = state.inputs | bit if level else state.inputs & ~bit
    unit.motion.set_input(number, level)
    unit.changed = True
    for strand in state.strands():
        if strand.wait is not None and strand.wait.kind == "AI" and strand.wait.number == number:
            input_changed(unit, strand.wait)
    for thread in state.threads:
        for frame in thread.stack:
            if frame.wait is not None and frame.wait.kind == "AI" and frame.wait.number == number:
                input_changed(unit, frame.wait)


def _analog(simulation: Simulation, number: int, volts: float) -> None:
    simulation.unit.state.analog[number - 1] = scaled(volts)
    simulation.unit.motion.set_analog(number, volts)


def _abort(simulation: Simulation, level: bool) -> None:
    """A low level stops motion at once and ends all programs (dmc-1412-1414.txt l.1157)."""
    unit = simulation.unit
    unit.motion.set_abort(level)
    if unit.state.abort_input and not level:
        unit.halt_all()
    unit.state.abort_input = level
    unit.changed = True


def _reset(simulation: Simulation, level: bool) -> None:
    if not level:
        simulation.unit.begin_reset()


def _axis_signal(simulation: Simulation, name: str, axis: int, number: float) -> None:
    motion = simulation.unit.motion
    if name in ("fls", "rls"):
        motion.set_limit(axis, name == "fls", number != 0)
    elif name == "home":
        motion.set_home(axis, number != 0)
    elif name == "aux":
        motion.set_auxiliary(axis, round(number))
    elif name == "aux_speed":
        motion.set_auxiliary_speed(axis, number)
    elif name == "position":
        motion.push(axis, round(number))
    else:
        motion.load(axis, number)
