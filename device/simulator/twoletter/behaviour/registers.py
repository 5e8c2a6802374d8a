"""Plain registers: commands whose whole meaning is a stored number need nothing but their entry here."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from codegen.models import Model
from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.fixed import ONE, scaled
from codegen.twoletter.rows import Takes
from device.simulator.motion import Register
from device.simulator.twoletter.behaviour import limits
from device.simulator.twoletter.state import CommandError, State

if TYPE_CHECKING:
    from device.simulator.twoletter.calls import Call
    from device.simulator.twoletter.unit import Unit

NO_JUMPER: Final = 96
STEPPER: Final = 2 * ONE  # |MT| from here on: stepper


@dataclass(frozen=True, slots=True)
class Store:
    """Where a number goes: per axis or one for all, and the motion register that follows it."""

    per_axis: bool = True
    register: Register | None = None
    apply: Callable[[Unit, int, int], None] | None = None  # (unit, axis, scaled value) after storing
    check: Callable[[Unit, str, int, int], None] | None = None  # refuses a value that the machine does not allow


def _follow(register: Register) -> Store:
    return Store(register=register)


def _mode(name: str, register: Register | None = None) -> Store:
    """A register that also chooses what the next BG does (dmc-1412-1414.txt l.1745)."""

    def choose(unit: Unit, axis: int, value: int) -> None:
        unit.state.modes[axis] = name
        if name == "JG":
            _speed(unit, axis, value)

    return Store(register=register, apply=choose, check=limits.check_target if name != "JG" else None)


def _speed(unit: Unit, axis: int, value: int) -> None:
    unit.state.last_speed[axis] = value
    follow_home_speed(unit, axis)


def chosen_speed(unit: Unit, axis: int, which: str) -> int:
    """The speed of HM or FI: that of SP, of JG, or of the last of both (dmc-1412-1414.txt l.2323)."""
    state = unit.state
    return abs(state.last_speed[axis] if " " in which else state.registers[which][axis])


def follow_profile(unit: Unit, axis: int) -> None:
    """How the sample loop is where the manuals leave it open."""
    profile, motion = unit.profile, unit.motion
    for register, value in (
        (Register.HOME_RAMPED, profile.home_end == "decelerates"),
        (Register.REFERENCE_BIAS, 0.5 if profile.reference_rounding == "nearest" else 0.0),
        (Register.SETTLES_AT_ONCE, not profile.smoothing_tail),
        (Register.READ_LATE, profile.position_read == "sample end"),
    ):
        motion.set(axis, register, float(value))
    follow_home_speed(unit, axis)


def follow_home_speed(unit: Unit, axis: int) -> None:
    unit.motion.set(axis, Register.HOME_SPEED, chosen_speed(unit, axis, unit.profile.home_speed) / ONE)


def _sample_time(unit: Unit, axis: int, value: int) -> None:
    follow_sample_time(unit)


def follow_sample_time(unit: Unit) -> None:
    """TM; negative takes the clock of another controller of the chain (SSC manual l.1231).

    Where there is no other one, the last sample time goes on and a notice says so.
    """
    value = unit.state.settings["TM"]
    if value >= ONE:
        unit.set_sample_time(value // ONE)
    elif not unit.chained:
        unit.notice("no external sample clock is connected (negative TM): the last sample time goes on")


def _look(unit: Unit, axis: int, value: int) -> None:
    unit.changed = True


def _path(setter: str) -> Store:
    """A parameter of coordinated motion."""

    def follow(unit: Unit, axis: int, value: int) -> None:
        getattr(unit.motion.path, setter)(value / ONE)

    return Store(per_axis=False, apply=follow)


def _phase(setter: str, whole: bool = False) -> Store:
    """A setting of sine commutation (DMC-1412)."""

    def follow(unit: Unit, axis: int, value: int) -> None:
        getattr(unit.motion.commutation, setter)(axis, value // ONE if whole else value / ONE)

    return Store(apply=follow)


def _needs_jumper(unit: Unit, name: str, axis: int, value: int) -> None:
    """Stepper types need the SM jumper (SSC manual l.772)."""
    if abs(value) >= STEPPER and not unit.stepper_jumpers[axis]:
        raise CommandError(NO_JUMPER)


STORES: Final[dict[str, Store]] = {
    "PA": _mode("PA"),
    "PR": _mode("PR"),
    "JG": _mode("JG", Register.JOG_SPEED),
    "SP": Store(register=Register.SPEED, apply=_speed),
    "AC": _follow(Register.ACCELERATION),
    "DC": _follow(Register.DECELERATION),
    "IT": _follow(Register.SMOOTHING),
    "KS": _follow(Register.STEP_SMOOTHING),
    "KP": _follow(Register.KP),
    "KI": _follow(Register.KI),
    "KD": _follow(Register.KD),
    "IL": _follow(Register.INTEGRATOR_LIMIT),
    "TL": _follow(Register.TORQUE_LIMIT),
    "OF": _follow(Register.OFFSET),
    "FA": _follow(Register.ACCELERATION_FEED),
    "FV": _follow(Register.VELOCITY_FEED),
    "ER": _follow(Register.ERROR_LIMIT),
    "OE": _follow(Register.OFF_ON_ERROR),
    "FL": _follow(Register.FORWARD_LIMIT),
    "BL": _follow(Register.REVERSE_LIMIT),
    "MT": Store(register=Register.MOTOR_TYPE, check=_needs_jumper),
    "CE": _follow(Register.ENCODER),
    "DV": _follow(Register.DUAL_LOOP),
    "AF": _follow(Register.ANALOG_FEEDBACK),
    "TW": Store(),
    "VS": _path("set_speed"),
    "VA": _path("set_acceleration"),
    "VD": _path("set_deceleration"),
    "VR": _path("set_ratio"),
    "VT": _path("set_smoothing"),
    "TM": Store(per_axis=False, apply=_sample_time),
    "LZ": Store(per_axis=False),
    "EO": Store(per_axis=False),
    "TR": Store(per_axis=False, apply=_look),
    "PF": Store(per_axis=False),
    "VF": Store(per_axis=False),
    "SA": Store(per_axis=False),
    "BB": _phase("set_hall_offset"),
    "BI": _phase("set_hall_inputs", whole=True),
    "BM": _phase("set_cycle"),
    "BO": _phase("set_offset"),
    "CW1": Store(per_axis=False),  # the two fields of CW
    "CW2": Store(per_axis=False),
}
PHASE: Final = frozenset({"BB", "BI", "BM", "BO"})
PATH: Final = frozenset({"VS", "VA", "VD", "VR", "VT"})
FIELDS: Final = {"CW1": 2, "CW2": 0}  # defaults of what is no row of its own


def default(name: str) -> int:
    """The scaled value of a register after a master reset."""
    if name in FIELDS:
        return FIELDS[name]
    value = COMMANDS[name].default
    return scaled(float(value)) if value is not None else 0


def load_defaults(state: State, model: Model) -> None:
    """Factory values of every register."""
    for name, row in STORES.items():
        if row.per_axis:
            state.registers[name] = [default(name)] * len(model.axes)
        else:
            state.settings[name] = default(name)
    state.registers["EM"] = [0] * len(model.axes)
    state.settings["DT"] = 0
    for name in ("GN", "ZR"):
        state.registers[name] = [default(name)] * len(model.axes)
    state.registers["IP"] = [0] * len(model.axes)
    state.modes = ["PR"] * len(model.axes)
    state.last_speed = [default("SP")] * len(model.axes)


def read(unit: Unit, name: str, axis: int) -> int:
    """The scaled value of a register."""
    if STORES[name].per_axis:
        values = unit.state.registers[name]
        if not 0 <= axis < len(values):
            raise CommandError(90)
        return values[axis]
    return unit.state.settings[name]


def is_stepper(unit: Unit, axis: int) -> bool:
    """MT 2, -2, 2.5 or -2.5."""
    return abs(unit.state.registers["MT"][axis]) >= STEPPER


def store(unit: Unit, call: Call) -> None:
    """Checks every place first: out of range is error 6 and all keep their old values."""
    row, name = call.row, call.name
    entry = STORES[name]
    accepted: list[tuple[int, int]] = []
    for axis, value in enumerate(call.values):
        if value is None:
            continue
        if name == "SP":
            value = abs(value)
        stepper = entry.per_axis and row.takes is Takes.AXIS_NUMBERS and is_stepper(unit, axis)
        if not row.accepts(value, unit.model, stepper):
            raise CommandError(6)
        if entry.check is not None:
            entry.check(unit, name, axis, row.stored(value))
        accepted.append((axis, row.stored(value)))
    for axis, value in accepted:
        put(unit, name, axis, value)


def put(unit: Unit, name: str, axis: int, value: int) -> None:
    """Stores an accepted value and lets the motion follow."""
    entry = STORES[name]
    if entry.per_axis:
        unit.state.registers[name][axis] = value
    else:
        unit.state.settings[name] = value
    if entry.register is not None:
        unit.motion.set(axis, entry.register, value / ONE * unit.profile.feed(name))
    if entry.apply is not None:
        entry.apply(unit, axis, value)


def put_all(unit: Unit) -> None:
    """Lets the motion follow every register, after a reset."""
    for name, entry in STORES.items():
        if entry.register is not None:
            for axis, value in enumerate(unit.state.registers[name]):
                unit.motion.set(axis, entry.register, value / ONE * unit.profile.feed(name))
        elif name in PHASE and entry.apply is not None:
            if unit.model.commutation:
                entry.apply(unit, 0, unit.state.registers[name][0])
        elif name in PATH and entry.apply is not None:
            entry.apply(unit, 0, unit.state.settings[name])
