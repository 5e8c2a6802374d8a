"""File, controller and EEPROM: the badge, and the window that says in words where they differ."""

from __future__ import annotations

import dataclasses as dc
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QTableWidget

from codegen.instructions import SingleAxisMove
from tests.app.test_run import answer, idle, same_model, trigger
from tests.rig import Rig
from tests.stage import Stage
from widgets.compare.window import CompareWindow

WHOLE = True  # the panels at the machine are there from the beginning


def badge(stage: Stage) -> str:
    stage.go()
    return stage.studio.window.run_bar.badge.accessibleName().removeprefix("Program in the controller: ")


def burned(stage: Stage, kind: str = "simulator") -> Rig:
    """The open program is in the controller and burned."""
    rig = same_model(stage, kind)
    stage.download()
    trigger(stage, "burn")
    answer(stage, "Burn")
    stage.until(lambda: any("program is burned" in text for text in stage.studio.messages.texts()))
    return rig


def change_the_move(stage: Stage, distance: str = "12") -> str:
    """The move of the wire cutter gets another distance; its step."""
    session = stage.studio.session
    step = next(each for each in session.document.program.steps() if isinstance(each.instruction, SingleAxisMove))
    session.replace(step.id, dc.replace(step.instruction, distance=distance))
    return step.id


def compared(stage: Stage) -> CompareWindow:
    """The window, as the badge opens it."""
    QTest.mouseClick(stage.studio.window.run_bar.badge, Qt.MouseButton.LeftButton)
    stage.go()
    window = stage.studio.proof.comparing.window
    assert window is not None and window.isVisible()
    return window


def rows(table: QTableWidget) -> list[list[str]]:
    return [
        [item.text() if (item := table.item(row, column)) is not None else "" for column in range(4)]
        for row in range(table.rowCount())
    ]


def read(stage: Stage, window: CompareWindow) -> None:
    QTest.mouseClick(window.read, Qt.MouseButton.LeftButton)
    stage.until(lambda: stage.studio.run.doing)
    idle(stage)
    stage.go()


def test_the_badge_tells_of_controller_and_eeprom(stage: Stage) -> None:
    same_model(stage)
    assert badge(stage) == "? Not known"
    stage.download()
    assert badge(stage) == "✓ In the controller, EEPROM unknown"
    trigger(stage, "burn")
    answer(stage, "Burn")
    stage.until(lambda: badge(stage) == "✓ In the controller, burned")
    change_the_move(stage)
    assert badge(stage) == "≠ Changed since"
    stage.download()
    assert badge(stage) == "✓ In the controller, not burned"
    assert "as burned from here on " in stage.studio.window.run_bar.badge.toolTip()


@pytest.mark.long
def test_a_burn_by_hand_makes_the_eeprom_unknown(stage: Stage) -> None:
    burned(stage)
    assert badge(stage) == "✓ In the controller, burned"
    stage.type("BP")
    stage.go()
    assert badge(stage) == "✓ In the controller, EEPROM unknown"


def test_what_was_burned_is_remembered_by_the_serial_number(stage: Stage) -> None:
    rig = burned(stage, "machine")
    held = rig.program
    stage.connect("machine", stage.studio.model(), program="\n".join(held))
    assert badge(stage) == "? Not known"
    trigger(stage, "upload")
    idle(stage)
    assert badge(stage) == "✓ In the controller, burned"


@pytest.mark.long
def test_a_controller_without_serial_number_is_not_taken_for_the_same(stage: Stage) -> None:
    rig = same_model(stage, "machine")
    rig.simulation.unit.profile = dc.replace(rig.simulation.unit.profile, serial_number=0)
    rig.controller.identity = dc.replace(rig.controller.identity, serial=0)  # type: ignore[type-var]
    stage.download()
    trigger(stage, "burn")
    answer(stage, "Burn")
    stage.until(lambda: badge(stage) == "✓ In the controller, burned")
    again = stage.connect("machine", stage.studio.model(), program="\n".join(rig.program))
    again.controller.identity = dc.replace(again.controller.identity, serial=0)  # type: ignore[type-var]
    trigger(stage, "upload")
    idle(stage)
    assert badge(stage) == "✓ In the controller, EEPROM unknown"


def test_differences_are_sentences_of_instructions(stage: Stage) -> None:
    burned(stage)
    step = change_the_move(stage)
    window = compared(stage)
    assert "≠ The controller's program differs from the open one in one place." in window.summary.text()
    assert "✓ The EEPROM holds the program that is in the controller, as burned from here" in window.summary.text()
    (row,) = rows(window.tables["Program"])
    assert row[0].endswith("changed")
    assert row[1].startswith("Move X by 12 in") and row[2].startswith("Move X by 10 in")
    assert row[3] == row[2]
    assert "PR 7644" in window.code.toPlainText() and "PR 6370" in window.code.toPlainText()  # 637 counts an inch
    QTest.mouseClick(window.go, Qt.MouseButton.LeftButton)
    assert stage.studio.program.current_step() == step


@pytest.mark.long
def test_what_is_not_burned_is_said(stage: Stage) -> None:
    burned(stage)
    change_the_move(stage)
    stage.download()
    window = compared(stage)
    assert "✓ The controller holds exactly the open program" in window.summary.text()
    assert "≠ Not burned: the EEPROM holds “CUTTER” as burned from here on " in window.summary.text()
    (row,) = rows(window.tables["Program"])
    assert row[0].endswith("not burned") and row[2] == "the same" and row[3].startswith("Move X by 10 in")


def test_setup_values_are_read_and_compared_in_watch(stage: Stage) -> None:
    rig = same_model(stage, "machine")
    setup = stage.studio.session.document.setup
    stage.studio.session.set_setup(setup.with_axis("X", dc.replace(setup.axis("X"), kp="12.25")))
    rig.type("KP 9")
    rig.controller.release_control()
    before = len(rig.lines)
    window = compared(stage)
    read(stage, window)
    table = {row[0]: row[1:] for row in rows(window.tables["Setup values"])}
    assert table["Proportional of X (KP)"][:2] == ["12.25", "9"]
    assert "of the setup" in window.summary.text()
    assert {line[:2] for line in rig.lines[before:]} <= {"MG", "UL", "LV", "LA", "QU", ""}


def test_values_burned_by_hand_are_noted_and_compared(stage: Stage) -> None:
    rig = same_model(stage, "machine")
    rig.type("KP 9")
    stage.type("BN")
    stage.until(lambda: stage.studio.proof.eeprom.known.parameters is not None)
    rig.type("KP 10")
    window = compared(stage)
    read(stage, window)
    table = {row[0]: row[1:] for row in rows(window.tables["Setup values"])}
    assert table["Proportional of X (KP)"][1:] == ["10", "9"]
    assert "One value in the EEPROM (burned on " in window.summary.text()


def test_while_a_question_waits_nothing_is_read(stage: Stage) -> None:
    stage.question()
    window = compared(stage)
    assert not window.read.isEnabled()
    assert "waits for an answer" in window.read.toolTip()


@pytest.mark.long
def test_while_a_program_runs_the_controller_can_be_compared(stage: Stage) -> None:
    rig = same_model(stage)
    rig.simulation.stimulus("in1", 0)
    stage.download()
    trigger(stage, "execute")
    stage.until(lambda: rig.running)
    window = compared(stage)
    read(stage, window)
    assert "The controller holds exactly the open program" in window.summary.text()
    assert rig.running


def test_keys_open_read_and_close(stage: Stage) -> None:
    same_model(stage)
    QTest.keyClick(stage.studio.window, Qt.Key.Key_F6)
    stage.go()
    window = stage.studio.proof.comparing.window
    assert window is not None and window.isVisible()
    window.read.setFocus()
    QTest.keyClick(window.read, Qt.Key.Key_Space)
    stage.until(lambda: window.cancel.isVisible())
    idle(stage)
    stage.go()
    assert "There is no program in the controller." in window.summary.text()
    QTest.keyClick(window, Qt.Key.Key_Escape)
    assert not window.isVisible()


@pytest.mark.parametrize("text", ["", "{", '{"format": "twoletter burned"}', '{"format": "twoletter burned", "x": 1}'])
def test_a_spoilt_memory_of_burns_is_none(tmp_path: Path, text: str) -> None:
    from codegen.difference_report import Burned
    from device.backup_burned import FILE, load_burned

    (tmp_path / FILE).write_text(text)
    assert load_burned(tmp_path) == Burned()
