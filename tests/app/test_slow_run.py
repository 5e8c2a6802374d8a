"""A first run at a part of the speed: sent, shown as such everywhere, never burned, then back to full speed."""

from __future__ import annotations

import re

from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QMenu, QToolButton

from app.held import Holding
from device.tasks import NotAllowed
from tests.app.test_run import answer, asked, code, idle, same_model
from tests.stage import Stage


def slow_down(stage: Stage, percent: int = 25) -> None:
    """The program runs at a part of its speed."""
    same_model(stage)
    stage.studio.actions[f"execute_{percent}"].trigger()
    stage.until(lambda: stage.studio.desk.question is not None)
    answer(stage, f"Download and execute at {percent} %")
    idle(stage)
    stage.until(lambda: "The program was started." in stage.studio.messages.texts())


def test_the_slowed_program_is_sent_and_runs_after_asking(stage: Stage) -> None:
    rig = same_model(stage)
    stage.studio.actions["execute_25"].trigger()
    stage.until(lambda: stage.studio.desk.question is not None)
    words, answers = asked(stage)
    assert "every speed at 25 %" in words
    assert "cannot be burned" in words
    assert answers == ["Download and execute at 25 %"]
    assert rig.program == []
    answer(stage, "Download and execute at 25 %")
    idle(stage)
    # the wire cutter moves at 5 in/s, 637 counts/in: 3185 counts/s; SP is kept in twos
    assert "SP 796" in rig.program
    assert rig.program[-1] == "NO SLOWED TO 25 PERCENT"
    assert [line for line in rig.program if not line.startswith(("SP", "NO"))] == [
        line for line in code(stage) if not line.startswith("SP")
    ]
    stage.until(lambda: "The program was started." in stage.studio.messages.texts())
    stage.until(lambda: 0 in stage.studio.program.code.executing)  # the source map holds for it


def test_it_is_called_slowed_wherever_the_state_of_the_program_is_shown(stage: Stage) -> None:
    slow_down(stage)
    window = stage.studio.window
    stage.until(lambda: "slowed to 25 %" in window.status.program.text())
    assert "25 %" in window.run_bar.badge.text()
    stage.studio.program.program_status()
    stage.studio.program.trace()
    stage.go(10)
    status = stage.studio.program.run.window
    assert status is not None
    cell = status.table.item(0, 1)
    assert cell is not None and cell.text() == "► slowed to 25 %"
    assert "slowed to 25 %" in stage.studio.program.run.bar.text.text()
    assert any("slowed to 25 %" in words for words in stage.studio.display.threads.words())


def test_once_sent_it_runs_again_without_asking(stage: Stage) -> None:
    slow_down(stage)
    stage.studio.run.halt()
    idle(stage)
    stage.studio.desk.question = None
    stage.studio.actions["execute_25"].trigger()
    stage.go(10)
    assert stage.studio.desk.question is None
    assert stage.studio.messages.texts()[-1] == "The program was started."


def test_execute_asks_before_it_goes_back_to_full_speed_and_sends_the_real_one(stage: Stage) -> None:
    slow_down(stage, 10)
    stage.studio.run.halt()
    idle(stage)
    stage.studio.actions["execute"].trigger()
    stage.go()
    words, answers = asked(stage)
    assert "10 times as fast" in words
    assert {"Download and execute at full speed", "Run it at 10 %"} <= set(answers)
    answer(stage, "Download and execute at full speed")
    idle(stage)
    assert stage.rig.program == code(stage)
    assert stage.studio.run.held().holding is Holding.SAME


def test_a_slowed_program_is_never_burned(stage: Stage) -> None:
    slow_down(stage)
    stage.studio.run.halt()
    idle(stage)
    stage.studio.actions["burn"].trigger()
    stage.go()
    words, answers = asked(stage)
    assert "never burned" in words
    assert answers == ["Download at full speed"]
    for command in ("BP", "BN", "WT 1;BP"):
        future = stage.controller.ask(command)
        stage.until(future.done)
        assert isinstance(future.exception(), NotAllowed), command
    assert not [line for line in stage.rig.lines if re.search(r"(^|;)B[PN]", line)]
    answer(stage, "Download at full speed")
    idle(stage)
    future = stage.controller.burn_program()
    stage.until(future.done)
    assert future.result().accepted


def test_a_slowed_program_found_in_a_controller_is_known_for_what_it_is(stage: Stage) -> None:
    same_model(stage, program="#A\nSP 100\nPR 5\nBG X\nAM X\nEN\nNO SLOWED TO 50 PERCENT")
    stage.studio.run.upload()
    idle(stage)
    held = stage.studio.run.held()
    assert (held.holding, held.percent) == (Holding.SLOWED, 50)
    stage.go()
    assert "50 %" in stage.studio.window.run_bar.badge.text()


def test_what_can_not_be_slowed_is_said_and_nothing_is_sent(stage: Stage) -> None:
    from codegen.instructions import TwoLetterCode

    rig = same_model(stage)
    stage.studio.session.insert([TwoLetterCode(text="SP _SPX")])
    stage.studio.run.download(percent=50)
    stage.go(20)
    words, _ = asked(stage)
    assert "slowed already" in words
    assert rig.program == []


def test_the_arrow_of_execute_and_the_menu_offer_the_same(stage: Stage) -> None:
    same_model(stage)
    stage.go()
    slow, bar = stage.studio.window.submenus["slow"], stage.studio.window.run_bar.toolbar
    arrow = bar.findChild(QToolButton, "arrow")
    assert arrow is not None
    QTest.mouseClick(arrow, Qt.MouseButton.LeftButton)  # comes back at once: nothing waits for the menu
    assert slow.isVisible()
    slow.close()
    assert [each.text() for each in slow.actions()] == ["Execute at 50 %…", "Execute at 25 %…", "Execute at 10 %…"]
    assert all(each.isEnabled() for each in slow.actions())
    menus = stage.studio.window.header.menus.actions()
    controller = next(each.menu() for each in menus if each.text() == "&Controller")
    assert isinstance(controller, QMenu)
    assert slow.menuAction() in controller.actions()  # by keys: Alt+C, then the arrows
