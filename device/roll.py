"""The live roll: an hour of what was polled, in memory that is set aside once; far views from coarse pieces.

What is derived of positions is worked out as they come and kept like them. A stretch becomes a capture with its own
times, which is saved, opened and drawn like any other.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from device.bits import Signal
from device.capture import Capture, Channel, scale_of
from device.curves import AROUND, FITS, MOST_OF_A_SHAPE, Curve, Derived, Measured, group_of, straight
from device.waves import Wave, levels, wave

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from codegen.setup import Setup
    from device.ring import Ring

    Values = NDArray[np.float64]

MOST = 1 << 18  # values of a channel
LEAST_S = 0.0139  # between two of them, so that an hour fits; a line at 38 400 baud carries no more
PIECE = 64  # values to one coarse piece
FINE = 4096  # values drawn one by one
MOST_CHANGES = 8192  # of a channel of bits; beyond, it is drawn from pieces and not measured
COLUMNS = 1000  # of a far view; more than a picture shows apart
AT_ONCE = 50_000  # positions whose derived values are worked out in one go


class Track:
    """One channel: values with their times, round and round, and least and most of every 64."""

    def __init__(self, most: int = MOST) -> None:
        self.count = 0
        self._most = most - most % PIECE
        self._times, self._values = np.empty(self._most), np.empty(self._most)
        pieces = self._most // PIECE
        self._piece_times, self._least, self._greatest = (np.empty(pieces) for _ in range(3))
        self._sums, self._squares = np.empty(pieces), np.empty(pieces)

    def set_aside(self) -> None:
        """Touches what is not filled yet, so that memory does not grow later; some ms, so not where a window waits."""
        for kept in (self._times, self._values):
            kept[self.count :] = np.nan

    def add(self, times: Values, values: Values) -> None:
        """Newer values, oldest first."""
        if len(times) > self._most:
            times, values = times[-self._most :], values[-self._most :]
        places = np.arange(self.count, self.count + len(times)) % self._most
        self._times[places], self._values[places] = times, values
        first = self.count // PIECE
        self.count += len(times)
        for piece in range(first, self.count // PIECE):
            start = piece * PIECE % self._most
            block = self._values[start : start + PIECE]
            place = start // PIECE
            self._piece_times[place] = self._times[start]
            self._least[place], self._greatest[place] = block.min(), block.max()
            self._sums[place], self._squares[place] = block.sum(), block @ block

    @property
    def first(self) -> int:
        """Number of the oldest value that is still here."""
        return max(0, self.count - self._most + PIECE)

    @property
    def last_time(self) -> float:
        return float(self._times[(self.count - 1) % self._most]) if self.count else float("nan")

    @property
    def lasts_s(self) -> float:
        """From the oldest value to the newest."""
        return self.last_time - float(self._times[self.first % self._most]) if self.count else 0.0

    def numbered(self, low: int, high: int) -> tuple[Values, Values]:
        """Values by their numbers, the last one not included."""
        low, high = max(low, self.first), min(high, self.count)
        if high <= low:
            return self._times[:0], self._values[:0]
        start, end = low % self._most, (high - 1) % self._most + 1
        if start < end:
            return self._times[start:end].copy(), self._values[start:end].copy()
        return tuple(np.concatenate([kept[start:], kept[:end]]) for kept in (self._times, self._values))  # type: ignore[return-value]

    def between(self, start: float, end: float) -> tuple[Values, Values]:
        """Every value of a stretch of time, and one beyond at either side."""
        return self.numbered(self._place(start) - 1, self._place(end) + 1)

    def many(self, start: float, end: float) -> bool:
        """Whether a stretch of time holds so many values that they are measured by pieces."""
        return self._place(end) - self._place(start) > MOST_OF_A_SHAPE

    def measured(self, start: float, end: float) -> tuple[Measured, Values, Values]:
        """Of a stretch of many values what needs no shape, exactly; and the times and values at its two ends."""
        low, high = self._place(start), self._place(end)
        first, last = -(-low // PIECE), high // PIECE
        places = np.arange(first, last) % len(self._piece_times)
        edges = np.concatenate([self.numbered(low, first * PIECE)[1], self.numbered(last * PIECE, high)[1]])
        least = min(self._least[places].min(), edges.min(initial=np.inf))
        most = max(self._greatest[places].max(), edges.max(initial=-np.inf))
        mean = (self._sums[places].sum() + edges.sum()) / (high - low)
        square = (self._squares[places].sum() + edges @ edges) / (high - low)
        found = Measured(least, most, mean, math.sqrt(square), most - least, math.nan, math.nan)
        ends = [self.numbered(low - 1, low + 2), self.numbered(high - 2, high + 1)]
        times, values = (np.concatenate([end[part] for end in ends]) for part in range(2))
        return found, times, values

    def seen(self, start: float, end: float) -> tuple[Values, Values]:
        """What a picture of that stretch shows: all values, or where they are many least and most of each 64."""
        low, high = max(self.first, self._place(start) - 1), min(self.count, self._place(end) + 1)
        if high - low <= FINE:
            return self.between(start, end)
        places = np.arange(-(-low // PIECE), high // PIECE) % len(self._piece_times)
        starts = np.arange(0, len(places), -(-len(places) // COLUMNS))
        times = np.repeat(self._piece_times[places][starts], 2)
        values = np.empty(len(times))
        values[0::2] = np.minimum.reduceat(self._least[places], starts)
        values[1::2] = np.maximum.reduceat(self._greatest[places], starts)
        rest = np.arange(high - high % PIECE, high) % self._most
        return np.concatenate([times, self._times[rest]]), np.concatenate([values, self._values[rest]])

    def _place(self, time: float) -> int:
        """Number of the first value at or after a time."""
        low, high = self.first, self.count
        while low < high:
            middle = (low + high) // 2
            if self._times[middle % self._most] < time:
                low = middle + 1
            else:
                high = middle
        return low

    @property
    def size(self) -> int:
        """Bytes that are set aside."""
        kept = (self._times, self._values, self._piece_times, self._least, self._greatest, self._sums, self._squares)
        return sum(each.nbytes for each in kept)


class Followed:
    """What is derived of a track, in a track of its own: two values behind it, because it looks at both sides."""

    def __init__(self, kind: Derived, source: Track, commanded: Track | None, most: int) -> None:
        self.track = Track(most)
        self._kind, self._source, self._commanded = kind, source, commanded
        self._next = source.first + (0 if commanded is not None else AROUND)  # number of the next value to look at

    def follow(self) -> None:
        """Takes what is new, and at first everything that is there."""
        while self._step():
            pass

    def _step(self) -> bool:
        """The next stretch; whether there may be more."""
        first, around = max(self._next, self._source.first + AROUND), 0 if self._commanded is not None else AROUND
        end = min(self._source.count - around, first + AT_ONCE)
        if end <= first:
            return False
        times, values = self._source.numbered(first - around, end + around)
        if self._commanded is None:
            times, values = times[around : len(times) - around], FITS[self._kind](times, values)
        else:
            ready = times <= self._commanded.last_time
            times, values, end = times[ready], values[ready], first + int(ready.sum())
            near = self._commanded.between(times[0], times[-1]) if len(times) else (times, times)
            values = straight(times, *near) - values
        self._next = end
        known = np.isfinite(values)
        self.track.add(times[known], values[known])
        return len(times) == AT_ONCE


class Changes:
    """The numbers of a track of bits that differ from the one before, in a track of its own: few, also of an hour."""

    def __init__(self, source: Track, most: int) -> None:
        self.track = Track(most)
        self.changed = 0  # the bits that have ever changed
        self._source, self._last, self._next = source, math.nan, source.first
        self._asked: tuple[float, ...] = ()
        self._found: tuple[Values, Values, float, bool] = (np.zeros(0), np.zeros(0), math.nan, True)

    def follow(self) -> None:
        """Takes what is new, and at first everything that is there."""
        times, values = self._source.numbered(self._next, self._source.count)
        self._next = self._source.count
        if not len(values):
            return
        before = np.append(self._last, values[:-1])
        new = values != before
        both = new & np.isfinite(before)
        turned = values[both].astype(np.int64) ^ before[both].astype(np.int64)
        self.changed |= int(np.bitwise_or.reduce(turned)) if len(turned) else 0
        self._last = float(values[-1])
        self.track.add(times[new], values[new])

    def wave(self, signal: Signal, low: float, high: float) -> Wave:
        """The level of one bit over a stretch of time; of very many changes as far as a picture shows them."""
        asked = (low, high, self.track.count, self._source.count)
        if asked != self._asked:  # once for all of its bits
            self._asked, self._found = asked, self._stretch(low, high)
        times, values, end, whole = self._found
        return wave(times, values, end, signal.bit, whole)

    def _stretch(self, low: float, high: float) -> tuple[Values, Values, float, bool]:
        times, values = self.track.between(low, high)
        times = np.maximum(times, low) if math.isfinite(low) else times
        end = max(min(high, self._source.last_time), float(times[-1])) if len(times) else math.nan
        if len(values) <= MOST_CHANGES:
            return times, values, end, True
        words = values.astype(np.int64)
        starts = np.arange(0, len(words), -(-len(words) // COLUMNS))
        both = np.empty(2 * len(starts))  # of each piece what was on all the time, then what was on at any time
        both[0::2], both[1::2] = np.bitwise_and.reduceat(words, starts), np.bitwise_or.reduceat(words, starts)
        return np.repeat(times[starts], 2), both, end, False


@dataclass(frozen=True, slots=True)
class Line:
    """One curve of the roll: how it is called, its values in counts (or V, or bits), and what one shown unit counts.

    `signal`: it is one bit of them, and `changes` knows when it changed.
    """

    label: str
    unit: str
    group: str
    channel: Channel
    derived: Derived | None
    track: Track
    scale: float
    signal: Signal | None = None
    changes: Changes | None = None

    def curve(self, values: Values) -> Curve:
        """Values of its track as a curve in the person's unit."""
        values = levels(values, self.signal.bit) if self.signal is not None else values / self.scale
        return Curve(self.label, self.unit, self.group, self.channel.axis, values, self.channel, self.derived)


class Roll:
    """Tracks of some live values, filled from the ring of the poll with every tick; `before`: tracks that go on."""

    def __init__(self, keys: Sequence[str], most: int = MOST, before: Roll | None = None) -> None:
        self._most = most
        self._seen = -1
        self._ring: Ring | None = None
        self.start = float("nan")  # the time of the first value: 0 in the picture
        former: dict[str, Track] = before.tracks if before is not None else {}
        self.tracks: dict[str, Track] = {key: former[key] if key in former else Track(most) for key in keys}
        self._fresh = [track for key, track in self.tracks.items() if key not in former]
        if before is not None:
            self._seen, self._ring, self.start = before._seen, before._ring, before.start
        self._followed: dict[tuple[Derived, str], Followed] = {}
        self._changes: dict[str, Changes] = {}

    def lines(self, channels: Sequence[Channel], derived: Collection[Derived], setup: Setup | None) -> tuple[Line, ...]:
        """Every channel that is watched, then what is derived of it."""
        found = []
        for channel in channels:
            if channel.live_key in self.tracks:
                scale, unit = scale_of(channel, setup)
                track = self.tracks[channel.live_key]
                found.append(Line(channel.label, unit, group_of(channel), channel, None, track, scale))
        for kind in Derived:
            if kind in derived:
                found += [line for axis in "XYZW" if (line := self._derived(kind, axis, setup)) is not None]
        return tuple(found)

    def _derived(self, kind: Derived, axis: str, setup: Setup | None) -> Line | None:
        """None where what it needs is not watched."""
        position, commanded, error = (Channel(what, axis) for what in ("position", "commanded", "error"))
        here, there, off = (self.tracks.get(each.live_key) for each in (position, commanded, error))
        scale, unit = scale_of(position, setup)
        if kind is Derived.FOLLOWING:
            if here is None or there is None:
                return Line(f"{kind} {axis}", unit, group_of(error), position, kind, off, scale) if off else None
            track = self._follow(kind, axis, here, there)
            return Line(f"{kind} {axis}", unit, group_of(error), position, kind, track, scale)
        source, channel = (here, position) if here is not None else (there, commanded)
        if source is None:
            return None
        unit = f"{unit}{'/s' if kind is Derived.VELOCITY else '/s²'}"
        return Line(f"{kind} {axis}", unit, str(kind), channel, kind, self._follow(kind, axis, source, None), scale)

    def _follow(self, kind: Derived, axis: str, source: Track, commanded: Track | None) -> Track:
        key = (kind, axis)
        if key not in self._followed:
            self._followed[key] = Followed(kind, source, commanded, self._most)
            self._followed[key].follow()
            self._fresh.append(self._followed[key].track)
        return self._followed[key].track

    def changes(self, channel: Channel) -> Changes:
        """When the bits of a channel that is watched have changed."""
        key = channel.live_key
        if key not in self._changes:
            self._changes[key] = Changes(self.tracks[key], self._most)
            self._changes[key].follow()
            self._fresh.append(self._changes[key].track)
        return self._changes[key]

    def capture(self, channels: Sequence[Channel], low: float, high: float) -> Capture:
        """A stretch as a capture with times of its own; NaN where a channel was not read at a moment."""
        kept = [channel for channel in channels if channel.live_key in self.tracks]
        read = [self._within(self.tracks[channel.live_key], low, high) for channel in kept]
        moments = np.unique(np.concatenate([times for times, _ in read])) if read else np.zeros(0)
        values = np.full((len(kept), len(moments)), np.nan)
        for row, (times, what) in enumerate(read):
            values[row, np.searchsorted(moments, times)] = what
        return Capture(tuple(kept), values, 1, 1000.0, trigger_text="live", moments=moments)

    @staticmethod
    def _within(track: Track, low: float, high: float) -> tuple[Values, Values]:
        times, values = track.between(low, high)
        inside = (times >= low) & (times <= high)
        return times[inside], values[inside]

    def take(self, ring: Ring) -> bool:
        """What is new since the last call; whether there was anything."""
        if ring is not self._ring:
            self._ring, self._seen = ring, ring.count
        if self._fresh:
            self._fresh.pop().set_aside()
        self._seen, values, times = ring.since(self._seen)
        found = False
        for key, track in self.tracks.items():
            if key not in ring.columns or not len(values):
                continue
            place = ring.columns.index(key)
            at, what = times[:, place], values[:, place]
            fresh = np.isfinite(at) & np.isfinite(what)
            if not fresh.any():
                continue
            if np.isnan(self.start):
                self.start = float(at[fresh][0])
            turns = np.floor((at - self.start) / LEAST_S)  # at most one value in each
            fresh &= turns > np.fmax.accumulate(np.concatenate([[-np.inf], turns[:-1]]))
            if track.count:
                fresh &= turns > np.floor(track.last_time / LEAST_S)
            track.add(at[fresh] - self.start, what[fresh])
            found |= bool(fresh.any())
        for followed in self._followed.values():
            followed.follow()
        for changes in self._changes.values():
            changes.follow()
        return found

    @property
    def end(self) -> float:
        """The time of the newest value, s from the first."""
        ends = [track.last_time for track in self.tracks.values() if track.count]
        return max(ends, default=0.0)
