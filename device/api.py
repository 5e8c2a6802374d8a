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
from device.asking import Prompt, Waiting
from device.clock import Clock
from device.commands import Reply
from device.door import Door
from device.download import Downloaded, DownloadFailed, Job
from device.events import Event, EventList, What
from device.going import Ended
from device.hands import Io, Memory
from device.happenings import Badge, Kind, Notice, NoticeKind, State
from device.identify import Identity, mismatch, who
from device.jog import Places, Plan, Routine
from device.lease import Ran
from device.link import Link, Owner, Traffic
from device.meeting import Events
from device.moving import Motion, NeedsConfirmation
from device.own import OwnSimulator
from device.poll import Poller
from device.ring import EMPTY, Row
from device.stop import StopState
from device.stop_button import StopButton
from device.tasks import LinkError, LinkLost, NotAllowed, Priority, Refused, Send, Steps, Stopped, data_line
from device.transport import ONLY_WATCHED, LineSettings, OpenFailed, Transport, open_transport
from device.wire import Manners, nonces

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from codegen.setup import Setup

__all__ = [
    "ONLY_WATCHED", "Badge", "Controller", "DownloadFailed", "Downloaded", "Ended", "Event", "EventList", "Identity",
    "Job", "Kind", "LineSettings", "LinkError", "LinkLost", "NeedsConfirmation", "NotAllowed", "Notice", "NoticeKind",
    "OwnSimulator", "Places", "Plan", "Prompt", "Ran", "Refused", "Reply", "Routine", "Row", "State", "StopState",
    "Stopped", "Traffic", "What", "jog",
]  # fmt: skip
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
        self.stopping_time_s: float | None = None  # None: the controller is asked
        self.idle_limit_s = idle_limit_s
        self.io_control = False
        self.program_folder = program_folder
        self.door = Door(self.line.address)
        self.waiting = Waiting()
        self.nonces = nonces()
        self.poller = Poller(self.line, clock, self.nonces, self.resting, self._read, self._nothing_runs)
        self.stopper = StopButton(self)
        self.memory = Memory(self)
        self.motion = Motion(self)
        self.io = Io(self)
        self.expected_model = model
        self.known_models = dict(known_models or {})
        self.simulator = own
        self._notices: deque[Notice] = deque(maxlen=2000)
        self.clock_there = Clock()
        self.recording = ""  # why nothing else can be captured now: a capture is under way
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
        self.motion.let_go(watching=True)
        if self.door.control:
            self.door.control = False
            self.notify(NoticeKind.CONTROL, why)

    def set_io_control(self, on: bool) -> None:
        self.io_control = on and self.control

    def close(self) -> None:
        self.link.close()
        if self.simulator is not None:
            self.simulator.close()
        self.state, self.state_text = State.OFFLINE, "Offline"
        self.show_stop(StopState.NO_LINK)

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
        self.stopper.press(then)

    @property
    def stop_state(self) -> StopState:
        """What the STOP button shows."""
        return self.stopper.look()

    @property
    def stop_pressed_at(self) -> float:
        return self.stopper.pressed_at

    def show_stop(self, state: StopState) -> None:
        """The stop is now known to be in this state."""
        self.stopper.show(state)

    # --------------------------------------------------------------- asking

    def ask(self, command: str, timeout_s: float | None = None) -> Future[Reply]:
        """One line as a person types it; the reply says whether it was accepted, and why not."""
        self.used()
        return self.run(commands.by_hand(self, command, timeout_s), Priority.USER, "user")

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

    def watch(self, owner: str, keys: Iterable[str], each_round: Iterable[str] = ()) -> None:
        """What one owner needs; `each_round`: drawn as curves, so read in every round and in one line."""
        self.poller.watch(owner, keys, each_round)

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
        if self.link.at_work:
            self.used()
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

    @property
    def listing(self) -> str | None:
        """What the controller is known to hold."""
        return self.memory.listing

    def set_listing(self, listing: str | None) -> None:
        self.memory.set_listing(listing)

    def show_listing(self, text: str) -> None:
        """The code of the document now; the badge compares it with what the controller holds."""
        self.memory.show_listing(text)

    @property
    def program_badge(self) -> Badge:
        return self.memory.badge

    def execute(self, label: str | None = None, thread: int = 0, anyway: bool = False) -> Future[Reply]:
        """Starts the verified program at a label; `anyway` runs what is in the controller."""
        return self.memory.execute(label, thread, anyway)

    def halt(self) -> Future[Reply]:
        """Ends all programs, then all motion; as STOP does where a line could become an answer."""
        return self.memory.halt()

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
