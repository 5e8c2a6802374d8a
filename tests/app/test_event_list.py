"""The event list: what really happens at a simulated machine appears in words, is kept, found and given away."""

from __future__ import annotations

import json
import zipfile
from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QTextBrowser

from app.help_pages import Pages
from device.events import Event, What
from tests.stage import Stage, make_studio
from widgets.events.panel import COLUMNS, EMPTY, HELP_PAGES, MOST, NO_HIT
from widgets.help.topic import topic_of


@pytest.fixture
def stage(qapp: QApplication, tmp_path: Path) -> Iterator[Stage]:
    made = make_studio(tmp_path)
    made.studio.window.resize(1280, 900)
    made.studio.window.show()
    made.go()
    made.studio.desk.bring("Events")
    made.go()
    yield made
    made.clear_away()


def words(stage: Stage) -> str:
    return stage.studio.at_machine.event_list.words()


def test_nothing_yet_then_a_limit_with_its_place_and_the_next_step(stage: Stage) -> None:
    stage.go()
    assert words(stage) == EMPTY
    rig = stage.connect("simulator", "ssc1")
    stage.go(30)
    rig.type("PR 20000", "SP 20000", "BG X")
    stage.later(0.3)
    rig.simulation.stimulus("fls_x", 0)
    stage.until(lambda: "forward limit" in words(stage).casefold())
    line = next(line for line in words(stage).split("\n") if "forward limit" in line.casefold())
    assert "X " in line and "reverse" in line  # where it stood, and which way to move it back


def test_stop_download_and_program_errors_are_there_and_found(stage: Stage) -> None:
    stage.connect("simulator", "ssc1")
    stage.download()
    stage.controller.stop()
    stage.until(lambda: "stopped (confirmed)" in words(stage))
    stage.rig.start("#A\nPR 100\nQQ 5\nEN")
    stage.until(lambda: "program error" in words(stage))
    panel = stage.studio.at_machine.event_list
    panel.table.setCurrentCell(0, 0)
    stage.until(lambda: "error 1" in words(stage))
    panel.table.setCurrentCell(1, 0)
    panel.table.setFocus()
    QTest.keyClick(panel.table, Qt.Key.Key_Up)
    assert panel.words_.text() == "Cause: error 1, Unrecognized command. Next: Look at the spelling of the line."
    QTest.keyClicks(panel.search, "qq")
    assert panel.table.rowCount() == 1 and "line 2" in words(stage)
    panel.search.setText("no such word")
    assert words(stage) == NO_HIT
    panel.search.clear()
    panel.kind.setCurrentText("Download")
    assert panel.table.rowCount() >= 1 and all("download" in line for line in words(stage).split("\n"))


def test_a_line_is_shown_where_it_is_of_the_open_program(stage: Stage) -> None:
    stage.connect("simulator", "ssc1")
    said: list[str] = []
    stage.studio.ear._say = said.append
    stage.studio.at_machine.event_list.line_wanted.emit(1)
    assert said == ["Line 1 is of another program than the open one."]
    stage.download()
    stage.go()
    stage.studio.at_machine.event_list.line_wanted.emit(1)
    assert len(said) == 1
    step = stage.studio.session.listing.step_of(stage.studio.ear._kept[1])
    assert stage.studio.program.current_step() == step


def test_a_stop_tells_where_all_axes_were_and_what_ran(stage: Stage) -> None:
    """The program waits at line 2 for its input; a double click asks for that line."""
    rig = stage.connect("simulator", "ssc2")
    rig.start("#A\nWT 100\nAI 1\nEN")
    rig.simulation.stimulus("in1", 0)
    stage.go(60)
    stage.controller.stop()
    stage.until(lambda: "STOP was pressed" in words(stage))
    stage.go(30)
    panel, told = stage.studio.at_machine.event_list, []
    row = next(number for number, event in enumerate(panel.rows) if event.what is What.STOP)
    where = panel.table.item(row, 2).text()
    assert "X 0" in where and "Y 0" in where and where.endswith("thread 0 line 2")
    panel.line_wanted.connect(told.append)
    place = panel.table.visualItemRect(panel.table.item(row, 2)).center()
    QTest.mouseClick(panel.table.viewport(), Qt.MouseButton.LeftButton, pos=place)
    QTest.mouseDClick(panel.table.viewport(), Qt.MouseButton.LeftButton, pos=place)
    assert told == [2]


def test_events_survive_the_studio(stage: Stage, tmp_path: Path) -> None:
    stage.connect("simulator", "ssc1")
    stage.controller.stop()
    stage.until(lambda: "STOP was pressed" in words(stage))
    other = make_studio(tmp_path)
    assert any("STOP was pressed" in event.text for event in other.studio.at_machine.happened.events.all())
    other.clear_away()


def test_the_service_bundle_holds_everything(stage: Stage, tmp_path: Path) -> None:
    stage.connect("simulator", "ssc1")
    stage.download()
    path = tmp_path / "service.zip"
    QTest.mouseClick(
        stage.studio.at_machine.event_list.bundle, Qt.MouseButton.LeftButton
    )  # asks for a file; F12 still works
    stage.studio.at_machine.happened.save_bundle(path)
    stage.until(lambda: not stage.studio.tick.writing)
    with zipfile.ZipFile(path) as bundle:
        assert bundle.testzip() is None
        names = set(bundle.namelist())
        assert {"events.json", "traffic.txt", "program.tlp", "setup.tls", "versions.txt", "controller.dmc"} <= names
        assert bundle.read("window.png")[:4] == b"\x89PNG"
        assert any(each["what"] == "download" for each in json.loads(bundle.read("events.json")))
        assert bundle.read("controller.dmc").decode().split() == stage.studio.session.listing.text.split()
        assert "DL" in bundle.read("traffic.txt").decode()


def test_a_bundle_that_can_not_be_written_is_said(stage: Stage, tmp_path: Path) -> None:
    said: list[str] = []
    stage.studio.at_machine.happened.said.connect(said.append)
    stage.studio.at_machine.happened.save_bundle(tmp_path / "no" / "such" / "folder.zip")
    stage.until(lambda: said)
    assert said[0].startswith("The service bundle was not saved")


def test_each_event_has_its_help(stage: Stage) -> None:
    """By a button, and by F1 on its row; its page is there."""
    panel = stage.studio.at_machine.event_list
    assert set(HELP_PAGES) == set(What) and set(HELP_PAGES.values()) <= set(Pages())
    assert not panel.more.isEnabled() and topic_of(panel.table) == "Events"
    rig = stage.connect("machine", "ssc1")
    rig.cut()
    stage.until(lambda: "lost link" in words(stage))
    panel.table.setCurrentCell(0, 0)
    assert topic_of(panel.table) == "Troubleshooting"
    QTest.mouseClick(panel.more, Qt.MouseButton.LeftButton)
    stage.go()
    assert stage.studio.desk.help is not None
    assert "The controller does not answer" in stage.studio.desk.help.findChild(QTextBrowser).toPlainText()


def test_one_more_event_leaves_the_rows_alone_that_stand_there(stage: Stage) -> None:
    """A thousand rows come in a few ticks; what is new comes in above them, and the selected event stays so."""
    panel, events = stage.studio.at_machine.event_list, stage.studio.at_machine.happened.events
    for number in range(MOST):
        events.add(Event(0, float(number), What.LIMIT, f"limit number {number}", axis="X"))
    stage.until(lambda: panel.table.rowCount() == MOST)
    panel.table.setCurrentCell(3, 0)
    chosen, changed, new = panel.rows[3], 0, 0

    def count(*_: object) -> None:
        nonlocal changed
        changed += 1

    panel.table.model().dataChanged.connect(count)
    for number in (MOST, MOST + 1):
        new = events.add(Event(0, float(number), What.FAULT, f"fault number {number}")).number
        stage.go(2)
    events.complete(new, cause="a wire")
    stage.go(2)
    assert 0 < changed <= 3 * 3 * len(COLUMNS)  # text, tool tip and icon of three rows
    assert panel.rows[panel.table.currentRow()] is chosen
    texts = [panel.table.item(row, 3).text() for row in range(MOST)]
    assert texts == [event.text for event in events.search()[:MOST]]
    assert panel.table.item(0, 4).text() == "a wire"
