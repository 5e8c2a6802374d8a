"""Before a program starts: the limits of the setup are in the controller, or the person has said otherwise."""

from __future__ import annotations

from collections.abc import Callable, Collection
from concurrent.futures import Future
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, Signal

from app.connection import Connection
from app.run import Ask
from app.session import Session
from app.tick import Tick, failure_of
from codegen.document import Document
from codegen.setup import Setup, setup_problems
from device.api import Controller, Kind, State

if TYPE_CHECKING:
    from codegen.setup_differences import Difference, Key

MOST_SHOWN = 8  # values in a question


@dataclass(frozen=True)
class Moment:
    """What would start: a restart and a download bring another listing."""

    controller: Controller
    document: Document
    listing: str | None
    traffic: int  # the last line that had gone over the wire

    @property
    def was_stopped(self) -> bool:
        """Whether STOP was pressed since: then nothing starts any more."""
        return any(each.source == "stop" for each in self.controller.traffic(self.traffic))


class SetupLimits(QObject):
    """Looks once for each controller, setup and downloaded program; a simulator is simply given the limits."""

    said = Signal(str)

    def __init__(self, connection: Connection, session: Session, tick: Tick, ask: Ask, parent: QObject | None = None):
        super().__init__(parent)
        self._connection, self._session, self._tick, self._ask = connection, session, tick, ask
        self._settled: tuple[object, ...] | None = None

    def careful(self, go_on: Callable[[], object]) -> None:
        """Goes on at once where there is nothing to compare; else reads the controller's limits first."""
        from codegen.setup_differences import stated_limits
        from device.setup_transfer import read_registers

        now = self._now()
        controller, setup = now.controller, now.document.setup
        if not comparable(controller, setup) or self._settled == (controller, setup, controller.listing):
            go_on()
            return
        keys = stated_limits(setup)

        def done(future: Future[Any]) -> None:
            failure = failure_of(future)
            if failure:
                self.said.emit(f"Not started, because the controller's limits were not read: {failure}")
            elif self._is_still(now):
                self._compare(now, keys, future.result(), go_on)

        self._tick.when_done(read_registers(controller, keys), done)

    def _now(self) -> Moment:
        controller = self._connection.controller
        lines = controller.traffic()
        return Moment(controller, self._session.document, controller.listing, lines[-1].number if lines else 0)

    def _is_still(self, then: Moment) -> bool:
        """Whether what was looked at is still what would start; says so when it is not."""
        if then.was_stopped:
            self.said.emit("Not started: STOP was pressed.")
            return False
        now = self._now()
        same = now.controller is then.controller and now.document is then.document and now.listing == then.listing
        if not same:
            self.said.emit("Not started: the program, the setup or the controller changed meanwhile. Try again.")
        return same

    def _compare(
        self, now: Moment, keys: Collection[Key], readings: dict[Key, int], go_on: Callable[[], object]
    ) -> None:
        from codegen.setup_differences import differences

        found = [each for each in differences(now.document.setup, readings) if each.key in keys]
        send = partial(self._send, now, [each.key for each in found], go_on)
        if not found:
            self._settle(now, go_on)
        elif now.controller.kind is Kind.SIMULATOR:
            send()
        else:
            answers = [
                ("Send the limits and execute", send),
                ("Execute with the controller's", partial(self._settle, now, go_on)),
            ]
            self._ask("The controller's limits are not those of the setup", limit_words(found), answers, "warning")

    def _settle(self, now: Moment, go_on: Callable[[], object]) -> None:
        if self._is_still(now):
            self._settled = (now.controller, now.document.setup, now.listing)
            go_on()

    def _send(self, now: Moment, keys: Collection[Key], go_on: Callable[[], object]) -> None:
        from codegen.setup_differences import lines_to_send
        from device.setup_transfer import Sent, send_setup

        if not self._is_still(now):
            return
        setup = now.document.setup

        def done(future: Future[Any]) -> None:
            failure = failure_of(future)
            sent: Sent | None = None if failure else future.result()
            if sent is None or not sent.complete:
                words = failure if sent is None else sent.sentence
                self._ask("Not started: the limits were not taken", words, (), "problem")
                return
            self.said.emit(f"Limits of the setup: {sent.sentence}")
            self._settle(now, go_on)

        self._tick.when_done(send_setup(now.controller, setup, lines_to_send(setup, set(keys))).future, done)


def comparable(controller: Controller, setup: Setup) -> bool:
    """Whether what is connected has the axes of the setup and would take its limits."""
    ready = controller.state is State.READY and controller.control and not controller.resting()
    same = controller.model is not None and controller.model.name == setup.model
    return ready and same and not any(each.severity == "error" for each in setup_problems(setup))


def limit_words(found: Collection[Difference]) -> str:
    """The values side by side."""
    rows = list(found)
    lines = [f"• {each.title} of {each.axis}: setup {each.setup}, controller {each.controller}" for each in rows]
    more = [f"• and {len(rows) - MOST_SHOWN} more"] if len(rows) > MOST_SHOWN else []
    return "\n".join([*lines[:MOST_SHOWN], *more, "", "The program was checked against the limits of the setup."])
