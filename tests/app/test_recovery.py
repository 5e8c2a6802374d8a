"""Unsaved work after a crash: all of it is offered, with a file as without, and nothing is lost on the way."""

from __future__ import annotations

import os
from datetime import datetime, timedelta
from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.recovery import Recovery
from app.studio import begin
from codegen.document import Document
from codegen.instructions import Label
from codegen.program import Program, Step
from tests.stage import Stage
from widgets.unsaved.window import UnsavedWork

NOW = datetime(2026, 5, 4, 10, 30)


def leave(stage: Stage, name: str, hours: int = 0, original: Path | None = None) -> Document:
    """What a crash leaves behind: a recovery copy that nobody locks."""
    document = Document(Program(name=name, main=(Step(id="s1", instruction=Label(name=name)),)))
    folder = path(stage).parent / "recovery"
    Recovery(folder).set_aside(document, original, NOW + timedelta(hours=hours))
    return document


def path(stage: Stage) -> Path:
    found = stage.studio.session.path
    assert found is not None
    return found


def window(stage: Stage) -> UnsavedWork:
    found = stage.studio.desk.unsaved
    assert found is not None
    return found


def lines(stage: Stage) -> list[str]:
    shown = window(stage).list
    return [shown.item(row).text() for row in range(shown.count())]


def click(stage: Stage, words: str) -> None:
    button = {"Recover": window(stage).recover, "Throw away": window(stage).forget, "Later": window(stage).later}[words]
    QTest.mouseClick(button, Qt.MouseButton.LeftButton)
    stage.go()


def test_everything_that_was_left_is_offered_newest_first_with_time_name_and_size(stage: Stage) -> None:
    leave(stage, "FIRST", 0)
    leave(stage, "THIRD", 2, path(stage).parent / "third.tlp")
    leave(stage, "SECOND", 1)
    begin(stage.studio, None, "offline")
    stage.go(1)
    assert [line.split(" – ")[:3] for line in lines(stage)] == [
        ["third.tlp", "2026-05-04 12:30", "1 step"],
        ["SECOND", "2026-05-04 11:30", "1 step"],
        ["FIRST", "2026-05-04 10:30", "1 step"],
    ]
    assert window(stage).isVisible()


def test_one_is_recovered_the_others_stay(stage: Stage) -> None:
    second, first = leave(stage, "SECOND", 1), leave(stage, "FIRST")
    begin(stage.studio, None, "offline")
    stage.go(1)
    window(stage).list.setCurrentRow(1)
    click(stage, "Recover")
    assert stage.studio.session.document == first
    assert stage.studio.session.dirty
    assert not window(stage).isVisible()
    assert [left.document for left in stage.studio.session.recoverable()] == [second]
    assert "1 more unsaved document stay" in stage.studio.messages.texts()[-1]


def test_later_keeps_everything(stage: Stage) -> None:
    leave(stage, "FIRST")
    begin(stage.studio, None, "offline")
    stage.go(1)
    click(stage, "Later")
    assert len(stage.studio.session.recoverable()) == 1


def test_what_is_thrown_away_is_asked_about(stage: Stage) -> None:
    kept = leave(stage, "FIRST")
    leave(stage, "SECOND", 1)
    begin(stage.studio, None, "offline")
    stage.go(1)
    click(stage, "Throw away")
    assert len(stage.studio.session.recoverable()) == 2
    question = stage.studio.desk.question
    assert question is not None
    assert "SECOND" in question.words
    QTest.mouseClick(question.buttons["Throw it away"], Qt.MouseButton.LeftButton)
    assert [left.document for left in stage.studio.session.recoverable()] == [kept]
    assert [line.split(" – ")[0] for line in lines(stage)] == ["FIRST"]


def test_recovering_sets_unsaved_work_aside_that_is_open(stage: Stage) -> None:
    left = leave(stage, "FIRST")
    stage.studio.desk.offer_recovery()
    stage.studio.session.insert([Label(name="OPEN")])
    mine = stage.studio.session.document
    click(stage, "Recover")
    assert stage.studio.session.document == left
    assert [each.document for each in stage.studio.session.recoverable()] == [mine]


def test_with_a_file_the_newer_work_on_it_is_offered(stage: Stage) -> None:
    file = path(stage)
    leave(stage, "FOREIGN", 5)
    work = leave(stage, "WORK", 1, file)
    before = (NOW - timedelta(days=1)).timestamp()
    os.utime(file, (before, before))
    begin(stage.studio, Path(os.path.relpath(file)), "offline")
    question = stage.studio.desk.question
    assert question is not None
    assert question.words == "Unsaved work on wire-cutter.tlp (2026-05-04 11:30) is newer than the file. It is kept."
    assert stage.studio.session.document != work  # the file is open until something else is chosen
    QTest.mouseClick(question.buttons["Recover it"], Qt.MouseButton.LeftButton)
    assert stage.studio.session.document == work
    assert path(stage) == file
    assert [left.name for left in stage.studio.session.recoverable()] == ["FOREIGN"]


def test_with_a_file_that_was_saved_later_nothing_is_asked(stage: Stage) -> None:
    file = path(stage)
    leave(stage, "WORK", 1, file)
    after = (NOW + timedelta(days=1)).timestamp()
    os.utime(file, (after, after))
    begin(stage.studio, file, "offline")
    assert stage.studio.desk.question is None
    stage.studio.desk.offer_recovery()
    assert "the file was saved later" in lines(stage)[0]


def test_nothing_left_nothing_asked(stage: Stage) -> None:
    begin(stage.studio, None, "offline")
    stage.go(1)
    assert stage.studio.desk.unsaved is None
    assert stage.studio.session.document.program.main  # the sample


def test_the_rest_can_be_fetched_later_from_the_menu(stage: Stage) -> None:
    recover = stage.studio.actions.actions["recover"]
    recover.trigger()
    assert stage.studio.desk.unsaved is None  # nothing there: said, no window
    assert "no unsaved work" in stage.studio.window.status.currentMessage()
    leave(stage, "FIRST")
    recover.trigger()
    assert [line.split(" – ")[0] for line in lines(stage)] == ["FIRST"]
