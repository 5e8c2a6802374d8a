"""Connecting to a machine that works already: what it does is listed, and nothing is changed."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.found_working import TITLE
from device.api import StopState
from tests.rig import Rig
from tests.stage import Stage
from widgets.parts.question import Question

PROGRAM = "#A\nJG 5000\nBG X\nAM X\nEN\n#B\nWT 100\nJP #B\nEN"


def meet(stage: Stage, program: str = PROGRAM, *threads: str, model: str = "ssc2", kind: str = "machine") -> Rig:
    """A machine whose threads were started before anybody connected."""
    rig = stage.connect(kind, model, answers=False, program=program)
    for number, label in enumerate(threads):
        rig.simulation.execute(label, number)
    stage.until(
        lambda: (
            rig.controller.polling and rig.controller.last().value("thread0") == rig.controller.last().value("thread0")
        )
    )
    stage.go(30)
    return rig


def told(stage: Stage) -> Question:
    question = stage.studio.desk.question
    assert question is not None and question.isVisible()
    assert question.windowTitle() == TITLE
    return question


def test_what_runs_and_moves_is_listed_with_its_line_and_its_code(stage: Stage) -> None:
    meet(stage, PROGRAM, "#A", "#B")
    words = told(stage).words.splitlines()
    assert words[0] == "▲  Thread 0: line 3, waiting: after move (AM X)"
    assert words[1].startswith("▲  Thread 1: line ")
    assert words[2] == "▲  X moves."
    assert "Since when" in words[3]


def test_looking_has_changed_nothing(stage: Stage) -> None:
    rig = meet(stage, PROGRAM, "#A", "#B")
    told(stage)
    assert rig.moving == ["X"] and len(rig.running) == 2
    assert not rig.controller.control
    assert rig.sent(r"(?!MG|UL)") == []


def test_going_on_watching_leaves_everything_as_it_is(stage: Stage) -> None:
    rig = meet(stage, PROGRAM, "#A")
    QTest.mouseClick(told(stage).buttons["Go on watching"], Qt.MouseButton.LeftButton)
    stage.go(30)
    assert rig.moving == ["X"] and rig.stops == []
    assert stage.studio.desk.question is not None
    assert not _open(stage)


def test_stop_everything_stops_everything(stage: Stage) -> None:
    rig = meet(stage, PROGRAM, "#A", "#B")
    QTest.mouseClick(told(stage).buttons["Stop everything"], Qt.MouseButton.LeftButton)
    stage.until(lambda: rig.controller.stop_state is StopState.STOPPED)
    assert rig.moving == [] and rig.running == []


def test_its_program_is_read_on_request(stage: Stage) -> None:
    meet(stage, PROGRAM, "#A")
    QTest.mouseClick(told(stage).buttons["Read its program"], Qt.MouseButton.LeftButton)
    stage.until(lambda: stage.studio.desk.upload is not None)
    assert stage.studio.desk.upload is not None
    assert "JG 5000" in stage.studio.desk.upload.text


def test_a_coordinated_motion_is_listed(stage: Stage) -> None:
    meet(stage, "#A\nVS 500\nLM XY\nLI 90000,90000\nLE\nBG S\nEN", "#A")
    assert told(stage).words.splitlines()[0] == "▲  X Y move on a common path."


def test_a_machine_at_rest_is_met_without_a_word(stage: Stage) -> None:
    meet(stage)
    assert stage.studio.desk.question is None


def test_of_a_simulator_nothing_is_said(stage: Stage) -> None:
    meet(stage, PROGRAM, "#A", kind="simulator")
    assert stage.studio.desk.question is None


def _open(stage: Stage) -> bool:
    question = stage.studio.desk.question
    try:
        return question is not None and question.isVisible()
    except RuntimeError:  # Qt's half has gone
        return False
