"""Curves of a capture in user units, and what can be read off them: derived values, measurements, the spectrum."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection
from dataclasses import dataclass, replace
from enum import StrEnum
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from device.capture import Capture, Channel

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Values = NDArray[np.float64]

SETTLED = 0.05  # of a stretch at either end: its level before and after a step
AROUND = 2  # values before and behind, from which live ones get their velocity and acceleration
STEP_SHARE = 0.1  # of the peak to peak value: smaller differences of the ends are no step
MOST_OF_A_SHAPE = 20_000  # values in which steps and periods are looked for; beyond, it would hold a window up
HYSTERESIS = 0.1  # of the peak to peak value, around the mean
PLACES = ("position", "auxiliary", "latch")


class Derived(StrEnum):
    """What is calculated from recorded positions."""

    VELOCITY = "Velocity"
    ACCELERATION = "Acceleration"
    FOLLOWING = "Following error"


@dataclass(frozen=True, eq=False)
class Curve:
    """One line of a picture; curves of one `group` share a scale."""

    label: str
    unit: str
    group: str
    axis: str
    values: Values
    channel: Channel
    derived: Derived | None = None

    @property
    def dashed(self) -> bool:
        """Drawn apart from the actual value beside it."""
        return self.channel.what in ("commanded", "latch", "outputs")


def curves(capture: Capture, derived: Collection[Derived] = ()) -> tuple[Curve, ...]:
    """Every recorded channel, then what is derived of it, all in user units."""
    return _curves(capture, frozenset(derived))


@lru_cache(maxsize=6)
def _curves(capture: Capture, derived: frozenset[Derived]) -> tuple[Curve, ...]:
    """A long one takes a while, and is drawn again with each thing that is chosen."""
    found = [_recorded(capture, channel) for channel in capture.channels]
    for kind in Derived:
        if kind in derived:
            found += [each for axis in "XYZW" if (each := derive(capture, kind, axis)) is not None]
    return tuple(found)


def _recorded(capture: Capture, channel: Channel) -> Curve:
    scale, unit = capture.scale(channel)
    return Curve(channel.label, unit, group_of(channel), channel.axis, capture.of(channel) / scale, channel)


def group_of(channel: Channel) -> str:
    """What shares a scale: places with places, errors apart, volts, and each kind of bits and codes."""
    row = channel.row
    if row.dimension == "position":
        return "Position error" if row.name == "error" else "Position"
    return "Voltage" if row.dimension == "voltage" else row.label


def derive(capture: Capture, kind: Derived, axis: str) -> Curve | None:
    """Of one axis; None where what it needs was not recorded."""
    position, commanded, error = (Channel(what, axis) for what in ("position", "commanded", "error"))
    if kind is Derived.FOLLOWING:
        if position in capture.channels and commanded in capture.channels:
            scale, unit = capture.scale(position)
            values = (_between(capture, commanded) - capture.of(position)) / scale
        elif error in capture.channels:
            scale, unit = capture.scale(error)
            values = capture.of(error) / scale
        else:
            return None
        return Curve(f"{kind} {axis}", unit, "Position error", axis, values, position, kind)
    source = next((each for each in (position, commanded) if each in capture.channels), None)
    if source is None or capture.count < 3:
        return None
    scale, unit = capture.scale(source)
    per = "/s" if kind is Derived.VELOCITY else "/s²"
    if capture.moments is not None:
        values = _fitted(kind, capture.moments, capture.of(source)) / scale
    else:
        calculate = velocity if kind is Derived.VELOCITY else acceleration
        values = calculate(capture.of(source), capture.interval_s) / scale  # of whole counts: 0 is 0
    return Curve(f"{kind} {axis}", f"{unit}{per}", str(kind), axis, values, source, kind)


def velocity(places: Values, interval_s: float) -> Values:
    """By differences from the element before to the one behind, at the ends to the neighbour; units a second."""
    found: Values = np.gradient(places, interval_s)
    return found


def acceleration(places: Values, interval_s: float) -> Values:
    """By second differences; the ends are as their neighbours."""
    found = np.full(len(places), np.nan)
    found[1:-1] = (places[2:] - 2 * places[1:-1] + places[:-2]) / interval_s**2
    found[0], found[-1] = found[1], found[-2]
    return found


# --------------------------------------------- values that came when the line carried them


def slopes(times: Values, places: Values) -> Values:
    """Velocity of each value but the first and last two: of the straight line nearest to the five around it."""
    t, _, v = _windows(times, places)
    found: Values = (t * v).sum(axis=1) / (t * t).sum(axis=1)
    return found


def bends(times: Values, places: Values) -> Values:
    """Acceleration likewise, of the parabola nearest to the five values around."""
    t, square, v = _windows(times, places)
    second = square - (t * square).sum(axis=1, keepdims=True) / (t * t).sum(axis=1, keepdims=True) * t
    second -= second.mean(axis=1, keepdims=True)
    found: Values = 2 * (second * v).sum(axis=1) / (second * second).sum(axis=1)
    return found


FITS: dict[Derived, Callable[[Values, Values], Values]] = {Derived.VELOCITY: slopes, Derived.ACCELERATION: bends}


def _windows(times: Values, places: Values) -> tuple[Values, Values, Values]:
    """Of each stretch of five: times from their mean, those squared, and values from the first."""
    wide = 2 * AROUND + 1
    t = np.lib.stride_tricks.sliding_window_view(times, wide)
    t = t - t.mean(axis=1, keepdims=True)
    v = np.lib.stride_tricks.sliding_window_view(places, wide)
    return t, t * t, v - v[:, :1]


def _fitted(kind: Derived, times: Values, places: Values) -> Values:
    """A value for each that was read and has neighbours, NaN elsewhere."""
    found = np.full(len(times), np.nan)
    known = np.flatnonzero(np.isfinite(places))
    if len(known) > 2 * AROUND:
        found[known[AROUND:-AROUND]] = FITS[kind](times[known], places[known])
    return found


def _between(capture: Capture, channel: Channel) -> Values:
    """The values of a channel; of a live one also where another was read, on the straight line between its own."""
    values = capture.of(channel)
    return values if capture.moments is None else straight(capture.times, capture.times, values)


def straight(wanted: Values, times: Values, values: Values) -> Values:
    """Values at wanted times, on straight lines between known ones; NaN beyond the first and the last."""
    known = np.isfinite(values)
    if not known.any():
        return np.full(len(wanted), np.nan)
    found: Values = np.interp(wanted, times[known], values[known], left=np.nan, right=np.nan)
    return found


def evenly(times: Values, values: Values) -> tuple[Values, float]:
    """As many values as were read, at even times between the first and the last, and the interval (for a spectrum)."""
    known = np.isfinite(values)
    times, values = times[known], values[known]
    if len(times) < 2:
        return values, 1.0
    even = np.linspace(times[0], times[-1], len(times))
    return straight(even, times, values), float(even[1] - even[0])


# ------------------------------------------------------------------ measurements


@dataclass(frozen=True, slots=True)
class Measured:
    """What a stretch of a curve says; NaN where it has none (no step, no oscillation, or too many values)."""

    least: float
    most: float
    mean: float
    rms: float
    peak_to_peak: float
    rise_s: float
    frequency_hz: float


def scaled(found: Measured, scale: float) -> Measured:
    """The same in a unit of so many counts."""
    return replace(
        found,
        least=found.least / scale,
        most=found.most / scale,
        mean=found.mean / scale,
        rms=found.rms / scale,
        peak_to_peak=found.peak_to_peak / scale,
    )


NOTHING = Measured(*(float("nan"),) * 7)


def measure(times: Values, values: Values) -> Measured:
    """Of one stretch; values that were not read are left out."""
    known = np.isfinite(values)
    if not known.any():
        return NOTHING
    if not known.all():
        times, values = times[known], values[known]
    least, most = float(values.min()), float(values.max())
    shaped = len(values) <= MOST_OF_A_SHAPE
    return Measured(
        least,
        most,
        float(values.mean()),
        math.sqrt(float(np.square(values).mean())),  # a scalar product would wake threads for so little
        most - least,
        rise_time(times, values) if shaped else math.nan,
        frequency(times, values) if shaped else math.nan,
    )


def rise_time(times: Values, values: Values) -> float:
    """From 10 to 90 % of a step between the levels at both ends, s; NaN where the ends do not differ."""
    few = max(1, round(len(values) * SETTLED))
    before, after = float(np.median(values[:few])), float(np.median(values[-few:]))
    height = after - before
    if len(values) < 3 or abs(height) <= STEP_SHARE * float(np.ptp(values)):
        return float("nan")
    share = (values - before) / height
    high = int(np.argmax(share >= 0.9))
    below = np.flatnonzero(share[:high] <= 0.1)
    if not len(below):
        return float("nan")
    low = int(below[-1])
    return _crossing(times, share, high - 1, 0.9) - _crossing(times, share, low, 0.1)


def _crossing(times: Values, values: Values, place: int, level: float) -> float:
    """When a straight line from an element to the next passes a level."""
    start, end = float(values[place]), float(values[place + 1])
    part = (level - start) / (end - start) if end != start else 0.0
    return float(times[place] + part * (times[place + 1] - times[place]))


def frequency(times: Values, values: Values) -> float:
    """Of an oscillation around its mean, Hz: whole periods between upward crossings; NaN with less than one."""
    span = float(np.ptp(values))
    if len(values) < 3 or span == 0:
        return float("nan")
    swing = values - float(values.mean())
    far = np.flatnonzero(np.abs(swing) >= HYSTERESIS * span / 2)
    above = swing[far] > 0
    risen = far[1:][above[1:] & ~above[:-1]]
    if len(risen) < 2:
        return float("nan")
    below = np.maximum.accumulate(np.where(swing < 0, np.arange(len(swing)), 0))  # the last one below, for each
    first, last = (_crossing(times, swing, int(below[place]), 0.0) for place in (risen[0], risen[-1]))
    return (len(risen) - 1) / (last - first) if last > first else float("nan")


# ---------------------------------------------------------------------- spectrum


class Window(StrEnum):
    """How a stretch is faded in and out before its spectrum is calculated."""

    HANN = "Hann"
    FLAT_TOP = "Flat top"
    NONE = "None (rectangular)"


WINDOW_WORDS = {
    Window.HANN: "Finds frequencies that lie close together; heights up to 15 % low between two lines.",
    Window.FLAT_TOP: "Heights right to 0.1 %; lines are wider.",
    Window.NONE: "Right only where a whole number of periods was captured.",
}
FLAT_TOP = (0.21557895, -0.41663158, 0.277263158, -0.083578947, 0.006947368)  # five-term flat top window


def spectrum(values: Values, interval_s: float, window: Window = Window.HANN) -> tuple[Values, Values]:
    """Frequencies in Hz and the amplitude of the sine at each, in the curve's unit; the mean is taken out."""
    values = values[np.isfinite(values)]
    count = len(values)
    if count < 4:
        return np.zeros(0), np.zeros(0)
    weights = WEIGHTS[window](count)
    lines = np.abs(np.fft.rfft((values - values.mean()) * weights)) / weights.sum()
    lines[1:] *= 2
    if count % 2 == 0:
        lines[-1] /= 2  # the highest line stands for itself alone
    hertz: Values = np.fft.rfftfreq(count, interval_s).astype(np.float64)
    return hertz, lines.astype(np.float64)


def _cosines(terms: tuple[float, ...]) -> Callable[[int], Values]:
    def weights(count: int) -> Values:
        turn = 2 * np.pi * np.arange(count) / count
        found: Values = sum((term * np.cos(order * turn) for order, term in enumerate(terms)), np.zeros(count))
        return found

    return weights


WEIGHTS: dict[Window, Callable[[int], Values]] = {
    Window.HANN: _cosines((0.5, -0.5)),
    Window.FLAT_TOP: _cosines(FLAT_TOP),
    Window.NONE: np.ones,
}
