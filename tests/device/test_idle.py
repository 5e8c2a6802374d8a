"""Control is given back when nothing is done for a while; not while something goes on that a person began."""

from __future__ import annotations

from datetime import datetime
from pathlib import Path

from device.capture import Channel, Plan, Trigger, When
from device.capturing import capture
from device.tuning.bench import Wish
from device.tuning.loop import Gains
from device.tuning.run import run_step
from tests.rig import Rig

IDLE_S = 0.7


def machine() -> Rig:
    rig = Rig("machine", "ssc2", idle_limit_s=IDLE_S).ready()
    rig.controller.take_control()
    rig.controller.watch("display", ("position.x", "inputs"))
    rig.type("SH")
    return rig


def falls_back(rig: Rig) -> bool:
    """Nobody does anything any more."""
    rig.run(IDLE_S + 1)
    return not rig.controller.control


def test_a_tuning_run_is_not_broken_off(tmp_path: Path) -> None:
    """Else its trial gains stayed in the controller, where Watch lets nobody put the former ones back."""
    rig = machine()
    wish = Wish("X", 400, Gains(kp=20, ki=0, kd=150, fv=0, fa=0), 5.0, 1.0)
    job = run_step(rig.controller, wish, tmp_path, datetime(2026, 11, 23))
    rig.until(job.future.done, 60.0)
    assert job.future.result().metrics is not None and not list(tmp_path.iterdir())
    assert rig.controller.control and falls_back(rig)


def test_a_capture_waits_for_its_trigger_as_long_as_it_takes() -> None:
    rig = machine()
    plan = Plan(
        (Channel("inputs"), Channel("position", "X")), 4, 40, trigger=Trigger(When.INPUT, number=1, rising=False)
    )
    job = capture(rig.controller, plan)
    rig.run(3 * IDLE_S)
    assert not job.future.done() and rig.controller.control
    rig.simulation.stimulus("in1", 0)
    assert rig.result(job.future).complete
    assert rig.controller.control and falls_back(rig)


def test_watching_and_reading_keep_nothing() -> None:
    rig = machine()
    for _ in range(6):
        rig.run(IDLE_S / 3)
        rig.controller.read("_TPX")  # as a window does that shows values
    assert falls_back(rig)
