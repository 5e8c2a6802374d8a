"""Trippoints: what each waits for. A condition that already holds makes no wait."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Final, TypeAlias

from codegen.twoletter.fixed import ONE
from device.simulator.motion import Watch
from device.simulator.twoletter.state import FOREVER, CommandError, Strand, Wait

if TYPE_CHECKING:
    from device.simulator.twoletter.calls import Call
    from device.simulator.twoletter.unit import Unit

ONLY_BY_DISTANCE: Final = {
    Watch.AFTER_DISTANCE: Watch.AFTER_DISTANCE_ONLY,
    Watch.AFTER_RELATIVE: Watch.AFTER_RELATIVE_ONLY,
}
Waits: TypeAlias = Callable[["Unit", Strand, "Call"], Wait | None]


def _by_axis(name: str, kind: Watch, sequence: Watch) -> Waits:
    """Trippoints that name axes or S; several must all have tripped."""

    def wait(unit: Unit, strand: Strand, call: Call) -> Wait | None:
        wanted = [(kind, axis, 0.0) for axis in call.axes]
        return _watch(unit, name, [*wanted, (sequence, 0, 0.0)] if call.sequence else wanted)

    return wait


def _in_position(unit: Unit, strand: Strand, call: Call) -> Wait | None:
    """MC: profile ended and in position, at most TW samples after the profile (dmc-1412-1414.txt l.2784)."""
    limits = unit.state.registers["TW"]
    return _watch(unit, "MC", [(Watch.IN_POSITION, axis, limits[axis] / ONE) for axis in call.axes])


def _by_number(name: str, kind: Watch) -> Waits:
    """Trippoints with one number at the place of its axis."""

    def wait(unit: Unit, strand: Strand, call: Call) -> Wait | None:
        for axis, value in enumerate(call.values):
            if value is not None:
                if not call.row.accepts(value, unit.model):
                    raise CommandError(6)
                return _watch(unit, name, [(_kind(unit, kind), axis, float(value // ONE))])
        raise CommandError(50)

    return wait


def _kind(unit: Unit, kind: Watch) -> Watch:
    """AD and AR of a controller where the end of the move does not end them."""
    return kind if unit.profile.distance_ends_with_move else ONLY_BY_DISTANCE.get(kind, kind)


def _watch(unit: Unit, name: str, wanted: list[tuple[Watch, int, float]]) -> Wait | None:
    motion = unit.motion
    watches = motion.watch_all(wanted)
    wait = Wait(name, watches=watches, axes=tuple(axis for _, axis, _ in wanted))
    if all(motion.tripped(watch) for watch in watches):
        unit.drop(wait)
        return None
    return wait


def _wait(unit: Unit, strand: Strand, call: Call) -> Wait | None:
    """WT n: n samples."""
    count = call.whole(0)
    if count < 0:
        raise CommandError(6)
    return _until(unit, "WT", unit.sample + count)


def _at_time(unit: Unit, strand: Strand, call: Call) -> Wait | None:
    """AT 0 sets the reference; AT n, AT -n wait from it (dmc-1412-1414.txt l.2766)."""
    count = call.whole(0)
    if count == 0:
        strand.reference = unit.sample
        return None
    due = strand.reference + abs(count)
    if count < 0:
        strand.reference = due
    return _until(unit, "AT", due)


def _until(unit: Unit, name: str, sample: int) -> Wait | None:
    if sample <= unit.sample:
        return None
    return Wait(name, wake=unit.clock.tick_of(sample), sample=sample)


def _after_input(unit: Unit, strand: Strand, call: Call) -> Wait | None:
    """AI n waits for high, AI -n for low; a level, not an edge (dmc-1412-1414.txt l.3951)."""
    number = call.whole(0)
    if not 1 <= abs(number) <= unit.model.inputs:
        raise CommandError(6)
    if unit.hall_mask >> (abs(number) - 1) & 1:  # the motor itself changes this one
        kind = Watch.INPUT_HIGH if number > 0 else Watch.INPUT_LOW
        return _watch(unit, "AI", [(kind, 0, float(abs(number)))])
    wait = Wait("AI", number=abs(number), level=number > 0)
    if input_level(unit, wait.number) == wait.level:
        return None
    return wait


def input_level(unit: Unit, number: int) -> bool:
    return bool(unit.state.inputs >> (number - 1) & 1)


def input_changed(unit: Unit, wait: Wait) -> None:
    """An input has another level: the wait ends at the next sample, or does not end any more."""
    if input_level(unit, wait.number) == wait.level:
        if wait.sample < 0:
            wait.sample = unit.sample + 1
            wait.wake = unit.clock.tick_of(wait.sample)
    else:
        wait.sample, wait.wake = -1, FOREVER
    unit.changed = True


WAITS: Final[dict[str, Waits]] = {
    "AM": _by_axis("AM", Watch.AFTER_MOVE, Watch.PATH_DONE),
    "AS": _by_axis("AS", Watch.AT_SPEED, Watch.PATH_SPEED),
    "MC": _in_position,
    "AD": _by_number("AD", Watch.AFTER_DISTANCE),
    "AR": _by_number("AR", Watch.AFTER_RELATIVE),
    "AP": _by_number("AP", Watch.AFTER_POSITION),
    "MF": _by_number("MF", Watch.FORWARD_PAST),
    "MR": _by_number("MR", Watch.REVERSE_PAST),
    "WT": _wait,
    "AT": _at_time,
    "AI": _after_input,
}
