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
from device.api import Controller, Kind, State, StopState

TITLE = "Leave Twoletter Studio?"
THREADS = 4


class Leaving(QObject):
    """Asks when a program runs, something moves or the controller's memory is worked on; else nothing is asked."""

    said = Signal(str)

    def __init__(self, connection: Connection, run: Run, desk: Desk, files: Files, window: QWidget) -> None:
        super().__init__(window)
        self._connection, self._run, self._desk, self._files, self._window = connection, run, desk, files, window
        self._agreed = False  # the person leaves it going on; holds until nothing does
        self._then: tuple[Controller, Callable[[], object]] | None = None  # once this one has stopped

    def asked(self, event: QCloseEvent) -> None:
        """The window is to be closed."""
        words = self.going_on()
        if self._agreed or not words:
            self._desk.closing(event, self._files)
            return
        event.ignore()
        self._put(TITLE, f"{words} Without this window there is no STOP and no F12.", "Stop and leave", self._agree)

    def careful(self, title: str, go_on: Callable[[], object]) -> None:
        """Turns to something else, after asking when the machine works: STOP reaches only what is connected."""
        words = self.going_on()
        if not words:
            go_on()
            return
        self._put(title, f"{words} Afterwards STOP and F12 no longer reach it.", "Stop it first", go_on)

    def _put(self, title: str, words: str, stop: str, go_on: Callable[[], object]) -> None:
        answers: list[tuple[str, Callable[[], None]]] = [("Leave it running", lambda: go_on() and None)]
        if not self._run.doing:
            answers.insert(0, (stop, lambda: self._stop(go_on)))
        self._desk.ask(title, words, answers, "warning")

    def going_on(self) -> str:
        """What would go on, or break off, without the studio, as a sentence; nothing when it may go."""
        controller = self._connection.controller
        if self._run.doing:
            return f"{self._run.doing.partition(':')[0]} is not finished."
        if controller.kind is not Kind.MACHINE:
            return ""  # a simulator of ours ends with the studio
        if controller.identity is None:
            return ""  # nobody has ever answered there
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
        """With each tick: goes on once the stop is proved, stays when it is not."""
        if self._agreed and not self.going_on():
            self._agreed = False
        if self._then is None:
            return
        controller, go_on = self._then
        if controller is not self._connection.controller:
            self._then = None
        elif controller.stop_state is StopState.STOPPED:
            self._then = None
            go_on()
        elif controller.stop_state is not StopState.STOPPING:
            self._then = None
            self.said.emit("Not left: the stop is not confirmed.")

    def _stop(self, go_on: Callable[[], object]) -> None:
        self._then = (self._connection.controller, go_on)
        self._connection.stop()

    def _agree(self) -> None:
        self._agreed = True
        self._window.close()


def _moves(value: float) -> bool:
    return math.isfinite(value) and value != 0
