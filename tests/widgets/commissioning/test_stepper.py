"""A stepper is brought to life by mouse and keys: no loop, no encoder needed, the person says what turned."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtTest import QTest

from codegen.setup_axis import MotorType
from codegen.twoletter.fixed import ONE
from device.commissioning.record import Verdict
from device.simulator.plant import Drive
from tests.stage import Stage
from tests.widgets.commissioning.person import LEFT, Person

MOST = 2000  # counts
DIRECTION = 4  # steps in front of it


def registers(stage: Stage, *names: str) -> list[float]:
    held = stage.rig.simulation.unit.state.registers
    return [held[name][0] / ONE for name in names]


@pytest.mark.parametrize("model", ["ssc2", pytest.param("dmc1412", marks=pytest.mark.long)])
def test_a_stepper_through_the_whole_list(stage: Stage, model: str, tmp_path: Path) -> None:
    person = Person(stage, model, drive=Drive.STEPPER)
    assert [step.key for step in person.desk.steps] == [
        "safety", "encoder", "switches", "stepper", "direction", "scale", "limits", "burn",
    ]  # fmt: skip
    person.safety()
    person.next()
    QTest.mouseClick(person.window.skip, LEFT)  # it has no encoder (dmc-1412-1414.txt l.601)
    assert person.finding("encoder")[0] is Verdict.SKIPPED and person.desk.step.key == "switches"
    person.switches()
    person.next()
    person.type("kind", MotorType.STEPPER_HIGH.value)
    person.type("smoothing", "4")
    person.press("stepper")
    assert person.finding("stepper") == (Verdict.PASSED, "Set and read back: MT -2, KS 4.")
    assert registers(stage, "MT", "KS") == [-2, 4]  # l.2126: high
    person.press("take_stepper")
    axis = stage.studio.session.document.setup.axis("X")
    assert (axis.motor, axis.smoothing) == (MotorType.STEPPER_HIGH, "4")
    person.next()
    start = person.place
    person.press("pulses")
    assert person.place - start == 300 and "300 pulses were sent. Which way" in person.finding("direction")[1]
    assert registers(stage, "SP", "OE")[0] == 25000  # as it was
    person.press("turned_forward")
    assert person.finding("direction")[0] is Verdict.PASSED
    person.next()
    person.type("distance", "0.5")
    person.press("scale")
    person.type("measured", "0.25")
    person.press("measured")
    assert "2000 counts in 1 mm were measured" in person.finding("scale")[1]
    person.press("take_scale")
    assert stage.studio.session.document.setup.axis("X").counts_per_unit == "2000"
    assert person.finding("scale")[0] is Verdict.PASSED
    person.next()
    assert set(person.window.page.fields) == {"forward", "reverse"}  # nothing limits the force of a stepper
    person.type("forward", "100")
    person.type("reverse", "-5")
    person.press("limits")
    assert registers(stage, "FL", "BL") == [200_000, -10_000]
    person.press("take_limits")
    person.next()
    person.press("burn")
    assert stage.studio.desk.question is not None
    QTest.mouseClick(stage.studio.desk.question.buttons["Write to EEPROM"], LEFT)
    person.settle()
    verdicts = {key: finding.verdict for key, finding in person.desk.record.findings.items()}
    assert verdicts.pop("encoder") is Verdict.SKIPPED and set(verdicts.values()) == {Verdict.PASSED}
    assert person.furthest < MOST
    assert not stage.rig.simulation.state()["axes"]["X"]["motor_on"]
    QTest.mouseClick(person.window.report, LEFT)
    assert person.desk.preview is not None
    text = person.desk.preview.pages.toPlainText()
    assert "7 of 8 steps passed" in text and "Sent: 300 pulses" in text


@pytest.mark.parametrize(
    ("answer", "words"),
    [
        ("turned_backward", "the other way than the one called forward"),
        pytest.param("turned_not", "did not turn", marks=pytest.mark.long),
    ],
)
def test_what_was_seen_of_the_motor(stage: Stage, answer: str, words: str) -> None:
    person = Person(stage, done=DIRECTION, drive=Drive.STEPPER)
    stage.type("MT 2")
    assert not person.window.page.acts[answer].isEnabled()
    person.press("pulses")
    person.press(answer)
    verdict, sentence = person.finding("direction")
    assert verdict is Verdict.FAILED and words in sentence
    assert person.furthest == 300
    assert person.window.page.result.links.isVisible()


def test_a_stepper_without_its_jumper(stage: Stage) -> None:
    """Error 96 (commands.md, MT; SSC manual l.772): a servo to the controller, whatever the setup says."""
    person = Person(stage, done=DIRECTION, drive=Drive.STEPPER)
    stage.rig.simulation.unit.stepper_jumpers = [False, False]
    person.press("pulses")
    assert "drives axis X as a servo (MT 1), the setup says stepper" in person.finding("direction")[1]
    person.desk.choose(3)
    stage.go(2)
    person.press("stepper")
    verdict, sentence = person.finding("stepper")
    assert verdict is Verdict.FAILED and "SM jumper is not set (error 96)" in sentence
    assert person.furthest == 0


@pytest.mark.long
def test_a_stepper_at_its_limit_switch(stage: Stage) -> None:
    person = Person(stage, done=DIRECTION, drive=Drive.STEPPER)
    stage.type("MT 2")
    stage.rig.simulation.stimulus("fls_x", 0)
    person.press("pulses")
    verdict, sentence = person.finding("direction")
    assert verdict is not Verdict.PASSED and "limit" in sentence
    assert person.furthest < 300
