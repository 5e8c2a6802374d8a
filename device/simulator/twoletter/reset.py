"""Power-up and reset: what is cleared, what the EEPROM brings back, and #AUTO."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from codegen.twoletter.fixed import ONE, scaled
from device.simulator.motion import Register
from device.simulator.twoletter import burned
from device.simulator.twoletter.behaviour import registers
from device.simulator.twoletter.state import fresh

if TYPE_CHECKING:
    from device.simulator.twoletter.unit import Unit

CHECK_SUM_ERROR: Final = 14


def power_up(unit: Unit) -> None:
    """Factory values, then what was burned; #AUTO starts when a burned program has it (dmc-1412-1414.txt l.2967)."""
    _load(unit)
    if "AUTO" in unit.code.labels and unit.eeprom.part("program") is not None:
        unit.start(0, unit.code.labels["AUTO"])


def begin(unit: Unit) -> None:
    """Motion and programs end at once, outputs and ports are cleared."""
    unit.halt_all()
    for strand in unit.state.strands():
        unit.drop(strand.wait)
        strand.wait = None
    for port in unit.state.ports:
        port.pending, port.mode, port.download = None, "command", None
        port.text.clear()
    for uart in unit.uarts:
        uart.clear()
    unit.end_field()
    motion = unit.motion
    motion.abort_all()
    motion.cam.enable(False)
    motion.contour.open(())
    motion.path.clear()
    motion.forget()
    for axis in unit.axes():
        motion.motor_off(axis)
    unit.state.outputs = 0
    motion.set_outputs(0)
    unit.state.command_at = -1
    unit.state.reset_at = unit.after_ms(unit.profile.reset_ms)
    unit.changed = True


def finish(unit: Unit) -> None:
    """The controller is back: prompt, then #AUTO."""
    unit.state.reset_at = -1
    _load(unit)
    unit.reply(1, b":")
    if "AUTO" in unit.code.labels and unit.eeprom.part("program") is not None:
        unit.start(0, unit.code.labels["AUTO"])


def _load(unit: Unit) -> None:
    """Everything as after power-up; inputs and the machine stay as they are."""
    before = unit.state
    state = unit.state = fresh(unit.model)
    state.inputs, state.analog, state.abort_input = before.inputs, before.analog, before.abort_input
    state.selected, state.ports[0].silent = before.selected, not before.selected  # %n stays until the next
    state.clock_offset = unit.sample
    registers.load_defaults(state, unit.model)
    _load_profile(unit)
    motors_on = [True] * len(unit.model.axes)
    parameters = unit.eeprom.part("parameters")
    if parameters is not None:
        motors_on = burned.load_parameters(unit, parameters)
    if unit.eeprom.damaged:
        state.error_code = CHECK_SUM_ERROR
    burned.load_variables(unit)
    unit.set_program(tuple(unit.eeprom.part("program") or ()))
    _start_motion(unit, motors_on)
    unit.open_port_two()


def _load_profile(unit: Unit) -> None:
    """What a master reset sets otherwise than the command table says."""
    state, profile = unit.state, unit.profile
    state.settings["LZ"] = profile.leading_zeros_removed * ONE
    state.settings["EO"] = profile.echo * ONE
    state.settings["CW1"] = profile.mark
    state.port_two[0] = profile.port_two_baud
    for name, change in profile.commands.items():
        if "default" not in change:
            continue
        value = scaled(float(change["default"]))
        if name in state.registers:
            state.registers[name] = [value] * len(unit.model.axes)
        elif name in state.settings:
            state.settings[name] = value
    state.last_speed = list(state.registers["SP"])


def _start_motion(unit: Unit, motors_on: list[bool]) -> None:
    state, motion = unit.state, unit.motion
    registers.follow_sample_time(unit)
    registers.put_all(unit)
    kind = "none" if unit.model.family == "ssc" else "auxiliary"
    for axis in unit.axes():
        motion.set_gear_master(axis, kind, axis)
        motion.set(axis, Register.GEAR_RATIO, 0.0)
        registers.follow_profile(unit, axis)
    motion.cam.master(0, auxiliary=unit.model.family != "ssc")
    motion.set_limit_polarity(state.switches[0] == 1)
    motion.path.turns_back = unit.profile.tangent_turns != "unwrapped"
    motion.set_outputs(state.outputs)
    if unit.model.commutation:
        motion.commutation.enable(0, state.brushless)
        if not motion.commutation.estimate(0):
            motion.commutation.set_phase(0, 0.0)  # unknown: the loop is unstable until BZ (l.750)
    for axis, on in enumerate(motors_on):
        motion.define_position(axis, 0)
        motion.define_auxiliary(axis, 0)
        if on:
            motion.servo_here(axis)
        else:
            motion.motor_off(axis)
