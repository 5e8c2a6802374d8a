"""On a German computer no number is ever misread: the real studio, in a process with that environment."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

WALKED = (
    "fields of dialogs",
    "lines of the set-up",
    "displays",
    "terminal lines",
    "answers to the program",
    "spin boxes",
)


@pytest.mark.paced
def test_no_number_is_misread_anywhere(tmp_path: Path) -> None:
    german = {
        "LANG": "de_DE.UTF-8",
        "LC_ALL": "de_DE.UTF-8",
        "LC_NUMERIC": "de_DE.UTF-8",
        "QT_QPA_PLATFORM": "offscreen",
    }
    words = [sys.executable, "-m", "tests.app.german", str(tmp_path)]
    root = Path(__file__).parents[2]
    done = subprocess.run(words, cwd=root, env={**os.environ, **german}, capture_output=True, text=True, timeout=200)
    assert done.returncode == 0, done.stderr[-3000:]
    said = dict(line.split(" ", 1)[::-1] for line in done.stdout.splitlines() if line[:1].isdigit())
    assert all(int(said[each]) > 0 for each in WALKED), done.stdout
    assert int(said["fields of dialogs"]) > 150
