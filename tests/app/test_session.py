"""The session keeps the program safe: history, file, recovery; it never overwrites in silence."""

from __future__ import annotations

import dataclasses as dc
import subprocess
import sys
from datetime import datetime
from pathlib import Path

import pytest
from PySide6.QtCore import QFileSystemWatcher
from pytestqt.qtbot import QtBot

from app.disk import Disk
from app.session import ChangedOnDisk, NoPath, Session
from codegen import files
from codegen.document import Document
from codegen.instructions import AccelDecel, End, Label, LoopRate, Output, Repeat, Subroutine, Wait
from codegen.program import Place, Program, Section, find

NOON = datetime(2026, 11, 22, 12, 0)


class Clock:
    """Seconds that pass only when told to."""

    def __init__(self) -> None:
        self.seconds = 0.0

    def __call__(self) -> float:
        return self.seconds


@pytest.fixture
def clock() -> Clock:
    """A clock at 0."""
    return Clock()


@pytest.fixture
def session(qtbot: QtBot, tmp_path: Path, clock: Clock) -> Session:
    """A new program; autosave only when asked."""
    return Session(recovery_folder=tmp_path / "recovery", clock=clock, now=lambda: NOON, autosave_ms=3_600_000)


def times(session: Session) -> list[str]:
    """The times of the waits in Main."""
    return [step.instruction.time for step in session.document.program.main if isinstance(step.instruction, Wait)]


# ---- editing


def test_every_change_says_the_old_and_the_new_document(session: Session) -> None:
    said: list[tuple[Document, Document]] = []
    session.document_changed.connect(lambda old, new: said.append((old, new)))
    first = session.document
    session.insert([Wait(time="1")])
    assert said == [(first, session.document)]
    session.undo()
    assert said[1][1] is first


def test_undo_and_redo_carry_their_labels(session: Session) -> None:
    (wait,) = session.insert([Wait(time="1")])
    session.replace(wait, Wait(time="2"))
    session.comment_out([wait])
    session.remove([wait])
    labels = []
    while session.can_undo:
        labels.append(session.undo_text)
        session.undo()
    assert labels == ["Delete Wait", "Comment out Wait", "Change Wait", "Add Wait"]
    assert session.redo_text == "Add Wait"
    assert session.undo_text == ""


def test_typing_in_one_field_within_a_second_is_one_step(session: Session, clock: Clock) -> None:
    (wait,) = session.insert([Wait(time="1")])
    for text in ("12", "123"):
        clock.seconds += 0.4
        session.replace(wait, Wait(time=text), "inspector")
    clock.seconds += 5
    session.replace(wait, Wait(time="9"), "inspector")
    session.undo()
    assert times(session) == ["123"]
    session.undo()
    assert times(session) == ["1"]


def test_a_change_to_the_same_value_is_no_change(session: Session) -> None:
    (wait,) = session.insert([Wait(time="1")])
    session.replace(wait, Wait(time="1"))
    assert session.undo_text == "Add Wait"


def test_new_steps_go_to_the_end_of_their_section(session: Session) -> None:
    session.insert([Wait(time="1")])
    session.insert([AccelDecel()])
    session.insert([Wait(time="2")])
    session.insert([LoopRate(period="1000")], None, Section.CONFIGURATION)
    assert times(session) == ["1", "2"]
    assert [type(step.instruction) for step in session.document.program.configuration] == [AccelDecel, LoopRate]


def test_a_subroutine_takes_new_steps_until_its_end(session: Session) -> None:
    session.insert([Subroutine(name="FEED")])
    session.insert([Wait(time="1")])
    session.insert([End()])
    session.insert([Wait(time="2")])
    assert times(session) == ["2"]
    assert len(session.document.program.routines[0].body) == 2


def test_a_repeat_takes_new_steps_until_it_is_left_level_by_level(session: Session) -> None:
    (outer,) = session.insert([Repeat()])
    (inner,) = session.insert([Repeat()])
    session.insert([Wait(time="1")])
    assert session.open_body == inner
    session.leave_body()
    assert session.open_body == outer
    session.insert([Wait(time="2")])
    session.leave_body()
    session.insert([Wait(time="3")])
    assert times(session) == ["3"]
    assert [type(step.instruction) for step in session.document.program.main[0].body] == [Repeat, Wait]


def test_insert_before_a_step_until_told_otherwise(session: Session) -> None:
    _, second = session.insert([Wait(time="1"), Wait(time="2")])
    session.insert_before(second)
    session.insert([Wait(time="3")])
    session.insert([Wait(time="4")])
    assert times(session) == ["1", "3", "4", "2"]
    session.insert_before(None)
    session.insert([Wait(time="5")])
    assert times(session)[-1] == "5"


def test_the_insertion_point_forgets_a_step_that_is_gone(session: Session) -> None:
    (repeat,) = session.insert([Repeat()])
    session.remove([repeat])
    assert session.open_body is None
    session.insert([Wait(time="1")])
    assert times(session) == ["1"]


def test_comment_out_again_brings_back(session: Session) -> None:
    ids = session.insert([Wait(time="1"), Wait(time="2")])
    session.comment_out(ids[:1])
    session.comment_out(ids)
    assert [step.enabled for step in session.document.program.main] == [False, False]
    session.comment_out(ids)
    assert [step.enabled for step in session.document.program.main] == [True, True]
    assert session.undo_text == "Bring back 2 steps"


def test_copies_have_ids_of_their_own(session: Session) -> None:
    ids = session.insert([Wait(time="1"), Label(name="A")])
    pasted = session.paste(session.copy(ids))
    assert len({*ids, *pasted}) == 4
    assert [step.instruction for step in session.document.program.main] == [Wait(time="1"), Label(name="A")] * 2


def test_pasting_something_else_changes_nothing(session: Session) -> None:
    assert session.paste("not a step") == ()
    assert not session.can_undo


def test_steps_move_into_a_repeat(session: Session) -> None:
    (wait,) = session.insert([Wait(time="1")])
    (repeat,) = session.insert([Repeat()])
    session.move([wait], Place(repeat, 0))
    assert [step.id for step in session.document.program.main] == [repeat]
    assert session.undo_text == "Move Wait"


def test_a_place_that_does_not_fit_is_refused_in_words(session: Session) -> None:
    (accel,) = session.insert([AccelDecel()])
    steps = session.document.program.configuration
    assert steps[0].id == accel
    assert session.refusal(steps, Place(Section.MAIN, 0)) == "Accel and Decel belongs to Configuration"
    assert session.refusal(steps, Place(Section.CONFIGURATION, 0)) == ""


def test_the_listing_is_made_once_for_a_document(session: Session) -> None:
    session.insert([Wait(time="20")])
    assert session.listing is session.listing
    assert "WT 20" in session.listing.text


# ---- file


def test_save_open_and_dirty(session: Session, tmp_path: Path) -> None:
    assert not session.dirty
    session.set_program(name="CUTTER")
    session.insert([Wait(time="1")])
    assert session.dirty
    assert session.title == "CUTTER*"
    with pytest.raises(NoPath):
        session.save()
    session.save_as(tmp_path / "cutter.tlp")
    assert not session.dirty
    assert session.title == "cutter.tlp"
    saved = session.document
    session.undo()
    assert session.dirty
    session.redo()
    assert not session.dirty
    session.new()
    session.open(tmp_path / "cutter.tlp")
    assert session.document == saved
    assert not session.can_undo


def test_save_as_never_replaces_a_file_unasked(session: Session, tmp_path: Path) -> None:
    path = tmp_path / "other.tlp"
    path.write_text("precious")
    with pytest.raises(FileExistsError):
        session.save_as(path)
    assert path.read_text() == "precious"
    session.save_as(path, overwrite=True)
    assert files.load(path) == session.document


def test_save_refuses_when_the_file_was_changed_by_somebody_else(session: Session, tmp_path: Path) -> None:
    path = tmp_path / "cutter.tlp"
    session.save_as(path)
    other = Document(Program(name="OTHER"))
    files.save(path, other)
    session.insert([Wait(time="1")])
    with pytest.raises(ChangedOnDisk):
        session.save()
    assert files.load(path) == other
    session.save(overwrite=True)
    assert files.load(path) == session.document


def test_a_change_on_disk_is_noticed(qtbot: QtBot, session: Session, tmp_path: Path) -> None:
    path = tmp_path / "cutter.tlp"
    session.save_as(path)
    with qtbot.waitSignal(session.disk_changed, timeout=5000):
        files.save(path, Document(Program(name="OTHER")))
    assert session.on_disk is Disk.CHANGED
    session.revert()
    assert session.on_disk is Disk.SAME
    assert session.document.program.name == "OTHER"
    assert not session.dirty
    session.undo()  # what was open before the reload is still there
    assert session.document.program.name == ""


def test_a_change_is_noticed_where_the_folder_tells_nothing(qtbot: QtBot, session: Session, tmp_path: Path) -> None:
    path = tmp_path / "cutter.tlp"
    session.save_as(path)
    for watcher in session.findChildren(QFileSystemWatcher):  # as on a network drive
        watcher.blockSignals(True)
    with qtbot.waitSignal(session.disk_changed, timeout=8000):
        files.save(path, Document(Program(name="OTHER")))
    assert session.on_disk is Disk.CHANGED


def test_its_own_saving_is_not_taken_for_somebody_elses(qtbot: QtBot, session: Session, tmp_path: Path) -> None:
    session.save_as(tmp_path / "cutter.tlp")
    states: list[Disk] = []
    session.disk_changed.connect(lambda: states.append(session.on_disk))
    session.insert([Wait(time="1")])
    session.save()
    qtbot.wait(400)
    assert set(states) == {Disk.SAME}


def test_a_file_that_cannot_be_read_leaves_everything_as_it_was(session: Session, tmp_path: Path) -> None:
    session.insert([Wait(time="1")])
    before = session.document
    path = tmp_path / "broken.tlp"
    path.write_text("{")
    with pytest.raises(files.FileUnreadable):
        session.open(path)
    assert session.document is before
    assert session.can_undo
    assert session.path is None


def test_an_example_opens_as_a_copy(session: Session, tmp_path: Path) -> None:
    files.save(tmp_path / "example.tlp", Document(Program(name="EXAMPLE")))
    session.open_copy(tmp_path / "example.tlp")
    assert session.document.program.name == "EXAMPLE"
    assert session.path is None
    assert not session.dirty
    with pytest.raises(NoPath):
        session.save()


# ---- recovery


def test_unsaved_work_is_found_after_a_crash(tmp_path: Path, session: Session, qtbot: QtBot) -> None:
    script = (
        "import os, sys\n"
        "from pathlib import Path\n"
        "from PySide6.QtCore import QCoreApplication\n"
        "from app.session import Session\n"
        "from codegen.instructions import Wait\n"
        "application = QCoreApplication([])\n"
        "session = Session(recovery_folder=Path(sys.argv[1]))\n"
        "session.insert([Wait(time='77')])\n"
        "session.autosave_now()\n"
        "os._exit(1)  # a crash: nothing is closed\n"
    )
    folder = tmp_path / "recovery"
    assert session.recoverable() == ()
    subprocess.run([sys.executable, "-c", script, str(folder)], check=False, timeout=60)
    (found,) = session.recoverable()
    assert found.original == ""
    session.recover(found)
    assert times(session) == ["77"]
    assert session.dirty
    assert session.recoverable() == ()


def test_recovered_work_never_overwrites_a_newer_file_in_silence(session: Session, tmp_path: Path) -> None:
    path = tmp_path / "cutter.tlp"
    crashed = Session(recovery_folder=tmp_path / "recovery")
    crashed.save_as(path)
    crashed.insert([Wait(time="1")])
    crashed.autosave_now()
    kept = next((tmp_path / "recovery").glob("*.recovery"))
    left = tmp_path / "recovery" / "unsaved-8.recovery"
    left.write_bytes(kept.read_bytes())  # as a crash leaves it: nobody holds its lock
    later = Session()
    later.open(path)
    later.insert([Wait(time="2")])
    later.save()
    (found,) = session.recoverable()
    session.recover(found)
    assert (session.path, times(session)) == (path, ["1"])
    with pytest.raises(ChangedOnDisk):
        session.save()
    session.save(overwrite=True)
    crashed.close()


def test_recovered_work_is_saved_where_nobody_else_wrote(session: Session, tmp_path: Path) -> None:
    path = tmp_path / "cutter.tlp"
    crashed = Session(recovery_folder=tmp_path / "recovery")
    crashed.save_as(path)
    crashed.insert([Wait(time="1")])
    crashed.autosave_now()
    kept = next((tmp_path / "recovery").glob("*.recovery"))
    (tmp_path / "recovery" / "unsaved-8.recovery").write_bytes(kept.read_bytes())
    (found,) = session.recoverable()
    session.recover(found)
    session.save()
    assert not session.dirty
    crashed.close()


def test_a_subroutine_takes_the_next_steps_even_while_a_repeat_is_open(session: Session) -> None:
    (loop,) = session.insert([Repeat(count="3")])
    session.insert([Wait(time="1")])
    (routine,) = session.insert([Subroutine(name="SUB1")])
    session.insert([Output(output="1")])
    session.insert([End()])
    session.insert([Wait(time="2")])
    program = session.document.program
    assert [step.instruction for step in find(program, loop).body] == [Wait(time="1")]
    assert [step.instruction for step in find(program, routine).body] == [Output(output="1"), End()]
    assert program.main[-1].instruction == Wait(time="2")


def test_the_work_of_a_running_studio_is_left_alone(session: Session, tmp_path: Path) -> None:
    other = Session(recovery_folder=tmp_path / "recovery")
    other.insert([Wait(time="1")])
    other.autosave_now()
    assert session.recoverable() == ()
    other.close()


def test_a_good_end_leaves_nothing_behind(session: Session, tmp_path: Path) -> None:
    session.insert([Wait(time="1")])
    session.autosave_now()
    assert list((tmp_path / "recovery").glob("*.recovery"))
    session.close()
    assert not list((tmp_path / "recovery").glob("*.recovery"))


def test_saving_makes_the_recovery_copy_needless(session: Session, tmp_path: Path) -> None:
    session.insert([Wait(time="1")])
    session.autosave_now()
    session.save_as(tmp_path / "a.tlp")
    assert not list((tmp_path / "recovery").glob("*.recovery"))


def test_autosave_is_throttled_not_put_off(qtbot: QtBot, tmp_path: Path) -> None:
    session = Session(recovery_folder=tmp_path / "quick", autosave_ms=20)
    session.insert([Wait(time="1")])
    qtbot.waitUntil(lambda: bool(list((tmp_path / "quick").glob("*.recovery"))), timeout=5000)
    session.close()


def test_half_a_recovery_file_is_passed_over(session: Session, tmp_path: Path) -> None:
    (tmp_path / "recovery" / "unsaved-9.recovery").write_text('{"original": ""')
    assert session.recoverable() == ()


def test_a_recovery_folder_that_fills_up_is_said_once_in_words(
    qtbot: QtBot, session: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    assert session._recovery is not None
    monkeypatch.setattr(session._recovery, "write", full)
    session.insert([Wait(time="1")])
    with qtbot.waitSignal(session.autosave_failed) as said:
        session.autosave_now()
    assert said.args == ["Unsaved work cannot be kept safe: No space left on device"]


def test_a_place_that_is_gone_is_told_after_the_document_that_lost_it(session: Session) -> None:
    """Who shows the place looks at the steps: they have to be those of the new document."""
    told: list[str] = []
    session.document_changed.connect(lambda old, new: told.append("document"))
    session.insertion_changed.connect(lambda: told.append("place"))
    (step,) = session.insert([Wait(time="1")])
    session.insert_before(step)
    told.clear()
    session.undo()
    assert session.before is None
    assert told == ["document", "place"]


def test_the_document_is_frozen(session: Session) -> None:
    with pytest.raises(dc.FrozenInstanceError):
        session.document.program = Program()  # type: ignore[misc]
