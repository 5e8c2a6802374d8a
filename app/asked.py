"""Questions about a machine: an answer counts only for the machine it was asked about, as long as nobody stopped it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from app.connection import Connection
from app.run import Answers, Ask
from device.api import Controller, Identity

ANOTHER = "Nothing was done: another controller is connected now."
AGAIN = "Nothing was done: the connection was interrupted meanwhile."
STOPPED = "Nothing was done: STOP was pressed meanwhile."


@dataclass(frozen=True)
class Moment:
    """What was connected when a question was put up, and the last line that had gone over the wire."""

    controller: Controller
    identity: Identity | None
    line: int

    @classmethod
    def now(cls, controller: Controller) -> Moment:
        """As it is."""
        return cls(controller, controller.identity, max((each.number for each in controller.traffic()), default=0))

    def over(self, controller: Controller) -> str:
        """Why an answer does not count any more, as a sentence, or nothing."""
        if controller is not self.controller:
            return ANOTHER
        if controller.identity is not self.identity:  # each meeting makes a new one
            return AGAIN
        return STOPPED if any(each.source == "stop" for each in controller.traffic(self.line)) else ""


class AskedOfMachine:
    """Puts questions up like the desk; answers that come too late do nothing and say so."""

    def __init__(self, connection: Connection, ask: Ask, say: Callable[[str], None]) -> None:
        self._connection, self._ask, self._say = connection, ask, say

    def __call__(self, title: str, words: str, answers: Answers, picture: str = "help") -> None:
        moment = Moment.now(self._connection.controller)
        self._ask(title, words, [(label, partial(self._answer, moment, call)) for label, call in answers], picture)

    def _answer(self, moment: Moment, call: Callable[[], None]) -> None:
        if over := moment.over(self._connection.controller):
            self._say(over)
        else:
            call()
