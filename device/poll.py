"""What to ask and how often, from what is watched.

While a program runs at most 30 % of the line and little of the interpreter's time; while none runs most of the line;
all of it where a panel asked for that.
"""

from __future__ import annotations

import math
from collections import Counter, deque
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from typing import TypeAlias

from device import live
from device.ring import EMPTY, Ring
from device.tasks import NotAllowed, Send, Step, Stopped, Wait
from device.transport import LineSettings
from device.wire import FRAME_COLUMNS, Answer, Frame, Kind, Shape, framed

SHARE = 0.30  # of the line's time, in the busier direction, while a program runs
LEAST_S = 0.025  # between requests: one command takes 0.5 ms, so 2 % of the interpreter
IDLE_SHARE = 0.80  # of the time in which characters travel either way, while no program runs
IDLE_LEAST_S = 0.012
TURN = 3  # rounds of the quick values to one line of others
SEEN_MOVING = (live.AT, "velocity")
SOONER = 4  # times, what is seen to move has its turn
JITTER = 2  # counts, of an axis that is held
SLOW_S = 1.0  # period of values that change rarely
ALWAYS = ("thread0", "thread1", "thread2", "thread3", "time")
REFUSALS = 3  # a value refused this often is not asked again

Request: TypeAlias = list[tuple[str, str, Shape]]  # key, expression, shape
PollSteps: TypeAlias = Generator[Step, Answer, None]


def requests(keys: Sequence[str], columns: int) -> list[Request]:
    """The fewest lines of at most so many columns that read these keys; what is of one moment is in one line."""
    lines: list[Request] = []
    room = 0
    for unit in _units(keys):
        reads = [(key, *live.expression(key)) for key in unit]
        cost = _cost(reads, lines[-1] if lines else [])
        if not lines or cost > room:
            lines.append([])
            room, cost = columns - FRAME_COLUMNS, _cost(reads, [])
        lines[-1] += reads
        room -= cost
    return lines


def _units(keys: Sequence[str]) -> Iterator[tuple[str, ...]]:
    """The keys in their order; an error, and the places it is the difference of, as one."""
    for key in keys:
        _, axis = live.split(key)
        whole = tuple(live.key(name, axis) for name in live.TOGETHER)
        if key not in whole or whole[-1] not in keys:
            yield (key,)
        elif key == whole[-1]:
            yield whole


def _cost(reads: Request, line: Request) -> int:
    """Columns that these take in a line; what is read there already takes none."""
    there = {expression for _, expression, _ in line}
    return sum(1 + len(text) + len(shape.format) for _, text, shape in reads if text not in there)


def _with(wishes: dict[str, tuple[str, ...]], owner: str, keys: Iterable[str]) -> dict[str, tuple[str, ...]]:
    """The wishes of all with another one of one owner; an empty one is none."""
    return {name: value for name, value in {**wishes, owner: tuple(keys)}.items() if value}


class Poller:
    """Reads what is watched, for ever, at the pace the line allows; `run` is its task."""

    def __init__(
        self,
        line: LineSettings,
        clock: Callable[[], float],
        nonces: Iterator[str],
        suspended: Callable[[], str],
        read: Callable[[dict[str, float], float], None],
        idle: Callable[[], bool],
    ) -> None:
        self.ring = Ring(())
        self.columns = 80
        self.brief = 0  # fewer columns while somebody holds an axis: a release must not wait for a long read
        self.rate_hz = 0.0
        self.line_share = 0.0  # of the time in which characters of polls travel
        self.hurry = False  # as fast as the line can, whatever a program loses by it
        self._line, self._clock, self._nonces = line, clock, nonces
        self._suspended, self._read, self._idle = suspended, read, idle
        self._rounds = 0
        self._wanted: dict[str, tuple[str, ...]] = {}
        self._drawn: dict[str, tuple[str, ...]] = {}  # read in every round, because they are drawn as curves
        self._refused: Counter[str] = Counter()
        self._asked: dict[str, float] = {}  # when each value was asked for
        self._moved: set[str] = set()  # values of axes that are not where they were a round ago
        self._always_due = 0.0
        self._answered = False
        self._cycles: deque[float] = deque(maxlen=8)

    def watch(self, owner: str, keys: Iterable[str], each_round: Iterable[str] = ()) -> None:
        """What one owner needs now, some of it in every round; nothing ends its wish. Callable from any thread."""
        self._wanted = _with(self._wanted, owner, keys)
        self._drawn = _with(self._drawn, owner, each_round)

    def set_columns(self, names: Sequence[str]) -> None:
        """Which values this controller has; the ring starts afresh."""
        self.ring = Ring(names)
        self._refused.clear()

    def wanted(self) -> tuple[str, ...]:
        """The union of what is watched, as far as it exists here."""
        asked = {key for keys in list(self._wanted.values()) for key in keys}
        return tuple(key for key in self.ring.columns if key in asked and self._refused[key] < REFUSALS)

    def run(self) -> PollSteps:
        """The task: cycles of requests, each followed by the rest it owes the line."""
        while True:
            start, self._answered = self._clock(), False
            lines = [] if self._suspended() else self._due(start)
            if not lines:
                yield from self._rest(0.05)
                if self._suspended():
                    self.rate_hz = self.line_share = 0.0
                continue
            for request in lines:
                if self._suspended():
                    break
                yield from self._one(request)
            if self._answered:  # waiting for a dead controller is no pace: what it said last gets old meanwhile
                self._measure(start)

    def _due(self, now: float) -> list[Request]:
        """This round: the quick values, filled up with others in turn, and one line of others more.

        Once a second the threads and the clock, together, because they tell whether something may ask.
        """
        wanted, idle = self.wanted(), self._idle()
        rows = {key: live.split(key)[0] for key in wanted}
        first = tuple(dict.fromkeys(key for keys in list(self._drawn.values()) for key in keys if key in rows))
        quick = first
        if not (first and self.hurry):  # else the others have their turn with what may wait
            quick += tuple(k for k, row in rows.items() if k not in first and row.quick and not (row.slow and idle))
        others = [key for key in wanted if key not in quick and self._is_due(key, now)]
        others.sort(key=lambda key: (self._asked.get(key, -math.inf) - now) * (SOONER if key in self._moved else 1))
        columns = self.brief or self.columns
        self._rounds += 1
        more = 0 if quick and self._rounds % TURN else 1
        lines = requests((*quick, *others), columns)[: len(requests(quick, columns)) + more]
        self._asked.update({key: now for line in lines for key, _, _ in line})
        if now >= self._always_due and not (self.brief and idle):  # a hold ends by itself where the controller restarts
            self._always_due = now + SLOW_S
            always = tuple(key for key in ALWAYS if key in self.ring.columns)
            lines += requests(always, self.columns)
            self._asked.update(dict.fromkeys(always, now))
        return lines

    def _is_due(self, key: str, now: float) -> bool:
        return not live.split(key)[0].slow or now - self._asked.get(key, -SLOW_S) >= SLOW_S

    def _one(self, request: Request) -> PollSteps:
        nonce = next(self._nonces)
        reads = list(dict.fromkeys((expression, shape) for _, expression, shape in request))
        shapes = tuple(shape for _, shape in reads)
        text = framed(nonce, reads)
        start = self._clock()
        try:
            answer = yield Send(
                text.encode() + b"\r", Frame(nonce, shapes), 0.4 + 60 * self._line.byte_s, refusal_s=0.04
            )
        except Stopped:
            return
        except NotAllowed:
            yield from self._rest(0.05)
            return
        now = self._clock()
        if answer.kind is Kind.VALUES:
            self._answered = True
            came = dict(zip((expression for expression, _ in reads), answer.values, strict=True))
            values = {key: came[expression] for key, expression, _ in request}
            self._look_who_moved(values)
            self.ring.write(values, now, keep=self.wanted() + ALWAYS)
            self._read(values, start)
        elif answer.kind is Kind.UNCERTAIN and "?" in answer.text:
            yield from self._find_refused(request)
        out, back = len(text) + 1, sum(shape.width for shape in shapes) + 7
        yield from self._rest(self._pause(out, back, self._clock() - start))
        travelled = (out + back) * self._line.byte_s
        self.line_share += (travelled / max(self._clock() - start, travelled, 1e-6) - self.line_share) / 8

    def _look_who_moved(self, values: dict[str, float]) -> None:
        last = self.ring.last() if self.ring.columns else EMPTY
        for key, value in values.items():
            row, axis = live.split(key)
            if row.name == "position":
                moved = abs(value - last.value(key)) > JITTER
                (self._moved.update if moved else self._moved.difference_update)(live.key(n, axis) for n in SEEN_MOVING)

    def _pause(self, out: int, back: int, took: float) -> float:
        """Seconds to leave the line to others after an exchange of so many characters."""
        byte_s = self._line.byte_s
        if self.hurry:
            return 0.0
        if self._idle():
            whole = max((out + back) * byte_s / IDLE_SHARE, IDLE_LEAST_S)
        else:
            whole = max(max(out, back) * byte_s / SHARE, LEAST_S)
        return max(whole - took, 0.001)

    def _find_refused(self, request: Request) -> PollSteps:
        """One value of the line may be unknown here: ask singly, and stop asking what is refused."""
        if len(request) == 1:
            self._refused[request[0][0]] += 1
            return
        for single in request:
            yield from self._one([single])

    def _rest(self, seconds: float) -> PollSteps:
        try:
            yield Wait(seconds)
        except Stopped:
            return

    def _measure(self, start: float) -> None:
        """How often the quick ones come, and how long it takes until all have been read."""
        self._cycles.append(max(self._clock() - start, 1e-6))
        period = sum(self._cycles) / len(self._cycles)
        self.rate_hz = 1.0 / period
        self.ring.period_s, self.ring.turn_s = period, period * len(requests(self.wanted(), self.columns)) * TURN / 2
