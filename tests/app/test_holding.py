"""Hold-to-run by the window's own buttons, the machine in another process (safety.md, 4): what ends a hold, in time."""

from __future__ import annotations

import time
from pathlib import Path

import pytest

from device.simulator.process import SimulatorProcess
from tests.device.test_latency import NO_PTY
from tests.device.test_lease_real import (
    LEASE_S,
    MOST_DISTURBED,
    SEEN_S,
    STALL_S,
    STOPPING_S,
    Heart,
    Studio,
    run,
    stopped,
)
from tests.long import record

pytestmark = [NO_PTY, pytest.mark.long, pytest.mark.alone, pytest.mark.timeout(1800)]  # 10 s at least
WAYS = ("release", "focus", "behind", "close")
WORDS = {
    "release": "release",
    "focus": "focus loss",
    "behind": "another window in front",
    "close": "window closed",
}


def test_whatever_ends_a_hold_in_the_window_stops_the_axis_in_time(tmp_path: Path) -> None:
    worst: dict[str, float] = {}
    disturbed: list[str] = []
    baud, ways = 19200, list(WAYS) * 100
    with SimulatorProcess("ssc2", baud=baud, pty=True) as machine:
        studio = Studio(machine, baud, "tests.app.holding", [str(tmp_path)])
        try:
            while ways:
                run(machine, studio, letting_go="release")
                taken, stall = _ended(machine, studio, ways[0])
                if taken > LEASE_S + STOPPING_S + SEEN_S and stall > STALL_S:
                    disturbed.append(f"{ways[0]}: {taken:.3f} s, stood still for {stall:.3f} s")
                    assert len(disturbed) <= MOST_DISTURBED, disturbed
                    continue
                way = ways.pop(0)
                worst[way] = max(worst.get(way, 0.0), taken)
                assert taken <= LEASE_S + STOPPING_S + SEEN_S, (way, stall)
        finally:
            studio.end()
    for way, seconds in worst.items():
        name = f"hold in the window: {WORDS[way]} to standstill, {baud} baud"
        record(name, "pytest tests/app/test_holding.py", None, seconds, "s")
    print({way: round(seconds, 3) for way, seconds in worst.items()}, disturbed)
    assert set(worst) == set(WAYS)


def _ended(machine: SimulatorProcess, studio: Studio, way: str) -> tuple[float, float]:
    """Seconds until it stood, and how long the computer stood still meanwhile."""
    with Heart() as heart:
        began = time.monotonic()
        studio.tell(way)
        taken = stopped(machine, began)
    assert studio._out.readline() == f"{way}\n"
    return taken, heart.worst
