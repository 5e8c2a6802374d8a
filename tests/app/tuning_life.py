"""A whole studio that tunes until it is killed: `python -m tests.app.tuning_life ADDRESS BAUD FOLDER SEED`.

A hand on its mouse takes one page of the tuner after the other, ticks that the way is free and starts.
"""

from __future__ import annotations

import dataclasses as dc
import random
import sys
from pathlib import Path

from PySide6.QtCore import QPoint, Qt, QTimer
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QWidget

from app.compose import Studio
from app.connection import Opened
from app.help_pages import Pages
from app.settings import Settings
from codegen.setup import Setup, Unit
from device.api import Controller, Kind, LineSettings, State
from device.transport import open_transport
from tests.device.tuning.life import STEP
from widgets.tuner.panel import AUTOMATIC, MANUAL, MODEL, TunerPanel

SCALE = 1000  # counts per mm
TURN_MS = 30


def studio_at(application: QApplication, address: str, baud: int, folder: Path) -> Studio:
    """A studio on a table in mm, connected to that machine."""

    def connect(_: str, line: LineSettings) -> Opened:
        return Opened(Controller(lambda: open_transport(address, line), kind=Kind.MACHINE, line=line), None)

    studio = Studio(application, Settings(folder / "settings.json"), folder, connect, list, Pages())
    axis = dc.replace(Setup().axes[0], unit=Unit.MM, counts_per_unit=str(SCALE), forward_limit="", reverse_limit="")
    document = studio.session.document
    setup = dc.replace(document.setup, model="ssc2", axes=(axis,) * 4, serial_number="")
    studio.session.set_document(dc.replace(document, setup=setup), "Table")
    studio.tick.start()
    studio.connection.adopt(connect(address, LineSettings(baud=baud)), "machine")
    return studio


def click(widget: QWidget) -> None:
    QTest.mouseClick(widget, Qt.MouseButton.LeftButton, pos=QPoint(12, widget.height() // 2))


class Hand:
    """What it does next, by what it sees."""

    def __init__(self, studio: Studio, seed: int) -> None:
        self.studio, self.chance, self.started = studio, random.Random(seed), False
        self.pages = [MANUAL, AUTOMATIC, MODEL]
        self.chance.shuffle(self.pages)
        self.chosen = False
        self._timer = QTimer(interval=TURN_MS)
        self._timer.timeout.connect(self.turn)
        self._timer.start()

    def turn(self) -> None:
        controller = self.studio.connection.controller
        if controller.state is not State.READY:
            return
        if not controller.control:
            controller.take_control()
            return
        panel = self.studio.at_machine.tuning.panel
        if not panel.isVisible():
            self.studio.actions["tune"].trigger()
            return
        if panel.bode_plot is None or panel.running:
            return
        if not panel.axes.count():
            return  # it does not know its machine yet
        if "SH" in panel.result.text():  # its gains were too much: the motor went off
            controller.ask("SH X")
            panel.show_result("")
        elif not self.chosen:
            self._choose(panel)
        elif panel.box.begin.isEnabled():
            self.chosen = False
            if not self.started:
                self.started = True
                print("ready", flush=True)
            click(panel.box.begin)
        elif not panel.box.free.isChecked() and panel.box.words.text().startswith("X moves by"):
            click(panel.box.free)

    def _choose(self, panel: TunerPanel) -> None:
        """The next page, with other gains and another step."""
        page = self.pages[0]
        self.pages = [*self.pages[1:], page]
        click(panel.buttons[page])
        panel.box.seconds.setCurrentIndex(0)
        panel.box.drive.setCurrentIndex(1)
        step = STEP if page == AUTOMATIC else self.chance.choice((-STEP, STEP))
        self._type(panel.box.step, f"{step / SCALE:g}")
        self._type(panel.box.volts, "6")
        fields = panel.manual.gains.fields
        for name, low, high in (("KP", 3, 30), ("KD", 60, 300), ("KI", 0, 2)):
            self._type(fields[name], f"{self.chance.uniform(low, high):.3f}")
        self.chosen = True

    @staticmethod
    def _type(field: QWidget, text: str) -> None:
        field.setFocus()
        QTest.keyClick(field, Qt.Key.Key_A, Qt.KeyboardModifier.ControlModifier)
        QTest.keyClicks(field, text)


def main(address: str, baud: int, folder: Path, seed: int) -> None:
    application = QApplication([])
    studio = studio_at(application, address, baud, folder)
    studio.window.show()
    hand = Hand(studio, seed)
    application.exec()
    del hand
    studio.close()


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]), Path(sys.argv[3]), int(sys.argv[4]))
