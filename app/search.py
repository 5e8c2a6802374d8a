"""Looking for a controller at start: ports known from before first, one by one; a new port only when allowed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from PySide6.QtCore import QObject, Signal

from app.connection import Connector, Opened
from device.api import State
from device.transport import LineSettings

PATIENCE_S = 6.0


@dataclass(frozen=True)
class Candidate:
    """A port that could have a controller behind it."""

    device: str
    words: str
    used_before: bool


class Search(QObject):
    """Tries one candidate at a time; `look` is called with each tick and never waits."""

    looking = Signal(str)  # what is being tried, a sentence
    question = Signal(object)  # Candidate that was never used
    found = Signal(object, object)  # Candidate, Opened
    nothing = Signal(str)  # why none was found

    def __init__(self, connect: Connector, clock: Callable[[], float], parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._connect, self._clock = connect, clock
        self._left: list[Candidate] = []
        self._failed: list[str] = []
        self._line = LineSettings()
        self._asked: Candidate | None = None
        self._trying: tuple[Candidate, Opened, float] | None = None

    @property
    def busy(self) -> bool:
        return self._trying is not None

    def start(self, candidates: Sequence[Candidate], line: LineSettings) -> None:
        """Ports used before come first."""
        self.cancel()
        self._line = line
        self._failed = []
        self._left = sorted(candidates, key=lambda each: not each.used_before)
        if not self._left:
            self.nothing.emit("This computer has no serial port. Plug in the cable of the controller and try again.")
            return
        self._next()

    def allow(self) -> None:
        """The person lets the port in question be asked."""
        if self._asked is not None:
            candidate, self._asked = self._asked, None
            self._try(candidate)

    def skip(self) -> None:
        """The person wants that port left alone."""
        if self._asked is not None:
            self._failed.append(f"{self._asked.device} was left alone")
            self._asked = None
            self._next()

    def cancel(self) -> None:
        """Something else was chosen."""
        self._left, self._asked = [], None
        if self._trying is not None:
            self._trying[1].controller.close()
            self._trying = None

    def look(self) -> None:
        """Has the port that is being tried answered?"""
        if self._trying is None:
            return
        candidate, opened, since = self._trying
        controller = opened.controller
        if controller.state is State.READY:
            self._trying = None
            self._left = []
            self.found.emit(candidate, opened)
        elif controller.state is State.LOST or self._clock() - since > PATIENCE_S:
            self._trying = None
            self._failed.append(f"{candidate.device}: {controller.state_text or 'no answer'}")
            controller.close()
            self._next()

    def _next(self) -> None:
        if not self._left:
            tried = "; ".join(self._failed)
            self.nothing.emit(
                f"No controller answered at {self._line.baud} baud ({tried}). Check cable, power and switches."
            )
            return
        candidate = self._left.pop(0)
        if candidate.used_before:
            self._try(candidate)
        else:
            self._asked = candidate
            self.question.emit(candidate)

    def _try(self, candidate: Candidate) -> None:
        self.looking.emit(f"Asking {candidate.words} ({candidate.device}) at {self._line.baud} baud…")
        self._trying = (candidate, self._connect(candidate.device, self._line), self._clock())
