"""A long run that was interrupted goes on with what has not passed yet."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.long import progress

TESTS = """
from pathlib import Path

def test_right():
    assert True

def test_wrong():
    assert Path("mended").exists()
"""


def run(folder: Path, here: Path) -> str:
    progress.begin_part(folder)
    surroundings = {**os.environ, "TWOLETTER_LONG_RUN": str(folder), "PYTHONPATH": str(progress.ROOT)}
    surroundings["PYTEST_DISABLE_PLUGIN_AUTOLOAD"] = "1"  # starts sooner
    command = [
        sys.executable,
        "-m",
        "pytest",
        "-p",
        "tests.long.progress",
        "-p",
        "no:cacheprovider",
        "-q",
        "test_two.py",
    ]
    done = subprocess.run(command, cwd=here, env=surroundings, capture_output=True, text=True, timeout=120)
    return done.stdout.strip().splitlines()[-1]


def test_what_has_passed_is_left_out(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(progress, "FOLDER", tmp_path / "long")
    (tmp_path / "test_two.py").write_text(TESTS)
    with progress.kept(resume=False) as folder:
        assert "1 failed, 1 passed" in run(folder, tmp_path)
    (tmp_path / "mended").touch()
    with progress.kept(resume=True) as folder:
        assert "1 passed, 1 deselected" in run(folder, tmp_path)
        assert progress.lines(folder / "passed") == {"test_two.py::test_right", "test_two.py::test_wrong"}
    with progress.kept(resume=False) as folder:
        assert progress.lines(folder / "passed") == set()


def test_other_sources_begin_it_anew(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(progress, "FOLDER", tmp_path / "long")
    prints = iter("aab")
    monkeypatch.setattr(progress, "fingerprint", lambda: next(prints))
    for resume, left in ((False, []), (True, ["x"]), (True, [])):
        with progress.kept(resume) as folder:
            assert sorted(progress.lines(folder / "passed")) == left
            (folder / "passed").write_text("x\n")
    assert "sources have changed" in capsys.readouterr().out
