"""FE, FI and HM: the four cases of the manual's table (dmc-1412-1414.txt l.2312-2386)."""

from __future__ import annotations

import pytest

from device.simulator.kernel import layout
from device.simulator.motion import Event, Motion, Register
from device.simulator.plant import Drive, Plant


def machine(**changes: object) -> Motion:
    """A well damped axis standing at 0."""
    values: dict[str, object] = {"viscous_friction": 0.004, "index_at": 1300.0}
    motion = Motion(1, [Plant(**(values | changes))])  # type: ignore[arg-type]
    for register, value in (
        (Register.KD, 200),
        (Register.KP, 20),
        (Register.SPEED, 5000),
        (Register.ACCELERATION, 999424),
        (Register.DECELERATION, 999424),
    ):
        motion.set(0, register, value)
    motion.run(1)
    return motion


def directions(motion: Motion, samples: int) -> list[int]:
    """The signs of the commanded speed, one entry a change, while the move runs."""
    seen: list[int] = []
    for _ in range(samples):
        motion.run(1)
        v = motion.commanded_velocity(0)
        if not motion.moving(0):
            break
        sign = (v > 0) - (v < 0)
        if sign and (not seen or seen[-1] != sign):
            seen.append(sign)
    return seen


# l.2341-2346: switch, CN second field, initial _HMX, then the directions of the three stages
@pytest.mark.parametrize(
    ("closed", "polarity", "initial", "stages"),
    [
        (False, -1, 1, [-1, 1, 1]),
        (False, 1, 0, [1, -1, 1]),
        (True, -1, 0, [1, -1, 1]),
        (True, 1, 1, [-1, 1, 1]),
    ],
)
def test_the_four_cases(closed: bool, polarity: int, initial: int, stages: list[int]) -> None:
    # the switch lies where the first stage goes: a normally open one is pulled low there, a closed one opens
    reverse_first = initial == 1
    if closed:
        switch = (-4000.0, 1e9) if reverse_first else (-1e9, 4000.0)
    else:
        switch = (-1e9, -4000.0) if reverse_first else (4000.0, 1e9)
    motion = machine(home_switch=switch)
    level = motion.home_level(0)
    assert level is (not closed)
    home = level != (polarity == 1)
    assert int(home) == initial
    motion.begin_home(0, home)
    seen = directions(motion, 60_000)
    assert seen == [stages[0], stages[1]] + ([stages[2]] if stages[2] != stages[1] else [])
    assert motion.stop_code(0) == 10
    assert motion.take_events() == [(Event.HOMED, 0)]
    assert motion.reference(0) == 0
    motion.run(3000)
    assert abs(motion.position(0)) <= 1
    # position 0 is the index pulse: machine counts of index_at modulo 4N
    zero = -int(motion._read(0, layout.COUNTS_SHIFT))
    assert zero % 4000 == 1300


def test_second_stage_goes_at_256_counts_a_second() -> None:
    motion = machine(home_switch=(-1e9, -4000.0))
    motion.begin_home(0, True)
    slow = set()
    for _ in range(20_000):
        motion.run(1)
        if motion.moving(0) and motion.commanded_velocity(0) > 0:
            slow.add(motion.commanded_velocity(0))
    assert max(slow) == 256


def test_home_on_a_stepper_has_two_stages() -> None:
    motion = machine(home_switch=(-1e9, -4000.0), drive=Drive.STEPPER)
    motion.set(0, Register.MOTOR_TYPE, 2)
    motion.begin_home(0, True)
    assert directions(motion, 60_000) == [-1, 1]
    assert (motion.reference(0), motion.auxiliary(0), motion.stop_code(0)) == (0, 0, 10)


@pytest.mark.parametrize(("home", "switch"), [(True, (-1e9, -3000.0)), (False, (3000.0, 1e9))])
def test_find_edge_stops_past_the_switch_and_keeps_the_position(home: bool, switch: tuple[float, float]) -> None:
    # l.2370-2386; SC 9, the position is not zeroed
    motion = machine(home_switch=switch)
    motion.set(0, Register.SPEED, 8000)
    motion.begin_edge(0, home)
    motion.run(1)
    while motion.moving(0):
        motion.run(1000)
    assert motion.stop_code(0) == 9
    assert 3000 <= abs(motion.reference(0)) < 3000 + 8000**2 / (2 * 999424) + 200
    assert (motion.reference(0) < 0) == home
    assert motion.take_events() == [(Event.HOMED, 0)]


@pytest.mark.parametrize("direction", [1, -1])
def test_find_index_makes_the_pulse_zero(direction: int) -> None:
    motion = machine(home_switch=None, index_at=700.0)
    motion.begin_index(0, 400, direction)
    motion.run(1)
    while motion.moving(0):
        motion.run(1000)
    assert motion.stop_code(0) == 10
    motion.run(2000)
    assert -motion._read(0, layout.COUNTS_SHIFT) == (700 if direction > 0 else 700 - 4000)
    assert 0 <= motion.reference(0) * direction < 40


def test_a_limit_ends_homing() -> None:
    motion = machine(home_switch=(-1e9, -4000.0), reverse_limit=-2000.0)
    motion.begin_home(0, True)
    motion.run(1)
    while motion.moving(0):
        motion.run(1000)
    assert motion.stop_code(0) == 3
    assert motion.take_events() == [(Event.REVERSE_LIMIT, 0)]


def test_stop_ends_homing() -> None:
    motion = machine(home_switch=(-1e9, -4000.0))
    motion.begin_home(0, True)
    motion.run(500)
    motion.stop(0)
    motion.run(500)
    assert (motion.moving(0), motion.stop_code(0)) == (False, 4)
    assert motion.run(20_000) == 20_000
