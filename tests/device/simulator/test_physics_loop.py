"""Servo and machine against chapter 10 of the manual, the exact sampled loop, and an independent integration."""

from __future__ import annotations

import cmath
import math

import numpy
import pytest

from device.simulator.motion import Motion, Register
from device.simulator.plant import Drive, Place, Plant
from tests.device.simulator.reference import PERIOD, VOLT, Gains, Machine, closed_loop, counts_a_radian, loop_response

ANALYSIS = Plant(amplifier_gain=4.0, encoder_lines=500.0)  # l.4507-4515: Kt 0.1, J 2e-4, Ka 4, N 500
ANALYSIS_GAINS = Gains(kp=12.5, kd=245.0)


def axis(plant: Plant, gains: Gains, period: float = PERIOD, seed: int = 0) -> Motion:
    """A simulated axis with these gains."""
    motion = Motion(1, [plant], seed=seed)
    motion.set_sample_time(period * 1_024_000)
    motion.set(0, Register.KP, gains.kp)
    motion.set(0, Register.KD, gains.kd)
    motion.set(0, Register.KI, gains.ki)
    motion.set(0, Register.TORQUE_LIMIT, gains.torque_limit)
    motion.set(0, Register.DUAL_LOOP, float(gains.dual))
    motion.set(0, Register.ERROR_LIMIT, 1e12)
    return motion


# ---------------------------------------------------------------- the chapter's own arithmetic


def crossover(response: object, low: float = 10.0, high: float = 2000.0) -> float:
    """Where the magnitude falls through one."""
    assert callable(response)
    for _ in range(60):
        middle = math.sqrt(low * high)
        low, high = (middle, high) if abs(response(middle)) > 1 else (low, middle)
    return low


def margin(value: complex) -> float:
    """Phase margin, degrees."""
    return math.degrees(cmath.phase(-value))


def continuous(plant: Plant, gains: Gains, omega: float, period: float = 0.001) -> complex:
    """A(s) = M Ka Kd Kf H G with P = 4KP, D = 4T KD, H = 2000/(s + 2000) (l.4385-4500)."""
    s = 1j * omega
    motor = plant.torque_constant / (plant.inertia * s * s) * plant.amplifier_gain
    filtered = 4 * gains.kp + 4 * period * gains.kd * s
    return motor * VOLT * counts_a_radian(plant) * (2 / period) / (s + 2 / period) * filtered


def test_analysis_example_of_the_chapter() -> None:
    # l.4564-4583: A = 390 000 (s + 51) / [s² (s + 2000)]; 200 rad/s, 70 degrees

    def printed(omega: float) -> complex:
        return 390_000 * (1j * omega + 51) / ((1j * omega) ** 2 * (1j * omega + 2000))

    assert crossover(printed) == pytest.approx(200, rel=0.01)
    assert margin(printed(200)) == pytest.approx(70, abs=1)
    for omega in (50, 200, 900):  # the parts of our machine multiply to the printed function
        assert continuous(ANALYSIS, ANALYSIS_GAINS, omega) == pytest.approx(printed(omega), rel=0.03)


def test_design_example_of_the_chapter() -> None:
    # l.4638-4718: L = 3.175e6/[s² (s + 2000)], 500 rad/s and 45 degrees: P 82.4, 500 D 137.2, KP 20.6, KD 68.6
    s = 500j
    printed = 3.175e6 / (s * s * (s + 2000))
    assert abs(printed) == pytest.approx(0.00625, rel=0.02)
    wanted = cmath.rect(1, math.radians(-135)) / printed
    assert (abs(wanted), math.degrees(cmath.phase(wanted))) == (
        pytest.approx(160, rel=0.02),
        pytest.approx(59, abs=0.5),
    )
    p, d = 160 * math.cos(math.radians(59)), 160 * math.sin(math.radians(59)) / 500
    assert (p, 500 * d) == (pytest.approx(82.4, abs=0.05), pytest.approx(137.2, abs=0.1))
    assert (p / 4, d / (4 * 0.001)) == (pytest.approx(20.6, abs=0.05), pytest.approx(68.6, abs=0.05))


def test_design_example_as_the_simulator_runs_it() -> None:
    # commands.md 11: with the printed parts (M 1000/s², so Kt 0.2; l.4613-4638) and a 16-bit converter the loop is
    # 7.76e5/[s² (s + 2000)]: 195 rad/s, 27 degrees
    plant, gains = Plant(amplifier_gain=2.0, torque_constant=0.2), Gains(kp=20.6, kd=68.6)
    omega = crossover(lambda omega: continuous(plant, gains, omega))
    assert (omega, margin(continuous(plant, gains, omega))) == (pytest.approx(195, abs=2), pytest.approx(27, abs=1.5))


@pytest.mark.parametrize(("period", "omega"), [(0.001, 200), (PERIOD, 196)])
def test_exact_sampled_loop_of_the_analysis_example(period: float, omega: float) -> None:
    # commands.md 11: 64.5 degrees in the sampled loop; 200 rad/s at 1 ms, 196 at 1/1024 s
    found = crossover(lambda w: loop_response(ANALYSIS, ANALYSIS_GAINS, w, period))
    assert found == pytest.approx(omega, abs=1.5)
    assert margin(loop_response(ANALYSIS, ANALYSIS_GAINS, found, period)) == pytest.approx(64.5, abs=0.5)


# ---------------------------------------------------------------- frequency sweep of the simulated axis


def swept(motion: Motion, cycles: int, volts: float, count: int = 1024, settle: int = 600) -> complex:
    """The open loop as a sweep with a sine in OF shows it: what the filter adds, over the whole command."""
    outputs, offsets = [], []
    for k in range(settle + count):
        offset = volts * math.sin(2 * math.pi * cycles * k / count)
        motion.set(0, Register.OFFSET, offset)
        motion.run(1)
        outputs.append(motion.torque(0))
        offsets.append(offset)
    wave = numpy.exp(-2j * math.pi * cycles * numpy.arange(count) / count)
    total = numpy.dot(wave, outputs[settle:])
    return complex(-(total - numpy.dot(wave, offsets[settle:])) / total)


SWEEPS = {
    "current": (ANALYSIS, ANALYSIS_GAINS, (16, 24, 32, 64, 120)),
    "voltage": (Plant(drive=Drive.VOLTAGE, amplifier_gain=4.0), Gains(kp=20, kd=200), (8, 16, 32, 64)),
    "voltage, no inductance": (
        Plant(drive=Drive.VOLTAGE, amplifier_gain=4.0, inductance=0.0),
        Gains(kp=20, kd=200),
        (8, 16, 32, 64),
    ),
    "velocity": (Plant(drive=Drive.VELOCITY, amplifier_gain=2.0, tachometer_gain=0.1), Gains(30, 60), (4, 16, 32, 64)),
    "friction": (Plant(viscous_friction=0.004), Gains(12, 200), (8, 16, 32)),
    "dead time": (Plant(amplifier_gain=4.0, encoder_lines=500, delay_samples=2), Gains(6, 160), (16, 24, 32)),
    "resonance": (
        Plant(load_inertia=3e-4, coupling_stiffness=30.0, coupling_damping=0.02),
        Gains(kp=4, kd=60),
        (8, 16, 40, 80, 110),
    ),
    "load encoder": (
        Plant(load_inertia=2e-5, coupling_stiffness=30.0, coupling_damping=0.02, main=Place.LOAD),
        Gains(kp=4, kd=60),
        (8, 16, 32),
    ),
}


@pytest.mark.parametrize("name", SWEEPS)
def test_sweep_agrees_with_the_exact_sampled_loop(name: str) -> None:
    plant, gains, cycles = SWEEPS[name]
    for each in cycles:
        measured = swept(axis(plant, gains), each, 6.0)
        exact = loop_response(plant, gains, 2 * math.pi * each)
        assert abs(measured) == pytest.approx(abs(exact), rel=0.02), each
        assert abs(math.degrees(cmath.phase(measured / exact))) < 2, each


def test_sweep_shows_the_phase_margin_of_the_analysis_example() -> None:
    # commands.md 11: 64.5 degrees at 196 rad/s (31 cycles of 1024 samples are 195, 32 are 201 rad/s)
    first, second = (swept(axis(ANALYSIS, ANALYSIS_GAINS), cycles, 3.0) for cycles in (31, 32))
    assert abs(first) > 1 > abs(second)
    part = math.log(abs(first)) / math.log(abs(first) / abs(second))
    assert 2 * math.pi * (31 + part) == pytest.approx(196, rel=0.02)
    assert margin(first) + part * (margin(second) - margin(first)) == pytest.approx(64.5, abs=2)


def test_resonance_is_where_its_formula_says() -> None:
    # anti-resonance sqrt(k/JL), resonance sqrt(k (1/Jm + 1/JL)) between motor command and motor speed
    plant = Plant(load_inertia=3e-4, coupling_stiffness=30.0, coupling_damping=0.002)
    low, high = math.sqrt(30 / 3e-4), math.sqrt(30 * (1 / 2e-4 + 1 / 3e-4))
    gains = Gains(kp=1, kd=20)
    speeds = {}
    for cycles in range(40, 92, 2):
        omega = 2 * math.pi * cycles
        z = cmath.exp(1j * omega * PERIOD)
        filtered = (4 * gains.kp + 4 * gains.kd * (1 - 1 / z)) * VOLT
        speeds[omega] = abs(swept(axis(plant, gains), cycles, 2.0) / filtered) * omega
    assert min(speeds, key=speeds.__getitem__) == pytest.approx(low, abs=2 * 2 * math.pi)
    assert max(speeds, key=speeds.__getitem__) == pytest.approx(high, abs=2 * 2 * math.pi)


# ---------------------------------------------------------------- steps against the independent integration


def stepped(motion: Motion, counts: int, samples: int) -> tuple[list[float], numpy.ndarray]:
    """RP steps by `counts` at once (IP while jogging at 0, SSC manual l.2154); RP and TP of every sample."""
    motion.trace(samples)
    motion.set(0, Register.JOG_SPEED, 0)
    motion.begin_jog(0)
    motion.run(5)
    assert motion.increment(0, counts)
    motion.run(samples - 5)
    rows = motion.trace_rows()
    return list(rows[:, 1]), rows[:, 2]


STEPS = {
    "chapter 10": (ANALYSIS, ANALYSIS_GAINS, 40),
    "factory gains": (Plant(), Gains(), 40),
    "voltage": (Plant(drive=Drive.VOLTAGE, amplifier_gain=4.0), Gains(kp=20, kd=200, ki=0.5), 40),
    "voltage, no inductance": (Plant(drive=Drive.VOLTAGE, amplifier_gain=4.0, inductance=0), Gains(20, 200), 40),
    "velocity": (Plant(drive=Drive.VELOCITY, amplifier_gain=2.0), Gains(30, 60), 40),
    "resonance": (Plant(load_inertia=3e-4, coupling_stiffness=30.0, coupling_damping=0.02), Gains(2, 40), 40),
    "gravity": (Plant(gravity=0.4), Gains(12, 200, 0.3), 40),
    "dead time": (Plant(delay_samples=3), Gains(6, 160), 40),
    "viscous friction": (Plant(viscous_friction=0.003), Gains(12, 200), 40),
    "coulomb friction": (Plant(coulomb_friction=0.01), Gains(12, 200, 0.2), 200),
    "torque limit": (Plant(), Gains(12, 200, torque_limit=1.5), 40),
    "peak current": (Plant(amplifier_gain=4.0, peak_current=3.0), Gains(6, 100), 40),
    "torque ripple": (Plant(torque_ripple=0.3), Gains(12, 200), 40),
    "dual loop with play": (
        Plant(
            load_inertia=1e-4,
            coupling_stiffness=30.0,
            coupling_damping=0.03,
            backlash=24.0,
            main=Place.LOAD,
            auxiliary=Place.MOTOR,
        ),
        Gains(4, 120, dual=True),
        200,
    ),
}


@pytest.mark.parametrize("name", STEPS)
def test_step_agrees_with_an_independent_integration(name: str) -> None:
    plant, gains, steps = STEPS[name]
    references, positions = stepped(axis(plant, gains), 1000, 260)
    expected = closed_loop(Machine(plant, steps), gains, references)
    assert max(expected) > 900
    assert numpy.abs(positions - expected).max() <= 0.01 * 1000


def test_step_at_the_shortest_sample_time() -> None:
    # TM 250: 1/4096 s; the filter works by the sample, so the same KD damps four times less
    plant, gains, period = ANALYSIS, Gains(kp=12.5, kd=980.0), 1 / 4096
    references, positions = stepped(axis(plant, gains, period), 1000, 800)
    expected = closed_loop(Machine(plant, 20, period), gains, references)
    assert numpy.abs(positions - expected).max() <= 10


def test_a_move_follows_as_the_integration_does() -> None:
    plant, gains = Plant(viscous_friction=0.002, coulomb_friction=0.004), Gains(12, 200, 0.2)
    motion = axis(plant, gains)
    motion.set(0, Register.SPEED, 40000)
    motion.trace(400)
    motion.begin_position(0, 6370)
    motion.run(400)
    rows = motion.trace_rows()
    expected = closed_loop(Machine(plant, 100), gains, list(rows[:, 1]))
    assert numpy.abs(rows[:, 2] - expected).max() <= 10
    assert numpy.abs(rows[:, 1] - rows[:, 2]).max() > 10  # there is something to compare
