"""Sine commutation of the DMC-1412: BA BB BC BD BI BM BO BS BZ (dmc-1412-1414.txt l.680-804)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from codegen.twoletter.fixed import ONE, scaled
from codegen.twoletter.nodes import Axes
from device.simulator.times import TICKS_PER_MS
from device.simulator.twoletter.behaviour import hall_test
from device.simulator.twoletter.state import CommandError, FieldTest, Strand, Wait

if TYPE_CHECKING:
    from device.simulator.twoletter.calls import Call
    from device.simulator.twoletter.unit import Unit

NO_HALLS, NOT_BRUSHLESS, TIMEOUT, NO_MOVEMENT, RUNAWAY = 110, 111, 112, 113, 114
LOOK_MS: Final = 100  # how often BZ looks where the motor is
DRIVE_LOOKS: Final = 15  # how long it waits for the motor to stand
NUDGE_LOOKS: Final = 5
NUDGE_DEGREES: Final = 30.0  # tells a motor that stands at zero from one that does not move
STOOD: Final = 1 / 36  # of a cycle: less is no movement
STANDS: Final = 1 / 20  # of a cycle per second: less is standing
TOO_FAR: Final = 1.5  # cycles: more than any way to the zero
PHASE_MS: Final = 700  # BS without a time
SWEEP: Final = 72  # steps of a cycle, five degrees each


def brushless_axis(unit: Unit, strand: Strand, call: Call) -> None:
    """BA X: two phase signals; BA N: one, the amplifier commutates."""
    letters = "".join(argument.letters for argument in call.command.arguments if isinstance(argument, Axes))
    if letters not in ("X", "N"):
        raise CommandError(50)
    unit.state.brushless = letters == "X"
    unit.motion.commutation.enable(0, unit.state.brushless)


def _must_be_brushless(unit: Unit) -> None:
    if not unit.state.brushless:
        raise CommandError(NOT_BRUSHLESS)


def calibrate(unit: Unit, strand: Strand, call: Call) -> None:
    """BC: the phase is set at the next hall transition (l.796)."""
    _must_be_brushless(unit)
    if hall_test.bits(unit) in (0, 7):
        raise CommandError(NO_HALLS)
    unit.motion.commutation.calibrate(0)


def phase(unit: Unit, strand: Strand, call: Call) -> None:
    """BD degrees: the phase here."""
    _must_be_brushless(unit)
    if unit.profile.phase_operand == "degrees":
        unit.motion.commutation.set_phase(0, _volts_or_degrees(unit, call))
        return
    counts = call.whole(0)
    if not 0 <= counts <= unit.state.registers["BM"][0] // ONE:
        raise CommandError(6)
    unit.motion.commutation.set_phase(0, counts / _phase_unit(unit))


def _phase_unit(unit: Unit) -> float:
    """What a degree is in _BD (phase_operand)."""
    return 1.0 if unit.profile.phase_operand == "degrees" else unit.state.registers["BM"][0] / ONE / 360.0


def _volts_or_degrees(unit: Unit, call: Call) -> float:
    value = call.value(0)
    if value is None:
        raise CommandError(50)
    if not call.row.accepts(value, unit.model):
        raise CommandError(6)
    return value / ONE


# ------------------------------------------------------------------ BZ


def zero(unit: Unit, strand: Strand, call: Call) -> None:
    """BZ V: a still field draws the motor to phase zero; V < 0 leaves the motor on (l.765-771)."""
    volts = _volts_or_degrees(unit, call)
    _begin(unit, strand, FieldTest("BZ", volts, unit.motion.position(0)))
    _drive(unit, strand, 0.0, DRIVE_LOOKS)


def _begin(unit: Unit, strand: Strand, test: FieldTest) -> None:
    _must_be_brushless(unit)
    if unit.motion.moving(0):
        raise CommandError(7)
    if unit.state.field_test is not None:
        raise CommandError(7)
    unit.state.field_test = test


def _drive(unit: Unit, strand: Strand, degrees: float, looks: int) -> None:
    """Turns the field, and waits so many looks."""
    test = _test(unit)
    test.looks = looks
    unit.motion.commutation.hold(0, test.volts, degrees)
    _wait(unit, strand, "BZ", LOOK_MS * TICKS_PER_MS)


def _test(unit: Unit) -> FieldTest:
    assert unit.state.field_test is not None
    return unit.state.field_test


def _wait(unit: Unit, strand: Strand, kind: str, ticks: int) -> None:
    strand.wait = Wait(kind, wake=unit.clock.now + ticks)
    unit.changed = True


def look(unit: Unit, strand: Strand, wait: Wait) -> None:
    """BZ goes on: the motor has run away, is still on its way, stands at zero, or does not move."""
    test, motion = _test(unit), unit.motion
    cycle, moved = unit.state.registers["BM"][0] / ONE, abs(motion.position(0) - test.start)
    if moved > TOO_FAR * cycle:
        _fail(unit, RUNAWAY)
    test.looks -= 1
    if test.looks > 0:
        _wait(unit, strand, "BZ", LOOK_MS * TICKS_PER_MS)
    elif test.stage == "nudge":
        if abs(motion.position(0) - test.mark) < STOOD * cycle:
            _fail(unit, NO_MOVEMENT)
        test.stage = "back"
        _drive(unit, strand, 0.0, DRIVE_LOOKS)
    elif abs(motion.velocity_now(0)) > STANDS * cycle:
        _fail(unit, TIMEOUT)
    elif test.stage == "zero" and moved < STOOD * cycle:
        test.stage, test.mark = "nudge", motion.position(0)
        _drive(unit, strand, NUDGE_DEGREES, NUDGE_LOOKS)
    else:
        unit.end_field()
        if test.volts < 0:
            motion.servo_here(0)


def _fail(unit: Unit, code: int) -> None:
    unit.end_field()
    raise CommandError(code)


# ------------------------------------------------------------------ BS


def setup(unit: Unit, strand: Strand, call: Call) -> None:
    """BS V,T: a cycle there and back by a turning field tells wiring, BM, hall order and offset (l.719-735)."""
    volts, time = call.value(0), call.whole(1, PHASE_MS)
    fields = call.row.fields_for(unit.model)
    if volts is None:
        raise CommandError(50)
    if not fields[0].accepts(volts, unit.model) or not fields[1].accepts(time * ONE, unit.model):
        raise CommandError(6)
    _begin(unit, strand, FieldTest("BS", volts / ONE, unit.motion.position(0), phase_ms=time))
    unit.motion.commutation.hold(0, volts / ONE, 0.0)
    _wait(unit, strand, "BS", time * TICKS_PER_MS)


def turn(unit: Unit, strand: Strand, wait: Wait) -> None:
    """BS goes on: the next five degrees, there and back, each end for a whole phase."""
    test, motion = _test(unit), unit.motion
    step = len(test.seen)
    test.seen.append((motion.position(0), hall_test.bits(unit)))
    if step == 2 * SWEEP + 2:
        unit.end_field()
        for line in hall_test.findings(test.seen, SWEEP, unit.state.registers["BI"][0] // ONE):
            unit.answer(strand, line)
        return
    degrees = 360.0 * (min(step, SWEEP) - max(0, step - SWEEP - 1)) / SWEEP
    at_end = step in (SWEEP, 2 * SWEEP + 1)
    ticks = test.phase_ms * TICKS_PER_MS
    motion.commutation.hold(0, test.volts, degrees)
    _wait(unit, strand, "BS", ticks if at_end else ticks * 4 // SWEEP)


DOES: Final = {"BA": brushless_axis, "BC": calibrate, "BD": phase, "BS": setup, "BZ": zero}
READS: Final = {
    "BC": lambda unit, axis: hall_test.bits(unit) * ONE,
    "BD": lambda unit, axis: scaled(unit.motion.commutation.phase(0) * _phase_unit(unit)),
    "BZ": lambda unit, axis: unit.motion.commutation.counts_to_zero(0) * ONE,
}
ENDS: Final = {"BZ": look, "BS": turn}
