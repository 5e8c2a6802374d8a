"""A program that asks: the answer box takes what the program's line asks for, and nothing after STOP."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from device.api import StopState
from tests.rig import Rig
from tests.stage import Stage
from widgets.terminal.prompt import PromptBox

ONE = 65536  # a variable's 1, as the controller holds numbers (dmc-1412-1414.txt l.3219: two bytes of fraction)


def ask(stage: Stage, line: str, kind: str = "machine") -> Rig:
    """A machine whose program was started from here and asks."""
    rig = stage.connect(kind, program="\n".join(["#A", *(f"N={n}" for n in range(1, 12)), line, "DONE=1", "EN"]))
    rig.controller.take_control()
    rig.controller.execute(anyway=True)
    stage.until(lambda: rig.controller.pending_prompt is not None)
    stage.go()
    return rig


def box(stage: Stage) -> PromptBox:
    return stage.studio.window.prompt


def answer(stage: Stage, text: str) -> None:
    """Typed and sent with Enter, as a person does."""
    box(stage).line.clear()
    QTest.keyClicks(box(stage).line, text)
    QTest.keyClick(box(stage).line, Qt.Key.Key_Return)
    stage.go(30)


def variable(rig: Rig, name: str) -> float | None:
    held = rig.simulation.unit.state.variables.get(name)
    return None if held is None else held / ONE


@pytest.mark.parametrize("text", ["12,5", "1e3", "1.234.567", "１２", "12 mm", "12;MO X", "LEN*2", "3000000000"])
def test_what_is_no_number_is_not_sent_to_a_question_for_a_number(stage: Stage, text: str) -> None:
    rig = ask(stage, 'IN "Length?",LEN')
    box(stage).line.setText(text)  # also by the clipboard
    QTest.keyClick(box(stage).line, Qt.Key.Key_Return)
    QTest.mouseClick(box(stage).send, Qt.MouseButton.LeftButton)
    stage.go(30)
    assert rig.controller.pending_prompt is not None
    assert rig.running == [12]
    assert variable(rig, "LEN") is None
    assert rig.sent(r"(?!XQ|UL)") == []
    assert not box(stage).send.isEnabled()
    assert box(stage).problem.isVisible()
    assert box(stage).problem.text().endswith(".")
    assert box(stage).line.text() == text  # to be corrected
    answer(stage, "12.5")
    assert variable(rig, "LEN") == 12.5
    assert variable(rig, "DONE") == 1
    assert box(stage).isHidden()


@pytest.mark.parametrize(("text", "value"), [("-3.25", -3.25), ("$1F", 31.0), ("+7", 7.0), (" 8 ", 8.0)])
def test_numbers_arrive_as_they_were_typed(stage: Stage, text: str, value: float) -> None:
    rig = ask(stage, 'IN "Length?",LEN')
    answer(stage, text)
    assert variable(rig, "LEN") == value


def test_a_question_for_a_text_takes_a_text_and_cuts_nothing_off(stage: Stage) -> None:
    rig = ask(stage, 'IN "Part?",PART{S4}')
    assert box(stage).line.placeholderText() == "Text, up to 4 characters; empty keeps the old value"
    answer(stage, "ABCDE")
    assert rig.controller.pending_prompt is not None
    assert "has 5 characters, the program takes 4" in box(stage).problem.text()
    answer(stage, "12,5")  # a text may be that
    held = rig.simulation.unit.state.variables["PART"]
    assert held.to_bytes(6, "big", signed=True) == b"12,5\0\0"  # dmc-1412-1414.txt l.3640: six characters


def test_an_empty_answer_keeps_the_old_value(stage: Stage) -> None:
    rig = ask(stage, 'IN "Pieces?",N')
    answer(stage, "")
    assert variable(rig, "N") == 11  # ssc-tol-o-motion.txt l.2390; N=11 stands before the question


@pytest.mark.parametrize("confirmed", [True, False])
def test_a_question_is_never_answered_after_stop(stage: Stage, confirmed: bool) -> None:
    rig = ask(stage, 'IN "Length?",LEN')
    QTest.keyClicks(box(stage).line, "12.5")
    if not confirmed:
        rig.cut()
    QTest.keyClick(stage.studio.window, Qt.Key.Key_F12)
    QTest.keyClick(box(stage).line, Qt.Key.Key_Return)  # at once, before anything has been heard
    stage.studio.tick.once()
    if not confirmed:
        stage.later(0.6)
        stage.go(1)
        assert stage.controller.stop_state is StopState.NOT_CONFIRMED
        assert box(stage).withdrawn
        assert box(stage).problem.text() == "STOP was pressed: this question is not answered any more."
        assert not box(stage).line.isEnabled()
        assert not box(stage).send.isEnabled()
        QTest.keyClick(box(stage).line, Qt.Key.Key_Return)
        rig.loopback.unplugged = False
    else:
        stage.until(lambda: stage.controller.stop_state is StopState.STOPPED)
        stage.go()
        assert box(stage).isHidden()
    stage.go(60)
    assert "12.5" not in "".join(rig.lines)
    assert "answer was not sent" in " ".join(stage.studio.messages.texts())


def test_the_next_question_after_a_stop_can_be_answered(stage: Stage) -> None:
    rig = ask(stage, 'IN "Length?",LEN')
    QTest.keyClick(stage.studio.window, Qt.Key.Key_F12)
    stage.until(lambda: stage.controller.stop_state is StopState.STOPPED)
    stage.go()
    rig.controller.execute(anyway=True)
    stage.until(lambda: rig.controller.pending_prompt is not None)
    stage.go()
    assert box(stage).isVisible()
    assert not box(stage).withdrawn
    answer(stage, "4")
    assert variable(rig, "LEN") == 4


def test_a_question_that_was_just_answered_by_another_way_is_not_answered_again(stage: Stage) -> None:
    rig = ask(stage, 'IN "Length?",LEN')
    rig.result(rig.controller.answer("3"))
    assert box(stage).isVisible()  # no tick since
    box(stage).line.setText("9")
    QTest.keyClick(box(stage).line, Qt.Key.Key_Return)
    stage.go(20)
    assert variable(rig, "LEN") == 3
    assert "9" not in rig.sent(r"\d")
