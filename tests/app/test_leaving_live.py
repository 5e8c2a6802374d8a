"""A real machine behind a paced serial line: leaving asks whenever it works, and never when it rests.

The machine is a simulator in a process of its own behind a pseudo-terminal at 19 200 baud; what it does at the moment
of the click is told by that process, not by the studio.
"""

from __future__ import annotations

import os
import random
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QPushButton

from app.compose import Studio
from app.connection import connector
from app.help_pages import Pages
from app.settings import Settings
from app.studio import begin
from device.api import Kind, State
from device.simulator.process import SimulatorProcess
from tests.app.hands import Mouse, live, shown, until
from tests.long import count, record
from widgets.connect.serial_setup import SerialSetup

BAUD = 19_200
PROGRAM = ["#A", "N=0", "#B", "N=N+1", "JP #B", "EN"]  # runs for ever, moves nothing
NOT_LEFT = "Not left: the stop is not confirmed."
WORK: dict[str, tuple[str, ...]] = {
    "a jog": ("JG 1000", "BG X"),
    "a slow move": ("PR ,1000000", "SP ,500", "BG Y"),
    "a coordinated motion": ("VS 500", "LM XY", "LI 100000,100000", "LE", "BG S"),
    "a program": ("XQ #A",),
    "a program and a jog": ("XQ #A", "JG ,-1000", "BG Y"),
}
REST: dict[str, tuple[str, ...]] = {
    "nothing was done": (),
    "something was read": ("TP",),
    "a move has ended": ("PR 200", "SP 20000", "BG X"),
    "a program has ended": ("XQ #END",),
    "a jog was stopped": ("JG 1000", "BG X", "ST X"),
}

pytestmark = [pytest.mark.paced, pytest.mark.skipif(os.name != "posix", reason="pseudo-terminals")]


@pytest.fixture
def machine() -> Iterator[SimulatorProcess]:
    with SimulatorProcess("ssc2", pty=True, baud=BAUD) as process:
        process.state()  # it serves
        yield process


@pytest.fixture
def hands(tmp_path: Path, qapp: QApplication, machine: SimulatorProcess) -> Iterator[Mouse]:
    """A studio that was connected to it through the serial setup, in Control, the terminal in front."""
    studio = Studio(
        qapp,
        Settings(tmp_path / "settings.json"),
        tmp_path,
        connector(tmp_path / "programs", lambda: 600.0),
        list,
        Pages(),
    )
    studio.window.show()
    studio.tick.start()
    QTest.qWaitForWindowActive(studio.window, 3000)
    begin(studio, None, "offline")
    hands = Mouse(studio)
    connect(hands, machine.address)
    load(hands)
    yield hands
    studio.close()
    studio.session.close()
    studio.window.hide()
    studio.window.deleteLater()
    QApplication.processEvents()


def connect(hands: Mouse, port: str) -> None:
    hands.act("serial")
    setup = shown(SerialSetup)
    assert isinstance(setup, SerialSetup)
    line = setup.port.lineEdit()
    assert line is not None
    hands.fill(line, port)
    hands.choose(setup.baud, "19 200")
    hands.press(setup.connect_button)
    controller = hands.studio.connection.controller
    until(lambda: controller.state is State.READY, "the machine to answer")
    assert controller.kind is Kind.MACHINE
    assert controller.line.baud == BAUD
    hands.press(hands.studio.window.header.switch.control)
    hands.act("terminal")


def load(hands: Mouse) -> None:
    controller = hands.studio.connection.controller
    job = controller.download("\n".join([*PROGRAM, "#END", "EN"]))
    until(job.future.done, "the program to be in the machine")
    assert job.future.result().verified


def type_commands(hands: Mouse, *commands: str) -> None:
    terminal = hands.studio.terminal
    for command in commands:
        before = len(terminal.log.toPlainText())
        hands.fill(terminal.line, command)
        hands.press(terminal.send)
        until(lambda command=command, before=before: _answer(hands, command, before), f"an answer to {command}")
        assert "?" not in _answer(hands, command, before)


def _answer(hands: Mouse, command: str, before: int) -> str:
    """What the terminal shows below a command, without the sentences of the studio between dashes."""
    _, typed, below = hands.studio.terminal.log.toPlainText()[before:].partition(f"› {command}\n")
    return "".join(line for line in below.splitlines() if not line.strip().startswith("—")) if typed else ""


def works(state: dict[str, Any]) -> bool:
    """Told by the machine itself."""
    return any(axis["moving"] for axis in state["axes"].values()) or any(each["running"] for each in state["threads"])


def exit_button(hands: Mouse) -> None:
    hands.act("exit")


def close_box(hands: Mouse) -> None:
    hands.window.close()  # what the window system calls


def disconnect(hands: Mouse) -> None:
    hands.act("disconnect")


WAYS: tuple[Callable[[Mouse], None], ...] = (exit_button, close_box, disconnect)


def turn_away(hands: Mouse, way: Callable[[Mouse], None]) -> bool:
    """Whether a question came up; else the studio has turned away."""
    studio, desk = hands.studio, hands.studio.desk
    desk.question = None
    way(hands)
    gone = (lambda: studio.connection.controller.kind is Kind.OFFLINE) if way is disconnect else _hidden(studio)
    until(lambda: desk.question is not None or gone(), "a question, or to be away")
    return desk.question is not None


def _hidden(studio: Studio) -> Callable[[], bool]:
    return lambda: not studio.window.isVisible()


def answer(hands: Mouse, words: str) -> None:
    question = hands.studio.desk.question
    assert question is not None
    hands.press(next(each for each in question.findChildren(QPushButton) if each.text() == words))


def come_back(hands: Mouse, machine: SimulatorProcess) -> None:
    hands.window.show()
    QTest.qWaitForWindowActive(hands.window, 3000)
    if hands.studio.connection.controller.kind is Kind.OFFLINE:
        connect(hands, machine.address)


def test_leaving_asks_when_the_machine_works_and_only_then(hands: Mouse, machine: SimulatorProcess) -> None:
    dice = random.Random(7)
    rounds = count(10, 100)
    deck = [*WORK, *REST] * (rounds // len([*WORK, *REST]))
    dice.shuffle(deck)
    for what in deck:
        way = dice.choice(WAYS)
        type_commands(hands, *(WORK.get(what) or REST.get(what, ())))
        if what in REST:
            until(lambda: not works(machine.state()), "the machine to rest")
        live(dice.choice((0.0, 0.0, 0.1, 0.7)))  # at once, or after a while
        busy = works(machine.state())
        assert busy == (what in WORK)
        asked = turn_away(hands, way)
        assert asked == busy, f"{what}, {way.__name__}: {'asked' if asked else 'not asked'}"
        if asked:
            assert works(machine.state())  # the question alone stops nothing
            answer(hands, "Cancel")
            assert hands.studio.connection.controller.kind is Kind.MACHINE and hands.window.isVisible()
            type_commands(hands, "ST", "HX")
            until(lambda: not works(machine.state()), "the machine to rest")
        else:
            come_back(hands, machine)
    assert len(deck) == rounds
    record("leaving asks exactly when the machine works", "pytest tests/app/test_leaving_live.py", 7, rounds, "rounds")


def test_stop_and_leave_leaves_a_machine_at_rest(hands: Mouse, machine: SimulatorProcess) -> None:
    type_commands(hands, "XQ #A", "JG 1000", "BG X")
    said, gone = hands.studio.messages.texts, _hidden(hands.studio)
    assert turn_away(hands, exit_button)
    answer(hands, "Stop and leave")
    until(lambda: gone() or NOT_LEFT in said(), "the window to close, or to say why not")
    if not gone():  # a busy computer proves the stop too late: whoever leaves again is asked only while it works
        until(lambda: not works(machine.state()), "the machine to rest")
        if turn_away(hands, exit_button):
            answer(hands, "Stop and leave")
        until(gone, "the window to close")
    assert not works(machine.state())


def test_leave_it_running_leaves_it_running(hands: Mouse, machine: SimulatorProcess) -> None:
    type_commands(hands, "XQ #A", "JG 1000", "BG X")
    assert turn_away(hands, exit_button)
    answer(hands, "Leave it running")
    until(_hidden(hands.studio), "the window to close")
    state = machine.state()
    assert state["axes"]["X"]["moving"] and state["threads"][0]["running"]
