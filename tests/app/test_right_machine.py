"""Another type or serial number than the setup's: nothing is downloaded, executed or burned before it is confirmed."""

from __future__ import annotations

import dataclasses as dc

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.right_machine import TITLE
from codegen.twoletter.fixed import ONE
from device.api import Badge
from tests.rig import Rig
from tests.stage import Stage
from widgets.parts.question import Question

LEAVES = {"download": "DL", "execute": "XQ", "burn": "BP"}
WORDS = {"download": "Download anyway", "execute": "Execute anyway", "burn": "Burn anyway"}


def written_for(stage: Stage, **facts: str) -> None:
    """The open program's setup names this type or this serial number."""
    session = stage.studio.session
    session.set_document(
        dc.replace(session.document, setup=dc.replace(session.document.setup, **facts)), "Change setup"
    )


def machine(stage: Stage, model: str = "", kind: str = "machine", serial: int = 4711) -> Rig:
    """In Control, holding the open program as if it had been downloaded by somebody before."""
    rig = stage.connect(kind, model or stage.studio.model(), program=stage.studio.session.listing.text, answers=False)
    profile = rig.simulation.unit.profile
    rig.simulation.unit.profile = dc.replace(profile, serial_number=serial)
    stage.until(lambda: rig.controller.polling)
    rig.controller.take_control()
    rig.simulation.unit.state.registers["OE"] = [ONE] * len(rig.simulation.model.axes)  # the limits of the setup
    stage.go()
    return rig


def trigger(stage: Stage, name: str) -> None:
    stage.studio.desk.question = None
    stage.studio.actions[name].trigger()
    stage.go(40)


def doubted(stage: Stage) -> Question | None:
    question = stage.studio.desk.question
    return question if question is not None and question.windowTitle() == TITLE else None


def left(rig: Rig) -> set[str]:
    """Which of the three have left for the controller."""
    sent = " ".join(rig.lines)
    return {name for name, command in LEAVES.items() if command in sent.replace("_XQ", "")}


@pytest.mark.parametrize("name", LEAVES)
@pytest.mark.parametrize("facts", [{"serial_number": "4712"}, {"model": "ssc3"}], ids=["serial number", "type"])
def test_on_another_controller_nothing_leaves_before_it_is_confirmed(
    stage: Stage, name: str, facts: dict[str, str]
) -> None:
    rig = machine(stage)
    written_for(stage, **facts)
    trigger(stage, name)
    question = doubted(stage)
    assert question is not None and question.isVisible()
    assert "serial number 4711" in question.words
    assert set(question.buttons) == {WORDS[name]}
    assert left(rig) == set()
    assert rig.running == []


@pytest.mark.parametrize("name", LEAVES)
def test_the_controller_of_the_setup_is_not_asked_about(stage: Stage, name: str) -> None:
    machine(stage)
    written_for(stage, serial_number="4711")
    trigger(stage, name)
    assert doubted(stage) is None


def test_what_was_confirmed_is_not_asked_again(stage: Stage) -> None:
    rig = machine(stage)
    written_for(stage, serial_number="4712")
    trigger(stage, "download")
    question = doubted(stage)
    assert question is not None
    QTest.mouseClick(question.buttons["Download anyway"], Qt.MouseButton.LeftButton)
    stage.until(lambda: rig.controller.program_badge is Badge.SAME and not stage.studio.run.doing)
    trigger(stage, "execute")
    assert doubted(stage) is None
    assert rig.running


def test_another_connection_or_another_setup_is_asked_about_again(stage: Stage) -> None:
    machine(stage)
    written_for(stage, serial_number="4712")
    trigger(stage, "download")
    question = doubted(stage)
    assert question is not None
    QTest.mouseClick(question.buttons["Download anyway"], Qt.MouseButton.LeftButton)
    stage.until(lambda: not stage.studio.run.doing)
    written_for(stage, serial_number="4713")
    trigger(stage, "download")
    assert doubted(stage) is not None
    written_for(stage, serial_number="4712")
    machine(stage)
    trigger(stage, "download")
    assert doubted(stage) is not None


def test_a_confirmation_of_one_controller_is_none_of_the_next(stage: Stage) -> None:
    machine(stage)
    written_for(stage, serial_number="4712")
    trigger(stage, "download")
    question = doubted(stage)
    assert question is not None
    other = machine(stage, serial=4713)  # connected while the question stood there
    QTest.mouseClick(question.buttons["Download anyway"], Qt.MouseButton.LeftButton)
    stage.go(40)
    assert left(other) == set()


def test_a_simulator_of_the_right_type_is_not_asked_for_its_number(stage: Stage) -> None:
    machine(stage, kind="simulator")
    written_for(stage, serial_number="99")
    trigger(stage, "download")
    assert doubted(stage) is None
