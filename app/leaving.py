"""Before the studio leaves: what goes on at the machine and what is not saved is asked; what is on its way to the disk
is waited for. STOP leaves with the window."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from PySide6.QtCore import QObject, Signal
from PySide6.QtGui import QCloseEvent
from PySide6.QtWidgets import QAbstractItemView, QAbstractSpinBox, QApplication, QLineEdit, QWidget

from app.connection import Connection
from app.desk import Desk
from app.files import Files
from app.run import Run
from app.tick import Tick, failure_of
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

    def __init__(self, connection: Connection, run: Run, desk: Desk, files: Files, tick: Tick, window: QWidget) -> None:
        super().__init__(window)
        self._connection, self._run, self._desk, self._files, self._window = connection, run, desk, files, window
        self._tick = tick
        self.careful_of_code: Callable[[Callable[[], object]], None] = lambda go_on: go_on() and None  # of the editor
        self.last: list[Callable[[], object]] = []  # keep what is not kept yet
        self._event: QCloseEvent | None = None  # while the window is asked to close
        self._unwritten: int | None = None  # before the last was written; None: nobody is about to leave
        self._gone = False  # all is agreed to and written: every window closes
        self._asking: Asking | None = None
        self._then: tuple[Controller, Callable[[], object]] | None = None  # once this one has stopped
        self._after: tuple[Controller, Callable[[], object]] | None = None  # once what is under way has ended there
        self.left: Controller | None = None  # works, and the person turns away from it all the same

    def asked(self, event: QCloseEvent) -> None:
        """The window is to be closed."""
        event.setAccepted(self._gone)
        if self._gone:
            return
        self._event = event
        if self._unwritten is None:
            self.check(self._close)
        else:  # a second time: the disk may hang; its thread goes on
            self._leave()
        self._event = None

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
        """With each tick: judges what the machine has answered, goes on once a stop is proved, or all is written."""
        self._judge()
        self._leave_written()
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
        """About the machine nothing is open; what is not saved is asked about next."""
        _leave_field()
        self._files.careful(TITLE, lambda: self.careful_of_code(self._end))

    def _end(self) -> None:
        """Keeps what is not kept, and closes when that is written."""
        self._unwritten = self._tick.unwritten
        for each in self.last:
            each()
        self._leave_written()
        if self._unwritten is not None:
            self.said.emit("Closes as soon as everything is written.")

    def _leave_written(self) -> None:
        if self._unwritten is None or self._tick.writing:
            return
        if self._tick.unwritten == self._unwritten:
            self._leave()
            return
        self._unwritten = None
        self.said.emit("Not left: something could not be written, as was just said. Closing again leaves without it.")

    def _leave(self) -> None:
        self._gone = True
        self._desk.leave()
        if self._event is not None:
            self._event.accept()
        else:
            self._window.close()
        QApplication.quit()  # asks every window once more
        self._gone, self._unwritten = False, None


def _leave_field() -> None:
    """What was typed last is taken as if the field had been left; a cell may be one of the machine's and is not."""
    field = QApplication.focusWidget()
    if isinstance(field, QLineEdit | QAbstractSpinBox) and not isinstance(_above(field), QAbstractItemView):
        field.clearFocus()


def _above(field: QWidget) -> QWidget | None:
    """What a cell is edited in."""
    view = field.parentWidget()
    return view.parentWidget() if view is not None else None
