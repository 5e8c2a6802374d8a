"""The file of the open program: changed, replaced, touched, removed by somebody else; never overwritten silently."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

import resources
from app.disk import Disk
from app.file_bar import FileBar
from codegen import files
from codegen.document import Document
from codegen.instructions import Label
from codegen.program import Program
from device.api import StopState
from tests.app.pauses import Ticks, too_long
from tests.benchmarks.editing import large_document
from tests.long import is_long
from tests.stage import Stage

OTHER = Document(Program(name="OTHER"))


def path_of(stage: Stage) -> Path:
    path = stage.studio.session.path
    assert path is not None
    return path


def bar(stage: Stage) -> FileBar:
    return stage.studio.files.bar


def press(stage: Stage, words: str) -> None:
    button = bar(stage).buttons[words]
    assert button.isVisible()
    QTest.mouseClick(button, Qt.MouseButton.LeftButton)
    stage.go()


def wait(stage: Stage, shown: bool) -> None:
    """Until the file system has told (real time: the watcher lives outside of the stage)."""
    for _ in range(200):
        QTest.qWait(20)
        if bar(stage).isVisible() == shown:
            break
    assert bar(stage).isVisible() == shown


def changed(stage: Stage) -> Document:
    """Somebody else writes the file; what was open."""
    before = stage.studio.session.document
    files.save(path_of(stage), OTHER)
    wait(stage, True)
    return before


def test_a_change_by_another_program_is_said_and_nothing_is_taken_or_overwritten(stage: Stage) -> None:
    before = changed(stage)
    assert bar(stage).text.text().startswith("wire-cutter.tlp was changed by another program.")
    assert stage.studio.session.document is before
    assert [words for words, button in bar(stage).buttons.items() if button.isVisible()] == [
        "Reload", "Compare", "Save as…", "Keep mine",
    ]  # fmt: skip
    stage.studio.session.insert([Label(name="MINE")])
    stage.studio.actions["save"].trigger()
    question = stage.studio.desk.question
    assert question is not None
    assert "changed by another program" in question.words
    assert files.load(path_of(stage)) == OTHER


def test_reload_takes_the_file_and_undo_brings_mine_back(stage: Stage) -> None:
    stage.studio.session.insert([Label(name="MINE")])
    mine = changed(stage)
    assert "within reach of Undo" in bar(stage).text.text()
    press(stage, "Reload")
    assert stage.studio.session.document == OTHER
    assert not stage.studio.session.dirty
    assert bar(stage).isHidden()
    stage.studio.session.undo()
    assert stage.studio.session.document == mine


def test_keep_mine_hides_the_bar_and_save_asks_all_the_same(stage: Stage) -> None:
    changed(stage)
    press(stage, "Keep mine")
    assert bar(stage).isHidden()
    stage.studio.actions["save"].trigger()
    question = stage.studio.desk.question
    assert question is not None
    assert files.load(path_of(stage)) == OTHER
    QTest.mouseClick(question.buttons["Overwrite it"], Qt.MouseButton.LeftButton)
    assert files.load(path_of(stage)) == stage.studio.session.document
    assert stage.studio.session.on_disk is Disk.SAME


def test_compare_shows_both(stage: Stage) -> None:
    changed(stage)
    press(stage, "Compare")
    window = stage.studio.files.comparison
    assert window is not None
    assert "differ from the open program" in window.words.text()
    window.tabs.setCurrentWidget(window.differences)
    assert "AI 1" in window.differences.toPlainText()
    assert "only in the file" in window.differences.toPlainText()
    window.close()


def test_compare_says_when_only_something_else_than_the_code_differs(stage: Stage) -> None:
    session = stage.studio.session
    other = Document(session.document.program, session.document.setup, notes="seen by somebody else")
    files.save(path_of(stage), other)
    wait(stage, True)
    press(stage, "Compare")
    window = stage.studio.files.comparison
    assert window is not None
    assert "They are the code of the open program. The setup, comments or names differ." in window.words.text()
    window.close()


def test_a_file_that_was_only_touched_is_not_a_change(stage: Stage) -> None:
    path = path_of(stage)
    os.utime(path, (1, 1))
    data = path.read_bytes()
    path.write_bytes(data)
    other = path.with_name("beside.tlp")
    other.write_bytes(data)
    other.replace(path)  # replaced by the same
    QTest.qWait(500)
    stage.go()
    assert bar(stage).isHidden()
    assert stage.studio.session.on_disk is Disk.SAME


def test_a_file_put_in_its_place_is_noticed_more_than_once(stage: Stage) -> None:
    for name in ("ONE", "TWO"):  # as editors do it: a new file under the old name
        beside = path_of(stage).with_name("beside.tlp")
        files.save(beside, Document(Program(name=name)))
        beside.replace(path_of(stage))
        wait(stage, True)
        press(stage, "Reload")
        assert stage.studio.session.document.program.name == name
    files.save(path_of(stage), OTHER)
    wait(stage, True)


def test_a_deleted_file_is_said_and_save_writes_it_again(stage: Stage) -> None:
    path = path_of(stage)
    path.unlink()
    wait(stage, True)
    assert "is not there any more" in bar(stage).text.text()
    assert not bar(stage).buttons["Reload"].isVisible()
    stage.studio.actions["save"].trigger()
    assert files.load(path) == stage.studio.session.document
    assert bar(stage).isHidden()


def test_the_bar_goes_when_the_file_is_as_it_was_again(stage: Stage) -> None:
    path = path_of(stage)
    data = path.read_bytes()
    path.unlink()
    wait(stage, True)
    path.write_bytes(data)
    wait(stage, False)
    assert stage.studio.session.on_disk is Disk.SAME


def test_a_file_that_became_unreadable_is_one_sentence_and_nothing_is_lost(stage: Stage) -> None:
    before = stage.studio.session.document
    path_of(stage).write_text("{")
    wait(stage, True)
    for words in ("Reload", "Compare"):
        press(stage, words)
        question = stage.studio.desk.question
        assert question is not None
        assert "\n" not in question.words
        assert question.words.endswith(".")
        question.close()
    assert stage.studio.session.document is before
    assert bar(stage).isVisible()


def test_another_program_takes_the_bar_away(stage: Stage) -> None:
    changed(stage)
    stage.studio.session.new()
    QApplication.processEvents()
    assert bar(stage).isHidden()


def test_examples_open_as_copies(stage: Stage) -> None:
    menu = stage.studio.window.submenus["examples"]
    menu.aboutToShow.emit()
    texts = [action.text() for action in menu.actions()]
    assert len(texts) == len(list(resources.path("examples").glob("*.tlp")))
    feeder = next(action for action in menu.actions() if action.text().startswith("CUTTER"))
    feeder.trigger()
    stage.go()
    session = stage.studio.session
    assert session.path is None  # Save asks for a name: what is shipped stays as it is
    assert session.document.program.name == "CUTTER"
    menu.aboutToShow.emit()
    assert [action.text() for action in menu.actions()] == texts


@pytest.mark.alone
def test_a_large_program_is_read_beside_the_window(stage: Stage, tmp_path: Path) -> None:
    """1000 steps: no tick waits for them."""
    path, session = tmp_path / "large.tlp", stage.studio.session
    files.save(path, large_document())
    stage.studio.window.show()
    stage.connect("machine")

    def opening() -> dict[str, float]:
        ticks = Ticks(stage)
        session.new()
        stage.go()
        ticks.phase("longest tick while 1000 steps are opened", lambda: stage.studio.files.open_path(path),
            lambda: session.path == path, then=3)  # fmt: skip
        assert session.document == large_document() and not session.dirty
        assert stage.studio.program.tree.model().rowCount() > 1000
        return ticks.worst

    assert too_long("pytest tests/app/test_files.py", opening, bare=is_long()) == {}
    assert session.listing.lines[-1].text


def test_stop_goes_out_and_work_is_kept_while_a_large_program_is_read(stage: Stage, tmp_path: Path) -> None:
    path, session = tmp_path / "large.tlp", stage.studio.session
    files.save(path, large_document())
    stage.connect("machine")
    stage.studio.files.open_path(path)
    assert session.path != path  # it is being read
    QTest.keyClick(stage.studio.window, Qt.Key.Key_F12)
    session.insert([Label(name="MINE")])
    stage.until(lambda: any("was not opened" in text for text in stage.studio.messages.texts()))
    assert stage.controller.stop_state is StopState.STOPPED
    assert session.path != path and session.dirty
    stage.studio.files.open_path(path)
    stage.until(lambda: session.path == path)


def test_a_large_file_that_is_none_is_said(stage: Stage, tmp_path: Path) -> None:
    path = tmp_path / "large.tlp"
    path.write_text("no program" * 9000)
    before = stage.studio.session.document
    stage.studio.files.open_path(path)
    stage.until(lambda: stage.studio.desk.question is not None)
    question = stage.studio.desk.question
    assert question is not None and question.windowTitle() == "The program cannot be opened"
    assert stage.studio.session.document is before
