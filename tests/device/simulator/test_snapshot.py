"""The whole state can be copied: nothing of a copy is shared with what runs on, and it takes no time."""

from __future__ import annotations

import time
from collections import deque
from typing import Any

import pytest

from device.simulator.copying import clone
from device.simulator.twoletter.state import FieldTest, Frame, Recording, Wait
from tests.device.simulator.bench import Bench
from tests.long import is_long, record
from tests.slower import slower

CHANGEABLE = (list, dict, set, bytearray, deque)
BUSY = """
DM A[8000];N=5;LZ1
XQ#B,1
JS#S
EN
#S
PR 2000;BGX
AMX
EN
#B
N=N+1
JP#B
#LIMSWI;RE
"""


def parts(value: Any, path: str = "state") -> dict[int, str]:
    """Everything in a value that can be changed in place, by identity."""
    found = {}
    if isinstance(value, CHANGEABLE) or hasattr(type(value), "__slots__"):
        found[id(value)] = path
    if isinstance(value, dict):
        for name, item in value.items():
            found |= parts(item, f"{path}[{name}]")
    elif isinstance(value, (list, tuple, deque)):
        for number, item in enumerate(value):
            found |= parts(item, f"{path}[{number}]")
    else:
        for name in getattr(type(value), "__slots__", ()):
            found |= parts(getattr(value, name), f"{path}.{name}")
    return found


def busy() -> Bench:
    """A controller in the middle of everything."""
    bench = Bench("ssc4", baud=19200)
    bench.load(BUSY)
    bench.type("XQ\r", 60)
    state = bench.simulation.unit.state
    state.recording = Recording(arrays=["A"], sources=[("_TP", 0)])
    state.field_test = FieldTest("BZ", 1.0, 0, seen=[(1, 2)])
    state.threads[2].stack.append(Frame(3, "JS", Wait("WT", wake=1 << 60)))
    bench.simulation.receive(1, b"MG N\rTP")
    bench.simulation.receive(2, b"x")
    return bench


def test_a_copy_shares_nothing_that_can_change() -> None:
    bench = busy()
    for original in (bench.simulation.unit.state, bench.simulation.uarts[0], bench.simulation.uarts[1]):
        copied = clone(original)
        assert copied == original
        ours, theirs = parts(original), parts(copied)
        assert len(ours) > 4
        assert [path for place, path in theirs.items() if place in ours] == []
        assert sorted(ours.values()) == sorted(theirs.values())


def test_limits_of_a_copied_queue_stay() -> None:
    assert clone(deque([(1, 2)], maxlen=5)).maxlen == 5


@pytest.mark.alone
def test_the_whole_state_is_copied_in_a_fifth_of_a_millisecond() -> None:
    simulation = busy().simulation
    best = 1.0
    for _ in range(100):
        begin = time.perf_counter()
        moment = simulation.snapshot()
        best = min(best, time.perf_counter() - begin)
        simulation.restore(moment)
    record("snapshot of a whole controller", "tests/device/simulator/test_snapshot.py", 0, best * 1e6, "us")
    assert best <= 0.2e-3 * (1.0 if is_long() else slower())
