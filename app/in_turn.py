"""What the studio asks by itself, as after a crash: one after the other, unsaved work last."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

from PySide6.QtCore import QObject
from PySide6.QtWidgets import QDialog

from app.connection import Connection
from app.run import Answers
from device.api import Controller, State
from widgets.parts.question import Question


@dataclass(frozen=True)
class Put:
    """A question about a machine, for as long as that one is connected."""

    controller: Controller
    title: str
    words: str
    answers: Answers
    picture: str


class InTurn(QObject):
    """`ask` is used like the desk's; `hold` keeps a window back until nothing about the machine is open or to come."""

    def __init__(
        self, connection: Connection, put: Callable[..., Question], coming: Callable[[], bool], parent: QObject
    ) -> None:
        super().__init__(parent)
        self._connection, self._put, self._coming = connection, put, coming
        self._waiting: deque[Put] = deque()
        self._open: Question | None = None
        self._held: QDialog | None = None

    def ask(self, title: str, words: str, answers: Answers, picture: str = "help") -> None:
        """As soon as those before it are answered."""
        self._waiting.append(Put(self._connection.controller, title, words, answers, picture))
        self.look()

    @property
    def asking(self) -> bool:
        """Whether a question about the machine is open."""
        return self._open is not None

    def hold(self, window: QDialog) -> None:
        """Shown when it is its turn; steps aside while something is asked about the machine."""
        self._held = window
        window.finished.connect(self._let_go)

    def look(self) -> None:
        """With each tick: whose turn it is."""
        while self._open is None and self._waiting:
            self._next(self._waiting.popleft())
        if self._held is not None:
            connecting = self._connection.controller.state is State.CONNECTING
            shown = self._open is None and (self._held.isVisible() or not (connecting or self._coming()))
            if self._held.isVisible() != shown:
                self._held.setVisible(shown)

    def _next(self, put: Put) -> None:
        if put.controller is self._connection.controller:
            self._open = self._put(put.title, put.words, put.answers, put.picture)
            self._open.finished.connect(self._answered)

    def _answered(self) -> None:
        self._open = None

    def _let_go(self) -> None:
        self._held = None
