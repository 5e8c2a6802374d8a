"""After a kill several things want an answer, one after the other: what was there before it first (safety.md, 4)."""

from __future__ import annotations

from datetime import datetime

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QDialog

from app.former_offer import STEP, TUNING
from app.found_working import TITLE
from app.recovery import Recovery
from app.studio import begin
from codegen.document import Document
from codegen.twoletter.fixed import ONE
from device.former import Former, keep, left_behind
from tests.stage import Stage
from widgets.parts.question import Question

UNSAVED = "Recover unsaved work?"
WHOLE = "what a tuning left is looked at by a part of the tuner"
WHEN = datetime(2026, 5, 4, 10, 30)
KILLED = "#A\nJG 5000\nBG X\nAM X\nEN"  # goes on without the studio


def killed(stage: Stage) -> None:
    """What a studio left that was killed with unsaved work, amid a step of commissioning and after a tuning."""
    data = stage.studio.data
    Recovery(data / "recovery").set_aside(Document(), None, WHEN)
    for name, values in (("commissioning", {"ER": 900 * ONE}), ("tuning", {"KP": 7 * ONE})):
        file = data / name / "left.before-tuning"
        keep(Former("X", "ssc2", 1, "machine", "the press", WHEN.isoformat(), 0, values, file))


def shown(stage: Stage) -> list[str]:
    """The dialogs that can be seen."""
    return [each.windowTitle() for each in stage.studio.window.findChildren(QDialog) if each.isVisible()]


def answer(stage: Stage, words: str) -> None:
    question = next(each for each in stage.studio.window.findChildren(Question) if each.isVisible())
    QTest.mouseClick(question.buttons[words], Qt.MouseButton.LeftButton)


def test_dialogs_after_a_kill_come_one_after_the_other(stage: Stage) -> None:
    """Unsaved work comes last; where it is shown already, it steps aside."""
    killed(stage)
    begin(stage.studio, None, "offline")
    stage.go(2)
    assert shown(stage) == [UNSAVED]
    rig = stage.connect("machine", "ssc2", answers=False, program=KILLED)
    rig.simulation.execute("#A")
    seen: list[str] = []

    def look() -> None:
        stage.go(1)
        titles = shown(stage)
        assert len(titles) <= 1, titles
        seen.extend(title for title in titles if title not in seen[-1:])

    for words in ("", "Keep what the controller holds", "Keep what the controller holds", "Stop everything"):
        if words:
            answer(stage, words)
        for _ in range(30):
            look()
    assert seen[0] == UNSAVED
    assert set(seen[1:3]) == {STEP.title, TUNING.title}
    assert seen[3:] == [TITLE, UNSAVED]
    assert not left_behind(stage.studio.data / "tuning") and not left_behind(stage.studio.data / "commissioning")


@pytest.mark.long
def test_what_was_to_be_asked_of_a_machine_that_is_gone_is_not_asked(stage: Stage) -> None:
    killed(stage)
    rig = stage.connect("machine", "ssc2", answers=False, program=KILLED)
    rig.simulation.execute("#A")
    stage.until(lambda: bool(shown(stage)))
    stage.go(30)
    stage.connect("simulator", "ssc1")
    answer(stage, "Keep what the controller holds")
    stage.go(30)
    assert shown(stage) == []


def test_what_is_put_back_has_nothing_left_to_tell(stage: Stage) -> None:
    """The jog in which a killed run held its axis ends with it: no question speaks of a motion that is over."""
    keep(Former("X", "ssc2", 1, "machine", "the press", WHEN.isoformat(), 0, {"KP": 7 * ONE},
                stage.studio.data / "tuning" / "left.before-tuning"))  # fmt: skip
    rig = stage.connect("machine", "ssc2", answers=False, program="#A\nSH X\nJG 0\nBG X\nEN")
    rig.simulation.execute("#A")
    stage.until(lambda: bool(shown(stage)))
    assert shown(stage) == [TUNING.title]
    answer(stage, "Take Control and put them back")
    assert rig.simulation.state()["axes"]["X"]["moving"]
    for _ in range(60):
        stage.go(1)
        assert TITLE not in shown(stage)
    assert not left_behind(stage.studio.data / "tuning") and not rig.simulation.state()["axes"]["X"]["moving"]
