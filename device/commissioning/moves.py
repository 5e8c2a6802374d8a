"""What the steps send: motor off, switches, guards, and bounded moves inside them, as steps for the link.

A move is a relative one that is longer than the error limit around it: an axis that does not follow (a dead encoder,
no power, the wrong polarity) is switched off by the controller itself, in the sample in which it happens, whether
this computer lives or not. Former values are on disk before the first change, and put back with the motor off.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import datetime
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.fixed import ONE, scaled
from codegen.twoletter.problems import ERROR_TEXTS
from device import commands
from device.backing_up import LINE_S, REFUSAL_S, exact
from device.backup import Value
from device.commissioning.judge import Moved
from device.commissioning.steps import MOST
from device.download import Job, proved
from device.identify import fence
from device.lease import CODE, COUNTS, FLAG, Exchange
from device.stop import StopState
from device.tasks import LinkError, LinkLost, NotAllowed, Steps, Stopped, Wait
from device.tuning.guards import LIMITS, PROFILE, SUFFIX, Former, assign, forget, keep, putting_back, ready, still
from device.wire import Kind, Shape

if TYPE_CHECKING:
    from device.api import Controller

T = TypeVar("T")
INPUTS = {"forward": "LF", "reverse": "LR", "home": "HM"}
KEPT = (*LIMITS, *PROFILE)
TRIAL_COUNTS, TRIAL_ERROR = 300, 60  # counts of the polarity move, and its error limit
LARGEST_ERROR = 400  # counts: an axis with much friction needs more than the usual
SPEED, RAMP = 2000, 20480  # counts/s, counts/s²: slow to follow, quick enough to trip a dead encoder's error limit
MARGIN = 200  # counts beyond the target before it is switched off from here
SETTLE_S, LONGEST_S, STOPPED_S, OFF_S = 0.3, 8.0, 6.0, 3.0
LARGEST_CYCLE = MOST - 100  # counts: BS turns one whole cycle each way
VOLTS = Shape(2, 4)


@dataclass(frozen=True, slots=True)
class Trial:
    """A bounded move: how far, how large the following error may get, how hard the motor may be driven."""

    axis: str
    counts: int
    error: int = TRIAL_ERROR
    torque: Fraction = Fraction(1)
    stepper: bool = False  # it may have no encoder: where it is, is where it is commanded to be

    @property
    def problem(self) -> str:
        """Why it may not be made, or nothing."""
        if not self.counts or abs(self.counts) + self.error + MARGIN > MOST:
            return f"no step moves an axis by more than {MOST - self.error - MARGIN} counts, or by none."
        if not 1 <= self.error <= LARGEST_ERROR:
            return f"the error limit of a first move is 1 to {LARGEST_ERROR} counts."
        return "" if 0 < self.torque < 10 else "the torque limit lies above 0 and below 10 V."


# ----------------------------------------------------------------------- without motion


def motor_off(c: Controller, axis: str) -> Steps[bool]:
    """As a step of its own: not under a running program."""
    model = ready(c, axis, "Not switched off")
    yield from still(c, model, "Not switched off")
    return (yield from switch_off(c, axis))


def switch_off(c: Controller, axis: str, what: str = "Not done") -> Steps[bool]:
    """MO, and whether the controller then says so."""
    ready(c, axis, what)
    yield from _said(c, f"MO {axis}")
    told = yield from exact(c.nonces, [f"_MO{axis}"], _columns(c))
    return bool(told[0])


def set_switches(c: Controller, axis: str, limit: int, home: int) -> Steps[bool]:
    """CN: which level of limit and home inputs counts; the motor is off meanwhile."""
    model = ready(c, axis, "Not set")
    yield from still(c, model, "Not set")
    yield from switch_off(c, axis)
    yield from _said(c, f"CN {limit},{home}")
    return True


def look_at_switches(c: Controller, axis: str) -> Steps[Mapping[str, int] | None]:
    """Levels of the three inputs, at once: the usual reading comes round too seldom for a switch tripped by hand."""
    told = yield from _exchange(c).read(*((f"_{name}{axis}", FLAG) for name in INPUTS.values()))
    return None if told is None else dict(zip(INPUTS, map(int, told), strict=True))


def set_values(
    c: Controller, axis: str, values: Mapping[str, Value], folder: Path, now: datetime
) -> Steps[tuple[Mapping[str, Value], Mapping[str, Value]]]:
    """Sets limits with the motor off; what was there and what is there now. Put back where one is refused."""
    model = ready(c, axis, "Not set")
    yield from still(c, model, "Not set")
    yield from switch_off(c, axis)
    former = yield from _keep(c, axis, folder, now)
    try:
        yield from assign(c, axis, values)
    except LinkLost:
        raise  # the file stays, and is offered when the controller answers again
    except LinkError as reason:
        yield from _finish(c, former, str(reason))
        raise
    found = yield from exact(c.nonces, [f"_{name}{axis}" for name in values], model.columns)
    forget(former)
    there = {name: value for name, value in zip(values, found, strict=True) if value is not None}
    return former.values, there


def burn(c: Controller, axis: str) -> Steps[commands.Reply]:
    """BN with the motor off, so that the next power-up leaves it off."""
    model = ready(c, axis, "Not burned")
    yield from still(c, model, "Not burned")
    yield from switch_off(c, axis, "Not burned")
    return (yield from commands.typed(c, "BN", 3.0))


BURN_WORDS = (
    "Everything the controller holds now (motor and encoder types, CN, limits, gains) is written into its EEPROM over "
    "what was there. The motor of {axis} goes off first, so that the next power-up leaves it off; other motors start "
    "as they are now. The program is not burned with it. It takes about 250 ms: leave the power on."
)


# ------------------------------------------------------------------------- bounded moves


def move(c: Controller, trial: Trial, folder: Path, now: datetime, job: Job[Moved]) -> Steps[Moved]:
    """Guards around the axis, one relative move, motor off, everything put back."""
    model = ready(c, trial.axis, "Not moved")
    if trial.problem:
        raise NotAllowed(f"Not moved: {trial.problem}")
    yield from still(c, model, "Not moved")
    yield from switch_off(c, trial.axis, "Not moved")
    former = yield from _keep(c, trial.axis, folder, now)
    return (yield from _guarded(c, former, lambda: _driven(c, trial, former, job)))


def _driven(c: Controller, trial: Trial, former: Former, job: Job[Moved]) -> Steps[Moved]:
    axis, exchange = trial.axis, _exchange(c)
    start = former.place
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
    yield from _said(c, f"SH {axis}")
    try:
        yield from _said(c, f"PR{axis}={trial.counts};BG {axis}")
    except LinkError:
        told = yield from exact(c.nonces, [f"_MO{axis}"], _columns(c))
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
            yield from _off(c, axis)
        if off or bounded or (settled and c.clock() - settled > SETTLE_S):
            break
    volts = yield from exchange.read((f"_TT{axis}", VOLTS))
    yield from _off(c, axis)
    told = yield from exchange.read((f"_SC{axis}", CODE), (f"_RP{axis}", COUNTS), (where, COUNTS))
    if told is None or volts is None:
        raise LinkLost("The controller stopped answering.")
    code, commanded, last = (int(value) for value in told)
    reached = places[-1] if not (off or bounded) else last  # what is off may be moved by anything
    if off:
        commanded = _frozen(trial, start, commanded)
    places.append(reached)
    return Moved(trial.counts, start, reached, commanded, min(places), max(places), code, bool(off), volts[0], bounded)


def _frozen(trial: Trial, start: int, commanded: int) -> int:
    """Where an axis that went off was commanded to be; some controllers let RP follow TP while the motor is off."""
    low, high = sorted((start, start + trial.counts))
    return min(max(commanded, low), high)


# -------------------------------------------------------------------- sine commutation


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
    yield from _said(c, f"BA {axis}")
    yield from _said(c, f"BM {float(phases.cycle):.4f}".rstrip("0").rstrip("."))
    if phases.halls:
        yield from _said(c, f"BI {phases.halls}")
    line = f"BS {float(phases.volts):g},{phases.time_ms}"
    answer = yield from _field(c, axis, proved(c.nonces, line, max(10.0, 2 * phases.seconds), REFUSAL_S))  # l.739
    if answer.kind is Kind.SILENT:
        raise LinkLost(f"The controller did not answer “{line}”.")
    return answer.text if answer.kind is Kind.ACCEPTED else ""


def drive_to_zero(c: Controller, axis: str, volts: Fraction, offset: int) -> Steps[tuple[commands.Reply, int | None]]:
    """BB and BZ; positive volts leave the motor off (l.765). The counts to phase zero with it."""
    if not 0 < volts <= 3:
        raise NotAllowed("Not moved: the voltage lies above 0, and at most at 3 V.")
    yield from _before_field(c, axis)
    yield from _said(c, f"BB {offset}")
    reply = yield from _field(c, axis, commands.typed(c, f"BZ {float(volts):g}", 15.0))
    told = yield from exact(c.nonces, [f"_BZ{axis}"], _columns(c))
    return reply, None if told[0] is None else told[0] // ONE


def _before_field(c: Controller, axis: str) -> Steps[None]:
    model = ready(c, axis, "Not tested")
    if model.name != "dmc1412":
        raise NotAllowed("Not tested: only the DMC-1412 commutates a motor.")
    yield from still(c, model, "Not tested")
    yield from switch_off(c, axis)


def _field(c: Controller, axis: str, steps: Steps[T]) -> Steps[T]:
    """What turns the field; whatever comes of it, the motor is off afterwards."""
    try:
        result = yield from steps
    except Stopped:
        yield from _until_stopped(c)
        yield from _off(c, axis)
        raise
    yield from _off(c, axis)
    return result


# ----------------------------------------------------------------- what stands around them


def putting_back_of(c: Controller, former: Former) -> Steps[str]:
    """Motor off, then everything as it was before a step that was interrupted."""
    yield from switch_off(c, former.axis, "Not put back")
    yield from putting_back(c, former)
    return f"Axis {former.axis} has the limits and speeds from before; its motor is off. Nothing was burned."


def _keep(c: Controller, axis: str, folder: Path, now: datetime) -> Steps[Former]:
    """What the axis is set to, on disk before anything is changed."""
    found = yield from exact(c.nonces, [f"_{name}{axis}" for name in (*KEPT, "TP")], _columns(c))
    values = {name: value for name, value in zip((*KEPT, "TP"), found, strict=True) if value is not None}
    missing = [name for name in (*KEPT, "TP") if name not in values]
    if missing or c.model is None:
        raise NotAllowed(f"Not started: the controller does not tell {', '.join(missing)} of axis {axis}.")
    place = values.pop("TP") // ONE
    serial = (c.identity.serial or 0) if c.identity is not None else 0
    file = folder / f"{c.model.name}-{serial}-{axis}-{now:%Y%m%d-%H%M%S-%f}{SUFFIX}"
    former = Former(axis, c.model.name, serial, str(c.kind), c.who, now.isoformat(), place, values, file)
    keep(former)
    return former


def _guarded(c: Controller, former: Former, body: Callable[[], Steps[T]]) -> Steps[T]:
    try:
        result = yield from body()
    except Stopped as stop:
        yield from _until_stopped(c)
        yield from _finish(c, former, str(stop))
        raise
    except LinkLost:
        raise  # the controller keeps its guards; the file is offered when it answers again
    except LinkError as reason:
        yield from _finish(c, former, str(reason))
        raise
    yield from _finish(c, former, "The move is complete.")
    return result


def _finish(c: Controller, former: Former, why: str) -> Steps[None]:
    """Motor off, former values; then the file is no longer needed."""
    try:
        yield from _off(c, former.axis)
        yield from assign(c, former.axis, {name: former.values[name] for name in (*PROFILE, *LIMITS)})
    except LinkError as failure:
        raise type(failure)(
            f"{why} The former limits of axis {former.axis} are not all back: {failure} They are kept on this computer "
            "and offered again."
        ) from failure
    forget(former)


def _off(c: Controller, axis: str) -> Steps[None]:
    """The motor goes off (not while it moves: so it is stopped before), in Watch as well: what began here ends here."""
    exchange, end = _exchange(c), c.clock() + OFF_S
    while c.clock() < end:
        for word in ("MO", "ST"):
            answer = yield from exchange.prove(f"{word} {axis}", stops=True)
            if word == "MO" and answer.kind is Kind.ACCEPTED:
                return
            if answer.kind is Kind.SILENT:
                raise LinkLost("The controller stopped answering.")
        yield Wait(0.02)
    raise LinkLost(f"it is not certain that the motor of {axis} is off. Press STOP.")


def _until_stopped(c: Controller) -> Steps[None]:
    """After STOP nothing is sent before its proof; without it the file stays for later."""
    end = c.clock() + STOPPED_S
    while c.stop_state is not StopState.STOPPED:
        if c.clock() > end:
            raise LinkLost("STOP was not confirmed; the former values are kept, and offered when the axis is at rest.")
        yield Wait(0.05)


def _said(c: Controller, line: str) -> Steps[None]:
    """One line, proved; LinkError with the reason where it is refused."""
    answer = yield from proved(c.nonces, line, LINE_S, REFUSAL_S)
    if answer.kind is Kind.ACCEPTED:
        return
    if answer.kind is Kind.SILENT:
        raise LinkLost(f"The controller stopped answering at “{line}”.")
    fenced = yield from fence(c.nonces)
    code = int(fenced.values[0]) if fenced.kind is Kind.VALUES else 0
    raise LinkError(f"“{line}” was refused: error {code}, {ERROR_TEXTS.get(code, 'unknown error')}.")


def _columns(c: Controller) -> int:
    return c.model.columns if c.model is not None else 40


def _exchange(c: Controller) -> Exchange:
    return Exchange(c.clock, c.nonces, _columns(c), c.line.byte_s)
