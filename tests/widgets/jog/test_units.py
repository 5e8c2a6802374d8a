"""A typed number never counts in another unit; a question is answered for the machine it was asked about."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QPushButton

from app.asked import ANOTHER, STOPPED
from codegen.setup import Unit
from tests.stage import Stage
from tests.widgets.jog.test_jog import LEFT, at, make_table, ready, still, typed
from widgets.jog.one_axis import OneAxisPage
from widgets.jog.pages import ARC, LINE


@pytest.fixture
def stage(qapp: QApplication, tmp_path: Path) -> Iterator[Stage]:
    made = make_table(tmp_path)
    yield made
    made.clear_away()


def measure(stage: Stage, x: tuple[Unit, str], y: tuple[Unit, str]) -> None:
    """Other units of the two axes: the unit and the counts in one."""
    document = stage.studio.session.document
    axes = document.setup.axes
    pair = (dc.replace(axes[n], unit=unit, counts_per_unit=scale) for n, (unit, scale) in enumerate((x, y)))
    setup = dc.replace(document.setup, axes=(*pair, *axes[2:]))
    stage.studio.session.set_document(dc.replace(document, setup=setup), "Another scale")
    stage.go()


def choose(page: OneAxisPage, axis: str) -> None:
    """Another axis, by its button."""
    buttons = page.form.cells["axis", ""].editor.findChildren(QPushButton)
    QTest.mouseClick(next(each for each in buttons if each.text() == axis), LEFT)


def test_one_axis_keeps_its_numbers_in_their_unit(stage: Stage) -> None:
    page = ready(stage)
    for name, text in (("distance", "2.5"), ("speed", "5"), ("place", "7")):
        typed(page, name, text)
    measure(stage, (Unit.INCH, "25400"), (Unit.DEGREE, "100"))
    assert (page.item.distance, page.item.place) != ("2.5", "7") and page.item.place == ""
    assert page.form.cells["distance", ""].editor.text() == page.item.distance  # what is seen is what is sent
    QTest.mouseClick(page.forward, LEFT)
    still(stage)
    assert 0 < at(stage) <= 1000  # the short way of a page that begins, not 2.5 in = 63 500 counts
    typed(page, "distance", "0.25")
    choose(page, "Y")
    assert page.item.axis == "Y" and page.item.distance not in ("2.5", "0.25") and "deg" in page.forward.text()
    choose(page, "X")
    assert page.item.distance == "0.25"
    measure(stage, (Unit.MM, "2000"), (Unit.MM, "1000"))
    assert (page.item.distance, page.item.speed, page.item.place) == ("2.5", "5", "7")  # in mm they were typed


@pytest.mark.parametrize("index", [LINE, ARC])
def test_two_axes_begin_anew_in_another_unit(stage: Stage, index: int) -> None:
    ready(stage)
    panel = stage.studio.at_machine.jog
    QTest.mouseClick(panel.buttons[index], LEFT)
    stage.go()
    page = panel.line if index == LINE else panel.arc
    assert page is not None
    typed(page, "speed", "50")
    if index == LINE:
        typed(page, "distances", "3", "X")
        typed(page, "distances", "4", "Y")
    else:
        typed(page, "radius", "30")
    measure(stage, (Unit.MM, "4000"), (Unit.MM, "1000"))
    assert page.item.speed == "50"  # a millimetre stays one, whatever its counts
    measure(stage, (Unit.INCH, "25400"), (Unit.MM, "1000"))
    assert page.item.speed == "1" and page.form.cells["speed", ""].editor.text() == "1"
    if index == LINE:
        assert page.item.distances[:2] == ("", "4")
    else:
        assert page.item.radius == "1"


def test_an_axis_that_only_the_setup_has_can_not_be_moved(stage: Stage) -> None:
    page, panel = ready(stage), stage.studio.at_machine.jog
    stage.connect("simulator", "ssc1")  # the setup is for two axes
    stage.go(5)
    assert page.forward.isEnabled() and panel.axis == "X"
    choose(page, "Y")
    stage.go()
    for button in (page.forward, page.hold_back, page.home, page.zero):
        assert not button.isEnabled() and button.toolTip() == "This controller has no axis Y."
    assert page.ends.text() == "This controller has no axis Y."
    stage.connect("simulator", "ssc2")
    stage.go(5)
    assert page.forward.isEnabled() and panel.axis == "Y"


@pytest.mark.parametrize("what", ["another machine", "STOP", "nothing"])
def test_a_question_that_is_left_open_starts_nothing_later(stage: Stage, what: str) -> None:
    page = ready(stage)
    typed(page, "distance", "250")  # behind the limit at 200 mm
    typed(page, "speed", "100")
    QTest.mouseClick(page.forward, LEFT)
    stage.until(lambda: stage.studio.desk.question is not None)
    question = stage.studio.desk.question
    assert question is not None
    if what == "another machine":
        stage.connect("simulator", "ssc2")
    elif what == "STOP":
        stage.studio.connection.stop()
    stage.go(20)
    QTest.mouseClick(question.buttons["Move anyway"], LEFT)
    stage.go(20)
    assert (at(stage) > 0) == (what == "nothing")
    words = stage.studio.at_machine.jog.result.text()
    assert (words == ANOTHER, words == STOPPED) == (what == "another machine", what == "STOP")
