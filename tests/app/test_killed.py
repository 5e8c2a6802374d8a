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
@pytest.mark.timeout(count(240, 3600))
@pytest.mark.paced
def test_killed_at_random_moments(tmp_path: Path) -> None:
    """The everyday run keeps copies after 30 ms instead of a second, so that its lives are short."""
    kills, autosave, beside = count(50, 1000), AUTOSAVE_MS if is_long() else 30, count(1, 4)
    worst = 0.0
    running = [_killing(tmp_path / str(number), kills // beside, autosave, SEED + number) for number in range(beside)]
    for process in running:
        said, complaint = process.communicate()
        assert process.returncode == 0, complaint[-2000:]
        worst = max(worst, float(said.split()[0]))
    assert worst <= ALLOWED_S
    record("editing lost at worst by a kill", "pytest tests/app/test_killed.py", SEED, worst, f"s ({kills} kills)")


def _killing(folder: Path, kills: int, autosave_ms: int, seed: int) -> subprocess.Popen[str]:
    folder.mkdir()
    words = [sys.executable, "-m", "tests.app.killing", str(folder), str(kills), str(autosave_ms), str(seed)]
    root = Path(__file__).parents[2]
    return subprocess.Popen(words, cwd=root, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def test_a_copy_is_kept_a_second_after_an_edit() -> None:
    assert AUTOSAVE_MS <= 1000
