"""The servo filter against its formula, and the closed loop against the poles of the sampled system."""

from __future__ import annotations

import cmath
import math

import numpy
import pytest

from device.simulator.motion import Event, Motion, Register
from device.simulator.plant import Drive, Plant

VOLT = 20 / 65536
PERIOD = 1 / 1024
STANDSTILL = Plant(coulomb_friction=100.0)  # nothing moves: the filter alone


def held(error: int, **registers: float) -> Motion:
    """An axis held by friction with a position error of `error` counts."""
    motion = Motion(1, [STANDSTILL])
    for name, value in registers.items():
        motion.set(0, Register[name.upper()], value)
    motion.push(0, -error)
    motion.run(1)
    assert motion.error(0) == error
    return motion


def test_proportional_is_four_kp() -> None:
    # commands.md 8; dmc-1412-1414.txt l.4454-4476
    motion = held(100, kp=6, kd=0)
    assert motion.torque(0) == pytest.approx(4 * 6 * 100 * VOLT, abs=1e-12)


def test_derivative_is_four_kd_of_one_sample() -> None:
    motion = held(10, kp=0, kd=64)
    assert motion.torque(0) == pytest.approx(4 * 64 * 10 * VOLT, abs=1e-12)
    motion.run(1)
    assert motion.torque(0) == 0


def test_integral_sums_half_ki_and_is_clamped() -> None:
    motion = held(8, kp=0, kd=0, ki=2, integrator_limit=0.5)
    assert motion.torque(0) == pytest.approx(8 * VOLT, abs=1e-12)
    motion.run(9)
    assert motion.torque(0) == pytest.approx(10 * 8 * VOLT, abs=1e-9)
    motion.run(10000)
    assert motion.torque(0) == 0.5


def test_negative_integrator_limit_freezes_during_the_move() -> None:
    motion = held(8, kp=0, kd=0, ki=2, integrator_limit=-0.5)
    motion.run(9)
    frozen = motion.torque(0)
    motion.set(0, Register.JOG_SPEED, 0)
    motion.begin_jog(0)
    motion.run(20)
    assert motion.torque(0) == frozen
    motion.stop(0)
    motion.run(10000)
    assert motion.torque(0) == 0.5


def test_offset_torque_limit_and_motor_off() -> None:
    motion = held(1000, kp=6, kd=0, offset=0.25, torque_limit=2)
    assert motion.torque(0) == 2
    motion.motor_off(0)
    motion.run(1)
    assert motion.torque(0) == 0.25
    assert not motion.amplifier_enabled(0)
    motion.servo_here(0)
    motion.run(1)
    assert (motion.error(0), motion.torque(0)) == (0, 0.25)


def test_feed_forwards() -> None:
    # commands.md 8: 1.22e-6 FV v and 1.5e-7 FA a, volts
    motion = Motion(1, [STANDSTILL])
    for register, value in ((Register.KP, 0), (Register.KD, 0), (Register.VELOCITY_FEED, 10)):
        motion.set(0, register, value)
    motion.set(0, Register.ACCELERATION_FEED, 4)
    motion.set(0, Register.ERROR_LIMIT, 1e9)
    motion.set(0, Register.JOG_SPEED, 30000)
    motion.begin_jog(0)
    motion.run(1)
    assert motion.torque(0) == pytest.approx(1.22e-6 * 10 * 250 + 1.5e-7 * 4 * 256000, rel=1e-9)
    motion.run(1000)
    assert motion.torque(0) == pytest.approx(0.366, rel=1e-6)  # FV 10 at 30,000 counts/s


def test_reversed_motor_and_encoder() -> None:
    straight, reversed_motor = held(50, kp=6), held(50, kp=6, motor_type=-1)
    assert reversed_motor.torque(0) == -straight.torque(0)
    motion = Motion(1, [STANDSTILL])
    motion.set(0, Register.ENCODER, 2)
    motion.push(0, 40)
    motion.run(1)
    assert motion.position(0) == -40


def test_wrong_polarity_runs_away_and_is_switched_off() -> None:
    # dmc-1412-1414.txt l.633-673: ER 2000, OE 1; |TE| passes 2000, the motor goes off with SC 8
    motion = Motion(1)
    for register, value in ((Register.ERROR_LIMIT, 2000), (Register.OFF_ON_ERROR, 1), (Register.MOTOR_TYPE, -1)):
        motion.set(0, register, value)
    motion.begin_position(0, 1000)
    seen: list[tuple[Event, int]] = []
    for _ in range(20):
        motion.run(5000)
        seen += motion.take_events()
    assert (Event.ERROR, 0) in seen
    assert (Event.SWITCHED_OFF, 0) in seen
    assert (motion.motor_on(0), motion.stop_code(0), motion.moving(0)) == (False, 8, False)
    assert motion.error_exceeded(0)


def test_error_without_oe_is_an_event_and_a_level() -> None:
    motion = held(101, kp=0, kd=0, error_limit=100)
    assert motion.take_events() == [(Event.ERROR, 0)]
    assert motion.motor_on(0)
    motion.push(0, 50)
    motion.run(1)
    assert not motion.error_exceeded(0)
    motion.push(0, -500)
    assert motion.run(10) == 1
    assert motion.take_events() == [(Event.ERROR, 0)]


def sampled_poles(gain: float, kp: float, kd: float, period: float) -> numpy.ndarray:
    """Closed-loop poles of 4KP + 4KD (1 - 1/z) around gain/s² behind a zero-order hold.

    The held double integrator is gain T²/2 (z + 1) / (z - 1)²; z (z - 1)² + c ((kp + kd) z - kd)(z + 1) = 0.
    """
    c = gain * period**2 / 2 * 4 * VOLT
    return numpy.roots(numpy.polyadd([1, -2, 1, 0], c * numpy.polymul([kp + kd, -kd], [1, 1])))


def test_closed_loop_has_the_poles_of_the_sampled_system() -> None:
    # a fine encoder makes the loop linear; the slow pole pair is all that is left of the free response
    plant = Plant(encoder_lines=1e6)
    gain = 0.1 / 2.0e-4 * 4e6 / (2 * math.pi)
    kp, kd = 6e-3, 64e-3
    motion = Motion(1, [plant])
    motion.set(0, Register.KP, kp)
    motion.set(0, Register.KD, kd)
    motion.set(0, Register.ERROR_LIMIT, 1e12)
    motion.push(0, 1_000_000)
    motion.trace(600)
    motion.run(600)
    response = motion.trace_rows()[:, 2]
    rows = numpy.array([response[i : i + 3][::-1] for i in range(20, 400)])
    fitted = numpy.linalg.lstsq(rows[:, 1:], -rows[:, 0], rcond=None)[0]
    expected = numpy.sort_complex(sampled_poles(gain, kp, kd, PERIOD))
    assert abs(expected[0]) < 0.05
    assert numpy.sort_complex(numpy.roots([1, *fitted])) == pytest.approx(expected[1:], abs=1e-5)


def test_default_gains_ring_as_the_manual_motor_does() -> None:
    # examples.md: KP 6 KD 64 on the frictionless motor of chapter 10: 48 rad/s, damping 0.26
    gain = 0.1 / 2.0e-4 * 4000 / (2 * math.pi)
    pole = max(sampled_poles(gain, 6, 64, PERIOD), key=lambda z: (z.imag > 0, abs(z)))
    s = cmath.log(pole) / PERIOD
    assert abs(s) == pytest.approx(48, abs=1)
    damping = -s.real / abs(s)
    assert damping == pytest.approx(0.26, abs=0.02)  # 0.258 continuous at 1 ms, 0.242 sampled at 1/1024 s
    motion = Motion(1)
    motion.push(0, 2000)
    motion.trace(500)
    motion.run(500)
    error = motion.trace_rows()[:, 2]
    crossings = [i for i in range(1, 500) if error[i - 1] > 0 >= error[i]]
    period = (crossings[1] - crossings[0]) * PERIOD
    assert 2 * math.pi / period == pytest.approx(s.imag, rel=0.03)
    peak = abs(error[: crossings[1]].min())
    assert peak / 2000 == pytest.approx(math.exp(-math.pi * damping / math.sqrt(1 - damping**2)), rel=0.02)


def test_integral_removes_the_error_of_a_load() -> None:
    # dmc-1412-1414.txt l.863-891: TE falls as KP rises; with KI it becomes 0
    errors = []
    for kp, ki in ((2, 0), (10, 0), (10, 1)):
        motion = Motion(1, [Plant(viscous_friction=0.002)])
        motion.set(0, Register.KP, kp)
        motion.set(0, Register.KI, ki)
        motion.set(0, Register.KD, 200)
        motion.load(0, -0.5)
        motion.run(8000)
        errors.append(motion.error(0))
    assert errors[0] == pytest.approx(0.5 / (4 * 2 * VOLT), abs=1)
    assert errors[1] == pytest.approx(0.5 / (4 * 10 * VOLT), abs=1)
    assert abs(errors[2]) <= 1


def test_dual_loop_takes_the_derivative_from_the_auxiliary_encoder() -> None:
    motion = Motion(1, [Plant(coulomb_friction=100.0, auxiliary_ratio=0.5)])
    motion.set(0, Register.KP, 0)
    motion.set(0, Register.DUAL_LOOP, 1)
    motion.push(0, -100)
    motion.run(1)
    assert motion.torque(0) == pytest.approx(4 * 64 * 50 * VOLT)


def test_stepper_has_no_filter() -> None:
    motion = Motion(1, [Plant(drive=Drive.STEPPER)])
    motion.set(0, Register.MOTOR_TYPE, 2)
    motion.begin_position(0, 5000)
    motion.run(400)
    assert (motion.error(0), motion.torque(0)) == (0, 0)
    motion.run(1000)
    assert (motion.auxiliary(0), motion.position(0)) == (5000, 5000)


def test_sample_time_changes_the_loop() -> None:
    motion = Motion(1)
    motion.set_sample_time(250)
    motion.set(0, Register.OFFSET, 1)
    motion.set(0, Register.KP, 0)
    motion.set(0, Register.KD, 0)
    motion.run(100)
    gain = 0.1 / 2.0e-4 * 4000 / (2 * math.pi)
    assert motion.velocity_now(0) == pytest.approx(gain * 100 * 250 / 1_024_000)
