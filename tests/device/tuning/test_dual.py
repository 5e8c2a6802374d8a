"""Automatic tuning with a dual loop (dmc-1412-1414.txt l.2230-2252): load encoder main, motor encoder auxiliary."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.twoletter.fixed import ONE
from device.simulator.plant import Place, Plant
from device.tuning.automatic import vibrates
from device.tuning.bench import Found, Measured, Wish
from device.tuning.excite import NotIdentified
from device.tuning.guards import HELD
from device.tuning.loop import Gains
from device.tuning.metrics import Response
from device.tuning.run import run_automatic, run_excitation, run_step
from tests.device.tuning.test_guards import WHEN
from tests.device.tuning.test_run import done, ready
from tests.device.tuning.thirty import spring
from tests.long import is_long, record
from tests.rig import Rig

PLAY = 40.0  # counts between motor and load
STEP = 400
BOTH: dict[str, Any] = {"main": Place.LOAD, "auxiliary": Place.MOTOR, "backlash": PLAY}
MACHINES = {
    "play, dry": Plant(**BOTH, viscous_friction=1e-3, coulomb_friction=0.003),
    "play alone": Plant(**BOTH),
    "late": Plant(**BOTH, coulomb_friction=0.003, delay_samples=2),
    "strong": Plant(**BOTH, coulomb_friction=0.03, amplifier_gain=10.0),
    "hangs": Plant(**BOTH, coulomb_friction=0.003, gravity=0.3),
    "finer at the motor": Plant(**BOTH, coulomb_friction=0.003, auxiliary_ratio=4.0),  # l.2240: greater resolution
    "behind a spring": Plant(main=Place.LOAD, auxiliary=Place.MOTOR, coulomb_friction=0.003, **spring(80, 0.05, 0.5)),
}
COMMAND = "./studio test --long tests/device/tuning/test_dual.py"


def dual(plant: Plant) -> Rig:
    rig = ready(plants={"X": plant})
    rig.type("DVX=1")
    return rig


def registers(rig: Rig) -> dict[str, float]:
    values = rig.simulation.unit.state.registers
    return {name: values[name][0] / ONE for name in HELD}


def tuned(rig: Rig, folder: Path, seconds: float = 0.5) -> Found:
    wish = Wish("X", STEP, Gains(), seconds=seconds)
    job = run_automatic(rig.controller, wish, folder, WHEN, lambda m, why: None, velocity=False)
    found: Found = done(rig, job, 400)
    return found


def stepped(rig: Rig, folder: Path, gains: Gains) -> Measured:
    found: Measured = done(rig, run_step(rig.controller, Wish("X", STEP, gains, seconds=0.5), folder, WHEN))
    return found


@pytest.mark.parametrize("name", MACHINES if is_long() else ["play, dry"])
def test_kd_is_raised_first_without_kp_then_kp_then_ki(tmp_path: Path, name: str) -> None:
    rig = dual(MACHINES[name])
    before = registers(rig)
    found = tuned(rig, tmp_path)
    assert found.gains is not None, found.words
    # l.2252: "start with KP=0, KI=0 and to maximize the value of KD [...] increase KP gradually [...] finally KI"
    gains = [(trial.gains.kp, trial.gains.ki, trial.gains.kd) for trial in found.trials]
    first = [each for each in gains if each[0] == 0]
    assert len(first) >= 3 and gains[: len(first)] == first and all(ki == 0 for _, ki, _ in first)
    assert [kd for _, _, kd in first] == sorted({kd for _, _, kd in first})
    assert found.gains.kd > 64 and 0 < found.gains.kp <= found.gains.kd / 4  # the factory's KD; l.885
    assert registers(rig) == pytest.approx(before, abs=1e-4) and not list(
        tmp_path.iterdir()
    )  # recommended, not set; OF as it was
    best = stepped(rig, tmp_path, found.gains)
    assert best.metrics is not None and best.metrics.settling_time is not None and not best.vibrates
    assert abs(best.metrics.steady_error) <= (1 if not MACHINES[name].gravity else 3)
    record(f"dual loop tuned automatically, {name}: settling", COMMAND, None, best.metrics.settling_time * 1000, "ms")


@pytest.mark.skipif(not is_long(), reason="the long run tunes all of them")
def test_what_it_finds_swings_with_the_load_encoder_alone(tmp_path: Path) -> None:
    rig = dual(MACHINES["play alone"])
    found = tuned(rig, tmp_path)
    assert found.gains is not None
    assert not stepped(rig, tmp_path, found.gains).vibrates
    rig.type("DVX=0")
    alone = stepped(rig, tmp_path, found.gains)
    error = alone.response.commanded - alone.response.actual
    assert np.ptp(error[-30:]) > 10  # counts of the load, for ever: what the second encoder is for


def test_an_axis_with_weight_on_it_does_not_lose_its_kp(tmp_path: Path) -> None:
    rig = dual(Plant(**BOTH, coulomb_friction=0.003, gravity=2.5))
    rig.run(1.0)
    place = rig.simulation.state()["axes"]["X"]["actual"]
    found = tuned(rig, tmp_path)
    assert found.gains is None and "needs 2.50 V to stay where it is" in found.words and found.trials == ()
    state = rig.simulation.state()["axes"]["X"]
    assert state["motor_on"] and abs(state["actual"] - place) <= 2 and not list(tmp_path.iterdir())


def test_it_is_not_identified_and_told_why(tmp_path: Path) -> None:
    rig = dual(MACHINES["play, dry"])
    excited = done(rig, run_excitation(rig.controller, Wish("X", 200, Gains()), tmp_path, WHEN))
    assert isinstance(excited.recording, NotIdentified)
    assert "dual loop (DV 1) cannot be identified" in excited.recording.reason and not rig.sent("IP")


def test_a_swing_that_every_record_hides_is_seen() -> None:
    steps = np.full(64, 400.0)
    for sent, looks, seen in (
        (np.full(64, 10.0), (10.0, -10.0, -10.0, 10.0), True),  # every fourth sample of + + - -
        (np.full(64, 0.4), (0.4, 0.4, 0.39), False),
        (np.linspace(2.0, -2.0, 64), (-2.0, -2.1, -2.2), False),  # still on its way
        (np.full(64, 10.0), (), False),
    ):
        assert vibrates(Response(0.0078, steps, steps, sent), Gains(), looks) is seen


@pytest.mark.parametrize("kd", [300, 640])
def test_damping_beyond_what_sampling_allows_vibrates(tmp_path: Path, kd: int) -> None:
    # x'' = g u behind a hold, u = -4 KD (20/65536) (x - x one sample before): the poles of what is left without KP
    # solve z² - (1 - a/2) z + a/2 = 0 with a = 4 KD (20/65536) g T²; their size is sqrt(a/2)
    plant = Plant(amplifier_gain=10.0)
    gain = 10.0 * plant.torque_constant / plant.inertia * 4 * plant.encoder_lines / (2 * math.pi)
    size = math.sqrt(4 * kd * 20 / 65536 * gain / 1024**2 / 2)
    rig = ready(plants={"X": plant})
    measured = stepped(rig, tmp_path, Gains(kp=20, kd=kd))
    assert measured.vibrates is (size > 1)
