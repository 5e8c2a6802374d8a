"""What happens on the link, told to the controller: connecting, texts, questions, loss (on the link's thread)."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from codegen.models import MODELS
from device import commands
from device.asking import Listing, parted
from device.clock import TICKS, Reading, Verdict
from device.download import FEW, Unsteady, held_program, recover
from device.happenings import Kind, NoticeKind, State
from device.identify import Identity, identify, read_once, read_surely
from device.stop import StopState
from device.tasks import LinkLost, NotAllowed, Priority, Steps, Stopped, Wait
from device.wire import Kind as AnswerKind
from device.wire import Shape

if TYPE_CHECKING:
    from device.api import Controller

HALT_S = 0.5  # a reset takes longer
SHOWN = 3  # of lines nobody can tell apart; all of them stand in the terminal
LAG_S = 3.0  # readings closer than this follow each other without a gap


class Events:
    """Hears the link and keeps the controller's state (on the link's thread)."""

    def __init__(self, controller: Controller) -> None:
        self._c = controller
        self._checking = False
        self._asked = ""  # the text of a question as it stands there without a line end

    def opened(self) -> None:
        c = self._c
        self._checking = False
        c.state, c.state_text = State.CONNECTING, "Asking who is there…"
        c.link.submit(self._meet_surely(self._meet), Priority.USER, "poll")

    def _meet_surely(self, steps: Callable[[], Steps[None]]) -> Steps[None]:
        """Meeting again after whatever came in between (STOP, silence)."""
        while True:
            try:
                yield from steps()
                return
            except (LinkLost, Stopped, NotAllowed) as reason:
                if self._c.link.transport is None:
                    raise
                if not isinstance(reason, Stopped):
                    self._c.state_text = str(reason)
                yield Wait(0.3)

    def _meet(self) -> Steps[None]:
        """Meets over a line just opened, then starts reading."""
        c = self._c
        yield from self._get_to_know()
        identity = c.identity
        text = identity.text if identity is not None else ""
        c.state, c.state_text = State.READY, f"Connected: {text or 'unknown controller'}"
        c.show_stop(StopState.READY)
        c.notify(NoticeKind.IDENTIFIED, f"Connected to {text or 'a controller that does not name itself'}.")
        if c.model is None:
            c.notify(NoticeKind.IDENTIFIED, "This controller's type is not known; choose it to see live values.")
        c.link.submit(c.poller.run(), Priority.POLL, "poll")

    def _get_to_know(self) -> Steps[None]:
        """Identifies, compares the clock, learns whether a program runs and may ask."""
        before = self._c.identity
        self._know((yield from self._identify()))
        self._c.waiting.restarted()
        yield from self._compare(before)
        yield from self._programs()

    def _know(self, identity: Identity) -> None:
        """The type: as it says itself, as chosen before for this serial number, or as expected; never guessed."""
        c = self._c
        c.identity = identity
        remembered = MODELS.get(c.known_models.get(identity.serial, "")) if identity.serial is not None else None
        c.take_model(identity.model or remembered or c.expected_model)

    # ----------------------------------------------------- the same as before?

    def answers_again(self) -> None:
        """Reads are answered again on a line that was never closed: who is it, and was it switched off?"""
        c = self._c
        if self._checking:
            return
        self._checking = True
        c.state, c.state_text = State.CONNECTING, "Answers again; asking who is there…"
        c.link.submit(self._meet_surely(self._again), Priority.USER, "poll")

    def _again(self) -> Steps[None]:
        c = self._c
        yield from self._get_to_know()
        self._checking = False
        c.state, c.state_text = State.READY, "Connected"
        if c.stop_state in (StopState.NO_LINK, StopState.NOT_CONFIRMED):
            c.show_stop(StopState.READY)
        c.notify(NoticeKind.CONNECTED, "The controller answers again.")

    def clock_read(self, samples: float, sent: float, came: float) -> None:
        """A live reading of the clock; where it is not as expected, everything is asked again."""
        c = self._c
        reading = Reading(samples, c.clock_there.period, sent, came)
        if self._checking or c.state is not State.READY:
            return
        if not c.doubt and self._as_expected(reading):
            c.clock_there.keep(reading)
            return
        self._checking = c.doubt = True
        c.link.submit(self._check_again(), Priority.USER, "poll")

    def _as_expected(self, reading: Reading) -> bool:
        """A simulation may lag: while it is read all the time only a step back counts, or a clock that began again."""
        c = self._c
        last = c.clock_there.last
        if c.kind is Kind.SIMULATOR and last is not None and reading.came - last.came <= LAG_S:
            passed = max(reading.sent - last.came, 0.0) * TICKS / max(reading.period, last.period, 1.0)
            advance = reading.samples - last.samples
            began_again = reading.samples <= passed and advance < passed / 2 and reading.sent - last.came > HALT_S
            return advance >= 0 and not began_again
        verdict = c.clock_there.judge(reading)
        if verdict is Verdict.ANOTHER and c.kind is Kind.SIMULATOR:
            return last is None or reading.samples >= last.samples
        return verdict in (Verdict.FIRST, Verdict.AS_EXPECTED)

    def _check_again(self) -> Steps[None]:
        try:
            before = self._c.identity
            self._know((yield from identify(self._c.nonces, self._c.line.address)))
            yield from self._compare(before)
            yield from self._programs()
        finally:
            self._checking = False

    def _compare(self, before: Identity | None) -> Steps[None]:
        """Whether this is the controller of before, running since: by its name, its number and its clock."""
        c = self._c
        now = yield from self._read_clock()
        identity = c.identity
        same = before is None or (
            identity is not None
            and (before.text, before.serial, before.axes) == (identity.text, identity.serial, identity.axes)
        )
        what = ""
        if not same:
            what = "is another one than before"
        elif now is None:
            what = "does not tell its clock" if before is not None else ""
        elif not self._as_expected(now):
            restarted = c.clock_there.judge(now) is not Verdict.ANOTHER
            what = "was restarted" if restarted else "was restarted or is another one (its clock is not as expected)"
        if now is not None:
            c.clock_there.keep(now)
        c.doubt = False
        if what:
            c.restarted(what)

    def _read_clock(self) -> Steps[Reading | None]:
        c = self._c
        both = [("TIME", Shape(10, 0)), ("_TM", Shape(5, 0))]
        for reads in (both, both, both[:1]):
            sent = c.clock()
            answer = yield from read_once(c.nonces, *reads)
            if answer.kind is AnswerKind.VALUES:
                samples, period = (*answer.values, c.clock_there.period)[:2]
                return Reading(samples, period, sent, c.clock())
        return None

    def _identify(self) -> Steps[Identity]:
        c = self._c
        while True:
            try:
                if c.waiting.unfinished:
                    yield from recover(c.waiting, c.nonces)
                return (yield from identify(c.nonces, c.line.address))
            except LinkLost as reason:
                if c.state is not State.LOST:
                    self.lost(str(reason), refused=True)

    def _programs(self) -> Steps[None]:
        """Which threads run; a running program that is not known is read, because it may ask."""
        c = self._c
        threads = c.model.threads if c.model is not None else 1
        lines = []
        for number in range(threads):
            answer = yield from read_surely(c.nonces, (f"_XQ{number}", Shape(4, 0)))
            lines += [int(v) for v in answer.values if v >= 0]
        c.waiting.threads(frozenset(lines))
        if lines and c.listing is None:
            try:
                text = yield from held_program(c.waiting, c.nonces, most=FEW)
            except Unsteady as reason:
                text = reason.nearest  # enough to know its questions
            c.waiting.listing = Listing(text)

    def lost(self, sentence: str, *, refused: bool) -> None:
        c = self._c
        if not refused and c.link.transport is not None and c.state is not State.READY:
            return  # not met yet: whoever is asking tells
        new = c.state is not State.LOST or c.state_text != sentence
        c.doubt = c.identity is not None
        c.state, c.state_text = State.LOST, sentence
        if c.stopper.state is StopState.STOPPING:
            c.show_stop(StopState.NOT_CONFIRMED)
        elif c.stopper.state is not StopState.NOT_CONFIRMED:
            c.show_stop(StopState.NO_LINK)
        if new:
            c.notify(NoticeKind.LOST, sentence)
        if not refused and c.kind is Kind.MACHINE:
            c.release_control("Back to Watch: the connection was lost.")

    def text(self, line: str) -> None:
        """A line of a program: a message, or an error, which may stand behind a question that got no answer."""
        c = self._c
        before, number, text = parted(line, c.waiting.listing)
        if number < 0 or before not in ("", self._asked):
            c.notify(NoticeKind.MESSAGE, before)
        self._asked = ""
        if number >= 0:
            c.notify(NoticeKind.FAULT, f"?{number:03d} {text}")
            c.waiting.failed(number, text)
            c.door.question = c.waiting.question

    def unclear(self, lines: list[str]) -> None:
        """An answer was cut off by STOP, or a program read, while one ran: who can tell what it printed then?"""
        c = self._c
        if c.waiting.position != frozenset():
            what = f"{len(lines)} lines" if len(lines) > 1 else "A line"
            shown = " / ".join(line.strip() for line in lines[:SHOWN]) + (" …" if len(lines) > SHOWN else "")
            c.notify(NoticeKind.UNCLEAR, f"{what} came that may be a reply or printed by the program: {shown}")

    def standing(self, rest: str) -> None:
        c = self._c
        if c.waiting.seen(rest):
            c.door.question = c.waiting.question
            prompt = c.waiting.prompt
            c.notify(NoticeKind.PROMPT, prompt.text if prompt is not None else rest)
            self._asked = rest

    def sent(self, data: bytes, source: str) -> None:
        """What leaves may change what the controller holds or waits for."""
        commands.sent(self._c, data, source)
