"""Moving by hand: what the jog panel asks for goes to the controller, what came of it goes back."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import Future
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject

from app.asked import AskedOfMachine
from app.connection import Connection
from app.points import Points, file_name
from app.run import Ask
from app.session import Session
from app.settings import Settings
from app.tick import Tick, failure_of
from device.jog import told, zero
from device.moving import NeedsConfirmation
from widgets.display.readings import unit_of
from widgets.jog.ends import places_of
from widgets.jog.panel import JogPanel
from widgets.parts.units import shown

if TYPE_CHECKING:
    from codegen.document import Document
    from device.going import Ended
    from device.jog import Places, Plan
    from device.lease import Ran
    from device.steer import Drove
    from widgets.jog.drive import Drive

PANEL = "panel"
SPEEDS = "jog_speeds"  # the setting


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
        settings: Settings,
        points: Points,
        parent: QObject | None = None,
    ) -> None:
        super().__init__(parent)
        self._settings, self._points = settings, points
        self._driven: Future[Any] | None = None
        self._going: dict[str, int] = {}  # where a planned move on its way ends, counts
        self._connection, self._session, self._tick = connection, session, tick
        self._panel, self._homed = panel, homed
        self._ask = AskedOfMachine(connection, ask, lambda why: panel.show_result(why, good=False))
        panel.hold_wanted.connect(self._hold)
        panel.run_wanted.connect(self._run)
        panel.drive_wanted.connect(self._drive)
        panel.steered.connect(self._steer)
        panel.renewed.connect(lambda owner: self._motion.renew(owner))
        panel.released.connect(lambda owner: self._motion.release(owner or None))
        panel.latch_wanted.connect(lambda on: self._motion.set_latch(on))
        panel.plan_wanted.connect(self.go)
        panel.zero_wanted.connect(self._zero)
        panel.speed_kept.connect(self._keep_speed)
        panel.show_speeds(self._speeds())
        panel.point_wanted.connect(self._go_to_point)
        panel.point_saved.connect(self._save_point)
        panel.point_renamed.connect(lambda before, name: self._points_changed(self._points.rename(before, name)))
        panel.point_deleted.connect(self._delete_point)
        session.document_changed.connect(self._document_changed)
        self._open_points()

    def ghost(self) -> Mapping[str, int]:
        """Where axes will stop: held, on their way, or looked at; counts."""
        motion = self._motion
        return motion.ghost or (self._going if motion.busy else {}) or self._panel.preview

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

    def _drive(self, drive: Drive, owner: str) -> None:
        self._panel.show_result("")
        future: Future[Any] = self._motion.drive(drive.speeds, drive.ramps, drive.ramps, owner=owner)
        self._driven = future

        def done(future: Future[Any]) -> None:
            if future is self._driven:  # it ended by itself: the stick has to go through its middle first
                self._panel.holder.let_go(owner)
            failure = failure_of(future)
            self._panel.show_result(failure or self._drove(future.result()), good=not failure)

        self._tick.when_done(future, done)

    def _steer(self, drive: Drive, owner: str) -> None:
        if problem := self._motion.steer(owner, drive.speeds):
            self._panel.holder.let_go(owner)
            self._panel.show_result(problem, good=False)

    def go(self, plan: Plan, confirmed: bool = False) -> None:
        """A planned move; asked about first where it passes a limit or the axis is not homed."""
        self._panel.show_result(f"{plan.title}…")
        future: Future[Ended] = self._motion.go(plan, owner=PANEL, homed=self._homed(), confirmed=confirmed)
        self._going = plan.ghost(self._places(plan.axes))

        def done(future: Future[Any]) -> None:
            self._going = {}
            error = None if future.cancelled() else future.exception()
            if isinstance(error, NeedsConfirmation):
                self._panel.show_result("")
                answers = [("Move anyway", lambda: self.go(plan, confirmed=True))]
                self._ask("Move anyway?", str(error), answers, "warning")
            elif failure := failure_of(future):
                self._panel.show_result(failure, good=False)
            else:
                self._panel.show_result(self._ended(future.result()))

        self._tick.when_done(future, done)

    def _go_to_point(self, plan: Plan) -> None:
        """Says what will move and where, and goes after a yes."""
        setup, places = self._session.document.working_setup, self._places(plan.axes)
        ways = [
            f"Axis {letter}: from {told(places.commanded[letter], letter, setup)} to {told(end, letter, setup)}."
            if letter in places.commanded
            else f"Axis {letter}: to {told(end, letter, setup)}."
            for letter, end in plan.ends.items()
        ]
        unknown = [letter for letter in plan.axes if letter not in set(self._homed())]
        doubts = [f"Axis {letter} was not seen homed: that place may be anywhere." for letter in unknown]
        if passes := plan.passes(places, setup):
            doubts.append(passes)
        words = "\n".join([*ways, *doubts, "Each axis goes straight at its own speed; they do not arrive together."])
        answers = [("Go there", lambda: self.go(plan, confirmed=bool(doubts)))]
        self._ask(f"{plan.title}?", words, answers, "warning" if doubts else "help")

    def _places(self, letters: str) -> Places:
        """Where the axes are commanded to be as far as that is fresh, between the limits of the setup."""
        controller = self._connection.controller
        return places_of(controller.last(), letters, self._session.document.working_setup, controller.clock())

    def _save_point(self, name: str) -> None:
        controller = self._connection.controller
        row, setup = controller.last(), self._session.document.working_setup
        keys = {letter: f"position.{letter.lower()}" for letter in controller.axes or setup.letters}
        old = [letter for letter, key in keys.items() if row.stale(key, controller.clock())]
        if old:
            self._panel.show_result(f"Not saved: the place of axis {old[0]} is not read at the moment.", good=False)
            return
        counts = {letter: round(row.value(key)) for letter, key in keys.items()}
        self._points_changed(self._points.save_here(name, counts, setup))

    def _delete_point(self, name: str) -> None:
        words = f"The point “{name}” is forgotten. Nothing moves."
        delete = [("Delete it", lambda: self._points_changed(self._points.delete(name)))]
        self._ask(f"Delete “{name}”?", words, delete, "warning")

    def _points_changed(self, problem: str) -> None:
        self._panel.show_result(problem, good=not problem)
        self._panel.show_points(self._points.points)

    def _open_points(self) -> None:
        self._points_changed(self._points.open(self._session.document.setup))

    def _document_changed(self, old: Document | None, new: Document) -> None:
        if old is None or file_name(old.setup) != file_name(new.setup):
            self._open_points()

    def _keep_speed(self, axis: str, name: str, speed: str) -> None:
        kept = self._speeds()
        kept[axis] = {**kept.get(axis, {}), name: speed}
        self._settings.set(SPEEDS, kept)
        self._panel.show_speeds(kept)

    def _speeds(self) -> dict[str, dict[str, str]]:
        """Of the settings file, as far as it is what this program wrote."""
        found = self._settings.get(SPEEDS)
        tables = {axis: kept for axis, kept in found.items() if isinstance(kept, dict)}
        return {axis: {k: v for k, v in kept.items() if isinstance(v, str)} for axis, kept in tables.items()}

    def _zero(self, axis: str) -> None:
        words = (
            f"The place where axis {axis} stands now becomes 0. Programs and limits count from there. Nothing moves."
        )
        self._ask(f"Set axis {axis} to zero here?", words, [("Set to zero", lambda: self.go(zero(axis)))], "warning")

    def _ended(self, ended: Ended) -> str:
        at = ", ".join(self._at(letter, counts) for letter, counts in ended.places.items())
        return f"{ended.sentence} {at}" if at else ended.sentence

    def _ran(self, ran: Ran) -> str:
        axis = self._session.document.working_setup.axis(ran.axis)
        ran_on = f"{shown(ran.run_on, axis)} {unit_of(axis)}"
        return f"{ran.sentence} {self._at(ran.axis, ran.place)}; ran on {ran_on} in {ran.seconds * 1000:.0f} ms."

    def _drove(self, drove: Drove) -> str:
        setup = self._session.document.working_setup
        ran_on = ", ".join(
            f"{letter} {shown(counts, setup.axis(letter))} {unit_of(setup.axis(letter))}"
            for letter, counts in drove.run_on.items()
        )
        places = ", ".join(self._at(letter, counts) for letter, counts in drove.places.items())
        sentence = drove.sentence or "Stopped."
        return f"{sentence} {places}; ran on {ran_on} in {drove.seconds * 1000:.0f} ms."

    def _at(self, letter: str, counts: int) -> str:
        axis = self._session.document.working_setup.axis(letter)
        return f"{letter} at {shown(counts, axis)} {unit_of(axis)}"

    def _expect(self, future: Future[Any], words: Callable[[Any], str]) -> None:
        def done(future: Future[Any]) -> None:
            failure = failure_of(future)
            self._panel.show_result(failure or words(future.result()), good=not failure)

        self._tick.when_done(future, done)
