"""A name that was typed on a lamp is one step of the history; the codes of the display open their help page."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from tests.stage import Stage, make_studio


@pytest.fixture
def stage(qapp: QApplication, tmp_path: Path) -> Iterator[Stage]:
    stage = make_studio(tmp_path)
    stage.studio.window.show()
    stage.connect()
    stage.studio.desk.bring("Display")
    stage.go()
    yield stage
    stage.clear_away()


def test_a_name_typed_on_a_lamp_is_one_step_of_the_history(stage: Stage) -> None:
    session, display = stage.studio.session, stage.studio.display
    before = session.document
    QTest.keyClick(display.outputs.lamps[0], Qt.Key.Key_F2)
    editor = display.outputs.editor
    assert editor is not None
    editor.clear()
    QTest.keyClicks(editor, "Cutter")
    QTest.keyClick(editor, Qt.Key.Key_Return)
    stage.go()
    assert session.document.setup.output_names[0] == "Cutter"
    assert "output 1 Cutter" in display.words()
    session.undo()
    stage.go()
    assert session.document == before
    assert "Cutter" not in display.words()


def test_a_refused_name_is_said_in_the_status_bar_and_more_opens_the_codes(stage: Stage) -> None:
    display, desk = stage.studio.display, stage.studio.desk
    QTest.keyClick(display.inputs.lamps[4], Qt.Key.Key_F2)
    editor = display.inputs.editor
    assert editor is not None
    QTest.keyClicks(editor, "12")
    QTest.keyClick(editor, Qt.Key.Key_Return)
    stage.go()
    assert any("Input 5 was not renamed" in text for text in stage.studio.messages.texts())
    display.stops.more.click()
    stage.go()
    assert desk.help is not None and desk.help.isVisible()
    assert desk._help_panel is not None and desk._help_panel.page == "Error and stop codes"
