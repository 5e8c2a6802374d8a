"""A studio killed while it tunes: OE, ER and the limits hold the axis; what was before is found, and put back."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from codegen.twoletter.fixed import ONE
from device.api import Controller
from device.former import left_behind, meant, put_back
from device.simulator.process import SimulatorProcess
from tests.device.test_latency import NO_PTY
from tests.device.tuning.life import BAUD, STEP, connected
from tests.long import count, record

FORMER = {
    "KP": 7.0, "KI": 0.5, "KD": 70.0, "ER": 9000.0, "OE": 0.0, "FL": 50000.0, "BL": -50000.0, "SP": 30000.0,
}  # fmt: skip
FURTHEST = STEP + int(STEP * 0.6) + 20  # a step, and the margin for its overshoot
ERROR = int(STEP * 1.5) + 10
LATEST_S = 6.0  # after the first word: anywhere in the first runs
WATCHED_S = 0.7
SEED = 11
pytestmark = [NO_PTY, pytest.mark.paced, pytest.mark.timeout(count(240, 3600))]


def test_killed_at_any_moment_of_tuning(tmp_path: Path) -> None:
    kills = count(3, 50)
    with ThreadPoolExecutor(3) as pool:
        found = list(pool.map(lambda number: one(tmp_path / str(number), SEED + number), range(kills)))
    assert any(found)  # some were killed in the middle
    record(
        "studios killed while tuning, all put back", "pytest tests/device/tuning/test_killed.py", SEED, kills, "kills"
    )
    record("of them in the middle of a run", "pytest tests/device/tuning/test_killed.py", SEED, sum(found), "kills")


def set_up(machine: SimulatorProcess) -> None:
    """Its motor on, and the values that have to be there again at the end."""
    before = connected(machine.address)
    before.ask("SH X").result(30)
    for name, value in FORMER.items():
        assert before.ask(f"{name}X={value:g}").result(30).accepted
    before.close()


def one(folder: Path, seed: int) -> bool:
    """One life; whether it left something to put back."""
    folder.mkdir()
    with SimulatorProcess("ssc2", baud=BAUD, pty=True) as machine:
        set_up(machine)
        live_and_die(machine, folder, seed)
        stays(machine)
        after = connected(machine.address)
        try:
            return recovered(after, folder)
        finally:
            after.close()


def live_and_die(machine: SimulatorProcess, folder: Path, seed: int) -> None:
    words = [sys.executable, "-m", "tests.device.tuning.life", machine.address, str(folder), str(seed)]
    process = subprocess.Popen(words, stdout=subprocess.PIPE, text=True, env={**os.environ, "PYTHONPATH": os.getcwd()})
    assert process.stdout is not None
    assert process.stdout.readline() == "ready\n"
    time.sleep(random.Random(seed).uniform(0.2, LATEST_S))
    process.send_signal(signal.SIGKILL)
    process.wait()
    process.stdout.close()


def stays(machine: SimulatorProcess) -> None:
    """Inside the stated travel, whatever the gains were."""
    end = time.monotonic() + WATCHED_S
    while time.monotonic() < end:
        assert abs(machine.state()["axes"]["X"]["actual"]) <= FURTHEST
        time.sleep(0.02)


def recovered(controller: Controller, folder: Path) -> bool:
    """What the next start finds: guards around changed gains; and everything as before, once it is put back."""
    there = held(controller)
    left = [former for former in left_behind(folder) if meant(former, controller)]
    if there["KP"] != FORMER["KP"] or there["KD"] != FORMER["KD"]:
        assert left and there["OE"] == 1 and there["ER"] <= ERROR and there["FL"] <= FURTHEST
    if left:
        assert {name: left[0].values[name] / ONE for name in FORMER} == FORMER
        assert "KP 7, KI 0.5, KD 70" in put_back(controller, left[0]).result(60)
    assert held(controller) == FORMER
    assert left_behind(folder) == ()
    return bool(left)


def held(controller: Controller) -> dict[str, float]:
    values = controller.read(*(f"_{name}X" for name in FORMER)).result(60)
    return dict(zip(FORMER, values, strict=True))
