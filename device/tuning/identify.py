"""What an axis is, told from a small excitation: inertia, friction, weight, delay and the first resonance."""

from __future__ import annotations

import math
from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass, replace

import numpy

from device.tuning.excite import NotIdentified
from device.tuning.fit import Fit, Values, Windows, refining, solve, windows
from device.tuning.plant import AxisPlant, Resonance
from device.tuning.recording import Recording, Samples, every_sample

LATEST = 10  # samples of delay at most
TRIED = (0, 1, 2, 3, 5)  # delays from which the search begins
COUNTING = math.sqrt(1.0 / 12.0)  # counts; what reading in whole counts alone leaves
BETTER = 1.03  # how much smaller the residual must be for a model with Coulomb friction
SEEN = 40.0  # logarithm of the likelihood (twice) from which a resonance is believed
SHOWS = 1.015  # and how much smaller it must leave the residual
EXPECTED = 1.02  # residual over that of counting alone, below which there is nothing left to explain
AMISS = 1.2  # residual over that of counting alone, above which a model without friction is not good enough
WEAK = 0.05  # one sigma of the gain, as a part, above which a second excitation is worth its time
FEWEST = 200  # samples of motion
HARDLY = 6.0  # counts of motion
FINE = 6  # counts of the largest jump to either side; of smaller ones counting makes some percent of error
LOW_HZ, HIGH_HZ, SCANNED = 20.0, 420.0, 26
COUNTED = (0.004, 0.07, 5.0)  # parts of the gain, see `counting_error`; of some hundred simulated axes
SURE_GAIN = 0.15  # one sigma, as a part, above which a gain is not told
POLE_UNIT = 10.0  # rad/s; what the search counts in
Work = Generator[float, None, "Estimate | NotIdentified"]


@dataclass(frozen=True)
class Estimate:
    """The axis as the excitation showed it."""

    plant: AxisPlant
    sigma: dict[str, float]  # one standard deviation of gain, pole, coulomb, gravity, delay and, where seen, frequency
    fit: float  # part of the motion's variance that is explained
    left: float  # counts, standard deviation of what is not explained; 0.29 is counting alone
    notes: tuple[str, ...]  # what could not be told, and why


@dataclass(frozen=True)
class Found:
    """One kind of model at its best."""

    data: Windows
    rubbing: bool
    shape: Callable[[Values], AxisPlant]
    values: Values
    fit: Fit
    curvature: Values

    @property
    def repeated(self) -> float:
        """How much larger deviations are than for white noise: the residual's samples repeat each other."""
        residual = self.fit.residual
        alike = float(residual[1:] @ residual[:-1]) / (self.fit.cost or 1.0)
        alike = min(0.98, max(0.0, alike))
        return math.sqrt((1.0 + alike) / (1.0 - alike))

    @property
    def left(self) -> float:
        """Standard deviation of the residual, counts."""
        return math.sqrt(self.fit.cost / max(1, self.data.samples))


def rigid(values: Values, period: float) -> AxisPlant:
    """Pole and delay."""
    return AxisPlant(gain=1.0, pole=float(values[0]) * POLE_UNIT, delay=float(values[1]) * period)


def springy(values: Values, period: float, on_load: bool) -> AxisPlant:
    """Pole, delay, and logarithms of frequency, damping and (encoder on the motor) ratio of inertias."""
    hertz, damping = math.exp(values[2]), math.exp(values[3])
    # an encoder on the load does not tell how the inertia is divided
    ratio = 1.0 if on_load else math.exp(values[4])
    return replace(rigid(values, period), resonance=Resonance(hertz, damping, ratio, on_load))


def bounds(places: int) -> tuple[Values, Values]:
    """The search stays within these."""
    low = [-1.0, 0.0, math.log(15.0), math.log(0.002), math.log(0.02)]
    high = [400.0, LATEST - 0.001, math.log(480.0), math.log(0.7), math.log(20.0)]
    return numpy.array(low[:places]), numpy.array(high[:places])


def best_rigid(data: Windows, rubbing: bool, done: float) -> Generator[float, None, Found]:
    """The best machine without a spring."""

    def shape(values: Values) -> AxisPlant:
        return rigid(values, data.period)

    found: list[Found] = []
    for late in TRIED:
        start = numpy.array([0.1, float(late)])
        values, fit, curvature = yield from refining(data, start, shape, rubbing, *bounds(2), done)
        found.append(Found(data, rubbing, shape, values, fit, curvature))
    return min(found, key=lambda one: one.fit.cost)


def best_springy(base: Found, on_load: bool, done: float) -> Generator[float, None, Found]:
    """The best machine with a spring, its encoder on one side of it."""
    data, rubbing = base.data, base.rubbing

    def shape(values: Values) -> AxisPlant:
        return springy(values, data.period, on_load)

    places = 4 if on_load else 5
    delays = sorted({float(late) for late in TRIED[:4]} | {float(base.values[1])})
    starts: list[tuple[float, Values]] = []
    for hertz in numpy.geomspace(LOW_HZ, HIGH_HZ, SCANNED):
        for late in delays:
            for ratio in (1.0,) if on_load else (0.3, 1.5):
                values = numpy.array([base.values[0], late, math.log(hertz), math.log(0.04), math.log(ratio)])[:places]
                starts.append((solve(data, shape(values), rubbing).cost, values))
            yield done
    starts.sort(key=lambda one: one[0])
    values, fit, curvature = yield from refining(data, starts[0][1], shape, rubbing, *bounds(places), done + 0.1)
    return Found(data, rubbing, shape, values, fit, curvature)


def believable(found: Found, base: Found) -> bool:
    """Whether the spring explains so much more that it is no chance."""
    seen, spread = found.fit.plant.resonance, deviations(found)
    if seen is None or found.fit.cost <= 0.0 or found.fit.plant.gain <= 0.0:
        return False
    likelier = found.data.samples * math.log(base.fit.cost / found.fit.cost)
    sure = spread[2] < 0.1 and seen.damping < 0.5 and (len(spread) < 5 or spread[4] < 0.4)
    return sure and likelier > SEEN and base.left > SHOWS * found.left


def deviations(found: Found) -> Values:
    """One sigma of the values that were searched."""
    covariance = numpy.linalg.pinv(found.curvature) * (found.left * found.repeated) ** 2
    result: Values = numpy.sqrt(numpy.maximum(0.0, numpy.diag(covariance)))
    return result


def sigmas(found: Found) -> dict[str, float]:
    """One sigma of every number of the plant: its own, and what the searched values pass on."""
    plant, spread = found.fit.plant, deviations(found)
    variances = [(value * found.repeated) ** 2 for value in found.fit.spread] + [0.0]
    for n, width in enumerate(spread):
        near = found.values.copy()
        near[n] += 1e-3
        other = solve(found.data, found.shape(near), found.rubbing).plant
        for place, change in enumerate(
            (
                other.gain - plant.gain,
                other.gravity * other.gain - plant.gravity * plant.gain,
                other.coulomb * other.gain - plant.coulomb * plant.gain,
            )
        ):
            if place < len(variances):
                variances[place] += (change / 1e-3 * width) ** 2
    gain = abs(plant.gain) or 1.0
    result = {
        "gain": math.sqrt(variances[0]),
        "pole": float(spread[0]) * POLE_UNIT,
        "gravity": math.sqrt(variances[1]) / gain,
        "coulomb": math.sqrt(variances[2]) / gain,
        "delay": float(spread[1]) * found.data.period,
    }
    if plant.resonance is not None:
        result["frequency"] = float(spread[2]) * plant.resonance.frequency
        result["damping"] = float(spread[3]) * plant.resonance.damping
        if len(spread) > 4:
            result["ratio"] = float(spread[4]) * plant.resonance.ratio
    return result


def counting_error(left: float, jump: int) -> float:
    """One sigma, as a part of the gain, of what reading in whole counts makes beyond chance.

    The counts that are lost follow the motion itself, so they lean to one side: the more, the smaller the jumps
    (counts) are and the more the axis chatters between its counts, which leaves more unexplained.
    """
    always, counted, chattering = COUNTED
    return math.hypot(always, (counted + chattering * max(0.0, left - COUNTING)) / max(1, jump))


def explained(found: Found) -> float:
    """Part of the motion's variance, window by window."""
    weight, counts = found.data.weight, found.data.counts
    mean = (weight * counts).sum(axis=1, keepdims=True) / weight.sum(axis=1, keepdims=True)
    whole = float((weight * (counts - mean) ** 2).sum())
    return max(0.0, 1.0 - found.fit.cost / whole) if whole > 0.0 else 0.0


def notes(found: Found, sigma: dict[str, float]) -> tuple[str, ...]:
    """What could not be told, and why."""
    plant, said = found.fit.plant, []
    if plant.resonance is None:
        said.append(
            f"No resonance was seen from {LOW_HZ:.0f} to {HIGH_HZ:.0f} Hz; one that moves the encoder by less than "
            f"about {max(found.left, COUNTING):.1f} counts does not show. Larger jumps show more."
        )
    elif plant.resonance.on_load:
        said.append("The encoder sits behind the spring, so it does not tell how the inertia is divided.")
    if not found.rubbing:
        said.append("Coulomb friction is too small to be told from the counting of the encoder.")
    if sigma["pole"] > max(1.0, 0.5 * abs(plant.pole)):
        said.append("Viscous friction could not be told: the excitation is too short for it.")
    if plant.velocity_mode:
        said.append("The drive closes a velocity loop of its own: inertia shows only as its lag.")
    if sigma["gain"] > WEAK * plant.gain:
        said.append(
            f"The inertia is only known within {100.0 * sigma['gain'] / plant.gain:.0f} %: allow more travel, or "
            "excite again with the gains that are found now."
        )
    if found.left > 3.0 * COUNTING:
        said.append(
            f"{found.left:.1f} counts of the motion remain unexplained: play, cogging, a second resonance or the "
            "amplifier's current limit are not in the model. Leave a larger margin, or try smaller jumps."
        )
    return tuple(said)


def too_weak(found: Found, sigma: dict[str, float], moved: float, counting: float) -> str | None:
    """Why an estimate must not be used."""
    gain = found.fit.plant.gain
    if moved < HARDLY or found.data.samples < FEWEST:
        return (
            f"The axis moved {moved:.0f} counts, for too short a time: friction holds it, or the gains are too low. "
            "Allow more travel, or raise KP and KD."
        )
    if gain <= 0.0:
        return "The axis moves against the motor command: check the polarity of motor and encoder."
    if sigma["gain"] > SURE_GAIN * gain:
        if counting > sigma["gain"] / 2.0:
            return (
                "With these gains the axis chatters between its counts, and what it is cannot be told from that: lower "
                "KP and KD; the jumps can be larger then."
            )
        return "The answer is too small to tell the inertia: allow more travel, or raise KP and KD."
    return None


def identifying(recordings: Sequence[Recording]) -> Work:
    """`identify` in pieces of some 30 ms, for who must not wait; yields the part that is done."""
    samples: list[Samples] = []
    for recording in recordings:
        every = every_sample(recording)
        if isinstance(every, NotIdentified):
            return every
        samples.append(every)
    moved = max((float(numpy.ptp(one.counts)) for one in samples), default=0.0)
    bases: list[Found] = []
    for rubbing in (False, True):
        data = windows(samples, rubbing, LATEST)
        if data is not None and data.samples >= FEWEST:
            bases.append((yield from best_rigid(data, rubbing, 0.15 * rubbing)))
            if at_rest(bases[-1]):
                break
    if not bases:
        return NotIdentified(
            f"The axis moved {moved:.0f} counts, for too short a time. Allow more travel, or raise KP and KD."
        )
    if bases[0].left > BETTER * bases[-1].left:
        bases.reverse()
    candidates: list[Found] = []
    for n, base in enumerate(bases):
        candidates.append((yield from with_spring(base, 0.3 + 0.35 * n)))
        if at_rest(candidates[-1]) or rubs(candidates[-1]):
            break
    jump = max((abs(each) for recording in recordings for each in recording.steps), default=2 * FINE) // 2
    result = concluded(candidates, moved, jump)
    if isinstance(result, Estimate) and jump < FINE:
        said = (
            f"The jumps were {jump} counts, more would have been too much for KP and KD: what is told here may be some "
            "percent off. With lower gains the jumps are larger."
        )
        result = replace(result, notes=(said, *result.notes))
    return result


def at_rest(found: Found) -> bool:
    """Nothing is left to explain but the counting."""
    return found.left <= EXPECTED * COUNTING


def rubs(found: Found) -> bool:
    """Coulomb friction is plainly there."""
    return found.rubbing and found.fit.plant.coulomb > 3.0 * sigmas(found)["coulomb"]


def with_spring(base: Found, done: float) -> Generator[float, None, Found]:
    """With a spring where that explains more, else as it is."""
    if at_rest(base):
        return base
    springs = []
    for on_load in (False, True):
        springs.append((yield from best_springy(base, on_load, done + 0.17 * on_load)))
    good = [one for one in springs if believable(one, base)]
    return min(good, key=lambda one: one.fit.cost) if good else base


def concluded(candidates: list[Found], moved: float, jump: int) -> Estimate | NotIdentified:
    """The simpler of the models, unless friction is plainly there."""
    best = candidates[-1]
    if len(candidates) > 1:
        smooth, rubbing = sorted(candidates, key=lambda one: one.rubbing)
        better = smooth.left > BETTER * rubbing.left
        best = rubbing if better and (rubs(rubbing) or smooth.left > AMISS * COUNTING) else smooth
    sigma = sigmas(best)
    counting = counting_error(best.left, jump) * abs(best.fit.plant.gain)
    sigma["gain"] = math.hypot(sigma["gain"], counting)
    weak = too_weak(best, sigma, moved, counting)
    if weak:
        return NotIdentified(weak)
    plant = best.fit.plant
    plant = replace(plant, pole=max(0.0, plant.pole))
    return Estimate(plant, sigma, explained(best), best.left, notes(best, sigma))


def identify(recordings: Sequence[Recording]) -> Estimate | NotIdentified:
    """The plant behind captured excitations; takes about two seconds of one processor."""
    work = identifying(recordings)
    while True:
        try:
            next(work)
        except StopIteration as done:
            result: Estimate | NotIdentified = done.value
            return result
