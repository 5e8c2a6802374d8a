"""Download, execute, halt, burn and upload: what is asked before, and what is said afterwards."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Future
from typing import Any, Protocol

from PySide6.QtCore import QObject, Signal

from app.connection import Connection
from app.session import Session
from app.tick import Tick, failure_of
from codegen.generate import Listing
from codegen.program import program_label
from device.api import Badge, Job

Answers = Sequence[tuple[str, Callable[[], None]]]


class Ask(Protocol):
    """Puts a question up without waiting for the answer."""

    def __call__(self, title: str, words: str, answers: Answers, picture: str = "help") -> None: ...


class Run(QObject):
    """Talks to the controller's memory; `job` is what is under way."""

    said = Signal(str)
    uploaded = Signal(str)
    downloaded = Signal(object)  # the Listing that is now in the controller
    show_problem = Signal(str)  # step id

    def __init__(
        self, connection: Connection, session: Session, tick: Tick, ask: Ask, parent: QObject | None = None
    ) -> None:
        super().__init__(parent)
        self._connection, self._session, self._tick, self._ask = connection, session, tick, ask
        self.job: Job[Any] | None = None
        self.doing = ""

    def download(self, then: Callable[[], None] | None = None) -> None:
        """The listing of the open program, verified by reading it back."""
        listing = self._session.listing
        errors = [each for each in listing.problems if each.severity == "error"]
        if errors:
            first = errors[0]
            self._ask(
                "The program can not be downloaded yet",
                f"{first.message}" + (f" (and {len(errors) - 1} more)" if len(errors) > 1 else ""),
                [("Show it", lambda: self.show_problem.emit(first.step))],
                "problem",
            )
            return
        mismatch = self._mismatch()
        if mismatch:
            self._ask("Another controller", mismatch, [("Download anyway", lambda: self._download(then))], "warning")
        else:
            self._download(then)

    def _mismatch(self) -> str:
        """Why this program may not be for this controller; empty when it is."""
        found, wanted = self._connection.controller.model, self._session.document.setup.limits
        if found is None or found == wanted:
            return ""
        return (
            f"The program is written for {wanted.name.upper()} ({wanted.axes}), but {found.name.upper()} "
            f"({found.axes}) is connected. Change the model in the setup, or download all the same."
        )

    def _download(self, then: Callable[[], None] | None) -> None:
        listing = self._session.listing  # as sent: the document may change meanwhile
        job = self._connection.controller.download(listing.text)
        self._begin("Downloading", job, lambda done: self._downloaded(done, listing, then))

    def execute(self) -> None:
        """Runs the program when it is the one that was verified; otherwise asks which one is meant."""
        badge = self._connection.controller.program_badge
        if badge is Badge.SAME:
            self.run_in_controller()
            return
        words = {
            Badge.CHANGED: "The program was changed since it was downloaded. The controller holds the earlier one.",
            Badge.UNKNOWN: "What is in the controller is not known to be this program.",
        }[badge]
        answers: Answers = [
            ("Download and execute", lambda: self.download(self.run_in_controller)),
            ("Run what is in the controller", self.run_in_controller),
            ("Show what is in the controller", self.upload),
        ]
        self._ask("Which program?", words, answers, "warning")

    def run_in_controller(self) -> None:
        """XQ of the program's label if the verified listing is in the controller, else of line 0."""
        controller = self._connection.controller
        same = controller.program_badge is Badge.SAME
        label = program_label(self._session.document.program) if same else None
        self._then(controller.execute(label, anyway=not same), self._executed)

    def halt(self) -> None:
        """Halts all threads and decelerates all motion."""
        self._then(self._connection.controller.halt(), lambda _: self.said.emit("Halted: programs and motion."))

    def burn(self) -> None:
        """Says what the next power-up will do, then burns when told to."""
        words = self._connection.controller.memory.burn_words()
        self._ask("Burn the program?", words, [("Burn", self._burn)], "warning")

    def upload(self) -> None:
        """Reads the controller's program."""
        self._begin(
            "Uploading", self._connection.controller.upload(), lambda done: self.uploaded.emit(str(done.result()))
        )

    def cancel(self) -> None:
        """Gives up what is under way."""
        if self.job is not None:
            self.job.cancel()

    def _burn(self) -> None:
        self.doing = "Burning: leave the power on"
        future = self._connection.controller.burn_program()
        self._then(future, lambda _: self.said.emit("The program is burned: it is there after the next power-up."))

    def _executed(self, future: Future[Any]) -> None:
        reply = future.result()
        self.said.emit("The program runs." if reply.accepted else f"The controller refused to run it: {reply.reason}")

    def _downloaded(self, future: Future[Any], listing: Listing, then: Callable[[], None] | None) -> None:
        done = future.result()
        if done.verified:
            self.downloaded.emit(listing)
        self.said.emit(done.sentence)
        if then is not None and done.verified:
            then()

    def _begin(self, doing: str, job: Job[Any], finished: Callable[[Future[Any]], None]) -> None:
        self.job, self.doing = job, doing
        self._then(job.future, finished)

    def _then(self, future: Future[Any], finished: Callable[[Future[Any]], None]) -> None:
        def done(future: Future[Any]) -> None:
            self.job, self.doing = None, ""
            failure = failure_of(future)
            if failure:
                self.said.emit(failure)
            else:
                finished(future)

        self._tick.when_done(future, done)
