"""Gains for a crossover and a phase margin: the method of dmc-1412-1414.txt l.4595-4718 with the sampled filter."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy

from codegen.twoletter.commands import COMMANDS
from device.tuning.excite import kick
from device.tuning.loop import FACTORY, VOLTS, Complex, Gains, Margins, filter_response, grid, is_stable, margins_of
from device.tuning.plant import AxisPlant, Vector, response, shifted

APART = 0.5  # |1 + A| above the crossover: 6 dB, whatever the phase
DRIFT = (0.9, 1.1)  # the resonance may lie there instead
APART_DRIFTED = 0.35
CLOSE, CLOSE_PHASE = 0.05, 2.5  # part of the crossover and degrees that rounding may take
MOST_INTEGRAL = 0.5  # of the crossover: an integrator corner above it makes the answer creep and swing
COARSE = 0.25  # of the torque limit: more than that for one count of the encoder is no loop but a switch
LOUD = 0.1  # of the torque limit: from there on one count can be heard
FASTEST = 0.9  # of half the sampling frequency
RATIO = 1.06  # between two crossovers that are tried
TRIES = 60
SOUND_PHASE = 50.0  # degrees
SOUND_PART = 0.6  # of the fastest crossover there is


@dataclass(frozen=True)
class Target:
    """What the loop should do."""

    crossover: float  # rad/s
    phase: float  # degrees
    integral: float = 0.2  # corner of the integrator as a part of the crossover; 0: KI 0


@dataclass(frozen=True)
class Design:
    """Gains the controller can hold, and what they reach."""

    gains: Gains
    margins: Margins
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Refusal:
    """Why a target cannot be reached, and the nearest that can."""

    reason: str
    nearest: Design | None
    nearest_target: Target | None


@dataclass(frozen=True)
class Known:
    """A plant with its responses, worked out once."""

    plant: AxisPlant
    period: float
    keep: Gains
    frequency: Vector
    responses: tuple[tuple[AxisPlant, Complex], ...]  # as identified first, then with the resonance elsewhere


def known(plant: AxisPlant, period: float, keep: Gains) -> Known:
    """The responses over the whole grid."""
    frequency = grid(period)
    variants = [plant, *(shifted(plant, part) for part in DRIFT if plant.resonance is not None)]
    return Known(plant, period, keep, frequency, tuple((one, response(one, period, frequency)) for one in variants))


def limits(name: str) -> tuple[float, float]:
    """Largest value and resolution of a gain."""
    row = COMMANDS[name]
    return float(row.high or 0.0), float(row.step or 1.0)


def exact(at: complex, target: Target, period: float) -> tuple[float, float, float] | str:
    """KP, KD and KI that make |A| 1 and the phase what was asked (l.4656-4700), or why there are none."""
    wanted = complex(math.cos(math.radians(target.phase - 180.0)), math.sin(math.radians(target.phase - 180.0)))
    needed = wanted / at / VOLTS
    change = 1.0 - complex(math.cos(target.crossover * period), -math.sin(target.crossover * period))
    corner = 1.0 - math.exp(-target.integral * target.crossover * period)
    first, second = 1.0 + corner / change, change
    whole = first.real * second.imag - first.imag * second.real
    p = (needed.real * second.imag - needed.imag * second.real) / whole
    d = (first.real * needed.imag - first.imag * needed.real) / whole
    if p <= 0.0:
        return "late"
    if d >= 0.0:
        return p / 4.0, d / 4.0, 2.0 * corner * p
    return lagging(needed, change, target, period)


def lagging(needed: complex, change: complex, target: Target, period: float) -> tuple[float, float, float] | str:
    """KP and KI alone, where the plant leaves more phase than was asked."""
    total = needed.imag / (1.0 / change).imag
    p = needed.real - total * (1.0 / change).real
    most = 1.0 - math.exp(-MOST_INTEGRAL * target.crossover * period)
    if target.integral == 0.0 or p <= 0.0 or not 0.0 <= total <= most * p:
        return "early"
    return p / 4.0, 0.0, 2.0 * total


def rounded(name: str, value: float) -> tuple[float, ...]:
    """The two values nearest to it that the controller can hold."""
    high, step = limits(name)
    low = math.floor(value / step) * step
    return tuple(dict.fromkeys(min(high, one) for one in (low, low + step))) if value else (0.0,)


def margins_at(case: Known, gains: Gains) -> Margins:
    """Margins without the poles, which take longer."""
    loop = case.responses[0][1] * filter_response(gains, case.period, case.frequency)
    return margins_of(loop, case.frequency, True)


def miss(found: Margins, target: Target) -> float:
    """How far margins are from the target: 1 is what rounding may take."""
    if found.crossover is None or found.phase is None:
        return math.inf
    return max(abs(found.crossover / target.crossover - 1.0) / CLOSE, abs(found.phase - target.phase) / CLOSE_PHASE)


def nearest_gains(case: Known, target: Target, values: Sequence[float]) -> tuple[Gains, Margins]:
    """The best of the values around the exact ones that the controller can hold."""
    options = []
    choices = [rounded(name, value) for name, value in zip(("KP", "KD", "KI"), values, strict=True)]
    for kp, kd, ki in itertools.product(*choices):
        gains = replace(case.keep, kp=kp, kd=kd, ki=ki)
        found = margins_at(case, gains)
        options.append((miss(found, target), gains, found))
    best = min(options, key=lambda one: one[0])
    return best[1], best[2]


def degrees(value: complex) -> float:
    """Angle of a plant's response from -360 to 0."""
    angle = math.degrees(math.atan2(value.imag, value.real))
    return angle - 360.0 if angle > 0.0 else angle


def hertz(crossover: float) -> str:
    """As the person asks for it."""
    return f"{crossover / (2.0 * math.pi):.3g} Hz"


def no_lead(case: Known, target: Target, at: complex) -> str:
    """Why the phase cannot be had."""
    lag = -degrees(at)
    causes = ["the hold of the sample"]
    if case.plant.delay > 0.2 * case.period:
        causes.append(f"a delay of {case.plant.delay * 1000:.2f} ms")
    if case.plant.resonance is not None:
        causes.append(f"the resonance at {case.plant.resonance.frequency:.0f} Hz")
    return (
        f"At {hertz(target.crossover)} the axis is {lag:.0f}° late (inertia, {', '.join(causes)}); KD gives back "
        f"less than 90°, and {target.phase:.0f}° of margin needs more."
    )


def too_much_phase(case: Known, target: Target, at: complex) -> str:
    """Why less margin cannot be had."""
    has = 180.0 + degrees(at)
    return (
        f"At {hertz(target.crossover)} the axis has {has:.0f}° of margin with KP alone"
        + (" (its drive closes a velocity loop)" if case.plant.velocity_mode else "")
        + f"; {target.phase:.0f}° would need a negative KD. Ask for a higher crossover or more margin."
    )


def unsound(case: Known, gains: Gains, found: Margins, target: Target) -> str | None:
    """What is wrong with gains that reach the target at the crossover, in a sentence."""
    spring = case.plant.resonance
    where = f"the resonance at {spring.frequency:.0f} Hz" if spring else "what the delay leaves of the phase"
    if not is_stable(case.plant, gains, case.period):
        values = f"KP {gains.kp:g}, KD {gains.kd:g}, KI {gains.ki:g}"
        return f"With {values} the loop would oscillate: {where} does not allow it."
    if found.crossover is None or abs(found.crossover / target.crossover - 1.0) > CLOSE:
        if miss(found, target) < 8.0 and spring is None:
            return (
                f"KP {gains.kp:g}, KD {gains.kd:g} is as near as whole steps of the gains come to "
                f"{hertz(target.crossover)}: they are too coarse for this axis."
            )
        return f"The gain passes 1 more than once: {where} lifts or lowers it again."
    if found.phase is None or found.phase < target.phase - CLOSE_PHASE:
        return (
            f"Behind the crossover {where} lifts the gain above 1 again, with only {found.phase or 0:.0f}° of margin."
        )
    if found.phase > target.phase + CLOSE_PHASE:
        return f"KP {gains.kp:g}, KD {gains.kd:g}: whole steps of the gains are too coarse for this axis."
    above = case.frequency > found.crossover
    least = min(APART, 1.8 * math.sin(math.radians(target.phase) / 2.0))
    for n, (variant, of_plant) in enumerate(case.responses):
        apart = numpy.abs(1.0 + of_plant * filter_response(gains, case.period, case.frequency))[above].min()
        if apart < (least if n == 0 else APART_DRIFTED) or (n and not is_stable(variant, gains, case.period)):
            if spring is None:
                return "More than the half of what would make it oscillate: less than 6 dB of gain margin are left."
            return f"The resonance at {spring.frequency:.0f} Hz would not stay 6 dB below oscillation" + (
                "." if n == 0 else " if it lies 10 % elsewhere."
            )
    if kick(gains) > COARSE * gains.torque_limit:
        return (
            f"One count of the encoder would make {kick(gains):.1f} V (KP {gains.kp:g}, KD {gains.kd:g}): "
            "the encoder is too coarse for this crossover."
        )
    return None


def attempt(case: Known, target: Target) -> Design | str:
    """The gains, or why not."""
    if target.crossover >= FASTEST * math.pi / case.period:
        return f"{hertz(target.crossover)} is too near to half the sampling frequency."
    at = complex(response(case.plant, case.period, numpy.array([target.crossover]))[0])
    values = exact(at, target, case.period)
    if values == "late":
        return no_lead(case, target, at)
    if isinstance(values, str):
        return too_much_phase(case, target, at)
    for name, value in zip(("KP", "KD", "KI"), values, strict=True):
        if value > limits(name)[0]:
            return f"{name} would have to be {value:.0f}; the controller takes {limits(name)[0]:g} at most."
    if values[0] < 0.5 * limits("KP")[1]:
        return f"KP would have to be {values[0]:.3f}, less than the controller's step of {limits('KP')[1]:g}."
    gains, found = nearest_gains(case, target, values)
    wrong = unsound(case, gains, found, target)
    return wrong or Design(gains, found, remarks(case, gains, found, target.integral > 0.0))


def remarks(case: Known, gains: Gains, found: Margins, asked: bool) -> tuple[str, ...]:
    """What to know about gains that are sound."""
    said = []
    if asked and not gains.ki:
        said.append(f"KI would be smaller than its step of {limits('KI')[1]:g}, so it is 0.")
    if kick(gains) > LOUD * gains.torque_limit:
        said.append(f"One count of the encoder makes {kick(gains):.2f} V: the motor may be heard.")
    if case.plant.gravity and not gains.ki and abs(case.plant.gravity) > 4.0 * VOLTS * gains.kp:
        sag = abs(case.plant.gravity) / (4.0 * VOLTS * gains.kp)
        said.append(f"Without KI the weight leaves an error of {sag:.0f} counts.")
    loop = case.responses[0][1] * filter_response(gains, case.period, case.frequency)
    if case.plant.resonance is not None and found.crossover is not None:
        above = (case.frequency > 1.5 * found.crossover) & (numpy.abs(loop) > 1.0)
        if above.any():
            said.append(
                f"At {case.plant.resonance.frequency:.0f} Hz the gain is above 1 again; its phase makes that safe, "
                "as long as the resonance stays where it is."
            )
    return tuple(said)


def design(plant: AxisPlant, target: Target, period: float, keep: Gains = FACTORY) -> Design | Refusal:
    """Gains for a target, or why there are none and which target is the nearest that can be reached."""
    if not (target.crossover > 0.0 and 0.0 < target.phase < 90.0 and 0.0 <= target.integral <= MOST_INTEGRAL):
        return Refusal(
            "A target is a crossover above 0 Hz, a phase margin between 0 and 90° and an integrator corner of at "
            f"most {MOST_INTEGRAL:g} of the crossover.",
            None,
            None,
        )
    case = known(plant, period, keep)
    found = attempt(case, target)
    if isinstance(found, Design):
        return found
    for part in (0.5, 0.0):
        slower = replace(target, integral=target.integral * part)
        near = attempt(case, slower) if target.integral else found
        if isinstance(near, Design):
            return Refusal(f"{found} With {'less' if part else 'no'} integrator it can be reached.", near, slower)
    for n in range(1, TRIES):
        for factor in (RATIO**-n, RATIO**n):
            other = replace(target, crossover=target.crossover * factor)
            near = attempt(case, other)
            if isinstance(near, Design):
                return Refusal(found, near, other)
    return Refusal(found, None, None)


def propose(plant: AxisPlant, period: float, keep: Gains = FACTORY) -> Target | None:
    """A sound target to begin with: well below the fastest crossover there is; None where nothing can be reached."""
    case = known(plant, period, keep)
    for most in (LOUD, COARSE):
        crossover = 0.25 * math.pi / period
        while crossover > 1.0:
            found = attempt(case, Target(crossover, SOUND_PHASE))
            if isinstance(found, Design) and kick(found.gains) <= most * found.gains.torque_limit:
                slower = Target(float(f"{crossover * SOUND_PART:.2g}"), SOUND_PHASE)
                return slower if isinstance(attempt(case, slower), Design) else Target(crossover, SOUND_PHASE)
            crossover /= RATIO
    return None
