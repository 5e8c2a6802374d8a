"""Bounded moves, as steps for the link.

A move is a relative one that is longer than the error limit around it: an axis that does not follow (a dead encoder,
no power, the wrong polarity) is switched off by the controller itself, in the sample in which it happens, whether
this computer lives or not. Former values are on disk before the first change, and put back with the motor off.

How far a motor runs whose encoder dies on the way depends on how much error is left to the limit. So every move begins
with a very small error limit, and with it little force; where that ends it, it goes on with a slightly larger one. And
so that little error is little force whatever the axis was tuned to, no gain is above that of the factory meanwhile.
"""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import datetime
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.fixed import ONE, scaled
from device.backing_up import exact
from device.backup import Value
from device.commissioning.guarding import columns_of, exchange_of, guarded, power_off, switch_off
from device.commissioning.judge import STIRRED, Moved, joined, toggling
from device.download import Job
from device.former import Former, assign
from device.lease import CODE, COUNTS, FLAG, Exchange
from device.quiet import ready, said, still
from device.tasks import LinkError, LinkLost, NotAllowed, Steps, Wait
from device.wire import Shape

if TYPE_CHECKING:
    from codegen.models import Model
    from device.api import Controller

TRIAL_COUNTS, TRIAL_ERROR = 300, 60  # counts of the polarity move, and its largest error limit
LARGEST_TRIAL = 600  # counts
LARGEST_MOVE = 1000  # counts: what is left to MOST is for an encoder that dies on the way
LARGEST_ERROR = 400  # counts: an axis with much friction needs more than the usual
FEELERS = (10, 10, 10)  # error limits that are tried first, counts; a dead channel may look still once
SILENT = 20  # counts: no more is tried by itself where the reading says nothing; what the axis does, only eyes can tell
GROWTH = Fraction(13, 10)  # of the error limit from try to try
GAINS = ("KP", "KD", "FV", "FA")
RAN = 40  # counts backwards that are no sagging of a load that hangs
SPEED, RAMP = 1000, 5120  # counts/s, counts/s²: little error is needed to follow, so the limit can be small
MARGIN = 200  # counts beyond the target before it is switched off from here
SETTLE_S, LONGEST_S, COAST_S = 0.3, 8.0, 4.0
STANDS = 6  # equal readings in a row
VOLTS = Shape(2, 4)
STEPPER = 2 * ONE  # |MT| from here on: a stepper


@dataclass(frozen=True, slots=True)
class Trial:
    """A bounded move: how far, how large the following error may get, how hard the motor may be driven."""

    axis: str
    counts: int
    error: int = TRIAL_ERROR
    torque: Fraction = Fraction(1)
    stepper: bool = False  # it may have no encoder: where it is, tell the pulses that were sent (TD)
    before: str = ""  # a command between SH and the move
    silent: int = SILENT  # with so much the axis may stand still, as the person has seen or an earlier move has shown

    @property
    def problem(self) -> str:
        """Why it may not be made, or nothing."""
        if not self.counts or abs(self.counts) > LARGEST_MOVE:
            return f"no step moves an axis by more than {LARGEST_MOVE} counts, or by none."
        if not 1 <= self.error <= LARGEST_ERROR:
            return f"the error limit of a first move is 1 to {LARGEST_ERROR} counts."
        return "" if 0 < self.torque < 10 else "the torque limit lies above 0 and below 10 V."

    def errors(self) -> Iterator[int]:
        """The error limits to try, one after the other."""
        error = Fraction(FEELERS[-1])
        yield from (each for each in FEELERS if each < self.error)
        while (error := error * GROWTH) < self.error:
            yield int(error)
        yield self.error


def move(c: Controller, trial: Trial, folder: Path, now: datetime, job: Job[Moved]) -> Steps[Moved]:
    """Guards around the axis, a relative move, motor off, everything put back."""
    model = ready(c, trial.axis, "Not moved")
    if trial.problem:
        raise NotAllowed(f"Not moved: {trial.problem}")
    yield from still(c, model, "Not moved")
    yield from switch_off(c, trial.axis, "Not moved")
    yield from _as_set_up(c, model, trial)
    if trial.stepper:
        return (yield from guarded(c, trial.axis, folder, now, lambda f: _stepping(c, trial, f, job), place="RP"))
    climbing = guarded(c, trial.axis, folder, now, lambda former: _climbing(c, trial, former, job), also=GAINS)
    return (yield from climbing)


def _as_set_up(c: Controller, model: Model, trial: Trial) -> Steps[None]:
    """A stepper is not driven as a servo, nor a servo as a stepper."""
    told = yield from exact(c.nonces, [f"_MT{trial.axis}"], model.columns)
    kind = told[0] or 0
    if (abs(kind) >= STEPPER) != trial.stepper:
        names = ("stepper", "servo") if abs(kind) >= STEPPER else ("servo", "stepper")
        raise NotAllowed(
            f"Not moved: the controller drives axis {trial.axis} as a {names[0]} (MT {kind / ONE:g}), the setup says "
            f"{names[1]}. Send the setup to the controller first."
        )


def _climbing(c: Controller, trial: Trial, former: Former, job: Job[Moved]) -> Steps[Moved]:
    """Towards one place, with larger and larger error limits as long as one of them ends it on the way."""
    target, place = former.place + trial.counts, former.place
    tries: list[Moved] = []
    best, stood = 0, 0
    for error in trial.errors():
        there = yield from _driven(c, dc.replace(trial, counts=target - place, error=error), place, former, job)
        tries.append(there)
        moved = dc.replace(joined(tries, trial.counts), dead=toggling(tries))
        stood = stood + 1 if there.high - there.low <= 1 else 0
        lost = there.tripped and best > 2 and stood * best > STIRRED  # at once where it went far, else the second time
        best = max(best, there.high - there.low)
        silent = best <= 1 and int(error * GROWTH) > trial.silent
        if not there.tripped or moved.dead or lost or silent or there.way < -RAN or error == trial.error:
            return dc.replace(moved, lost=lost)
        place = there.end
        if abs(target - place) < 2 * int(error * GROWTH) or (target - place) * trial.counts < 0:
            return moved  # what is left would not reach the error limit
    raise AssertionError  # the last of the errors returns


def _stepping(c: Controller, trial: Trial, former: Former, job: Job[Moved]) -> Steps[Moved]:
    """One move, with what an encoder told of it; limits lie around the commanded position (RP)."""
    names = [f"_TD{trial.axis}", f"_TP{trial.axis}"]
    told = yield from exact(c.nonces, names, columns_of(c))
    start, before = ((value or 0) // ONE for value in told)
    moved = yield from _driven(c, trial, start, former, job)
    told = yield from exact(c.nonces, names, columns_of(c))
    return dc.replace(moved, encoder=(told[1] or 0) // ONE - before)


def _coasted(exchange: Exchange, where: str, place: int, end: float) -> Steps[list[int]]:
    """Readings until the axis stands with its motor off."""
    places = [place]
    while len(places) < STANDS or len(set(places[-STANDS:])) > 1:
        if exchange.clock() > end:
            raise LinkError("The axis does not come to rest with its motor off; does something pull it?")
        yield Wait(0.04)
        told = yield from exchange.read((where, COUNTS))
        if told is None:
            raise LinkLost("The controller stopped answering.")
        places.append(int(told[0]))
    return places


def _driven(c: Controller, trial: Trial, start: int, former: Former, job: Job[Moved]) -> Steps[Moved]:
    axis, exchange = trial.axis, exchange_of(c)
    place = former.place if trial.stepper else start
    low, high = sorted((place, place + trial.counts))
    guards = {
        "OE": ONE,
        "ER": scaled(trial.error),
        "TL": min(COMMANDS["TL"].stored(scaled(trial.torque)), former.values["TL"]),
        "FL": scaled(high + MARGIN),
        "BL": scaled(low - MARGIN),
    }
    pace = {"SP": scaled(SPEED), "AC": scaled(RAMP), "DC": scaled(RAMP), "IT": ONE}
    patience = {"KI": 0}  # it would push harder and harder against a reading that stands
    yield from assign(c, axis, guards | pace | patience | _soft(former))
    job.show("moving", 0, abs(trial.counts))
    yield from said(c, f"SH {axis}")
    if trial.before:
        yield from said(c, trial.before)
    try:
        yield from said(c, f"PR{axis}={trial.counts};BG {axis}")
    except LinkError:
        told = yield from exact(c.nonces, [f"_MO{axis}"], columns_of(c))
        if not told[0]:
            raise  # else it ran away as soon as its motor was on: that is what is looked for
    return (yield from _watched(c, trial, start, exchange, job))


def _soft(former: Former) -> dict[str, Value]:
    """Gains up to those of the factory, softer ones as they are; a stepper has none."""
    most = {name: scaled(Fraction(str(COMMANDS[name].default))) for name in GAINS if name in former.values}
    return {name: min(value, former.values[name]) for name, value in most.items()}


def _watched(c: Controller, trial: Trial, start: int, exchange: Exchange, job: Job[Moved]) -> Steps[Moved]:
    """Looks until the move has ended and the axis stands, or left its bounds; then the motor is off."""
    axis, places = trial.axis, [start]
    where = f"_{'TD' if trial.stepper else 'TP'}{axis}"
    end, settled, bounded = c.clock() + LONGEST_S, 0.0, False
    while True:
        told = yield from exchange.read((f"_MO{axis}", FLAG), (f"_BG{axis}", FLAG), (where, COUNTS))
        if told is None or job.cancelled or c.clock() > end:
            raise LinkError("The move was ended from here; the motor is off.")
        off, moving, place = (int(value) for value in told)
        stands = settled and abs(place - places[-1]) <= 1 and not trial.stepper  # what a dead channel does is ended
        places.append(place)
        job.show("moving", abs(place - start), abs(trial.counts))
        way = (place - start) * (1 if trial.counts > 0 else -1)
        bounded = not off and not -MARGIN <= way <= abs(trial.counts) + MARGIN
        settled = settled or (0.0 if moving else c.clock())
        if bounded:
            yield from power_off(c, axis)
        if off or bounded or stands or (settled and c.clock() - settled > SETTLE_S):
            break
    volts = yield from exchange.read((f"_TT{axis}", VOLTS))
    yield from power_off(c, axis)
    told = yield from exchange.read((f"_SC{axis}", CODE), (f"_RP{axis}", COUNTS))
    if told is None or volts is None:
        raise LinkLost("The controller stopped answering.")
    code, commanded = (int(value) for value in told)
    if off or bounded:
        places += yield from _coasted(exchange, where, places[-1], c.clock() + COAST_S)
        commanded = _frozen(trial, start, commanded) if off else commanded
    changes = sum(here != there for here, there in pairwise(places))
    return Moved(
        trial.counts,
        start,
        places[-1],
        commanded,
        min(places),
        max(places),
        code,
        bool(off),
        volts[0],
        bounded,
        changes,
        0 if trial.stepper else trial.error,
    )


def _frozen(trial: Trial, start: int, commanded: int) -> int:
    """Where an axis that went off was commanded to be; some controllers let RP follow TP while the motor is off."""
    low, high = sorted((start, start + trial.counts))
    return min(max(commanded, low), high)
