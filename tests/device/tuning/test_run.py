"""Steps, automatic tuning and excitations over the simulator's byte stream, between their guards."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.twoletter.fixed import ONE
from device.download import Job
from device.simulator.plant import Plant
from device.tasks import NotAllowed, Stopped
from device.tuning.automatic import VELOCITY
from device.tuning.bench import Measured, Wish
from device.tuning.excite import NotIdentified
from device.tuning.guards import Cancelled, Fault
from device.tuning.loop import Gains
from device.tuning.run import burn, read_present, run_automatic, run_excitation, run_step, use_gains
from tests.device.tuning.test_guards import WHEN
from tests.long import is_long
from tests.rig import Rig

FACTORY = {"KP": 6.0, "KI": 0.0, "KD": 64.0}
GOOD = Gains(kp=6, ki=0, kd=64)


def ready(kind: str = "simulator", model: str = "ssc2", **more: Any) -> Rig:
    rig = Rig(kind, model, **more).ready()
    rig.controller.take_control()
    rig.type("SH")
    return rig


def done(rig: Rig, job: Job[Any], seconds: float = 60.0) -> Any:
    rig.until(job.future.done, seconds)
    return job.future.result()


def held(rig: Rig, axis: int = 0) -> dict[str, float]:
    registers = rig.simulation.unit.state.registers
    return {name: registers[name][axis] / ONE for name in FACTORY}


@pytest.mark.parametrize(("model", "axis"), [("ssc2", "Y"), ("dmc1412", "X")])
def test_a_step_is_recorded_measured_and_taken_back(tmp_path: Path, model: str, axis: str) -> None:
    rig = ready(model=model)
    measured: Measured = done(rig, run_step(rig.controller, Wish(axis, 400, Gains(kp=10, kd=100)), tmp_path, WHEN))
    response = measured.response
    assert response.commanded[0] == 0 and response.commanded[-1] == 400
    assert abs(response.actual[0]) <= 2 and abs(response.actual[-1] - 400) <= 4
    assert measured.metrics is not None and measured.metrics.step == 400
    assert measured.metrics.settling_time is not None and 0.005 < measured.metrics.settling_time < 0.4
    assert np.abs(response.volts).max() <= 10.001
    assert held(rig) == FACTORY and not list(tmp_path.iterdir())
    state = rig.simulation.state()["axes"][axis]
    assert state["commanded"] == 0 and state["motor_on"] and not rig.moving
    assert any(f"KP{axis}=10" in line for line in rig.lines)


def test_gains_that_run_away_end_with_the_motor_off_and_the_former_gains(tmp_path: Path) -> None:
    rig = ready()
    with pytest.raises(Fault, match="went off"):
        done(rig, run_step(rig.controller, Wish("X", 300, Gains(kp=1000, kd=0, ki=100)), tmp_path, WHEN))
    assert held(rig) == FACTORY and not rig.simulation.state()["axes"]["X"]["motor_on"]


def test_a_switch_that_is_met_ends_the_run(tmp_path: Path) -> None:
    rig = ready()
    job = run_step(rig.controller, Wish("X", 300, GOOD), tmp_path, WHEN)
    rig.until(lambda: abs(rig.simulation.state()["axes"]["X"]["actual"]) > 100)
    rig.simulation.stimulus("fls_x", 0)
    with pytest.raises(Fault, match="Axis X met its forward limit switch"):
        done(rig, job)
    assert held(rig) == FACTORY and not rig.moving and not list(tmp_path.iterdir())


def test_a_step_that_no_error_limit_can_hold_is_refused(tmp_path: Path) -> None:
    rig = ready()
    for step in (0, 3, 30_000):
        with pytest.raises(NotAllowed, match="4 to 20000"):
            done(rig, run_step(rig.controller, Wish("X", step, GOOD), tmp_path, WHEN))
    assert not rig.sent("OE|KP")


def test_stop_in_the_middle_ends_it_and_cancel_too(tmp_path: Path) -> None:
    rig = ready("machine")
    job = run_step(rig.controller, Wish("X", 400, Gains(kp=10, kd=100), seconds=2.0), tmp_path, WHEN)
    rig.until(lambda: abs(rig.simulation.state()["axes"]["X"]["actual"]) > 100)
    rig.controller.stop()
    with pytest.raises(Stopped, match="former values of axis X are back"):
        done(rig, job)
    assert held(rig) == FACTORY and not rig.moving and not list(tmp_path.iterdir())
    job = run_step(rig.controller, Wish("X", 400, Gains(kp=10, kd=100), seconds=2.0), tmp_path, WHEN)
    rig.until(lambda: abs(rig.simulation.state()["axes"]["X"]["actual"]) > 100)
    job.cancel()
    with pytest.raises(Cancelled):
        done(rig, job)
    assert held(rig) == FACTORY and not list(tmp_path.iterdir())


def test_stop_while_the_record_is_read_ends_the_trials(tmp_path: Path) -> None:
    rig = ready("machine")
    told: list[Measured] = []
    job = run_automatic(
        rig.controller, Wish("X", 400, GOOD), tmp_path, WHEN, lambda m, why: told.append(m), velocity=False
    )
    rig.until(lambda: any(line.startswith("QU") for line in rig.lines))
    rig.controller.stop()
    with pytest.raises(Stopped):
        done(rig, job)
    assert len(told) == 0 and held(rig) == FACTORY and not rig.moving and not list(tmp_path.iterdir())


def test_automatic_tuning_makes_it_better_and_puts_the_former_gains_back(tmp_path: Path) -> None:
    rig = ready()
    rig.type("KPX=20;KDX=400")  # not from the very beginning
    told: list[tuple[Measured, str]] = []
    wish = Wish("X", 400, GOOD, seconds=0.4)
    found = done(
        rig,
        run_automatic(rig.controller, wish, tmp_path, WHEN, lambda m, why: told.append((m, why)), velocity=False),
        400,
    )
    assert found.gains is not None, found.words
    assert len(told) == len(found.trials) >= 4 and all(why for _, why in told)
    assert found.gains.kd >= 400 and found.gains.kp > 20  # KD and KP went up (ssc-tol-o-motion.txt l.2938)
    assert held(rig) == {"KP": 20, "KI": 0, "KD": 400}  # recommended, not set
    first = told[0][0].metrics
    best = done(rig, run_step(rig.controller, Wish("X", 400, found.gains, seconds=0.4), tmp_path, WHEN))
    assert first is not None and best.metrics is not None and best.metrics.settling_time is not None
    assert best.metrics.settling_time < (first.settling_time or 1.0) and not best.vibrates


@pytest.mark.long
@pytest.mark.parametrize(("gravity", "ki"), [(0.5, 0.0), (-0.5, 0.0), (0.5, 1.0)])
def test_an_axis_that_hangs_is_tuned_and_gets_an_integrator(tmp_path: Path, gravity: float, ki: float) -> None:
    """With KP 6 and KI 0 half a volt is 68 counts of sag: no step of 500 would settle; KI comes last (l.887)."""
    rig = ready(plants={"X": Plant(gravity=gravity)})
    rig.type(f"KI {ki:g}")
    rig.run(2.0)
    wish = Wish("X", 500, GOOD, seconds=0.5)
    found = done(rig, run_automatic(rig.controller, wish, tmp_path, WHEN, lambda m, why: None, velocity=False), 400)
    assert found.gains is not None and found.gains.ki > 0 and found.gains.kp > 6, found.words
    best = done(rig, run_step(rig.controller, Wish("X", 500, found.gains, seconds=1.0), tmp_path, WHEN))
    assert best.metrics is not None and best.metrics.settling_time is not None and not best.vibrates
    assert abs(best.metrics.steady_error) <= 1
    assert held(rig) == {**FACTORY, "KI": ki} and rig.simulation.state()["axes"]["X"]["motor_on"]


def test_a_hanging_axis_is_drawn_where_it_hangs_before_its_step(tmp_path: Path) -> None:
    rig = ready(plants={"X": Plant(gravity=0.5)})
    rig.run(1.0)
    measured: Measured = done(rig, run_step(rig.controller, Wish("X", 400, Gains(kp=8, kd=100)), tmp_path, WHEN))
    sag = 0.5 / (4 * 8 * 20 / 65536)  # l.4454-4476: counts at which KP 8 makes half a volt
    assert -measured.response.actual[0] == pytest.approx(sag, abs=2)
    assert measured.response.volts[0] == pytest.approx(0.5, abs=0.1)  # KP and KD make 0.13 V of a count
    assert measured.metrics is not None and measured.metrics.steady_error == pytest.approx(sag, abs=2)
    assert "weight or friction" in measured.words


@pytest.mark.parametrize(("step", "gravity"), [(10, 0.5), (-40, 0.5), (10, -0.5), (200, 3.0)])
def test_the_guards_do_not_drop_what_hangs(tmp_path: Path, step: int, gravity: float) -> None:
    """With KP 6 half a volt hangs 68 counts below its place, three volts 410: further than 1.5 times such a step."""
    rig = ready(plants={"X": Plant(gravity=gravity)})
    rig.run(1.0)
    done(rig, run_step(rig.controller, Wish("X", step, GOOD, seconds=0.3), tmp_path, WHEN))
    state = rig.simulation.state()["axes"]["X"]
    assert state["motor_on"] and abs(state["error"]) == pytest.approx(abs(gravity) / (24 * 20 / 65536), abs=3)


def test_gains_and_limits_that_would_drop_it_are_refused_and_nothing_falls(tmp_path: Path) -> None:
    rig = ready(plants={"X": Plant(gravity=0.5)})
    rig.run(1.0)
    place = rig.simulation.state()["axes"]["X"]["actual"]
    for wish, says in (
        # 0.5 V by KP 1: 410 counts, and the step of 300; ER is 1.5 steps, 10, and twice the 68 counts of now
        (Wish("X", 300, Gains(kp=1)), "With KP 1 it would hang 4.. counts .* error limit of 59. counts"),
        (
            Wish("X", 300, GOOD, torque=0.4),
            "needs 0.5. V to stay where it is; a torque limit of 0.40 V would not hold it",
        ),
    ):
        with pytest.raises(NotAllowed, match=says):
            done(rig, run_step(rig.controller, wish, tmp_path, WHEN))
        assert rig.simulation.state()["axes"]["X"]["motor_on"] and held(rig) == FACTORY
        assert rig.simulation.state()["axes"]["X"]["actual"] == pytest.approx(place, abs=3)
    assert not list(tmp_path.iterdir())


def test_never_on_a_drive_in_velocity_mode(tmp_path: Path) -> None:
    rig = ready()
    job = run_automatic(rig.controller, Wish("X", 400, GOOD), tmp_path, WHEN, lambda m, why: None, velocity=True)
    with pytest.raises(NotAllowed, match="do not perform an auto tune"):
        done(rig, job)
    assert "proceed to manual tuning" in VELOCITY and not rig.sent("OE|KP")


@pytest.mark.skipif(not is_long(), reason="the window's own test does it in the everyday run")
def test_an_excitation_stays_within_the_step(tmp_path: Path) -> None:
    rig = ready()
    furthest: list[float] = []
    job = run_excitation(rig.controller, Wish("X", 200, GOOD), tmp_path, WHEN)
    while not job.future.done():
        rig.run(0.02)
        furthest.append(abs(rig.simulation.state()["axes"]["X"]["commanded"]))
    excited = job.future.result()
    assert not isinstance(excited.recording, NotIdentified), excited.recording
    assert 4 <= max(furthest) <= 200
    assert len(excited.recording.error) >= 64 and np.ptp(excited.recording.error) > 4
    assert held(rig) == FACTORY and not list(tmp_path.iterdir())


def test_gains_are_used_and_burned_only_when_asked(tmp_path: Path) -> None:
    rig = ready()
    present = rig.result(read_present(rig.controller, "X"))
    assert (present.gains.kp, present.gains.kd, present.motor_on, present.dual) == (6, 64, True, False)
    assert "nothing was burned" in rig.result(use_gains(rig.controller, "X", Gains(kp=12.5, ki=0.25, kd=90)))
    assert held(rig) == {"KP": 12.5, "KI": 0.25, "KD": 90}
    assert not rig.sent("BN")
    assert rig.result(burn(rig.controller, "X", Gains(kp=13, kd=90))).accepted
    assert held(rig)["KP"] == 13 and rig.sent("BN")
