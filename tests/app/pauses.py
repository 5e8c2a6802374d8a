"""How long the window of a studio stands still: its thread's time in one tick, or true pauses between heartbeats."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import QElapsedTimer, Qt, QTimer
from PySide6.QtWidgets import QApplication

from tests.long import record
from tests.slower import FULL_SPEED_MS, beside
from tests.stage import TICK_S, Stage

LIMIT_MS = 50.0
RUNS = 3


def too_long(command: str, measure: Callable[[], dict[str, float]], bare: bool = False) -> dict[str, float]:
    """The phases that are. The longest of each, the best of up to three runs: what we cause comes every time.

    A machine that is slow now has more time, unless the limit is `bare`.
    """
    best: dict[str, float] = {}
    found: dict[str, float] = {}
    for _ in range(RUNS):
        before = beside()
        for name, figure in measure().items():
            best[name] = min(figure, best.get(name, math.inf))
        slower = 1.0 if bare else max(1.0, max(before, beside()) / FULL_SPEED_MS)
        found = {name: round(figure, 1) for name, figure in best.items() if figure > LIMIT_MS * slower}
        if not found:
            break
    for name, figure in best.items():
        record(name, command, None, figure, "ms")
    print({name: round(figure, 1) for name, figure in sorted(best.items(), key=lambda each: -each[1])})
    assert best
    return found


class Ticks:
    """A stage in virtual time: of each phase the longest tick, in ms that the window's thread had the processor."""

    def __init__(self, stage: Stage) -> None:
        self.stage = stage
        self.worst: dict[str, float] = {}

    def phase(
        self, name: str, begin: Callable[[], object] = lambda: None, true: Callable[[], object] = lambda: True,
        then: int = 0, seconds: float = 60.0,
    ) -> None:  # fmt: skip
        """From a click (measured too) until it is `true`, and some ticks more."""
        self._timed(name, begin)
        end = self.stage.clock.now + seconds
        while not true():
            assert self.stage.clock.now < end, name
            self._tick(name)
        for _ in range(then):
            self._tick(name)

    def _tick(self, name: str) -> None:
        self.stage.clock.pass_by(TICK_S)
        self._timed(name, self.stage.studio.tick.once)

    def _timed(self, name: str, call: Callable[[], object]) -> None:
        before = time.thread_time()
        call()
        QApplication.processEvents()
        self.worst[name] = max(self.worst.get(name, 0.0), 1000 * (time.thread_time() - before))


def queued_ms() -> float:
    """How long this thread was ready but other programs had the processors, all in all (Linux tells)."""
    told = Path("/proc/thread-self/schedstat")
    return int(told.read_text().split()[1]) / 1e6 if told.exists() else 0.0


class Heart:
    """Beats every 5 ms in the window's thread; keeps the pauses, without the time that other programs took."""

    def __init__(self) -> None:
        self.pauses: list[float] = []
        self._since, self._queued = QElapsedTimer(), 0.0
        self._timer = QTimer(interval=5, timerType=Qt.TimerType.PreciseTimer)
        self._timer.timeout.connect(self._beat)

    def start(self) -> None:
        self.pauses.clear()
        self._since.start()
        self._queued = queued_ms()
        self._timer.start()

    def stop(self) -> list[float]:
        """The longest pauses in ms, longest first."""
        self._beat()
        self._timer.stop()
        return sorted(self.pauses, reverse=True)

    def _beat(self) -> None:
        queued = queued_ms()
        self.pauses.append(self._since.nsecsElapsed() / 1e6 - (queued - self._queued))
        self._since.restart()
        self._queued = queued
