"""In Watch nothing leaves but reads and STOP, whatever is clicked (safety.md, 2)."""

from __future__ import annotations

import random
import re
from collections.abc import Iterator

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QAbstractButton, QDialog, QFileDialog, QWidget

from tests.long import count, record
from tests.rig import Rig
from tests.stage import Stage

# the revision, framed reads, uploads and lists; STOP and its proof
HARMLESS = {"", "MG", "LS", "LV", "LA", "QU", "UL", "ST", "AB", "HX;MG"}
LEAVE_ALONE = {"exit", "take_control"}  # ends the program; is the switch itself
LISTING = "#A\nSB 2\nEN"


def machine(stage: Stage, control: bool) -> Rig:
    rig = stage.connect("machine", program=LISTING)
    if control:
        rig.controller.take_control()
    return rig


def words(rig: Rig) -> set[str]:
    """What every line that left begins with."""
    plain = ("".join(letter for letter in line if " " < letter < "\\") for line in rig.lines)
    return {re.match(r"(HX;)?[A-Z]{0,2}", line)[0] for line in plain}  # type: ignore[index]


def click_around(stage: Stage, seed: int, times: int, control: bool = False) -> Iterator[list[Rig]]:
    """Clicks anywhere, again and again; the machines it was done to."""
    dice = random.Random(seed)
    machines = [machine(stage, control)]
    for _ in range(times):
        widget = dice.choice(targets(stage, control))
        point = QPoint(dice.randrange(max(1, widget.width())), dice.randrange(max(1, widget.height())))
        QTest.mouseClick(widget, Qt.MouseButton.LeftButton, pos=point)
        stage.go(1)
        tidy(stage)
        if stage.controller is not machines[-1].controller:  # the simulator was chosen, or nothing
            machines.append(machine(stage, control))
        yield machines
    stage.go(30)
    yield machines


@pytest.mark.parametrize("seed", range(count(3, 50)))
def test_a_random_clicker_sends_nothing_but_reads_and_stop(stage: Stage, seed: int) -> None:
    machines = list(click_around(stage, seed, 60))[-1]
    for rig in machines:
        assert words(rig) <= HARMLESS
        assert rig.program == LISTING.split("\n")
        assert rig.simulation.state()["outputs"] == 0
    assert [text for text in stage.studio.messages.texts() if text.startswith("Not ")] == []  # nor was it asked to
    record("random clicks in Watch, nothing but reads sent", "pytest tests/app/test_watch.py", None, 60, "", add=True)


def test_the_clicker_would_notice(stage: Stage) -> None:
    for machines in click_around(stage, 0, 400, control=True):
        if set().union(*(words(rig) for rig in machines)) & {"DL", "XQ", "BP", "SB", "CB"}:
            return
    pytest.fail("400 clicks in Control and nothing has left")


def targets(stage: Stage, control: bool) -> list[QWidget]:
    """Every visible button of every window, except what ends the program or changes the switch."""
    switch = stage.studio.window.header.switch
    spared = [switch.watch if control else switch.control]
    found: list[QWidget] = []
    for button in stage.studio.window.findChildren(QAbstractButton):
        if isinstance(button.window(), QFileDialog) and "Cancel" not in button.text():
            continue  # it writes where it is told, and waits for an answer before it overwrites
        default = getattr(button, "defaultAction", lambda: None)()
        action = default.objectName() if default is not None else ""
        if button.isVisible() and button not in spared and action not in LEAVE_ALONE and button.text() != "Exit":
            found.append(button)
    return found


def tidy(stage: Stage) -> None:
    """Closes what has piled up."""
    dialogs = [dialog for dialog in stage.studio.window.findChildren(QDialog) if dialog.isVisible()]
    for dialog in dialogs[3:]:
        dialog.close()
