"""The state of a simulation as plain values: the shape of `run --json`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from codegen.twoletter.fixed import ONE, string_text
from device.simulator.times import TICKS

if TYPE_CHECKING:
    from device.simulator.simulation import Simulation


def state(simulation: Simulation) -> dict[str, Any]:
    """Positions in counts, inputs and outputs as TI and OP have them, lines from 0."""
    facts, unit = simulation.unit.state, simulation.unit
    strings = {name: string_text(facts.variables[name]) for name in sorted(facts.strings & facts.variables.keys())}
    return {
        "controller": simulation.model.name,
        "virtual_seconds": simulation.ticks / TICKS,
        "messages": [list(message) for message in simulation.unit.records.told()],
        "errors": [dict(error) for error in simulation.errors],
        "axes": {letter: _axis(simulation, axis) for axis, letter in enumerate(simulation.model.axes)},
        "inputs": facts.inputs,
        "outputs": facts.outputs,
        "analog": [volts / ONE for volts in facts.analog],
        "error_output": error_output(simulation),
        "variables": {name: _plain(value) for name, value in facts.variables.items()},
        "strings": strings,
        "arrays": {name: [_plain(value) for value in values] for name, values in facts.arrays.items()},
        "threads": [
            {
                "running": thread.running,
                "line": unit.current_line(thread) if thread.running else -1,
                "waiting_for": thread.wait.kind if thread.wait is not None else None,
            }
            for thread in facts.threads
        ],
        "notices": list(simulation.notices),
    }


def error_output(simulation: Simulation) -> bool:
    """The ERROR output: an axis beyond its error limit, or reset active (dmc-1412-1414.txt l.1182)."""
    motion = simulation.unit.motion
    return simulation.unit.state.reset_at >= 0 or any(motion.error_exceeded(axis) for axis in simulation.unit.axes())


def _plain(value: int) -> int | float:
    return value // ONE if value % ONE == 0 else value / ONE


def _axis(simulation: Simulation, axis: int) -> dict[str, Any]:
    motion = simulation.unit.motion
    return {
        "commanded": motion.reference(axis),
        "actual": motion.position(axis),
        "error": motion.error(axis),
        "velocity": motion.velocity(axis),
        "torque": motion.torque(axis),
        "stop_code": motion.stop_code(axis),
        "motor_on": bool(motion.motor_on(axis)),
        "amp_enable": bool(motion.amplifier_enabled(axis)),
        "moving": bool(motion.moving(axis)),
    }
