"""Paths of several axes: lines, arcs, speed along the way, stops."""

from __future__ import annotations

import math

import numpy
import pytest

from device.simulator.kernel import angle
from device.simulator.motion import Event, Motion, Register, Watch
from tests.device.simulator.kernel.waiting import run_until


def test_sine_series() -> None:
    for tenth in range(-9000, 9001, 7):
        assert angle.sine(tenth / 10) == pytest.approx(math.sin(math.radians(tenth / 10)), abs=2e-14)


def test_linear_path_runs_through_corners_at_vector_speed() -> None:
    motion = Motion(3)
    way = motion.path
    way.set_speed(20000)
    way.linear([0, 1])
    assert way.free == 511
    assert [way.line({0: 3000, 1: 4000}), way.line({0: 4000, 1: -3000})] == [0, 0]
    way.end()
    assert (way.length, way.free, way.ready) == (10000, 509, True)
    motion.trace(5000)
    way.begin()
    assert motion.moving(0)
    assert motion.stop_code(1) == 100
    samples = run_until(motion, Watch.PATH_DONE)
    assert samples / 1024 == pytest.approx(0.5 + 20000 / 256000, abs=3 / 1024)
    assert [motion.reference(axis) for axis in range(3)] == [7000, 1000, 0]
    assert [motion.stop_code(axis) for axis in range(2)] == [101, 101]
    rows = motion.trace_rows()
    steps = numpy.hypot(numpy.diff(rows[:, 1]), numpy.diff(rows[:, 5])) * 1024
    middle = steps[120:-120]
    assert numpy.median(middle) == pytest.approx(20000, rel=0.05)
    assert middle.min() > 10000  # no slowing at the corner


def test_full_circle_comes_back_and_stays_on_its_radius() -> None:
    motion = Motion(2)
    way = motion.path
    way.vector(0, 1)
    assert way.arc(2000, 0, 360) == 0
    way.end()
    motion.trace(5000)
    way.begin()
    run_until(motion, Watch.PATH_DONE)
    assert (motion.reference(0), motion.reference(1)) == (0, 0)
    rows = motion.trace_rows()
    assert numpy.hypot(rows[:, 1] + 2000, rows[:, 5]) == pytest.approx(2000, abs=1)
    assert rows[:, 1].min() == pytest.approx(-4000, abs=1)


def test_arc_after_line_and_tangent_axis() -> None:
    motion = Motion(4)
    way = motion.path
    way.set_tangent(10, 500)
    way.vector(0, 1, 2)
    assert way.point(1000, 0) == 0
    assert way.arc(500, 270, 180) == 0
    way.end()
    assert way.tangent_start == 500
    motion.define_position(2, 500)
    way.begin()
    run_until(motion, Watch.PATH_DONE)
    assert [motion.reference(axis) for axis in range(3)] == [1000, 1000, 500 + 1800]
    assert way.last_point(0) == pytest.approx(1000, abs=1e-9)


def test_no_end_stops_at_once() -> None:
    motion = Motion(1)
    way = motion.path
    way.linear([0])
    way.line({0: 5000})
    way.begin()
    run_until(motion, Watch.PATH_DONE)
    assert motion.reference(0) == 5000
    assert motion.velocity_now(0) > 5000  # the machine runs on: there was no deceleration


def test_stop_decelerates_along_the_path() -> None:
    motion = Motion(2)
    way = motion.path
    way.linear([0, 1])
    way.line({0: 30000, 1: 40000})
    way.end()
    way.begin()
    motion.run(500)
    way.stop()
    run_until(motion, Watch.PATH_DONE)
    assert motion.reference(1) == pytest.approx(motion.reference(0) * 4 / 3, abs=1.5)
    assert motion.reference(0) < 20000
    assert motion.stop_code(0) == 4


def test_a_limit_of_one_axis_stops_the_path() -> None:
    motion = Motion(2)
    way = motion.path
    way.linear([0, 1])
    way.line({0: 30000, 1: 40000})
    way.end()
    way.begin()
    motion.run(300)
    motion.set_limit(1, True, False)
    assert motion.run(2000) == 1
    assert motion.take_events() == [(Event.FORWARD_LIMIT, 1)]
    motion.run(2000)
    assert not way.moving
    assert motion.stop_code(0) == 2
    assert motion.reference(1) < 20000


def test_an_abort_of_one_axis_stops_the_path() -> None:
    motion = Motion(2)
    way = motion.path
    way.linear([0, 1])
    way.line({0: 30000, 1: 40000})
    way.end()
    way.begin()
    motion.run(300)
    motion.abort(0)
    motion.run(2000)
    assert not way.moving
    assert not motion.moving(1)


def test_an_abort_of_all_ends_the_path_in_the_same_sample() -> None:
    motion = Motion(2)
    way = motion.path
    way.linear([0, 1])
    way.line({0: 30000, 1: 40000})
    way.end()
    way.begin()
    motion.run(300)
    motion.abort_all()
    motion.run(1)
    assert not way.moving
    assert not way.ready


def test_a_second_sequence_needs_no_new_lm() -> None:
    motion = Motion(2)
    way = motion.path
    way.linear([0, 1])
    for _ in range(3):
        way.line({0: 300, 1: 400})
        way.line({0: -100})
        way.end()
        assert way.length == 600
        way.begin()
        run_until(motion, Watch.PATH_DONE)
        assert not way.ready
        assert way.free == 511
        assert way.travelled == 600
    assert (motion.reference(0), motion.reference(1)) == (600, 1200)
    way.vector(0, 1)
    for _ in range(2):
        assert way.point(50, 60) == 0  # local coordinates begin at 0 again
        way.end()
        way.begin()
        run_until(motion, Watch.PATH_DONE)
    assert (motion.reference(0), motion.reference(1)) == (700, 1320)


def test_speed_of_a_segment_and_ratio() -> None:
    motion = Motion(1)
    way = motion.path
    way.linear([0])
    way.line({0: 5000}, 10240)
    way.line({0: 20000}, 20480)
    way.end()
    way.begin()
    run_until(motion, Watch.PATH_SPEED)
    assert motion.commanded_velocity(0) == 10240
    run_until(motion, Watch.PATH_DISTANCE, 0, 8000)
    assert motion.commanded_velocity(0) == 20480
    assert way.segment == 1
    way.set_ratio(0.5)
    motion.run(100)
    assert motion.commanded_velocity(0) == 10240


def test_errors_of_segments() -> None:
    motion = Motion(2)
    way = motion.path
    way.linear([0, 1])
    assert way.line({}) == 30
    assert way.point(10, 10) == 33
    assert way.line({0: 2147483647}) == 0
    assert way.line({0: 10}) == 31
    way.linear([0])
    assert [way.line({0: 1}) for _ in range(512)] == [0] * 511 + [32]
    assert way.free == 0


def test_many_short_segments_are_refilled_while_moving() -> None:
    motion = Motion(2)
    way = motion.path
    way.set_smoothing(0.02)
    way.linear([0, 1])
    given = 0
    for _ in range(400):
        given += 1
        assert way.line({0: 3, 1: 4}) == 0
    way.begin()
    while given < 4000:
        motion.run(20)
        while way.free > 10 and given < 4000:
            assert way.line({0: 3, 1: 4}) == 0
            given += 1
    way.end()
    run_until(motion, Watch.PATH_DONE)
    assert (motion.reference(0), motion.reference(1)) == (12000, 16000)


def test_ellipse_scale() -> None:
    motion = Motion(2)
    way = motion.path
    way.set_scale(2, 1)
    way.vector(0, 1)
    way.arc(1000, 0, 180)
    way.end()
    way.begin()
    run_until(motion, Watch.PATH_DONE)
    assert (motion.reference(0), motion.reference(1)) == (-4000, 0)


def test_gear_to_the_vector() -> None:
    motion = Motion(3)
    motion.set_gear_master(2, "vector")
    motion.set(2, Register.GEAR_RATIO, 0.5)
    way = motion.path
    for _ in range(2):
        way.linear([0, 1])
        way.line({0: 300, 1: 400})
        way.end()
        way.begin()
        run_until(motion, Watch.PATH_DONE)
    assert motion.reference(2) == 500
