"""Where events come from: the notices of a connection, the live values, and the lines that were sent."""

from __future__ import annotations

import math
import re
import time
from collections.abc import Callable
from typing import TYPE_CHECKING

from codegen.twoletter import nodes
from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.parse import parse_line
from codegen.twoletter.problems import ARRIVED, ERROR_TEXTS, RUNNING, STOP_STEPS, STOP_TEXTS, USUAL_STEP, error_step
from device.events import Event, EventList, What
from device.happenings import Notice, NoticeKind
from device.stop import StopState

if TYPE_CHECKING:
    from device.api import Controller
    from device.ring import Row

WATCHED = ("stop_code", "motor_off", "position")
CAUSE_S = 3.0  # so long an error waits for its code
TOLD = re.compile(r"\?(\d{3}) (.*)")
FORWARD, REVERSE, STOP_COMMAND, OFF_ON_ERROR = 2, 3, 4, 8
BURNS = frozenset({"BN", "BP", "BV"})
LOOK_S = 0.2  # between two looks
RECENT_S = 1.5  # so long ago a thread was seen running that is told with what happened
HAND_S = 2.0  # so long a stop belongs to the hand that let go


class EventsHeard:
    """Turns what is heard into events. `happened` gets every notice, `look` is called with each tick.

    It watches stop codes, motors and positions itself (`WATCHED`), so it hears with no panel open.
    """

    def __init__(self, events: EventList, wall: Callable[[], float] = time.time) -> None:
        self.events, self._wall = events, wall
        self._codes: dict[str, float] = {}
        self._off: dict[str, float] = {}
        self._seen: dict[str, tuple[int, float]] = {}  # by thread: the line it was seen on, and when
        self._error = 0.0
        self._line = 0
        self._burning = ""
        self._stop = 0  # the number of the STOP that is on its way
        self._unexplained: list[tuple[int, float]] = []  # errors of programs, and when they were told
        self._began = self._looked = self._hand_until = 0.0
        self._watches: tuple[str, ...] = ()

    def begin(self, controller: Controller) -> None:
        """Another controller; what it did before is not news."""
        self._codes, self._off, self._seen, self._unexplained = {}, {}, {}, []
        self._error, self._burning, self._stop, self._line = -1.0, "", 0, 0
        self._began, self._watches = controller.clock(), ()
        self._looked = self._hand_until = 0.0

    # ---------------------------------------------------------------- notices

    def happened(self, controller: Controller, notice: Notice) -> None:
        """One notice of the connection."""
        match notice.kind:
            case NoticeKind.FAULT:
                self._program_error(controller, notice)
            case NoticeKind.LOST:
                self._add(controller, What.LOST, notice.text, step="Look at the cable and the controller's power.")
            case NoticeKind.CONNECTED | NoticeKind.IDENTIFIED:
                self._add(controller, What.BACK, notice.text)
            case NoticeKind.RESTARTED:
                self._forget(controller)
                step = "Home the axes again; look whether the program in the controller is the right one."
                self._add(controller, What.RESET, notice.text, step=step)
            case NoticeKind.DOWNLOAD:
                self._add(controller, What.DOWNLOAD, notice.text)
            case NoticeKind.STOP:
                self._stopping(controller, notice.text)

    def _program_error(self, controller: Controller, notice: Notice) -> None:
        """`?012 PR 5000`: the line and its text; the code is read a moment later."""
        found = TOLD.match(notice.text)
        line = int(found.group(1)) if found else None
        text = f"Error in line {line}: {found.group(2)}" if found else notice.text
        threads = self._running(controller)
        same = [n for n, at in threads.items() if at == line] or list(threads)
        thread = int(same[0]) if len(same) == 1 else None
        event = self._add(controller, What.PROGRAM, text, thread=thread, line=line, step=USUAL_STEP)
        self._unexplained.append((event.number, notice.at))

    def _stopping(self, controller: Controller, text: str) -> None:
        if str(StopState.STOPPING) in text or not self._stop:
            self._stop = self._add(controller, What.STOP, "STOP was pressed.").number
        if str(StopState.STOPPING) in text:
            return
        proved = str(StopState.STOPPED) in text
        step = "" if proved else "Use the machine's emergency stop; look at the cable and the controller's power."
        self.events.complete(self._stop, cause=text.removeprefix("STOP: ").removesuffix("."), step=step)
        self._stop = self._stop if not proved else 0

    # ------------------------------------------------------------ live values

    def look(self, controller: Controller) -> None:
        """What the newest readings and the lines that left tell."""
        now = controller.clock()
        if controller.motion.busy:
            self._hand_until = now + HAND_S
        if now - self._looked < LOOK_S:
            return
        self._looked = now
        self._watch(controller)
        self._see_threads(controller)
        row = controller.last()
        for letter in controller.axes:
            self._look_at_axis(controller, row, letter)
        self._look_at_error(controller, row)
        self._hear_lines(controller)

    def _watch(self, controller: Controller) -> None:
        keys = tuple(f"{name}.{letter.lower()}" for letter in controller.axes for name in WATCHED)
        if keys != self._watches:
            self._watches = keys
            threads = (f"thread{n}" for n in range(_threads(controller)))
            controller.watch("events", (*keys, *threads, "error_code"))

    def _look_at_axis(self, controller: Controller, row: Row, letter: str) -> None:
        code, off = f"stop_code.{letter.lower()}", f"motor_off.{letter.lower()}"
        if row.time(code) > self._began and self._codes.get(letter) != row.value(code):
            known = letter in self._codes
            self._codes[letter] = row.value(code)
            if known:
                self._stopped(controller, letter, int(row.value(code)))
        if row.time(off) > self._began and self._off.get(letter) != row.value(off):
            known = letter in self._off
            self._off[letter] = row.value(off)
            if known and row.value(off) and self._codes.get(letter) == OFF_ON_ERROR:
                self._add(
                    controller, What.FAULT, f"The motor of axis {letter} went off: its position error was above ER.",
                    axis=letter, cause=STOP_TEXTS[OFF_ON_ERROR], step=STOP_STEPS[OFF_ON_ERROR],
                )  # fmt: skip

    def _stopped(self, controller: Controller, letter: str, code: int) -> None:
        by_hand = code == STOP_COMMAND and controller.clock() < self._hand_until
        if code in RUNNING or code in ARRIVED or by_hand:
            return
        limit = code in (FORWARD, REVERSE)
        text = f"Axis {letter} stopped at its {'forward' if code == FORWARD else 'reverse'} limit."
        self._add(
            controller, What.LIMIT if limit else What.STOPPED,
            text if limit else f"Axis {letter} stopped with code {code}.",
            axis=letter, cause=STOP_TEXTS.get(code, "unknown stop code"), step=STOP_STEPS.get(code, ""),
        )  # fmt: skip

    def _look_at_error(self, controller: Controller, row: Row) -> None:
        """The error code: it explains the errors told since, or is one of a command that was refused."""
        at, code = row.time("error_code"), row.value("error_code")
        now = controller.clock()
        waiting = [(number, told) for number, told in self._unexplained if now - told <= CAUSE_S]
        if not math.isnan(code) and at > self._began:
            for number, told in waiting:
                if at > told and code:
                    self._explain(number, int(code))
            waiting = [(number, told) for number, told in waiting if at <= told]
            if self._error not in (code, -1.0) and code and not self._unexplained:
                words = ERROR_TEXTS.get(int(code), "unknown error")
                self._add(
                    controller, What.REFUSED, f"Error {int(code)}: {words}.", cause=words, step=error_step(int(code))
                )
            self._error = code
        self._unexplained = waiting

    def _explain(self, number: int, code: int) -> None:
        words = ERROR_TEXTS.get(code, "unknown error")
        self.events.complete(number, cause=f"error {code}, {words}", step=error_step(code))

    def _hear_lines(self, controller: Controller) -> None:
        """A burn that was answered, told apart from one that was refused."""
        for entry in controller.traffic(self._line):
            self._line = entry.number
            if entry.source != "user":
                continue
            if entry.direction == ">":
                self._burning = _burned(entry.text) or self._burning
            elif entry.direction == "<" and self._burning:
                done, self._burning = self._burning, ""
                if not entry.text.startswith("?"):
                    step = "The next power-up begins with what was burned."
                    self._add(controller, What.BURN, f"{COMMANDS[done].title} ({done}).", step=step)

    # ----------------------------------------------------------------- inside

    def _see_threads(self, controller: Controller) -> None:
        """The line each thread was seen on; what ends a thread is told after it has ended."""
        row = controller.last()
        for number in range(_threads(controller)):
            line, at = row.value(f"thread{number}"), row.time(f"thread{number}")
            if line >= 0 and at > self._began:
                self._seen[str(number)] = int(line), at

    def _running(self, controller: Controller) -> dict[str, int]:
        """The threads that ran just now, with their lines."""
        self._see_threads(controller)
        return {number: line for number, (line, at) in self._seen.items() if controller.clock() - at < RECENT_S}

    def _forget(self, controller: Controller) -> None:
        self._codes, self._off, self._error = {}, {}, -1.0
        self._began = controller.clock()

    def _add(
        self, controller: Controller, what: What, text: str, *, axis: str = "", thread: int | None = None,
        line: int | None = None, cause: str = "", step: str = "",
    ) -> Event:  # fmt: skip
        row = controller.last()
        places = {letter: row.value(f"position.{letter.lower()}") for letter in controller.axes}
        known = {letter: place for letter, place in places.items() if not math.isnan(place)}
        machine = controller.identity.text if controller.identity is not None else ""
        running = self._running(controller) if line is None else {}
        return self.events.add(
            Event(0, self._wall(), what, text, axis, known, thread, line, cause, step, machine, running)
        )


def _threads(controller: Controller) -> int:
    return controller.model.threads if controller.model is not None else 1


def _burned(line: str) -> str:
    """The burn on a line, if there is one."""
    for statement in parse_line(line.strip()).statements:
        if isinstance(statement, nodes.Command) and statement.name in BURNS:
            return statement.name
    return ""
