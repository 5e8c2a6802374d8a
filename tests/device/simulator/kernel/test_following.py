"""Gearing, contour records and the electronic cam."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from device.simulator.motion import Event, Motion, Register, Watch
from device.simulator.plant import Place, Plant
from tests.device.simulator.kernel.waiting import run_until


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
