"""In Watch nothing leaves but reads and STOP, whatever is clicked (safety.md, 2)."""

from __future__ import annotations

import random

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QAbstractButton, QApplication, QDialog, QWidget

from tests.fakes import FakeController
from tests.long import count
from tests.stage import Stage

READS = {"watch", "listing", "upload", "stop"}
LEAVE_ALONE = {"exit", "take_control"}  # ends the program; is the switch itself


def click_around(stage: Stage, seed: int, times: int = 60) -> set[str]:
    """Names of everything that was asked of a machine meanwhile."""
    dice = random.Random(seed)
    machines = [stage.connect("machine")]
    stage.go()
    for _ in range(times):
        widget = dice.choice(targets(stage))
        point = QPoint(dice.randrange(max(1, widget.width())), dice.randrange(max(1, widget.height())))
        QTest.mouseClick(widget, Qt.MouseButton.LeftButton, pos=point)
        stage.go(1)
        tidy()
        if stage.studio.connection.controller is not machines[-1]:  # the simulator was chosen, or nothing
            machines.append(stage.connect("machine"))
    return {call if isinstance(call, str) else call[0] for machine in machines for call in machine.calls}


@pytest.mark.parametrize("seed", range(count(3, 50)))
def test_a_random_clicker_sends_nothing_but_reads_and_stop(stage: Stage, seed: int) -> None:
    assert click_around(stage, seed) <= READS


def test_the_clicker_would_notice(stage: Stage, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(FakeController, "starts_in_control", True)
    found = set().union(*(click_around(stage, seed, 120) for seed in range(2)))
    assert found & {"download", "execute", "halt", "burn", "ask", "output"}


def targets(stage: Stage) -> list[QWidget]:
    """Every visible button of every window, except what ends the program or is the switch itself."""
    header = stage.studio.window.header
    spared = [header.switch.control]
    found: list[QWidget] = []
    for window in QApplication.topLevelWidgets():
        for button in window.findChildren(QAbstractButton):
            action = (
                button.defaultAction().objectName()
                if hasattr(button, "defaultAction") and button.defaultAction()
                else ""
            )
            words = button.text().lower()
            if button.isVisible() and button not in spared and action not in LEAVE_ALONE and words != "exit":
                found.append(button)
    return found


def tidy() -> None:
    """Closes what has piled up."""
    windows = QApplication.topLevelWidgets()
    dialogs = [window for window in windows if isinstance(window, QDialog) and window.isVisible()]
    for dialog in dialogs[3:]:
        dialog.close()
