"""The window closed in the very moment in which something is kept: nothing is lost, nothing holds anybody up."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QLineEdit

from codegen.instructions import SingleAxisMove
from device.capture_file import load
from device.recorder_read import open_recording
from device.tuning import logbook
from device.tuning.logbook import Logbook
from tests.app.test_tuner import click, tuner
from tests.device.tuning.test_logbook import RUN
from tests.stage import Stage, make_studio
from tests.widgets.scope.hands import click as push
from tests.widgets.scope.hands import scope
from tests.widgets.teach.bench import Bench
from widgets.parts.question import Question
from widgets.tuner.panel import LOGBOOK


def end(stage: Stage) -> None:
    """As the program does it once the window has gone; the stage does not do it again."""
    stage.studio.close()
    stage.studio.close = lambda: None  # type: ignore[method-assign]


def close(stage: Stage) -> None:
    """The cross of the window; then as long as it waits for the disk."""
    stage.studio.window.close()
    stage.until(lambda: not stage.studio.window.isVisible())
    end(stage)
    left = [each.name for each in threading.enumerate() if each.name.startswith(("logbook", "background"))]
    assert left == []


@pytest.fixture
def again(stage: Stage, tmp_path: Path) -> Iterator[Callable[[], Stage]]:
    """The next start."""
    made: list[Stage] = []

    def start() -> Stage:
        made.append(make_studio(tmp_path, example=""))
        made[-1].studio.window.show()
        made[-1].go()
        return made[-1]

    yield start
    for each in made:
        each.clear_away()


class SlowDisk:
    """Lets nothing through until it is told to; or fails then."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.ready, self.reached, self.full = threading.Event(), threading.Event(), False
        fsync = os.fsync

        def held(file: int) -> None:
            if threading.current_thread() is not threading.main_thread():
                self.reached.set()
                assert self.ready.wait(30)
                if self.full:
                    raise OSError(28, "No space left on device")
            fsync(file)

        monkeypatch.setattr(logbook.os, "fsync", held)


@pytest.fixture
def disk(monkeypatch: pytest.MonkeyPatch) -> Iterator[SlowDisk]:
    made = SlowDisk(monkeypatch)
    yield made
    made.ready.set()


def book_of(stage: Stage) -> Logbook:
    """As it is on the disk."""
    (file,) = (stage.studio.data / "tuning").glob("*.jsonl")
    return Logbook(file)


def test_a_run_and_the_note_that_was_just_typed_are_in_the_logbook(
    stage: Stage, again: Callable[[], Stage], disk: SlowDisk
) -> None:
    studio, panel = stage.studio, tuner(stage)
    part = studio.at_machine.tuning
    part.book.add(RUN)
    panel.open_page(LOGBOOK)
    page = panel.logbook
    page.runs.setCurrentRow(0)
    page.note.setFocus()
    QTest.keyClicks(page.note, "good")  # the field is never left
    studio.window.close()
    assert disk.reached.wait(30)  # the line of the run, which a thread writes
    stage.go(5)
    assert studio.window.isVisible() and book_of(stage).entries[0].note == ""  # its disk is slow: it is waited for
    disk.ready.set()
    close(stage)
    (entry,) = book_of(stage).entries
    assert entry.note == "good" and entry.gains == RUN.gains
    after = again()
    tuner(after)
    assert [each.note for each in after.studio.at_machine.tuning.book.book.entries] == ["good"]


def test_a_line_that_could_not_be_written_keeps_the_window_until_it_is_closed_again(
    stage: Stage, disk: SlowDisk
) -> None:
    studio, disk.full = stage.studio, True
    tuner(stage)
    studio.at_machine.tuning.book.add(RUN)
    studio.window.close()
    stage.go()
    disk.ready.set()
    stage.until(lambda: any(words.startswith("Not left:") for words in studio.messages.texts()))
    assert any("its newest line is lost: No space left on device" in words for words in studio.messages.texts())
    assert studio.window.isVisible()
    close(stage)


def test_a_disk_that_hangs_holds_nobody_who_closes_again(stage: Stage, disk: SlowDisk) -> None:
    tuner(stage)
    stage.studio.at_machine.tuning.book.add(RUN)
    stage.studio.window.close()
    stage.go()
    assert stage.studio.window.isVisible()
    stage.studio.window.close()
    assert not stage.studio.window.isVisible()
    disk.ready.set()
    end(stage)  # what the end of the program waits for
    assert len(book_of(stage).entries) == 1


def test_live_values_that_roll_are_in_a_file_and_open_at_the_next_start(
    stage: Stage, again: Callable[[], Stage], tmp_path: Path
) -> None:
    body = scope(stage)
    body.choices.count.setValue(123)  # remembered half a second later
    push(body.bar.live)
    stage.rig.controller.ask("PR 4000;BG X")
    stage.go(40)
    roll = stage.studio.at_machine.scope.roll
    assert roll is not None
    seen = [track.numbered(0, track.count)[1] for track in roll.tracks.values()]
    assert all(len(values) > 5 for values in seen) and np.ptp(seen[0]) > 1000
    close(stage)
    (path,) = (tmp_path / "captures").glob("* live.npz")
    kept = load(path)
    assert kept.moments is not None
    for row, values in zip(kept.values, seen, strict=True):
        assert np.array_equal(row[np.isfinite(row)][: len(values)], values)
    after = again()
    after.studio.actions["scope"].trigger()
    after.go()
    found = after.studio.at_machine.curves.body
    assert found is not None and found.choices.count.value() == 123
    after.studio.at_machine.scope.open(path)
    after.until(lambda: found.shown is not None)
    assert found.shown.count == kept.count


def test_a_way_that_is_being_recorded_is_in_the_table_of_the_next_start(qapp: QApplication, tmp_path: Path) -> None:
    bench = Bench(tmp_path).connect()
    bench.enable()
    bench.click(bench.parts.way)
    for x, y in ((1, 0), (0, 1), (0, 0)):
        bench.push(x, y)
        bench.stage.go(35)
    bench.still()
    assert bench.rows == ()
    bench.stage.studio.session.save()
    close(bench.stage)
    rows, place = bench.rows, bench.places
    bench.stage.clear_away()
    again = Bench(tmp_path)
    again.stage.go()
    assert 2 <= len(rows) == len(again.rows) and again.rows == rows
    assert (float(rows[-1]["x"]) * 1000, float(rows[-1]["y"]) * 1000) == place
    again.stage.clear_away()


def test_a_recording_and_a_bundle_that_were_just_asked_for_are_whole(
    stage: Stage, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    stage.connect("simulator", "ssc2")
    tape, bundle = tmp_path / "all.tape", tmp_path / "service.zip"
    stage.studio.at_machine.recorded.save(tape)
    stage.studio.at_machine.happened.save_bundle(bundle)
    close(stage)
    assert open_recording(tape).length > 0 and open_recording(bundle).length > 0


def test_leaving_without_saving_asks_once_and_the_code_editor_after_it(stage: Stage) -> None:
    """What is left of unsaved work: nothing, because it was not wanted."""
    studio = stage.studio
    studio.session.set_program(name="OTHER")
    studio.session.autosave_now()
    studio.editor.show()
    editor = studio.editor.window
    assert editor is not None
    editor.text.setFocus()
    QTest.keyClicks(editor.text, "MG 1")
    studio.window.close()
    click(asked(stage, "are not saved").buttons["Do not save"])
    click(asked(stage, "code editor").buttons["Do not keep it"])
    assert not studio.window.isVisible() and not editor.isVisible()
    assert studio.session.recoverable() == () and not list((studio.data / "recovery").glob("*.recovery"))


def asked(stage: Stage, words: str) -> Question:
    QApplication.processEvents()
    (found,) = (each for each in stage.studio.window.findChildren(Question) if each.isVisible())
    assert words in found.words
    return found


def test_a_field_that_was_never_left_counts_as_unsaved_work(stage: Stage) -> None:
    studio = stage.studio
    step = next(each for each in studio.session.document.program.main if isinstance(each.instruction, SingleAxisMove))
    studio.desk.bring("Inspector")
    studio.program.tree.choose([step.id])
    stage.go()
    field = next(
        each for each in studio.program.inspector.findChildren(QLineEdit) if each.isVisible() and each.text() == "10"
    )
    field.setFocus()
    QTest.keyClick(field, Qt.Key.Key_A, Qt.KeyboardModifier.ControlModifier)
    QTest.keyClicks(field, "12")
    studio.window.close()
    assert studio.window.isVisible() and "changes that are not saved" in asked(stage, "saved").words


LIFE = """
import sys
from functools import partial
from PySide6.QtCore import QTimer
import app.studio as program
from widgets.parts.question import Question

begin = program.begin

def lived(studio, file, connect):
    begin(studio, file, connect)
    QTimer.singleShot(0, partial(leave, studio))

def leave(studio):
    studio.at_machine
    studio.session.set_program(name="OTHER")
    studio.actions["exit"].trigger()
    question, = (each for each in studio.window.findChildren(Question) if each.isVisible())
    question.buttons["Do not save"].click()

program.begin = lived
sys.exit(program.run_studio(None, "offline"))
"""


@pytest.mark.paced
def test_the_whole_program_ends_and_what_was_done_last_is_recorded(tmp_path: Path) -> None:
    around = {
        **os.environ, "XDG_CONFIG_HOME": str(tmp_path), "XDG_DATA_HOME": str(tmp_path), "PYTHONPATH": os.getcwd(),
    }  # fmt: skip
    ended = subprocess.run([sys.executable, "-c", LIFE], env=around, timeout=60, capture_output=True, text=True)
    assert ended.returncode == 0, ended.stderr
    (tape,) = tmp_path.glob("*/recordings/*.tape")
    done = [str(note.payload) for note in open_recording(tape).notes]
    assert any(words.startswith("Program: ") for words in done) and "Exit" in done
