"""Tuning: what the panel asks for goes between guards to the controller; what was measured goes into the logbook."""

from __future__ import annotations

import math
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import replace
from datetime import datetime
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, Signal

from app.connection import Connection
from app.run import Ask, Run
from app.session import Session
from app.tick import Tick, failure_of
from app.tuner_book import Book
from app.tuner_feed import Feeding
from app.tuner_gains import IntoController
from app.tuner_memory import Memory
from app.tuner_model import Modelling
from codegen.fields import Dimension
from device.api import Kind, State
from widgets.display.readings import unit_of
from widgets.parts.units import shown
from widgets.tuner.asked import UNSURE, VELOCITY, Asked, Judged
from widgets.tuner.panel import AUTOMATIC, LOGBOOK, MODEL, TunerPanel

if TYPE_CHECKING:
    from codegen.setup import Setup
    from device.download import Job
    from device.tuning.bench import Excited, Found, Measured, Wish
    from device.tuning.feed import Sweep
    from device.tuning.loop import Gains
    from device.tuning.run import Present
    from widgets.tuner.plots import Curve

MOST_DRAWN = 4  # responses over each other
STEADY = 3.0  # counts


class Tuner(QObject):
    """One run at a time; everything it starts is inside `device.tuning.guards`."""

    said = Signal(str)

    def __init__(
        self,
        connection: Connection,
        session: Session,
        run: Run,
        tick: Tick,
        panel: TunerPanel,
        book: Book,
        memory: Memory,
        ask: Ask,
        careful: Callable[[str, Callable[[], object]], None],
        folder: Path,
        parent: QObject | None = None,
        now: Callable[[], datetime] = datetime.now,
    ) -> None:
        super().__init__(parent)
        self._connection, self._session, self._run, self._tick = connection, session, run, tick
        self._panel, self._ask, self._careful, self._now = panel, ask, careful, now
        self.folder, self._book, self._memory = folder, book, memory
        self.job: Job[Any] | None = None
        self._present: Present | None = None
        self._drawn: list[Curve] = []
        self._moved = False  # what is drawn are moves
        self._trials: list[tuple[Measured, str]] = []
        self._shown_trials = 0
        self._reading = self._fresh = False  # fresh: of another controller, its gains are not in the fields yet
        self._since = -math.inf  # what was read before this moment is from before a run
        self._hangs = 0.0  # counts, as it was last told; a count more or less makes no other sentence of it
        self.model = Modelling(tick, panel, self._excite, self._show_running, self._ended, memory, self)
        self.feeding = Feeding(panel, self.model, careful, self._moves, self._begin, self._keep, self._tops, self)
        panel.judge = self.judge
        panel.axis_chosen.connect(self._axis_chosen)
        panel.start_wanted.connect(self._start)
        panel.cancel_wanted.connect(self.cancel)
        self.into = IntoController(connection, tick, panel, ask, careful, self.read_present, self)
        panel.zero_wanted.connect(self._zero)
        panel.predicted_wanted.connect(self._run_predicted)
        panel.page_opened.connect(self._opened)
        connection.changed.connect(lambda _controller: self._another())
        self._joined = False

    # ---- what would happen

    def wish(self, asked: Asked) -> Wish:
        """The same as the controller's side takes it."""
        from device.tuning.bench import Wish

        return Wish(asked.axis, asked.step, asked.gains, asked.torque, asked.seconds)

    def judge(self, asked: Asked) -> Judged:
        """Where the axis will go, in its unit, and what ends it; or why it cannot."""
        wish = self.wish(asked)
        wrong = wish.problem or self._not_excited(asked)
        if wrong:
            return Judged("", f"{wrong[:1].upper()}{wrong[1:]}")
        setup = self._session.document.working_setup
        axis, guard = setup.axis(asked.axis), wish.guard.bearing(self._hangs)
        row, key = self._connection.controller.last(), f"commanded.{asked.axis.lower()}"
        place = row.value(key) if row.time(key) > self._since else math.nan
        low, high = place - guard.reverse, place + guard.forward
        if not (low <= high):
            return Judged("", f"Where axis {asked.axis} stands is not known yet.")
        reverse, forward = _soft(setup, asked.axis)
        if low < reverse or high > forward:
            return Judged("", f"That passes a limit of the setup: {self._between(low, high, asked.axis)}.")
        error = guard.error if self._present is None else min(guard.error, self._present.error)
        about = "about " if self._hangs else ""
        excites = self._panel.page == MODEL or (self._panel.page == AUTOMATIC and asked.drive == UNSURE)
        aside = f" (to be identified, by up to {shown(abs(asked.step) // 2, axis)} to either side)" if excites else ""
        return Judged(
            f"{asked.axis} moves by {shown(asked.step, axis)} {unit_of(axis)} and back{aside}, and stays between "
            f"{self._between(low, high, asked.axis)}; beyond {about}{error} counts of error its motor goes off."
        )

    def _not_excited(self, asked: Asked) -> str:
        """Why what this page begins with, an excitation, is refused; or nothing."""
        from device.tuning.excite import refused

        page, dual = self._panel.page, self._present is not None and self._present.dual
        if page == MODEL:
            return refused(asked.gains, dual)
        if page == AUTOMATIC and asked.drive == UNSURE and refused(asked.gains, dual):
            return f"Choose the drive mode; it cannot be found out here. {refused(asked.gains, dual)}"
        return ""

    def _between(self, low: float, high: float, letter: str) -> str:
        axis = self._session.document.working_setup.axis(letter)
        return f"{shown(low, axis)} and {shown(high, axis)} {unit_of(axis)}"

    # ---- runs

    def _start(self, page: int, asked: Asked) -> None:
        begin = {AUTOMATIC: self._automatic, MODEL: self.model.identify}.get(page, self._step)
        self._careful("Tune", partial(begin, asked))

    def cancel(self) -> None:
        """Ends the run at its next line; what it changed is put back."""
        if self.job is not None:
            self.job.cancel()
            self._panel.show_result("Cancelling…")

    def _step(self, asked: Asked) -> None:
        self._run_step(asked, "manual", self._measured)

    def _run_step(self, asked: Asked, method: str, then: Callable[[Measured, str], None]) -> None:
        from device.tuning.run import run_step

        job = run_step(self._connection.controller, self.wish(asked), self.folder, self._now())
        self._begin(job, f"Step of {asked.axis}", lambda measured: then(measured, method))

    def _automatic(self, asked: Asked) -> None:
        if asked.drive != UNSURE:
            self._search(asked, asked.drive == VELOCITY)
            return
        automatic = self._panel.automatic
        automatic.show_result("First the axis is asked by a small excitation what mode its drive is in.")

        def told(velocity: bool | None) -> None:
            if velocity is None:
                words = "The drive's mode could not be found out; choose it in the field Drive mode."
                automatic.show_result(words, good=False)
                self._panel.show_result(words, good=False)
                return
            self._search(asked, velocity)

        self.model.recognise(asked, told)

    def _search(self, asked: Asked, velocity: bool) -> None:
        from device.tuning.run import run_automatic

        self._trials, self._shown_trials = [], 0
        self._panel.automatic.clear()
        job = run_automatic(
            self._connection.controller, self.wish(asked), self.folder, self._now(),
            lambda measured, why: self._trials.append((measured, why)), velocity=velocity,
        )  # fmt: skip
        self._begin(job, f"Tuning {asked.axis}", self._found)

    def _found(self, found: Found) -> None:
        from device.tuning.entry import gains_words

        self._show_trials()
        best = next((each for each in reversed(found.trials) if each.gains == found.gains), None)
        if best is None and found.gains is not None:
            kept = [each for each in found.trials if _same(each.gains, found.gains)]
            best = kept[-1] if kept else None
        chosen = f"Recommended: {gains_words(found.gains)}. " if found.gains is not None else ""
        self._panel.automatic.show_result(f"{chosen}{found.words}", good=found.gains is not None)
        if found.gains is None:
            self._panel.show_result("No gains are recommended; the reason stands above.", good=False)
        else:
            self._panel.manual.gains.show_filter(found.gains)
            self._panel.show_result("Recommended gains are in the fields; the controller has its former ones.")
        if best is not None:
            self._keep(best, "automatic", found.words)

    def _excite(self, asked: Asked, then: Callable[[Excited], None]) -> None:
        from device.tuning.run import run_excitation

        job = run_excitation(self._connection.controller, self.wish(asked), self.folder, self._now())
        self._begin(job, f"Exciting {asked.axis}", then)

    def _moves(self, asked: Asked, way: Sweep, other: Gains) -> Job[Any]:
        from device.tuning.run import run_moves

        return run_moves(self._connection.controller, self.wish(asked), way, other, self.folder, self._now())

    def _run_predicted(self, asked: Asked) -> None:
        """The step with the proposed gains, measured and laid over its prediction."""
        proposal = self.model.proposal
        if proposal is not None and proposal.gains is not None:
            there = self._present.gains.torque_limit if self._present is not None else asked.torque
            wanted = replace(asked, gains=proposal.gains, torque=min(asked.torque, there))
            step = partial(self._run_step, wanted, "model", self._measured)
            self._careful("Tune", partial(self.model.foresee, wanted, step))

    def _tops(self, letter: str) -> tuple[int, int]:
        """The highest SP and AC that the setup allows an axis."""
        setup = self._session.document.working_setup
        speed, rise = (
            setup.counts(each, letter, setup.bounds(each, letter)[1])
            for each in (Dimension.SPEED, Dimension.ACCELERATION)
        )
        return speed, rise

    # ---- what came of it

    def _measured(self, measured: Measured, method: str) -> None:
        self._keep(measured, method, measured.words)
        self._panel.show_result(measured.words, good=not measured.vibrates)

    def _keep(self, measured: Measured, method: str, words: str) -> None:
        """Drawn, and a line of the logbook."""
        from device.tuning.entry import Entry, gains_words
        from widgets.tuner.plots import Curve

        self._book.last = measured
        if (method == "move") != self._moved:  # a step dwarfs the error of a move
            self._drawn.clear()
            self._moved = method == "move"
        curve = Curve(measured.response, gains_words(measured.gains))
        before = self.model.predicted if method == "model" else tuple(self._drawn[-MOST_DRAWN + 1 :])
        self._drawn = [*self._drawn, Curve(measured.response, gains_words(measured.gains), quiet=True)][-MOST_DRAWN:]
        self._panel.show_curves((*before, curve), measured.metrics, measured.gains.torque_limit)
        entry = Entry(
            0, self._now().isoformat(timespec="seconds"), measured.axis, method, measured.gains, measured.step,
            measured.response, measured.metrics, words, self.model.data() if method == "model" else {},
            controller=self._connection.controller.who,
        )  # fmt: skip
        self._book.add(entry)

    def _zero(self) -> None:
        """The graph is empty; the next step is drawn from 0."""
        self._drawn.clear()
        self._panel.show_curves([], None, 10.0)

    # ---- around a run

    def _begin(self, job: Job[Any], words: str, then: Callable[[Any], None]) -> None:
        self.job = self._run.job = job
        self._run.doing = words
        self._show_running(f"{words}…")

        def done(future: Future[Any]) -> None:
            self._ended()
            failure = failure_of(future)
            self._show_trials()
            if failure:
                self._panel.show_result(failure, good=False)
            else:
                then(future.result())
            self.read_present()

        self._tick.when_done(job.future, done)

    def _show_running(self, words: str) -> None:
        self._panel.show_running(words)
        self._panel.show_result(words)

    def _ended(self) -> None:
        self._since = self._connection.controller.clock()
        if self._run.job is self.job:
            self._run.job, self._run.doing = None, ""
        self.job = None
        self._panel.show_running("")

    def look(self) -> None:
        """With each tick: how far it is, and the trials that have come."""
        self._show_trials()
        self.model.look()
        job = self.job
        if job is not None and not job.future.done() and job.phase not in ("waiting", "") and not job.cancelled:
            share = f", {100 * job.fraction:.0f} %" if job.total else ""
            self._panel.show_result(f"{self._panel.running.rstrip('…')}: {job.phase}{share}…")
        state = self._connection.controller.state
        unread = self._joined and self._present is None and not self._reading
        if unread and self._panel.isVisible() and state is State.READY:
            self.read_present(into_fields=self._fresh)

    def _show_trials(self) -> None:
        if self._shown_trials == len(self._trials):  # most ticks; what is imported below takes long to load
            return
        from device.tuning.entry import gains_words
        from widgets.tuner.plots import Curve

        while self._shown_trials < len(self._trials):
            measured, why = self._trials[self._shown_trials]
            before = self._trials[self._shown_trials - 1][0] if self._shown_trials else None
            self._shown_trials += 1
            self._panel.automatic.add_trial(why, measured.gains, measured.words)
            curves = [Curve(before.response, "Before", quiet=True)] if before is not None else []
            curves.append(Curve(measured.response, gains_words(measured.gains)))
            self._panel.show_curves(curves, measured.metrics, measured.gains.torque_limit)

    def _axis_chosen(self, axis: str) -> None:
        self._join_pages()
        self._forget()
        self.read_present(into_fields=True)

    def _forget(self) -> None:
        """What is shown belongs to another axis."""
        self._hangs = 0.0
        self._drawn.clear()
        self.model.forget()
        if self._joined:
            self._panel.automatic.clear()
            self._panel.show_curves([], None, 10.0)

    def _opened(self, page: int) -> None:
        """A page, for the first time or again: DV may be another one by now."""
        self._join_pages()
        if page == LOGBOOK:
            self._panel.logbook.tell()
        self.read_present()

    def _join_pages(self) -> None:
        """The panel's pages are made when it is first shown."""
        if self._joined:
            return
        self._joined = True
        self._panel.manual.present.clicked.connect(lambda: self.read_present(into_fields=True))
        self._book.join()
        self._memory.join()

    def _another(self) -> None:
        """Another controller: what was known belongs to the one before."""
        self._since = -math.inf
        self._forget()
        self._present, self._fresh = None, True
        if self._joined:
            self._panel.show_present(None)
            self._book.refresh()

    def read_present(self, into_fields: bool = False) -> None:
        """The gains that the controller holds now, beside the fields."""
        from device.tuning.run import read_present

        controller, axis = self._connection.controller, self._panel.axis
        if controller.kind is Kind.OFFLINE or controller.state is not State.READY or self.job is not None:
            return
        self._reading = True
        typed = self._panel.manual.gains.texts if into_fields else ()

        def done(future: Future[Any]) -> None:
            self._reading = False
            if failure_of(future) or controller is not self._connection.controller or axis != self._panel.axis:
                return
            self._present, self._fresh = future.result(), False
            if abs(future.result().hangs - self._hangs) > STEADY + self._hangs / 10:
                self._hangs = float(round(future.result().hangs))
            self._panel.show_present(future.result().gains, future.result().dual)
            if into_fields and typed == self._panel.manual.gains.texts:  # nobody has typed meanwhile
                self._panel.manual.gains.show_gains(future.result().gains)

        self._tick.when_done(read_present(controller, axis), done)


def _same(one: Gains, other: Gains) -> bool:
    return (one.kp, one.ki, one.kd) == (other.kp, other.ki, other.kd)


def _soft(setup: Setup, letter: str) -> tuple[float, float]:
    """The soft limits of the setup in counts; one that is missing limits nothing."""
    from codegen.numbers import parse_number

    axis = setup.axis(letter)
    low, high = parse_number(axis.reverse_limit), parse_number(axis.forward_limit)
    return (
        -math.inf if low is None else setup.counts(Dimension.POSITION, letter, low),
        math.inf if high is None else setup.counts(Dimension.POSITION, letter, high),
    )
