"""The mark “homed”: only after a homing that this studio saw to end, lost with whatever makes the place unknown."""

from __future__ import annotations

import dataclasses as dc

import pytest

from codegen.setup import Axis, MotorType
from device.api import State, StopState
from tests.rig import Rig
from tests.stage import Stage


def ready(stage: Stage, kind: str = "machine") -> Rig:
    """A machine with Control whose stop codes have been read once, the display in front."""
    rig = stage.connect(kind, "ssc2")
    rig.controller.take_control()
    stage.studio.desk.arrange("Run")
    stage.later(1.5)
    stage.go(30)
    return rig


def mark(stage: Stage, letter: str = "X") -> str:
    return stage.studio.display.axes[letter].homed.text()


def why(stage: Stage, letter: str = "X") -> str:
    return stage.studio.display.axes[letter].homed.toolTip()


def settle(stage: Stage) -> None:
    """Slow values are read once a second (device/poll.py)."""
    stage.later(1.5)
    stage.go(40)


def home(stage: Stage) -> Rig:
    """X looks for its edge and finds it (dmc-1412-1414.txt, FE: stops at the transition of the home input)."""
    rig = ready(stage)
    stage.type("JG 2000,2000", "FE X", "BG X")
    stage.until(lambda: rig.moving == ["X"])
    stage.later(1.5)
    stage.go(40)
    rig.simulation.stimulus("home_x", 0)
    stage.until(lambda: rig.moving == [])
    settle(stage)
    return rig


def test_nothing_is_homed_that_was_not_seen_to_be(stage: Stage) -> None:
    ready(stage)
    assert mark(stage) == "○ not homed"
    assert "has not seen it homed" in why(stage)
    assert "The controller keeps no such mark" in why(stage)


def test_an_edge_that_was_found_is_a_homing_that_was_seen_to_end(stage: Stage) -> None:
    home(stage)
    assert mark(stage) == "● homed"
    assert mark(stage, "Y") == "○ not homed"
    assert "found its edge (FE), seen at" in why(stage)
    stage.type("PR 100", "BG X")  # an ordinary move afterwards changes nothing
    settle(stage)
    assert mark(stage) == "● homed"


def test_homing_over_its_three_stages(stage: Stage) -> None:
    rig = ready(stage)
    stage.type("JG 2000", "HM X", "BG X")
    stage.until(lambda: rig.moving == ["X"])
    stage.later(1.5)
    stage.go(40)
    rig.simulation.stimulus("home_x", 0)  # to the switch, back off slowly, then to the index (dmc-1412-1414.txt, HM)
    stage.later(1.0)
    assert mark(stage) == "○ not homed"
    rig.simulation.stimulus("home_x", 1)
    stage.until(lambda: rig.moving == [])
    settle(stage)
    assert mark(stage) == "● homed"
    assert "was homed (HM, FI)" in why(stage)


def test_a_homing_that_was_stopped_is_none(stage: Stage) -> None:
    rig = ready(stage)
    stage.type("JG 2000", "FE X", "BG X")
    stage.until(lambda: rig.moving == ["X"])
    stage.controller.stop()
    stage.until(lambda: stage.controller.stop_state is StopState.STOPPED)
    settle(stage)
    assert mark(stage) == "○ not homed"


def test_a_homing_that_ended_at_a_limit_is_none(stage: Stage) -> None:
    rig = ready(stage)
    stage.type("JG 2000", "FE X", "BG X")
    stage.until(lambda: rig.moving == ["X"])
    rig.simulation.stimulus("fls_x", 0)
    rig.simulation.stimulus("rls_x", 0)
    stage.until(lambda: rig.moving == [])
    settle(stage)
    assert mark(stage) == "○ not homed"


def test_a_reset_takes_the_mark(stage: Stage) -> None:
    rig = home(stage)
    rig.simulation.stimulus("reset", 0)
    stage.until(lambda: mark(stage) == "○ not homed")
    assert "restarted" in why(stage)


def test_a_lost_connection_takes_the_mark_and_it_does_not_come_back_by_itself(stage: Stage) -> None:
    rig = home(stage)
    rig.cut()
    stage.until(lambda: stage.controller.state is State.LOST)
    stage.go()
    assert mark(stage) == "○ not homed"
    assert "connection was lost" in why(stage)
    rig.loopback.unplugged = False
    stage.until(lambda: stage.controller.state is State.READY)
    settle(stage)  # the stop code still tells of the homing; what happened meanwhile it does not tell
    assert mark(stage) == "○ not homed"


def test_a_position_defined_by_hand_takes_the_mark_of_that_axis(stage: Stage) -> None:
    home(stage)
    stage.type("DP ,500")
    settle(stage)
    assert mark(stage) == "● homed"
    stage.type("DP 500")
    settle(stage)
    assert mark(stage) == "○ not homed"
    assert "(DP)" in why(stage)


@pytest.mark.parametrize("motor", [MotorType.SERVO, MotorType.STEPPER_LOW])
def test_a_stepper_that_is_switched_off_may_be_anywhere(stage: Stage, motor: MotorType) -> None:
    session = stage.studio.session
    session.set_setup(session.document.setup.with_axis("X", dc.replace(Axis(), motor=motor)))
    home(stage)
    assert mark(stage) == "● homed"
    stage.type("MO X")
    settle(stage)
    assert mark(stage) == ("● homed" if motor is MotorType.SERVO else "○ not homed")


def test_another_controller_starts_without_marks(stage: Stage) -> None:
    home(stage)
    ready(stage)
    assert mark(stage) == "○ not homed"


def test_a_person_can_say_what_they_know(stage: Stage) -> None:
    rig = ready(stage)
    actions = stage.studio.display.axes["X"].homed.actions()
    actions[0].trigger()
    stage.go()
    assert mark(stage) == "● homed"
    assert "you said so" in why(stage)
    actions[1].trigger()
    stage.go()
    assert mark(stage) == "○ not homed"
    assert rig.sent(r"(?!MG\{\^30\})") == []  # nothing but framed reads
