"""A studio that is killed at any moment: the file is the old or the new one, at most 2 s of editing are lost."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from app.session import AUTOSAVE_MS
from tests.long import count, is_long, record

SEED = 3
ALLOWED_S = 2.0


@pytest.mark.skipif(not hasattr(os, "fork"), reason="lives are forks")
def test_killed_at_random_moments(tmp_path: Path) -> None:
    """The everyday run keeps copies after 30 ms instead of a second, so that its lives are short."""
    kills, autosave = count(50, 1000), AUTOSAVE_MS if is_long() else 30
    words = [sys.executable, "-m", "tests.app.killing", str(tmp_path), str(kills), str(autosave), str(SEED)]
    root = Path(__file__).parents[2]
    done = subprocess.run(words, cwd=root, capture_output=True, text=True, timeout=30 + kills * 10)
    assert done.returncode == 0, done.stderr[-2000:]
    worst = float(done.stdout.split()[0])
    assert worst <= ALLOWED_S
    record(f"editing lost at worst in {kills} kills", "pytest tests/app/test_killed.py", SEED, worst, "s")


def test_a_copy_is_kept_a_second_after_an_edit() -> None:
    assert AUTOSAVE_MS <= 1000
