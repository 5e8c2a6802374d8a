"""A backup holds everything to the last bit, and a restore puts it back (over the simulator's byte stream)."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from codegen.disk import FileUnreadable
from codegen.models import MODELS
from device.backing_up import Restored, backup_steps, restore_steps
from device.backup import (
    UNNAMED,
    Backup,
    differences,
    dumps,
    from_hexadecimal,
    hexadecimal,
    load,
    loads,
    misfits,
    number_of,
    number_text,
    save,
)
from device.backup_words import missing
from device.download import Job
from device.tasks import LinkError, NotAllowed, Priority
from tests.rig import Rig

PROGRAM = "#A\nDM P[3]\nLEN=1\nCOUNT=COUNT+1\nEN"
VALUES = st.integers(-(1 << 47), (1 << 47) - 1)


def backed_up(rig: Rig, note: str = "") -> Backup:
    job: Job[Backup] = Job()
    future = rig.controller.run(backup_steps(rig.controller, job, note), Priority.DOWNLOAD, "download")
    rig.until(future.done, 120)
    return future.result()


def restored(rig: Rig, backup: Backup) -> Restored:
    job: Job[Restored] = Job()
    future = rig.controller.run(restore_steps(rig.controller, backup, job), Priority.DOWNLOAD, "download")
    rig.until(future.done, 240)
    return future.result()


def changed_controller() -> Rig:
    """One that was worked with: gains, limits, a program, a variable with a fraction, a string, an array."""
    rig = Rig(model="ssc2", program=PROGRAM)
    rig.ready()
    for line in (
        "KP 12.25,7;KI .5;FL 20000,30000;ER 800;OE 1,1",
        "OF -1.5;TL 4.5;SP 12345;AC 512000",
        'LEN=-3.25;COUNT=7;WORD="ABC"',
        "DM P[3];P[0]=1;P[1]=-2.5;P[2]=$7FFFFFFF.FFFF",
    ):
        assert rig.result(rig.controller.ask(line)).accepted, line
    return rig


@given(VALUES)
def test_numbers_are_kept_to_the_last_bit(value: int) -> None:
    assert from_hexadecimal(hexadecimal(value)) == value
    assert number_of(number_text(value)) == value


@pytest.mark.parametrize("text", ["12,5", "1e3", "0.1", "", "--1", "1.", "99999999999", "0x10", "１"])
def test_a_number_in_a_file_is_never_guessed(text: str) -> None:
    with pytest.raises(ValueError, match="controller"):
        number_of(text)


def test_a_backup_holds_what_was_set() -> None:
    backup = backed_up(changed_controller(), "before the rebuild")
    assert backup.model == "ssc2" and backup.note == "before the rebuild"
    assert backup.parameters["KP"] == (12 * 65536 + 16384, 7 * 65536)
    assert backup.parameters["OF"][0] // 65536 == -2  # -1.5 within the step of the converter
    assert backup.parameters["FL"] == (20000 * 65536, 30000 * 65536)
    assert backup.program == PROGRAM
    assert backup.variables["LEN"] == -(3 * 65536 + 16384)
    assert backup.arrays["P"] == (65536, -(5 * 32768), (1 << 47) - 1)
    assert set(backup.not_read) == {"CC", "CN", "CW", "EO", UNNAMED}
    assert "variables and arrays that its program does not name" in "".join(missing(backup))


def test_the_file_reads_back_as_it_was(tmp_path: Path) -> None:
    backup = backed_up(changed_controller())
    save(tmp_path / "a.tlb", backup)
    assert load(tmp_path / "a.tlb") == backup


def test_a_restore_makes_another_controller_the_same() -> None:
    backup = backed_up(changed_controller())
    other = Rig(model="ssc2")
    other.ready()
    done = restored(other, backup)
    assert done.complete, (done.refused, done.left)
    again = backed_up(other)
    assert not differences(backup, again)
    assert again.program == PROGRAM and again.variables["LEN"] == backup.variables["LEN"]
    assert again.motors_on == ""  # a restored controller holds no torque before a person says so
    assert "motors are off" in done.sentence and "nothing is burned" in done.sentence


def test_a_cancelled_restore_says_what_to_do() -> None:
    backup = backed_up(changed_controller())
    other = Rig(model="ssc2")
    other.ready()
    job: Job[Restored] = Job()
    future = other.controller.run(restore_steps(other.controller, backup, job), Priority.DOWNLOAD, "download")
    other.until(lambda: job.done >= 3, 60)
    job.cancel()
    other.until(future.done, 60)
    with pytest.raises(LinkError, match=r"cancelled after \d+ of \d+ lines: the motors are off.*restore once more"):
        future.result()


def test_another_model_is_refused_with_the_reasons() -> None:
    backup = backed_up(changed_controller())
    other = Rig(model="ssc1")
    other.ready()
    with pytest.raises(NotAllowed, match="ssc2, this is a ssc1; it has the axes X Y, this has X"):
        restored(other, backup)
    assert backed_up(other).program == ""  # nothing was sent
    assert misfits(backup, MODELS["ssc2"]) == []


def test_while_a_program_runs_nothing_is_restored() -> None:
    backup = backed_up(changed_controller())
    other = Rig(model="ssc2", program="#A\nWT 1000\nJP #A")
    other.ready()
    assert other.result(other.controller.ask("XQ #A")).accepted
    with pytest.raises(NotAllowed, match="a program is running"):
        restored(other, backup)


def test_in_watch_nothing_is_restored() -> None:
    backup = backed_up(changed_controller())
    other = Rig(model="ssc2")
    other.ready()
    other.controller.release_control()
    with pytest.raises(NotAllowed, match="Watch"):
        restored(other, backup)


def test_a_question_in_the_middle_of_a_reading_gets_no_answer_from_it() -> None:
    """A program asks (IN) while the controller is read to be compared: reading ends, the question stands."""
    rig = Rig(model="ssc4", program='#A\nWT 500\nIN "LENGTH?",LEN\nEN')
    rig.ready()
    assert rig.result(rig.controller.ask("XQ #A")).accepted
    job: Job[Backup] = Job()
    steps = backup_steps(rig.controller, job, running=True)
    future = rig.controller.run(steps, Priority.DOWNLOAD, "download")
    rig.until(future.done, 30)
    with pytest.raises(LinkError):
        future.result()
    rig.until(lambda: rig.controller.pending_prompt is not None, 5)
    assert rig.running == [2]  # still waiting: nothing that was read became its answer
    rig.result(rig.controller.answer("7.5"))
    rig.until(lambda: not rig.running, 5)
    assert rig.result(rig.controller.read("LEN")) == (7.5,)


def test_differences_are_said_in_words() -> None:
    backup = backed_up(changed_controller())
    other = replace(
        backup,
        parameters={**backup.parameters, "KP": (6 * 65536, 7 * 65536)},
        program=PROGRAM.replace("LEN=1", "LEN=2"),
        variables={},
    )
    said = differences(backup, other)
    assert any("of X (KP) is 6, the back-up has 12.25" in text for text in said)
    assert "the program differs first at line 2" in said
    assert "variable LEN is missing" in said


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (('"version": 1', '"version": 9'), "newer program"),
        (('"model": "ssc2"', '"model": "ssc9"'), "no controller model 'ssc9'"),
        (('"12.25"', '"12,25"'), "KPX: '12,25' is not a number"),
        (('"format": "twoletter backup"', '"format": "other"'), "does not say that it is one"),
        (('"KP": {', '"QQ": {'), "QQ is none of a ssc2"),
        (("{", "["), "line 2"),
    ],
)
def test_a_spoilt_file_is_one_sentence(change: tuple[str, str], reason: str) -> None:
    text = dumps(backed_up(changed_controller()))
    assert change[0] in text
    with pytest.raises(FileUnreadable, match=reason.replace("(", "\\(")):
        loads(text.replace(*change, 1))
