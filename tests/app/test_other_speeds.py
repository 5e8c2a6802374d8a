"""The tests of the panels once more, over a line at the other two speeds of these controllers."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
# Those whose steps need no particular pace. Left to 19 200: what is seen for the time of a tick only (run, where a
# download takes longer), what has real processes at a speed of its own (operator_live, leaving_live, main_job,
# holding, faults, killed), what measures, and what needs no line at all.
PANELS = (
    *(f"tests/widgets/{name}" for name in (
        "commissioning", "display", "jog", "plane", "scope", "simulator", "teach/test_teach.py", "terminal", "values",
    )),
    *(f"tests/app/test_{name}.py" for name in (
        "backups", "doctor_desk", "editor", "event_list", "homed", "live_values", "operator", "question", "recorder",
        "slow_run", "stop", "tracing", "watch",
    )),
)  # fmt: skip


@pytest.mark.long
@pytest.mark.parametrize("baud", ["9600", "38400"])
@pytest.mark.parametrize("panel", PANELS)
def test_a_panel_works_at(panel: str, baud: str) -> None:
    around = {**os.environ, "TEST_BAUD": baud, "TWOLETTER_LONG": ""}
    run = subprocess.run(
        [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "-m", "not long", panel],
        cwd=ROOT,
        env=around,
        capture_output=True,
        text=True,
        timeout=1800,
    )
    told = run.stdout.strip().splitlines()
    assert run.returncode == 0, "\n".join(line for line in told if line.startswith(("FAILED", "ERROR", "E  ")))
    assert " passed" in told[-1]
