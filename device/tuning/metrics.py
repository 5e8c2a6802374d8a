"""What a step response says about the gains."""

from __future__ import annotations

from dataclasses import dataclass

import numpy

from device.tuning.plant import Vector

BAND = 0.02  # of the step, on both sides of its end
LAST = 0.1  # of the response over which the steady error is averaged
AT_LIMIT = 0.001  # V
SHARP = 5  # values from which on a rise is known to a few percent


@dataclass(frozen=True)
class Response:
    """Commanded and actual position and motor command, evenly sampled."""

    period: float  # s between two elements
    commanded: Vector  # counts
    actual: Vector  # counts
    volts: Vector


@dataclass(frozen=True)
class Metrics:
    """Times in s from the step, positions in counts."""

    step: float  # where the commanded position ends less where it began
    rise_time: float | None  # from 10 % to 90 % of the step; None: never that far
    overshoot: float  # part of the step by which the actual position passes its end
    settling_time: float | None  # until it stays within 2 % of the step (1 count at least); None: not in the last tenth
    steady_error: float  # commanded less actual, mean of the last tenth
    peak_error: float  # the largest |commanded - actual|
    saturated: float  # part of the time in which the motor command is at its limit
    every: float = 0.0  # s between two recorded values
    rest_time: float | None = None  # until it stays as near to where it comes to rest, which may be beside the end

    @property
    def coarse(self) -> bool:
        """Whether the rise is so short that it lies between a few recorded values."""
        return self.rise_time is not None and self.rise_time < SHARP * self.every


def passage(position: Vector, level: float) -> float | None:
    """Where the position first comes to a level, in elements with a fraction."""
    above = numpy.flatnonzero(position >= level)
    if not len(above):
        return None
    place = int(above[0])
    if place == 0:
        return 0.0
    before, after = float(position[place - 1]), float(position[place])
    return place - 1 + (level - before) / (after - before)


def last(response: Response) -> slice:
    """The elements over which the steady error is averaged."""
    begin = int(numpy.flatnonzero(numpy.diff(response.commanded))[0])
    return slice(-max(1, int(LAST * (len(response.commanded) - begin))), None)


def stays(away: Vector, band: float, period: float) -> float | None:
    """When the distance from a place has become smaller than a band for good, s; None: not by the last tenth."""
    outside = numpy.flatnonzero(numpy.abs(away) > band)
    place = int(outside[-1]) + 1 if len(outside) else 0
    return None if place > len(away) - max(1, int(LAST * len(away))) else place * period


def measure(response: Response, torque_limit: float) -> Metrics | str:
    """The numbers of a step response; a sentence where there is no step in it."""
    commanded, actual = response.commanded, response.actual
    step = float(commanded[-1] - commanded[0]) if len(commanded) else 0.0
    if step == 0.0:
        return "There is no step in this response: the commanded position ends where it began."
    begin = int(numpy.flatnonzero(numpy.diff(commanded))[0])  # the last element before it moves
    gone = (actual[begin:] - actual[begin]) / step  # 0 at the start, 1 at the end
    low, high = passage(gone, 0.1), passage(gone, 0.9)
    error = commanded[begin:] - actual[begin:]
    band, steady = max(1.0, BAND * abs(step)), float((commanded - actual)[last(response)].mean())
    away = commanded[-1] - actual[begin:]
    return Metrics(
        step=step,
        rise_time=None if low is None or high is None else (high - low) * response.period,
        overshoot=max(
            0.0,
            float(
                (actual[begin:] - commanded[-1]).max() / step
                if step > 0
                else (commanded[-1] - actual[begin:]).max() / -step
            ),
        ),
        settling_time=stays(away, band, response.period),
        steady_error=steady,
        peak_error=float(numpy.abs(error).max()),
        saturated=float((numpy.abs(response.volts[begin:]) >= torque_limit - AT_LIMIT).mean()),
        every=response.period,
        rest_time=stays(away - steady, band, response.period),
    )


def percent(part: float) -> str:
    """`24 %`."""
    return f"{100.0 * part:.0f} %"


def measured_words(metrics: Metrics, swings: bool) -> str:
    """The response in one sentence."""
    if swings:
        return "The axis vibrates with these gains: take less KP or KI, or more KD."
    if metrics.settling_time is None and metrics.rest_time is not None:
        return (
            f"It rests {round(abs(metrics.steady_error), 1):g} counts beside its end: weight or friction hold it "
            "there. KI takes such an error away."
        )
    if metrics.settling_time is None:
        return "The response did not settle within the record."
    torque = percent(metrics.saturated)
    saturated = f" The torque was at its limit for {torque} of it." if metrics.saturated > 0.01 else ""
    return (
        f"Settled within {metrics.settling_time * 1000:.0f} ms, overshoot {percent(metrics.overshoot)}, "
        f"{round(metrics.steady_error, 1) + 0.0:g} counts of error left.{saturated}"
    )
