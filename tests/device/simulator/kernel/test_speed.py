"""The compiled loop is fast enough for a dry run while typing."""

from __future__ import annotations

import time

import pytest

from device.simulator.motion import Motion
from tests.device.simulator.kernel.speed import moves_and_waits
from tests.long import is_long, record
from tests.slower import slower


@pytest.mark.alone
def test_four_axes_move_and_wait_two_thousand_times_faster_than_real_time() -> None:
    motion = Motion(4, compiled=True)
    moves_and_waits(motion, 50)
    ratio = max(moves_and_waits(motion, 200)[0] for _ in range(5))
    record("motion, four axes, moves and waits", "tests/device/simulator/kernel/test_speed.py", 0, ratio, "x real time")
    assert ratio > 2000 / (1.0 if is_long() else slower())


@pytest.mark.alone
def test_a_snapshot_takes_less_than_a_fifth_of_a_millisecond() -> None:
    motion = Motion(4, compiled=True)
    motion.run(100)
    best = 1.0
    for _ in range(50):
        begin = time.perf_counter()
        moment = motion.snapshot()
        best = min(best, time.perf_counter() - begin)
        motion.restore(moment)
    record("motion snapshot", "tests/device/simulator/kernel/test_speed.py", 0, best * 1e6, "us")
    assert best < 0.2e-3 * (1.0 if is_long() else slower())


def test_plain_python_moves_too() -> None:
    motion = Motion(4, compiled=False)
    ratio, _ = moves_and_waits(motion, 1)
    assert motion.sample >= 1024
    assert ratio > 0.5
