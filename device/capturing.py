"""Capturing over the link: arrays of our own, RA RD RC, the wait for a trigger, and reading out what was recorded.

A running program is not disturbed: its arrays keep their names and room, its own recording is never taken away, and
reading takes no more of the line than live values do. What has begun outlives STOP, which is worth recording.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from datetime import datetime
from typing import TYPE_CHECKING

import numpy as np

from codegen.models import Model
from codegen.twoletter.parse import parse
from device import live
from device.capture import Capture, Channel, Plan, Trigger, When, objection
from device.capture_room import Room
from device.capture_talk import ELEMENT_BYTES, LINE_S, NOT, Talk
from device.download import Job
from device.proof import tells
from device.quiet import allowed, recording
from device.tasks import LinkError, LinkLost, NotAllowed, Priority, Steps, data_line
from device.trigger import Turning, found_at, passed, watched
from device.wire import FRAME_COLUMNS, Kind, Shape, Upload, fitting

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from codegen.setup import Setup
    from device.api import Controller

STANDS_S = 0.2  # the pointer of a ring, beyond two intervals, before it is asked whether it records at all
SHORT_SHARE = 0.05  # of the whole; what is less than wanted from before a trigger by more is told
ELEMENT = re.compile(r"[ -][0-9]{10}\.[0-9]{4}")  # of QU while VF is 10.4; anything else is read framed


class CaptureJob(Job[Capture]):
    """A capture under way: how far, how long still, what there is of it, and two ways to end it."""

    def __init__(self, progress: Callable[[Job[Capture]], None] | None = None) -> None:
        super().__init__(progress)
        self.remaining_s = math.nan  # unknown while a trigger is waited for
        self.finished = False
        self.read_so_far: Callable[[], Capture | None] = lambda: None

    def finish(self) -> None:
        """Ends the recording now, and reads what was recorded (`cancel`: keeps only what has been read)."""
        self.finished = True

    def partial(self) -> Capture | None:
        """What has been read so far (NaN elsewhere); also after a failure."""
        return self.read_so_far()


def capture(
    c: Controller,
    plan: Plan,
    progress: Callable[[Job[Capture]], None] | None = None,
    setup: Setup | None = None,
    note: str = "",
) -> CaptureJob:
    """Starts a capture; needs Control, because it writes arrays in the controller."""
    job = CaptureJob(progress)

    def steps() -> Steps[Capture]:
        with recording(c, "a capture is under way. Wait for its end, or cancel it.", NOT):
            return (yield from capture_steps(c, plan, job, setup, note))

    job.future = c.run(steps(), Priority.DOWNLOAD, "download")
    return job


def capture_steps(
    c: Controller,
    plan: Plan,
    job: CaptureJob,
    setup: Setup | None = None,
    note: str = "",
    during: Callable[[], Steps[None]] | None = None,
) -> Steps[Capture]:
    """As `capture`, as part of a longer task; `during` runs right after the recording has begun, before any reading.

    The arrays are given back whatever is thrown into it, except where the line is lost.
    """
    under_way = Recording(c, plan, job, setup, note)
    under_way.during = during
    try:
        done = yield from under_way.steps()
    except LinkLost:
        raise
    except LinkError:
        yield from under_way.room.clean()
        raise
    yield from under_way.room.clean()
    return done


class Recording:
    """One capture as steps for the link."""

    def __init__(self, c: Controller, plan: Plan, job: CaptureJob, setup: Setup | None, note: str) -> None:
        self._c, self._plan, self._job, self._setup, self._note = c, plan, job, setup, note
        self._talk = Talk(c)
        self.room = Room(c, plan, self._talk)
        self._start = 0.0
        self._quick = True
        self._element_s = ELEMENT_BYTES * c.line.byte_s
        self._read = 0
        self._values: NDArray[np.float64] = np.full((len(plan.channels), 0), np.nan)
        self._trigger, self._early = 0, 0
        self._when = ""
        self._judged, self._sends = "", False  # a listing, and whether it sends text
        self._ended = False  # by us, before its time
        self._whole = True  # nothing ended it before the trigger came and enough was recorded
        self._before: float | None = None
        self._armed = False  # by how the trigger's signal was before the recording began
        self._trigger_text = plan.trigger.text
        self.during: Callable[[], Steps[None]] | None = None

    # ------------------------------------------------------------------ the whole

    def steps(self) -> Steps[Capture]:
        c, plan, job = self._c, self._plan, self._job
        job.show("preparing", 0, 1000)
        model = self._allowed()
        yield from self.room.prepare(model)
        self._when = datetime.now().isoformat(sep=" ", timespec="seconds")
        self._values = np.full((len(plan.channels), plan.count), np.nan)
        job.read_so_far = self.partial
        ring = plan.trigger.when is not When.NOW
        line = f"RC {plan.exponent},{-plan.count if ring else plan.count}" + (f";{plan.go}" if plan.go else "")
        if len(line) + 1 + FRAME_COLUMNS > model.columns:
            raise NotAllowed(f"{NOT}: “{plan.go}” is too long to start with the recording.")
        if ring:
            yield from self._arm()
        self.room.began = True
        yield from self._talk.must(line)
        self._start = c.clock()
        if self.during is not None:
            yield from self.during()
        yield from self._ring(model) if ring else self._line()
        if not self._read:
            raise LinkError("Capture cancelled before anything was read.")
        yield from self._same_time()
        return self._captured(complete=self._whole and self._read == self._values.shape[1] == plan.count)

    def _same_time(self) -> Steps[None]:
        """All times are worked out from TM; where it was changed meanwhile the record says so."""
        (tm,) = yield from self._talk.numbers(("_TM", Shape(5, 0)), keep=True)
        if tm != self.room.tm:
            words = f"TM was changed from {self.room.tm:g} to {tm:g} while this was recorded: its times are not right."
            self._note = f"{self._note} {words}".strip()

    def partial(self) -> Capture | None:
        """What there is by now."""
        return self._captured(complete=False) if self._read else None

    def _captured(self, complete: bool) -> Capture:
        c, plan = self._c, self._plan
        return Capture(
            channels=plan.channels,
            values=self._values[:, : self._read].copy(),
            exponent=plan.exponent,
            tm=self.room.tm,
            trigger=self._trigger,
            early=self._early,
            trigger_text=self._trigger_text,
            model=c.model.name if c.model is not None else "",
            controller=c.who,
            when=self._when,
            setup=self._setup,
            complete=complete,
            note=self._note,
        )

    # ----------------------------------------------------------------- preparing

    def _allowed(self) -> Model:
        model = allowed(self._c, NOT)
        problem = objection(self._plan, model)
        if problem:
            raise NotAllowed(f"{NOT}: {problem}")
        return model

    # ----------------------------------------------------------- a start at once

    def _line(self) -> Steps[None]:
        """Elements are read while more are recorded, so that the picture grows."""
        plan, job, interval = self._plan, self._job, self._plan.interval_s(self.room.tm)
        while self._read < self._values.shape[1] and not job.cancelled:
            records, index = yield from self._talk.numbers(("_RC", Shape(1, 0)), ("_RD", Shape(4, 0)), keep=True)
            if job.finished and records:
                self._ended = True
                yield from self._talk.must("RC 0", keep=True)
                continue
            self._ours(index)
            ready = int(index) if records else self._recorded(int(index), interval)
            if not records and ready < self._values.shape[1]:
                self._values = self._values[:, :ready]
            chunk = self._talk.chunk()
            if ready - self._read >= min(chunk, self._values.shape[1] - self._read) > 0:
                yield from self._read_on(list(range(self._read, min(ready, self._read + chunk))))
            elif records:
                self._tell("recording", max(plan.count - int(index), 0) * interval)
                yield from self._talk.pause(min(max((self._read + chunk - index) * interval, 0.02), 0.2))

    def _ours(self, index: float) -> None:
        """The pointer lies in our arrays; LinkError where somebody has begun another recording since."""
        if index > self._plan.count:
            raise LinkError("Capture ended: somebody else has begun another recording in the controller.")

    def _recorded(self, index: int, interval: float) -> int:
        """How many elements a recording that has ended holds: all, or fewer where somebody ended it early."""
        whole = self._c.clock() - self._start >= (self._plan.count - 1) * interval
        return self._plan.count if whole and not self._ended else index

    # ---------------------------------------------------------------- a trigger

    def _ring(self, model: Model) -> Steps[None]:
        """Records round and round until the trigger came and enough behind it; then reads the ring, oldest first."""
        plan, trigger = self._plan, self._plan.trigger
        turning = Turning(plan.count, plan.interval_s(self.room.tm), self._start)
        bracket = yield from self._wait_for(trigger, turning)
        if bracket is None and self._job.cancelled:
            return
        if bracket is not None:
            yield from self._record_behind(bracket, turning)
        yield from self._talk.must("RC 0", keep=True)
        (index,) = yield from self._talk.numbers(("_RD", Shape(4, 0)), keep=True)
        self._ours(index)
        order = turning.order(int(index), self._c.clock())
        self._values = self._values[:, : len(order)]
        oldest = turning.total - len(order)
        if bracket is not None:
            self._trigger = min(max(bracket[1] - oldest, 0), len(order) - 1)
            self._early = min(bracket[1] - bracket[0], self._trigger)
        else:  # all of it is from before
            self._whole, self._trigger = False, len(order)
            self._trigger_text = f"ended before it came ({trigger.text})"
        while self._read < len(order) and not self._job.cancelled:
            end = min(len(order), self._read + self._talk.chunk())
            stretch = order[self._read : end]
            if 0 in stretch[1:]:
                stretch = stretch[: stretch.index(0, 1)]
            yield from self._read_on(stretch)
        if bracket is not None and not self._job.cancelled:
            self._trigger, self._early = found_at(
                trigger, plan.channels, self._values, self._trigger - self._early, self._trigger
            )
            self._tell_share(self._trigger, oldest)

    def _tell_share(self, kept: int, lost: int) -> None:
        """Fewer values from before the trigger than wanted: it came early, or the line was slow to end a short ring."""
        count, wanted = self._plan.count, self._plan.trigger.pre
        if kept < (wanted - SHORT_SHARE) * count and not self._job.finished:
            why = f"a ring of {count} turns too fast for this line; take more values, or a longer interval."
            words = f"Only {kept} values are from before the trigger, {wanted * count:.0f} were wanted: "
            self._note = f"{self._note} {words}{why if lost else 'it came sooner.'}".strip()

    def _arm(self) -> Steps[None]:
        """What is true before the recording begins is no trigger; what changes from then on is one."""
        trigger = self._plan.trigger
        for _ in range(2):  # a position says only with the second reading whether it stands
            (value,) = yield from self._talk.numbers(live.expression(watched(trigger)))
            _, self._armed = passed(trigger, self._before, value, False)
            self._before = value

    def _goes_on(self, turning: Turning) -> Steps[bool]:
        """Whether it still records: its pointer stands for long only where somebody else ended it (RC 0)."""
        if self._c.clock() - turning.changed < 2 * self._plan.interval_s(self.room.tm) + STANDS_S:
            return True
        (records,) = yield from self._talk.numbers(("_RC", Shape(1, 0)), keep=True)
        turning.changed = self._c.clock()
        self._whole = self._whole and bool(records)
        return bool(records)

    def _wait_for(self, trigger: Trigger, turning: Turning) -> Steps[tuple[int, int] | None]:
        """Elements between which the trigger came, counted from the start; None when it was not waited for longer."""
        expression, shape = live.expression(watched(trigger))
        before, armed = self._before, self._armed
        last, earlier = 0, 0
        while not (self._job.cancelled or self._job.finished):
            self._tell(f"waiting: {trigger.text}", math.nan)
            value, index = yield from self._talk.numbers((expression, shape), ("_RD", Shape(4, 0)), keep=True)
            total = turning.count_on(int(index), self._c.clock())
            came, armed = passed(trigger, before, value, armed)
            if came:
                return earlier, total
            if not (yield from self._goes_on(turning)):
                return None
            earlier, last, before = last, total, value
            yield from self._talk.breathe()
        return None

    def _record_behind(self, bracket: tuple[int, int], turning: Turning) -> Steps[None]:
        """Until the ring holds the wanted share from behind the trigger."""
        plan, interval = self._plan, self._plan.interval_s(self.room.tm)
        spare = min(plan.count // 4, bracket[1] - bracket[0] + math.ceil(0.05 / interval))
        goal = bracket[1] + max(1, round(plan.count * (1 - plan.trigger.pre)) - spare)
        while turning.total < goal and not (self._job.cancelled or self._job.finished):
            left = (goal - turning.total) * interval
            self._tell("recording", left)
            yield from self._talk.pause(min(max(left - 0.02, 0.005), 0.2))
            (index,) = yield from self._talk.numbers(("_RD", Shape(4, 0)), keep=True)
            turning.count_on(int(index), self._c.clock())
            if not (yield from self._goes_on(turning)):
                return

    # ------------------------------------------------------------------- reading

    def _read_on(self, elements: list[int]) -> Steps[None]:
        """The next stretch of every channel."""
        start, first, count = self._c.clock(), self._read, len(elements)
        for row, (name, channel) in enumerate(zip(self.room.names, self._plan.channels, strict=True)):
            values = yield from self._elements(name, elements, channel)
            self._values[row, first : first + count] = np.asarray(values) * channel.row.scale
        self._read += count
        took = (self._c.clock() - start) / (count * len(self.room.names))
        self._element_s += (took - self._element_s) / 4 if first else took - self._element_s
        unread = (self._values.shape[1] - self._read) * len(self.room.names) * self._element_s
        recorded = self._start + self._plan.count * self._plan.interval_s(self.room.tm)
        behind = recorded - self._c.clock() if self._plan.trigger.when is When.NOW else 0.0
        self._tell("reading" if behind <= 0 else "recording", max(unread, behind))

    def _elements(self, name: str, elements: Sequence[int], channel: Channel) -> Steps[list[float]]:
        """By QU where its format keeps numbers whole and no program's text can come between, else each framed."""
        if self._quick and (not self._talk.programs_run() or self._silent()):
            line = f"QU {name}[],{elements[0]},{elements[-1]},1"
            answer = yield from self._talk.exchange(data_line(line), Upload(), LINE_S, keep=True)
            if answer.kind is Kind.REFUSED:
                raise LinkError(f"Capture ended: the controller has no {name} any more (was it reset?).")
            texts = answer.text.strip("\r\n").split(",")
            if len(texts) == len(elements) and all(map(ELEMENT.fullmatch, texts)):
                yield from self._talk.breathe()
                return [float(text.replace(" ", "")) for text in texts]
            yield from self._talk.fence()
            self._quick = answer.kind is not Kind.ACCEPTED  # the person's VF is another one, or a program's text
        found: list[float] = []
        shape = Shape(10, 4 if channel.row.dimension == "voltage" and channel.row.scale == 1.0 else 0)
        columns = self._c.model.columns if self._c.model is not None else 40
        for reads in fitting([(f"{name}[{each}]", shape) for each in elements], columns):
            found += yield from self._talk.numbers(*reads, keep=True)
            yield from self._talk.breathe()
        return found

    def _silent(self) -> bool:
        """Whether the program in the controller is known to send nothing."""
        listing = self._c.listing
        if listing is None:
            return False
        if listing != self._judged:
            lines = parse(listing).lines
            self._judged, self._sends = listing, any(tells(each) for line in lines for each in line.statements)
        return not self._sends

    def _tell(self, phase: str, remaining_s: float) -> None:
        job, spent = self._job, self._c.clock() - self._start
        job.remaining_s = remaining_s
        whole = spent + remaining_s
        job.show(phase, 0 if math.isnan(whole) or whole <= 0 else round(1000 * spent / whole), 1000)
