"""After a kill several things want an answer: they come one after the other, what the machine does first."""

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

    for words in ("", "Stop everything", "Keep what the controller holds", "Keep what the controller holds"):
        if words:
            answer(stage, words)
        for _ in range(30):
            look()
    assert seen[:2] == [UNSAVED, TITLE]
    assert set(seen[2:4]) == {STEP.title, TUNING.title}
    assert seen[4:] == [UNSAVED]
    assert not left_behind(stage.studio.data / "tuning") and not left_behind(stage.studio.data / "commissioning")


@pytest.mark.long
def test_what_was_to_be_asked_of_a_machine_that_is_gone_is_not_asked(stage: Stage) -> None:
    killed(stage)
    rig = stage.connect("machine", "ssc2", answers=False, program=KILLED)
    rig.simulation.execute("#A")
    stage.until(lambda: shown(stage) == [TITLE])
    stage.go(30)
    stage.connect("simulator", "ssc1")
    answer(stage, "Go on watching")
    stage.go(30)
    assert shown(stage) == []
