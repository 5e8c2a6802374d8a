"""The newest live values and a stretch of their past: one writer, many readers, no lock held by a reader."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from device.live import LIVE

if TYPE_CHECKING:  # numpy loads with the first value of a controller, not with the first window
    import numpy as np
    from numpy.typing import NDArray

STALE_S = 0.5  # beyond three periods, how much older a value may be before it is shown as stale


@dataclass(frozen=True, slots=True)
class Row:
    """One value per column, each with the time it was read (monotonic seconds); NaN when it is not polled."""

    columns: Mapping[str, int]
    values: Sequence[float] | NDArray[np.float64]
    times: Sequence[float] | NDArray[np.float64]
    period_s: float = 0.0  # between two readings of the quick values
    turn_s: float = 0.0  # until all others have had their turn

    def value(self, key: str) -> float:
        """The value, or NaN when it is not polled or unknown here."""
        place = self.columns.get(key)
        return float("nan") if place is None else float(self.values[place])

    def time(self, key: str) -> float:
        """When it was read, or NaN."""
        place = self.columns.get(key)
        return float("nan") if place is None else float(self.times[place])

    def stale(self, key: str, now: float) -> bool:
        """Whether the value is older than it should be (also when there is none)."""
        age, row = now - self.time(key), LIVE.get(key.partition(".")[0])
        period = self.period_s if row is not None and row.quick else max(self.period_s, self.turn_s)
        return not age <= 3 * period + STALE_S + (row is not None and row.slow)

    def has(self, key: str) -> bool:
        return self.value(key) == self.value(key)


EMPTY = Row({}, (), ())
UNREAD = float("nan")


class Ring:
    """Rows in a circle; `write` is for the link's thread only, everything else for anyone."""

    def __init__(self, columns: Sequence[str], size: int = 20_000) -> None:
        self.columns = tuple(columns)
        self.period_s = self.turn_s = 0.0
        self._places = {name: place for place, name in enumerate(self.columns)}
        self._size = size
        self._count = 0
        self._values: NDArray[np.float64]  # (size, columns), made with the first row
        self._times: NDArray[np.float64]

    @property
    def count(self) -> int:
        """How many rows were ever written."""
        return self._count

    def write(self, values: Mapping[str, float], at: float, keep: Iterable[str] | None = None) -> None:
        """A new row: the last one with these values put in; columns outside `keep` become NaN."""
        import numpy as np

        if not self._count:
            self._values, self._times = self._unread(), self._unread()
        place = self._count % self._size
        row, times = self._values[place], self._times[place]
        if self._count:
            previous = (self._count - 1) % self._size
            row[:] = self._values[previous]
            times[:] = self._times[previous]
        if keep is not None:
            kept = [self._places[name] for name in keep if name in self._places]
            dropped = np.ones(len(self.columns), dtype=bool)
            dropped[kept] = False
            row[dropped] = np.nan
            times[dropped] = np.nan
        for name, value in values.items():
            column = self._places.get(name)
            if column is not None:
                row[column] = value
                times[column] = at
        self._count += 1

    def last(self) -> Row:
        """The newest row (all NaN before the first)."""
        if not self._count:
            unread = (UNREAD,) * len(self.columns)
            return Row(self._places, unread, unread)
        place = (self._count - 1) % self._size
        return Row(self._places, self._values[place].copy(), self._times[place].copy(), self.period_s, self.turn_s)

    def tail(self, count: int) -> NDArray[np.float64]:
        """The newest rows, oldest first."""
        return self._newest(self._values, count) if self._count else self._unread()[:0]

    def tail_times(self, count: int) -> NDArray[np.float64]:
        """When each value of `tail` was read."""
        return self._newest(self._times, count) if self._count else self._unread()[:0]

    def since(self, count: int) -> tuple[int, NDArray[np.float64], NDArray[np.float64]]:
        """Rows written after the first `count` as far as they are still here: the new count, values, times."""
        import numpy as np

        end = self._count
        if not end:
            return 0, self._unread()[:0], self._unread()[:0]
        places = np.arange(max(count, end - self._size + 1, 0), end) % self._size
        return end, self._values[places], self._times[places]

    def _unread(self) -> NDArray[np.float64]:
        import numpy as np

        return np.full((self._size, len(self.columns)), np.nan)

    def _newest(self, source: NDArray[np.float64], count: int) -> NDArray[np.float64]:
        import numpy as np

        end = self._count
        start = max(end - min(count, self._size - 1), 0)
        return source[np.arange(start, end) % self._size]
