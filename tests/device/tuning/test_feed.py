"""FV and FA from an estimate: the torque a move needs by chapter 10's equations, and what is left of the error."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from codegen.twoletter.fixed import ONE
from device.simulator.plant import Plant
from device.tuning.bench import Measured, Wish
from device.tuning.feed import feeds, sweep
from device.tuning.loop import Gains
from device.tuning.plant import AxisPlant
from device.tuning.run import run_moves
from tests.device.tuning.test_dual import registers
from tests.device.tuning.test_guards import WHEN
from tests.device.tuning.test_run import done, ready

RUB, INERTIA, TORQUE, LINES = 5e-3, 2e-3, 0.1, 1000.0  # N·m·s/rad, kg·m², N·m/A at 1 A/V, lines
COUNTS = 4 * LINES / (2 * math.pi)  # a radian (dmc-1412-1414.txt l.4440)
AXIS = AxisPlant(gain=TORQUE / INERTIA * COUNTS, pole=RUB / INERTIA)
STEP = 4000
FASTEST = (8_000_000, 67_107_840)  # SP and AC of the controller


@pytest.mark.parametrize("tm", [1000, 500])
def test_they_give_the_torque_that_the_move_needs(tm: int) -> None:
    # 10 000 counts/s and 100 000 counts/s²; SP and AC count in 1024 samples (spec/commands.md 7 and 8)
    period, speed, rise = tm / 1_024_000, 1e4, 1e5
    found = feeds(AXIS, period)
    sp, ac = speed * 1024 * period, rise * (1024 * period) ** 2
    assert 1.22e-6 * found.fv * sp == pytest.approx(RUB * speed / COUNTS / TORQUE, rel=1 / found.fv)  # whole steps
    assert 1.5e-7 * found.fa * ac == pytest.approx(INERTIA * rise / COUNTS / TORQUE, rel=0.01)


def test_what_the_register_can_not_hold_is_said() -> None:
    found = feeds(AxisPlant(gain=500.0), 1 / 1024)
    assert found.fa == 8191 and "FA would have to be 13333; the controller takes 8191 at most" in found.words


@pytest.mark.parametrize("tops", [FASTEST, (6000, 67_107_840), (8_000_000, 40_000), (3000, 20_000), (0, 0)])
@pytest.mark.parametrize("tm", [1000, 500])
def test_the_move_that_compares_never_passes_the_top_speed_of_the_machine(tops: tuple[int, int], tm: int) -> None:
    period = tm / 1_024_000
    way = sweep(AXIS, STEP, period, 9.9982, tops)
    assert 2 <= way.speed <= max(tops[0], 2) and 1024 <= way.acceleration <= max(tops[1], 1024)
    # SP and AC count in 1024 samples; a trapezium takes way/speed + speed/rise, a triangle 2 √(way/rise)
    speed, rise = way.speed / (1024 * period), way.acceleration / (1024 * period) ** 2
    lasts = STEP / speed + speed / rise if speed**2 / rise < STEP else 2 * math.sqrt(STEP / rise)
    assert way.seconds == pytest.approx(lasts + 0.25)  # and rests a quarter of a second
    assert way.commanded(way.seconds / 99, 100)[-1] == STEP


def test_with_them_the_following_error_of_a_move_almost_goes(tmp_path: Path) -> None:
    rig = ready(plants={"X": Plant(inertia=INERTIA, viscous_friction=RUB)})
    before = registers(rig)
    found, way = feeds(AXIS, 1 / 1024), sweep(AXIS, STEP, 1 / 1024, 9.9982, FASTEST)
    wish, more = Wish("X", STEP, Gains(kp=12, kd=200)), Gains(kp=12, kd=200, fv=found.fv, fa=found.fa)
    job = run_moves(rig.controller, wish, way, more, tmp_path, WHEN)
    first: Measured
    first, second = done(rig, job, 60)
    errors = [np.abs(each.response.commanded - each.response.actual).max() for each in (first, second)]
    # without: the torque of the acceleration comes from KP alone, 4 KP (20/65536) V a count
    volts = (way.acceleration + way.speed * AXIS.pole) / AXIS.gain
    assert errors[0] > 0.5 * volts / (4 * 12 * 20 / 65536)
    assert errors[1] < 0.15 * errors[0]
    assert first.response.commanded[-1] == STEP == -second.response.commanded[-1]
    state = rig.simulation.state()["axes"]["X"]
    assert state["commanded"] == 0 and state["motor_on"] and not list(tmp_path.iterdir())
    assert registers(rig) == pytest.approx(before, abs=1e-4)
    assert rig.simulation.unit.state.registers["FA"][0] / ONE == 0  # recommended, not set
