"""What a step that broke off has left: former values are offered first thing when the machine is there again."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, Signal

from app.connection import Connection
from app.run import Ask
from app.tick import Tick, failure_of
from device.api import Controller, Kind, State

if TYPE_CHECKING:
    from device.former import Former


@dataclass(frozen=True)
class Broken:
    """What it was that broke off, and how its former values are put back."""

    title: str
    name: str  # as in "the tuning of axis X"
    back: str  # what putting them back does, a sentence
    motor_off: bool = False
    values: str = ""  # what was changed, where it is more than gains


TUNING = Broken(
    "A tuning was interrupted",
    "tuning",
    "Putting them back moves nothing and burns nothing; a jog at speed 0 that was left is stopped.",
)
STEP = Broken(
    "A commissioning step was interrupted",
    "commissioning",
    "Putting them back switches the motor off, moves nothing and burns nothing.",
    motor_off=True,
    values="settings",
)


class Offer(QObject):
    """Looks into the folder when a controller answers; says at the start what is waiting for its machine."""

    said = Signal(str)

    def __init__(
        self,
        connection: Connection,
        tick: Tick,
        ask: Ask,
        folder: Path,
        running: Callable[[], bool],
        parent: QObject | None = None,
        broken: Broken = TUNING,
    ) -> None:
        super().__init__(parent)
        self._connection, self._tick, self._ask, self._folder, self._running = connection, tick, ask, folder, running
        self._broken = broken
        self._looked_at: Controller | None = None  # and its values, or nothing left behind, were told
        self._told = False
        self._reading: Controller | None = None  # what it holds is on its way

    @property
    def looking(self) -> bool:
        """Whether what the controller holds of it is being read."""
        return self._reading is self._connection.controller

    def look(self) -> None:
        """With each tick; the folder is read once for every connection."""
        if not self._told:
            self._told = True
            self._tell_at_start()
        controller = self._connection.controller
        if controller.kind is Kind.OFFLINE or controller.state is not State.READY:
            self._looked_at = None
            return
        if self._running():
            self._looked_at = None  # what it could not put back (Watch, a lost line) is asked about when it has ended
            return
        if self.looking or controller is self._looked_at or controller.model is None or controller.resting():
            return
        self._looked_at = controller
        self.offer(controller)

    def again(self) -> None:
        """A step has failed here: what it could not put back is asked about, once it can be."""
        self._looked_at = None

    def offer(self, controller: Controller) -> None:
        """Asks about the axes of this controller, one after the other."""
        if not self._folder.is_dir():
            return
        from device.former import left_behind, named, now_there

        if not left_behind(self._folder):
            return
        if controller.identity is None or controller.identity.serial is None:
            self._reading = controller
            self._tick.when_done(named(controller), partial(self._named, controller))
        elif left := self._left(controller):
            former = left[0]
            self._reading = controller
            self._tick.when_done(now_there(controller, former), partial(self._compare, controller, former))

    def _named(self, controller: Controller, future: Future[Any]) -> None:
        """Its serial number was disturbed when it was met: it has been asked once more."""
        self._reading = None
        if failure_of(future):
            self._looked_at = None
        elif controller.identity is not None and controller.identity.serial is not None:
            self.offer(controller)

    def _left(self, controller: Controller) -> list[Former]:
        """The oldest of each axis: it holds the values from before all of them."""
        from device.former import left_behind, meant

        found: dict[str, Former] = {}
        for former in left_behind(self._folder):
            if meant(former, controller):
                found.setdefault(former.axis, former)
        return list(found.values())

    def _tell_at_start(self) -> None:
        if not self._folder.is_dir():
            return
        from device.former import left_behind

        for former in left_behind(self._folder)[:1]:
            values = self._broken.values or f"gains ({former.gains()})"
            self.said.emit(
                f"The {self._broken.name} of axis {former.axis} of {former.who} was interrupted. Connect it: its "
                f"former {values} are offered first."
            )

    def _compare(self, controller: Controller, former: Former, future: Future[Any]) -> None:
        self._reading = None
        if controller is not self._connection.controller:
            return
        if failure_of(future):
            self._looked_at = None  # it is asked again
            return
        there = future.result()
        if there == dict(former.values):
            self._forget(controller, former)
            name = self._broken.name
            self.said.emit(f"Axis {former.axis} already has the values from before its interrupted {name}.")
            return
        self._put(controller, former, there)

    def _put(self, controller: Controller, former: Former, there: dict[str, int]) -> None:
        from device.former import number

        differ = [name for name, value in former.values.items() if there.get(name) != value]
        now = ", ".join(f"{name} {number(there[name])}" for name in differ if name in there)
        before = ", ".join(f"{name} {number(former.values[name])}" for name in differ)
        words = (
            f"The {self._broken.name} of axis {former.axis} that began on {former.when[:16].replace('T', ' at ')} did "
            f"not come to its end. The controller holds {now}. Before it: {before}. {self._broken.back}"
        )
        put = "Put the former values back" if controller.control else "Take Control and put them back"
        answers = [
            (put, lambda: self._put_back(controller, former)),
            ("Keep what the controller holds", lambda: self._keep(controller, former)),
        ]
        self._ask(self._broken.title, words, answers, "warning")

    def _put_back(self, controller: Controller, former: Former) -> None:
        from device.former import put_back

        if controller is not self._connection.controller:
            self.said.emit("Not put back: another controller is connected now.")
            return
        controller.take_control()

        def done(future: Future[Any]) -> None:
            failure = failure_of(future)
            if failure:
                again = [("Try again", lambda: self._put_back(controller, former))]
                self._ask("The former values are not back", failure, again, "problem")
                return
            self._forget(controller, former)
            self.said.emit(future.result())

        self._tick.when_done(put_back(controller, former, motor_off=self._broken.motor_off), done)

    def _keep(self, controller: Controller, former: Former) -> None:
        self._forget(controller, former)
        were = "other " + self._broken.values if self._broken.values else former.gains()
        self.said.emit(f"Axis {former.axis} keeps what the controller holds; before it had {were}.")

    def _forget(self, controller: Controller, former: Former) -> None:
        """All that was left of this axis; then the next one is asked about."""
        from device.former import forget, left_behind, meant

        for each in left_behind(self._folder):
            if each.axis == former.axis and meant(each, controller):
                forget(each)
        self.offer(controller)
