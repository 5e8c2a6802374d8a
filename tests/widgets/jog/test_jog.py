"""The jog panel by mouse and keys, against a simulated table over its byte stream."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import QEvent, Qt
from PySide6.QtGui import QKeyEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QLineEdit, QPushButton

from codegen.setup import Unit
from tests.long import count
from tests.stage import Stage, make_studio
from widgets.jog.one_axis import OneAxisPage
from widgets.jog.panel import OFFLINE, WATCHED, JogPanel
from widgets.jog.together import TogetherPage

SCALE = 1000  # counts per mm
LEFT, SHIFT = Qt.MouseButton.LeftButton, Qt.KeyboardModifier.ShiftModifier


def make_table(folder: Path) -> Stage:
    """A studio with a table of 1000 counts per mm, its jog panel in front."""
    made = make_studio(folder)
    document = made.studio.session.document
    axis = dc.replace(
        document.setup.axes[0], unit=Unit.MM, counts_per_unit=str(SCALE), reverse_limit="-50", forward_limit="200"
    )
    setup = dc.replace(document.setup, model="ssc2", axes=(axis,) * 4)
    made.studio.session.set_document(dc.replace(document, setup=setup), "Table")
    made.studio.window.resize(1280, 900)
    made.studio.window.show()
    made.go()
    made.studio.desk.bring("Display")
    made.go()
    made.studio.desk.bring("Jog")
    made.go()
    return made


@pytest.fixture
def stage(qapp: QApplication, tmp_path: Path) -> Iterator[Stage]:
    made = make_table(tmp_path)
    yield made
    made.clear_away()


def ready(stage: Stage, kind: str = "simulator") -> OneAxisPage:
    """Connected, the pages there."""
    stage.connect(kind, "ssc2")
    stage.until(lambda: stage.studio.at_machine.jog.one is not None)
    stage.go(5)
    assert stage.studio.at_machine.jog.one is not None
    return stage.studio.at_machine.jog.one


def typed(page: OneAxisPage | TogetherPage, name: str, text: str, axis: str = "") -> None:
    """A text typed into a field in place of what was there."""
    editor = page.form.cells[(name, axis)].editor
    line = editor if isinstance(editor, QLineEdit) else editor.findChild(QLineEdit)
    line.selectAll()
    QTest.keyClicks(line, text)


def held_for(stage: Stage, ticks: int) -> None:
    """Time passes while something is held; the timer of the window does not run in virtual time."""
    for _ in range(ticks):
        stage.go(1)
        stage.studio.at_machine.jog.holder.renew()


def at(stage: Stage, axis: str = "X") -> int:
    return int(stage.rig.simulation.state()["axes"][axis]["commanded"])


def moving(stage: Stage, axis: str = "X") -> bool:
    return bool(stage.rig.simulation.state()["axes"][axis]["moving"])


def still(stage: Stage) -> JogPanel:
    stage.go(3)
    stage.until(lambda: not moving(stage) and not moving(stage, "Y") and not stage.controller.motion.busy)
    stage.go(3)
    return stage.studio.at_machine.jog


def test_a_click_is_one_increment(stage: Stage) -> None:
    page = ready(stage)
    typed(page, "distance", "2.5")
    assert page.forward.text() == "+2.5 mm  ▶"
    QTest.mouseClick(page.forward, LEFT)
    still(stage)
    assert at(stage) == 2500  # 2.5 mm of 1000 counts
    QTest.mouseClick(page.back, LEFT)
    assert "X at 0.000 mm" in still(stage).result.text()
    assert at(stage) == 0
    QTest.mouseClick(next(each for each in page.presets if each.text() == "10"), LEFT)
    QTest.mouseClick(page.back, LEFT)
    still(stage)
    assert at(stage) == -10_000


def test_it_moves_while_the_button_is_held_and_shows_where_it_stops(stage: Stage) -> None:
    page = ready(stage)
    QTest.mousePress(page.hold_forward, LEFT)
    held_for(stage, 40)
    assert moving(stage)
    assert page.ghost.text().startswith("stops at ")
    assert stage.controller.motion.ghost["X"] >= at(stage)
    QTest.mouseRelease(page.hold_forward, LEFT)
    panel = still(stage)
    assert at(stage) > 1000
    assert "ran on" in panel.result.text() and f"X at {at(stage) / SCALE:.3f} mm" in panel.result.text()
    assert page.ghost.text() == ""


ENDED = ("focus", "hidden", "page", "watch", "stop", "nobody renews")


def test_whatever_ends_holding_stops_the_axis(stage: Stage) -> None:
    page, panel = ready(stage), stage.studio.at_machine.jog
    for how in ENDED:
        stage.studio.desk.bring("Jog")
        panel.buttons[0].click()
        stage.controller.take_control()
        stage.until(lambda: page.hold_back.isEnabled())
        QTest.mousePress(page.hold_back, LEFT)
        held_until_it_moves(stage)
        _end(stage, page, how)
        # 150 ms, the stopping time of 0.1 s, the way over the line; as a dead PC
        for _ in range(12 if how != "nobody renews" else 18):
            stage.go(1)
            if how in ("focus", "hidden", "page"):
                panel.holder.renew()  # nothing is renewed any more
        assert not moving(stage), how
        QTest.mouseRelease(page.hold_back, LEFT)
        still(stage)


def held_until_it_moves(stage: Stage) -> None:
    """At speed, the timer of the window worked by hand."""
    stage.until(lambda: stage.studio.at_machine.jog.holder.renew() or moving(stage))
    held_for(stage, 6)


def _end(stage: Stage, page: OneAxisPage, how: str) -> None:
    panel = stage.studio.at_machine.jog
    if how == "focus":
        stage.studio.window.header.stop.setFocus()
    elif how == "hidden":
        stage.studio.desk.bring("Display")
    elif how == "page":
        panel.buttons[1].click()
    elif how == "watch":
        stage.controller.release_control()
    elif how == "stop":
        stage.controller.stop()
    else:
        panel.holder._beat.stop()  # as if the window hung


def test_arrows_hold_and_with_shift_they_step(stage: Stage) -> None:
    page, panel = ready(stage), stage.studio.at_machine.jog
    panel.setFocus()
    QTest.keyPress(panel, Qt.Key.Key_Right)
    held_for(stage, 20)
    assert moving(stage)
    QTest.keyRelease(panel, Qt.Key.Key_Right)
    still(stage)
    before = at(stage)
    assert before > 0
    QTest.keyClick(panel, Qt.Key.Key_Left, SHIFT)
    still(stage)
    assert at(stage) == before - 1000  # the first increment is 1 mm
    editor = page.form.cells[("speed", "")].editor
    editor.setFocus()
    QTest.keyPress(editor, Qt.Key.Key_Right)  # in a field an arrow is an arrow
    stage.go(10)
    QTest.keyRelease(editor, Qt.Key.Key_Right)
    assert at(stage) == before - 1000


UNCLEAR = ("Shift", "other arrow", "another window", "speed", "latch", "Ctrl released", "letter", "setup")


def test_arrows_let_go_when_it_is_not_clear_what_is_meant(stage: Stage) -> None:
    page, panel = ready(stage), stage.studio.at_machine.jog
    typed(page, "deceleration", "100")
    for how in UNCLEAR[: count(3, len(UNCLEAR))]:
        stage.studio.window.activateWindow()
        panel.setFocus()
        QTest.keyPress(panel, Qt.Key.Key_Right)
        stage.until(lambda: panel.holder.renew() or moving(stage))
        _disturb(stage, page, how)
        held_for(stage, 10)
        assert panel.holder.owner == "" and not moving(stage), how
        place = at(stage)
        repeat = QKeyEvent(QEvent.Type.KeyPress, Qt.Key.Key_Right, Qt.KeyboardModifier.NoModifier, "", True)
        QApplication.sendEvent(panel, repeat)  # the keyboard repeats what is still down
        held_for(stage, 5)
        assert at(stage) == place, how
        QTest.keyRelease(panel, Qt.Key.Key_Right)


def _disturb(stage: Stage, page: OneAxisPage, how: str) -> None:
    panel, studio = stage.studio.at_machine.jog, stage.studio
    if how == "Shift":
        QTest.keyPress(panel, Qt.Key.Key_Shift)
    elif how == "Ctrl released":
        QTest.keyRelease(panel, Qt.Key.Key_Control)
    elif how in ("other arrow", "letter"):
        QTest.keyPress(panel, Qt.Key.Key_Left if how == "other arrow" else Qt.Key.Key_A)
    elif how == "latch":
        page.latch.click()
        stage.controller.motion.set_latch(False)
    elif how == "speed":
        QTest.mouseClick(page.fast.buttons["slow"], LEFT)
    elif how == "setup":
        document = studio.session.document
        setup = dc.replace(document.setup, notes="another")
        studio.session.set_document(dc.replace(document, setup=setup), "Setup")
    else:
        studio.options.show()
        assert studio.options.page is not None
        studio.options.page.activateWindow()


def test_arrows_with_other_keys_hold_nothing(stage: Stage) -> None:
    ready(stage)
    panel = stage.studio.at_machine.jog
    panel.setFocus()
    stage.go(2)
    assert "● ← → hold X" in panel.arrows.text()
    for key in (Qt.KeyboardModifier.ControlModifier, Qt.KeyboardModifier.AltModifier):
        QTest.keyPress(panel, Qt.Key.Key_Right, key)
        held_for(stage, 5)
        QTest.keyRelease(panel, Qt.Key.Key_Right, key)
    assert at(stage) == 0
    stage.studio.program.tree.setFocus()
    stage.go(2)
    assert panel.arrows.text().startswith("○")


def test_a_latched_jog_runs_on_until_it_is_stopped(stage: Stage) -> None:
    page = ready(stage)
    assert not page.run_forward.isVisibleTo(page)
    QTest.mouseClick(page.latch, LEFT)
    stage.go(2)
    QTest.mouseClick(page.run_back, LEFT)
    stage.go(60)  # nobody holds anything
    assert moving(stage) and at(stage) < -1000
    QTest.mouseClick(page.stop_run, LEFT)
    still(stage)
    stage.controller.stop()
    stage.until(lambda: not page.latch.isChecked())  # off again after STOP


def test_a_move_past_a_limit_or_to_a_place_without_home_asks_first(stage: Stage) -> None:
    page = ready(stage)
    typed(page, "distance", "250")  # as far as the travel is long
    QTest.mouseClick(page.forward, LEFT)
    stage.until(lambda: stage.studio.desk.question is not None)
    question = stage.studio.desk.question
    assert question is not None and "forward limit, 200 mm" in question.words
    assert at(stage) == 0 and not moving(stage)
    question.close()
    stage.studio.desk.question = None
    typed(page, "distance", "1")
    typed(page, "place", "3")
    QTest.mouseClick(page.go, LEFT)
    stage.until(lambda: stage.studio.desk.question is not None)
    question = stage.studio.desk.question
    assert question is not None and "homed" in question.words
    question.buttons["Move anyway"].click()
    still(stage)
    assert at(stage) == 3000


def test_zero_here_asks_and_moves_nothing(stage: Stage) -> None:
    page = ready(stage)
    QTest.mouseClick(page.forward, LEFT)
    still(stage)
    QTest.mouseClick(page.zero, LEFT)
    question = stage.studio.desk.question
    assert question is not None
    question.buttons["Set to zero"].click()
    still(stage)
    assert at(stage) == 0


def test_a_line_and_an_arc_end_where_geometry_says(stage: Stage) -> None:
    ready(stage)
    panel = stage.studio.at_machine.jog
    panel.buttons[1].click()
    line = panel.line
    assert line is not None
    for axis, text in (("X", "3"), ("Y", "-4")):
        typed(line, "distances", text, axis)
    typed(line, "speed", "10")
    typed(line, "acceleration", "1000")
    assert line.plan is not None and "VS 10000" in line.plan.commands  # along 5 mm = 5000 counts: 10 mm/s
    QTest.mouseClick(line.go, LEFT)
    still(stage)
    assert (at(stage), at(stage, "Y")) == (3000, -4000)
    panel.buttons[2].click()
    arc = panel.arc
    assert arc is not None
    typed(arc, "radius", "2")
    typed(arc, "sweep", "90")
    QTest.mouseClick(arc.go, LEFT)
    still(stage)
    # from angle 0 a quarter of a circle to the left of its start: one radius to the left, one up
    assert abs(at(stage) - 1000) <= 1 and abs(at(stage, "Y") + 2000) <= 1


def test_two_scales_make_no_circle_and_a_wrong_number_no_move(stage: Stage) -> None:
    page = ready(stage)
    document = stage.studio.session.document
    axes = list(document.setup.axes)
    axes[1] = dc.replace(axes[1], counts_per_unit="500")
    setup = dc.replace(document.setup, axes=tuple(axes))
    stage.studio.session.set_document(dc.replace(document, setup=setup), "Other scale")
    stage.go()
    panel = stage.studio.at_machine.jog
    panel.buttons[2].click()
    assert panel.arc is not None and panel.arc.plan is None
    assert "an ellipse" in panel.arc.words.text()
    panel.buttons[0].click()
    stage.go()
    typed(page, "distance", "12,5")
    assert not page.forward.isEnabled() and "12.5" in page.forward.toolTip()
    assert not page.hold_forward.isEnabled()


def test_offline_and_watch_say_why_nothing_moves(stage: Stage) -> None:
    stage.go()
    assert stage.studio.at_machine.jog.words() == OFFLINE
    page = ready(stage, "machine")
    assert stage.studio.at_machine.jog.reason == WATCHED
    buttons: list[QPushButton] = [page.forward, page.hold_forward, page.home, page.zero]
    assert not any(button.isEnabled() for button in buttons)
    assert page.forward.toolTip() == WATCHED
    QTest.mousePress(page.hold_forward, LEFT)
    held_for(stage, 10)
    QTest.mouseRelease(page.hold_forward, LEFT)
    assert at(stage) == 0


def test_axes_that_are_not_in_the_setup_are_named_with_the_way_to_them(stage: Stage) -> None:
    ready(stage)
    panel = stage.studio.at_machine.jog
    assert not panel.more.isVisible()
    stage.connect("simulator", "ssc4")
    stage.until(panel.more.isVisible)
    assert "Z and W of this controller are not in the setup (SSC, two axes)" in panel.more.words.text()
    panel.buttons[3].click()
    stage.go(3)
    assert panel.drive is not None and set(panel.drive.axes) <= set("XY")
    panel.more.open.click()
    stage.go(3)
    assert stage.studio.setup.window is not None and stage.studio.setup.window.isVisible()
