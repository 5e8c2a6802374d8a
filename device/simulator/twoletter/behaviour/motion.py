"""Independent motion: BG, ST, AB, homing, positions and what tells about them."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Final

from codegen.twoletter.fixed import ONE
from device.simulator.twoletter.behaviour import limits, registers
from device.simulator.twoletter.behaviour.sequences import begin_sequence
from device.simulator.twoletter.state import CommandError, Port, Strand

if TYPE_CHECKING:
    from device.simulator.twoletter.calls import Call
    from device.simulator.twoletter.unit import Unit

MOTOR_OFF, ALREADY_MOVING, AT_LIMIT, BAD_INCREMENT, CONTOURING = 20, 21, 22, 16, 18


def begin(unit: Unit, strand: Strand, call: Call) -> None:
    """BG: all named axes start, or none (begins_as_a_whole)."""
    whole = unit.profile.begins_as_a_whole
    for axis in call.axes if whole else ():
        _check_begin(unit, axis)
    if call.sequence:
        begin_sequence(unit)
    for axis in call.axes:
        if not whole:
            _check_begin(unit, axis)
        _begin_axis(unit, axis)


def _check_begin(unit: Unit, axis: int) -> None:
    motion = unit.motion
    if not motion.motor_on(axis):
        raise CommandError(MOTOR_OFF)
    if motion.moving(axis):
        raise CommandError(ALREADY_MOVING)
    if motion.contour.has(axis):
        raise CommandError(CONTOURING)
    direction = _direction(unit, axis)
    if direction and motion.blocked(axis, direction):
        raise CommandError(AT_LIMIT)
    if unit.state.modes[axis] in ("PA", "PR"):
        limits.check_begin(unit, axis, _target(unit, axis))


def _target(unit: Unit, axis: int) -> int:
    state = unit.state
    if state.modes[axis] == "PA":
        return state.registers["PA"][axis] // ONE
    return unit.motion.reference(axis) + state.registers["PR"][axis] // ONE


def _direction(unit: Unit, axis: int) -> int:
    """Which way the prepared motion goes first: 1, -1 or 0."""
    state, mode = unit.state, unit.state.modes[axis]
    if mode in ("HM", "FE"):
        return -1 if home_state(unit, axis) else 1
    if mode in ("JG", "FI"):
        speed = state.registers["JG"][axis]
        return (speed > 0) - (speed < 0)
    distance = _target(unit, axis) - unit.motion.reference(axis)
    return (distance > 0) - (distance < 0)


def _begin_axis(unit: Unit, axis: int) -> None:
    motion, state = unit.motion, unit.state
    mode = state.modes[axis]
    if mode == "JG":
        motion.begin_jog(axis)
    elif mode == "HM":
        motion.begin_home(axis, home_state(unit, axis))
    elif mode == "FE":
        motion.begin_edge(axis, bool(home_state(unit, axis)) == (unit.profile.edge_direction == "table"))
    elif mode == "FI":
        direction = -1 if state.registers["JG"][axis] < 0 else 1
        motion.begin_index(axis, registers.chosen_speed(unit, axis, unit.profile.index_speed) / ONE, direction)
    else:
        motion.begin_position(axis, _target(unit, axis))


def _prepare(mode: str) -> Callable[[Unit, Strand, Call], None]:
    def prepare(unit: Unit, strand: Strand, call: Call) -> None:
        for axis in call.axes:
            unit.state.modes[axis] = mode

    return prepare


def stop(unit: Unit, strand: Strand, call: Call) -> None:
    """ST: the named axes; without letters all, and programs as the family does it (dmc-1412-1414.txt l.2814)."""
    if call.sequence or not call.named:
        unit.motion.path.stop()
    for axis in call.axes:
        unit.motion.stop(axis)
    if call.named:
        return
    if isinstance(strand, Port) or unit.model.family == "ssc":
        unit.halt_all()


def abort(unit: Unit, strand: Strand, call: Call) -> None:
    """AB: everything at once; AB1 leaves the programs (recall)."""
    _check_flag(call)
    unit.motion.abort_all()
    if call.value(0) is None or call.whole(0) != unit.profile.abort_keeps_programs:
        unit.halt_all()


def _check_flag(call: Call) -> None:
    value = call.value(0)
    if value is not None and not 0 <= value >> 16 <= 1:
        raise CommandError(6)


def increment(unit: Unit, strand: Strand, call: Call) -> None:
    """IP: standing like PR and BG; moving the target or the jog steps on (SSC manual l.2154)."""
    for axis, _ in _numbers(unit, call):
        if not unit.motion.moving(axis) and not unit.motion.motor_on(axis):
            raise CommandError(MOTOR_OFF)
    for axis, value in _numbers(unit, call):
        counts = value // ONE
        limits.refuse(unit, axis, unit.motion.target(axis) + counts)
        unit.state.registers["IP"][axis] = value
        motion = unit.motion
        if motion.moving(axis):
            if not motion.increment(axis, counts):
                raise CommandError(BAD_INCREMENT)
            continue
        direction = (counts > 0) - (counts < 0)
        if direction and motion.blocked(axis, direction):
            raise CommandError(AT_LIMIT)
        motion.begin_position(axis, motion.reference(axis) + counts)


def _numbers(unit: Unit, call: Call) -> list[tuple[int, int]]:
    """Axes with their accepted numbers; error 6 when one is out of range."""
    found = [(axis, value) for axis, value in enumerate(call.values) if value is not None]
    for _, value in found:
        if not call.row.accepts(value, unit.model):
            raise CommandError(6)
    return [(axis, call.row.stored(value)) for axis, value in found]


def define_position(unit: Unit, strand: Strand, call: Call) -> None:
    """DP: encoder and commanded position become n."""
    for axis, value in _numbers(unit, call):
        unit.motion.define_position(axis, value // ONE)


def define_auxiliary(unit: Unit, strand: Strand, call: Call) -> None:
    """DE: the auxiliary encoder; the main one of a stepper (dmc-1412-1414.txt l.2207)."""
    for axis, value in _numbers(unit, call):
        unit.motion.define_auxiliary(axis, value // ONE)


def servo_here(unit: Unit, strand: Strand, call: Call) -> None:
    for axis in call.axes:
        unit.motion.servo_here(axis)


def motor_off(unit: Unit, strand: Strand, call: Call) -> None:
    for axis in call.axes:
        unit.motion.motor_off(axis)


def home_state(unit: Unit, axis: int) -> bool:
    """_HM: the level, inverted by CN's second field (dmc-1412-1414.txt l.2325)."""
    return unit.motion.home_level(axis) != (unit.state.switches[1] == 1)


def _limit(unit: Unit, level: bool) -> int:
    """_LF and _LR: the input's level; or whether the limit is not active (the same with CN -1)."""
    other = unit.profile.limit_operand == "not active" and unit.state.switches[0] == 1
    return ONE if level != other else 0


def position_target(unit: Unit, axis: int) -> int:
    """_PA: the target while moving, else the last commanded stop."""
    motion = unit.motion
    return (motion.target(axis) if motion.moving(axis) else motion.reference(axis)) * ONE


def axis_moving(unit: Unit, axis: int) -> int:
    """_BG; S is the coordinated sequence."""
    return ONE if (unit.motion.moving(axis) if axis >= 0 else unit.motion.path.moving) else 0


def _counts(read: str) -> Callable[[Unit, int], int]:
    def value(unit: Unit, axis: int) -> int:
        return int(getattr(unit.motion, read)(axis)) * ONE

    return value


DOES: Final = {
    "BG": begin,
    "ST": stop,
    "AB": abort,
    "IP": increment,
    "DP": define_position,
    "DE": define_auxiliary,
    "SH": servo_here,
    "MO": motor_off,
    "HM": _prepare("HM"),
    "FE": _prepare("FE"),
    "FI": _prepare("FI"),
}
READS: Final[dict[str, Callable[[Unit, int], int]]] = {
    "TP": _counts("position"),
    "DP": _counts("position"),
    "RP": _counts("reference"),
    "TD": _counts("auxiliary"),
    "DE": _counts("auxiliary"),
    "TE": _counts("error"),
    "PA": position_target,
    "TV": lambda unit, axis: round(unit.motion.velocity(axis)) * ONE,
    "TT": lambda unit, axis: round(unit.motion.torque(axis) * ONE),
    "BG": axis_moving,
    "MO": lambda unit, axis: 0 if unit.motion.motor_on(axis) else ONE,
    "HM": lambda unit, axis: ONE if home_state(unit, axis) else 0,
    "AB": lambda unit, axis: ONE if unit.state.abort_input else 0,
    "IP": lambda unit, axis: unit.state.registers["IP"][axis],
    "_LF": lambda unit, axis: _limit(unit, unit.motion.forward_level(axis)),
    "_LR": lambda unit, axis: _limit(unit, unit.motion.reverse_level(axis)),
    "LF": lambda unit, axis: _limit(unit, unit.motion.forward_level(axis)),
    "LR": lambda unit, axis: _limit(unit, unit.motion.reverse_level(axis)),
}
