"""Where a trigger lies in a ring of recorded values: turns counted from here, then the exact element from the data."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from device import live
from device.bits import STATUS_MOVING
from device.capture import Channel, Trigger, When, shown_by

if TYPE_CHECKING:
    from numpy.typing import NDArray

BESIDE = 2  # elements before the bracket in which the trigger may lie as well: what was read takes a moment to come


class Turning:
    """Counts how many elements a ring has taken, from its pointer (`_RD`) and the time that has passed."""

    def __init__(self, size: int, interval_s: float, start: float) -> None:
        self._size, self._interval_s, self._at = size, interval_s, start
        self._index, self.changed = -1, start  # the pointer, and since when it stands there
        self.total = 0

    def count_on(self, index: int, now: float) -> int:
        """The pointer was read now; the number of elements taken so far."""
        if index != self._index:
            self._index, self.changed = index, now
        likely = self.total + (now - self._at) / self._interval_s
        turns = max(round((likely - index) / self._size), 0)
        found = turns * self._size + index
        self.total, self._at = max(found, self.total), now
        return self.total

    def order(self, index: int, now: float) -> list[int]:
        """After the end: the places of what is held, oldest first."""
        total = self.count_on(index, now)
        if total < self._size:
            return list(range(total))
        return [*range(index, self._size), *range(index)]


def found_at(
    trigger: Trigger, channels: Sequence[Channel], values: NDArray[np.float64], low: int, high: int
) -> tuple[int, int]:
    """The trigger's element within a bracket and how many it may be early: 0 where the data themselves show it."""
    signal = signal_of(trigger, channels, values)
    if signal is not None:
        start = max(low - BESIDE, 1)
        rises = np.flatnonzero(signal[start : high + 1] & ~signal[start - 1 : high])
        if len(rises):
            return start + int(rises[0]), 0
    return high, high - low


def signal_of(trigger: Trigger, channels: Sequence[Channel], values: NDArray[np.float64]) -> NDArray[np.bool_] | None:
    """A flag per element that becomes true at the trigger; None where no recorded channel shows it."""
    channel = shown_by(trigger, channels)
    if channel is None:
        return None
    row = values[list(channels).index(channel)]
    if channel.what == "commanded" and trigger.when is When.MOTION:
        return np.concatenate([np.zeros(1, dtype=np.bool_), row[1:] != row[:-1]])
    if channel.what == "axis_status" and trigger.when is When.MOTION:
        return _bit(row, STATUS_MOVING.number)
    if trigger.when is When.INPUT:
        on = _bit(row, trigger.number - 1)
        return on if trigger.rising else ~on
    there: NDArray[np.bool_] = np.greater_equal(row, trigger.level)
    return there if trigger.rising else np.less_equal(row, trigger.level)


def _bit(row: NDArray[np.float64], number: int) -> NDArray[np.bool_]:
    """One bit of recorded words."""
    found: NDArray[np.bool_] = (np.nan_to_num(row).astype(np.int64) >> number & 1).astype(np.bool_)
    return found


def watched(trigger: Trigger) -> str:
    """The live value that shows the trigger from here."""
    match trigger.when:
        case When.MOTION:
            return live.key("commanded", trigger.axis)
        case When.INPUT:
            return "inputs"
        case _:
            assert trigger.channel is not None
            return trigger.channel.live_key


def passed(trigger: Trigger, before: float | None, value: float, armed: bool) -> tuple[bool, bool]:
    """Whether the trigger has come with this reading, and whether it may come from now on."""
    if trigger.when is When.MOTION:
        moved = before is not None and value != before
        return armed and moved, armed or (before is not None and not moved)
    if trigger.when is When.INPUT:
        on = bool(int(value) >> (trigger.number - 1) & 1)
        there = on == trigger.rising
    else:
        there = value >= trigger.level if trigger.rising else value <= trigger.level
    return armed and there, armed or not there
