"""Gains for a target against chapter 10, the true loops, and every sentence that refuses."""

from __future__ import annotations

import itertools
import math
import random
from dataclasses import replace

import numpy
import pytest

from codegen.twoletter.commands import COMMANDS
from device.simulator.plant import Drive, Place, Plant
from device.tuning.design import CLOSE, CLOSE_PHASE, Design, Refusal, Target, design, exact, propose
from device.tuning.loop import FACTORY, VOLTS, Gains
from device.tuning.plant import AxisPlant, Resonance
from tests.device.simulator.reference import PERIOD
from tests.device.tuning import truth
from tests.device.tuning.thirty import MOTOR, spring
from tests.long import count, record

RADIAN = 4 * 1000 / (2 * math.pi)
SIZES = (0.125, 0.125, 1 / 128)  # steps of KP, KD, KI (commands.json)
PLAIN = AxisPlant(gain=4 * 500 * RADIAN, pole=2.0)


def reached(plant: AxisPlant, target: Target, keep: Gains = FACTORY) -> Design:
    found = design(plant, target, PERIOD, keep)
    assert isinstance(found, Design), found
    return found


def refusal(plant: AxisPlant, target: Target) -> Refusal:
    found = design(plant, target, PERIOD)
    assert isinstance(found, Refusal)
    return found


def test_the_design_example_of_the_chapter() -> None:
    # l.4638-4718: L = 3.175e6/[s² (s + 2000)], 500 rad/s and 45 degrees: KP 20.6, KD 68.6 with a sample of 1 ms
    s, short = 500j, 1e-6
    printed = 3.175e6 / (s * s * (s + 2000))  # converter counts to encoder counts
    found = exact(printed / VOLTS, Target(500, 45, 0.0), short)
    assert not isinstance(found, str)
    # with a vanishing sample the filter is the chapter's P + sD: P = 4KP, D = 4T KD
    kp, kd, ki = found[0], found[1] * short / 0.001, found[2]
    # the chapter rounds |G| to 160 and the angle to 59 degrees
    wanted = 1 / abs(printed)
    angle = -135 - math.degrees(math.atan2(printed.imag, printed.real)) + 360  # of G: -135 + 194
    assert kp == pytest.approx(20.6, rel=0.02) and kd == pytest.approx(68.6, rel=0.02) and ki == 0
    assert angle % 360 == pytest.approx(59, abs=0.1)
    assert 4 * kp == pytest.approx(wanted * math.cos(math.radians(angle)), rel=1e-3)


def test_gains_are_what_the_controller_can_hold() -> None:
    found = reached(PLAIN, Target(73, 51), replace(FACTORY, torque_limit=5.0, integrator_limit=3.0, offset=0.1))
    for name, value in (("KP", found.gains.kp), ("KD", found.gains.kd), ("KI", found.gains.ki)):
        row = COMMANDS[name]
        assert row.step is not None and (value / row.step).is_integer() and 0 <= value <= (row.high or 0)
    assert (found.gains.torque_limit, found.gains.integrator_limit, found.gains.offset) == (5.0, 3.0, 0.1)
    assert found.margins.crossover == pytest.approx(73, rel=0.05)
    assert found.margins.phase == pytest.approx(51, abs=2.5)
    assert reached(PLAIN, Target(73, 51, 0.0)).gains.ki == 0.0


def check_refused(machine: Plant, target: Target, reason: str) -> None:
    """No gains come to it; for what is refused for whole steps of the gains, none of the steps around does."""
    if "One count of the encoder" in reason or "10 % elsewhere" in reason:
        return  # reachable, but not sound
    if "too coarse" not in reason and "controller's step" not in reason:
        nothing = truth.reachable(machine, target.crossover, target.phase, [target.integral], [0], (CLOSE, CLOSE_PHASE))
        assert not nothing, (target, reason)
        return
    values = exact(complex(truth.machine_response(machine, numpy.array([target.crossover]))[0]), target, PERIOD)
    assert not isinstance(values, str)
    steps = [[(value // size + n) * size for n in (0, 1)] for value, size in zip(values, SIZES, strict=True)]
    for kp, kd, ki in itertools.product(*steps):
        if kp > 0:
            true = truth.loop(machine, Gains(kp=kp, kd=kd, ki=ki))
            off = abs(true.crossover / target.crossover - 1) / CLOSE, abs(true.phase - target.phase) / CLOSE_PHASE
            assert max(off) > 0.95


MACHINES = {
    "plain": (Plant(amplifier_gain=4.0, viscous_friction=0.0004), PLAIN),
    "late": (Plant(delay_samples=2), AxisPlant(gain=500 * RADIAN, delay=2 * PERIOD)),
    "speed": (Plant(drive=Drive.VELOCITY, amplifier_gain=2.0), AxisPlant(gain=1000 * RADIAN, pole=100.0)),
    "spring": (Plant(**spring(90, 0.05, 0.6)), AxisPlant(gain=500 * RADIAN, resonance=Resonance(90, 0.05, 0.6))),
    "load": (
        Plant(main=Place.LOAD, **spring(70, 0.15, 0.6)),
        AxisPlant(gain=500 * RADIAN, resonance=Resonance(70, 0.15, 0.6, True)),
    ),
}


@pytest.mark.parametrize("name", MACHINES)
def test_every_answer_is_true(name: str) -> None:
    """Random targets: a design reaches its target in the true loop, a refusal means that nothing does."""
    machine, plant = MACHINES[name]
    chance = random.Random(name)
    rounds, refused = count(4, 60), 0
    for _ in range(rounds):
        target = Target(math.exp(chance.uniform(math.log(15), math.log(600))), chance.uniform(25, 75), 0.1)
        found = design(plant, target, PERIOD)
        given = found if isinstance(found, Design) else found.nearest
        wanted = target if isinstance(found, Design) else found.nearest_target
        if given is not None and wanted is not None:
            true = truth.loop(machine, given.gains)
            assert true.stable
            assert true.crossover == pytest.approx(wanted.crossover, rel=0.06)
            assert true.phase == pytest.approx(wanted.phase, abs=3)
        if isinstance(found, Refusal):
            refused += 1
            check_refused(machine, target, found.reason)
    record(
        f"refused targets of random ones, {name}",
        "./studio test --long tests/device/tuning",
        None,
        refused,
        f"of {rounds}",
    )


@pytest.mark.parametrize(
    ("plant", "target", "words"),
    [
        (AxisPlant(gain=5e5, delay=5 * PERIOD), Target(200, 50), ("° late", "a delay of 4.88 ms", "less than 90°")),
        (AxisPlant(gain=2e3), Target(200, 50), ("KP would have to be", "1023.88 at most")),
        (AxisPlant(gain=1e8), Target(30, 50), ("less than the controller's step of 0.125",)),
        (AxisPlant(gain=1e6, pole=300.0), Target(60, 40), ("with KP alone", "velocity loop", "negative KD")),
        (AxisPlant(gain=5e4), Target(150, 60), ("One count of the encoder would make", "too coarse")),
        (AxisPlant(gain=3e5, resonance=Resonance(60, 0.03, 0.5, True)), Target(70, 45), ("resonance at 60 Hz",)),
        (PLAIN, Target(0, 45), ("above 0 Hz",)),
        (PLAIN, Target(50, 95), ("between 0 and 90°",)),
        (PLAIN, Target(3000, 45), ("half the sampling frequency",)),
    ],
)
def test_a_refusal_says_why(plant: AxisPlant, target: Target, words: tuple[str, ...]) -> None:
    found = refusal(plant, target)
    for word in words:
        assert word in found.reason
    assert found.reason.endswith(".")
    if found.nearest is not None and found.nearest_target is not None:
        assert found.nearest_target.phase == target.phase
        assert isinstance(design(plant, found.nearest_target, PERIOD), Design)


def test_the_delay_alone_decides_the_first_refusal() -> None:
    # at w: 180° of two integrators, half a sample of hold, five samples of delay; the difference 1 - 1/z leads by
    # 90° - wT/2 at most, so the margin is at most 90° - wT/2 (1 + 1) - 5 wT
    omega = 200.0
    most = 90 - math.degrees(omega * PERIOD * (0.5 + 0.5 + 5))
    assert most < 50
    plant = AxisPlant(gain=5e5, delay=5 * PERIOD)
    assert isinstance(design(plant, Target(omega, most + 3, 0.0), PERIOD), Refusal)
    assert "less than 90°" in refusal(plant, Target(omega, most + 3, 0.0)).reason


def test_a_speed_drive_gets_its_margin_from_the_integrator() -> None:
    # with KP alone at w: 90° - atan(w/pole) - wT/2 are left
    omega, pole = 40.0, 100.0
    alone = 90 - math.degrees(math.atan(omega / pole)) - math.degrees(omega * PERIOD / 2)
    found = reached(AxisPlant(gain=6e5, pole=pole), Target(omega, alone - 15))
    assert found.gains.kd == 0 and found.gains.ki > 0


def test_remarks_on_sound_gains() -> None:
    loud = reached(AxisPlant(gain=1e5), Target(120, 50))
    assert any("may be heard" in note for note in loud.notes)
    hanging = reached(AxisPlant(gain=5e5, gravity=0.5), Target(60, 50, 0.0))
    sag = 0.5 / (4 * hanging.gains.kp * 20 / 65536)
    assert f"Without KI the weight leaves an error of {sag:.0f} counts." in hanging.notes
    springy = reached(AxisPlant(gain=3e5, resonance=Resonance(40, 0.03, 0.5)), Target(60, 50))
    assert any("its phase makes that safe" in note for note in springy.notes)
    tiny = reached(AxisPlant(gain=4e5), Target(20, 60, 0.01))
    assert tiny.gains.ki == 0 and any("KI would be smaller than its step" in note for note in tiny.notes)


@pytest.mark.parametrize("name", MACHINES)
def test_what_is_proposed_can_be_reached(name: str) -> None:
    machine, plant = MACHINES[name]
    target = propose(plant, PERIOD)
    assert target is not None
    true = truth.loop(machine, reached(plant, target).gains)
    assert true.stable and true.apart >= 0.45
    assert true.crossover == pytest.approx(target.crossover, rel=0.1)


def test_nothing_is_proposed_for_an_axis_that_hardly_moves() -> None:
    assert propose(AxisPlant(gain=10.0), PERIOD) is None


def test_the_motor_of_the_machines() -> None:
    assert pytest.approx(0.1 / MOTOR) == 500
