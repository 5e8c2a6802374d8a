"""The window killed while it tunes, the machine in another process: OE, ER and limits hold; the next start offers."""

from __future__ import annotations

import os
import random
import select
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from PySide6.QtWidgets import QApplication

from device.former import left_behind, meant
from device.simulator.process import SimulatorProcess
from tests.app.tuning_life import click, studio_at
from tests.device.test_latency import NO_PTY
from tests.device.tuning.life import BAUD, connected
from tests.device.tuning.test_killed import ERROR, FORMER, FURTHEST, held, set_up, stays
from tests.long import count, record
from tests.stage import Clock, Stage
from widgets.parts.question import Question

COMMAND = "pytest tests/app/test_tuning_killed.py"
LATEST_S = 5.0  # after the first click on Start
WELL_AMID_S = 0.4  # after the former values came on the disk: a run takes longer
PATIENCE_S, BEGINS_S = 60.0, count(90, 300)
SEED = 5
pytestmark = [NO_PTY, pytest.mark.paced, pytest.mark.timeout(count(240, 3600))]


def test_the_window_killed_at_any_moment_of_tuning(qapp: QApplication, tmp_path: Path) -> None:
    kills = count(1, 50)
    found = [one(qapp, tmp_path / str(number), SEED + number, number == 0) for number in range(kills)]
    assert any(found)  # some were killed in the middle
    record("windows killed while tuning, all put back by the next start", COMMAND, SEED, kills, "kills")
    record("of them in the middle of a run of the window", COMMAND, SEED, sum(found), "kills")


def one(qapp: QApplication, folder: Path, seed: int, amid: bool) -> bool:
    """One life, ended amid a run or at any moment; whether it left something to put back."""
    folder.mkdir()
    with SimulatorProcess("ssc2", baud=BAUD, pty=True) as machine:
        set_up(machine)
        live_and_die(machine, folder, seed, amid)
        stays(machine)
        left, changed = left_of(machine, folder)
        offered(qapp, machine, folder, left, changed)
        after = connected(machine.address)
        assert held(after) == FORMER
        after.close()
    return left


def live_and_die(machine: SimulatorProcess, folder: Path, seed: int, amid: bool) -> None:
    words = [sys.executable, "-m", "tests.app.tuning_life", machine.address, str(BAUD), str(folder), str(seed)]
    around = {**os.environ, "PYTHONPATH": os.getcwd(), "QT_QPA_PLATFORM": "offscreen"}
    process = subprocess.Popen(words, stdout=subprocess.PIPE, text=True, env=around)
    assert process.stdout is not None
    try:
        assert select.select([process.stdout], [], [], BEGINS_S)[0], "it did not begin"
        assert process.stdout.readline() == "ready\n"
        if amid:
            in_a_run(folder / "tuning", random.Random(seed).uniform(0.0, WELL_AMID_S))
        else:
            time.sleep(random.Random(seed).uniform(0.1, LATEST_S))
    finally:
        process.send_signal(signal.SIGKILL)
        process.wait()
        process.stdout.close()


def in_a_run(kept: Path, later_s: float) -> None:
    """Until what was before is on disk, and a little later still is."""
    end = time.monotonic() + PATIENCE_S
    while True:
        assert time.monotonic() < end, "no run began"
        if left_behind(kept):
            time.sleep(later_s)
            if left_behind(kept):
                return
        time.sleep(0.005)


def left_of(machine: SimulatorProcess, folder: Path) -> tuple[bool, list[str]]:
    """Whether what was before is on disk, and what differs from it now: changed gains stand between the guards."""
    controller = connected(machine.address)
    there = held(controller)
    left = [former for former in left_behind(folder / "tuning") if meant(former, controller)]
    controller.close()
    changed = [name for name in FORMER if there[name] != FORMER[name]]
    if {"KP", "KD", "KI"} & set(changed):
        assert left and there["OE"] == 1 and there["ER"] <= ERROR
        assert -FURTHEST <= there["BL"] <= there["FL"] <= FURTHEST
    return bool(left), changed


def offered(qapp: QApplication, machine: SimulatorProcess, folder: Path, left: bool, changed: list[str]) -> None:
    """The next start of the window offers the former gains first thing, and puts them back by a click."""
    studio = studio_at(qapp, machine.address, BAUD, folder)
    studio.window.show()
    try:
        end = time.monotonic() + PATIENCE_S
        while left and left_behind(folder / "tuning"):
            qapp.processEvents()
            for question in studio.window.findChildren(Question):
                if question.isVisible():
                    assert "tuning of axis X" in question.words
                    before = question.words.partition("Before it:")[2]
                    assert all(f"{name} {FORMER[name]:g}" in before for name in changed)
                    click(question.buttons["Take Control and put them back"])
            time.sleep(0.005)
            assert time.monotonic() < end, "the former gains were not put back"
    finally:
        Stage(studio, Clock(), []).clear_away()
