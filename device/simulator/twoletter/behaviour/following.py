"""Gearing, contour mode and the electronic cam: motion that follows something else."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from codegen.twoletter.evaluate import compile_expression
from codegen.twoletter.fixed import ONE
from codegen.twoletter.nodes import Axes
from device.simulator.motion import Register, Watch
from device.simulator.twoletter.state import AXES, CommandError, NotYet, Port, Strand, Wait

if TYPE_CHECKING:
    from device.simulator.twoletter.calls import Call
    from device.simulator.twoletter.unit import Unit

OWN_MASTER, RECORD_RANGE = 46, 41
CAM_RUNS, BAD_INDEX, NO_MASTER, CYCLE_TOO_LONG, SLAVE_RUNS, NOT_ENABLED = 100, 101, 102, 103, 104, 105
LONGEST_CYCLE: Final = 8_388_607
TABLE_END: Final = 256
MASTERS: Final = {"D": "auxiliary", "C": "commanded"}


def numbers(unit: Unit, call: Call) -> list[tuple[int, int]]:
    """Places with their accepted numbers; error 6 when one is out of range."""
    fields = call.row.fields_for(unit.model)
    found = []
    for place, value in enumerate(call.values):
        if value is None:
            continue
        row = fields[place] if place < len(fields) else call.row
        if not row.accepts(value, unit.model):
            raise CommandError(6)
        found.append((place, row.stored(value)))
    return found


# ------------------------------------------------------------------- gearing


def gear_master(unit: Unit, strand: Strand, call: Call) -> None:
    """GA: one master for all slaves (SSC); X, its auxiliary encoder DX, its commanded position CX, or S."""
    letters = next((item.letters for item in call.command.arguments if isinstance(item, Axes)), "")
    kind = "vector" if letters == "S" else MASTERS.get(letters[:1], "main")
    master = 0 if kind == "vector" else AXES.find(letters[-1:])
    if not 0 <= master < len(unit.model.axes):
        raise CommandError(90)
    own = master if kind in ("main", "commanded") else -1
    if own >= 0 and unit.motion.get(own, Register.GEAR_RATIO) != 0.0:
        raise CommandError(OWN_MASTER)
    unit.state.gear_master = own
    for axis in unit.axes():
        unit.motion.set_gear_master(axis, "none" if axis == own else kind, master)


def gear_ratio(unit: Unit, strand: Strand, call: Call) -> None:
    """GR: engages at once; 0 lets go (dmc-1412-1414.txt l.1793)."""
    given = numbers(unit, call)
    if any(axis == unit.state.gear_master and value for axis, value in given):
        raise CommandError(OWN_MASTER)
    for axis, value in given:
        unit.motion.set(axis, Register.GEAR_RATIO, value / ONE)


# ------------------------------------------------------------------- contour


def contour_mode(unit: Unit, strand: Strand, call: Call) -> None:
    """CM: these axes take contour data (dmc-1412-1414.txt l.1940)."""
    unit.motion.contour.open(call.axes)
    unit.state.settings["DT"] = 0


def delta_time(unit: Unit, strand: Strand, call: Call) -> None:
    """DT n: 2^n samples a record; 0 with CD0 ends the mode."""
    for _, value in numbers(unit, call):
        unit.state.settings["DT"] = value
        unit.state.contour_timed = True


def contour_data(unit: Unit, strand: Strand, call: Call) -> None:
    """CD: one record; a program waits while there is no room (inferred)."""
    given = numbers(unit, call)
    contour = unit.motion.contour
    if not unit.state.contour_timed:
        raise CommandError(unit.profile.contour_untimed_code)
    if not contour.active or any(value and not contour.has(axis) for axis, value in given):
        raise CommandError(RECORD_RANGE)
    if not contour.free:
        if isinstance(strand, Port):
            raise CommandError(unit.profile.contour_full_code)
        watch = unit.motion.watch(Watch.CONTOUR_FREE)
        raise NotYet(Wait("CD", watches=(watch,)))
    contour.give({axis: value // ONE for axis, value in given}, unit.state.settings["DT"] // ONE)


# ----------------------------------------------------------------------- cam


def cam_master(unit: Unit, strand: Strand, call: Call) -> None:
    """EA: the axis whose encoder the cam follows (SSC)."""
    _not_running(unit)
    commanded = unit.profile.cam_follows == "commanded position"
    unit.motion.cam.master(call.axes[0], auxiliary=False, commanded=commanded)
    unit.state.cam_master = call.axes[0]


def _not_running(unit: Unit) -> None:
    if unit.motion.cam.on:
        raise CommandError(CAM_RUNS)


def _needs_master(unit: Unit) -> None:
    if unit.state.cam_master < 0 and unit.model.family == "ssc":
        raise CommandError(NO_MASTER)


def cam_cycle(unit: Unit, strand: Strand, call: Call) -> None:
    """EM: the master's cycle and each slave's net change; 141x: slave,master (dmc-1412-1414.txt l.1811)."""
    _not_running(unit)
    _needs_master(unit)
    cam, state = unit.motion.cam, unit.state
    for place, value in numbers(unit, call):
        counts = value // ONE
        is_master = place == (1 if unit.model.family != "ssc" else state.cam_master)
        if is_master and not 1 <= counts <= LONGEST_CYCLE:
            raise CommandError(6)
        if is_master:
            cam.cycle(counts)
            state.cam_cycle = counts
        else:
            cam.net(place, counts)
        if place < len(state.registers["EM"]):
            state.registers["EM"][place] = value


def cam_interval(unit: Unit, strand: Strand, call: Call) -> None:
    """EP m,n: master counts a table step, and where the table begins."""
    state = unit.state
    for place, value in numbers(unit, call):
        if place == 0:
            _not_running(unit)
        state.cam_interval[place] = value // ONE
    unit.motion.cam.interval(*state.cam_interval)


def cam_table(unit: Unit, strand: Strand, call: Call) -> None:
    """ET[i]=x,y,z,w"""
    if call.command.index is None:
        raise CommandError(BAD_INDEX)
    index = compile_expression(call.command.index)(unit.names) // ONE
    if not 0 <= index <= TABLE_END:
        raise CommandError(BAD_INDEX)
    for axis, value in numbers(unit, call):
        unit.motion.cam.entry(axis, index, value // ONE)


def cam_enable(unit: Unit, strand: Strand, call: Call) -> None:
    """EB1 begins, EB0 ends the mode."""
    on = call.whole(0)
    if on not in (0, 1):
        raise CommandError(6)
    if on:
        _needs_master(unit)
        if not 1 <= unit.state.cam_cycle <= TABLE_END * unit.state.cam_interval[0]:
            raise CommandError(CYCLE_TOO_LONG)
    unit.motion.cam.enable(bool(on))


def cam_engage(unit: Unit, strand: Strand, call: Call) -> None:
    """EG: from that master position on, outside the cycle at once."""
    for axis, value in _cam_places(unit, call):
        unit.motion.cam.engage(axis, value)


def cam_disengage(unit: Unit, strand: Strand, call: Call) -> None:
    """EQ: up to that master position, outside the cycle at once."""
    for axis, value in _cam_places(unit, call):
        unit.motion.cam.disengage(axis, value)


def _cam_places(unit: Unit, call: Call) -> list[tuple[int, int]]:
    if not unit.motion.cam.on:
        raise CommandError(NOT_ENABLED)
    found = [(axis, value // ONE) for axis, value in numbers(unit, call)]
    if unit.model.family == "ssc" and any(axis == unit.state.cam_master for axis, _ in found):
        raise CommandError(SLAVE_RUNS)
    return found


def wait_contour(unit: Unit, strand: Strand, call: Call) -> Wait | None:
    """WC: until the interpolator has taken the last record (commands.md 11)."""
    if unit.motion.contour.free:
        return None
    return Wait("WC", watches=(unit.motion.watch(Watch.CONTOUR_FREE),))


DOES: Final = {
    "GA": gear_master,
    "GR": gear_ratio,
    "CM": contour_mode,
    "DT": delta_time,
    "CD": contour_data,
    "EA": cam_master,
    "EM": cam_cycle,
    "EP": cam_interval,
    "ET": cam_table,
    "EB": cam_enable,
    "EG": cam_engage,
    "EQ": cam_disengage,
}
READS: Final = {
    "GR": lambda unit, axis: round(unit.motion.get(axis, Register.GEAR_RATIO) * ONE),
    "CM": lambda unit, axis: 0 if unit.motion.contour.free else ONE,
    "DT": lambda unit, axis: unit.state.settings["DT"],
    "EM": lambda unit, axis: unit.state.registers["EM"][axis],
    "EP": lambda unit, axis: unit.state.cam_interval[0] * ONE,
    "EB": lambda unit, axis: int(unit.motion.cam.on) * ONE,
    "EG": lambda unit, axis: int(unit.motion.cam.engaged(axis)) * ONE,
}
WAITS: Final = {"WC": wait_contour}
