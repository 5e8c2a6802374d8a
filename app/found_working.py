"""A machine that works already when it is met: what runs and moves there, and what can be done about it."""

from __future__ import annotations

from collections.abc import Callable

from app.connection import Connection
from app.run import Ask
from app.tick import failure_of
from app.work import Inquiry, inquire
from device.api import Controller, Kind, State

TITLE = "The machine is at work"
SINCE = "Since when, and what ran before, is not known. Connecting has changed nothing: the studio only watches."


class FoundWorking:
    """`look` is called with each tick; it asks the machine once for every connection."""

    def __init__(
        self,
        connection: Connection,
        ask: Ask,
        stop: Callable[[], None],
        upload: Callable[[], None],
        first: Callable[[Controller], bool],
    ) -> None:
        self._connection, self._ask, self._stop, self._upload = connection, ask, stop, upload
        self._first, self._late = first, False  # whether something else is asked before; whether it has been
        self._met: Controller | None = None
        self._asked: Inquiry | None = None

    @property
    def asking(self) -> bool:
        """Whether a machine has still to say what it does."""
        return self._asked is not None

    def look(self) -> None:
        """Asks a machine that has just been met what it does, and tells the person when it works."""
        controller = self._connection.controller
        if controller is not self._met:
            if controller.kind is not Kind.MACHINE or controller.state is not State.READY:
                return
            self._met, self._asked, self._late = controller, inquire(controller), False
        if controller.control:  # what works from now on may have been started from here
            self._asked = None
        if self._asked is not None and self._asked.answer.done():
            if self._first(controller):
                self._late = True
                return
            if self._late:  # much may have ended since then
                self._asked, self._late = inquire(controller), False
                return
            asked, self._asked = self._asked, None
            self._tell(controller, asked)

    def _tell(self, controller: Controller, asked: Inquiry) -> None:
        if failure_of(asked.answer):
            found = controller.resting()  # a question may come at any moment: then nothing more is asked
        else:
            listing = controller.waiting.listing
            found = asked.work().told(listing.text.splitlines() if listing is not None else ())
        if found:
            answers = [
                ("Go on watching", _nothing),
                ("Stop everything", self._stop),
                ("Read its program", self._upload),
            ]
            self._ask(TITLE, f"{found}\n{SINCE}", answers, "warning")


def _nothing() -> None:
    """The person has seen it."""
