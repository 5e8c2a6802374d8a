"""Gearing, contour records, the electronic cam and paths of several axes."""

from __future__ import annotations

import math

import numpy
import pytest
from hypothesis import given
from hypothesis import strategies as st

from device.simulator.kernel import angle
from device.simulator.motion import Event, Motion, Register, Watch
from device.simulator.plant import Place, Plant


def run_until(motion: Motion, kind: Watch, axis: int = 0, value: float = 0, limit: int = 200_000) -> int:
    number = motion.watch(kind, axis, value)
    samples = 0
    while not motion.tripped(number) and samples < limit:
        samples += motion.run(limit - samples)
    assert motion.tripped(number)
    motion.drop(number)
    return samples


# --- gearing ----------------------------------------------------------------------------------------------------------
def geared(ratio: float) -> Motion:
    motion = Motion(1, [Plant(auxiliary=Place.EXTERNAL, viscous_friction=0.002)])
    motion.set(0, Register.KD, 200)
    motion.set_gear_master(0, "auxiliary", 0)
    motion.set(0, Register.GEAR_RATIO, ratio)
    return motion


def test_gearing_to_the_auxiliary_encoder() -> None:
    # dmc-1412-1414.txt l.1793-1797: GR 1.132, then 2
    motion = geared(1.132)
    motion.set_auxiliary_speed(0, 10240)
    motion.run(1024)
    master = motion.auxiliary(0)
    assert motion.reference(0) == math.floor(1.132 * master + 0.5)
    before = motion.reference(0)
    motion.set(0, Register.GEAR_RATIO, 2)
    motion.run(1024)
    assert motion.reference(0) - before == pytest.approx(2 * (motion.auxiliary(0) - master), abs=1)
    assert not motion.moving(0)


def test_a_move_is_superimposed_on_gearing() -> None:
    # l.1777: a geared motor may be advanced by PR
    plain, moved = geared(1.0), geared(1.0)
    for motion in (plain, moved):
        motion.set_auxiliary_speed(0, -5120)
        motion.run(100)
    moved.begin_position(0, moved.reference(0) + 3000)
    moved.run(2000)
    plain.run(2000)
    assert moved.reference(0) - plain.reference(0) == 3000
    assert moved.stop_code(0) == 1


def test_a_limit_and_a_stop_end_gearing() -> None:
    motion = geared(1.0)
    motion.set_auxiliary_speed(0, 10240)
    motion.run(100)
    motion.set_limit(0, True, False)
    motion.run(2)
    assert motion.take_events() == [(Event.FORWARD_LIMIT, 0)]
    assert motion.get(0, Register.GEAR_RATIO) == 0
    motion = geared(1.0)
    motion.stop(0)
    assert motion.get(0, Register.GEAR_RATIO) == 0


def test_defining_the_masters_position_moves_no_slave() -> None:
    motion = Motion(2)
    for kind in ("main", "commanded"):
        motion.set_gear_master(1, kind, 0)
        motion.set(1, Register.GEAR_RATIO, 1)
        before = motion.reference(1)
        motion.define_position(0, 12345)
        motion.run(3)
        assert motion.reference(1) == before


def test_commanded_master_is_followed_in_the_same_sample() -> None:
    motion = Motion(2)
    motion.set_gear_master(0, "commanded", 1)
    motion.set(0, Register.GEAR_RATIO, -0.5)
    motion.begin_position(1, 8000)
    for _ in range(700):
        motion.run(1)
        assert motion.reference(0) == pytest.approx(-motion.reference(1) / 2, abs=1)
    assert motion.reference(1) == 8000
    assert motion.reference(0) == -4000


# --- contour ----------------------------------------------------------------------------------------------------------
def test_contour_of_the_manual() -> None:
    # l.1940-1965: 12 at 1 ms, 24 at 2, 48 at 4, 138 at 12, 302 at 28; records join without a gap
    motion = Motion(1)
    motion.contour.open([0])
    records = [({0: 48}, 2), ({0: 90}, 3), ({0: 164}, 4), ({}, 0)]
    places = {}
    for sample in range(40):
        if motion.contour.free and records:
            motion.contour.give(*records.pop(0))
        motion.run(1)
        places[sample + 1] = motion.reference(0)
    assert [places[ms] for ms in (1, 2, 4, 12, 28, 40)] == [12, 24, 48, 138, 302, 302]
    assert (motion.moving(0), motion.stop_code(0)) == (False, 51)


def test_contour_waits_for_data_and_am_for_the_end_record() -> None:
    motion = Motion(2)
    motion.contour.open([0, 1])
    motion.contour.give({0: 8, 1: -4}, 2)
    motion.run(50)
    assert (motion.reference(0), motion.reference(1)) == (8, -4)
    assert motion.moving(0)
    assert motion.stop_code(0) == 50
    assert motion.contour.free
    motion.contour.give({}, 0)
    assert run_until(motion, Watch.AFTER_MOVE) == 1


def test_contour_ends_by_stop_and_by_abort() -> None:
    for end in (Motion.stop, Motion.abort):
        motion = Motion(1)
        motion.contour.open([0])
        motion.contour.give({0: 2560}, 8)
        motion.run(100)
        end(motion, 0)
        motion.run(300)
        assert not motion.moving(0)
        assert not motion.contour.active
        assert 1000 <= motion.reference(0) < 1300


@given(st.lists(st.tuples(st.integers(-32767, 32767), st.integers(1, 8)), min_size=1, max_size=12))
def test_contour_ends_exactly_at_the_sum(records: list[tuple[int, int]]) -> None:
    motion = Motion(1)
    motion.contour.open([0])
    for counts, exponent in [*records, (0, 0)]:
        run_until(motion, Watch.CONTOUR_FREE)
        motion.contour.give({0: counts}, exponent)
    run_until(motion, Watch.AFTER_MOVE)
    assert motion.reference(0) == sum(counts for counts, _ in records)
    assert motion.sample == sum(2**exponent for _, exponent in records) + 1


# --- cam --------------------------------------------------------------------------------------------------------------
def manual_cam() -> Motion:
    """l.1811-1879: cycle 6000, slave 0, 3000, 2250, 1500 at 0, 2000, 4000, 6000."""
    motion = Motion(1, [Plant(auxiliary=Place.EXTERNAL, viscous_friction=0.002)])
    motion.set(0, Register.KD, 200)
    motion.cam.master(0, auxiliary=True)
    motion.cam.cycle(6000)
    motion.cam.net(0, 1500)
    motion.cam.interval(2000, 0)
    for index, value in enumerate((0, 3000, 2250, 1500)):
        motion.cam.entry(0, index, value)
    motion.cam.enable(True)
    return motion


def test_cam_of_the_manual() -> None:
    motion = manual_cam()
    motion.cam.engage(0, -1)
    motion.set_auxiliary_speed(0, 1024 * 4)
    seen = {}
    for _ in range(1499):
        motion.run(1)
        seen[motion.auxiliary(0)] = motion.reference(0)
    assert (seen[1000], seen[2000], seen[4000], seen[5000]) == (1500, 3000, 2250, 1875)
    motion.run(2)
    assert motion.auxiliary(0) == 0
    assert motion.reference(0) == 0  # both are redefined where the master wraps
    assert abs(motion.error(0)) < 200
    for _ in range(500):
        motion.run(1)
    assert (motion.auxiliary(0), motion.reference(0)) == (2000, 3000)


def test_cam_backwards_adds_the_net_change() -> None:
    motion = manual_cam()
    motion.cam.engage(0, -1)
    motion.set_auxiliary_speed(0, -1024 * 4)
    motion.run(501)
    assert (motion.auxiliary(0), motion.reference(0)) == (4000, 2250)


def test_cam_engages_and_leaves_at_a_master_position() -> None:
    # l.1920-1926: engaged and left at 1000 of the cycle
    motion = manual_cam()
    motion.define_position(0, 1500)
    motion.cam.engage(0, 1000)
    motion.set_auxiliary_speed(0, 1024 * 4)
    motion.run(240)
    assert (motion.cam.engaged(0), motion.reference(0)) == (False, 1500)
    motion.run(20)
    assert motion.cam.engaged(0)
    motion.cam.disengage(0, 1000)
    while motion.cam.engaged(0):
        motion.run(1)
    assert 1000 <= motion.auxiliary(0) < 1008
    assert motion.reference(0) == pytest.approx(1500, abs=6)
    still = motion.reference(0)
    motion.run(500)
    assert motion.reference(0) == still


def test_switching_the_cam_off_lets_go() -> None:
    motion = manual_cam()
    motion.cam.engage(0, -1)
    motion.cam.enable(False)
    motion.set_auxiliary_speed(0, 4096)
    motion.run(100)
    assert motion.reference(0) == 0


# --- paths ------------------------------------------------------------------------------------------------------------
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
