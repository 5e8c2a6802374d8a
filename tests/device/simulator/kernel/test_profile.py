"""Profiles against the manual's worked numbers and against mathematics."""

from __future__ import annotations

import math

import numpy
import pytest
from hypothesis import given
from hypothesis import strategies as st

from device.simulator.motion import Event, Motion, Register, Watch

SAMPLES = 1024


def one_axis(**registers: float) -> Motion:
    motion = Motion(1)
    motion.set(0, Register.KD, 200)
    for name, value in registers.items():
        motion.set(0, Register[name.upper()], value)
    return motion


def until_done(motion: Motion, limit: int = 10**7) -> int:
    """Samples until the profile is complete."""
    number = motion.watch(Watch.AFTER_MOVE)
    samples = 0
    while not motion.tripped(number) and samples < limit:
        samples += motion.run(limit - samples)
    motion.drop(number)
    return samples


def references(motion: Motion, samples: int) -> list[int]:
    found = []
    for _ in range(samples):
        motion.run(1)
        found.append(motion.reference(0))
    return found


def test_profiled_move_of_the_manual() -> None:
    # dmc-1412-1414.txt l.915-922: PR 10000, SP 20000, AC = DC = 100000, stored as 99328 (multiples of 1024)
    motion = one_axis(speed=20000, acceleration=99328, deceleration=99328)
    motion.begin_position(0, 10000)
    assert until_done(motion) / SAMPLES == pytest.approx(0.5 + 20000 / 99328, abs=2 / SAMPLES)
    assert motion.reference(0) == 10000
    assert motion.stop_code(0) == 1


def test_triangle() -> None:
    # never reaches SP: t = 2 sqrt(d / a)
    motion = one_axis(speed=8_000_000, acceleration=256000, deceleration=256000)
    motion.begin_position(0, -10000)
    assert until_done(motion) / SAMPLES == pytest.approx(2 * math.sqrt(10000 / 256000), abs=2 / SAMPLES)
    assert motion.reference(0) == -10000


def test_at_speed_of_the_manual() -> None:
    # dmc-1412-1414.txt l.2831-2837: JG 50000, AC 10000 (stored 9216): 50000 / 9216 = 5.425 s
    motion = one_axis(jog_speed=50000, acceleration=9216)
    motion.begin_jog(0)
    number = motion.watch(Watch.AT_SPEED)
    samples = motion.run(10000)
    assert motion.tripped(number)
    assert samples == math.ceil(50000 / 9)
    assert samples / SAMPLES == pytest.approx(5.43, abs=0.005)
    assert motion.commanded_velocity(0) == 50000


def test_one_sample_adds_ac_over_1024_and_moves_speed_over_1024() -> None:
    motion = one_axis(jog_speed=8_000_000, acceleration=1024 * 4096)
    motion.begin_jog(0)
    assert references(motion, 4) == [4, 12, 24, 40]  # 4096 counts/s more each sample: 4, 8, 12, 16 counts


def test_separate_deceleration() -> None:
    # t = d/v + v/(2 AC) + v/(2 DC)
    motion = one_axis(speed=40000, acceleration=512000, deceleration=102400)
    motion.begin_position(0, 50000)
    expected = 50000 / 40000 + 40000 / (2 * 512000) + 40000 / (2 * 102400)
    assert until_done(motion) / SAMPLES == pytest.approx(expected, abs=3 / SAMPLES)


def test_new_speed_during_the_move() -> None:
    # dmc-1412-1414.txt l.2842-2855: after 10000 of 12000 counts slow from 20000 to 5000
    motion = one_axis(speed=20000, acceleration=99328)
    motion.begin_position(0, 12000)
    number = motion.watch(Watch.AFTER_DISTANCE, 0, 10000)
    motion.run(10**5)
    assert motion.tripped(number)
    assert 10000 <= motion.reference(0) < 10000 + 20000 / SAMPLES + 1
    motion.set(0, Register.SPEED, 5000)
    motion.run(100)
    assert motion.commanded_velocity(0) == 5000
    until_done(motion)
    assert motion.reference(0) == 12000


def test_jog_reverses_through_zero_at_dc_and_ac() -> None:
    # dmc-1412-1414.txt l.946-956: JG 10000, AC 100000, DC 50000, later JG -40000
    motion = one_axis(jog_speed=10000, acceleration=99328, deceleration=49152)
    motion.begin_jog(0)
    motion.run(SAMPLES)
    motion.set(0, Register.JOG_SPEED, -40000)
    speeds = []
    for _ in range(900):
        motion.run(1)
        speeds.append(motion.commanded_velocity(0))
    down = math.ceil(10000 / 48)
    assert speeds[0] == 10000 - 48
    assert speeds[down - 1] == 0
    assert speeds[down] == -97
    assert speeds[-1] == -40000
    motion.run(1000)
    assert motion.velocity(0) == pytest.approx(-40000, abs=8)


def test_stop_decelerates_with_dc() -> None:
    motion = one_axis(jog_speed=20480, acceleration=1024 * 1000, deceleration=1024 * 100)
    motion.begin_jog(0)
    motion.run(100)
    before = motion.reference(0)
    motion.stop(0)
    assert motion.stop_code(0) == 4
    samples = until_done(motion)
    # 204 steps of 100 counts/s; the way is the sum of the speeds that are left
    assert samples == 205
    assert motion.reference(0) - before == round(sum(20480 - 100 * k for k in range(1, 205)) / 1024)


def test_abort_freezes_in_the_same_sample() -> None:
    motion = one_axis(jog_speed=50000)
    motion.begin_jog(0)
    motion.run(500)
    before = motion.reference(0)
    motion.abort(0)
    assert not motion.moving(0)
    assert motion.stop_code(0) == 7
    assert set(references(motion, 50)) == {before}


def test_abort_input_freezes_and_switches_off_with_oe() -> None:
    motion = one_axis(jog_speed=50000, off_on_error=1)
    motion.begin_jog(0)
    motion.run(500)
    before = motion.reference(0)
    motion.set_abort(False)
    assert motion.run(10) == 1
    assert (Event.ABORT, 0) in motion.take_events()
    assert (motion.reference(0), motion.stop_code(0), motion.motor_on(0)) == (before, 6, False)
    assert motion.run(10) == 10  # held down it is no new event


@pytest.mark.parametrize(("direction", "code"), [(1, 2), (-1, 3)])
def test_software_limit_acts_one_count_beyond(direction: int, code: int) -> None:
    # dmc-1412-1414.txt l.4140-4146: FL 2000; just beyond it the axis decelerates
    register = "forward_limit" if direction > 0 else "reverse_limit"
    motion = one_axis(speed=5000, deceleration=1024 * 1000, **{register: 2000 * direction})
    motion.begin_position(0, 20000 * direction)
    until_done(motion)
    stopped = motion.reference(0) * direction
    assert 2001 <= stopped <= 2001 + 5000 / SAMPLES + 5000**2 / (2 * 1024 * 1000) + 1
    assert motion.stop_code(0) == code
    assert motion.take_events() == [(Event.FORWARD_LIMIT if direction > 0 else Event.REVERSE_LIMIT, 0)]
    assert motion.blocked(0, direction)
    assert not motion.blocked(0, -direction)


def test_limit_switch_stops_in_its_direction_only() -> None:
    motion = one_axis(jog_speed=20000)
    motion.begin_jog(0)
    motion.run(300)
    motion.set_limit(0, False, False)
    assert motion.run(100) == 100  # the reverse switch does not matter going forward
    motion.set_limit(0, True, False)
    assert motion.run(100) == 1
    assert motion.take_events() == [(Event.FORWARD_LIMIT, 0)]
    assert motion.driving_into_limit(0) == 1
    until_done(motion)
    assert motion.stop_code(0) == 2
    motion.run(2)
    assert motion.driving_into_limit(0) == 0


def test_limit_polarity() -> None:
    motion = one_axis()
    motion.set_limit_polarity(True)
    assert motion.blocked(0, 1)
    motion.set_limit(0, True, False)
    motion.run(1)
    assert not motion.blocked(0, 1)


def test_increment_extends_in_the_same_direction_only() -> None:
    motion = one_axis()
    motion.begin_position(0, 10000)
    motion.run(100)
    assert not motion.increment(0, -5)
    assert motion.increment(0, 2500)
    assert motion.target(0) == 12500
    until_done(motion)
    assert motion.reference(0) == 12500
    motion.begin_position(0, 0)
    motion.run(100)
    motion.stop(0)
    assert not motion.increment(0, -100)  # error 16: forced deceleration


def test_increment_steps_a_jog_at_once() -> None:
    motion = one_axis(jog_speed=1024)
    motion.begin_jog(0)
    motion.run(100)
    before = motion.reference(0)
    assert motion.increment(0, -300)
    assert references(motion, 2) == [before - 299, before - 298]


def test_smoothing_keeps_the_end_and_takes_longer() -> None:
    # dmc-1412-1414.txt l.2305-2310: PR 20000 SP 5000 AC DC 100000: 4.05 s without, longer with IT .5
    times = []
    for smoothing in (1, 0.5, 0.00390625):
        motion = one_axis(speed=5000, acceleration=99328, deceleration=99328, smoothing=smoothing)
        motion.begin_position(0, 20000)
        times.append(until_done(motion) / SAMPLES)
        assert motion.reference(0) == 20000
    assert times[0] == pytest.approx(4 + 5000 / 99328, abs=2 / SAMPLES)
    assert times[0] < times[1] < times[2]


def test_smoothing_is_a_first_order_low_pass_of_the_velocity() -> None:
    motion = one_axis(jog_speed=102400, acceleration=1024 * 102400, smoothing=0.25)
    motion.begin_jog(0)
    expected, v, x = [], 0.0, 0.0
    for _ in range(30):
        v += 0.25 * (102400 - v)
        x += v / SAMPLES
        expected.append(math.floor(x + 0.5))
    assert references(motion, 30) == expected


def test_positions_wrap_at_32_bits() -> None:
    motion = one_axis(jog_speed=8_000_000, acceleration=67107840, deceleration=67107840)
    motion.define_position(0, 2**31 - 1000)
    motion.begin_jog(0)
    motion.run(1000)
    motion.stop(0)
    until_done(motion)
    assert motion.reference(0) < 0
    motion.run(3000)
    assert abs(motion.error(0)) < 5
    assert motion.position(0) < 0


def test_speed_does_not_follow_tm_in_counts_a_sample() -> None:
    motion = one_axis(jog_speed=10240, acceleration=1024 * 20480)
    motion.set_sample_time(500)
    motion.begin_jog(0)
    assert references(motion, 3) == [10, 20, 30]


moves = st.tuples(
    st.integers(-3_000_000, 3_000_000),
    st.integers(1000, 4_000_000).map(lambda v: 2 * v),
    st.integers(1, 65535).map(lambda a: 1024 * a),
    st.integers(1, 65535).map(lambda a: 1024 * a),
)


@given(moves)
def test_every_move_ends_exactly_and_within_its_limits(move: tuple[int, int, int, int]) -> None:
    target, speed, acceleration, deceleration = move
    motion = one_axis(speed=speed, acceleration=acceleration, deceleration=deceleration)
    motion.trace(400_000)
    motion.begin_position(0, target)
    samples = until_done(motion, 399_000)
    way = abs(target)
    if not motion.moving(0):
        assert motion.reference(0) == target
    positions = numpy.concatenate(([0.0], motion.trace_rows()[:, 1]))
    steps = numpy.diff(positions) * numpy.sign(target)
    assert (steps >= 0).all()  # never backwards, never beyond
    assert steps.max(initial=0) <= speed / SAMPLES + 1
    peak = min(speed, math.sqrt(2 * way * acceleration * deceleration / (acceleration + deceleration)))
    seconds = way / peak + peak / (2 * acceleration) + peak / (2 * deceleration) if way else 0
    if not motion.moving(0):
        assert samples == pytest.approx(seconds * SAMPLES, rel=0.01, abs=6)


@given(moves, st.lists(st.tuples(st.integers(1, 400), st.integers(0, 100_000)), max_size=5))
def test_speed_changes_and_increments_never_overshoot(
    move: tuple[int, int, int, int], changes: list[tuple[int, int]]
) -> None:
    target, speed, acceleration, deceleration = move
    motion = one_axis(speed=speed, acceleration=acceleration, deceleration=deceleration)
    motion.begin_position(0, target)
    sign = 1 if target > 0 else -1
    for wait, number in changes:
        motion.run(wait)
        if motion.moving(0):
            motion.set(0, Register.SPEED, 2 * number + 2000)
            if motion.increment(0, sign * number):
                target += sign * number
    motion.set(0, Register.SPEED, 8_000_000)
    motion.trace(300_000)
    until_done(motion, 299_000)
    if not motion.moving(0):
        assert motion.reference(0) == target
    positions = motion.trace_rows()[:, 1]
    assert (positions * sign <= abs(target)).all()
    assert (numpy.diff(positions) * sign >= 0).all()
