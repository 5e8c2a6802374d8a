"""What the controller tells about itself: error code, stop code, status bits."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from codegen.twoletter.fixed import ONE
from codegen.twoletter.problems import ERROR_TEXTS, STOP_TEXTS
from device.simulator.twoletter import memory
from device.simulator.twoletter.behaviour.motion import home_state
from device.simulator.twoletter.state import CommandError, Strand

if TYPE_CHECKING:
    from device.simulator.twoletter.calls import Call
    from device.simulator.twoletter.unit import Unit


def error_code(unit: Unit, strand: Strand, call: Call) -> None:
    """TC and TC1; reading clears the code (recall)."""
    which = call.whole(0)
    if which not in (0, 1):
        raise CommandError(6)
    code = unit.state.error_code
    if unit.profile.error_code_cleared_by_reading:
        unit.state.error_code = 0
    unit.answer(strand, _told(unit, code) if which else _three(unit, "TC", code))


def _told(unit: Unit, code: int) -> str:
    """The answer to TC1 (dmc-1412-1414.txt l.1403)."""
    form = unit.profile.error_text
    number = f"{code}" if form == "1 text" else f"{code:03d}"
    dash = "- " if form == "001 - text" else ""
    return f"{number} {dash}{ERROR_TEXTS.get(code, '')}".rstrip()


def last_code(unit: Unit, axis: int) -> int:
    """_TC in an expression."""
    code = unit.state.error_code
    if unit.profile.error_code_cleared_by_operand:
        unit.state.error_code = 0
    return code * ONE


def stop_code(unit: Unit, strand: Strand, call: Call) -> None:
    """SC; SC1 with the text (dmc-1412-1414.txt l.2687)."""
    if call.value(0) is not None:
        if call.whole(0) != 1:
            raise CommandError(6)
        code = unit.motion.stop_code(0)
        unit.answer(strand, f"{code} {STOP_TEXTS.get(code, '')}".rstrip())
        return
    unit.answer(strand, ",".join(_three(unit, "SC", unit.motion.stop_code(axis)) for axis in call.axes))


def _three(unit: Unit, name: str, value: int) -> str:
    return unit.formatted_reply(name, "3.0", value * ONE, None)


def switches(unit: Unit, axis: int) -> int:
    """TS: the bits of one axis; limits read "not active" in both polarities (inferred)."""
    motion = unit.motion
    active_high = unit.state.switches[0] == 1 and not unit.profile.limits_follow_level
    bits = (
        motion.moving(axis) << 7
        | motion.error_exceeded(axis) << 6
        | (not motion.motor_on(axis)) << 5
        | (motion.forward_level(axis) != active_high) << 3
        | (motion.reverse_level(axis) != active_high) << 2
        | home_state(unit, axis) << 1
        | (not motion.latch_armed(axis))
    )
    return int(bits) * ONE


def status_byte(unit: Unit, axis: int) -> int:
    """TB: program running, contouring, in an error routine, interrupt enabled, in it, echo."""
    state = unit.state
    kinds = {frame.kind for frame in state.threads[0].stack}
    bits = (
        unit.running() << 7
        | unit.motion.contour.active << 5
        | bool(kinds & {"LIMSWI", "POSERR"}) << 4
        | state.interrupt_armed << 3
        | ("ININT" in kinds) << 2
        | (state.settings["EO"] != 0)
    )
    return int(bits) * ONE


DOES: Final = {"TC": error_code, "SC": stop_code}
READS: Final = {
    "TC": last_code,
    "SC": lambda unit, axis: unit.motion.stop_code(axis) * ONE,
    "TS": switches,
    "TB": status_byte,
    "ED": lambda unit, axis: unit.state.error_line * ONE,
    "DA": lambda unit, axis: memory.free_arrays(unit.state, unit.model) * ONE,
    "DM": lambda unit, axis: memory.free_elements(unit.state, unit.model) * ONE,
    "DL": lambda unit, axis: (unit.model.labels - len(unit.code.labels)) * ONE,
    "UL": lambda unit, axis: (unit.model.variables - len(unit.state.variables)) * ONE,
    "BN": lambda unit, axis: unit.profile.serial_number * ONE,
}
