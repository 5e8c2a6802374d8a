"""Machines against the closed forms of chapter 10 and against energy, momentum and friction."""

from __future__ import annotations

import math

import numpy
import pytest
from hypothesis import given
from hypothesis import strategies as st

from device.simulator.kernel import layout
from device.simulator.mechanics import exponential
from device.simulator.motion import Motion, Register
from device.simulator.plant import Drive, Enable, Place, Plant

PERIOD = 1 / 1024
SCALE = 4000 / (2 * math.pi)  # Kf of a 1000-line encoder, 638 counts/rad (l.4445)


def motion_slot(name: str) -> int:
    """Where the first axis keeps something."""
    return layout.axis_base(0) + int(getattr(layout, name))


def open_loop(plant: Plant, volts: float) -> Motion:
    """The machine under a constant motor command, without feedback."""
    motion = Motion(1, [plant])
    for register in (Register.KP, Register.KD):
        motion.set(0, register, 0)
    motion.set(0, Register.ERROR_LIMIT, 1e15)
    motion.set(0, Register.OFFSET, volts)
    return motion


def test_current_drive_is_a_double_integrator() -> None:
    # l.4390-4398: P/V = Ka Kt / (J s²), 1000 rad/V with Ka 2
    motion = open_loop(Plant(amplifier_gain=2.0), 0.1)
    motion.run(1024)
    assert motion.velocity_now(0) == pytest.approx(1000 * 0.1 * SCALE, rel=1e-9)
    motion.run(1)
    assert motion.position(0) == pytest.approx(1000 * 0.1 * SCALE / 2, abs=1)


def test_voltage_drive_has_both_time_constants() -> None:
    # l.4370-4388: 40 / [s (0.04 s + 1)(0.002 s + 1)] rad/V for Kv 4; exact: the poles of s² L J + s R J + Kt²
    plant = Plant(drive=Drive.VOLTAGE, amplifier_gain=4.0)
    motion = open_loop(plant, 0.5)
    motion.trace(400)
    motion.run(400)
    slow, fast = sorted(numpy.roots([0.004 * 2e-4, 2 * 2e-4, 0.1**2]).real, reverse=True)
    assert -1 / slow == pytest.approx(0.04, rel=0.06)
    assert -1 / fast == pytest.approx(0.002, rel=0.06)
    final = 40 * 0.5 * SCALE
    t = numpy.arange(1, 401) * PERIOD
    expected = final * (1 + (fast * numpy.exp(slow * t) - slow * numpy.exp(fast * t)) / (slow - fast))
    assert motion.trace_rows()[:, 3] == pytest.approx(expected, rel=1e-9, abs=1e-6)


def test_voltage_drive_without_inductance() -> None:
    motion = open_loop(Plant(drive=Drive.VOLTAGE, amplifier_gain=4.0, inductance=0.0), 0.5)
    motion.run(100)
    expected = 40 * 0.5 * SCALE * (1 - math.exp(-100 * PERIOD / 0.04))
    assert motion.velocity_now(0) == pytest.approx(expected, rel=1e-9)


def test_velocity_drive() -> None:
    # l.4407-4411: ω/V = 1 / [Kg (s T1 + 1)], T1 = J / (Ka Kt Kg)
    motion = open_loop(Plant(drive=Drive.VELOCITY, amplifier_gain=2.0, tachometer_gain=0.1), 1.0)
    motion.run(20)
    t1 = 2e-4 / (2 * 0.1 * 0.1)
    assert motion.velocity_now(0) == pytest.approx(10 * SCALE * (1 - math.exp(-20 * PERIOD / t1)), rel=1e-9)


def test_peak_current_limits_the_torque() -> None:
    motion = open_loop(Plant(amplifier_gain=4.0, peak_current=12.0), 9.0)
    motion.run(10)
    assert motion.velocity_now(0) == pytest.approx(12 * 0.1 / 2e-4 * SCALE * 10 * PERIOD)


def test_viscous_friction_ends_in_a_constant_speed() -> None:
    motion = open_loop(Plant(viscous_friction=0.002), 0.1)
    motion.run(200)
    rate = 0.002 / 2e-4
    expected = 0.1 * 0.1 / 0.002 * SCALE * (1 - math.exp(-rate * 200 * PERIOD))
    assert motion.velocity_now(0) == pytest.approx(expected, rel=1e-9)


def test_stiction_holds_until_the_torque_is_higher() -> None:
    # l.963-973: with friction of 0.02 N·m, TL 0.2 V (0.02 N·m) does not move it
    plant = Plant(coulomb_friction=0.021)
    motion = open_loop(plant, 0.2)
    motion.run(2000)
    assert (motion.position(0), motion.velocity_now(0)) == (0, 0.0)
    motion.set(0, Register.OFFSET, 0.25)
    motion.run(100)
    assert motion.velocity_now(0) == pytest.approx((0.025 - 0.021) / 2e-4 * SCALE * 100 * PERIOD)


@given(st.floats(0.001, 0.02), st.floats(100.0, 90000.0))
def test_coulomb_friction_stops_where_the_energy_is_used_up(friction: float, speed: float) -> None:
    motion = open_loop(Plant(coulomb_friction=friction), 0.0)
    motion._state[motion_slot("MOTOR_V")] = speed
    deceleration = friction / 2e-4 * SCALE
    samples = math.ceil(speed / deceleration / PERIOD) + 3
    motion.run(samples)
    assert motion.velocity_now(0) == 0.0
    assert motion._state[motion_slot("MOTOR_X")] == pytest.approx(speed**2 / (2 * deceleration), rel=1e-9)


def test_friction_never_reverses_a_motion_by_itself() -> None:
    motion = open_loop(Plant(coulomb_friction=0.05), 0.0)
    motion._state[motion_slot("MOTOR_V")] = 5000.0
    motion.trace(100)
    motion.run(100)
    assert (motion.trace_rows()[:, 3] >= 0).all()


def test_reversal_with_friction_takes_the_right_branch_within_the_sample() -> None:
    # moving back at -v0 while pushed forward by more than friction: decelerates with a+f, then accelerates with a-f
    plant = Plant(coulomb_friction=0.005)
    motion = open_loop(plant, 0.1)
    a, f = 0.1 * 0.1 / 2e-4 * SCALE, 0.005 / 2e-4 * SCALE
    v0 = 3.4567 * (a + f) * PERIOD
    motion._state[motion_slot("MOTOR_V")] = -v0
    motion.run(20)
    stop = v0 / (a + f)
    assert motion.velocity_now(0) == pytest.approx((a - f) * (20 * PERIOD - stop), rel=1e-9)
    expected = -v0 * stop / 2 + (a - f) * (20 * PERIOD - stop) ** 2 / 2
    assert motion._state[motion_slot("MOTOR_X")] == pytest.approx(expected, rel=1e-9)


def test_gravity_is_held_by_its_own_volts_and_falls_without_power() -> None:
    plant = Plant(gravity=0.8)
    motion = open_loop(plant, 0.8)
    motion.run(1000)
    assert motion.velocity_now(0) == 0.0
    motion.motor_off(0)
    motion.run(100)
    assert motion.velocity_now(0) == pytest.approx(-0.8 * 0.1 / 2e-4 * SCALE * 100 * PERIOD)


def test_dead_time_delays_the_command() -> None:
    motion = open_loop(Plant(delay_samples=5), 1.0)
    motion.trace(20)
    motion.run(20)
    moving = motion.trace_rows()[:, 3] != 0
    assert list(moving[:6]) == [False] * 5 + [True]


def two_masses(**changes: float) -> Plant:
    values = {"load_inertia": 3e-4, "coupling_stiffness": 50.0, "viscous_friction": 0.0} | changes
    return Plant(**values)  # type: ignore[arg-type]


def test_two_masses_move_as_one_on_average() -> None:
    motion = open_loop(two_masses(coupling_damping=0.02), 0.1)
    motion.run(1024)
    total = 0.1 * 0.1 / 5e-4 * SCALE
    assert motion._state[motion_slot("LOAD_V")] == pytest.approx(total, rel=1e-3)
    assert motion._state[motion_slot("LOAD_X")] == pytest.approx(total / 2, rel=2e-3)


def test_two_masses_ring_at_the_coupled_frequency_and_keep_their_energy() -> None:
    plant = two_masses()
    motion = open_loop(plant, 0.0)
    motion._state[motion_slot("LOAD_X")] = 100.0
    twists, energies = [], []
    for _ in range(400):
        motion.run(1)
        x, y = motion._state[motion_slot("MOTOR_X")], motion._state[motion_slot("LOAD_X")]
        v, w = motion._state[motion_slot("MOTOR_V")], motion._state[motion_slot("LOAD_V")]
        twists.append(x - y)
        energies.append(50 * (x - y) ** 2 + 2e-4 * v * v + 3e-4 * w * w)
    frequency = math.sqrt(50 * (1 / 2e-4 + 1 / 3e-4))
    expected = [-100 * math.cos(frequency * (k + 1) * PERIOD) for k in range(400)]
    assert twists == pytest.approx(expected, abs=1e-6)
    assert max(energies) - min(energies) < 1e-9 * max(energies)


def test_backlash_leaves_the_load_alone_until_it_is_used_up() -> None:
    plant = two_masses(backlash=40.0, coupling_damping=0.01)
    motion = open_loop(plant, 0.02)
    motion.trace(200)
    moved = 0
    for _ in range(200):
        motion.run(1)
        x, y = motion._state[motion_slot("MOTOR_X")], motion._state[motion_slot("LOAD_X")]
        assert x - y < 20 + 30
        if x < 20:
            assert abs(y) < 0.5
        moved += y > 1
    assert moved > 50


def test_play_without_load_inertia_is_a_dead_band() -> None:
    motion = Motion(1, [Plant(backlash=12, auxiliary=Place.LOAD, viscous_friction=0.01)])
    motion.set(0, Register.KD, 200)
    motion.begin_position(0, 100)
    motion.run(2000)
    assert (motion.position(0), motion.auxiliary(0)) == (100, 94)
    motion.begin_position(0, 50)
    motion.run(2000)
    assert (motion.position(0), motion.auxiliary(0)) == (50, 56)


def test_play_behind_a_voltage_drive() -> None:
    plant = Plant(drive=Drive.VOLTAGE, amplifier_gain=4.0, backlash=12, auxiliary=Place.LOAD, viscous_friction=0.002)
    motion = Motion(1, [plant])
    motion.set(0, Register.KD, 200)
    motion.set(0, Register.KI, 1)
    motion.begin_position(0, 100)
    motion.run(4000)
    assert abs(motion.position(0) - 100) <= 1
    assert motion.auxiliary(0) <= motion.position(0) + 6
    assert motion.auxiliary(0) >= 93


def test_stiff_coupling_stays_stable() -> None:
    plant = two_masses(coupling_stiffness=5e4, coupling_damping=0.001, backlash=4.0, coulomb_friction=0.01)
    motion = Motion(1, [plant])
    motion.set(0, Register.KD, 100)
    motion.begin_position(0, 20000)
    motion.run(4000)
    assert abs(motion.position(0) - 20000) < 40
    assert abs(motion.velocity_now(0)) < 2000


def test_torque_ripple_follows_the_angle() -> None:
    plain, rippled = open_loop(Plant(), 0.1), open_loop(Plant(torque_ripple=0.2), 0.1)
    for motion in (plain, rippled):
        motion.run(300)
    assert rippled.velocity_now(0) != plain.velocity_now(0)
    assert rippled.velocity_now(0) == pytest.approx(plain.velocity_now(0), rel=0.2)


def test_encoder_noise_has_its_standard_deviation_and_its_seed() -> None:
    found = []
    for seed in (5, 5, 6):
        motion = Motion(1, [Plant(encoder_noise=3.0, coulomb_friction=100.0)], seed=seed)
        motion.trace(4000)
        motion.run(4000)
        found.append(motion.trace_rows()[:, 2].copy())
    assert (found[0] == found[1]).all()
    assert (found[0] != found[2]).any()
    assert found[0].std() == pytest.approx(3.0, rel=0.05)
    assert abs(found[0].mean()) < 0.3


def test_auxiliary_encoders() -> None:
    ratio = Motion(1, [Plant(auxiliary_ratio=0.25)])
    ratio.push(0, 401)
    ratio.run(1)
    assert ratio.auxiliary(0) == 100
    ratio.define_auxiliary(0, 7)
    assert ratio.auxiliary(0) == 7
    outside = Motion(1, [Plant(auxiliary=Place.EXTERNAL)])
    outside.set_auxiliary(0, 500)
    outside.set_auxiliary_speed(0, 1024)
    outside.run(101)
    assert outside.auxiliary(0) == 600
    outside.set(0, Register.ENCODER, 8)
    outside.run(100)
    assert outside.auxiliary(0) == 500


def test_switches_follow_the_load() -> None:
    plant = Plant(home_switch=(900, 1000), forward_limit=2000, reverse_limit=-100)
    motion = Motion(1, [plant])
    levels = {}
    place = 0
    for x in (-101, -100, 0, 899, 900, 1000, 1001, 2000, 2001):
        motion.push(0, x - place)
        place = x
        motion._state[motion_slot("MOTOR_V")] = 0.0
        motion.motor_off(0)
        motion.run(1)
        levels[x] = (motion.home_level(0), motion.forward_level(0), motion.reverse_level(0))
    assert [x for x in levels if not levels[x][0]] == [900, 1000]
    assert [x for x in levels if not levels[x][1]] == [2001]
    assert [x for x in levels if not levels[x][2]] == [-101]
    motion.set_home(0, False)
    assert not motion.home_level(0)


def test_a_dead_channel_toggles_by_one_count_only() -> None:
    """dmc-1412-1414.txt l.606: "if only one encoder channel fails, the position reporting varies by one count only"."""
    for channel in ("a", "b"):
        motion = Motion(1, [Plant(dead_channel=channel)])
        motion.motor_off(0)
        seen = []
        for _ in range(8):
            motion.push(0, 1)
            motion.run(1)
            seen.append(motion.position(0))
        assert set(seen) == {0, 1}
        assert sum(seen) == 4  # the other channel is high in two of four quarters


def test_wires_that_are_wrong() -> None:
    forwards = open_loop(Plant(), 0.1)
    backwards = open_loop(Plant(motor_reversed=True), 0.1)
    unpowered = open_loop(Plant(amplifier_enable=Enable.NONE), 0.1)
    unheard = open_loop(Plant(amplifier_enable=Enable.ALWAYS), 0.1)
    unheard.motor_off(0)
    for motion in (forwards, backwards, unpowered, unheard):
        motion.run(100)
    assert forwards.position(0) > 0
    assert [motion.position(0) for motion in (backwards, unpowered, unheard)] == [
        -forwards.position(0), 0, forwards.position(0)
    ]  # fmt: skip


def test_switches_that_are_wired_wrong() -> None:
    motion = Motion(1, [Plant(forward_limit=2000, reverse_limit=-100, limits_swapped=True, home_stuck=True)])
    motion.push(0, 2001)
    motion.set_home(0, False)
    motion.motor_off(0)
    motion.run(1)
    assert (motion.home_level(0), motion.forward_level(0), motion.reverse_level(0)) == (True, True, False)


def test_analog_feedback() -> None:
    motion = Motion(2, [Plant(coulomb_friction=100.0)] * 2)
    motion.set(1, Register.ANALOG_FEEDBACK, 1)
    motion.set_analog(2, -10.0)
    motion.run(1)
    assert motion.position(1) == -2048


@pytest.mark.parametrize("axis_drive", list(Drive))
def test_every_drive_reaches_its_target(axis_drive: Drive) -> None:
    motion = Motion(1, [Plant(drive=axis_drive, viscous_friction=0.001)])
    motion.set(0, Register.MOTOR_TYPE, 2 if axis_drive is Drive.STEPPER else 1)
    motion.set(0, Register.KD, 150)
    motion.set(0, Register.KI, 0.2)
    motion.begin_position(0, 8000)
    motion.run(6000)
    assert abs(motion.position(0) - 8000) <= 3


def test_matrix_exponential() -> None:
    turn = exponential([[0.0, -2.0], [2.0, 0.0]])
    assert turn[0] == pytest.approx([math.cos(2), -math.sin(2)], abs=1e-14)
    assert turn[1] == pytest.approx([math.sin(2), math.cos(2)], abs=1e-14)
    assert exponential([[-300.0]])[0][0] == pytest.approx(math.exp(-300.0), rel=1e-10)
