"""The operator terminal on a serial port of its own, beside the machine's main port, both behind real lines."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from app.compose import Studio
from app.connection import connector
from app.help_pages import Pages
from app.search import Candidate
from app.settings import Settings
from app.studio import begin
from device.simulator.process import SimulatorProcess
from tests.app.hands import Mouse, until
from tests.app.test_leaving_live import connect
from tests.app.test_operator import EXAMPLE

BAUD = 19_200

pytestmark = [pytest.mark.paced, pytest.mark.skipif(os.name != "posix", reason="pseudo-terminals")]


@pytest.fixture
def machine() -> Iterator[SimulatorProcess]:
    with SimulatorProcess("ssc2", pty=True, baud=BAUD, port2="pty") as process:
        process.state()  # it serves
        yield process


@pytest.fixture
def hands(tmp_path: Path, qapp: QApplication, machine: SimulatorProcess) -> Iterator[Mouse]:
    """A studio connected to the main port, in Control; the second port is on the list of the computer's ports."""
    ports = [Candidate(machine.address, "main", True), Candidate(machine.address2, "second", False)]
    opener = connector(tmp_path / "programs", lambda: 600.0)
    studio = Studio(qapp, Settings(tmp_path / "settings.json"), tmp_path, opener, lambda: ports, Pages())
    studio.window.show()
    studio.tick.start()
    QTest.qWaitForWindowActive(studio.window, 3000)
    begin(studio, None, "offline")
    hands = Mouse(studio)
    connect(hands, machine.address)
    yield hands
    studio.close()
    studio.session.close()
    studio.window.hide()
    studio.window.deleteLater()
    QApplication.processEvents()


def test_the_manuals_example_at_a_port_of_its_own(hands: Mouse, machine: SimulatorProcess) -> None:
    controller, panel = hands.studio.connection.controller, hands.studio.at_machine.keys
    job = controller.download(EXAMPLE)
    until(job.future.done, "the program to be in the machine")
    assert job.future.result().verified
    hands.studio.desk.bring("Operator terminal")
    until(lambda: panel.line.count() == 1, "the other port to be offered")
    assert panel.line.currentText() == machine.address2  # never the port that STOP needs
    QTest.mouseClick(panel.connect_button, Qt.MouseButton.LeftButton)
    until(lambda: panel.connect_button.text() == "Disconnect", "port 2 to be open")
    controller.execute(anyway=True)
    until(lambda: "start Y" in panel.words(), "the program's lines on the display")
    assert panel.words().split("\n") == ["press F1 to start X", "Press F2 to start Y"]
    until(lambda: panel.making.done, "the keys")
    hands.press(panel.pads["Hand-held"].caps["F1"])
    until(lambda: machine.state()["axes"]["X"]["commanded"] == 1000, "X to have moved")
    assert machine.state()["axes"]["Y"]["commanded"] == 0
    panel.screen.setFocus()
    QTest.keyClick(panel.screen, Qt.Key.Key_F2, Qt.KeyboardModifier.ShiftModifier)
    until(lambda: machine.state()["axes"]["Y"]["commanded"] == 1000, "Y to have moved")
    assert machine.state()["axes"]["X"]["commanded"] == 1000
