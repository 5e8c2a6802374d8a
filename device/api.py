"""What is connected, as the windows see it: a facade of commands, memory, motion and outputs that never blocks."""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import Future
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from codegen.models import MODELS, Model
from device import commands, jog, live
from device.asking import Listing, Prompt, Waiting
from device.clock import Clock
from device.commands import Reply
from device.door import Door
from device.download import Downloaded, DownloadFailed, Job, program_lines
from device.events import Event, EventList, What
from device.hands import Io, Memory
from device.happenings import Badge, Kind, Notice, NoticeKind, State
from device.identify import Identity, mismatch, who
from device.jog import Places, Plan, Routine
from device.lease import Ran
from device.link import Link, Owner, Traffic
from device.meeting import Events
from device.moving import Ended, Motion, NeedsConfirmation
from device.own import OwnSimulator
from device.poll import Poller
from device.ring import EMPTY, Row
from device.stop import NO_ANSWER_S, Stopping, StopState
from device.tasks import LinkError, LinkLost, NotAllowed, Priority, Refused, Send, Steps, Stopped, data_line
from device.transport import ONLY_WATCHED, LineSettings, OpenFailed, Transport, open_transport
from device.wire import Manners, nonces

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from codegen.setup import Setup

__all__ = [
    "Badge",
    "Controller",
    "DownloadFailed",
    "Downloaded",
    "Ended",
    "Event",
    "EventList",
    "Identity",
    "Job",
    "Kind",
    "LineSettings",
    "LinkError",
    "LinkLost",
    "NeedsConfirmation",
    "NotAllowed",
    "Notice",
    "NoticeKind",
    "OwnSimulator",
    "Places",
    "Plan",
    "Prompt",
    "Ran",
    "Refused",
    "Reply",
    "Routine",
    "Row",
    "State",
    "StopState",
    "Stopped",
    "Traffic",
    "What",
    "jog",
]
T = TypeVar("T")


class Controller:
    """One controller. Every call returns at once; answers come in futures, happenings in `notices`."""

    def __init__(
        self,
        opener: Callable[[], Transport] | None,
        *,
        kind: Kind,
        line: LineSettings | None = None,
        model: Model | None = None,
        program_folder: Path | None = None,
        idle_limit_s: float = 600.0,
        clock: Callable[[], float] = time.monotonic,
        own: OwnSimulator | None = None,
        known_models: Mapping[int, str] | None = None,
        manners: Manners | None = None,
        hears: Callable[[Controller], Owner] | None = None,
        threaded: bool = True,
    ) -> None:
        self.kind, self.line, self.clock = kind, line or LineSettings(), clock
        self.state = State.OFFLINE if opener is None else State.CONNECTING
        self.state_text = "Offline" if opener is None else "Connecting…"
        self.identity: Identity | None = None
        self.model = model
        self._stop_state = StopState.NO_LINK
        self._stopping: Stopping | None = None
        self.stop_pressed_at = 0.0
        self.stopping_time_s: float | None = None
        self.idle_limit_s = idle_limit_s
        self.io_control = False
        self.listing: str | None = None
        self.program_folder = program_folder
        self.door = Door(self.line.address)
        self.waiting = Waiting()
        self.nonces = nonces()
        self.poller = Poller(self.line, clock, self.nonces, self.resting, self._read, self._nothing_runs)
        self.memory = Memory(self)
        self.motion = Motion(self)
        self.io = Io(self)
        self.expected_model = model
        self.known_models = dict(known_models or {})
        self.simulator = own
        self._notices: deque[Notice] = deque(maxlen=2000)
        self._document: str | None = None
        self._document_lines: list[str] = []
        self._listing_lines: list[str] = []
        self.clock_there = Clock()
        self.doubt = False  # whether the controller may have been restarted or exchanged meanwhile
        self._used = clock()
        self.door.control = kind is Kind.SIMULATOR
        self.door.resting = self.resting
        self.door.closed = ONLY_WATCHED if kind is Kind.REPLAY else ""
        self._events = Events(self)
        heard = hears(self) if hears is not None else self._events
        self.link = Link(opener or _no_transport, self.line, heard, self.door, clock)
        self.link.wire.manners = manners or self.link.wire.manners
        self.link.last_words = self.motion.last_words
        if opener is not None and threaded:
            self.link.start()

    @classmethod
    def offline(cls) -> Controller:
        """No controller: everything that asks fails with one sentence."""
        return cls(None, kind=Kind.OFFLINE)

    @classmethod
    def connect(
        cls,
        address: str,
        line: LineSettings | None = None,
        *,
        kind: Kind | None = None,
        plant: Path | None = None,
        eeprom: Path | None = None,
        profile: Path | None = None,
        **more: Any,
    ) -> Controller:
        """A machine at a serial device or `socket://…`; `simulator:MODEL` starts a simulated controller of our own.

        `profile` is what `twoletter conform` wrote about it: raises ProfileUnreadable when it is none.
        """
        if profile is not None:
            from device.simulator.twoletter.profile_file import load_profile

            more["manners"] = load_profile(profile).manners()
        if address == "simulator" or address.startswith("simulator:"):
            own = OwnSimulator(address.partition(":")[2] or "ssc4", plant, eeprom, profile)
            settings = line or LineSettings(baud=None)
            return cls(lambda: own.open(settings), kind=Kind.SIMULATOR, line=settings, own=own, **more)
        settings = line or LineSettings()
        return cls(lambda: open_transport(address, settings), kind=kind or Kind.MACHINE, line=settings, **more)

    # ---------------------------------------------------------------- control

    @property
    def control(self) -> bool:
        """Whether what moves, sets or downloads may leave (else: Watch)."""
        return self.door.control

    def take_control(self) -> None:
        self.used()
        if not self.door.control and self.kind in (Kind.MACHINE, Kind.SIMULATOR):
            self.door.control = True
            self.notify(NoticeKind.CONTROL, "Control taken.")

    def used(self) -> None:
        """A person did something: the idle time begins again."""
        self._used = self.clock()

    def release_control(self, why: str = "Watch: only reading and STOP.") -> None:
        self.io_control = False
        self.motion.let_go()
        if self.door.control:
            self.door.control = False
            self.notify(NoticeKind.CONTROL, why)

    def set_io_control(self, on: bool) -> None:
        self.io_control = on and self.control

    def close(self) -> None:
        self.link.close()
        if self.simulator is not None:
            self.simulator.close()
        self.state, self.state_text, self._stop_state = State.OFFLINE, "Offline", StopState.NO_LINK

    def leave(self) -> None:
        """Closes without making the caller wait for the line or a process of ours to end."""
        if self.link.threaded:
            threading.Thread(target=self.close, name="leaving").start()
        else:
            self.close()

    def choose_model(self, name: str) -> int | None:
        """The person says which type an unknown controller is; the serial number to remember it by, if it has one."""
        self.take_model(MODELS[name])
        serial = self.identity.serial if self.identity is not None else None
        if serial is not None:
            self.known_models[serial] = name
        return serial

    def take_model(self, model: Model | None) -> None:
        """The type is known now: its live values can be read."""
        self.model = model
        if model is not None:
            self.poller.columns = model.columns
            if self.poller.ring.columns != live.columns(model):
                self.poller.set_columns(live.columns(model))

    @property
    def axes(self) -> str:
        """The axis letters there are, as far as known."""
        if self.model is not None:
            return self.model.axes
        return self.identity.axes if self.identity is not None else ""

    @property
    def who(self) -> str:
        """Which controller is connected, in words."""
        return who(self.identity, self.model)

    def mismatch(self, setup: Setup) -> str:
        """How it differs from the controller a setup was written for, as one sentence, or nothing."""
        sure = self.state is State.READY and not self.doubt
        return mismatch(self.identity if sure else None, self.model, setup)

    # ------------------------------------------------------------------- STOP

    def stop(self, then: Callable[[bool], None] = lambda still: None) -> None:
        """Stops everything, ahead of everything; pressed again while it is not proved, it aborts."""
        if self.kind is Kind.REPLAY:
            self.notify(NoticeKind.STOP, "There is nothing to stop: this is a recording.")
            then(False)
            return
        if self.link.transport is None:
            self.show_stop(StopState.NO_LINK if self.state is State.OFFLINE else StopState.NOT_CONFIRMED)
            then(False)
            return
        again = self._stopping is not None or self._stop_state is StopState.STOPPING
        self.motion.let_go()
        self._stopping, self.stop_pressed_at = None, self.clock()
        self.show_stop(StopState.STOPPING)
        self.link.stop(lambda sure: self._stop_steps(sure, again, then))

    def _stop_steps(self, sure: bool, abort: bool, then: Callable[[bool], None]) -> Steps[bool]:
        model = self.model
        self._stopping = stopping = Stopping(
            command_mode=sure and not self.resting() and self.line.address is None,  # others in a chain prove nothing
            axes=self.axes or "X",
            sequence=model is not None and model.coordinated,
            threads=model.threads if model is not None else 1,
            columns=model.columns if model is not None else 40,
            address=self.line.address,
            stopping_time_s=self.stopping_time_s,
            clock=self.clock,
            nonces=self.nonces,
            show=self.show_stop,
            abort=abort,
            heard=self.stop_pressed_at,
        )
        still = False
        try:
            still = yield from stopping.steps()
        finally:
            self._stopping = None
            then(still)
        if still:
            self.waiting.restarted()
            self.waiting.unfinished = False
            self.waiting.threads(frozenset())
            self.door.question = ""
        return still

    @property
    def stop_state(self) -> StopState:
        """What the STOP button shows; 500 ms without an answer is NOT CONFIRMED, whatever the link is doing."""
        if self._stop_state is StopState.STOPPING:
            stopping = self._stopping
            heard = self.stop_pressed_at if stopping is None else stopping.heard
            if self.clock() - heard >= NO_ANSWER_S:
                self.show_stop(StopState.NOT_CONFIRMED)
        return self._stop_state

    @property
    def stop_text(self) -> str:
        return str(self.stop_state)

    def show_stop(self, state: StopState) -> None:
        """The stop is now known to be in this state."""
        if state is not self._stop_state:
            self._stop_state = state
            if state in (StopState.STOPPING, StopState.STOPPED, StopState.NOT_CONFIRMED):
                self.notify(NoticeKind.STOP, f"STOP: {state}.")

    # --------------------------------------------------------------- asking

    def ask(self, command: str, timeout_s: float | None = None) -> Future[Reply]:
        """One line as a person types it; the reply says whether it was accepted, and why not."""
        self.used()
        return self.run(commands.typed(self, command, timeout_s), Priority.USER, "user")

    def read(self, *expressions: str) -> Future[tuple[float, ...]]:
        """Reads expressions (`_KPX`, `V1`) right under any number format; refused ones raise Refused."""
        return self.run(commands.read(self, expressions), Priority.POLL, "user")

    def run(self, steps: Steps[T], priority: Priority, source: str, *, address: bool = True) -> Future[T]:
        """Puts steps on the link; in a daisy chain the address goes before them."""
        if self.state is State.OFFLINE:
            steps.close()
            future: Future[T] = Future()
            future.set_exception(LinkLost("Offline: there is no controller. Connect first."))
            return future
        if address and self.line.address is not None:
            steps = commands.addressed(self, self.line.address, steps)
        return self.link.submit(steps, priority, source).future

    def answer(self, text: str) -> Future[None]:
        """Answers the question of the program that waits."""
        return self.run(self._answer_steps(text), Priority.USER, "user", address=False)

    def _answer_steps(self, text: str) -> Steps[None]:
        self.link.clear_rest()
        yield Send(data_line(text), answers_prompt=True)
        self.waiting.answered()
        self.door.question = self.waiting.question

    @property
    def pending_prompt(self) -> Prompt | None:
        return self.waiting.prompt

    def resume_polling(self) -> None:
        """The person says that nothing is waiting: reading goes on."""
        self.waiting.prompt, self.waiting.data_mode, self.waiting.free = None, False, True
        self.door.question = ""

    # ------------------------------------------------------------ live values

    def watch(self, owner: str, keys: Iterable[str]) -> None:
        self.poller.watch(owner, keys)

    def last(self) -> Row:
        return self.poller.ring.last() if self.poller.ring.columns else EMPTY

    def tail(self, count: int) -> NDArray[np.float64]:
        return self.poller.ring.tail(count)

    @property
    def columns(self) -> tuple[str, ...]:
        return self.poller.ring.columns

    @property
    def rate_hz(self) -> float:
        """Cycles of live values a second."""
        return self.poller.rate_hz

    @property
    def line_share(self) -> float:
        """How much of the line reading takes, 0 to 1."""
        return self.poller.line_share

    def hurry(self, on: bool) -> None:
        """Reads as fast as the line can, also while a program runs; or at the usual pace again."""
        self.poller.hurry = on

    def _nothing_runs(self) -> bool:
        """Whether it is known that no thread runs."""
        return self.waiting.position == frozenset()

    @property
    def polling(self) -> bool:
        return self.state is State.READY and not self.resting()

    @property
    def polling_text(self) -> str:
        """Why live values rest, or how fast they come."""
        return self.resting() or f"{self.rate_hz:.0f} readings/s"

    def resting(self) -> str:
        """Why live values rest now: a question waits or may come at any moment; nothing when they are read."""
        return self.waiting.question or self.waiting.imminent

    def _read(self, values: dict[str, float], sent: float) -> None:
        """A poll was answered that was wanted at `sent` (on the link's thread)."""
        now = self.clock()
        threads = {key: value for key, value in values.items() if key.startswith("thread")}
        if threads and self.model is not None and len(threads) == self.model.threads:
            self.waiting.threads(frozenset(int(value) for value in threads.values() if value >= 0))
        if "time" in values:
            self._events.clock_read(values["time"], sent, now)
        if self.kind is Kind.MACHINE and self.control and now - self._used > self.idle_limit_s:
            self.release_control("Back to Watch: nothing was done for a while.")
        if self.state is State.LOST:
            self._events.answers_again()

    def restarted(self, what: str) -> None:
        """What was known of the controller's memory and places is known no longer (on the link's thread)."""
        self.set_listing(None)
        self.waiting.restarted()
        self.notify(
            NoticeKind.RESTARTED, f"The controller {what}: homed marks and the program badge are no longer known."
        )
        if self.kind is Kind.MACHINE:
            self.release_control(f"Back to Watch: the controller {what}.")

    # --------------------------------------------------------------- programs

    def download(self, listing: str, progress: Callable[[Job[Downloaded]], None] | None = None) -> Job[Downloaded]:
        return self.memory.download(listing, progress)

    def upload(self) -> Job[str]:
        return self.memory.upload()

    def burn_program(self) -> Future[Reply]:
        return self.memory.burn_program()

    def show_listing(self, text: str) -> None:
        """The code of the document now; the badge compares it with what the controller holds."""
        if text != self._document:
            self._document, self._document_lines = text, program_lines(text)

    @property
    def program_badge(self) -> Badge:
        if self.listing is None or self.doubt:
            return Badge.UNKNOWN
        if self._document is None:
            return Badge.CHANGED
        return Badge.SAME if self._document_lines == self._listing_lines else Badge.CHANGED

    def execute(self, label: str | None = None, thread: int = 0, anyway: bool = False) -> Future[Reply]:
        """Starts the verified program at a label; `anyway` runs what is in the controller."""
        if self.program_badge is not Badge.SAME and not anyway:
            future: Future[Reply] = Future()
            words = (
                "has changed since the download"
                if self.program_badge is Badge.CHANGED
                else "in the controller is unknown"
            )
            future.set_exception(
                NotAllowed(f"Not started: the program {words}. Download it, or run what is in the controller.")
            )
            return future
        target = "" if label is None else (label if label.startswith("#") else f"#{label}")
        command = f"XQ {target}" + (f",{thread}" if thread or target else "") if target else "XQ"
        return self.ask(command)

    def halt(self) -> Future[Reply]:
        """Ends all programs, then all motion; as STOP does where a line could become an answer."""
        if not self.resting():
            return self.run(commands.halt(self), Priority.USER, "user")
        halted: Future[Reply] = Future()
        self.stop(lambda still: halted.set_result(Reply("", still, still, 0, "" if still else "Not confirmed.")))
        return halted

    def set_listing(self, listing: str | None) -> None:
        """What the controller is known to hold (on the link's thread)."""
        self._listing_lines = program_lines(listing or "")
        self.listing = listing
        self.waiting.listing = Listing(listing) if listing is not None else None

    # ---------------------------------------------------------------- notices

    def notify(self, kind: NoticeKind, text: str) -> None:
        self._notices.append(Notice(kind, text, self.clock()))

    def notices(self) -> list[Notice]:
        """What happened since the last call."""
        found = []
        while self._notices:
            found.append(self._notices.popleft())
        return found

    def traffic(self, after: int = 0) -> list[Traffic]:
        """Lines that went over the wire, newer than number `after`."""
        return [line for line in list(self.link.record) if line.number > after]


def _no_transport() -> Transport:
    raise OpenFailed("Offline: there is no controller.")
