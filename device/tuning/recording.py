"""What was captured, and every sample of it: the filter's own law tells the error between two captured elements."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy

from device.tuning.excite import LEAST_KD, NotIdentified
from device.tuning.loop import VOLTS, Gains
from device.tuning.plant import Vector

TORQUE_STEP = 10.0 / 32767.0  # V of a captured _TT (commands.md 4)
WHOLE = 0.3  # counts; how far from a whole number an error between two elements may come out
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


def errors_between(recording: Recording, integral: float) -> tuple[Vector, Vector, int, int]:
    """Error and integrator of every sample from the first integrator on; how many were unsure, how many did not fit."""
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
    return errors, integrals, unsure, wrong


def start(recording: Recording) -> float:
    """Integrator and offset at the first element: what makes the errors between whole numbers near the others."""
    gains, error, volts = recording.gains, recording.error[:QUIET], recording.volts[:QUIET]
    both, last = 4.0 * (gains.kp + gains.kd) + 0.5 * gains.ki, VOLTS * (4.0 * gains.kd - 0.5 * gains.ki)
    first = float(volts[1] - VOLTS * both * error[1]) + last * float(error[0])
    errors = errors_between(replace(recording, error=error, volts=volts), first)[0]
    # a whole number too high or too low in all of them is the integrator's part
    apart = errors[1::2] - 0.5 * (errors[:-1:2] + errors[2::2])
    return first - last * float(numpy.round(numpy.mean(apart)))


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
    """The commanded position of every sample, from its first place; a sentence where the jumps can not be found."""
    if recording.position is not None:
        even = recording.position + recording.error
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
    """Torque and place of every sample; the reason where they can not be told."""
    wrong_from_start = objection(recording)
    if wrong_from_start:
        return NotIdentified("The excitation can not be used: " + wrong_from_start)
    errors, integrals, unsure, wrong = errors_between(recording, start(recording))
    count = len(recording.error)
    if wrong > max(3, BAD_PART * count):
        return NotIdentified(
            "The captured torque does not follow from the captured error with "
            f"KP {recording.gains.kp:g}, KI {recording.gains.ki:g} and KD {recording.gains.kd:g}: "
            "these were not the gains, or another loop (dual loop, feed-forward) was at work."
        )
    if unsure > 0.2 * count:
        return NotIdentified(
            "The torque was at its limit most of the time, as it is when the loop oscillates: "
            "set KP and KD to a quarter and try again."
        )
    places = commanded(recording, errors)
    if isinstance(places, str):
        return NotIdentified("The excitation can not be used: " + places)
    gains, before = recording.gains, numpy.concatenate([errors[:1], errors[:-1]])
    volts = VOLTS * (4.0 * gains.kp * errors + 4.0 * gains.kd * (errors - before)) + integrals
    volts = numpy.clip(volts, -gains.torque_limit, gains.torque_limit)
    volts[::2] = recording.volts
    sure = numpy.ones(len(volts), dtype=bool)
    sure[1::2] = numpy.abs(volts[2::2]) < gains.torque_limit - 2 * TORQUE_STEP
    jumped = tuple(int(i) + 1 for i in numpy.flatnonzero(numpy.diff(places)))
    return Samples(recording.period, volts, places - errors, jumped, sure)
