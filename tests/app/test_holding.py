"""Hold-to-run by the window's own buttons, the machine in another process (safety.md, 4): what ends a hold, in time."""

from __future__ import annotations

import time
from pathlib import Path

import pytest

from device.simulator.process import SimulatorProcess
from tests.device.test_latency import NO_PTY
from tests.device.test_lease_real import LEASE_S, Studio, run, stopped
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
    baud = 19200
    with SimulatorProcess("ssc2", baud=baud, pty=True) as machine:
        studio = Studio(machine, baud, "tests.app.holding", [str(tmp_path)])
        try:
            for way in WAYS * 100:
                run(machine, studio, letting_go="release")
                began = time.monotonic()
                studio.tell(way)
                taken = stopped(machine, began, LEASE_S)
                assert studio._out.readline() == f"{way}\n"
                worst[way] = max(worst.get(way, 0.0), taken)
        finally:
            studio.end()
    for way, seconds in worst.items():
        name = f"hold in the window: {WORDS[way]} to standstill, {baud} baud"
        record(name, "pytest tests/app/test_holding.py", None, seconds, "s")
    print({way: round(seconds, 3) for way, seconds in worst.items()})
    assert set(worst) == set(WAYS)
