"""The roll keeps an hour of every channel in memory that never grows, and far views lose no peak."""

from __future__ import annotations

import math
import tracemalloc
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from codegen.disk import FileUnreadable
from codegen.setup import Setup
from device.capture import Channel, cut
from device.capture_file import load, save
from device.curves import Derived, Window, curves, evenly, spectrum
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
    rig.controller.watch("scope", keys, each_round=keys)  # as the scope asks while it draws them
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


def uneven(count: int) -> np.ndarray:
    """Times as a line brings them: some 20 to 60 ms apart."""
    return np.cumsum(np.random.default_rng(3).uniform(0.02, 0.06, count))


def rolled(pieces: int = 7, count: int = 400) -> tuple[Roll, np.ndarray]:
    """X runs with 300 counts/s until 6 s, then speeds up with 500 counts/s²; it is commanded 40 counts further on."""
    ring, roll, times = Ring(FOUR), Roll(FOUR), uneven(count)
    roll.take(ring)
    later = np.clip(times - 6, 0, None)
    for number, (at, place) in enumerate(zip(times, 300 * times + 250 * later**2, strict=True)):
        ring.write({"position.x": place, "commanded.x": place + 40}, at)
        if number % 2:
            ring.write({"torque.x": number}, at + 0.011)
        if number % pieces == 0:
            roll.take(ring)
            roll.lines(CHANNELS, Derived, None)
    roll.take(ring)
    return roll, times - times[0]


FOUR = ("position.x", "commanded.x", "torque.x")
CHANNELS = (Channel("position", "X"), Channel("commanded", "X"), Channel("torque", "X"))


def test_derived_values_come_with_the_positions() -> None:
    """A straight line and a parabola are what they are, however unevenly they were read."""
    roll, times = rolled()
    lines = {line.label: line for line in roll.lines(CHANNELS, Derived, None)}
    assert list(lines) == ["Position X", "Commanded position X", "Motor command X", "Velocity X", "Acceleration X",
        "Following error X"]  # fmt: skip
    assert [lines[name].unit for name in ("Velocity X", "Acceleration X")] == ["counts/s", "counts/s²"]
    at, velocity = lines["Velocity X"].track.between(0, 5.5)
    np.testing.assert_allclose(at, times[2 : 2 + len(at)])
    np.testing.assert_allclose(velocity, 300, rtol=1e-9)
    at, acceleration = lines["Acceleration X"].track.between(6.5, 99)
    assert at[-1] == times[-3]  # two values on either side belong to each
    np.testing.assert_allclose(acceleration, 500, rtol=1e-6)
    np.testing.assert_allclose(lines["Following error X"].track.between(0, 99)[1], 40, atol=1e-9)
    whole = rolled(pieces=1000)[0].lines(CHANNELS, Derived, None)
    for one, other in zip(lines.values(), whole, strict=True):  # in pieces or at once
        np.testing.assert_array_equal(one.track.between(0, 99), other.track.between(0, 99))


@pytest.mark.parametrize("name", ["live.csv", "live.npz"])
def test_a_stretch_is_a_capture_that_comes_back_from_its_file(name: str, tmp_path: Path) -> None:
    roll, times = rolled()
    taken = replace(
        roll.capture(CHANNELS, 2.0, 9.0), setup=Setup(model="ssc2"), model="ssc2", when="2026-11-23 08:00:00"
    )
    save(tmp_path / name, taken)
    found = load(tmp_path / name)
    assert found.moments is not None and found.setup == taken.setup and found.when == taken.when
    np.testing.assert_array_equal(found.moments, taken.moments)
    np.testing.assert_array_equal(found.values, taken.values)
    inside = times[(times >= 2) & (times <= 9)]
    np.testing.assert_array_equal(found.moments[np.isfinite(found.of(CHANNELS[0]))], inside)
    assert np.isfinite(found.of(CHANNELS[2])).sum() == np.isnan(found.of(CHANNELS[0])).sum() > 80  # each at its moment
    drawn = {curve.label: curve.values for curve in curves(found, Derived)}
    for line in roll.lines(CHANNELS, Derived, None)[3:]:  # the same curves as they were live
        at, values = line.track.between(2.5, 8.5)
        known = drawn[line.label][np.searchsorted(found.times, at)]
        np.testing.assert_allclose(known[1:-1], values[1:-1], rtol=1e-9)
    part = cut(found, 3.0, 4.0)
    assert part.times[0] >= 3.0 and part.times[-1] <= 4.0 and not part.complete


def test_what_is_damaged_in_its_times_is_said(tmp_path: Path) -> None:
    path = tmp_path / "live.csv"
    save(path, rolled()[0].capture(CHANNELS, 0, 99))
    lines = path.read_text(encoding="utf-8").splitlines()
    for harm, words in (("-1", "times do not follow"), ("", "times are no numbers")):
        cells = lines[5].split(",")
        path.write_text("\n".join([*lines[:5], ",".join([harm, *cells[1:]]), *lines[6:]]), encoding="utf-8")
        with pytest.raises(FileUnreadable, match=words):
            load(path)


def test_other_channels_go_on_with_what_is_there() -> None:
    roll, times = rolled()
    later = Roll(("position.x", "position.y"), before=roll)
    assert later.start == roll.start
    np.testing.assert_allclose(later.tracks["position.x"].between(0, 99)[0], times)
    assert later.tracks["position.y"].count == 0


def test_an_hour_is_measured_as_exactly_as_its_values_are() -> None:
    track, times = Track(), np.arange(50_000) * 0.05
    values = np.random.default_rng(5).normal(3, 2, 50_000)
    track.add(times[:30_001], values[:30_001])
    track.add(times[30_001:], values[30_001:])
    assert track.many(100.01, 2400.01) and not track.many(0, 500)
    found, at, ends = track.measured(100.01, 2400.01)
    inside = values[(times >= 100.01) & (times < 2400.01)]
    expected = (inside.min(), inside.max(), inside.mean(), np.sqrt(np.mean(inside**2)), np.ptp(inside))
    assert (found.least, found.most, found.mean, found.rms, found.peak_to_peak) == pytest.approx(expected)
    np.testing.assert_allclose(at, [100.0, 100.05, 100.1, 2399.95, 2400.0, 2400.05])
    np.testing.assert_array_equal(ends, values[np.round(at / 0.05).astype(int)])


def test_a_live_sine_has_its_line_in_the_spectrum() -> None:
    """2 Hz of 7 counts, read 25 times a second at uneven times: made even it stays that, near to the straight lines."""
    times = uneven(1500)
    even, apart = evenly(times, 7 * np.sin(2 * np.pi * 2.0 * times))
    hertz, heights = spectrum(even, apart, Window.FLAT_TOP)
    top = int(np.argmax(heights))
    assert hertz[top] == pytest.approx(2.0, abs=0.05) and heights[top] == pytest.approx(7, rel=0.06)
