"""Automatic tuning as the manuals describe it: KD and KP up while the response is tested, then KI (pure, no link).

ssc-tol-o-motion.txt l.2938: "starts by increasing the Kd then slowly incrementing the Kp and testing the response of
each increment [...] until the desired response is achieved. The routine then increased Ki and tests the position
error." dmc-1412-1414.txt l.855-891: the integrator last, KP not above KD/4, less of what made the motor vibrate;
l.2252 for the dual loop: KP 0 and KI 0 while KD is maximised.
"""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Generator, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.fixed import ONE, scaled
from device.tuning.design import COARSE, LOUD
from device.tuning.entry import gains_words
from device.tuning.excite import held, kick
from device.tuning.metrics import Metrics, last, measure

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from device.tuning.loop import Gains
    from device.tuning.metrics import Response

VELOCITY = (
    "Automatic tuning should be performed when controlling a drive operating in torque mode. When controlling a drive "
    "operating in velocity mode do not perform an auto tune; instead proceed to manual tuning."
)  # ssc-tol-o-motion.txt l.2938
FAILED = (
    "The auto tune may not work for all systems: proceed to the manual tune and restore the default values of Kp=6, "
    "Ki=0, Kd=64."
)  # ssc-tol-o-motion.txt l.2938
KD_FACTOR, KP_FACTOR, KI_FACTOR = 1.6, 1.5, 2.0
GENTLE = 64.0  # KD over the KP from which a dual loop gets stiffer; KD/4 is the most (l.885)
LOWER = 0.6  # of what made it vibrate
WANTED_OVERSHOOT = 0.12  # below it KP may go up
WANTED_S = 0.04  # settled so soon, nothing more is tried
CALMER = 0.8  # of the overshoot so far: less is an improvement
KI_OVERSHOOT = 0.3  # an integrator always overshoots a step; more than this is too much of it
WORTH = 0.93  # of the settling time so far: less is an improvement
NEAR_COUNTS = 1.0  # the position error that is "zero"
TORQUE_PART = 0.12  # of the torque limit: a motor command that swings by more than this to either side vibrates
COUNTS, MOST_PART = 2.0, 0.4  # or by more than so many counts of the encoder make, this part of the limit at most


@dc.dataclass(frozen=True)
class Trial:
    """The next gains to try, and why, in words."""

    gains: Gains
    why: str


@dc.dataclass(frozen=True)
class Seen:
    """What came of a trial."""

    metrics: Metrics | None
    vibrates: bool = False
    carried: float = 0.0  # V that hold the axis at the end

    @property
    def settled(self) -> float:
        """Settling time in s; infinite where it did not settle."""
        if self.metrics is None or self.metrics.settling_time is None or self.vibrates:
            return float("inf")
        return self.metrics.settling_time

    @property
    def ms(self) -> float:
        """The same in ms."""
        return self.settled * 1000

    @property
    def overshoot(self) -> float:
        return self.metrics.overshoot if self.metrics is not None else 0.0


@dc.dataclass(frozen=True)
class Chosen:
    """The end: gains, or a refusal in words."""

    gains: Gains | None
    words: str


def seen(response: Response, gains: Gains, swings: bool) -> Seen:
    """What a trial tells of its gains, an axis with weight on it lifted by what it sags before the step and after it.

    Friction leaves an error on the side it came from, weight on the same side always: KI takes it away, at last.
    """
    found = measure(response, gains.torque_limit)
    if isinstance(found, str):
        return Seen(None, swings)
    before, after = float(response.commanded[0] - response.actual[0]), found.steady_error
    sag = math.copysign(min(abs(before), abs(after)), after) if before * after > 0 else 0.0
    lifted = measure(dc.replace(response, actual=response.actual + sag), gains.torque_limit)
    assert isinstance(lifted, Metrics)  # the same commanded step
    carried = float(response.volts[last(response)].mean()) - gains.offset
    return Seen(dc.replace(lifted, steady_error=after), swings, carried)


Search = Generator[Trial, Seen, Chosen]


def grain(name: str, value: float) -> float:
    """The nearest value the controller can hold, inside its range."""
    row = COMMANDS[name.upper()]
    inside = min(max(value, float(row.low or 0)), float(row.high or 0))
    return row.stored(scaled(Fraction(inside))) / ONE


def with_gains(gains: Gains, **values: float) -> Gains:
    """Other gains at the controller's resolution."""
    return dc.replace(gains, **{name: grain(name, value) for name, value in values.items()})


def vibrates(response: Response, gains: Gains, looks: Sequence[float] = ()) -> bool:
    """Whether error or torque goes on changing its sign at the end of the record (l.869: "reversing polarity").

    `looks`: the motor command as read after it, at odd moments. A loop at the end of its damping swings in four
    samples to and fro; every 4th or 8th sample of that is always the same volt.
    """
    error = response.commanded - response.actual
    step = float(np.ptp(response.commanded)) or 1.0
    late = len(error) - len(error) * 2 // 5
    counted = min(COUNTS * kick(gains), MOST_PART * gains.torque_limit)
    volts, most = response.volts[late:], max(TORQUE_PART * gains.torque_limit, counted)
    return _swings(error[late:], max(2.0, 0.05 * step)) or _swings(volts, most) or _unseen(volts, looks, most)


def _unseen(volts: NDArray[np.float64], looks: Sequence[float], most: float) -> bool:
    """The looks differ, and lie where the record never was."""
    if not looks or max(looks) - min(looks) <= 2 * most:
        return False
    return max(looks) > float(volts.max()) + most or min(looks) < float(volts.min()) - most


def _swings(values: NDArray[np.float64], least: float) -> bool:
    """At least two whole periods, larger than `least`, and not dying away."""
    values = values[np.isfinite(values)]
    if len(values) < 12:
        return False
    about = values - values.mean()
    turns = int(np.count_nonzero(np.diff(np.signbit(about))))
    half = len(about) // 2
    first, last = float(np.ptp(about[:half])) / 2, float(np.ptp(about[half:])) / 2
    return turns >= 4 and last > least and last > 0.5 * first


def search(start: Gains, dual: bool = False) -> Search:
    """Yields trials, is sent what came of them; ends with what to use."""
    first = with_gains(start, ki=0.0, kp=0.0 if dual else min(start.kp, start.kd / 4), fv=0.0, fa=0.0)
    seen = yield Trial(first, "The integrator is 0 first; the response with the damping there is now.")
    if seen.vibrates:
        lower = with_gains(first, kd=first.kd * LOWER, kp=first.kp * LOWER)
        seen = yield Trial(lower, "It vibrates already: less of everything.")
        if seen.vibrates:
            return Chosen(None, f"The axis vibrates even with {gains_words(lower)}. {FAILED}")
        first = lower
    if dual:
        first = yield from _most_damping(first)
    best = Best(first, seen)
    yield from _more_stiffness(best, first, seen)
    yield from _stiffer(best)
    if best.seen.settled == float("inf"):
        return Chosen(None, f"No response settled within the record, the best was {gains_words(best.gains)}. {FAILED}")
    return (yield from _integrator(best.gains, best.seen, best.words))


def _most_damping(gains: Gains) -> Generator[Trial, Seen, Gains]:
    """The dual loop: KD as large as it goes without vibration, KP and KI 0; and not so large that it is only heard."""
    best = gains
    while best.kd < float(COMMANDS["KD"].high or 0) / KD_FACTOR:
        more = with_gains(best, kd=best.kd * KD_FACTOR)
        if kick(more) > LOUD * more.torque_limit:
            break
        seen = yield Trial(more, f"Dual loop: KD up to {more.kd:g} while KP is 0.")
        if seen.vibrates:
            best = with_gains(best, kd=best.kd * LOWER)
            break
        best = more
    return with_gains(best, kp=max(1.0, best.kd / GENTLE))


@dc.dataclass
class Best:
    """What was best so far, and why nothing more is tried."""

    gains: Gains
    seen: Seen
    words: str = ""

    def take(self, gains: Gains, seen: Seen) -> bool:
        """Whether these are better: settled sooner, or not overshooting so far any more."""
        calmer = self.seen.overshoot > WANTED_OVERSHOOT and seen.overshoot < CALMER * self.seen.overshoot
        better = seen.settled < WORTH * self.seen.settled or (calmer and seen.settled <= self.seen.settled)
        if better and not seen.vibrates:
            self.gains, self.seen = gains, seen
        return better and not seen.vibrates


def _stiffer(best: Best) -> Generator[Trial, Seen, None]:
    """KD up, then KP up to KD/4, testing each; goes on while the response gets better."""
    improved = True
    while improved:
        if best.seen.settled <= WANTED_S and best.seen.overshoot <= WANTED_OVERSHOOT:
            best.words = f"it settles within {best.seen.settled * 1000:.0f} ms, which is as good as is wanted"
            return
        kd = grain("kd", best.gains.kd * KD_FACTOR)
        if kd <= best.gains.kd:
            best.words = f"KD {kd:g} is the most there is"
            return
        trial = with_gains(best.gains, kd=kd)
        if kick(trial) > COARSE * trial.torque_limit:
            best.words = f"with KD {kd:g} one count of the encoder would make {kick(trial):.1f} V"
            return
        seen = yield Trial(trial, f"KD up to {kd:g}: more damping allows more stiffness.")
        if seen.vibrates:
            best.words = f"KD {kd:g} made it vibrate, so it stays at {best.gains.kd:g}"
            return
        improved = best.take(trial, seen)
        improved = (yield from _more_stiffness(best, trial, seen)) or improved
    best.words = best.words or f"more than KD {best.gains.kd:g} and KP {best.gains.kp:g} made it no better"


def _more_stiffness(best: Best, at: Gains, seen: Seen) -> Generator[Trial, Seen, bool]:
    """KP up in steps with this KD, while that helps; whether anything became better."""
    improved = False
    while seen.overshoot <= WANTED_OVERSHOOT:
        kp = grain("kp", max(at.kp * KP_FACTOR, at.kp + 1.0))
        if kp > at.kd / 4 or kp <= at.kp:  # l.885: typically not greater than KD/4
            break
        at = with_gains(at, kp=kp)
        seen = yield Trial(at, f"KP up to {kp:g}: stiffer, with KD {at.kd:g}.")
        if seen.vibrates:
            best.words = f"KP {kp:g} made it vibrate, so it stays at {best.gains.kp:g}"
            break
        improved = best.take(at, seen) or improved
    return improved


def _integrator(best: Gains, seen: Seen, words: str) -> Search:
    """KI up until the position error is gone; less of it where it overshoots or vibrates."""
    told = f"{words}"
    ki = grain("ki", max(best.kp / 32, 1 / 128))
    # an integrator may go on giving what it had gathered before KI was 0; only without it would the error show
    hidden = abs(seen.carried) > NEAR_COUNTS * 1.5 * held(best)
    if seen.metrics is not None and abs(seen.metrics.steady_error) <= NEAR_COUNTS and not hidden:
        seen_error = abs(seen.metrics.steady_error)
        return Chosen(best, f"{_begin(told)}. The position error was {seen_error:.3g} counts without KI: KI stays 0.")
    good = best
    for _ in range(8):
        trial = with_gains(best, ki=ki)
        after = yield Trial(trial, f"KI up to {trial.ki:g}: it takes away the position error that is left.")
        unsettled = after.settled == float("inf")
        if unsettled or after.overshoot > max(KI_OVERSHOOT, seen.overshoot + 0.15):
            what = "made it vibrate" if after.vibrates else "did not settle" if unsettled else "overshot too far"
            return Chosen(good, f"{_begin(told)}. KI {trial.ki:g} {what}, so it is {good.ki:g}.")
        good = trial
        if after.metrics is not None and abs(after.metrics.steady_error) <= NEAR_COUNTS:
            zero = f"KI {good.ki:g} brings the position error to zero; with it, it settles within {after.ms:.0f} ms"
            return Chosen(good, f"{_begin(told)}. {zero}.")
        ki *= KI_FACTOR
    return Chosen(good, f"{_begin(told)}. Some position error is left with KI {good.ki:g}.")


def _begin(words: str) -> str:
    return words[:1].upper() + words[1:]
