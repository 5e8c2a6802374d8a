"""Every planned move shows where it ends before it is started, and which limit it passes."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QLineEdit

from tests.stage import Stage
from tests.widgets.jog.test_jog import LEFT, at, held_for, make_table, ready, still, typed
from widgets.jog.one_axis import OneAxisPage


@pytest.fixture
def stage(qapp: QApplication, tmp_path: Path) -> Iterator[Stage]:
    made = make_table(tmp_path)
    yield made
    made.clear_away()


def seen(stage: Stage) -> OneAxisPage:
    """Ready to jog, and the display was looked at before: its bars are made when it is first seen."""
    page = ready(stage)
    stage.studio.desk.bring("Display")
    stage.go(2)
    stage.studio.desk.bring("Jog")
    stage.go(2)
    return page


def ghost(stage: Stage, axis: str = "X") -> float:
    """The ring on the bar of the display, mm."""
    return stage.studio.display.axes[axis].travel.marks.ghost


def test_an_increment_shows_its_end_before_it_is_clicked(stage: Stage) -> None:
    page = seen(stage)
    stage.rig.type("DP 10000")  # 10 mm
    stage.until(lambda: "11.000" in page.ends.text())
    assert page.ends.text() == "◀ Ends at X 9.000 mm.\n▶ Ends at X 11.000 mm."
    assert ghost(stage) != ghost(stage)  # nothing is looked at
    QTest.mouseMove(page.form, QPoint(5, 5))  # wherever the hand was in the test before
    QTest.mouseMove(page.forward, QPoint(5, 5))
    stage.go(2)
    assert ghost(stage) == 11.0 and "stops at 11.000 mm" in page.ghost.text()
    QTest.mouseMove(page.back, QPoint(5, 5))
    stage.go(2)
    assert ghost(stage) == 9.0
    typed(page, "distance", "195")
    stage.go(2)
    # 10 mm + 195 mm is behind the limit at 200 mm; 10 mm - 195 mm behind the one at -50 mm
    assert "passes its forward limit, 200 mm" in page.ends.text()
    assert "passes its reverse limit, -50 mm" in page.ends.text()
    assert at(stage) == 10_000  # nothing has moved


def test_a_typed_place_shows_the_ring_and_so_does_a_hold_but_home_has_no_end(stage: Stage) -> None:
    page = seen(stage)
    assert "not known beforehand" in page.home.toolTip()
    typed(page, "speed", "20")
    editor = page.form.cells[("place", "")].editor
    line = editor if isinstance(editor, QLineEdit) else editor.findChild(QLineEdit)
    line.setFocus()
    QTest.keyClicks(line, "15")
    stage.go(2)
    assert page.there.text() == "Ends at X 15.000 mm." and ghost(stage) == 15.0
    QTest.mouseClick(page.go, LEFT)
    stage.until(lambda: stage.studio.desk.question is not None)
    assert stage.studio.desk.question is not None
    stage.studio.desk.question.buttons["Move anyway"].click()
    page.hold_back.setFocus()
    stage.until(lambda: at(stage) > 0)
    assert at(stage) < 15_000 and ghost(stage) == 15.0  # on its way
    still(stage)
    assert at(stage) == 15_000 and ghost(stage) != ghost(stage)
    QTest.mousePress(page.hold_forward, LEFT)
    held_for(stage, 30)
    # the ring is of this tick, the axis at 20 mm/s goes 0.7 mm in one
    assert ghost(stage) * 1000 == pytest.approx(stage.controller.motion.ghost["X"], abs=1500)
    assert ghost(stage) * 1000 > at(stage)
    QTest.mouseRelease(page.hold_forward, LEFT)
    still(stage)
    assert ghost(stage) != ghost(stage)


def test_lines_and_arcs_show_their_ends_in_the_view_from_above(stage: Stage) -> None:
    seen(stage)
    panel, plane = stage.studio.at_machine.jog, stage.studio.at_machine.plane
    plane_dock = stage.studio.window.docks["X-Y view"]
    plane_dock.setFloating(True)
    plane_dock.show()
    stage.until(lambda: plane.commanded.count > 0)
    panel.buttons[1].click()
    line = panel.line
    assert line is not None
    for axis, text in (("X", "3"), ("Y", "-60")):
        typed(line, "distances", text, axis)
    stage.studio.window.activateWindow()
    line.go.setFocus()
    stage.go(3)
    assert line.ends.text() == (
        "Ends at X 3.000 mm, Y -60.000 mm. Axis Y would come to -60 mm and passes its reverse limit, -50 mm."
    )
    x, y = plane._drawn["ghost"].getData()
    assert (list(x), list(y)) == ([3.0], [-60.0])
    panel.buttons[2].click()
    arc = panel.arc
    assert arc is not None
    typed(arc, "acceleration", "10")
    assert arc.plan is not None and "VA 10240" in arc.plan.commands  # the nearest multiple of 1024, as the field says
    typed(arc, "radius", "4")
    typed(arc, "sweep", "180")
    stage.go(3)
    # half a circle from angle 0: two radii to the left, at the height where it began
    assert arc.ends.text() == "Ends at X -8.000 mm, Y 0.000 mm."
    assert arc.fast.slider.value() > 0
    before = arc.item.speed
    arc.fast.slider.setValue(arc.fast.slider.value() + 10)
    assert float(arc.item.speed) > float(before)
    assert arc.plan is not None and f"VS {round(float(arc.item.speed) * 1000)}" in arc.plan.commands
    plane_dock.setFloating(False)


def test_speeds_are_kept_in_the_settings_and_points_in_their_file(stage: Stage) -> None:
    page, settings = seen(stage), stage.studio.settings
    QTest.mouseClick(page.fast.buttons["medium"], LEFT)
    usual = page.item.speed
    assert usual == "10"  # 10 000 counts/s of 1000 counts/mm: slow on any machine
    typed(page, "speed", "7.5")
    page.fast.keep.menu().aboutToShow.emit()
    medium = next(each for each in page.fast.keep.menu().actions() if each.text().startswith("Medium"))
    assert medium.text() == "Medium is 7.5 mm/s from now on"
    medium.trigger()
    assert settings.get("jog_speeds") == {"X mm": {"medium": "7.5"}}
    typed(page, "speed", "1")
    QTest.mouseClick(page.fast.buttons["medium"], LEFT)
    assert page.item.speed == "7.5" and page.pace.speed == 7500
    page._set(axis="Y")  # every axis has its own
    QTest.mouseClick(page.fast.buttons["medium"], LEFT)
    assert page.item.speed == usual
    _points(stage)


def _points(stage: Stage) -> None:
    """A point is saved, gone to after a yes, renamed and deleted."""
    panel, desk = stage.studio.at_machine.jog, stage.studio.desk
    stage.rig.type("SH", "DP 5000,-3000")
    panel.buttons[4].click()
    saved = panel.saved
    assert saved is not None
    stage.until(lambda: saved._places.commanded == {"X": 5000, "Y": -3000})
    assert not saved.save.isEnabled() and "name" in saved.save.toolTip()
    QTest.keyClicks(saved.name, "Load")
    QTest.mouseClick(saved.save, LEFT)
    assert saved.table.item(0, 1).text() == "X 5.000 mm, Y -3.000 mm"  # a count is 0.001 mm
    stage.rig.type("DP 0,0")
    stage.until(lambda: saved._places.commanded == {"X": 0, "Y": 0})
    saved.table.setFocus()
    QTest.keyClick(saved.table, Qt.Key.Key_Down)
    saved.choose("Load")
    QTest.mouseClick(saved.pace.buttons["fast"], LEFT)
    stage.go(2)
    assert saved.ends.text() == "Ends at X 5.000 mm, Y -3.000 mm." and ghost(stage, "Y") == -3.0
    QTest.mouseClick(saved.go, LEFT)
    question = desk.question
    assert question is not None
    assert "Axis X: from 0 mm to 5 mm." in question.words and "Axis Y: from 0 mm to -3 mm." in question.words
    assert "not seen homed" in question.words and at(stage) == 0
    question.buttons["Go there"].click()
    still(stage)
    assert (at(stage), at(stage, "Y")) == (5000, -3000)
    saved.name.setText("Loading")
    QTest.mouseClick(saved.rename, LEFT)
    saved.choose("Loading")
    QTest.mouseClick(saved.delete, LEFT)
    assert desk.question is not None
    desk.question.buttons["Delete it"].click()
    assert saved.table.rowCount() == 0
