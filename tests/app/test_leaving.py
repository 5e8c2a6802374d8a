"""Leaving while a machine works asks first; marks of the running program belong to what was downloaded."""

from __future__ import annotations

import dataclasses as dc

import pytest
from PySide6.QtGui import QCloseEvent
from PySide6.QtWidgets import QPushButton

from codegen.instructions import Wait
from codegen.program import replace
from device.api import Badge, State
from tests.stage import Stage

JOG = "#A\nJG 5000\nBGX\n#B\nJP #B\n"


def answer(stage: Stage, words: str) -> None:
    question = stage.studio.desk.question
    assert question is not None and question.isVisible()
    next(button for button in question.findChildren(QPushButton) if button.text() == words).click()


def close(stage: Stage) -> bool:
    """Whether the window let itself be closed."""
    stage.studio.window.show()
    event = QCloseEvent()
    stage.studio.window.closeEvent(event)
    return event.isAccepted()


def running_machine(stage: Stage) -> None:
    rig = stage.connect("machine", "ssc1", program=JOG)
    rig.controller.take_control()
    rig.controller.execute(anyway=True)
    stage.until(lambda: rig.controller.last().value("moving.x") == 1)


def test_closing_in_mid_move_asks_and_nothing_is_closed(stage: Stage) -> None:
    running_machine(stage)
    assert not close(stage)
    question = stage.studio.desk.question
    assert question is not None and question.isVisible()


def test_stop_and_leave_leaves_only_after_the_confirmed_stop(stage: Stage) -> None:
    running_machine(stage)
    assert not close(stage)
    answer(stage, "Stop and leave")
    assert stage.studio.window.isVisible()
    stage.until(lambda: not stage.studio.window.isVisible())
    state = stage.rig.simulation.state()
    assert not state["axes"]["X"]["moving"]
    assert not any(thread["running"] for thread in state["threads"])


def test_leave_it_running_leaves_the_axis_moving(stage: Stage) -> None:
    running_machine(stage)
    assert not close(stage)
    answer(stage, "Leave it running")
    assert not stage.studio.window.isVisible()
    assert stage.rig.simulation.state()["axes"]["X"]["moving"]


def test_disconnecting_in_mid_move_asks_and_keeps_the_connection(stage: Stage) -> None:
    running_machine(stage)
    for name in ("disconnect", "simulator"):
        machine = stage.controller
        stage.studio.actions[name].trigger()
        assert stage.controller is machine
        question = stage.studio.desk.question
        assert question is not None and question.isVisible()
        question.close()
    stage.studio.actions["disconnect"].trigger()
    answer(stage, "Leave it running")
    assert stage.controller is not machine


def test_a_machine_at_rest_is_left_without_a_question(stage: Stage) -> None:
    stage.connect("machine", "ssc1")
    stage.until(lambda: stage.controller.last().value("moving.x") == 0)
    assert close(stage)


def test_an_edit_during_the_download_does_not_shift_the_marks(stage: Stage) -> None:
    stage.connect("machine", "ssc1")
    stage.controller.take_control()
    sent = stage.studio.session.listing
    stage.studio.run.download()
    stage.go(1)
    assert stage.studio.run.doing
    first = stage.studio.session.document.program.configuration[0]
    stage.studio.session.remove([first.id])
    stage.until(lambda: not stage.studio.run.doing)
    assert stage.controller.program_badge is Badge.CHANGED
    assert stage.studio.program.running is sent
    assert stage.studio.session.listing.text != sent.text


def test_another_document_carries_no_marks_of_the_program_that_runs(stage: Stage) -> None:
    stage.connect("machine", "ssc1")
    stage.download()
    stage.rig.simulation.stimulus("in1", 0)
    stage.studio.run.execute()
    stage.until(lambda: bool(stage.studio.program.delegate.executing))
    document = stage.studio.session.document
    waits = [step for step in document.program.main if isinstance(step.instruction, Wait)]
    other = replace(document.program, dc.replace(waits[0], instruction=Wait(time="500")))
    stage.studio.session.new()
    stage.studio.session.set_document(dc.replace(document, program=other), "Paste")
    stage.go(5)
    assert stage.studio.program.running is None
    assert stage.studio.program.delegate.executing == {}


def test_values_that_are_too_old_do_not_say_that_nothing_moves(stage: Stage, monkeypatch: pytest.MonkeyPatch) -> None:
    controller = stage.connect("machine", "ssc1").controller
    stage.until(lambda: controller.last().value("moving.x") == 0)
    assert stage.studio.leaving.going_on() == ""
    old = controller.last()
    stage.later(10.0)
    monkeypatch.setattr(controller, "last", lambda: old)
    assert controller.state is State.READY
    assert stage.studio.leaving.going_on() == "What the machine does now is not known."
