"""The roll keeps an hour of every channel in memory that never grows, and far views lose no peak."""

from __future__ import annotations

import math
import tracemalloc

import numpy as np
import pytest

from device.ring import Ring
from device.roll import FINE, PIECE, Roll, Track
from tests.long import count, record
from tests.rig import Rig

KEYS = ("position.x", "torque.x")


def test_new_values_are_taken_once_with_their_own_times() -> None:
    ring, roll = Ring(("time", *KEYS)), Roll(KEYS)
    assert not roll.take(ring)
    ring.write({"position.x": 5.0}, 100.0)
    ring.write({"position.x": 6.0, "torque.x": 0.5}, 100.1)
    ring.write({"time": 1.0}, 100.15)  # nothing of ours
    assert roll.take(ring) and not roll.take(ring)
    ring.write({"torque.x": 0.7}, 100.2)
    assert roll.take(ring)
    times, values = roll.tracks["position.x"].between(0, 10)
    np.testing.assert_allclose(times, [0.0, 0.1], atol=1e-9)
    assert list(values) == [5.0, 6.0]
    times, values = roll.tracks["torque.x"].between(0, 10)
    np.testing.assert_allclose(times, [0.1, 0.2], atol=1e-9)
    assert roll.end == pytest.approx(0.2)


def test_a_far_view_has_every_peak_and_a_near_one_every_value() -> None:
    track = Track(PIECE * 200)
    t = np.arange(30_000) * 0.02
    y = np.sin(t)
    y[23_456] = 50.0
    for start in range(0, 30_000, 7):
        track.add(t[start : start + 7], y[start : start + 7])
    assert track.first >= 30_000 - PIECE * 200
    times, values = track.seen(t[track.first], t[-1])
    assert values.max() == 50.0 and len(times) <= 2 * 200 + PIECE
    times, values = track.seen(t[23_000], t[23_000 + FINE - 10])
    assert len(times) == pytest.approx(FINE - 8, abs=3)
    np.testing.assert_allclose(values[times < 469], np.sin(times[times < 469]), atol=1e-12)


@pytest.mark.parametrize("hertz", [60, 400][: count(1, 2)])
def test_an_hour_fits_and_memory_does_not_grow(hertz: int) -> None:
    """At 60 values a second, and at 400: then the roll thins them rather than lose the oldest (short: 5 minutes)."""
    ring, roll = Ring(KEYS, size=20_000), Roll(KEYS)
    roll.take(ring)
    tracemalloc.start()
    grown: list[int] = []
    for second in range(count(300, 3600)):
        for part in range(hertz):
            at = second + part / hertz
            ring.write({"position.x": at, "torque.x": math.sin(at)}, 1000 + at)
        roll.take(ring)
        grown.append(tracemalloc.get_traced_memory()[0])
    tracemalloc.stop()
    more = (max(grown[20:]) - grown[20]) / 1e6
    record(f"live roll at {hertz}/s, memory after 20 s", "pytest tests/device/test_roll.py", None, more, "MB")
    assert more < 0.3
    assert roll.tracks["position.x"].between(0, 1)[1][0] == 0.0  # the oldest is still there
    assert sum(track.size for track in roll.tracks.values()) < 5e6 * len(KEYS)


def test_it_fills_from_a_controller_as_fast_as_its_line_carries() -> None:
    rig = Rig(model="ssc2").ready()
    keys = ("position.x", "error.x", "torque.x", "position.y")
    roll = Roll(keys)
    rig.controller.watch("scope", keys)
    rig.controller.poller.first = frozenset(keys)  # as the scope asks while it draws them
    roll.take(rig.controller.poller.ring)
    rates = []
    for hurry in (False, True):
        rig.start("#A\nWT 10\nJP #A\nEN")
        rig.controller.hurry(hurry)
        rig.run(2.0)
        roll.take(rig.controller.poller.ring)
        before = roll.tracks["position.x"].count
        rig.run(3.0)
        roll.take(rig.controller.poller.ring)
        rates.append((roll.tracks["position.x"].count - before) / 3.0)
    assert rates[1] > 1.5 * rates[0]
    assert all(track.count > 10 for track in roll.tracks.values())
