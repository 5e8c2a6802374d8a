"""What a measurement owes to the computer: one that is slow now, and other programs that have its processors."""

from __future__ import annotations

import os
import statistics
import time
from pathlib import Path

FULL_SPEED_MS = 8.7  # what `beside` takes on the machine of the bounds


def beside() -> float:
    """Milliseconds of processor time of a fixed piece of work; the middle of nine."""

    def once() -> float:
        began = time.process_time()
        kept: dict[int, tuple[int, str]] = {}
        for number in range(60_000):
            kept[number % 997] = (number, str(number))
        return 1000 * (time.process_time() - began)

    return statistics.median(once() for _ in range(9))


def slower() -> float:
    """How many times slower than the machine of the bounds this one is now; at least 1."""
    return max(1.0, beside() / FULL_SPEED_MS)


def queued_s(*others: int) -> float:
    """How long the threads of this and other processes were ready while other programs had the processors (Linux)."""
    told = 0.0
    for pid in (os.getpid(), *others):
        for thread in Path(f"/proc/{pid}/task").glob("*/schedstat"):
            try:
                told += int(thread.read_text().split()[1]) / 1e9
            except (OSError, IndexError):  # it has ended meanwhile
                continue
    return told
