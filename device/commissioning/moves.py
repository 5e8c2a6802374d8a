"""Bounded moves, as steps for the link.

A move is a relative one that is longer than the error limit around it: an axis that does not follow (a dead encoder,
no power, the wrong polarity) is switched off by the controller itself, in the sample in which it happens, whether
this computer lives or not. Former values are on disk before the first change, and put back with the motor off.

The first move of all begins with a very small error limit, and with it little force; only an axis that stood still
is tried with a larger one. So little happens before it is known that the encoder tells what the motor does.
"""

from __future__ import annotations

import dataclasses as dc
from dataclasses import dataclass
from datetime import datetime
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.fixed import ONE, scaled
from device.backing_up import exact
from device.commissioning.guarding import columns_of, exchange_of, guarded, keep_former, power_off, said, switch_off
from device.commissioning.judge import STIRRED, Moved
from device.commissioning.steps import MOST
from device.download import Job
from device.lease import CODE, COUNTS, FLAG, Exchange
from device.tasks import LinkError, LinkLost, NotAllowed, Steps, Wait
from device.tuning.guards import Former, assign, ready, still
from device.wire import Shape

if TYPE_CHECKING:
    from device.api import Controller

TRIAL_COUNTS, TRIAL_ERROR = 300, 60  # counts of the polarity move, and its error limit
LARGEST_TRIAL = 600  # counts: it may take two moves
LARGEST_ERROR = 400  # counts: an axis with much friction needs more than the usual
FEELERS = (10, 10, 10, 20, 40)  # error limits that are tried before, counts; a dead channel may look still once
RAN = 40  # counts backwards that are no sagging of a load that hangs
SPEED, RAMP = 2000, 20480  # counts/s, counts/s²: slow to follow, quick enough to trip a dead encoder's error limit
MARGIN = 200  # counts beyond the target before it is switched off from here
SETTLE_S, LONGEST_S, COAST_S = 0.3, 8.0, 4.0
STANDS = 6  # equal readings in a row
VOLTS = Shape(2, 4)


@dataclass(frozen=True, slots=True)
class Trial:
    """A bounded move: how far, how large the following error may get, how hard the motor may be driven."""

    axis: str
    counts: int
    error: int = TRIAL_ERROR
    torque: Fraction = Fraction(1)
    stepper: bool = False  # it may have no encoder: where it is, is where it is commanded to be
    before: str = ""  # a command between SH and the move

    @property
    def problem(self) -> str:
        """Why it may not be made, or nothing."""
        if not self.counts or abs(self.counts) + self.error + MARGIN > MOST:
            return f"no step moves an axis by more than {MOST - self.error - MARGIN} counts, or by none."
        if not 1 <= self.error <= LARGEST_ERROR:
            return f"the error limit of a first move is 1 to {LARGEST_ERROR} counts."
        return "" if 0 < self.torque < 10 else "the torque limit lies above 0 and below 10 V."


def move(c: Controller, trial: Trial, folder: Path, now: datetime, job: Job[Moved]) -> Steps[Moved]:
    """Guards around the axis, one relative move, motor off, everything put back."""
    former = yield from _begin(c, trial, folder, now)
    return (yield from guarded(c, former, lambda: _driven(c, trial, former, former.place, job)))


def first_move(c: Controller, trial: Trial, folder: Path, now: datetime, job: Job[Moved]) -> Steps[Moved]:
    """The same for an axis of which nothing is known yet: with little force first."""
    if abs(trial.counts) > LARGEST_TRIAL:
        raise NotAllowed(f"Not moved: the first move is {LARGEST_TRIAL} counts at most.")
    former = yield from _begin(c, trial, folder, now)
    return (yield from guarded(c, former, lambda: _felt(c, trial, former, job)))


def _begin(c: Controller, trial: Trial, folder: Path, now: datetime) -> Steps[Former]:
    model = ready(c, trial.axis, "Not moved")
    if trial.problem:
        raise NotAllowed(f"Not moved: {trial.problem}")
    yield from still(c, model, "Not moved")
    yield from switch_off(c, trial.axis, "Not moved")
    return (yield from keep_former(c, trial.axis, folder, now))


def _felt(c: Controller, trial: Trial, former: Former, job: Job[Moved]) -> Steps[Moved]:
    """Larger and larger error limits, as long as the axis stands still; one that follows a little gets the last."""
    before, place = None, former.place
    for error in (*(each for each in FEELERS if each < trial.error), trial.error):
        moved = yield from _driven(c, dc.replace(trial, error=error), former, place, job)
        moved = moved if before is None else moved.with_before(before)
        if error == trial.error or not moved.tripped or moved.toggled or moved.way < -RAN:
            return moved
        place = moved.end
        if moved.way > STIRRED:
            break
        before = moved if moved.furthest <= STIRRED else None
    return (yield from _driven(c, trial, former, place, job))


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


def _driven(c: Controller, trial: Trial, former: Former, start: int, job: Job[Moved]) -> Steps[Moved]:
    axis, exchange = trial.axis, exchange_of(c)
    low, high = sorted((start, start + trial.counts))
    guards = {
        "OE": ONE,
        "ER": scaled(trial.error),
        "TL": min(COMMANDS["TL"].stored(scaled(trial.torque)), former.values["TL"]),
        "FL": scaled(high + MARGIN),
        "BL": scaled(low - MARGIN),
    }
    pace = {"SP": scaled(SPEED), "AC": scaled(RAMP), "DC": scaled(RAMP), "IT": ONE}
    yield from assign(c, axis, guards | pace)
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


def _watched(c: Controller, trial: Trial, start: int, exchange: Exchange, job: Job[Moved]) -> Steps[Moved]:
    """Looks until the move has ended and settled, or left its bounds; then the motor is off."""
    axis, places = trial.axis, [start]
    where = f"_{'RP' if trial.stepper else 'TP'}{axis}"
    end, settled, bounded = c.clock() + LONGEST_S, 0.0, False
    while True:
        told = yield from exchange.read((f"_MO{axis}", FLAG), (f"_BG{axis}", FLAG), (where, COUNTS))
        if told is None or job.cancelled or c.clock() > end:
            raise LinkError("The move was ended from here; the motor is off.")
        off, moving, place = (int(value) for value in told)
        places.append(place)
        job.show("moving", abs(place - start), abs(trial.counts))
        way = (place - start) * (1 if trial.counts > 0 else -1)
        bounded = not off and not -MARGIN <= way <= abs(trial.counts) + MARGIN
        settled = settled or (0.0 if moving else c.clock())
        if bounded:
            yield from power_off(c, axis)
        if off or bounded or (settled and c.clock() - settled > SETTLE_S):
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
    )


def _frozen(trial: Trial, start: int, commanded: int) -> int:
    """Where an axis that went off was commanded to be; some controllers let RP follow TP while the motor is off."""
    low, high = sorted((start, start + trial.counts))
    return min(max(commanded, low), high)
