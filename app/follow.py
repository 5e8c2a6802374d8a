"""With every tick: what is possible, what is connected, what the program does, as the window shows it."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject

from app.actions import Actions
from app.connection import Connection
from app.facts import Facts
from app.homed import Homed, is_stepper
from app.run import Run
from app.session import Session
from app.tick import Tick, failure_of
from app.window import Window
from codegen.generate import Listing, generate
from codegen.read import sentence
from codegen.twoletter.problems import ERROR_TEXTS
from device.api import Badge, Kind, NoticeKind, Row, State, StopState
from device.download import program_lines
from widgets.display.display import DisplayPanel
from widgets.display.readings import age_of, fresh, rate_words, unit_of
from widgets.display.threads import thread_words
from widgets.panel import Panel
from widgets.parts.units import shown
from widgets.program.view import ProgramView
from widgets.terminal.answers import asked_in

if TYPE_CHECKING:
    from codegen.document import Document
    from device.api import Controller, Notice

FAULT = re.compile(r"\?\s*(\d{3}) (.*)")
OWNER = "status bar"


class Follow(QObject):
    """Reads, never asks the person anything; `look` is called with each tick."""

    def __init__(
        self,
        connection: Connection,
        session: Session,
        run: Run,
        actions: Actions,
        window: Window,
        parent: QObject | None = None,
    ) -> None:
        super().__init__(parent)
        self._connection, self._session, self._run = connection, session, run
        self._actions, self._window = actions, window
        self._watched: object = None
        self._stop = StopState.NO_LINK
        self._lost = False
        self.known = Facts()  # as of the last look

    def look(self) -> None:
        """Brings everything up to date; nothing is touched that has not changed."""
        controller = self._connection.controller
        self.known = self.facts()
        self._actions.show_facts(self.known)
        self._window.show_stop(controller.kind, controller.stop_state, controller.control)
        self._window.show_title(self._session.title, controller.kind)
        self._show_question()
        online = controller.kind is not Kind.OFFLINE
        self._window.run_bar.show_held(self._run.held() if online else None)
        self._window.status.progress.show_job(self._run.doing, self._run.job)
        self._watch()
        self._say_lost()
        self._status(controller.last())

    def _say_lost(self) -> None:
        """What was said last is not so any more on a line that is lost."""
        controller, before = self._connection.controller, self._lost
        self._lost = controller.state is State.LOST
        if self._lost and not before:
            self._window.status.say(controller.state_text)

    def _show_question(self) -> None:
        """What the program asks; what was asked when STOP was pressed is not answered any more."""
        controller, box = self._connection.controller, self._window.prompt
        prompt, listing = controller.pending_prompt, controller.waiting.listing
        source = listing.text.splitlines() if prompt is not None and listing is not None else []
        box.show_prompt(prompt, asked_in(source, prompt.lines, prompt.text) if prompt is not None else None)
        before, self._stop = self._stop, controller.stop_state
        not_confirmed = self._stop is StopState.NOT_CONFIRMED and before is not self._stop
        if self._stop is StopState.STOPPING or not_confirmed:
            box.withdraw()

    def facts(self) -> Facts:
        """What is the case right now."""
        controller = self._connection.controller
        program = self._session.document.program
        steps = len(program.configuration) + len(program.main) + len(program.routines)
        return Facts(
            kind=controller.kind,
            state=controller.state,
            control=controller.control,
            prompt=controller.pending_prompt is not None,
            busy=self._run.doing,
            badge=controller.program_badge,
            steps=steps,
            dirty=self._session.dirty,
        )

    def _watch(self) -> None:
        """What the status bar and the executing line need, whatever is visible."""
        controller = self._connection.controller
        wanted = (controller, controller.axes, controller.state, self._session.document.setup)
        if wanted == self._watched:
            return
        self._watched = wanted
        if controller.kind is not Kind.OFFLINE and controller.state is State.READY:
            threads = controller.model.threads if controller.model is not None else 1
            first = controller.axes[:1].lower()
            keys = [f"thread{number}" for number in range(threads)]
            for letter in controller.axes.lower():  # leaving asks for the first, the other tells what is homed
                keys += [f"moving.{letter}", f"stop_code.{letter}"]
            setup = self._session.document.setup
            keys += [f"motor_off.{letter.lower()}" for letter in controller.axes if is_stepper(setup.axis(letter))]
            controller.watch(OWNER, [*keys, *([f"position.{first}"] if first else [])])

    def _status(self, row: Row) -> None:
        controller, status = self._connection.controller, self._window.status
        status.show_link(controller.kind, self._link_words())
        if controller.kind is Kind.OFFLINE or controller.state is not State.READY:
            status.show_program("")
            status.show_position("")
            return
        now = controller.clock()
        source = (controller.listing or "").splitlines()
        status.show_program(thread_words(0, fresh(row, "thread0", now), source))
        letter = controller.axes[:1]
        if letter:
            axis = self._session.document.setup.axis(letter)
            key = f"position.{letter.lower()}"
            age = age_of(row, key, now)
            status.show_position(
                f"{letter} {shown(row.value(key), axis)} {unit_of(axis)}" + (f" ({age})" if age else "")
            )

    def _link_words(self) -> str:
        controller = self._connection.controller
        if controller.kind is Kind.OFFLINE:
            return "nothing connected"
        if controller.state is not State.READY:
            return controller.state_text
        said = controller.identity.text if controller.identity is not None else ""
        name = controller.model.name.upper() if controller.model is not None else said or "controller"
        baud = f" · {controller.line.baud:,} baud".replace(",", " ") if controller.line.baud else ""
        reads = rate_words(controller.rate_hz) if controller.polling else controller.polling_text
        return f"{name}{baud} · {reads}"


class Program(Panel):
    """Not shown anywhere: hears faults and rows for the program window (executing line, error on its instruction)."""

    title = "Program"

    def __init__(self, view: ProgramView, display: DisplayPanel, tick: Tick, say: Callable[[str], None]) -> None:
        super().__init__()
        self._view, self._display, self._tick, self._say = view, display, tick, say
        self._executing: dict[int, int | None] = {}
        self._told: tuple[object, ...] = ()
        self._kept: tuple[int, ...] = ()  # the rows of our listing by line of the controller; none: it is not ours
        self._document: Document | None = None
        self.homed = Homed()
        display.homed_told.connect(self.homed.confirm)

    def take(self, controller: Controller) -> None:
        super().take(controller)
        self.homed.begin(controller)

    def show_document(self, old: Document | None, new: Document) -> None:
        self._document = new

    def homed_axes(self) -> list[str]:
        """The axes that are known to be homed."""
        return [letter for letter, mark in self.homed.marks.items() if mark.homed]

    def look(self) -> None:
        """The lines the threads are on, from the newest row."""
        controller = self.controller
        if controller is None:
            return
        self._tell_source(controller)
        row = controller.last()
        if self._document is not None:
            self.homed.look(controller, row, self._document.setup)
            self._display.show_homed({letter: (each.words, each.help) for letter, each in self.homed.marks.items()})
        threads = controller.model.threads if controller.model is not None else 1
        now = controller.clock()
        lines = (
            {number: self._row(fresh(row, f"thread{number}", now)) for number in range(threads)} if self._kept else {}
        )
        if lines != self._executing:
            self._executing = lines
            self._view.show_executing(lines)

    def _tell_source(self, controller: Controller) -> None:
        """The lines of the controller's program; with the instructions they come from when it is the open one."""
        ours = controller.program_badge is Badge.SAME
        told = (controller.listing, self._view.running, self._document if ours else None)
        if told == self._told:
            return
        lines = program_lines(controller.listing or "")
        own = generate(self._document) if ours and self._document is not None else None
        fits = [each for each in (self._view.running, own) if each is not None and program_lines(each.text) == lines]
        self._kept = kept_lines(fits[0]) if fits and controller.listing is not None else ()
        if fits:
            self._view.running = fits[0]
        self._told = (told[0], self._view.running, told[2])
        found = sentences_of(self._document, self._kept) if own is not None and self._document is not None else {}
        self._display.show_source(lines, found)

    def _row(self, line: float) -> int | None:
        """The line of our listing that a line of the controller is."""
        at = int(line) if math.isfinite(line) else -1
        return self._kept[at] if 0 <= at < len(self._kept) else None

    def reveal(self, line: int) -> None:
        """The instruction that a line of the controller's program comes from."""
        row = self._row(line)
        if row is None:
            self._say(f"Line {line} is of another program than the open one.")
        else:
            self._view.reveal_line(row)

    def notice(self, notice: Notice) -> None:
        if self.controller is not None:
            self.homed.happened(notice.kind, self.controller.clock())
        found = FAULT.fullmatch(notice.text) if notice.kind is NoticeKind.FAULT else None
        if found is None or self.controller is None:
            return
        line, source = int(found[1]), found[2]

        def done(future: Future[Any]) -> None:
            code = 0 if failure_of(future) else int(future.result()[0])
            reason = ERROR_TEXTS.get(code, "the controller stopped here")
            row = self._row(line)
            if row is not None:
                self._view.show_error(row, f"{reason} ({source})")
            self._say(f"The program stopped at line {line}: {reason} ({source}).")

        self._tick.when_done(self.controller.read("_TC"), done)


def kept_lines(listing: Listing) -> tuple[int, ...]:
    """Of a listing the lines that are sent, in their order: the controller counts without the remarks."""
    return tuple(number for number, line in enumerate(listing.lines) if len(program_lines(f"{line.text}\nEN")) == 2)


def sentences_of(document: Document, kept: Sequence[int]) -> dict[int, str]:
    """The sentence of the instruction that each line of the controller's program comes from."""
    listing, setup = generate(document), document.working_setup
    words = {step.id: sentence(step.instruction, setup) for step in document.program.steps()}
    steps = {number: listing.lines[line].step for number, line in enumerate(kept)}
    return {number: words[step] for number, step in steps.items() if step in words}
