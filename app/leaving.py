"""Before the studio leaves a machine alone: what still goes on there, asked in words; STOP leaves with the window."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from PySide6.QtCore import QObject, Signal
from PySide6.QtGui import QCloseEvent
from PySide6.QtWidgets import QWidget

from app.connection import Connection
from app.desk import Desk
from app.files import Files
from app.run import Run
from app.tick import failure_of
from app.work import Inquiry, inquire
from device.api import Controller, Kind, State, StopState

TITLE = "Leave Twoletter Studio?"
PATIENCE_S = 2.0  # four axes and four threads are asked in half a second at 19 200 baud
UNKNOWN = "What the machine does now is not known."


@dataclass(frozen=True)
class Asking:
    """The machine was asked what it does, and who wants to know; they hear None when it matters no longer."""

    controller: Controller
    asked: Inquiry
    until: float
    then: Callable[[str | None], None]


class Leaving(QObject):
    """Asks when a program runs, something moves or the controller's memory is worked on; else nothing is asked."""

    said = Signal(str)

    def __init__(self, connection: Connection, run: Run, desk: Desk, files: Files, window: QWidget) -> None:
        super().__init__(window)
        self._connection, self._run, self._desk, self._files, self._window = connection, run, desk, files, window
        self._agreed = False  # while the window closes as it was agreed
        self._asking: Asking | None = None
        self._then: tuple[Controller, Callable[[], object]] | None = None  # once this one has stopped
        self._after: tuple[Controller, Callable[[], object]] | None = None  # once what is under way has ended there
        self.left: Controller | None = None  # works, and the person turns away from it all the same

    def asked(self, event: QCloseEvent) -> None:
        """The window is to be closed."""
        words = "" if self._agreed else self._at_once()
        if words == "":
            self._desk.closing(event, self._files)
            return
        event.ignore()
        self.check(self._close)

    def careful(self, title: str, go_on: Callable[[], object]) -> None:
        """Turns to something else, after asking when the machine works: STOP reaches only what is connected."""
        self.left = None

        def judge(words: str | None) -> None:
            if words:
                words = f"{words} Afterwards STOP and F12 no longer reach it."
                self._put(title, words, "Stop it first", go_on, lambda: self.careful(title, go_on))
            elif words is not None:
                go_on()

        self.check(judge)

    def check(self, then: Callable[[str | None], None]) -> None:
        """Tells, now or soon, what would go on without the studio, as a sentence; nothing when it may go."""
        self._drop()
        words = self._at_once()
        if words is not None:
            then(words)
            return
        controller = self._connection.controller
        self._asking = Asking(controller, inquire(controller), controller.clock() + PATIENCE_S, then)

    def _drop(self) -> None:
        asking, self._asking = self._asking, None
        if asking is not None:
            asking.then(None)

    def _at_once(self) -> str | None:
        """The same where it can be told without asking the machine; None where it must be asked."""
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
        return None if controller.state is State.READY else UNKNOWN

    def look(self) -> None:
        """With each tick: judges what the machine has answered, goes on once a stop is proved."""
        self._judge()
        if self._after is not None and not self._run.doing:
            (controller, again), self._after = self._after, None
            if controller is self._connection.controller:
                again()
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

    def _judge(self) -> None:
        asking = self._asking
        if asking is None:
            return
        if asking.controller is not self._connection.controller:
            self._drop()
        elif asking.asked.answer.done():
            self._asking = None
            asking.then(UNKNOWN if failure_of(asking.asked.answer) else asking.asked.work().words)
        elif asking.controller.clock() >= asking.until:
            self._asking = None
            asking.then(self._at_once() or UNKNOWN)

    def _put(self, title: str, words: str, stop: str, go_on: Callable[[], object], again: Callable[[], object]) -> None:
        """`again` asks anew: what is under way is cancelled, which puts back what it changed, and then looked at."""
        controller = self._connection.controller

        def leave() -> None:
            self.left = controller
            go_on()

        def end() -> None:
            self._run.cancel()
            self._after = controller, again

        answers = [(stop, lambda: self._stop(go_on)), ("Leave it running", leave)]
        if self._run.doing:  # nothing of it goes on without the studio
            answers = [("Cancel it first" if self._run.job is not None else "Wait for its end", end)]
            answers.append(("Leave at once", leave))
        self._desk.ask(title, words, answers, "warning")

    def _stop(self, go_on: Callable[[], object]) -> None:
        self._then = (self._connection.controller, go_on)
        self._connection.stop()

    def _close(self, words: str | None) -> None:
        if words:
            words = f"{words} Without this window there is no STOP and no F12."
            self._put(TITLE, words, "Stop and leave", self._agree, lambda: self.check(self._close))
        elif words is not None:
            self._agree()

    def _agree(self) -> None:
        self._agreed = True
        self._window.close()
        self._agreed = False
