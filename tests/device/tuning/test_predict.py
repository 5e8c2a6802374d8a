"""Predicted moves against the independent integration, and what limits and feed-forward do to them."""

from __future__ import annotations

import math

import numpy
import pytest

from device.simulator.plant import Drive, Place, Plant
from device.tuning.loop import Gains
from device.tuning.plant import AxisPlant, Resonance
from device.tuning.predict import predict, step
from tests.device.simulator import reference
from tests.device.simulator.reference import PERIOD, closed_loop
from tests.device.tuning.thirty import MOTOR, spring

RADIAN = 4 * 1000 / (2 * math.pi)
MOTOR_GAIN = 500 * RADIAN  # counts/s² for one volt: Kt / J Kf
VOLT = 0.1  # N·m for one volt of the default amplifier

CASES = {
    "plain": (Plant(), AxisPlant(gain=MOTOR_GAIN), Gains(kp=12, kd=200)),
    "integrator": (Plant(viscous_friction=0.001), AxisPlant(gain=MOTOR_GAIN, pole=5.0), Gains(kp=10, kd=180, ki=1)),
    "dry": (
        Plant(coulomb_friction=0.01),
        AxisPlant(gain=MOTOR_GAIN, coulomb=0.01 / VOLT),
        Gains(kp=12, kd=200, ki=0.5),
    ),
    "late": (Plant(delay_samples=2), AxisPlant(gain=MOTOR_GAIN, delay=2 * PERIOD), Gains(kp=6, kd=160)),
    "limit": (Plant(), AxisPlant(gain=MOTOR_GAIN), Gains(kp=12, kd=200, torque_limit=1.5)),
    "speed drive": (
        Plant(drive=Drive.VELOCITY, amplifier_gain=2.0),
        AxisPlant(gain=2 * MOTOR_GAIN, pole=100.0),
        Gains(kp=30, kd=60),
    ),
    "spring": (
        Plant(**spring(60, 0.05, 1.0)),
        AxisPlant(gain=MOTOR_GAIN, resonance=Resonance(60, 0.05, 1.0)),
        Gains(kp=6, kd=120),
    ),
    "spring, dry, encoder on the load": (
        Plant(main=Place.LOAD, coulomb_friction=0.005, **spring(80, 0.1, 0.5)),
        AxisPlant(gain=MOTOR_GAIN, coulomb=0.05, resonance=Resonance(80, 0.1, 0.5, on_load=True)),
        Gains(kp=4, kd=80),
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_a_predicted_step_is_what_the_equations_make(name: str) -> None:
    machine, plant, gains = CASES[name]
    commanded = step(1000, 160, 5)
    shown = predict(plant, gains, commanded, PERIOD)
    true = reference.Gains(gains.kp, gains.kd, gains.ki, gains.torque_limit)
    expected = closed_loop(reference.Machine(machine, 20), true, commanded.tolist())
    assert expected.max() > 900
    assert numpy.abs(shown.actual - expected).max() <= 10
    assert numpy.abs(shown.volts).max() <= gains.torque_limit


def test_a_hanging_load_is_at_rest_before_the_step() -> None:
    plant = AxisPlant(gain=MOTOR_GAIN, gravity=0.5, pole=5.0, coulomb=0.02)
    held = predict(plant, Gains(kp=12, kd=200, ki=0.5), numpy.zeros(300), PERIOD)
    assert not held.actual.any() and held.volts == pytest.approx(0.5, abs=1e-9)
    # without KI the error holds the load: 4KP e 20/65536 V
    sagging = predict(plant, Gains(kp=12, kd=200), numpy.zeros(300), PERIOD)
    assert sagging.actual == pytest.approx(-0.5 / (48 * 20 / 65536), abs=1.0)
    springy = AxisPlant(gain=MOTOR_GAIN, gravity=0.5, coulomb=0.05, resonance=Resonance(60, 0.05, 1.0, on_load=True))
    assert numpy.ptp(predict(springy, Gains(kp=6, kd=100, ki=0.5), numpy.zeros(300), PERIOD).actual) <= 1


def test_feed_forward_takes_the_error_of_a_move() -> None:
    # FV volts = 1.22e-6 FV speed, FA volts = 1.5e-7 FA acceleration (commands.md 8)
    speed, ramp = 20_000.0, 100
    accelerating = numpy.linspace(0, speed, ramp)
    commanded = numpy.cumsum(numpy.concatenate([accelerating, numpy.full(200, speed)])) / 1024
    plant = AxisPlant(gain=MOTOR_GAIN, pole=20.0)
    gains = {"kp": 12.0, "kd": 200.0}
    plain = predict(plant, Gains(**gains), commanded, PERIOD)
    needed = 20.0 / MOTOR_GAIN / 1.22e-6
    fed = predict(plant, Gains(**gains, fv=round(needed), fa=1 / MOTOR_GAIN / 1.5e-7), commanded, PERIOD)
    lag = numpy.abs(commanded - plain.actual)[-100:].mean()
    # at speed the filter has to hold the friction: gain u = pole v, u = 4KP e 20/65536
    assert lag == pytest.approx(20.0 * speed / MOTOR_GAIN / (48 * 20 / 65536), rel=0.05)
    assert numpy.abs(commanded - fed.actual)[-100:].mean() < 0.05 * lag
    assert numpy.abs(commanded - fed.actual)[20:ramp].max() < 0.5 * numpy.abs(commanded - plain.actual)[20:ramp].max()


def test_the_inertia_of_the_cases() -> None:
    assert pytest.approx(0.1 / MOTOR * RADIAN) == MOTOR_GAIN
