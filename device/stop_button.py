"""The STOP button: what a press does, and what the button shows."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from device.happenings import Kind, NoticeKind, State
from device.stop import NO_ANSWER_S, Stopping, StopState
from device.tasks import Steps

if TYPE_CHECKING:
    from device.api import Controller

TOLD = (StopState.STOPPING, StopState.STOPPED, StopState.NOT_CONFIRMED)


class StopButton:
    """One for a controller; callable in every state of it."""

    def __init__(self, controller: Controller) -> None:
        self._c = controller
        self._stopping: Stopping | None = None
        self.state = StopState.NO_LINK  # as it was shown last
        self.pressed_at = 0.0

    def press(self, then: Callable[[bool], None]) -> None:
        """Stops everything, ahead of everything; pressed again while it is not proved, it aborts."""
        c = self._c
        if c.kind is Kind.REPLAY:
            c.notify(NoticeKind.STOP, "There is nothing to stop: this is a recording.")
            then(False)
            return
        if c.link.transport is None:
            self.show(StopState.NO_LINK if c.state is State.OFFLINE else StopState.NOT_CONFIRMED)
            then(False)
            return
        again = self._stopping is not None or self.state is StopState.STOPPING
        c.motion.let_go()
        self._stopping, self.pressed_at = None, c.clock()
        self.show(StopState.STOPPING)
        c.link.stop(lambda sure: self._steps(sure, again, then))

    def _steps(self, sure: bool, abort: bool, then: Callable[[bool], None]) -> Steps[bool]:
        c, model = self._c, self._c.model
        self._stopping = stopping = Stopping(
            command_mode=sure and not c.resting() and c.line.address is None,  # others in a chain prove nothing
            axes=c.axes or "X",
            sequence=model is not None and model.coordinated,
            threads=model.threads if model is not None else 1,
            columns=model.columns if model is not None else 40,
            address=c.line.address,
            stopping_time_s=c.stopping_time_s,
            clock=c.clock,
            nonces=c.nonces,
            show=self.show,
            abort=abort,
            heard=self.pressed_at,
        )
        still = False
        try:
            still = yield from stopping.steps()
        finally:
            self._stopping = None
            then(still)
        if still:
            c.waiting.restarted()
            c.waiting.unfinished = False
            c.waiting.threads(frozenset())
            c.door.question = ""
        return still

    def look(self) -> StopState:
        """What it shows now; 500 ms without an answer is NOT CONFIRMED, whatever the link is doing."""
        if self.state is StopState.STOPPING:
            heard = self.pressed_at if self._stopping is None else self._stopping.heard
            if self._c.clock() - heard >= NO_ANSWER_S:
                self.show(StopState.NOT_CONFIRMED)
        return self.state

    def show(self, state: StopState) -> None:
        """The stop is now known to be in this state."""
        if state is not self.state:
            self.state = state
            if state in TOLD:
                self._c.notify(NoticeKind.STOP, f"STOP: {state}.")
