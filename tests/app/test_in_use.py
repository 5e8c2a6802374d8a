"""Two studios on one file or one port: the second one says who has it."""

from __future__ import annotations

import getpass
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

import resources
from app.in_use import note_of, user_of
from app.session import Session
from codegen import files
from codegen.document import Document
from codegen.instructions import Output
from codegen.program import Program
from tests.app.test_run import answer, asked
from tests.stage import Stage

OTHER = """
import sys
from pathlib import Path
from app.in_use import Claim
claim = Claim()
claim.take(Path(sys.argv[1]))
print("open", flush=True)
sys.stdin.readline()
claim.release()
"""


class Other:
    """Another studio in a process of its own that has the file open."""

    def __init__(self, path: Path) -> None:
        root = Path(__file__).parents[2]
        self.process = subprocess.Popen(
            [sys.executable, "-c", OTHER, str(path)], cwd=root, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
        assert self.process.stdout is not None
        assert self.process.stdout.readline() == "open\n"

    def close(self) -> None:
        assert self.process.stdin is not None
        if self.process.poll() is None:
            self.process.stdin.write("\n")
            self.process.stdin.flush()
            self.process.wait(20)

    def crash(self) -> None:
        os.kill(self.process.pid, signal.SIGKILL)
        self.process.wait(20)


@pytest.fixture
def program(tmp_path: Path) -> Path:
    path = tmp_path / "cutter.tlp"
    files.save(path, Document(Program("CUTTER")))
    return path


@pytest.fixture
def other(program: Path) -> Iterator[Other]:
    found = Other(program)
    yield found
    found.close()


def test_opening_asks_and_names_who_has_it(stage: Stage, program: Path, other: Other) -> None:
    before = stage.studio.session.path
    stage.studio.files.open_path(program)
    words, answers = asked(stage)
    assert f"{getpass.getuser()} on this computer (process {other.process.pid}), since " in words
    assert set(answers) == {"Open a copy", "Open it anyway"}
    assert stage.studio.session.path == before  # nothing is open until it was answered
    answer(stage, "Open a copy")
    assert stage.studio.session.path is None
    assert stage.studio.session.document.program.name == "CUTTER"


def test_opening_anyway_leaves_the_note_of_the_other(stage: Stage, program: Path, other: Other) -> None:
    stage.studio.files.open_path(program)
    answer(stage, "Open it anyway")
    assert stage.studio.session.path == program
    stage.studio.session.close()
    assert user_of(program)
    other.close()
    assert user_of(program) == ""
    assert not note_of(program).exists()


def test_after_a_crash_nobody_has_it(stage: Stage, program: Path, other: Other) -> None:
    other.crash()
    assert note_of(program).exists()
    stage.studio.files.open_path(program)
    assert stage.studio.session.path == program
    stage.studio.session.close()
    assert not note_of(program).exists()


def test_a_note_of_another_computer_counts_however_old_it_is(program: Path) -> None:
    note_of(program).write_text("4711\npython3\nPANEL-PC\n00000000000000000000000000000000\n")
    os.utime(note_of(program), (0, 0))
    assert "on PANEL-PC (process 4711)" in user_of(program)


def test_a_note_that_is_none_hinders_nobody(program: Path) -> None:
    note_of(program).write_bytes(b"\xff\x00 nothing")
    assert user_of(program) == ""


def test_the_note_follows_the_file(tmp_path: Path, program: Path, qtbot: object) -> None:
    session = Session()
    session.open(program)
    assert note_of(program).exists()
    assert user_of(program) == ""  # it is ours
    session.insert([Output(output="2")])
    session.save_as(tmp_path / "second.tlp")
    assert not note_of(program).exists()
    assert note_of(tmp_path / "second.tlp").exists()
    session.new()
    assert list(tmp_path.glob(".*in-use")) == []


def test_saving_over_a_file_that_is_open_elsewhere_is_asked_about(stage: Stage, program: Path, other: Other) -> None:
    stage.studio.files._save_to(program, None)
    words, answers = asked(stage)
    assert "Its work would be overwritten" in words
    assert set(answers) == {"Save under another name", "Overwrite it"}
    assert files.load(program).program.name == "CUTTER"


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_a_folder_that_takes_no_note_is_no_hindrance(tmp_path: Path, program: Path) -> None:
    tmp_path.chmod(0o500)
    session = Session()
    session.open(program)
    tmp_path.chmod(0o700)
    assert session.path == program


def test_nothing_is_written_beside_what_is_shipped() -> None:
    example = Path(resources.path("examples/wire-cutter.tlp"))
    session = Session()
    session.open(example)
    assert not note_of(example).exists()
    session.close()
