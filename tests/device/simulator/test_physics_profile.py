"""Moves and paths against closed forms: times of trapezoids, plain and smoothed, and arcs as circles."""

from __future__ import annotations

import math
import random

import numpy
import pytest

from device.simulator.motion import Motion, Register, Watch
from tests.device.simulator.kernel.waiting import run_until
from tests.long import count

SAMPLES = 1024  # a second at TM 1000


def timed(way: int, speed: int, up: int, down: int, smoothing: float = 1.0) -> int:
    """Samples that a move of the simulated axis takes."""
    motion = Motion(1)
    for register, value in (
        (Register.SPEED, speed),
        (Register.ACCELERATION, up),
        (Register.DECELERATION, down),
        (Register.SMOOTHING, smoothing),
    ):
        motion.set(0, register, value)
    motion.begin_position(0, way)
    samples = run_until(motion, Watch.AFTER_MOVE)
    assert motion.reference(0) == way
    return samples


def trapezoid(way: int, speed: int, up: int, down: int) -> tuple[float, float]:
    """Seconds of the move, and the speed it reaches: way/v + v/2a + v/2d (a triangle where the way is too short)."""
    peak = min(speed, math.sqrt(2 * way * up * down / (up + down)))
    return way / peak + peak / (2 * up) + peak / (2 * down), peak


def moves(seed: int) -> list[tuple[int, int, int, int]]:
    chance = random.Random(seed)
    return [
        (
            chance.randint(500, 60_000),
            2 * chance.randint(1000, 60_000),
            1024 * chance.randint(40, 4000),
            1024 * chance.randint(40, 4000),
        )
        for _ in range(count(60, 2000))
    ]


def test_a_move_takes_the_time_of_its_trapezoid() -> None:
    for way, speed, up, down in moves(1):
        seconds, _ = trapezoid(way, speed, up, down)
        # a ramp that is no whole number of samples long costs at most one more; so does the last part of the way
        assert timed(way, speed, up, down) == pytest.approx(seconds * SAMPLES, abs=3), (way, speed, up, down)


def owed(peak: float, down: int, keeps: float) -> float:
    """Counts that the IT filter lags behind when the ramp down from `peak` has ended.

    The filter keeps the part q of its lag each sample: the lag is Σ q^m times what the profile went m samples before
    the end. On the ramp that is m times the step D/1024² a sample, before it the speed: two geometric series.
    """
    step, ramp = down / SAMPLES**2, round(peak * SAMPLES / down)
    on_ramp = keeps * (1 - (ramp + 1) * keeps**ramp + ramp * keeps ** (ramp + 1)) / (1 - keeps) ** 2
    return step * on_ramp + peak / SAMPLES * keeps ** (ramp + 1) / (1 - keeps)


@pytest.mark.parametrize("smoothing", [0.5, 0.2, 0.05, 0.02])
def test_a_smoothed_move_takes_the_time_of_its_filter_more(smoothing: float) -> None:
    # l.2284-2310 and commands.md 7: v' += n (v - v'); over when less than half a count is owed
    keeps = 1 - smoothing
    for way, speed, up, down in moves(2)[: count(20, 300)]:
        seconds, peak = trapezoid(way, speed, up, down)
        if peak < speed or (way / peak - peak / (2 * up) - peak / (2 * down)) * SAMPLES * smoothing < 12:
            continue  # the closed form above takes the filter as settled at full speed
        tail = math.log(0.5 / owed(peak, down, keeps)) / math.log(keeps)
        found = timed(way, speed, up, down, smoothing)
        assert found == pytest.approx(seconds * SAMPLES + max(tail, 0), abs=4), (way, speed, up, down)


def test_smoothing_example_of_the_manual() -> None:
    # l.2303-2310: PR 20000, AC DC 100000 (rounded to 99328), SP 5000, IT .5
    seconds, peak = trapezoid(20000, 5000, 99328, 99328)
    tail = math.log(0.5 / owed(peak, 99328, 0.5)) / math.log(0.5)
    assert timed(20000, 5000, 99328, 99328, 0.5) == pytest.approx(seconds * SAMPLES + max(0, tail), abs=3)


# ---------------------------------------------------------------- arcs

ARCS = [(2000, 0, 360), (5000, 90, -270), (12_000, 30, 95.5), (700, 200, 700), (30_000, -45, -45), (100, 0, 360)]


def path_of_an_arc(radius: float, start: float, sweep: float, speed: float) -> numpy.ndarray:
    """Commanded places of both axes, sample by sample."""
    motion = Motion(2)
    way = motion.path
    way.set_speed(speed)
    way.set_acceleration(512_000)
    way.set_deceleration(512_000)
    way.vector(0, 1)
    assert way.arc(radius, start, sweep) == 0
    way.end()
    motion.trace(20_000)
    way.begin()
    run_until(motion, Watch.PATH_DONE)
    return motion.trace_rows()[:, (1, 5)].copy()


@pytest.mark.parametrize(("radius", "start", "sweep"), ARCS)
def test_an_arc_is_a_circle_at_constant_speed(radius: float, start: float, sweep: float) -> None:
    speed = 20000.0
    places = path_of_an_arc(radius, start, sweep, speed)
    centre = -radius * numpy.array([math.cos(math.radians(start)), math.sin(math.radians(start))])
    x, y = (places - centre).T
    assert numpy.abs(numpy.hypot(x, y) - radius).max() <= 1.5
    angles = numpy.degrees(numpy.unwrap(numpy.arctan2(y, x)))
    angles -= 360 * round((angles[0] - start) / 360)
    assert angles[-1] - start == pytest.approx(sweep, abs=math.degrees(1.5 / radius))
    length = radius * math.radians(abs(sweep))
    ramp = speed / 512_000 * SAMPLES  # samples; the rest of the arc is run at constant speed
    way = numpy.abs(angles - start) * math.pi / 180 * radius
    first, last = math.ceil(ramp) + 1, len(way) - math.ceil(ramp) - 2
    if last - first > 60:
        window = min(200, last - first)  # places are whole counts: the mean over so many samples is that much finer
        speeds = (way[first + window : last] - way[first : last - window]) / window * SAMPLES
        assert speeds == pytest.approx(speed, rel=0.005 + 2.0 / (window * speed / SAMPLES))
    peak = min(speed, math.sqrt(length * 512_000))
    assert len(way) == pytest.approx((length / peak + peak / 512_000) * SAMPLES, abs=4)


def test_the_constant_speed_is_exact_before_rounding() -> None:
    # COMMANDED_V is the change of the commanded place in a sample, before RP is rounded: half a percent, every sample
    motion = Motion(2)
    motion.path.set_speed(20000)
    motion.path.vector(0, 1)
    motion.path.arc(5000, 0, 360)
    motion.path.point(3000, 4000)
    motion.path.end()
    motion.path.begin()
    motion.run(100)  # 80 samples up to speed
    for _ in range(1500):
        motion.run(1)
        found = math.hypot(motion.commanded_velocity(0), motion.commanded_velocity(1))
        assert found == pytest.approx(20000, rel=0.005)


def test_the_corner_between_line_and_arc_is_taken_without_slowing() -> None:
    motion = Motion(2)
    motion.path.set_speed(20000)
    motion.path.vector(0, 1)
    motion.path.point(4000, 0)
    motion.path.arc(3000, 270, 90)  # goes on in the direction of the line
    motion.path.end()
    motion.trace(3000)
    motion.path.begin()
    run_until(motion, Watch.PATH_DONE)
    places = motion.trace_rows()[:, (1, 5)]
    assert list(places[-1]) == [7000, 3000]
    beyond = places[places[:, 0] > 4000]
    assert numpy.abs(numpy.hypot(beyond[:, 0] - 4000, beyond[:, 1] - 3000) - 3000).max() <= 1.5
    steps = numpy.hypot(*numpy.diff(places, axis=0).T)[100:300] * SAMPLES
    assert steps.mean() == pytest.approx(20000, rel=0.005)
    assert steps.min() > 20000 - 2 * SAMPLES  # rounding of the ends of a step, no more
