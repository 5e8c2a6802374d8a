"""Stand-ins for what is slow or dangerous to have in a widget test."""

from __future__ import annotations

import math
from collections.abc import Iterable
from concurrent.futures import Future
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from codegen.models import MODELS, Model
from device.api import (
    Badge,
    Identity,
    Kind,
    LineSettings,
    Notice,
    NoticeKind,
    Prompt,
    Reply,
    Row,
    State,
    StopState,
    Traffic,
)


def row_of(values: dict[str, float], at: float = 0.0, period_s: float = 0.1) -> Row:
    """A row with these values, all read at `at`."""
    places = {name: place for place, name in enumerate(values)}
    numbers = np.array([float(value) for value in values.values()])
    return Row(places, numbers, np.full(len(values), at), period_s)


def done(value: Any) -> Future[Any]:
    """A future that is finished already."""
    future: Future[Any] = Future()
    future.set_result(value)
    return future


def failed(error: BaseException) -> Future[Any]:
    """A future that has failed already."""
    future: Future[Any] = Future()
    future.set_exception(error)
    return future


@dataclass
class FakeJob:
    """Something under way that the test finishes."""

    future: Future[Any] = field(default_factory=Future)
    phase: str = ""
    done: int = 0
    total: int = 100
    cancelled: bool = False

    @property
    def fraction(self) -> float:
        return self.done / self.total

    def cancel(self) -> None:
        self.cancelled = True


class FakeMemory:
    def __init__(self, owner: FakeController) -> None:
        self._owner = owner

    def burn_words(self) -> str:
        return "At the next power-up this program is in the controller but does not start: it has no #AUTO."


class FakeIo:
    def __init__(self, owner: FakeController) -> None:
        self._owner = owner

    def set_output(self, number: int, on: bool) -> Future[Any]:
        self._owner.calls.append(("output", number, on))
        return done(Reply("", True))


class FakeController:
    """As much of `device.api.Controller` as the windows use; `calls` keeps what was asked."""

    starts_in_control = False

    def __init__(self, kind: Kind = Kind.OFFLINE, model: str = "ssc2") -> None:
        self.kind = kind
        offline = kind is Kind.OFFLINE
        self.state = State.OFFLINE if offline else State.READY
        self.state_text = "Offline" if offline else "Connected: SSC"
        self.control = kind is Kind.SIMULATOR or self.starts_in_control
        self.io_control = False
        self.model: Model | None = None if offline else MODELS[model]
        self.axes = "" if offline else MODELS[model].axes
        self.identity = None if offline else Identity("SSC2", MODELS[model], self.axes, 1234)
        self.line = LineSettings(baud=19200)
        self.rate_hz, self.polling, self.polling_text = 38.0, not offline, "38 readings/s"
        self.stop_state = StopState.NO_LINK if offline else StopState.READY
        self.pending_prompt: Prompt | None = None
        self.program_badge = Badge.UNKNOWN
        self.listing: str | None = None
        self.calls: list[Any] = []
        self.row = row_of({})
        self.waiting_notices: list[Notice] = []
        self.replies: dict[str, Reply] = {}
        self.memory, self.io = FakeMemory(self), FakeIo(self)
        self.job = FakeJob()
        self.closed = False

    def say(self, kind: NoticeKind, text: str) -> None:
        self.waiting_notices.append(Notice(kind, text, 0.0))

    def notices(self) -> list[Notice]:
        found, self.waiting_notices = self.waiting_notices, []
        return found

    def last(self) -> Row:
        return self.row

    def watch(self, owner: str, keys: Iterable[str]) -> None:
        self.calls.append(("watch", owner, tuple(keys)))

    def stop(self) -> None:
        self.calls.append("stop")
        if self.kind is not Kind.OFFLINE:
            self.stop_state = StopState.STOPPING

    def take_control(self) -> None:
        self.control = True

    def release_control(self, why: str = "") -> None:
        self.control = False
        self.io_control = False

    def set_io_control(self, on: bool) -> None:
        self.io_control = on and self.control

    def show_listing(self, text: str) -> None:
        self.calls.append(("listing", text))

    def ask(self, command: str, timeout_s: float | None = None) -> Future[Any]:
        self.calls.append(("ask", command))
        return done(self.replies.get(command, Reply("", True)))

    def read(self, *expressions: str) -> Future[Any]:
        self.calls.append(("read", expressions))
        return done(tuple(7.0 for _ in expressions))

    def answer(self, text: str) -> Future[Any]:
        self.calls.append(("answer", text))
        self.pending_prompt = None
        return done(None)

    def resume_polling(self) -> None:
        self.pending_prompt = None

    def download(self, listing: str, progress: Any = None) -> FakeJob:
        self.calls.append(("download", listing))
        self.job = FakeJob()
        return self.job

    def upload(self) -> FakeJob:
        self.calls.append("upload")
        self.job = FakeJob()
        return self.job

    def execute(self, label: str | None = None, thread: int = 0, anyway: bool = False) -> Future[Any]:
        self.calls.append(("execute", label, anyway))
        return done(Reply("", True))

    def halt(self) -> Future[Any]:
        self.calls.append("halt")
        return done(Reply("", True))

    def burn_program(self) -> Future[Any]:
        self.calls.append("burn")
        return done(Reply("", True))

    def traffic(self, after: int = 0) -> list[Traffic]:
        return []

    def choose_model(self, name: str) -> int | None:
        self.calls.append(("model", name))
        self.model, self.axes = MODELS[name], MODELS[name].axes
        return 1234

    def close(self) -> None:
        self.closed = True


class FakeWorld:
    """The outside of a fake simulator."""

    def __init__(self) -> None:
        self.signals: list[tuple[str, float | str]] = []

    def stimulus(self, signal: str, value: float | str) -> None:
        self.signals.append((signal, value))


def live_row(now: float = 0.0) -> Row:
    """A plausible two-axis machine at work: X moves, Y stands at its forward limit."""
    values = {
        "position.x": 6370.0, "commanded.x": 6371.0, "error.x": 1.0, "velocity.x": 3185.0,
        "switches.x": 128 + 8 + 4 + 1.0,
        "stop_code.x": 0.0, "position.y": -1250.0, "commanded.y": -1250.0, "error.y": 0.0, "velocity.y": 0.0,
        "switches.y": 4 + 2 + 1.0, "stop_code.y": 2.0, "inputs": 0b11111110, "outputs": 0b00000101,
        "thread0": 4.0, "thread1": -1.0, "thread2": -1.0, "thread3": math.nan,
    }  # fmt: skip
    return row_of(values, now)
