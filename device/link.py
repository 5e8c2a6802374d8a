"""The one thread that owns the transport: stop first, then lease, people, downloads, polls; no call blocks."""

from __future__ import annotations

import contextlib
import itertools
import threading
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any, Protocol, TypeVar

from device.door import LEAVE, Door
from device.outgoing import Echo, Outgoing, say_last
from device.proof import bare
from device.stop import stop_bytes
from device.tasks import LinkError, LinkLost, NotAllowed, Priority, Send, Step, Steps, Stopped, Task, Wait
from device.transport import LineSettings, OpenFailed, Transport, TransportLost
from device.wire import Answer, Frame, Kind, Proof, Wire

T = TypeVar("T")
PROMPT_QUIET_S = 0.06  # text without a line end that stands this long may be a question
SILENCES = 3  # unanswered exchanges in a row that mean "does not answer"
SILENT = "The controller does not answer."
NOISY = (
    "The controller does not answer, but something comes over the line: "
    "is another device plugged in, or has the speed changed?"
)
ANSWER = Answer(Kind.ACCEPTED)


@dataclass(frozen=True, slots=True)
class Traffic:
    """One line of what went over the wire."""

    number: int
    at: float
    direction: str
    text: str
    source: str


class Owner(Protocol):
    """Who is told what happens on the link; called on its thread, must be quick."""

    def opened(self) -> None: ...
    def lost(self, sentence: str, *, refused: bool) -> None: ...
    def text(self, line: str) -> None: ...
    def standing(self, rest: str) -> None: ...
    def unclear(self, lines: list[str]) -> None: ...
    def sent(self, data: bytes, source: str) -> None: ...


class Link:
    """Runs tasks over one transport; `step` does a little of everything and is what the thread repeats."""

    def __init__(
        self, opener: Callable[[], Transport], line: LineSettings, owner: Owner, door: Door, clock: Callable[[], float]
    ) -> None:
        self._opener, self._line, self._owner, self.door, self._clock = opener, line, owner, door, clock
        self.transport: Transport | None = None
        self.wire = Wire()
        self.sure = False  # the controller is known to be in command mode
        self.record: deque[Traffic] = deque(maxlen=4000)
        self._numbers = itertools.count(1)
        self._incoming: deque[Task[Any]] = deque()
        self._ready: list[Task[Any]] = []
        self._current: Task[Any] | None = None
        self._holder: Task[Any] | None = None
        self._out, self.echo = Outgoing(line, clock), Echo()
        self._deadline = 0.0
        self._last_byte = 0.0
        self._told_rest = ""
        self._silences = 0
        self._noise = False  # something came that was no answer
        self._next_open = 0.0
        self._stop: Callable[[bool], Steps[bool]] | None = None
        self.last_words: Callable[[], bytes] = lambda: b""  # what ends a motion by hand when the line is closed
        self._closing = threading.Event()
        self._thread: threading.Thread | None = None

    # ------------------------------------------------------- for every thread

    def start(self) -> None:
        self._thread = threading.Thread(target=self._run, name="link", daemon=True)
        self._thread.start()

    @property
    def threaded(self) -> bool:
        """Whether a thread of its own serves the line."""
        return self._thread is not None

    @property
    def at_work(self) -> bool:
        """Whether something that a person began still goes on (for the link's own thread)."""
        return any(task.priority is not Priority.POLL and task.source != "poll" for task in self._ready)

    def close(self) -> None:
        self._closing.set()
        if self._thread is not None and self._thread is not threading.current_thread():
            self._thread.join(2.0)
        if self._thread is None:
            self._shut()

    def submit(self, steps: Steps[T], priority: Priority, source: str) -> Task[T]:
        task: Task[T] = Task(steps, priority, source)
        self._incoming.append(task)
        return task

    def stop(self, steps: Callable[[bool], Steps[bool]]) -> None:
        """Drops everything and runs these steps next; they are told whether the line is surely in command mode."""
        self._stop = steps

    # ------------------------------------------------------------ the thread

    def _run(self) -> None:
        clean = False
        try:
            while not self._closing.is_set():
                self.step()
            clean = True
        finally:
            if not clean:
                self._stop_motion_first()
            self._shut()

    def _stop_motion_first(self) -> None:
        """A fault of this program: motion ends before the fault is reported."""
        if self.transport is not None:
            with contextlib.suppress(TransportLost):
                self.transport.write(stop_bytes(False, chained=self._line.address is not None))
        self._owner.lost("The program failed inside; the controller was told to stop. Connect again.", refused=False)

    def _shut(self) -> None:
        """Leaves nothing half: a line begun becomes one the controller refuses, a transfer is ended."""
        if self.transport is not None:
            with contextlib.suppress(TransportLost):
                self.transport.write((b"\\\r" if self._out else b"") + (LEAVE if self._holder is not None else b""))
                say_last(self.transport, self.last_words(), self._clock)
        self._fail_all(LinkLost("The connection was closed."), survivors=False)
        if self.transport is not None:
            self.transport.close()
            self.transport = None

    def step(self) -> None:
        """Opens, reads, settles, sends: one round of at most a few milliseconds."""
        if self.transport is None and not self._open():
            return
        try:
            if self._stop is not None:
                self._begin_stop()
            self._flush()
            self._receive()
            self._out.new_round()
            while True:
                self._settle()
                self._start_next()
                self._flush()
                if not self._goes_on():
                    break
        except TransportLost as reason:
            self.drop(str(reason))

    def _goes_on(self) -> bool:
        """Lines that get no answer follow each other without a gap, but replies are looked for every 32 bytes."""
        step = self._current.step if self._current is not None else None
        return not self._out and isinstance(step, Send) and step.expect is None and self._out.room_in_round

    def _open(self) -> bool:
        while self._incoming:
            task = self._incoming.popleft()
            self._finish(task, LinkLost("There is no connection to a controller."))
        self._stop = None
        if self._clock() < self._next_open:
            self._closing.wait(0.01)
            return False
        try:
            self.transport = self._opener()
        except OpenFailed as reason:
            self._next_open = self._clock() + 1.0
            self._owner.lost(str(reason), refused=True)
            return False
        self.wire.forget()
        self._out.opened()
        self._silences, self.sure = 0, False
        self._owner.opened()
        return True

    def drop(self, sentence: str) -> None:
        """Closes a line that is gone; it is opened again by and by."""
        if self.transport is not None:
            self.transport.close()
            self.transport = None
        self._next_open = self._clock() + 0.5
        self._out.clear()
        self.sure = False
        self._fail_all(LinkLost(sentence), survivors=False)
        self._owner.lost(sentence, refused=False)

    def _begin_stop(self) -> None:
        stop, self._stop = self._stop, None
        assert stop is not None and self.transport is not None
        whole = not self._out and self._holder is None
        sure = self.sure and whole and self.transport.unsent() == 0
        self.transport.discard_output()
        self._out.discarded()
        self.wire.drop()
        self._fail_all(Stopped("Dropped: STOP was pressed."), survivors=True)
        self.sure = False
        task = self.submit(stop(sure), Priority.STOP, "stop")
        self._incoming.remove(task)
        self._admit(task)
        self._start_next()

    def _receive(self) -> None:
        assert self.transport is not None
        busy = self._out or self._current is not None
        data = self.echo.taken_from(self.transport.read(0.002 if busy else 0.005))
        now = self._clock()
        if data:
            self._last_byte, self._noise = now, True
            self.wire.feed(data)
            self._watch_bytes(data)
            step = self._current.step if self._current is not None else None
            if isinstance(step, Send) and step.extends:
                self._deadline = now + step.timeout_s
        for line in self.wire.left.lines():
            self.note("*", line, "program")
            self._owner.text(line)
        if unclear := self.wire.left.unclear():
            for line in unclear:
                self.note("<", line, "unclear")
            self._owner.unclear(unclear)
        rest = self.wire.left.rest
        if rest and rest != self._told_rest and now - self._last_byte >= PROMPT_QUIET_S:
            self._told_rest = rest
            self._owner.standing(rest)
        elif not rest:
            self._told_rest = ""

    def _watch_bytes(self, data: bytes) -> None:
        """A reply where none belongs ends a transfer at once (the controller is not taking lines any more)."""
        holder = self._holder
        step = holder.step if holder is not None else None
        if holder is not None and step is not None and any((b & 0x7F) in step.watch_for for b in data):
            self._out.clear()
            self._current = None
            if holder in self._ready:
                self._ready.remove(holder)
            self.wire.give_up()
            self._advance(holder, Answer(Kind.REFUSED, text=data.decode("ascii", "replace"), certain=False))

    def _settle(self) -> None:
        """Ends the present exchange when its answer or its time-out has come."""
        task = self._current
        if task is None or not isinstance(task.step, Send):
            return
        if task.step.expect is None:
            if not self._out:
                self._current = None
                self._advance(task, ANSWER)
            return
        answer = self.wire.answer()
        if answer is None:
            if self._out or (self._clock() < self._deadline and not self._seems_refused(task.step)):
                return
            answer = self.wire.give_up()
        self._silences = 0 if answer.kind is not Kind.SILENT else self._silences + 1
        self._noise &= self._silences > 1  # half an answer, cut off by a pulled cable, is none
        if isinstance(task.step.expect, Frame | Proof):
            self.echo.on = self.wire.left.echoed
        self.sure = answer.kind in (Kind.VALUES, Kind.ACCEPTED, Kind.REFUSED) and answer.certain
        self._current = None
        self._advance(task, answer)
        if self._silences >= SILENCES and not self.door.question:
            self._silences = 0
            self._owner.lost(NOISY if self._noise else SILENT, refused=False)
            self._noise = False

    def _seems_refused(self, step: Send) -> bool:
        """A `?` came and nothing after it; only a fence can tell whether it was the answer."""
        if not step.refusal_s or not self.wire.question:
            return False
        now = self._clock()
        chatty = now - (self._deadline - step.timeout_s) >= 5 * step.refusal_s
        return chatty or now - self._last_byte >= step.refusal_s

    def _start_next(self) -> None:
        while self._incoming:
            self._admit(self._incoming.popleft())
        now = self._clock()
        while self._current is None:
            if self._holder is not None:
                candidates = [self._holder] if self._holder in self._ready else []
            else:
                candidates = self._ready
            due = [task for task in candidates if task.due <= now]
            if not due:
                return
            task = min(due, key=lambda t: (t.priority, t.number))
            self._ready.remove(task)
            if isinstance(task.step, Wait):
                self._advance(task, ANSWER)
            else:
                self._transmit(task)

    def _admit(self, task: Task[Any]) -> None:
        task.number = next(self._numbers)
        if task.future.set_running_or_notify_cancel():
            self._advance(task, None)

    def _transmit(self, task: Task[Any]) -> None:
        step = task.step
        assert isinstance(step, Send)
        refusal = self.door.refusal(
            step.data,
            stop=task.priority is Priority.STOP,
            answer=step.answers_prompt,
            poll=task.priority is Priority.POLL,
            stored=step.stored,
            ends=step.stops,
        )
        if refusal:
            self._throw(task, NotAllowed(refusal))
            return
        self._current = task
        self._holder = task if step.hold else None
        self.echo.sent(step.data, transfer=step.hold and not isinstance(step.expect, Frame | Proof))
        self.wire.expect(step.expect, step.data.rstrip(b"\r").decode("ascii", "replace"))
        self._out.put(step.data)
        self._deadline = self._clock() + step.timeout_s
        if step.expect is None:
            self.sure = False
            if task.priority is Priority.STOP:
                for _ in range(step.data.count(b"\r")):
                    self.wire.left.owe(1)
        shown = step.data.decode("ascii", "replace").rstrip("\r")
        self.note(">", bare(shown) if task.source in ("user", "download") else shown, task.source)
        self._owner.sent(step.data, task.source)

    # ------------------------------------------------------------- the steps

    def _advance(self, task: Task[Any], value: Answer | None) -> None:
        self._go_on(task, partial(next, task.steps) if value is None else partial(task.steps.send, value))

    def _throw(self, task: Task[Any], error: LinkError) -> None:
        """Tells the steps; they may go on (polls do) or end with it."""
        self._go_on(task, partial(task.steps.throw, error))

    def _go_on(self, task: Task[Any], advance: Callable[[], Step]) -> None:
        try:
            step = advance()
        except StopIteration as done:
            self._release(task)
            task.future.set_result(done.value)
        except (LinkError, TransportLost) as error:
            self._finish(task, error)
        else:
            self._queue(task, step)

    def _queue(self, task: Task[Any], step: Step) -> None:
        task.step = step
        task.due = self._clock() + (step.seconds if isinstance(step, Wait) else 0.0)
        self._holder = task if step.hold else (None if self._holder is task else self._holder)
        self._ready.append(task)

    def _finish(self, task: Task[Any], error: Exception) -> None:
        self._release(task)
        task.steps.close()
        if not task.future.done():
            task.future.set_exception(error)

    def _release(self, task: Task[Any]) -> None:
        if self._holder is task:
            self._holder = None
        if self._current is task:
            self._current = None

    def _fail_all(self, error: LinkError, survivors: bool) -> None:
        tasks = [*self._ready, *self._incoming]
        if self._current is not None:
            tasks.append(self._current)
        self._ready, self._current, self._holder = [], None, None
        self._incoming.clear()
        for task in tasks:
            self._throw(task, error)
            if not survivors and task in self._ready:
                self._ready.remove(task)
                self._finish(task, error)

    # -------------------------------------------------------------- output

    def _flush(self) -> None:
        """Hands over what may leave; behind the last byte of a line its time begins."""
        task = self._current
        urgent = task is not None and task.priority is Priority.STOP
        whole = self.transport is not None and self._out.hand_over(self.transport, urgent)
        if whole and task is not None and isinstance(task.step, Send):
            self._deadline = self._out.clear_at + task.step.timeout_s

    def clear_rest(self) -> None:
        """The text that stands there is done with (its question was answered)."""
        self.wire.left.take_rest()
        self._told_rest = ""

    def note(self, direction: str, text: str, source: str) -> None:
        """One line for the terminal's traffic."""
        self.record.append(Traffic(next(self._numbers), self._clock(), direction, text, source))
