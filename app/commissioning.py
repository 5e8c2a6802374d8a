"""Bringing an axis to life: the window with what stands around it: record, live values, report."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Callable
from concurrent.futures import Future
from datetime import datetime
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, Signal

from app import facts as need
from app.asked import AskedOfMachine
from app.commissioning_orders import Orders
from app.connection import Connection
from app.facts import Facts
from app.late import COMMISSIONING
from app.run import Ask
from app.session import Session
from app.tick import Tick, failure_of
from device.api import Controller, Job, Kind
from device.commissioning.judge_stepper import refused
from device.commissioning.record import Finding, Record, Verdict, keep, resumed
from device.commissioning.seen import Switches, Turned
from device.commissioning.steps import Step, steps_for
from device.tasks import Priority, Steps

if TYPE_CHECKING:
    from PySide6.QtWidgets import QWidget

    from codegen.setup import Axis
    from device.commissioning.judge import Moved
    from widgets.commissioning.window import CommissioningWindow
    from widgets.program.printing import PrintPreview

OWNER = "commissioning"
LIVE = ("position", "error", "torque", "motor_off", "forward_limit", "reverse_limit", "home")
PLACES = ("position.", "commanded.", "auxiliary.")  # read together, so that they fit each other
PAUSE_TICKS = 30  # a second without typing
NOT_CONNECTED = "Connect a controller or start the simulator first."


class Commissioning(QObject):
    """Owns the window; `look` is called with each tick."""

    said = Signal(str)
    help_wanted = Signal(str)
    broken = Signal()  # a step failed: something may be left to put back

    def __init__(
        self,
        connection: Connection,
        session: Session,
        tick: Tick,
        ask: Ask,
        facts: Callable[[], Facts],
        data: Path,
        parent: QWidget,
        now: Callable[[], datetime] = datetime.now,
    ) -> None:
        super().__init__(parent)
        self._connection, self._session, self._tick = connection, session, tick
        self.ask = AskedOfMachine(connection, ask, self.said.emit)
        self._facts, self._parent, self.now = facts, parent, now
        self.folder = data / COMMISSIONING
        self.window: CommissioningWindow | None = None
        self.preview: PrintPreview | None = None
        self.record = Record("X", "")
        self.row = 0
        self.job: Job[Any] | None = None
        self.busy = ""
        self.note = ""  # a field that has to be put right
        self.turned: Turned | None = None
        self.switches: Switches | None = None
        self.moved: Moved | None = None
        self.measured: Fraction | None = None  # counts in a unit
        self.still = 0  # counts: with so large an error limit the axis was seen to stand still
        self._begun = 0.0
        self._to_keep = 0  # ticks until what was typed is written
        self._looking = False
        self._seen: Controller | None = None
        self._watched: tuple[str, ...] = ()
        self._orders = Orders(self)

    # ---- what it works with

    @property
    def controller(self) -> Controller:
        return self._connection.controller

    @property
    def axis(self) -> Axis:
        """The axis in the setup of the open program."""
        return self._session.document.working_setup.axis(self.record.axis)

    @property
    def session(self) -> Session:
        return self._session

    @property
    def steps(self) -> tuple[Step, ...]:
        return steps_for(self.axis.is_stepper, self.record.sine)

    @property
    def step(self) -> Step:
        steps = self.steps
        return steps[min(self.row, len(steps) - 1)]

    @property
    def reason(self) -> str:
        """Why nothing may be sent now."""
        facts = self._facts()
        return need.control(facts) or need.quiet(facts)

    # ---- the window

    def show(self) -> None:
        """The list, at the step where it was left."""
        from widgets.commissioning.window import CommissioningWindow

        if self.window is None:
            self.window = window = CommissioningWindow(self._parent)
            window.axis_chosen.connect(self.choose_axis)
            window.sine_chosen.connect(self._choose_sine)
            window.step_chosen.connect(self.choose)
            window.typed.connect(self._typed)
            window.ticked.connect(lambda name, on: self._typed(name, "yes" if on else ""))
            window.pressed.connect(self._orders.carry_out)
            window.skip_wanted.connect(self._skip)
            window.again_wanted.connect(self._ask_again)
            window.report_wanted.connect(self.show_report)
            window.help_wanted.connect(self.help_wanted)
            window.stop.stop.connect(self._connection.stop)
            window.left.connect(self._leave)
        self._meet()
        self._show()
        self.window.show()
        self.window.raise_()
        self.window.activateWindow()

    def choose_axis(self, letter: str) -> None:
        """Another axis of this controller, where it was left; not while something is under way."""
        if self.busy:
            self._show()
            return
        if self._to_keep:
            self.keep(self.record)
        controller = self.controller
        model = controller.model.name if controller.model is not None else self._session.document.setup.model
        identity = controller.identity
        serial = (identity.serial or 0) if identity is not None else 0
        self.record = resumed(self.folder, letter, model, serial)
        self.row = self.record.at(self.steps)
        self._forget()
        self._show()

    def choose(self, row: int) -> None:
        """Another step."""
        if 0 <= row < len(self.steps) and row != self.row and not self.busy:
            self.row = row
            self._forget()
        self._show()

    @property
    def place(self) -> str:
        """The live value that tells where the axis is: a stepper is where it was commanded to be."""
        return "commanded" if self.axis.is_stepper else "position"

    @property
    def live(self) -> tuple[str, ...]:
        """The values of this axis that are read."""
        return (*LIVE, "commanded", "auxiliary") if self.axis.is_stepper else LIVE

    def look(self) -> None:
        """With each tick: live values, what a press allows."""
        window = self.window
        if window is None or not window.isVisible():
            self._watch(())
            return
        if self.controller is not self._seen:
            self._meet()
        self._watch(tuple(f"{name}.{self.record.axis.lower()}" for name in self.live) if self.controller.model else ())
        self._read()
        if self._to_keep == 1:
            self.keep(self.record)
        self._to_keep = max(self._to_keep - 1, 0)
        self._show()

    # ---- what came of something

    def found(self, finding: Finding, key: str = "") -> None:
        """A verdict: kept at once."""
        dated = dc.replace(finding, when=f"{self.now():%Y-%m-%d %H:%M}")
        self.keep(self.record.found(key or self.step.key, dated))

    def keep(self, record: Record) -> None:
        """The record as it is now, on disk too."""
        self.record, self._to_keep = record, 0
        if complaint := keep(record, self.folder):
            self.said.emit(complaint)
        self._show()

    def text(self, name: str, usual: str = "") -> str:
        """What was typed on the present page."""
        return self.record.text(self.step.key, name, usual)

    def run(self, words: str, steps: Steps[Any], done: Callable[[Any], None], job: Job[Any] | None = None) -> None:
        """Orders for the link; a failure is the finding of the step, which stays open."""
        controller, key = self.controller, self.step.key
        self.busy, self.job = words, job
        future = controller.run(steps, Priority.USER, "user")

        def ended(future: Future[Any]) -> None:
            self.busy, self.job = "", None
            if failure := failure_of(future):
                self.broken.emit()
                self.found(refused(failure), key)
            elif controller is self.controller:
                done(future.result())
            self._show()

        self._tick.when_done(future, ended)
        self._show()

    # ---- inside

    def _meet(self) -> None:
        """The controller that is connected now, or none."""
        self._seen = self.controller
        axes = self.controller.axes or self._session.document.setup.letters
        self.choose_axis(self.record.axis if self.record.axis in axes else axes[0])

    def _forget(self) -> None:
        """What was seen belongs to one visit of one step."""
        self.turned = self.switches = self.moved = self.measured = None
        self.note, self.still = "", 0
        self._begun = 0.0

    def _watch(self, keys: tuple[str, ...]) -> None:
        if keys != self._watched:
            self._watched = keys
            self.controller.watch(OWNER, keys, tuple(key for key in keys if key.startswith(PLACES)))

    def _read(self) -> None:
        """What came since the last look, while something is moved by hand."""
        if self.turned is not None and (counts := self._fresh("position")) is not None:
            self.turned = self.turned.with_reading(int(counts))
        if self.switches is not None and not self._looking and not self.busy:
            from device.commissioning.settings import look_at_switches

            self._looking = True
            future = self.controller.run(look_at_switches(self.controller, self.record.axis), Priority.POLL, "poll")
            self._tick.when_done(future, self._looked)

    def _looked(self, future: Future[Any]) -> None:
        self._looking = False
        levels = None if failure_of(future) else future.result()
        if self.switches is not None and levels is not None:
            self.switches = self.switches.with_levels(levels)
            self._orders.judge_switches()

    def _fresh(self, name: str) -> float | None:
        """A value that was read after `begin`; None where there is none yet."""
        key, row = f"{name}.{self.record.axis.lower()}", self.controller.last()
        if not row.has(key) or row.time(key) <= self._begun:
            return None
        return row.value(key)

    def begin(self) -> None:
        """From now on readings count."""
        self._begun = self.controller.clock()

    def _typed(self, name: str, text: str) -> None:
        """Kept on disk once the person pauses: a disk may be slow."""
        self.note = ""
        self.record = self.record.with_text(self.step.key, name, text)
        self._to_keep = PAUSE_TICKS
        self._show()

    def _choose_sine(self, on: bool) -> None:
        if not self.busy:
            key = self.step.key
            self.keep(dc.replace(self.record, sine=on))
            keys = [step.key for step in self.steps]
            self.row = keys.index(key) if key in keys else self.record.at(self.steps)
        self._show()

    def _skip(self) -> None:
        if self.step.optional:
            self.found(Finding(Verdict.SKIPPED, "Skipped: it was not looked at."))
            self.choose(self.row + 1)

    def _ask_again(self) -> None:
        words = f"What was found of axis {self.record.axis} is thrown away. Nothing changes in the controller."
        self.ask("Start again with this axis?", words, [("Start again", self._again)], "warning")

    def _again(self) -> None:
        self.keep(dc.replace(self.record, findings={}, typed={}))
        self.row = 0
        self._forget()
        self._show()

    def _cancel(self) -> None:
        if self.job is not None:
            self.job.cancel()

    def _leave(self) -> None:
        """The window was closed: what is under way ends, and everything is put back."""
        self._cancel()
        self._forget()
        if self._to_keep:
            self.keep(self.record)

    def _show(self) -> None:
        from app.commissioning_pages import Now, page_of
        from widgets.commissioning.page import Entry

        window, controller = self.window, self.controller
        if window is None:
            return
        model, row = controller.model, controller.last()
        sine = self.record.sine if model is not None and model.name == "dmc1412" and not self.axis.is_stepper else None
        who = controller.who if controller.kind is not Kind.OFFLINE else NOT_CONNECTED
        axes = controller.axes or self._session.document.setup.letters
        window.show_machine(axes, self.record.axis, f"{who[:1].upper()}{who[1:]}", sine)
        found = [(step, self.record.of(step.key)) for step in self.steps]
        entries = [Entry(step.title, finding.verdict.value, finding.sentence) for step, finding in found]
        may_skip = self.step.optional and not self.busy and not self.record.of(self.step.key).done
        window.show_steps(entries, self.row, may_skip, bool(self.record.findings))
        live = {name: row.value(f"{name}.{self.record.axis.lower()}") for name in self.live}
        now = Now(
            self.record, self.axis, live, self.reason, self.busy, self.turned, self.switches, self.moved,
            self.measured is not None and self.measured != self.axis.scale,
        )  # fmt: skip
        page = page_of(self.step, self.steps, now)
        window.show_page(dc.replace(page, mark="open", sentence=self.note, advice=(), facts=()) if self.note else page)
        window.show_stop(controller.kind, controller.stop_state)

    # ---- report

    def show_report(self) -> None:
        """What was found of this axis as pages: preview, PDF, print."""
        from widgets.commissioning.report import Line, report_pages
        from widgets.program.printing import PrintPreview

        record, document = self.record, self._session.document
        title = f"Commissioning of axis {record.axis}{f', {document.setup.name}' if document.setup.name else ''}"
        about = (
            ("Controller", self.controller.who if self.controller.kind is not Kind.OFFLINE else record.model),
            ("Axis", f"{record.axis}, {self.axis.counts_per_unit or '?'} counts in 1 {self.axis.symbol}"),
            ("Printed", f"{self.now():%Y-%m-%d %H:%M}"),
        )
        lines = [
            Line(step.title, each.verdict.value, each.sentence, each.facts, each.advice, each.when, step.manual)
            for step in self.steps
            for each in (record.of(step.key),)
        ]
        pages = report_pages(document, title, about, lines)
        self.preview = PrintPreview("Report", pages, f"commissioning axis {record.axis}", self.window)
        self.preview.setProperty("helpPage", "Bring an axis to life")
        self.preview.said.connect(self.said)
        self.preview.show()
