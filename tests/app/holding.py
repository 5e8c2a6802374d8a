"""A whole studio that holds an axis by its mouse: `python -m tests.app.holding ADDRESS BAUD FOLDER`, told by lines.

`hold` presses the button of the jog panel; `release`, `focus`, `behind` and `close` are what ends it. Each word is
said back when it is done.
"""

from __future__ import annotations

import dataclasses as dc
import sys
from pathlib import Path

from PySide6.QtCore import QSocketNotifier, Qt, QTimer
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QWidget

from app.compose import Studio
from app.connection import Opened
from app.help_pages import Pages
from app.settings import Settings
from codegen.setup import Unit
from device.api import Controller, Kind, LineSettings, State
from device.transport import open_transport
from tests.device.holding import ACCELERATION, SPEED

SCALE = 1000  # counts per mm
LEFT = Qt.MouseButton.LeftButton


class Hand:
    """The studio and the hand on its mouse."""

    def __init__(self, address: str, baud: int, folder: Path) -> None:
        application = QApplication.instance()
        assert isinstance(application, QApplication)
        application.setQuitOnLastWindowClosed(False)  # the test opens the window again
        line = LineSettings(baud=baud)

        def connect(_: str, line: LineSettings) -> Opened:
            return Opened(Controller(lambda: open_transport(address, line), kind=Kind.SIMULATOR, line=line), None)

        self.studio = Studio(application, Settings(folder / "settings.json"), folder, connect, list, Pages())
        document = self.studio.session.document
        axis = dc.replace(document.setup.axes[0], unit=Unit.MM, counts_per_unit=str(SCALE))
        setup = dc.replace(document.setup, model="ssc2", axes=(axis,) * 4)
        self.studio.session.set_document(dc.replace(document, setup=setup), "Table")
        self.studio.session.save_as(folder / "table.tlp")
        self.studio.window.show()
        self.studio.tick.start()
        self.studio.connection.adopt(connect(address, line), "simulator")
        self.other, self.over = QWidget(), False
        self._notifier = QSocketNotifier(sys.stdin.fileno(), QSocketNotifier.Type.Read)
        self._notifier.activated.connect(lambda *_: self.hear(sys.stdin.readline().strip()))
        self._begin = QTimer(interval=50)
        self._begin.timeout.connect(self._get_ready)
        self._begin.start()

    def _get_ready(self) -> None:
        studio = self.studio
        studio._bring("Jog")
        if studio.connection.controller.state is not State.READY or studio.at_machine.jog.one is None:
            return
        self._begin.stop()
        page = studio.at_machine.jog.one
        ramp = str(ACCELERATION // SCALE)
        page._set(speed=str(SPEED // SCALE), acceleration=ramp, deceleration=ramp)
        print("ready", flush=True)

    def hear(self, word: str) -> None:
        if not word:
            self.over = True
            QApplication.quit()
            return
        if word == "hold":
            self._press()
            return
        panel, window = self.studio.at_machine.jog, self.studio.window
        assert panel.one is not None
        if word == "release":
            QTest.mouseRelease(panel.one.hold_forward, LEFT)
        elif word == "focus":
            window.header.stop.setFocus()
        elif word == "behind":
            self.other.show()
            self.other.activateWindow()
        elif word == "close":
            window.close()
        print(word, flush=True)

    def _press(self) -> None:
        """As soon as what was before has ended and the window is in front again."""
        studio, panel = self.studio, self.studio.at_machine.jog
        self.other.hide()
        if studio.desk.question is not None:
            studio.desk.question.close()
            studio.desk.question = None
        if not studio.window.isVisible():
            studio.window.show()
        studio.window.activateWindow()
        assert panel.one is not None
        button = panel.one.hold_forward
        if studio.connection.controller.motion.busy or not button.isEnabled() or not button.isVisible():
            QTimer.singleShot(20, self._press)
            return
        QTest.mouseRelease(button, LEFT)
        QTest.mousePress(button, LEFT)
        print("hold", flush=True)


def main(address: str, baud: int, folder: Path) -> None:
    application = QApplication([])
    hand = Hand(address, baud, folder)
    while not hand.over:  # the window was closed, and is opened again
        application.exec()
    hand.studio.close()


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]), Path(sys.argv[3]))
