"""Bits over time (pure): their levels, what a stretch of them says, and those of a capture."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from codegen.models import MODELS
from device.bits import Bit, Signal, signals, worth

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from device.capture import Capture, Channel

    Values = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Timing:
    """What a stretch of a level says: how long it was on and how long it is known, s; edges; NaN without a period."""

    on_s: float
    known_s: float
    rises: int
    falls: int
    period_s: float


@dataclass(frozen=True, eq=False)
class Wave:
    """A level over time: from `times[n]` on it is `on[n]`; the last one until `end`. Not `whole`: only to be drawn."""

    times: Values
    on: NDArray[np.bool_]
    end: float
    whole: bool = True

    def at(self, moment: float) -> bool | None:
        """The level at a moment; None where it is not known."""
        if not self.whole or not len(self.times) or not self.times[0] <= moment <= self.end:
            return None
        return bool(self.on[int(np.searchsorted(self.times, moment, side="right")) - 1])

    def corners(self) -> tuple[Values, Values]:
        """The line that draws it, 0 and 1."""
        if not len(self.times):
            return self.times, np.zeros(0)
        return np.append(np.repeat(self.times, 2)[1:], self.end), np.repeat(self.on, 2).astype(np.float64)

    def timing(self, low: float, high: float) -> Timing:
        """Of the stretch from `low` to `high`, as far as it is known."""
        if not self.whole or not len(self.times) or high < self.times[0] or low > self.end:
            return Timing(math.nan, math.nan, 0, 0, math.nan)
        low, high = max(low, float(self.times[0])), min(high, self.end)
        ends = np.append(self.times[1:], self.end)
        lasts = np.clip(ends, low, high) - np.clip(self.times, low, high)
        inside = (self.times > low) & (self.times <= high)
        inside[0] = False  # the first reading is no edge
        rises, falls = self.times[inside & self.on], self.times[inside & ~self.on]
        same = rises if len(rises) > 1 else falls
        period = float(same[-1] - same[0]) / (len(same) - 1) if len(same) > 1 else math.nan
        return Timing(float(lasts[self.on].sum()), high - low, len(rises), len(falls), period)


def waves(times: Values, values: Values, known: Sequence[Signal]) -> tuple[Wave, ...]:
    """The level of every signal; values that were not read are left out."""
    read = np.isfinite(values)
    if not read.all():
        times, values = times[read], values[read]
    if not len(values):
        return tuple(Wave(times, np.zeros(0, dtype=np.bool_), math.nan) for _ in known)
    places = np.append(0, np.flatnonzero(values[1:] != values[:-1]) + 1)
    return tuple(wave(times[places], values[places], float(times[-1]), each.bit) for each in known)


def wave(times: Values, values: Values, end: float, bit: Bit, whole: bool = True) -> Wave:
    """The level of one bit of numbers with the times at which they came."""
    on = bit.on(values.astype(np.int64))
    turns = np.append(True, on[1:] != on[:-1])[: len(on)]
    return Wave(times[turns], on[turns], end, whole)


def levels(values: Values, bit: Bit) -> Values:
    """0 or 1 of each number, NaN where it was not read."""
    read = np.isfinite(values)
    return np.where(read, bit.on(np.where(read, values, 0.0).astype(np.int64)), np.nan)


@lru_cache(maxsize=6)
def captured(capture: Capture) -> dict[Channel, tuple[tuple[Signal, Wave], ...]]:
    """Every bit of every channel that has bits."""
    found = {}
    for channel in capture.channels:
        known = of_capture(capture, channel)
        if known:
            drawn = waves(capture.times, capture.of(channel), known)
            found[channel] = tuple(zip(known, drawn, strict=True))
    return found


def of_capture(capture: Capture, channel: Channel) -> tuple[Signal, ...]:
    """The bits of a captured channel, with the names of its own setup."""
    return signals(channel, capture.setup, MODELS.get(capture.model), live=capture.moments is not None)


def drawn(capture: Capture, channel: Channel, wanted: Collection[int] | None) -> tuple[tuple[Signal, Wave], ...]:
    """Those signals of a captured channel that are drawn (as `worth` chooses)."""
    found = captured(capture).get(channel, ())
    changed = {signal.bit.number for signal, each in found if len(each.times) > 1}
    chosen = worth([signal for signal, _ in found], wanted, changed)
    return tuple(each for each in found if each[0] in chosen)
