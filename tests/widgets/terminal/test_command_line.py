"""The line of the terminal: completion and parameters from the table, earlier lines, log, clear screen."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from tests.stage import Stage, make_studio
from widgets.terminal.diary import Diary
from widgets.terminal.terminal import TerminalPanel


@pytest.fixture
def stage(qapp: QApplication, tmp_path: Path) -> Iterator[Stage]:
    made = make_studio(tmp_path)
    made.studio.window.show()
    made.go()
    made.studio.desk.bring("Terminal")
    made.connect("simulator", "ssc2", program="#HOME\nEN")
    made.go(5)
    made.studio.window.activateWindow()
    made.studio.terminal.line.setFocus()
    yield made
    made.clear_away()


def panel(stage: Stage) -> TerminalPanel:
    return stage.studio.terminal


def test_what_fits_is_offered_and_taken_by_tab(stage: Stage) -> None:
    line = panel(stage).line
    QTest.keyClicks(line, "K")
    assert {"KP", "KI", "KD"} <= set(line.offered)
    QTest.keyClicks(line, "P")
    QTest.keyClick(line, Qt.Key.Key_Escape)
    assert line.offered == []
    line.clear()
    QTest.keyClicks(line, "MG _TP")
    assert {"_TPX", "_TPY"} <= set(line.offered) and "_TPZ" not in line.offered  # two axes
    QTest.keyClick(line, Qt.Key.Key_Down)
    QTest.keyClick(line, Qt.Key.Key_Tab)
    assert line.text() in ("MG _TPX", "MG _TPY") and line.hasFocus()


def test_the_parameters_of_the_command_are_shown_with_the_one_at_the_cursor(stage: Stage) -> None:
    terminal = panel(stage)
    QTest.keyClicks(terminal.line, "KP 6,")
    words = terminal.help.text()
    assert words.startswith("<b>KP</b>") and "1023.875" in words  # KP 0 to 1023.875
    assert "<b>Y" in words and "<b>X" not in words
    terminal.line.clear()
    assert not terminal.help.isVisibleTo(terminal)


def test_enter_sends_and_the_arrows_bring_earlier_lines_back(stage: Stage) -> None:
    line = panel(stage).line
    for text in ("MG 1", "MG 2"):
        QTest.keyClicks(line, text)
        QTest.keyClick(line, Qt.Key.Key_Return)
        stage.go(20)
    assert line.text() == "" and "0000000002.0000" in panel(stage).log.toPlainText()
    QTest.keyClick(line, Qt.Key.Key_Up)
    QTest.keyClick(line, Qt.Key.Key_Up)
    assert line.text() == "MG 1"
    QTest.keyClick(line, Qt.Key.Key_Down)
    assert line.text() == "MG 2"


def test_what_is_no_command_tells_the_reason(stage: Stage) -> None:
    QTest.keyClicks(panel(stage).line, "KP 5000")
    QTest.keyClick(panel(stage).line, Qt.Key.Key_Return)
    stage.until(lambda: "? " in panel(stage).log.toPlainText())
    assert "6" in panel(stage).log.toPlainText().rpartition("? ")[2]  # error 6: number out of range


@pytest.mark.parametrize("clearing", ['MG {^27},"E"{N}', 'MG {^27},"[2J",{^27},"[H"{N}'])
def test_a_program_clears_the_screen(stage: Stage, clearing: str) -> None:
    terminal = panel(stage)
    stage.rig.start(f'MG "BEFORE"\nWT 100\n{clearing}\nMG "AFTER"\nEN')
    stage.until(lambda: "AFTER" in terminal.log.toPlainText())
    assert "BEFORE" not in terminal.log.toPlainText()


def test_the_log_holds_every_line_with_its_time(stage: Stage, tmp_path: Path) -> None:
    path = tmp_path / "session.log"
    panel(stage).keep_in(path)
    assert panel(stage).keep.text() == "End log"
    stage.type("MG 42")
    QTest.mouseClick(panel(stage).keep, Qt.MouseButton.LeftButton)
    text = path.read_text(encoding="utf-8")
    assert "› MG 42" in text and "0000000042.0000" in text
    panel(stage).keep_in(tmp_path / "no" / "folder.log")
    assert "cannot be written" in panel(stage).log.toPlainText() and not panel(stage).diary.open


def test_the_diary_adds_behind_what_was_there(tmp_path: Path) -> None:
    path = tmp_path / "a.log"
    for number in (1, 2):
        diary = Diary(lambda: time.struct_time((2026, 3, 4, 5, 6, 7, 0, 0, 0)))
        assert diary.begin(path)
        diary.add("›", f"TP {number}")
        diary.end()
    lines = path.read_text(encoding="utf-8").splitlines()
    assert lines == [
        "05:06:07 --- log of 2026-03-04", "05:06:07 › TP 1", "05:06:07 --- log of 2026-03-04", "05:06:07 › TP 2",
    ]  # fmt: skip
