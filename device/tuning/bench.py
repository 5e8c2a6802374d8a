"""One axis between its guards: steps and excitations, recorded by the controller, and what is measured of them.

A step is what both manuals allow to a standing axis: a jog at speed 0, in which IP moves the commanded position at
once (ssc-tol-o-motion.txt l.2154, dmc-1412-1414.txt l.1740). The former gains are back before anything is uploaded,
so a loop that swings does so for no longer than it is recorded.
"""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.fixed import ONE, scaled
from device.backing_up import LINE_S, REFUSAL_S, exact
from device.capture import Capture, Channel, Plan, most
from device.capturing import CaptureJob, capture_steps
from device.download import Job
from device.former import Former, assign
from device.lease import at
from device.proof import proved
from device.quiet import ready
from device.tasks import LinkError, NotAllowed, Steps, Wait
from device.tuning.automatic import Chosen, Search, search, seen, vibrates
from device.tuning.excite import Excitation, NotIdentified, carried, excitation, held, refused, sag
from device.tuning.feed import Sweep
from device.tuning.guards import Cancelled, Fault, Guard, not_stopped, watch
from device.tuning.loop import Gains, period
from device.tuning.metrics import Metrics, Response, measure, measured_words
from device.tuning.recording import Recording
from device.tuning.registers import ALL, FIELDS, gains_of, registers
from device.wire import Kind

if TYPE_CHECKING:
    from codegen.models import Model
    from device.api import Controller

LARGEST_STEP = 20_000  # counts: ER ends at 32 767, and half as much again must be left
TRIAL_VALUES = 120  # of a channel, in automatic tuning
EXCITED_VALUES = 500
MOVE_VALUES = 200
SETTLE_S = 0.15  # at rest with the new gains, before the step
BEFORE = 6  # elements drawn before the step; the axis stands in them
RECORDED_S = 5.0  # beyond the expected end of a recording
QUIET_COUNTS = 3  # of swing at rest are no vibration
LOOKS_S = (0.0, 0.0017, 0.0044, 0.0009, 0.0063, 0.0028, 0.0051)  # between two looks, beyond what the line takes
RESTING = 6  # looks at an axis until it is at rest
HEAVY = 0.2  # of the torque limit: what may hang on an axis that is without KP for a moment
CHANNELS = ("error", "torque", "position")
Told = Callable[["Measured", str], None]


@dc.dataclass(frozen=True)
class Wish:
    """What a person asks for: a step of `step` counts with these gains, and a margin on either side."""

    axis: str
    step: int
    gains: Gains
    torque: float = 9.9982
    seconds: float = 0.5
    margin: int = 0  # counts; 0: 60 % of the step

    @property
    def guard(self) -> Guard:
        return Guard.around(self.axis, self.step, self.margin or margin_of(self.step), self.torque)

    @property
    def problem(self) -> str:
        """What is wrong with it, or nothing."""
        if not 4 <= abs(self.step) <= LARGEST_STEP:
            return f"the step is {self.step} counts; an error limit (ER) can guard 4 to {LARGEST_STEP}."
        return self.guard.problem


def margin_of(step: int) -> int:
    """Counts on either side that an overshoot may take."""
    return math.ceil(abs(step) * 0.6) + 20


@dc.dataclass(frozen=True, eq=False)
class Measured:
    """One recorded step: what was in effect, what came of it."""

    axis: str
    step: int
    gains: Gains
    response: Response
    metrics: Metrics | None
    vibrates: bool
    words: str
    capture: Capture


@dc.dataclass(frozen=True, eq=False)
class Found:
    """What an automatic run recommends (none: why it gave up), and every trial with its reason."""

    gains: Gains | None
    words: str
    trials: tuple[Measured, ...]


@dc.dataclass(frozen=True, eq=False)
class Excited:
    """What was recorded of an excitation; `identify` makes an estimate of it, which takes too long for the link."""

    recording: Recording | NotIdentified
    period: float  # the true sample time, s
    gains: Gains  # in effect


def bench(c: Controller, former: Former, wish: Wish, job: Job[Any]) -> Steps[Bench]:
    """What a run needs to know, read inside the guards: the torque limit in effect, TM, the room for arrays."""
    model = ready(c, former.axis)
    names = [*ALL, "DV", "TE", "TT", "ER"]
    found = yield from exact(c.nonces, [*(f"_{name}{former.axis}" for name in names), "_TM"], model.columns)
    values = {name: value or 0 for name, value in zip([*names, "TM"], found, strict=True)}
    inside = gains_of(values)
    before = gains_of({**values, **{name: former.values[name] for name in FIELDS}})
    bears = carried(before, values["TE"] / ONE, values["TT"] / ONE)
    return Bench(
        c, model, former, wish, job, inside, before, values["DV"] != 0, abs(values["TM"]) / ONE, c.clock(),
        bears, values["ER"] / ONE,
    )  # fmt: skip


@dc.dataclass
class Bench:
    """One axis between its guards."""

    c: Controller
    model: Model
    former: Former
    wish: Wish
    job: Job[Any]
    inside: Gains  # what was in effect when the guards stood: with the torque limit of the run
    former_gains: Gains
    dual: bool
    tm: float
    began: float
    bears: float  # V that hold the axis, before anything is tried
    error_limit: float  # counts, between the guards
    trials: int = 0
    looks: tuple[float, ...] = ()  # the motor command at odd moments after the last record, V
    rest: tuple[float, float] = (0.0, 0.0)  # error (counts) and motor command (V) before the step

    @property
    def axis(self) -> str:
        return self.former.axis

    def step(self, counts: int, gains: Gains, seconds: float, values: int) -> Steps[Measured]:
        """One step from rest; the former gains are back before the record is read."""
        gains = self._with_limits(gains)
        plan = self._plan(seconds, values, f"IP {at(self.axis, counts)}")
        yield from self._jog(gains)
        capture = yield from self._captured(plan)
        response = self._response(capture, counts)
        metrics = measure(response, gains.torque_limit)
        swings = vibrates(response, gains, self.looks)
        found = None if isinstance(metrics, str) else metrics
        words = metrics if isinstance(metrics, str) else measured_words(metrics, swings)
        return Measured(self.axis, counts, gains, response, found, swings, words, capture)

    def move(self, sweep: Sweep, gains: Gains) -> Steps[Measured]:
        """A profiled move with these gains: its following error, and what the motor gave."""
        gains = self._with_limits(gains)
        self._check()
        pace = {"SP": sweep.speed * ONE, "AC": sweep.acceleration * ONE, "DC": sweep.acceleration * ONE, "IT": ONE}
        yield from assign(self.c, self.axis, {**registers(gains), **pace})
        yield Wait(SETTLE_S)
        yield from self._stands(gains)
        yield from proved(self.c.nonces, f"PR{self.axis}={sweep.counts}", LINE_S, REFUSAL_S)
        capture = yield from self._captured(self._plan(sweep.seconds, MOVE_VALUES, f"BG {self.axis}"))
        volts, error = (capture.of(Channel(name, self.axis)) for name in ("torque", "error"))
        commanded = sweep.commanded(capture.interval_s, len(error))
        response = Response(capture.interval_s, commanded, commanded - error, volts)
        words = f"Largest following error {np.abs(error).max():.3g} counts."
        return Measured(self.axis, sweep.counts, gains, response, None, False, words, capture)

    def automatic(self, wish: Wish, tell: Told) -> Steps[Found]:
        """To and fro, with what `search` wants tried next."""
        trials: list[Measured] = []
        if self.dual and (heavy := (yield from self._heavy())):
            return Found(None, heavy, ())
        start = self.former_gains if self.former_gains.kd >= 1 else dc.replace(self.former_gains, kd=64.0, kp=6.0)
        searching: Search = search(start, self.dual)
        counts, last = wish.step, None
        while True:
            try:
                trial = next(searching) if last is None else searching.send(last)
            except StopIteration as end:
                chosen: Chosen = end.value
                return Found(chosen.gains, chosen.words, tuple(trials))
            self._check()
            self.trials += 1
            self.job.show(f"trial {self.trials}", self.trials, 0)
            measured = yield from self.step(counts, trial.gains, wish.seconds, TRIAL_VALUES)
            trials.append(measured)
            tell(measured, trial.why)
            counts = -counts  # back and forth (ssc-tol-o-motion.txt l.2857)
            last = seen(measured.response, measured.gains, measured.vibrates)

    def excite(self, gains: Gains) -> Steps[Excited]:
        """Jumps to and fro within the travel while error and torque are recorded."""
        gains = dc.replace(self._with_limits(gains), fv=0.0, fa=0.0)
        sample = period(self.tm)
        if wrong := refused(gains, self.dual):
            return Excited(NotIdentified(wrong), sample, gains)
        several = min(3, self.model.recorded_channels)
        elements = min(EXCITED_VALUES, most(self.model, several))
        wanted = excitation(gains, abs(self.wish.step), elements, several, sample)
        if isinstance(wanted, NotIdentified):
            return Excited(wanted, sample, gains)
        plan = Plan(tuple(Channel(name, self.axis) for name in CHANNELS[:several]), wanted.exponent, wanted.elements)
        yield from self._jog(gains)
        capture = yield from self._captured(plan, wanted)
        return Excited(self._recording(capture, gains, wanted), sample, gains)

    # ---- inside

    def _with_limits(self, gains: Gains) -> Gains:
        """With the limits that hold inside the guards; NotAllowed where weight would pass the error limit with them."""
        hangs = sag(gains, self.bears)
        if hangs + abs(self.wish.step) >= self.error_limit:
            raise NotAllowed(
                f"Not started: axis {self.axis} needs {self.bears:.2f} V to stay where it is. With KP {gains.kp:g} it "
                f"would hang {hangs:.0f} counts below its place, and with the step pass the error limit of "
                f"{self.error_limit:.0f} counts: its motor would go off. Take more KP."
            )
        limits = ("integrator_limit", "torque_limit", "offset")
        return dc.replace(gains, **{name: getattr(self.inside, name) for name in limits})

    def _check(self) -> None:
        not_stopped(self.c, self.began)
        if self.job.cancelled:
            raise Cancelled(f"Cancelled. The former values of axis {self.axis} are back.")

    def _captured(self, plan: Plan, wanted: Excitation | None = None) -> Steps[Capture]:
        """The record; a STOP or a cancel while it is read ends the run as well."""
        try:
            capture = yield from capture_steps(self.c, plan, self._inner(), during=self._calm_after(plan, wanted))
        except LinkError:
            self._check()
            raise
        self._check()
        return capture

    def _inner(self) -> CaptureJob:
        """A recording's own job: its progress is ours, and so is a cancel."""

        def progress(inner: Job[Capture]) -> None:
            inner.cancelled = inner.cancelled or self.job.cancelled or self.c.stop_pressed_at >= self.began
            self.job.show(self.job.phase, inner.done, inner.total)

        return CaptureJob(progress)

    def _heavy(self) -> Steps[str]:
        """Whether so much hangs on the axis that it must not be without KP, in words."""
        carried, _ = yield from self._held()
        if abs(carried) <= HEAVY * self.former_gains.torque_limit:
            return ""
        yield from self._calm()
        return (
            f"Axis {self.axis} needs {abs(carried):.2f} V to stay where it is: weight hangs on it. A dual loop is "
            "tuned from KP 0 upwards, and with that it would sink. Tune it by hand, with the KP it has."
        )

    def _held(self) -> Steps[tuple[float, bool]]:
        """Volts with which KP holds the axis, after KI has gone (what it had integrated may stay); whether it rests."""
        yield from assign(self.c, self.axis, {"KI": 0})
        yield Wait(SETTLE_S)
        for _ in range(RESTING):
            errors = yield from self._errors()
            rests = max(errors) - min(errors) <= QUIET_COUNTS
            if rests:
                break
        return held(self.former_gains) * sum(errors) / len(errors), rests

    def _jog(self, gains: Gains) -> Steps[None]:
        """A jog at speed 0 with these gains, at rest for a moment; without KP, OF holds what KP held before."""
        self._check()
        values = registers(gains)
        if not gains.kp and self.former_gains.kp:
            carried, rests = yield from self._held()
            carried = carried if rests else 0.0  # of a load that floats in its backlash nothing can be told
            values["OF"] = COMMANDS["OF"].stored(self.former.values["OF"] + scaled(carried))
        yield from assign(self.c, self.axis, values)
        for line in (f"JG{self.axis}=0", f"BG {self.axis}"):
            answer = yield from proved(self.c.nonces, line, LINE_S, REFUSAL_S)
            if answer.kind is not Kind.ACCEPTED:
                yield from watch(self.c, self.axis)
                raise LinkError(f"The step could not begin: “{line}” was not accepted.")
        yield Wait(SETTLE_S)
        yield from self._stands(gains)

    def _stands(self, gains: Gains) -> Steps[None]:
        """The motor is on and the axis does not swing already; an integrator has taken over what it has to carry."""
        places = yield from self._errors()
        for _ in range(RESTING if gains.ki else 0):
            before, places = places, (yield from self._errors())
            if abs(sum(places) - sum(before)) <= len(places) / 2:
                break
        if max(places) - min(places) <= max(QUIET_COUNTS, abs(self.wish.step) // 4):
            return
        seen = f"(TE between {min(places)} and {max(places)} counts)"
        if not gains.kp:
            raise Fault(
                f"Axis {self.axis} does not stay where it is with KP 0 {seen}: weight, or more backlash than a dual "
                "loop can hold. The former gains are back: tune it by hand."
            )
        raise Fault(
            f"Axis {self.axis} swings at rest with these gains {seen}. The former gains are back: take less KP or KI."
        )

    def _errors(self) -> Steps[list[int]]:
        """The position error at some moments, counts; Fault where the motor went off."""
        found, volts = [], 0.0
        for _ in range(4):
            yield from watch(self.c, self.axis)
            told = yield from exact(self.c.nonces, [f"_TE{self.axis}", f"_TT{self.axis}"], self.model.columns)
            error, torque = ((value or 0) / ONE for value in told)
            found.append(math.floor(error))
            volts += torque
        self.rest = sum(found) / len(found), volts / len(found)
        return found

    def _look(self) -> Steps[None]:
        """The motor command at odd moments, which no regular record can hide a swing from."""
        found: list[float] = []
        for wait in LOOKS_S:
            told = yield from exact(self.c.nonces, [f"_TT{self.axis}"], self.model.columns)
            found.append((told[0] or 0) / ONE)
            yield Wait(wait)
        self.looks = tuple(found)

    def _plan(self, seconds: float, values: int, go: str) -> Plan:
        sample = period(self.tm)
        wanted = (Channel("error", self.axis), Channel("torque", self.axis))  # more would only take longer to read
        values = min(values, most(self.model, len(wanted)))
        exponent = next((n for n in range(1, 8) if values * 2**n * sample >= seconds), 8)
        count = min(values, max(40, math.ceil(seconds / (2**exponent * sample))))
        return Plan(wanted, exponent, count, go=go)

    def _calm_after(self, plan: Plan, wanted: Excitation | None = None) -> Callable[[], Steps[None]]:
        """While it is recorded: the jumps; behind it the jog ends and the former gains are back, before any upload."""

        def during() -> Steps[None]:
            began = self.c.clock()
            for jump in wanted.steps if wanted is not None else ():
                self._check()
                yield Wait(max(jump.at - (self.c.clock() - began), 0.0))
                yield from proved(self.c.nonces, f"IP {at(self.axis, jump.counts)}", LINE_S, REFUSAL_S)
            end = began + plan.count * plan.interval_s(self.tm)
            yield Wait(max(end - self.c.clock(), 0.0))
            while (yield from exact(self.c.nonces, ["_RC"], self.model.columns))[0]:
                self._check()
                if self.c.clock() > end + RECORDED_S:
                    raise LinkError("The recording did not come to its end.")
                yield Wait(0.02)
            if wanted is None:
                yield from self._look()
            yield from self._calm()

        return during

    def _calm(self) -> Steps[None]:
        yield from watch(self.c, self.axis)
        yield from assign(self.c, self.axis, {name: self.former.values[name] for name in (*FIELDS, "OF")})
        yield from proved(self.c.nonces, f"ST {self.axis}", LINE_S, REFUSAL_S)

    def _response(self, capture: Capture, counts: int) -> Response:
        """With a little rest before the step, which falls within a sample of the first element."""
        volts, error = (capture.of(Channel(name, self.axis)) for name in ("torque", "error"))
        stepped = np.arange(len(error)) >= int(np.argmax(np.abs(error) > abs(counts) / 2))
        actual = np.where(stepped, float(counts), 0.0) - error
        commanded = np.where(np.arange(len(error)) >= 1, float(counts), 0.0)
        rest, (error_before, volts_before) = np.zeros(BEFORE), self.rest
        return Response(
            capture.interval_s,
            np.concatenate([rest, commanded]),
            np.concatenate([rest - error_before, actual]),
            np.concatenate([rest + volts_before, volts]),
        )

    def _recording(self, capture: Capture, gains: Gains, wanted: Excitation) -> Recording:
        several = len(capture.channels)
        return Recording(
            period=period(self.tm),
            every=capture.interval_samples,
            gains=gains,
            error=capture.of(Channel("error", self.axis)),
            volts=capture.of(Channel("torque", self.axis)),
            position=capture.of(Channel("position", self.axis)) if several > 2 else None,
            steps=tuple(jump.counts for jump in wanted.steps),
        )
