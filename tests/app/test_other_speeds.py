"""The tests of the panels once more, over a line at the other two speeds of these controllers."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
# those whose steps need no particular pace: what is seen for the time of a tick only is left to 19 200
PANELS = (
    *(f"tests/widgets/{name}" for name in (
        "commissioning", "display", "jog", "plane", "scope", "simulator", "teach/test_teach.py", "terminal", "values",
    )),
    *(f"tests/app/test_{name}.py" for name in (
        "backups", "doctor_desk", "editor", "event_list", "live_values", "operator", "recorder", "slow_run", "stop",
        "tracing", "watch",
    )),
)  # fmt: skip


@pytest.mark.long
@pytest.mark.parametrize("baud", ["9600", "38400"])
def test_every_panel_works_at(baud: str) -> None:
    around = {**os.environ, "TEST_BAUD": baud, "TWOLETTER_LONG": ""}
    run = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-m", "not long", *PANELS],
        cwd=ROOT,
        env=around,
        capture_output=True,
        text=True,
        timeout=1500,
    )
    told = run.stdout.strip().splitlines()
    assert run.returncode == 0, "\n".join(line for line in told if line.startswith(("FAILED", "ERROR", "E  ")))
    assert " passed" in told[-1]
