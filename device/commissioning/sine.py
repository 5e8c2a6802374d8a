"""Sine commutation of a DMC-1412: BA, BM, BI and BS; BB and BZ (dmc-1412-1414.txt l.703-804)."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from codegen.twoletter.fixed import ONE
from device import commands
from device.backing_up import REFUSAL_S, exact
from device.commissioning.guarding import columns_of, power_off, switch_off
from device.commissioning.judge import Moved
from device.commissioning.moves import SILENT, TRIAL_ERROR, Trial, move
from device.commissioning.steps import MOST
from device.download import Job
from device.proof import proved
from device.quiet import ready, said, still, until_stopped
from device.tasks import LinkLost, NotAllowed, Steps, Stopped
from device.wire import Kind

if TYPE_CHECKING:
    from device.api import Controller

T = TypeVar("T")
LONGEST_S = 15.0  # that BS or BZ may take: ten seconds (l.739), and more than the longest asked for here
ZERO_S = 3.0  # that BZ takes
LARGEST_CYCLE = MOST - 100  # counts: BS turns one whole cycle each way


@dataclass(frozen=True, slots=True)
class Phases:
    """What BS needs: counts of a magnetic cycle, first hall input (0: none), volts, milliseconds for each phase."""

    axis: str
    cycle: Fraction
    halls: int
    volts: Fraction
    time_ms: int = 200

    @property
    def problem(self) -> str:
        if not 1 <= self.cycle <= LARGEST_CYCLE:
            return (
                f"the motor turns a whole magnetic cycle, and no step moves it by more than {MOST} counts: a cycle of "
                f"1 to {LARGEST_CYCLE} counts can be tested here."
            )
        if not 0 < self.volts <= 3:
            return "the voltage lies above 0, and at most at 3 V."
        if not 50 <= self.time_ms <= 700:
            return "the time for each phase is 50 to 700 ms."
        return "" if 0 <= self.halls <= 5 else "the hall sensors begin at input 1 to 5."

    @property
    def seconds(self) -> float:
        """How long the controller turns the motor there and back, and hears nothing meanwhile, STOP included."""
        return 11 * self.time_ms / 1000


def try_phases(c: Controller, phases: Phases) -> Steps[str]:
    """BA, BM and BI with the motor off, then BS; the controller answers when the motor has turned there and back."""
    if phases.problem:
        raise NotAllowed(f"Not tested: {phases.problem}")
    axis = phases.axis
    yield from _before_field(c, axis)
    yield from said(c, f"BA {axis}")
    yield from said(c, f"BM {float(phases.cycle):.4f}".rstrip("0").rstrip("."))
    if phases.halls:
        yield from said(c, f"BI {phases.halls}")
    line = f"BS {float(phases.volts):g},{phases.time_ms}"
    answer = yield from _field(c, axis, proved(c.nonces, line, LONGEST_S, REFUSAL_S), phases.seconds)
    if answer.kind is Kind.SILENT:
        raise LinkLost(f"The controller did not answer “{line}”.")
    return answer.text if answer.kind is Kind.ACCEPTED else ""


def drive_to_zero(c: Controller, axis: str, volts: Fraction, offset: int) -> Steps[tuple[commands.Reply, int | None]]:
    """BB and BZ; positive volts leave the motor off (l.765). The counts to phase zero with it."""
    if not 0 < volts <= 3:
        raise NotAllowed("Not moved: the voltage lies above 0, and at most at 3 V.")
    yield from _before_field(c, axis)
    yield from said(c, f"BB {offset}")
    reply = yield from _field(c, axis, commands.typed(c, f"BZ {float(volts):g}", LONGEST_S), ZERO_S)
    told = yield from exact(c.nonces, [f"_BZ{axis}"], columns_of(c))
    return reply, None if told[0] is None else told[0] // ONE


def by_halls(
    c: Controller,
    axis: str,
    cycle: Fraction,
    torque: Fraction,
    folder: Path,
    now: datetime,
    job: Job[Moved],
    silent: int = SILENT,
) -> Steps[tuple[Moved, int, int]]:
    """BC and a move over more than a sixth of the cycle (l.788-804); the state of the halls before and after it."""
    if not 6 <= cycle <= LARGEST_CYCLE:
        raise NotAllowed(f"Not moved: type the magnetic cycle first, 6 to {LARGEST_CYCLE} counts.")
    counts = max(int(cycle * 3 / 8), TRIAL_ERROR + 1)
    before = yield from exact(c.nonces, [f"_BC{axis}"], columns_of(c))
    trial = Trial(axis, counts, torque=torque, before=f"BC {axis}", silent=silent)
    moved = yield from move(c, trial, folder, now, job)
    after = yield from exact(c.nonces, [f"_BC{axis}"], columns_of(c))
    return moved, (before[0] or 0) // ONE, (after[0] or 0) // ONE


def _before_field(c: Controller, axis: str) -> Steps[None]:
    model = ready(c, axis, "Not tested")
    if model.name != "dmc1412":
        raise NotAllowed("Not tested: only the DMC-1412 commutates a motor.")
    yield from still(c, model, "Not tested")
    yield from switch_off(c, axis)


def _field(c: Controller, axis: str, steps: Steps[T], deaf_s: float) -> Steps[T]:
    """What turns the field, and lets nothing be heard for `deaf_s`; whatever comes of it, the motor is off then."""
    try:
        result = yield from steps
    except Stopped as stop:
        yield from until_stopped(c, deaf_s)
        yield from power_off(c, axis)
        raise Stopped(
            "STOP was pressed; the controller heard it when the motor had turned. The motor is off."
        ) from stop
    yield from power_off(c, axis)
    return result
