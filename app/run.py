"""Download, execute, halt, burn and upload: what is asked before, and what is said afterwards."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from datetime import datetime
from functools import partial
from typing import Any, Protocol

from PySide6.QtCore import QObject, Signal

from app.connection import Connection
from app.held import Held, Holding, Sent, burn_words, execute_words, held_by, slow_words
from app.right_machine import RightMachine
from app.session import Session
from app.tick import Tick, failure_of
from codegen.generate import Listing
from codegen.program import program_label
from codegen.slowed import slowed
from codegen.twoletter.slow_mark import FULL
from device.api import Badge, Job
from device.download import program_lines

Answers = Sequence[tuple[str, Callable[[], None]]]


class Ask(Protocol):
    """Puts a question up without waiting for the answer."""

    def __call__(self, title: str, words: str, answers: Answers, picture: str = "help") -> None: ...


class Before(Protocol):
    """Keeps what an action is about to replace, then goes on with the program that was read (None: none was)."""

    def __call__(self, reason: str, go_on: Callable[[str | None], None]) -> None: ...


def _at_once(reason: str, go_on: Callable[[str | None], None]) -> None:
    go_on(None)


class Run(QObject):
    """Talks to the controller's memory; `job` is what is under way."""

    said = Signal(str)
    uploaded = Signal(str)
    downloaded = Signal(object)  # the Listing that is now in the controller
    burned = Signal()  # what the controller holds is in the EEPROM
    show_problem = Signal(str)  # step id

    def __init__(
        self,
        connection: Connection,
        session: Session,
        tick: Tick,
        ask: Ask,
        right: RightMachine,
        parent: QObject | None = None,
        now: Callable[[], datetime] = datetime.now,
    ) -> None:
        super().__init__(parent)
        self._connection, self._session, self._tick, self._ask = connection, session, tick, ask
        self._right = right
        self.job: Job[Any] | None = None
        self.doing = ""
        self._now = now
        self.before: Before = _at_once
        self.before_start: Callable[[Callable[[], object]], object] = lambda go_on: go_on()
        self._under_way: Future[Any] | None = None
        self._last: Sent | None = None  # under way, or sent last, of the program that is open
        self._sent: Sent | None = None  # verified
        self._known: tuple[object, Held] | None = None
        session.replaced.connect(self._forget_open)

    def download(self, then: Callable[[], None] | None = None, percent: int = FULL) -> None:
        """The listing of the open program, at a part of its speed if wanted; verified by reading it back."""
        listing = self._listing(percent)
        errors = [each for each in listing.problems if each.severity == "error"]
        if errors:
            first = errors[0]
            self._ask(
                "The program cannot be downloaded yet" if percent == FULL else f"It cannot run at {percent} %",
                _as_sentence(first.message) + (f" ({len(errors) - 1} more in Problems.)" if len(errors) > 1 else ""),
                [("Show it", lambda: self.show_problem.emit(first.step))],
                "problem",
            )
            return
        self._right.careful("Download", partial(self._download, then, percent))

    def download_text(self, text: str, then: Callable[[Future[Any]], None]) -> None:
        """Code written by hand, as it stands; verified by reading it back, kept apart from the open program."""

        def send(old: str | None) -> None:
            self._last = None
            self.begin("Downloading", self._connection.controller.memory.download(text, old=old), then)

        self._right.careful("Download", lambda: self.before("before a download", send))

    def _listing(self, percent: int) -> Listing:
        return self._session.listing if percent == FULL else slowed(self._session.document, percent)

    def _download(self, then: Callable[[], None] | None, percent: int) -> None:
        listing = self._listing(percent)  # as sent: the document may change meanwhile
        name = program_label(self._session.document.program)
        sent = Sent(name, tuple(program_lines(listing.text)), self._now().strftime("%H:%M"))
        self._last = sent
        self.before("before a download", partial(self._send, listing, sent, then))

    def _send(self, listing: Listing, sent: Sent, then: Callable[[], None] | None, old: str | None) -> None:
        job = self._connection.controller.memory.download(listing.text, old=old)
        self.begin("Downloading", job, lambda done: self._downloaded(done, listing, sent, then))

    def execute(self) -> None:
        """Runs the program when it is the one that was verified; otherwise says what is held and asks what is meant."""
        self._right.careful("Execute", self._execute)

    def _execute(self) -> None:
        held = self.held()
        if held.holding is Holding.SAME:
            self.run_in_controller()
        elif held.holding is Holding.UNKNOWN:
            self._read_first(self._execute)
        else:
            download = ("Download and execute", lambda: self.download(self.run_in_controller))
            run = ("Run what is in the controller", partial(self._run_held, held))
            show = ("Show what is in the controller", self.upload)
            if held.holding is Holding.SLOWED:
                download = ("Download and execute at full speed", download[1])
                run = (f"Run it at {held.percent} %", run[1])
            answers = [download] if held.holding is Holding.EMPTY else [download, run, show]
            self._ask("Which program?", execute_words(held), answers, "warning")

    def execute_slowly(self, percent: int) -> None:
        """Runs the program at a part of its speed; what the controller holds is exchanged for that after asking."""
        self._right.careful("Execute", partial(self._execute_slowly, percent))

    def _execute_slowly(self, percent: int) -> None:
        held = self.held()
        if held.holding is Holding.UNKNOWN:
            self._read_first(partial(self._execute_slowly, percent))
        elif held.percent == percent and list(held.lines) == program_lines(self._listing(percent).text):
            self.run_in_controller()
        else:
            answer = partial(self.download, self.run_in_controller, percent)
            words = f"Download and execute at {percent} %"
            self._ask(f"Execute at {percent} % of the speed?", slow_words(held, percent), [(words, answer)], "warning")

    def run_in_controller(self) -> None:
        """Starts it, once the limits of the setup are settled."""
        self.before_start(self._start)

    def _start(self) -> None:
        """XQ of the program's label if a verified listing of it is in the controller, else of line 0."""
        controller, held = self._connection.controller, self.held()
        same = controller.program_badge is Badge.SAME
        label = program_label(self._session.document.program) if same else None
        if held.holding is Holding.SLOWED and held.sent is not None:
            label = held.sent.name
        self._then(controller.execute(label, anyway=not same), self._executed)

    def held(self) -> Held:
        """What the controller holds; worked out again only when something about it has changed."""
        controller = self._connection.controller
        key = (controller, controller.listing, controller.program_badge, self._sent)
        if self._known is None or self._known[0] != key:
            self._known = (key, held_by(controller, self._sent))
        return self._known[1]

    def halt(self) -> None:
        """Halts all threads and decelerates all motion."""
        self._then(self._connection.controller.halt(), self._halted)

    def burn(self) -> None:
        """Says what will be burned and what the next power-up will do, then burns when told to."""
        self._right.careful("Burn", self._ask_to_burn)

    def _ask_to_burn(self) -> None:
        held = self.held()
        if held.holding is Holding.UNKNOWN:
            self._read_first(self._ask_to_burn)
            return
        name = program_label(self._session.document.program)
        burn, first = ("Burn", partial(self._burn, held)), ("Download first", partial(self.download, self.burn))
        answers = [burn] if held.holding is Holding.SAME else [first, burn]
        if held.holding is Holding.SLOWED:
            answers = [("Download at full speed", self.download)]
        self._ask("Burn the program?", burn_words(held, name), answers, "warning")

    def upload(self) -> None:
        """Reads the controller's program and shows it."""
        self._read(lambda done: self.uploaded.emit(str(done.result())))

    def cancel(self) -> None:
        """Gives up what is under way."""
        if self.job is not None:
            self.job.cancel()

    def _read(self, finished: Callable[[Future[Any]], None]) -> None:
        self.begin("Uploading", self._connection.controller.upload(), finished)

    def _read_first(self, then: Callable[[], None]) -> None:
        """What the controller holds is not known: it is read, then asked about."""
        controller = self._connection.controller

        def go_on(_: Future[Any]) -> None:
            if controller is not self._connection.controller or self.held().holding is Holding.UNKNOWN:
                self.said.emit("What the controller holds is still not known. Try again.")
            else:
                then()

        self._read(go_on)

    def _run_held(self, held: Held) -> None:
        if self._still(held, "Not started"):
            self.run_in_controller()

    def _burn(self, held: Held) -> None:
        if self._still(held, "Not burned"):
            self.before("before a burn", lambda _: self._burn_now(held))

    def _burn_now(self, held: Held) -> None:
        if not self._still(held, "Not burned"):
            return
        self.doing = "Burning: leave the power on"
        self._under_way = future = self._connection.controller.burn_program()
        self._then(future, self._burned, "It is not known whether the program was burned: ")

    def _still(self, held: Held, what: str) -> bool:
        """Whether the controller holds what the person was told; says so when it does not."""
        if self.held() == held:
            return True
        self.said.emit(f"{what}: what the controller holds is not what was asked about. Try again.")
        return False

    def _burned(self, future: Future[Any]) -> None:
        reply = future.result()
        if reply.accepted:
            self.burned.emit()
        burned = "The program is burned: it is there after the next power-up."
        self.said.emit(burned if reply.accepted else f"The program is not burned: {reply.reason}")

    def _halted(self, future: Future[Any]) -> None:
        reply = future.result()
        self.said.emit("Halted: programs and motion." if reply.accepted else f"Halt: {reply.reason} Press STOP.")

    def _executed(self, future: Future[Any]) -> None:
        reply = future.result()
        self.said.emit(
            "The program was started." if reply.accepted else f"The controller refused to run it: {reply.reason}"
        )

    def _downloaded(self, future: Future[Any], listing: Listing, sent: Sent, then: Callable[[], None] | None) -> None:
        done = future.result()
        if done.verified:
            self._sent = dc.replace(sent, open=self._last is sent)
            self.downloaded.emit(listing)
        self.said.emit(done.sentence)
        if then is not None and done.verified:
            then()

    def begin(
        self,
        doing: str,
        job: Job[Any],
        finished: Callable[[Future[Any]], None],
        failed: Callable[[Future[Any]], None] | None = None,
    ) -> None:
        """Something with the controller's memory is under way; a failure is said unless it is taken care of."""
        self.job, self.doing, self._under_way = job, doing, job.future
        self._then(job.future, finished, failed=failed)

    def _forget_open(self) -> None:
        """Another program is open: what was sent is no earlier state of it."""
        self._last = None
        self._sent = dc.replace(self._sent, open=False) if self._sent is not None else None

    def _then(
        self,
        future: Future[Any],
        finished: Callable[[Future[Any]], None],
        before: str = "",
        failed: Callable[[Future[Any]], None] | None = None,
    ) -> None:
        def done(future: Future[Any]) -> None:
            if future is self._under_way:  # a halt, for instance, ends no download
                self.job, self.doing, self._under_way = None, "", None
            failure = failure_of(future)
            if failure and failed is not None:
                failed(future)
            elif failure:
                self.said.emit(f"{before}{failure}")
            else:
                finished(future)

        self._tick.when_done(future, done)


def _as_sentence(words: str) -> str:
    """A problem as it stands in a list, as a sentence of its own."""
    return f"{words[:1].upper()}{words[1:].rstrip('.')}."
