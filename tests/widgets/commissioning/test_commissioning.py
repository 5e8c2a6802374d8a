"""An axis is brought to life by mouse and keys, with the simulated machine under the person's hands."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QLineEdit

from device.api import Kind, State
from device.commissioning.record import Verdict
from device.commissioning.steps import steps_for
from tests.stage import Stage
from tests.widgets.commissioning.person import LEFT, Person

MOST = 2000  # counts
POLARITY = 4  # steps in front of it


def to_polarity(person: Person) -> None:
    for step in (person.safety, person.encoder, person.switches, person.guards):
        step()
        assert person.finding(person.desk.step.key)[0] is Verdict.PASSED, (
            person.desk.step.key,
            person.window.words(),
            person.desk.switches,
        )
        person.next()


@pytest.mark.parametrize("model", ["ssc2", pytest.param("dmc1412", marks=pytest.mark.long)])
def test_a_healthy_axis_through_the_whole_list(stage: Stage, model: str, tmp_path: Path) -> None:
    person = Person(stage, model)
    to_polarity(person)
    person.furthest = 0.0
    person.press("polarity")
    assert "Did it go the way" in person.finding("polarity")[1]
    person.press("forward")
    person.next()
    person.type("distance", "0.5")
    person.press("scale")
    person.type("measured", "0.5")
    person.press("measured")
    assert "The scale is right" in person.finding("scale")[1]
    person.next()
    person.type("forward", "200")
    person.type("reverse", "-5")
    person.press("limits")
    person.press("take_limits")
    assert stage.studio.session.document.setup.axis("X").forward_limit == "200"
    person.next()
    person.press("burn")
    assert stage.studio.desk.question is not None
    assert "next power-up" in stage.studio.desk.question.words
    QTest.mouseClick(stage.studio.desk.question.buttons["Write to EEPROM"], LEFT)
    person.settle()
    assert [finding.verdict for finding in person.desk.record.findings.values()] == [Verdict.PASSED] * 8
    assert 400 < person.furthest < MOST
    registers = stage.rig.simulation.unit.state.registers
    assert registers["FL"][0] // 65536 == 200_000  # 200 mm of 1000 counts
    QTest.mouseClick(person.window.report, LEFT)
    assert person.desk.preview is not None
    text = person.desk.preview.pages.toPlainText()
    assert "8 of 8 steps passed" in text and "Commissioned by" in text
    person.desk.preview.save(tmp_path / "report.pdf")
    assert (tmp_path / "report.pdf").read_bytes().startswith(b"%PDF")


def test_a_motor_that_is_wired_wrong(stage: Stage) -> None:
    person = Person(stage, done=POLARITY, motor_reversed=True)
    person.press("polarity")
    verdict, sentence = person.finding("polarity")
    assert verdict is Verdict.FAILED and "Wrong polarity" in sentence
    assert "Wrong polarity" in person.window.words()
    assert person.furthest < MOST
    assert not person.window.page.acts["forward"].isEnabled()
    assert person.window.page.result.links.isVisible()
    person.window.page.help_wanted.emit("Troubleshooting")
    assert stage.studio.desk.help is not None and stage.studio.desk.help.isVisible()


def test_an_encoder_with_a_dead_channel_and_one_with_another_scale(stage: Stage) -> None:
    person = Person(stage, done=1, dead_channel="b")
    person.off()
    person.encoder(2165)  # strokes of 433 counts: another quarter of a line each time
    assert "toggles by one count" in person.finding("encoder")[1]
    person.desk.choose(4)
    stage.go(2)
    button = person.window.page.acts["polarity"]
    assert not button.isEnabled() and "Encoder by hand" in button.toolTip()
    person = Person(stage, done=1)
    person.off()
    person.encoder(20_000, "5")
    verdict, sentence = person.finding("encoder")
    assert verdict is Verdict.FAILED and "4000 counts in 1 mm were measured" in sentence
    person.press("take_scale")
    assert stage.studio.session.document.setup.axis("X").counts_per_unit == "4000"
    assert person.finding("encoder")[0] is Verdict.PASSED


def test_a_home_switch_that_is_stuck(stage: Stage) -> None:
    person = Person(stage, done=2, home_stuck=True)
    person.switches("fls_x", "rls_x")
    person.trip("home_x")
    person.press("nothing")
    verdict, sentence = person.finding("switches")
    assert verdict is Verdict.FAILED and "home input did not change" in sentence
    assert person.furthest == 0


def test_the_list_is_taken_up_where_it_was_left_and_watch_sends_nothing(stage: Stage) -> None:
    person = Person(stage, kind=Kind.MACHINE)
    person.safety()
    person.next()
    person.type("distance", "2,5")
    person.press("begin_encoder")
    stage.until(lambda: person.window.page.acts["encoder"].isEnabled())
    person.press("encoder")
    QTest.mouseClick(person.window.close_, LEFT)
    stage.go(2)
    stage.studio.actions["commissioning"].trigger()
    stage.go(5)
    assert person.desk.step.key == "encoder"
    assert person.finding("safety")[0] is Verdict.PASSED
    field = person.window.page.fields["distance"]
    assert isinstance(field, QLineEdit) and field.text() == "2,5"
    stage.controller.release_control()
    stage.go(3)
    assert person.window.page.acts["begin_encoder"].isEnabled()  # it sends nothing
    person.desk.choose(0)
    assert "Control" in person.window.page.acts["off"].toolTip()
    stage.studio.connection.go_offline()
    stage.go(3)
    assert not person.window.page.acts["off"].isEnabled()


def test_stop_ends_the_step_and_everything_is_put_back(stage: Stage, tmp_path: Path) -> None:
    person = Person(stage, kind=Kind.MACHINE, done=POLARITY)
    person.type("counts", "600")
    before = stage.rig.simulation.unit.state.registers["SP"][0]
    QTest.mouseClick(person.window.page.acts["polarity"], LEFT)
    start = person.place
    stage.until(lambda: abs(person.place - start) > 100)
    assert list((tmp_path / "commissioning").glob("*.before-tuning"))
    QTest.mouseClick(person.window.stop, LEFT)
    stage.until(lambda: not person.desk.busy)
    stage.go(30)
    assert abs(person.place - start) < MOST
    assert "STOP" in person.finding("polarity")[1]
    assert stage.rig.simulation.unit.state.registers["SP"][0] == before
    assert not list((tmp_path / "commissioning").glob("*.before-tuning"))
    assert not stage.rig.simulation.state()["axes"]["X"]["motor_on"]


def test_what_an_interrupted_step_left_is_offered(stage: Stage, tmp_path: Path) -> None:
    person = Person(stage, kind=Kind.MACHINE, done=POLARITY)
    person.type("counts", "600")
    before = stage.rig.simulation.unit.state.registers["SP"][0]
    QTest.mouseClick(person.window.page.acts["polarity"], LEFT)
    start = person.place
    stage.until(lambda: abs(person.place - start) > 100)
    stage.rig.cut()
    stage.until(lambda: not person.desk.busy)
    stage.later(3.0)
    assert abs(person.place - start) < MOST
    assert stage.rig.simulation.unit.state.registers["SP"][0] != before
    stage.rig.loopback.unplugged = False
    stage.until(lambda: stage.controller.state is State.READY)
    stage.until(lambda: stage.studio.desk.question is not None)  # first thing, in Watch
    question = stage.studio.desk.question
    assert question is not None and "commissioning of axis X that began on" in question.words
    assert "Before it:" in question.words and "switches the motor off" in question.words
    QTest.mouseClick(question.buttons["Take Control and put them back"], LEFT)
    stage.until(lambda: not list((tmp_path / "commissioning").glob("*.before-tuning")))
    assert stage.rig.simulation.unit.state.registers["SP"][0] == before


def test_a_question_left_open_does_nothing_after_stop(stage: Stage) -> None:
    person = Person(stage, done=len(steps_for(False, False)) - 1)
    person.desk.choose(len(person.desk.steps) - 1)
    stage.go(2)
    person.press("burn")
    question = stage.studio.desk.question
    assert question is not None
    QTest.mouseClick(person.window.stop, LEFT)
    stage.go(20)
    QTest.mouseClick(question.buttons["Write to EEPROM"], LEFT)
    stage.go(20)
    assert not stage.rig.sent("BN") and person.finding("burn")[0] is Verdict.OPEN
