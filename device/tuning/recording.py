"""What was captured, and every sample of it: the filter's own law tells the error between two captured elements."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy

from device.tuning.excite import LEAST_KD, NotIdentified
from device.tuning.loop import VOLTS, Gains
from device.tuning.plant import Vector

TORQUE_STEP = 10.0 / 32767.0  # V of a captured _TT (commands.md 4)
WHOLE = 0.3  # counts; how far from a whole number an error between two elements may come out
WHOLE_LATE = 0.1  # the same where a torque tells the error of its own sample, which it does more finely
QUIET = 9  # elements before the first jump
NEAR = 6  # samples; two jumps lie further apart
BAD_PART = 0.05  # of them, above which gains and capture do not belong together


@dataclass(frozen=True)
class Recording:
    """One capture of a small excitation, element by element."""

    period: float  # s, a servo sample
    every: int  # samples between two elements: 2^n of RC
    gains: Gains  # in effect meanwhile
    error: Vector  # _TE, counts
    volts: Vector  # _TT, V
    position: Vector | None  # _TP, counts; None where only two channels could be captured
    steps: tuple[int, ...]  # jumps of the commanded position in the order sent, counts


@dataclass(frozen=True)
class Samples:
    """Every servo sample of a recording."""

    period: float
    volts: Vector  # of the motor command
    counts: Vector  # of the encoder, from its first place
    jumps: tuple[int, ...]  # samples at which the commanded position jumped
    sure: numpy.ndarray[tuple[int], numpy.dtype[numpy.bool_]]  # False where torque or place could only be guessed


def objection(recording: Recording) -> str | None:
    """What makes a recording useless from the start."""
    gains = recording.gains
    if recording.every != 2:
        return f"the capture took every {recording.every}th sample. Capture with RC 1 (every 2nd)."
    if len(recording.error) < 64 or len(recording.error) != len(recording.volts):
        return f"the capture holds {len(recording.error)} elements; 64 are the least."
    if gains.kd < LEAST_KD:
        return f"KD is {gains.kd:g}; {LEAST_KD:g} is the least for an excitation."
    if gains.fv or gains.fa:
        return "FV and FA must be 0 during the excitation."
    return None


@dataclass(frozen=True)
class Errors:
    """The error of every sample, and what belongs to it."""

    values: Vector  # counts
    integrals: Vector  # V, offset included
    torque_at: int  # the first sample whose torque was captured
    unsure: int  # how many the torque limit hides
    wrong: int  # how many do not come out as whole numbers


def between(recording: Recording, integral: float) -> Errors:
    """Torque and error of one sample captured together: each torque tells the error of the sample before it."""
    gains, error, volts = recording.gains, recording.error, recording.volts
    count = len(error)
    errors, integrals = numpy.zeros(2 * count - 1), numpy.zeros(2 * count - 1)
    errors[0], integrals[0] = error[0], integral
    both, last, most = 4.0 * (gains.kp + gains.kd), 4.0 * gains.kd, gains.torque_limit - 2 * TORQUE_STEP
    unsure = wrong = 0
    for n in range(1, count):
        here, torque = float(error[n]), float(volts[n])
        exact = ((both + 0.5 * gains.ki) * here * VOLTS + integral - torque) / (VOLTS * (last - 0.5 * gains.ki))
        if abs(torque) >= most:  # the limit hides it: as it went on before, because a jump may have come just now
            exact = 2.0 * float(errors[2 * n - 2]) - float(errors[max(0, 2 * n - 3)])
            unsure += 1
        elif abs(exact - round(exact)) > WHOLE:
            wrong += 1
        missing = float(round(exact))
        errors[2 * n - 1], errors[2 * n] = missing, here
        integrals[2 * n - 1] = integral + 0.5 * gains.ki * missing * VOLTS
        integral = integrals[2 * n - 1] + 0.5 * gains.ki * here * VOLTS
        integrals[2 * n] = integral
    return Errors(errors, integrals, 0, unsure, wrong)


def between_late(recording: Recording, integral: float) -> Errors:
    """An error captured as the next sample finds it (the controller reads at the end of a sample).

    Each torque tells the error of its own sample; a jump that comes between the two is not in the captured error yet.
    """
    gains, error, volts = recording.gains, recording.error, recording.volts
    count = len(error)
    errors, integrals = numpy.zeros(2 * count - 1), numpy.zeros(2 * count - 1)
    errors[0], integrals[0] = error[0], integral
    part, most = VOLTS * 0.5 * gains.ki, gains.torque_limit - 2 * TORQUE_STEP
    whole = VOLTS * 4.0 * (gains.kp + gains.kd) + part
    hidden = (0, *sorted(set(recording.steps)))
    unsure = wrong = 0
    for n in range(1, count):
        before, behind, torque = float(errors[2 * n - 2]), float(error[n]), float(volts[n])
        tried = [
            (torque - integral - part * size + VOLTS * 4.0 * gains.kd * (before + size)) / whole for size in hidden
        ]
        fits = [(abs(exact - behind), k) for k, exact in enumerate(tried) if abs(exact - round(exact)) <= WHOLE_LATE]
        chosen = min(fits)[1] if fits else 0
        exact = tried[chosen]
        if abs(torque) >= most:
            exact, chosen = 2.0 * before - float(errors[max(0, 2 * n - 3)]), 0
            unsure += 1
        elif not fits:
            wrong += 1
        errors[2 * n - 2] += hidden[chosen]
        integral += part * hidden[chosen]
        integrals[2 * n - 2] = integral
        errors[2 * n - 1], errors[2 * n] = float(round(exact)), behind
        integrals[2 * n - 1] = integral + part * errors[2 * n - 1]
        integral = integrals[2 * n - 1] + part * behind
        integrals[2 * n] = integral
    return Errors(errors, integrals, 1, unsure, wrong)


def start(recording: Recording, late: bool) -> float:
    """Integrator and offset at the first sample: what makes the errors between whole numbers near the others."""
    gains, error, volts = recording.gains, recording.error[:QUIET], recording.volts[:QUIET]
    damping, both = VOLTS * 4.0 * gains.kd, VOLTS * (4.0 * (gains.kp + gains.kd) + 0.5 * gains.ki)
    if late:
        one = -both
        first = float(volts[1]) - both * float(error[0]) + damping * float(error[0])
    else:
        one = damping - VOLTS * 0.5 * gains.ki
        first = float(volts[1]) - both * float(error[1]) + one * float(error[0])
    quiet = replace(recording, error=error, volts=volts)
    errors = (between_late(quiet, first) if late else between(quiet, first)).values
    # a whole number too high or too low in all of them is the integrator's part
    apart = errors[1::2] - 0.5 * (errors[:-1:2] + errors[2::2])
    return first - one * float(numpy.round(numpy.mean(apart)))


def every_error(recording: Recording) -> Errors:
    """The errors of every sample, whichever way the controller reads."""
    found = between(recording, start(recording, False))
    if found.wrong <= BAD_PART * len(recording.error):
        return found
    late = between_late(recording, start(recording, True))
    return late if late.wrong < found.wrong else found


def jumps(errors: Vector, sizes: tuple[int, ...]) -> list[int] | None:
    """The samples at which the commanded position jumped: there the error changes, and not before and behind."""
    change = numpy.diff(errors, prepend=errors[0], append=errors[-1])
    spike = numpy.zeros(len(errors))
    spike[1:] = change[1:-1] - 0.5 * (change[:-2] + change[2:])
    left, found = numpy.abs(spike), []
    for _ in sizes:
        place = int(left.argmax())
        found.append(place)
        left[max(0, place - NEAR) : place + NEAR + 1] = 0.0
    found.sort()
    fits = all(abs(spike[place] - size) <= 0.5 * abs(size) for place, size in zip(found, sizes, strict=True))
    return found if fits else None


def commanded(recording: Recording, errors: Vector) -> Vector | str:
    """The commanded position of every sample, from its first place; a sentence where the jumps cannot be found."""
    if recording.position is not None:
        even = recording.position + errors[::2]
        found = numpy.repeat(even, 2)[: len(errors)].astype(float)
        for n in numpy.flatnonzero(numpy.diff(even)):
            # between the elements: the place that leaves the encoder the smoothest way
            middle = 2 * n + 1
            mean = 0.5 * (even[n] - errors[middle - 1] + even[n + 1] - errors[middle + 1])
            options = (even[n], even[n + 1])
            found[middle] = min(options, key=lambda place: abs(place - errors[middle] - mean))
        from_first: Vector = found - found[0]
        return from_first
    places = jumps(errors, recording.steps) if recording.steps else None
    if places is None:
        return f"the {len(recording.steps)} jumps that were sent are not the ones seen in the error."
    result = numpy.zeros(len(errors))
    for place, size in zip(places, recording.steps, strict=True):
        result[place:] += size
    return result


def every_sample(recording: Recording) -> Samples | NotIdentified:
    """Torque and place of every sample; the reason where they cannot be told."""
    wrong_from_start = objection(recording)
    if wrong_from_start:
        return NotIdentified("The excitation cannot be used: " + wrong_from_start)
    found, count = every_error(recording), len(recording.error)
    if found.wrong > max(3, BAD_PART * count):
        return NotIdentified(
            "The captured torque does not follow from the captured error with "
            f"KP {recording.gains.kp:g}, KI {recording.gains.ki:g} and KD {recording.gains.kd:g}: "
            "these were not the gains, or another loop (dual loop, feed-forward) was at work."
        )
    if found.unsure > 0.2 * count:
        return NotIdentified(
            "The torque was at its limit most of the time, as it is when the loop oscillates: "
            "set KP and KD to a quarter and try again."
        )
    errors = found.values
    places = commanded(recording, errors)
    if isinstance(places, str):
        return NotIdentified("The excitation cannot be used: " + places)
    gains, before = recording.gains, numpy.concatenate([errors[:1], errors[:-1]])
    volts = VOLTS * (4.0 * gains.kp * errors + 4.0 * gains.kd * (errors - before)) + found.integrals
    volts = numpy.clip(volts, -gains.torque_limit, gains.torque_limit)
    volts[found.torque_at :: 2] = recording.volts[found.torque_at :]
    sure = numpy.ones(len(volts), dtype=bool)
    sure[1::2] = numpy.abs(recording.volts[1:]) < gains.torque_limit - 2 * TORQUE_STEP
    jumped = tuple(int(i) + 1 for i in numpy.flatnonzero(numpy.diff(places)))
    return Samples(recording.period, volts, places - errors, jumped, sure)
