"""The studio killed while it brings an axis to life, the machine in another process: guards hold, the start offers."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from PySide6.QtWidgets import QApplication

import resources
from app.found_working import TITLE
from codegen.twoletter.fixed import ONE
from device.api import Controller
from device.commissioning.record import Record, Verdict, resumed
from device.commissioning.steps import steps_for
from device.former import left_behind, meant
from device.simulator.process import SimulatorProcess
from tests.app.commissioning_life import FOLDER, SERIAL, passed_before
from tests.app.tuning_life import click, studio_at
from tests.device.test_latency import NO_PTY
from tests.device.tuning.life import BAUD, connected
from tests.long import count, record

ANSWERS = ("Take Control and put them back", "Try again", "Go on watching")
COMMAND = "pytest tests/app/test_commissioning_killed.py"
FORMER = {
    "ER": 9000.0, "OE": 0.0, "TL": 5.0, "FL": 500000.0, "BL": -500000.0, "SP": 30000.0, "AC": 102400.0, "KI": 0.5,
}  # fmt: skip
LARGEST_ERROR = 60.0  # counts: as typed on the page
WAY = 400 + 200  # counts: the longest move of the hand, and what it may leave its target by
LATEST_S = 7.0  # after the first press of a button: anywhere in the first moves
WATCHED_S = 1.2  # for a move that was under way
PATIENCE_S = 60.0
SEED = 3
pytestmark = [NO_PTY, pytest.mark.paced, pytest.mark.timeout(count(240, 3600))]


def test_killed_at_any_moment_of_commissioning(qapp: QApplication, tmp_path: Path) -> None:
    kills = count(1, 50)
    found = [one(qapp, tmp_path / str(number), SEED + number, number == 0) for number in range(kills)]
    assert any(found)  # some were killed in the middle
    record("studios killed while commissioning, all put back by the next start", COMMAND, SEED, kills, "kills")
    record("of them in the middle of a move of commissioning", COMMAND, SEED, sum(found), "kills")


def one(qapp: QApplication, folder: Path, seed: int, amid: bool) -> bool:
    """One life, ended amid a move or at any moment; whether it left something to put back."""
    folder.mkdir()
    with SimulatorProcess("ssc2", baud=BAUD, pty=True, plant=resources.path("plants/bench.toml")) as machine:
        before = connected(machine.address)
        assert before.ask("MO X").result(30).accepted  # from here on only a move switches it on
        for name, value in FORMER.items():
            assert before.ask(f"{name}X={value:g}").result(30).accepted
        before.close()
        known = passed_before(folder)  # on disk
        live_and_die(machine, folder, seed, amid)
        there = place(machine)
        comes_to_rest(machine, there)
        left, changed = guards_hold(machine, folder)
        asked = offered_and_resumed(qapp, machine, folder, known, left)
        assert asked or not changed  # nothing is asked where everything is as before
        assert abs(place(machine) - there) <= WAY
        assert not machine.state()["axes"]["X"]["motor_on"] or not asked
        after = connected(machine.address)
        assert held(after) == FORMER
        after.close()
    return left


def live_and_die(machine: SimulatorProcess, folder: Path, seed: int, amid: bool) -> None:
    words = [sys.executable, "-m", "tests.app.commissioning_life", machine.address, str(BAUD), str(folder)]
    around = {**os.environ, "PYTHONPATH": os.getcwd(), "QT_QPA_PLATFORM": "offscreen"}
    process = subprocess.Popen(words, stdout=subprocess.PIPE, text=True, env=around)
    assert process.stdout is not None
    assert process.stdout.readline() == "ready\n"
    if amid:
        start = place(machine)
        while abs(place(machine) - start) < 50:
            time.sleep(0.005)
    else:
        time.sleep(random.Random(seed).uniform(0.05, LATEST_S))
    process.send_signal(signal.SIGKILL)
    process.wait()
    process.stdout.close()


def place(machine: SimulatorProcess) -> float:
    return float(machine.state()["axes"]["X"]["actual"])


def comes_to_rest(machine: SimulatorProcess, there: float) -> None:
    """The move that was commanded ends by itself, inside its bounds."""
    end = time.monotonic() + WATCHED_S
    while time.monotonic() < end or machine.state()["axes"]["X"]["moving"]:
        assert abs(place(machine) - there) <= WAY
        assert time.monotonic() < end + PATIENCE_S, "it does not come to rest"
        time.sleep(0.02)


def held(controller: Controller) -> dict[str, float]:
    values = controller.read(*(f"_{name}X" for name in FORMER)).result(60)
    return dict(zip(FORMER, values, strict=True))


def guards_hold(machine: SimulatorProcess, folder: Path) -> tuple[bool, bool]:
    """OE, ER and limits stand around an axis that is not as before, and what was before is on disk."""
    controller = connected(machine.address)
    there = held(controller)
    left = [former for former in left_behind(folder / FOLDER) if meant(former, controller)]
    controller.close()
    if there != FORMER:
        assert left
        assert {name: left[0].values[name] / ONE for name in FORMER} == pytest.approx(FORMER, abs=1e-3)
    if machine.state()["axes"]["X"]["motor_on"]:
        assert there["OE"] == 1 and there["ER"] <= LARGEST_ERROR and there["FL"] - there["BL"] <= 400 + 400
    return bool(left), there != FORMER


def offered_and_resumed(qapp: QApplication, machine: SimulatorProcess, folder: Path, known: Record, left: bool) -> bool:
    """The next start offers what was before first thing; the list is at the step where it was."""
    studio = studio_at(qapp, machine.address, BAUD, folder)
    studio.window.show()
    words: list[str] = []
    try:
        end = time.monotonic() + PATIENCE_S
        answered: set[object] = set()
        while left and left_behind(folder / FOLDER):
            qapp.processEvents()
            question = studio.desk.question
            if question is not None and question not in answered:
                answered.add(question)
                words += [question.words] if question.windowTitle() != TITLE else []
                click(next(question.buttons[answer] for answer in ANSWERS if answer in question.buttons))
            time.sleep(0.005)
            assert time.monotonic() < end, words
        assert not words or ("commissioning of axis X" in words[0] and "Before it:" in words[0])
        while studio.connection.controller.model is None:
            qapp.processEvents()
            assert time.monotonic() < end
        studio.actions["commissioning"].trigger()
        desk = studio.commissioning
        kept = resumed(folder / FOLDER, "X", "ssc2", SERIAL)
        assert desk.record == kept
        for key, finding in known.findings.items():
            assert kept.of(key) == finding
        steps = steps_for(False, False)
        assert desk.step.key == steps[kept.at(steps)].key
        assert desk.step.key == ("scale" if kept.of("polarity").verdict is Verdict.PASSED else "polarity")
        return bool(words)
    finally:
        studio.close()
        studio.window.hide()
