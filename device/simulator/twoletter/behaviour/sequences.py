"""Coordinated motion: linear and vector sequences."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Final

from codegen.twoletter.fixed import ONE
from codegen.twoletter.nodes import Axes
from device.simulator.motion import Watch
from device.simulator.twoletter.behaviour.following import numbers
from device.simulator.twoletter.state import AXES, CommandError, Strand, Wait

if TYPE_CHECKING:
    from device.simulator.twoletter.calls import Call
    from device.simulator.twoletter.unit import Unit

NO_SEQUENCE, COORDINATED_RUNS, MOTOR_OFF, MOVING, BAD_PLANE, EMPTY = 24, 29, 20, 21, 28, 30
TOO_FEW: Final = 50
LONGEST_ARC: Final = 450_000_000  # radius times sweep, counts and degrees (commands.md 7)
SHORTEST_SWEEP: Final = 0.0001


def _not_running(unit: Unit) -> None:
    if unit.motion.path.moving:
        raise CommandError(COORDINATED_RUNS)


def linear_mode(unit: Unit, strand: Strand, call: Call) -> None:
    """LM: linear interpolation of these axes; a running sequence goes on when they are the same."""
    path = unit.motion.path
    if path.moving and (path.opened != "linear" or path.members != call.axes):
        raise CommandError(COORDINATED_RUNS)
    if not path.moving:
        path.linear(call.axes)


def linear_segment(unit: Unit, strand: Strand, call: Call) -> None:
    """LI: an increment for each axis of LM."""
    path = unit.motion.path
    if path.opened != "linear":
        raise CommandError(33 if path.opened else NO_SEQUENCE)
    counts = {axis: value // ONE for axis, value in numbers(unit, call)}
    _added(unit, path.line(counts, _speed(unit, call)))


def _speed(unit: Unit, call: Call) -> float | None:
    """The speed given with a segment; without one that of the segment before it, or VS (segment_speed_stays)."""
    if call.speed is None:
        return None if unit.profile.segment_speed_stays else unit.state.settings["VS"] / ONE
    return call.speed / ONE // 2 * 2


def _added(unit: Unit, error: int) -> None:
    if error == EMPTY and unit.profile.empty_segment == "left out":
        return
    if error:
        raise CommandError(error)


def vector_mode(unit: Unit, strand: Strand, call: Call) -> None:
    """VM: the plane of two axes, and a third that follows the tangent."""
    _not_running(unit)
    letters = next((item.letters for item in call.command.arguments if isinstance(item, Axes)), "")
    axes = [AXES.find(letter) for letter in letters]
    if any(axis >= len(unit.model.axes) for axis in axes):
        raise CommandError(90)
    if len(axes) == 2 and unit.profile.plane_needs_tangent:
        raise CommandError(TOO_FEW)
    if len(axes) < 2 or axes[0] == axes[1] or min(axes[:2]) < 0:
        raise CommandError(BAD_PLANE)
    unit.motion.path.vector(axes[0], axes[1], axes[2] if len(axes) > 2 and axes[2] >= 0 else None)


def _vector(unit: Unit) -> None:
    opened = unit.motion.path.opened
    if opened != "vector":
        raise CommandError(33 if opened else NO_SEQUENCE)


def vector_point(unit: Unit, strand: Strand, call: Call) -> None:
    """VP: a straight line to a point of the plane."""
    _vector(unit)
    (_, first), (_, second) = _all(unit, call, 2)
    _added(unit, unit.motion.path.point(first // ONE, second // ONE, _speed(unit, call)))


def arc(unit: Unit, strand: Strand, call: Call) -> None:
    """CR: radius, start angle and sweep in degrees."""
    _vector(unit)
    (_, radius), (_, start), (_, sweep) = _all(unit, call, 3)
    degrees = sweep / ONE
    if abs(degrees) < SHORTEST_SWEEP or abs(degrees) * (radius // ONE) > LONGEST_ARC:
        raise CommandError(6)
    _added(unit, unit.motion.path.arc(radius // ONE, start / ONE, degrees, _speed(unit, call)))


def _all(unit: Unit, call: Call, count: int) -> list[tuple[int, int]]:
    given = numbers(unit, call)
    if len(given) < count:
        raise CommandError(50)
    return given[:count]


def sequence_end(unit: Unit, strand: Strand, call: Call) -> None:
    """LE and VE: slow down to a stop at the last point."""
    if not unit.motion.path.opened:
        raise CommandError(NO_SEQUENCE)
    unit.motion.path.end()


def clear_sequence(unit: Unit, strand: Strand, call: Call) -> None:
    unit.motion.path.clear()


def ellipse(unit: Unit, strand: Strand, call: Call) -> None:
    """ES m,n: stretches the first or the second axis, or (ellipse) makes it go less far."""
    (_, first), (_, second) = _all(unit, call, 2)
    unit.motion.path.set_scale(first / ONE, second / ONE, shrinks=unit.profile.ellipse == "shrinks")


def tangent(unit: Unit, strand: Strand, call: Call) -> None:
    """TN m,n: counts a degree of the tangent axis, and its position at angle 0; an empty place keeps its value."""
    for place, value in numbers(unit, call):
        unit.state.tangent[place] = value
    unit.motion.path.set_tangent(unit.state.tangent[0] / ONE, unit.state.tangent[1] / ONE)


def begin_sequence(unit: Unit) -> None:
    """BGS"""
    motion = unit.motion
    if not motion.path.ready:
        raise CommandError(NO_SEQUENCE)
    if motion.path.moving:
        raise CommandError(MOVING)
    for axis in motion.path.members:
        if not motion.motor_on(axis):
            raise CommandError(MOTOR_OFF)
        if motion.moving(axis):
            raise CommandError(MOVING)
    motion.path.begin()


def after_distance(unit: Unit, strand: Strand, call: Call) -> Wait | None:
    """AV n: path length since the start or the last AV."""
    value = numbers(unit, call)
    watch = unit.motion.watch(Watch.PATH_DISTANCE, 0, value[0][1] / ONE if value else 0.0)
    wait = Wait("AV", watches=(watch,))
    if unit.motion.tripped(watch):
        unit.drop(wait)
        return None
    return wait


def sequence_length(unit: Unit, axis: int) -> int:
    """_LE and _VE."""
    path = unit.motion.path
    return int(path.length if unit.profile.sequence_length == "all segments" else path.to_come) * ONE


def _path(read: str) -> Callable[[Unit, int], int]:
    def value(unit: Unit, axis: int) -> int:
        return int(getattr(unit.motion.path, read)) * ONE

    return value


DOES: Final = {
    "LM": linear_mode,
    "LI": linear_segment,
    "LE": sequence_end,
    "VM": vector_mode,
    "VP": vector_point,
    "CR": arc,
    "VE": sequence_end,
    "ES": ellipse,
    "TN": tangent,
    "CS": clear_sequence,
}
READS: Final[dict[str, Callable[[Unit, int], int]]] = {
    "LM": _path("free"),
    "LE": sequence_length,
    "VE": sequence_length,
    "CS": _path("segment"),
    "AV": _path("travelled"),
    "TN": _path("tangent_start"),
    "VP": lambda unit, axis: int(unit.motion.path.last_point(axis)) * ONE,
}
WAITS: Final = {"AV": after_distance}
