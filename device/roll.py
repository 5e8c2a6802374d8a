"""The live roll: an hour of what was polled, in memory that is set aside once; far views from coarse pieces."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from device.ring import Ring

    Values = NDArray[np.float64]

MOST = 1 << 18  # values of a channel
LEAST_S = 0.0139  # between two of them, so that an hour fits; a line at 38 400 baud carries no more
PIECE = 64  # values to one coarse piece
FINE = 4096  # values drawn one by one
COLUMNS = 1000  # of a far view; more than a picture shows apart


class Track:
    """One channel: values with their times, round and round, and least and most of every 64."""

    def __init__(self, most: int = MOST) -> None:
        self.count = 0
        self._most = most - most % PIECE
        self._times, self._values = np.full(self._most, np.nan), np.full(self._most, np.nan)
        pieces = self._most // PIECE
        self._piece_times, self._least, self._greatest = (np.full(pieces, np.nan) for _ in range(3))

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

    @property
    def first(self) -> int:
        """Number of the oldest value that is still here."""
        return max(0, self.count - self._most + PIECE)

    @property
    def last_time(self) -> float:
        return float(self._times[(self.count - 1) % self._most]) if self.count else float("nan")

    def between(self, start: float, end: float) -> tuple[Values, Values]:
        """Every value of a stretch of time, and one beyond at either side."""
        low, high = self._place(start), self._place(end)
        places = np.arange(max(self.first, low - 1), min(self.count, high + 1)) % self._most
        return self._times[places], self._values[places]

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
        kept = (self._times, self._values, self._piece_times, self._least, self._greatest)
        return sum(each.nbytes for each in kept)


class Roll:
    """Tracks of some live values, filled from the ring of the poll with every tick."""

    def __init__(self, keys: Sequence[str], most: int = MOST) -> None:
        self.tracks = {key: Track(most) for key in keys}
        self._seen = -1
        self._ring: Ring | None = None
        self.start = float("nan")  # the time of the first value: 0 in the picture

    def take(self, ring: Ring) -> bool:
        """What is new since the last call; whether there was anything."""
        if ring is not self._ring:
            self._ring, self._seen = ring, ring.count
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
        return found

    @property
    def end(self) -> float:
        """The time of the newest value, s from the first."""
        ends = [track.last_time for track in self.tracks.values() if track.count]
        return max(ends, default=0.0)
