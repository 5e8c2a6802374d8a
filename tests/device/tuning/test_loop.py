"""The sampled loop against chapter 10, against polynomials, and against a second account of the same machines."""

from __future__ import annotations

import cmath
import math
from dataclasses import replace

import numpy
import pytest

from device.simulator.plant import Drive, Place, Plant
from device.tuning.loop import Gains, bode, filter_response, is_stable, margins, period
from device.tuning.plant import AxisPlant, Resonance, response
from tests.device.simulator import reference
from tests.device.simulator.reference import PERIOD, VOLT
from tests.device.tuning.thirty import MOTOR, spring

RADIAN = 4 * 1000 / (2 * math.pi)  # counts, 1000 lines (dmc-1412-1414.txt l.4440)
ANALYSIS = AxisPlant(gain=4 * 0.1 / 2e-4 * 4 * 500 / (2 * math.pi))  # l.4507-4515: Ka Kt / J Kf


def test_a_sample_lasts_its_tm() -> None:
    assert period(1000) == 1 / 1024  # commands.md 7: the true period at TM 1000 is 1/1024 s
    assert period(250) == 1 / 4096


def test_the_filter_of_the_manual() -> None:
    # K (z-A)/z + C z/(z-1) with K = 4 (KP+KD), A = KD/(KP+KD), C = KI/2 (l.4456-4467); gains of l.4476
    omega = numpy.array([50.0, 400.0, 2000.0])
    z = numpy.exp(1j * omega * PERIOD)
    whole, zero = (4 + 36) * 4, 36 / (4 + 36)
    expected = (whole * (z - zero) / z + 0.25 * z / (z - 1)) * 20 / 65536
    assert filter_response(Gains(kp=4, kd=36, ki=0.5), PERIOD, omega) == pytest.approx(expected)


def test_the_analysis_example_as_it_is_sampled() -> None:
    # commands.md 11: 64.5 degrees; 200 rad/s at 1 ms, 196 at 1/1024 s (l.4564-4583 has 70 for the continuous model)
    gains = Gains(kp=12.5, kd=245)
    for time, omega in ((0.001, 200.0), (PERIOD, 196.0)):
        found = margins(ANALYSIS, gains, time)
        assert found.crossover == pytest.approx(omega, abs=1.5)
        assert found.phase == pytest.approx(64.5, abs=0.5)
        assert found.stable


def test_gain_margin_is_where_the_polynomial_turns_unstable() -> None:
    # x'' = b u behind a hold: b T²/2 (z+1)/(z-1)²; with 4KP + 4KD (1-1/z) the poles are roots of a cubic
    gains, b = Gains(kp=12.5, kd=245), ANALYSIS.gain

    def largest(times: float) -> float:
        k = times * VOLT * b * PERIOD**2 / 2
        return max(abs(numpy.roots(numpy.polyadd([1, -2, 1, 0], k * numpy.polymul([1, 1], [4 * 257.5, -4 * 245])))))

    low, high = 1.0, 100.0
    for _ in range(50):
        middle = math.sqrt(low * high)
        low, high = (middle, high) if largest(middle) < 1 else (low, middle)
    assert margins(ANALYSIS, gains, PERIOD).gain == pytest.approx(20 * math.log10(low), abs=0.05)
    for times in (0.5, low * 0.99, low * 1.01):
        there = replace(gains, kp=gains.kp * times, kd=gains.kd * times)
        assert is_stable(ANALYSIS, there, PERIOD) == (largest(times) < 1)


def test_sensitivity_of_a_loop() -> None:
    # a loop with the phase margin p comes to 2 sin(p/2) of -1 at its crossover at most
    found = margins(ANALYSIS, Gains(kp=12.5, kd=245), PERIOD)
    assert found.phase is not None
    assert 1 / found.sensitivity <= 2 * math.sin(math.radians(found.phase) / 2) + 1e-3
    undamped = margins(ANALYSIS, Gains(kp=20, kd=0.125), PERIOD)  # two integrators and the hold: no margin at all
    assert not undamped.stable and undamped.phase is not None and undamped.phase < 0


MACHINES = {
    "current": (Plant(), AxisPlant(gain=500 * RADIAN)),
    "friction": (Plant(viscous_friction=0.004), AxisPlant(gain=500 * RADIAN, pole=20.0)),
    "two samples late": (Plant(delay_samples=2), AxisPlant(gain=500 * RADIAN, delay=2 * PERIOD)),
    # l.4400-4420: the speed loop's pole is Ka Kt Kg / J
    "velocity": (
        Plant(drive=Drive.VELOCITY, amplifier_gain=2.0, tachometer_gain=0.1),
        AxisPlant(gain=1000 * RADIAN, pole=2 * 0.1 * 0.1 / 2e-4),
    ),
    "spring": (
        Plant(viscous_friction=0.002, **spring(80, 0.05, 0.7)),
        AxisPlant(gain=500 * RADIAN, pole=0.002 / MOTOR, resonance=Resonance(80, 0.05, 0.7)),
    ),
    "load encoder": (
        Plant(main=Place.LOAD, **spring(60, 0.1, 2.0)),
        AxisPlant(gain=500 * RADIAN, resonance=Resonance(60, 0.1, 2.0, on_load=True)),
    ),
}


@pytest.mark.parametrize("name", MACHINES)
def test_plants_answer_as_their_equations_do(name: str) -> None:
    machine, plant = MACHINES[name]
    gains = Gains(kp=9, kd=120, ki=0.5)
    drawn = bode(plant, gains, PERIOD, 60)
    for omega, value in zip(drawn.frequency[20::6], drawn.loop[20::6], strict=True):
        true = reference.loop_response(machine, reference.Gains(9, 120, 0.5), float(omega))
        assert abs(value / true - 1) < 1e-3


def test_half_a_sample_of_delay_is_half_a_sample_of_phase_at_low_frequencies() -> None:
    omega = numpy.array([20.0, 60.0])
    late = response(AxisPlant(gain=1e5, delay=1.5 * PERIOD), PERIOD, omega)
    there = response(AxisPlant(gain=1e5), PERIOD, omega)
    for one, other, w in zip(late, there, omega, strict=True):
        assert cmath.phase(one / other) == pytest.approx(-1.5 * PERIOD * w, abs=2e-4)
        assert abs(one / other) == pytest.approx(1, abs=2e-4)
