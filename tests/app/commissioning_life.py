"""A whole studio that brings an axis to life until it is killed: `python -m tests.app.commissioning_life …`.

A hand on its mouse makes one test move after the other: polarity, forward, scale.
"""

from __future__ import annotations

import sys
from pathlib import Path

from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QApplication, QLineEdit

from app.compose import Studio
from device.api import State
from device.commissioning.record import Finding, Record, Verdict, keep, resumed
from device.commissioning.steps import steps_for
from tests.app.tuning_life import click, studio_at

SERIAL = 1  # of a simulated controller
TURN_MS = 30
BEFORE = 4  # steps that were passed at an earlier time
FOLDER = "commissioning"


def passed_before(folder: Path) -> Record:
    """Everything up to the first move was seen to be right, and a distance is typed for the scale."""
    done = {step.key: Finding(Verdict.PASSED, "Passed.") for step in steps_for(False, False)[:BEFORE]}
    record = Record("X", "ssc2", SERIAL, findings=done).with_text("scale", "distance", "0.4")
    assert keep(record, folder / FOLDER) == ""
    return resumed(folder / FOLDER, "X", "ssc2", SERIAL)


class Hand:
    """What it does next, by what it sees."""

    def __init__(self, studio: Studio) -> None:
        self.studio, self.started = studio, False
        self._timer = QTimer(interval=TURN_MS)
        self._timer.timeout.connect(self.turn)
        self._timer.start()

    def turn(self) -> None:
        controller = self.studio.connection.controller
        if controller.state is not State.READY:
            return
        if not controller.control:
            controller.take_control()
            self.studio.actions["commissioning"].trigger()
            return
        desk = self.studio.commissioning
        if desk.busy or desk.window is None or not desk.window.isVisible():
            return
        acts = desk.window.page.acts
        if "forward" in acts and acts["forward"].isEnabled():
            click(acts["forward"])
            desk.choose(desk.row + 1)  # scale
        elif "scale" in acts and acts["scale"].isEnabled() and desk.moved is None:
            self._begin("scale")
        elif "polarity" in acts and acts["polarity"].isEnabled():
            self._begin("polarity")
        else:
            desk.choose(BEFORE)

    def _begin(self, name: str) -> None:
        window = self.studio.commissioning.window
        assert window is not None
        field = window.page.fields.get("distance")
        assert not isinstance(field, QLineEdit) or field.text() == "0.4"
        if not self.started:
            self.started = True
            print("ready", flush=True)
        click(window.page.acts[name])


def main(address: str, baud: int, folder: Path) -> None:
    application = QApplication([])
    studio = studio_at(application, address, baud, folder)
    studio.window.show()
    hand = Hand(studio)
    application.exec()
    del hand
    studio.close()


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]), Path(sys.argv[3]))
