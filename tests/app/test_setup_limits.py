"""Before a program starts, the controller has the limits of the setup (safety.md, 4), or somebody said otherwise."""

from __future__ import annotations

import dataclasses as dc

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from codegen.twoletter.fixed import ONE
from device.api import StopState
from tests.rig import Rig
from tests.stage import Stage
from widgets.parts.question import Question

TITLE = "The controller's limits are not those of the setup"


def limited(stage: Stage, kind: str) -> Rig:
    """A machine of the wire cutter, in Control, with the program downloaded; its setup has limits."""
    session = stage.studio.session
    setup = session.document.setup
    axis = dc.replace(setup.axis("X"), forward_limit="20", error_limit="1", maximum_speed="10")
    session.set_setup(setup.with_axis("X", axis))
    stage.connect(kind, setup.model)
    return stage.download()


def register(rig: Rig, name: str) -> float:
    return rig.simulation.unit.state.registers[name][0] / ONE


def execute(stage: Stage) -> None:
    stage.studio.desk.question = None
    stage.studio.actions["execute"].trigger()


def asked(stage: Stage) -> Question:
    stage.until(lambda: stage.studio.desk.question is not None)
    question = stage.studio.desk.question
    assert question is not None and question.windowTitle() == TITLE and question.isVisible()
    return question


def press(question: Question, words: str) -> None:
    QTest.mouseClick(question.buttons[words], Qt.MouseButton.LeftButton)


def test_on_a_machine_they_are_shown_and_sent_when_told_to_and_then_asked_no_more(stage: Stage) -> None:
    rig = limited(stage, "machine")
    execute(stage)
    question = asked(stage)
    assert "Forward software limit of X: setup 20 in (FL 12740), controller off" in question.words  # 20 × 637
    assert "Speed of X: setup at most 10 in/s (SP 6370), controller SP 25000" in question.words
    assert rig.running == [] and register(rig, "FL") == 2147483647
    press(question, "Send the limits and execute")
    stage.until(lambda: bool(rig.running))
    assert [register(rig, name) for name in ("FL", "ER", "OE")] == [12740, 637, 1]
    assert register(rig, "SP") <= 6370  # the program may have set its own by now
    assert "BN" not in " ".join(rig.lines).replace("_BN", "")
    stage.studio.actions["halt"].trigger()
    stage.until(lambda: not rig.running)
    stage.go(20)
    execute(stage)
    stage.until(lambda: bool(rig.running))
    assert stage.studio.desk.question is None


@pytest.mark.long
def test_the_controllers_own_limits_can_stay(stage: Stage) -> None:
    rig = limited(stage, "machine")
    execute(stage)
    press(asked(stage), "Execute with the controller's")
    stage.until(lambda: bool(rig.running))
    assert register(rig, "FL") == 2147483647


def test_a_simulator_is_given_them_without_a_question(stage: Stage) -> None:
    rig = limited(stage, "simulator")
    execute(stage)
    stage.until(lambda: bool(rig.running))
    assert stage.studio.desk.question is None
    assert [register(rig, name) for name in ("FL", "OE")] == [12740, 1]
    assert any(text.startswith("Limits of the setup:") for text in stage.studio.messages.texts())


def test_stop_pressed_while_the_limits_are_looked_at_starts_nothing(stage: Stage) -> None:
    rig = limited(stage, "machine")
    execute(stage)
    question = asked(stage)
    stage.controller.stop()
    stage.until(lambda: stage.controller.stop_state is StopState.STOPPED)
    press(question, "Execute with the controller's")
    stage.go(20)
    assert rig.running == [] and "XQ #" not in " ".join(rig.lines)
    assert stage.studio.messages.texts()[-1] == "Not started: STOP was pressed."
