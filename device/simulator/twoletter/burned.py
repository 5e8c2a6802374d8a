"""What is burned, and how a reset brings it back."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from device.simulator.twoletter.behaviour import registers

if TYPE_CHECKING:
    from device.simulator.twoletter.unit import Unit

OLD_FILTER: Final = ("GN", "ZR")  # kept beside the registers that follow them


def parameters(unit: Unit) -> dict[str, Any]:
    """The parameter set of BN (commands.md, BN contents)."""
    state = unit.state
    saved = {name: entry for name, entry in registers.STORES.items() if unit.rows[name[:2]].burned}
    registers_kept = [*(name for name, entry in saved.items() if entry.per_axis), *OLD_FILTER]
    return {
        "registers": {name: list(state.registers[name]) for name in registers_kept},
        "settings": {name: state.settings[name] for name, entry in saved.items() if not entry.per_axis},
        "switches": list(state.switches),
        "port_two": list(state.port_two),
        "outputs": state.outputs,
        "brushless": state.brushless,
        "motors_on": [unit.motion.motor_on(axis) for axis in unit.axes()],
    }


def load_parameters(unit: Unit, burned: dict[str, Any]) -> list[bool]:
    """Puts burned parameters back; answers which motors are to be on."""
    state = unit.state
    for name, values in burned["registers"].items():
        if name in state.registers and len(values) == len(state.registers[name]):
            state.registers[name] = list(values)
    state.last_speed = list(state.registers["SP"])
    for name, value in burned["settings"].items():
        if name in state.settings:
            state.settings[name] = value
    state.switches = list(burned["switches"])
    state.port_two = list(burned["port_two"])
    if unit.profile.burns_outputs:
        state.outputs = burned["outputs"]
    state.brushless = bool(burned.get("brushless", False))
    return [bool(on) for on in burned["motors_on"]]


def load_variables(unit: Unit) -> None:
    """Burned variables and arrays."""
    variables, arrays = unit.eeprom.part("variables"), unit.eeprom.part("arrays")
    if variables is not None:
        unit.state.variables = dict(variables["values"])
        unit.state.strings = set(variables["strings"])
    if arrays is not None:
        unit.state.arrays = {name: list(values) for name, values in arrays.items()}
