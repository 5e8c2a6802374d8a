"""When each trippoint clears (commands.md 6), and what happens in which order within a sample."""

from __future__ import annotations

import pytest

from device.simulator.motion import Event, Motion, Register, Watch
from device.simulator.plant import Drive, Plant


def jogging(speed: float = 51200, **registers: float) -> Motion:
    motion = Motion(1)
    motion.set(0, Register.KD, 200)
    motion.set(0, Register.KP, 20)
    motion.set(0, Register.JOG_SPEED, speed)
    for name, value in registers.items():
        motion.set(0, Register[name.upper()], value)
    motion.begin_jog(0)
    return motion


def trip(motion: Motion, kind: Watch, value: float = 0.0, limit: int = 100_000) -> int:
    """Samples until the watch trips; `limit` when it does not."""
    number = motion.watch(kind, 0, value)
    samples = 0
    while not motion.tripped(number) and samples < limit:
        samples += motion.run(limit - samples)
    tripped = motion.tripped(number)
    motion.drop(number)
    return samples if tripped else limit


@pytest.mark.parametrize(
    "kind", [Watch.AFTER_MOVE, Watch.AFTER_DISTANCE, Watch.AFTER_RELATIVE, Watch.AFTER_POSITION, Watch.AT_SPEED]
)
def test_an_axis_that_stands_still_clears_at_once(kind: Watch) -> None:
    motion = Motion(1)
    assert trip(motion, kind, 1000) == 0


def test_after_distance_is_exact_to_the_sample() -> None:
    # l.2789-2796: AD 1000 at SP 10000: RP 1000 +- one sample's way
    motion = Motion(1)
    motion.set(0, Register.SPEED, 10000)
    motion.begin_position(0, 20000)
    trip(motion, Watch.AFTER_DISTANCE, 1000)
    assert 1000 <= motion.reference(0) <= 1010


def test_after_relative_counts_from_the_last_place() -> None:
    # l.2803-2815: five trips 10000 apart
    motion = jogging(50000)
    places = []
    for _ in range(5):
        trip(motion, Watch.AFTER_RELATIVE, 10000)
        places.append(motion.reference(0))
        motion.run(51)  # WT 50 between the trips does not shift them
    for k, place in enumerate(places):
        assert 10000 * (k + 1) <= place <= 10000 * (k + 1) + 50


def test_after_distance_marks_the_place_for_after_relative() -> None:
    motion = jogging(20480)
    trip(motion, Watch.AFTER_DISTANCE, 3000)
    trip(motion, Watch.AFTER_RELATIVE, 500)
    assert 3500 <= motion.reference(0) <= 3521


def test_distance_watches_see_the_profile_before_smoothing() -> None:
    plain, smooth = jogging(20480), jogging(20480, smoothing=0.01)
    assert trip(plain, Watch.AFTER_DISTANCE, 2000) == trip(smooth, Watch.AFTER_DISTANCE, 2000)
    assert smooth.reference(0) < plain.reference(0) - 100


@pytest.mark.parametrize("direction", [1, -1])
def test_after_position_crosses_in_either_direction(direction: int) -> None:
    motion = jogging(51200 * direction)
    trip(motion, Watch.AFTER_POSITION, 5000 * direction)
    assert 5000 <= motion.position(0) * direction <= 5060


def test_after_position_clears_at_the_end_of_the_move() -> None:
    motion = Motion(1)
    motion.begin_position(0, 1000)
    trip(motion, Watch.AFTER_POSITION, 5000)
    assert not motion.moving(0)


def test_forward_and_reverse_past() -> None:
    motion = jogging()
    trip(motion, Watch.FORWARD_PAST, 4000)
    assert 4000 <= motion.position(0) <= 4060
    assert trip(motion, Watch.FORWARD_PAST, 3000) == 0  # already past
    assert trip(motion, Watch.REVERSE_PAST, 9000) == 0
    assert trip(motion, Watch.REVERSE_PAST, 0, 5000) == 5000
    by_hand = Motion(1, [Plant(coulomb_friction=100.0)])
    by_hand.motor_off(0)
    number = by_hand.watch(Watch.FORWARD_PAST, 0, 50)
    by_hand.run(5)
    by_hand.push(0, 60)
    assert by_hand.run(5) == 1
    assert by_hand.tripped(number)


def test_at_speed_also_after_slowing_down() -> None:
    motion = jogging(51200)
    trip(motion, Watch.AT_SPEED)
    motion.set(0, Register.JOG_SPEED, 10240)
    motion.run(1)
    trip(motion, Watch.AT_SPEED)
    assert motion.commanded_velocity(0) == 10240


def test_at_speed_of_a_triangle_clears_when_it_stops() -> None:
    motion = Motion(1)
    motion.set(0, Register.SPEED, 8_000_000)
    motion.begin_position(0, 1000)
    trip(motion, Watch.AT_SPEED)
    assert not motion.moving(0)


def test_in_position_waits_for_the_encoder() -> None:
    # a weak loop lags: the profile is done long before the machine is there
    motion = Motion(1, [Plant(viscous_friction=0.01)])
    motion.set(0, Register.KP, 2)
    motion.set(0, Register.KD, 100)
    motion.begin_position(0, 20000)
    done = trip(motion, Watch.AFTER_MOVE)
    assert not motion.in_position(0)
    assert motion.position(0) < 20000
    later = trip(motion, Watch.IN_POSITION, 32766)
    assert later > 0
    assert motion.in_position(0)
    assert motion.position(0) >= 20000
    assert done > 0


def test_in_position_times_out_after_tw() -> None:
    # l.3051-3062: stuck machine, TW 1000
    motion = Motion(1, [Plant(coulomb_friction=100.0)])
    motion.begin_position(0, 1000)
    trip(motion, Watch.AFTER_MOVE)
    assert trip(motion, Watch.IN_POSITION, 1000) == 1000
    assert not motion.in_position(0)
    assert trip(motion, Watch.IN_POSITION, -1, 5000) == 5000  # TW -1: never


def test_in_position_of_a_stepper_waits_for_its_pulses() -> None:
    motion = Motion(1, [Plant(drive=Drive.STEPPER)])
    motion.set(0, Register.MOTOR_TYPE, 2)
    motion.set(0, Register.STEP_SMOOTHING, 8)
    motion.begin_position(0, 5000)
    trip(motion, Watch.AFTER_MOVE)
    assert motion.auxiliary(0) < 5000
    trip(motion, Watch.IN_POSITION, -1)
    assert motion.auxiliary(0) == 5000


def test_time_and_inputs() -> None:
    motion = Motion(1)
    assert trip(motion, Watch.TIME, motion.sample + 123) == 123
    number = motion.watch(Watch.INPUT_LOW, 0, 3)
    assert motion.run(50) == 50
    motion.set_input(3, False)
    assert motion.inputs() == 255 - 4
    assert motion.run(50) == 1
    assert motion.tripped(number)
    motion.drop(number)
    assert trip(motion, Watch.INPUT_HIGH, 3, 100) == 100
    assert trip(motion, Watch.INPUT_HIGH, 4) == 0


def test_run_returns_once_a_trip_and_goes_on() -> None:
    motion = jogging()
    first, second = motion.watch(Watch.TIME, 0, 10), motion.watch(Watch.TIME, 0, 25)
    assert motion.run(100) == 10
    assert (motion.tripped(first), motion.tripped(second), motion.quiet()) == (True, False, False)
    assert motion.run(100) == 15
    assert motion.tripped(second)
    assert motion.run(100) == 100
    assert motion.quiet()


def test_places_of_the_watch_table_are_used_again() -> None:
    motion = Motion(1)
    for _ in range(500):
        motion.drop(motion.watch(Watch.TIME, 0, 10**9))
    numbers = [motion.watch(Watch.TIME, 0, 10**9) for _ in range(64)]
    assert len(set(numbers)) == 64
    with pytest.raises(RuntimeError):
        motion.watch(Watch.TIME, 0, 1)


# --- order within a sample: inputs, profile, servo, plant, trippoints -------------------------------------------------
def test_an_input_acts_on_the_profile_of_the_same_sample() -> None:
    motion = jogging(51200, deceleration=1024 * 1000)
    motion.run(1000)
    motion.set_limit(0, True, False)
    motion.run(1)
    assert motion.commanded_velocity(0) == 50200
    assert motion.take_events() == [(Event.FORWARD_LIMIT, 0)]


def test_the_profile_acts_on_the_servo_of_the_same_sample() -> None:
    motion = Motion(1, [Plant(coulomb_friction=100.0)])
    motion.set(0, Register.KD, 0)
    motion.set(0, Register.ACCELERATION, 1024 * 10240)
    motion.begin_position(0, 1000)
    motion.run(1)
    assert motion.reference(0) == 10
    assert motion.error(0) == 10
    assert motion.torque(0) == pytest.approx(4 * 6 * 10 * 20 / 65536)


def test_the_servo_acts_on_the_plant_of_the_same_sample() -> None:
    motion = Motion(1)
    motion.set(0, Register.OFFSET, 1)
    motion.run(1)
    assert motion.velocity_now(0) > 0
    assert motion.position(0) == 0  # the encoder was read before


def test_trippoints_see_this_sample() -> None:
    motion = jogging(51200, acceleration=1024 * 51200)
    number = motion.watch(Watch.AFTER_DISTANCE, 0, 150)
    assert motion.run(100) == 3
    assert motion.reference(0) == 150
    assert motion.tripped(number)


def test_an_error_switches_off_before_the_plant_moves() -> None:
    motion = Motion(1)
    motion.set(0, Register.ERROR_LIMIT, 100)
    motion.set(0, Register.OFF_ON_ERROR, 1)
    motion.push(0, 101)
    assert motion.run(10) == 1
    assert motion.velocity_now(0) == 0.0
    assert set(motion.take_events()) == {(Event.ERROR, 0), (Event.SWITCHED_OFF, 0)}


@pytest.mark.parametrize("compiled", [True, False])
def test_watches_of_a_group_trip_with_the_last_of_them(compiled: bool) -> None:
    motion = Motion(3, compiled=compiled)
    for axis, way in enumerate((300, 900, 600)):
        motion.begin_position(axis, way)
    ends = []
    for axis in range(3):  # each by itself: one return a trip
        motion.watch(Watch.AFTER_MOVE, axis)
    group = motion.watch_all([(Watch.AFTER_MOVE, axis, 0.0) for axis in range(3)])
    while not all(motion.tripped(number) for number in group):
        motion.run(10_000)
        ends.append(motion.sample)
    assert len(ends) == 3  # the group's last comes with the longest move
    again = Motion(3, compiled=compiled)
    for axis, way in enumerate((300, 900, 600)):
        again.begin_position(axis, way)
    group = again.watch_all([(Watch.AFTER_MOVE, axis, 0.0) for axis in range(3)])
    again.run(10_000)
    assert again.sample == ends[-1]
    for number in group:
        again.drop(number)
    assert again.watch_all([(Watch.AFTER_MOVE, axis, 0.0) for axis in range(3)])
    assert not again.quiet()  # all of them hold at once: the caller sees it without a run
