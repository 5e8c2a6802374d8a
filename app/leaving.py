"""Before the studio leaves a machine alone: what still goes on there, asked in words; STOP leaves with the window."""

from __future__ import annotations

import math
from collections.abc import Callable

from PySide6.QtCore import QObject, Signal
from PySide6.QtGui import QCloseEvent
from PySide6.QtWidgets import QWidget

from app.connection import Connection
from app.desk import Desk
from app.files import Files
from app.run import Run
from device.api import Kind, State, StopState

TITLE = "Leave Twoletter Studio?"
THREADS = 4


class Leaving(QObject):
    """Asks when a program runs, something moves or the controller's memory is worked on; else nothing is asked."""

    said = Signal(str)

    def __init__(self, connection: Connection, run: Run, desk: Desk, files: Files, window: QWidget) -> None:
        super().__init__(window)
        self._connection, self._run, self._desk, self._files, self._window = connection, run, desk, files, window
        self._agreed = False  # the person leaves it going on; holds until nothing does
        self._stopping = False

    def asked(self, event: QCloseEvent) -> None:
        """The window is to be closed."""
        words = self.going_on()
        if self._agreed or not words:
            self._desk.closing(event, self._files)
            return
        event.ignore()
        answers = [("Leave it running", self._agree)]
        if not self._run.doing:
            answers.insert(0, ("Stop and leave", self._stop))
        self._desk.ask(TITLE, f"{words} Without this window there is no STOP and no F12.", answers, "warning")

    def careful(self, title: str, go_on: Callable[[], object]) -> None:
        """Turns to something else, after asking when the machine works: STOP reaches only what is connected."""
        words = self.going_on()
        if not words:
            go_on()
            return
        answers = (("Stop it", self._connection.stop), ("Leave it running", lambda: go_on() and None))
        self._desk.ask(title, f"{words} Afterwards STOP and F12 no longer reach it.", answers, "warning")

    def going_on(self) -> str:
        """What would go on, or break off, without the studio, as a sentence; nothing when it may go."""
        controller = self._connection.controller
        if self._run.doing:
            return f"{self._run.doing.partition(':')[0]} is not finished."
        if controller.kind is not Kind.MACHINE:
            return ""  # a simulator of ours ends with the studio
        if controller.state is State.LOST:
            return "The controller does not answer: whether something moves is not known."
        if controller.resting():
            return "A program may run: live values rest."
        row = controller.last()
        if row.stale("thread0", controller.clock()):
            return "What the machine does now is not known."
        found = ["a program runs"] if any(row.value(f"thread{number}") >= 0 for number in range(THREADS)) else []
        moving = [letter for letter in controller.axes if _moves(row.value(f"moving.{letter.lower()}"))]
        if moving:
            found.append(f"{' '.join(moving)} {'moves' if len(moving) == 1 else 'move'}")
        words = ", ".join(found)
        return f"{words[0].upper()}{words[1:]}." if words else ""

    def look(self) -> None:
        """With each tick: leaves once the stop is proved, stays when it is not."""
        if self._agreed and not self.going_on():
            self._agreed = False
        if not self._stopping:
            return
        state = self._connection.controller.stop_state
        if state is StopState.STOPPED:
            self._stopping = False
            self._agree()
        elif state is not StopState.STOPPING:
            self._stopping = False
            self.said.emit("Not left: the stop is not confirmed.")

    def _stop(self) -> None:
        self._stopping = True
        self._connection.stop()

    def _agree(self) -> None:
        self._agreed = True
        self._window.close()


def _moves(value: float) -> bool:
    return math.isfinite(value) and value != 0
