"""Moving by hand: what the jog panel asks for goes to the controller, what came of it goes back."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from concurrent.futures import Future
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject

from app.connection import Connection
from app.run import Ask
from app.session import Session
from app.tick import Tick, failure_of
from device.jog import zero
from device.moving import NeedsConfirmation
from widgets.display.readings import unit_of
from widgets.jog.panel import JogPanel
from widgets.parts.units import shown

if TYPE_CHECKING:
    from device.jog import Plan
    from device.lease import Ran
    from device.moving import Ended

PANEL = "panel"


class ByHand(QObject):
    """Every refusal becomes a sentence in the panel; a move that needs a yes asks for it."""

    def __init__(
        self,
        connection: Connection,
        session: Session,
        tick: Tick,
        panel: JogPanel,
        ask: Ask,
        homed: Callable[[], Iterable[str]],
        parent: QObject | None = None,
    ) -> None:
        super().__init__(parent)
        self._connection, self._session, self._tick = connection, session, tick
        self._panel, self._ask, self._homed = panel, ask, homed
        panel.hold_wanted.connect(self._hold)
        panel.run_wanted.connect(self._run)
        panel.renewed.connect(lambda owner: self._motion.renew(owner))
        panel.released.connect(lambda owner: self._motion.release(owner or None))
        panel.latch_wanted.connect(lambda on: self._motion.set_latch(on))
        panel.plan_wanted.connect(self.go)
        panel.zero_wanted.connect(self._zero)

    @property
    def _motion(self) -> Any:
        motion = self._connection.controller.motion
        motion.setup = self._session.document.working_setup
        return motion

    def _hold(self, axis: str, speed: int, acceleration: int, deceleration: int, owner: str) -> None:
        self._panel.show_result("")
        self._expect(self._motion.hold(axis, speed, acceleration, deceleration, owner), self._ran)

    def _run(self, axis: str, speed: int, acceleration: int, deceleration: int, owner: str) -> None:
        self._panel.show_result("")
        self._expect(self._motion.run(axis, speed, acceleration, deceleration, owner), self._ran)

    def go(self, plan: Plan, confirmed: bool = False) -> None:
        """A planned move; asked about first where it passes a limit or the axis is not homed."""
        self._panel.show_result(f"{plan.title}…")
        future: Future[Ended] = self._motion.go(plan, owner=PANEL, homed=self._homed(), confirmed=confirmed)

        def done(future: Future[Any]) -> None:
            error = None if future.cancelled() else future.exception()
            if isinstance(error, NeedsConfirmation):
                self._panel.show_result("")
                answers = [("Move anyway", lambda: self.go(plan, confirmed=True))]
                self._ask("Move all the same?", str(error), answers, "warning")
            elif failure := failure_of(future):
                self._panel.show_result(failure, good=False)
            else:
                self._panel.show_result(self._ended(future.result()))

        self._tick.when_done(future, done)

    def _zero(self, axis: str) -> None:
        words = (
            f"The place where axis {axis} stands now becomes 0. Programs and limits count from there. Nothing moves."
        )
        self._ask(f"Set axis {axis} to zero here?", words, [("Set to zero", lambda: self.go(zero(axis)))], "warning")

    def _ended(self, ended: Ended) -> str:
        at = ", ".join(self._place(letter, counts) for letter, counts in ended.places.items())
        return f"{ended.sentence} {at}" if at else ended.sentence

    def _ran(self, ran: Ran) -> str:
        axis = self._session.document.working_setup.axis(ran.axis)
        ran_on = f"{shown(ran.run_on, axis)} {unit_of(axis)}"
        return f"{ran.sentence} {self._place(ran.axis, ran.place)}; ran on {ran_on} in {ran.seconds * 1000:.0f} ms."

    def _place(self, letter: str, counts: int) -> str:
        axis = self._session.document.working_setup.axis(letter)
        return f"{letter} at {shown(counts, axis)} {unit_of(axis)}"

    def _expect(self, future: Future[Any], words: Callable[[Any], str]) -> None:
        def done(future: Future[Any]) -> None:
            failure = failure_of(future)
            self._panel.show_result(failure or words(future.result()), good=not failure)

        self._tick.when_done(future, done)
