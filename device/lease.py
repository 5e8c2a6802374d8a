"""Hold-to-run: a lease that ends by itself, over a move that ends by itself.

On the controller it is a relative move of at most speed × 0.4 s and the stopping distance ahead of where the axis is
commanded to be. While the lease is renewed IP lengthens it, in the same direction only; so a dead computer or a
pulled cable ends in a normal deceleration. IP starts a new move where the axis stands (SSC manual l.2148) and steps
a jog (l.2156), so it travels as `IP n*_BGX`: nothing happens where the move has ended meanwhile.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field

from codegen.twoletter.problems import ERROR_TEXTS, STOP_TEXTS
from device.identify import fence, read_once, read_surely
from device.proof import with_proof
from device.tasks import LinkError, NotAllowed, Send, Steps, Wait
from device.wire import FRAME_COLUMNS, Answer, Frame, Kind, Shape, fitting, framed

LEASE_S = 0.15  # not renewed for so long: the axis is stopped
AHEAD_S = 0.4  # of travel, and the stopping distance, are commanded at most
EXTEND_S = 0.08  # between two lengthenings
ANSWER_S = 0.25  # beyond the time on the line
STOP_TRIES = 3
LOOK_S = 0.02  # between two looks whether a move has ended
LINE_S = 0.11  # the slowest exchange of a lengthening; on a slower line the move would end before it is lengthened
EXCHANGE = 82  # characters of it, there and back
REPLY = 18  # characters of a reading at least
AT_TARGET = 1  # stop code of a move that came to its end
OUT_OF_RANGE = 6  # also of a target beyond FL or BL, on controllers that refuse it (dmc-1412-1414.txt l.4137)
LIMIT_NEAR = "its software limit (FL, BL) is near; move on by increments."
START_STEPS = {
    OUT_OF_RANGE: f"A number is out of range, or {LIMIT_NEAR}",
    20: "Switch the motor on (SH) first.",
    22: "Move away from the limit switch, in the other direction.",
}
COUNTS, FLAG, CODE = Shape(10, 0), Shape(1, 0), Shape(3, 0)


@dataclass(frozen=True, slots=True)
class Standing:
    """An axis before it is moved by hand."""

    place: int  # commanded position, counts
    period: int | None  # TM; None with an external clock, which is taken as the usual one
    former: tuple[int, ...]  # SP, AC, DC


@dataclass(frozen=True, slots=True)
class Exchange:
    """What steps of a moving axis need of the link."""

    clock: Callable[[], float]
    nonces: Iterator[str]
    columns: int
    byte_s: float

    def patience(self, characters: int) -> float:
        """Seconds to wait for an answer to so many characters, there and back."""
        return ANSWER_S + characters * self.byte_s

    def prove(self, command: str, stops: bool = False) -> Steps[Answer]:
        """One line and the proof that it was accepted; a refusal ends the wait early."""
        line, proof = with_proof(next(self.nonces), command)
        return (yield Send(line, proof, self.patience(len(line) + 12), refusal_s=0.04, stops=stops))

    def put_back(self, commands: Sequence[str]) -> Steps[None]:
        """Speeds and ramps as they were; not where Watch or a question forbids it meanwhile."""
        with suppress(NotAllowed):
            for line in self.packed(commands):
                yield from self.prove(line)

    def read(self, *reads: tuple[str, Shape]) -> Steps[tuple[float, ...] | None]:
        """Framed reads in as few lines as fit; None where one was not answered twice."""
        values: list[float] = []
        for line in fitting(reads, self.columns):
            answer = yield from read_surely(self.nonces, *line)
            if answer.kind is not Kind.VALUES:
                return None
            values += answer.values
        return tuple(values)

    def standing(self, axis: str) -> Steps[Standing]:
        """An axis that is to be moved by hand; NotAllowed where it moves already or its motor is off."""
        reads = [(f"_{name}{axis}", Shape(8, 0)) for name in ("SP", "AC", "DC")]
        flags = [(f"_{name}{axis}", FLAG) for name in ("BG", "MO")]
        values = yield from self.read(*flags, (f"_RP{axis}", COUNTS), ("_TM", Shape(5, 0)), *reads)
        if values is None:
            raise LinkError(f"Axis {axis} did not start: the controller did not answer.")
        moving, off, place, period, *former = (int(value) for value in values)
        if moving:
            raise NotAllowed(f"Axis {axis} moves already; stop it first.")
        if off:
            raise NotAllowed(f"Axis {axis} did not start: its motor is off. Switch it on (SH) first.")
        return Standing(place, period if period > 0 else None, tuple(former))

    def packed(self, commands: Sequence[str]) -> list[str]:
        """The commands in as few lines as leave room for their proof."""
        lines: list[str] = []
        for command in commands:
            if lines and len(lines[-1]) + 2 + len(command) + FRAME_COLUMNS <= self.columns:
                lines[-1] += f";{command}"
            else:
                lines.append(command)
        return lines

    def code(self) -> Steps[int]:
        """The error code that the last refusal left; 0 where it is not told."""
        answer = yield from fence(self.nonces)
        return int(answer.values[0]) if answer.kind is Kind.VALUES else 0


@dataclass(frozen=True, slots=True)
class Ran:
    """How a hold ended: where the axis stands, and how far and how long it ran on after it was let go."""

    axis: str
    place: int  # commanded position, counts
    run_on: int  # counts
    seconds: float
    sentence: str


def at(axis: str, value: object) -> str:
    """A number at the place of its axis: `,,500` for Z."""
    return "," * "XYZW".index(axis) + str(value)


def ramps_of(axis: str, former: Sequence[int]) -> list[str]:
    """What sets SP, AC and DC of an axis; nothing where they are not known."""
    return [f"{name} {at(axis, value)}" for name, value in zip(("SP", "AC", "DC"), former, strict=False)]


def not_started(code: int) -> str:
    """Why a start by hand was refused, and what to do."""
    return f"error {code}, {ERROR_TEXTS.get(code, 'unknown error')}. {START_STEPS.get(code, 'Is the way free?')}"


def ended(axis: str, code: int) -> str:
    """Why an axis stands, from its stop code, as one sentence."""
    return f"Axis {axis}: {STOP_TEXTS.get(code, f'stop code {code}')}."


@dataclass
class Lease:
    """One axis moving while somebody holds on; `renew` is called every 50 ms by the one who holds.

    Speed and ramps are what SP, AC and DC take; `period` (TM) is read at the start, `latched` is a jog that needs no
    renewal.
    """

    axis: str
    speed: int  # with the sign of the direction
    acceleration: int
    deceleration: int
    exchange: Exchange
    period: float = 1000.0
    latched: bool = False
    resting: Callable[[], str] = lambda: ""
    owner: str = ""
    renewed: float = 0.0
    released_at: float | None = None
    target: int = 0  # where the move ends by itself
    _place: int = 0  # commanded position when it was read last
    _seen: float = 0.0
    _velocity: float = 0.0  # measured, counts/s
    _reason: str = ""  # why it cannot be lengthened
    _former: tuple[int, ...] = field(default=())

    # ------------------------------------------------------- for every thread

    def renew(self) -> None:
        """Goes on holding; a lease that has lapsed is not taken up again, whoever wakes late has to press again."""
        if self.held:
            self.renewed = self.exchange.clock()

    def release(self) -> None:
        """Lets go."""
        if self.released_at is None:
            self.released_at = self.exchange.clock()

    @property
    def held(self) -> bool:
        if self.released_at is not None:
            return False
        return self.latched or self.exchange.clock() - self.renewed < LEASE_S

    @property
    def true_speed(self) -> float:
        """Counts in a true second; SP counts 1024 samples (commands.md, TM)."""
        return abs(self.speed) * 1000.0 / self.period

    @property
    def stopping_s(self) -> float:
        """How long the deceleration takes."""
        return self.true_speed / (self.deceleration * (1000.0 / self.period) ** 2)

    @property
    def ahead(self) -> int:
        """Counts that may lie ahead: speed × 0.4 s and the stopping distance."""
        return int(self.true_speed * (AHEAD_S + self.stopping_s / 2))

    @property
    def ghost(self) -> int:
        """Where the axis comes to stand when it is let go now, counts."""
        return self._now(self.exchange.clock()) + self._signed(int(self._velocity * self.stopping_s / 2))

    # ------------------------------------------------------------ on the link

    def steps(self) -> Steps[Ran]:
        """Starts, lengthens while held, stops, puts speed and ramps back; ends when the axis stands."""
        try:
            yield from self._meet()
            if self.held:
                yield from self._start()
            sentence = yield from (self._watch() if self.latched else self._keep_ahead())
        except NotAllowed as reason:
            if self.latched and self._seen and self.resting():
                raise StopNeeded(str(reason)) from reason
            raise
        let_go = self.released_at or (self.exchange.clock() if sentence or self.latched else self.renewed)
        self.release()
        if not sentence:
            yield from self._stop()
        return (yield from self._stand(let_go, sentence))

    @property
    def as_before(self) -> list[str]:
        """What sets speed and ramps as they were; nothing where they were not read yet."""
        return ramps_of(self.axis, self._former)

    def _signed(self, counts: int) -> int:
        return counts if self.speed >= 0 else -counts

    def _now(self, now: float) -> int:
        """Where it is commanded to be by now at least: from the last reading, at the speed measured before it."""
        way = min(self._velocity, self.true_speed) * max(now - self._seen, 0.0) if self._seen else 0.0
        place = self._place + self._signed(int(way))
        if self.latched:
            return place
        return max(min(place, self.target), self._place) if self.speed >= 0 else min(max(place, self.target), place)

    def _meet(self) -> Steps[None]:
        """Where the axis is, that it stands, how long a sample is, and what SP, AC and DC are."""
        standing = yield from self.exchange.standing(self.axis)
        self._former = standing.former
        self.period = float(standing.period or self.period)
        self._place = self.target = standing.place

    def _start(self) -> Steps[None]:
        wanted = {"AC": self.acceleration, "DC": self.deceleration, "SP": abs(self.speed)}
        before = dict(zip(("SP", "AC", "DC"), self._former, strict=True))
        commands = [f"{name} {at(self.axis, value)}" for name, value in wanted.items() if before[name] != value]
        if self.latched:
            commands = [each for each in commands if not each.startswith("SP")] + [f"JG {at(self.axis, self.speed)}"]
        else:
            commands.append(f"PR {at(self.axis, self._signed(self.ahead))}")
        *first, last = self.exchange.packed([*commands, f"BG {self.axis}"])
        for line in first:
            if not self.held:
                return
            yield from self._accepted(line)
        if self.held:
            began = self.exchange.clock()
            self.target = self._place + self._signed(self.ahead)
            self._seen = began
            yield from self._accepted(last)

    def _accepted(self, line: str) -> Steps[None]:
        answer = yield from self.exchange.prove(line)
        if answer.kind is not Kind.ACCEPTED:
            code = yield from self.exchange.code()
            yield from self._stop()
            raise LinkError(f"Axis {self.axis} did not start: {not_started(code)}")

    def _keep_ahead(self) -> Steps[str]:
        """Lengthens the move while held; ends with nothing, or with why the axis ended by itself."""
        extended = self.exchange.clock()
        while self.held:
            yield Wait(0.01)
            now = self.exchange.clock()
            if not self.held or now - extended < EXTEND_S:
                continue
            if self.resting():
                raise NotAllowed(f"The hold of axis {self.axis} ended: {self.resting()}")
            extended = now
            missing = self._now(now) + self._signed(self.ahead) - self.target
            moving = yield from self._lengthen(missing if missing * self.speed > 0 else 0)
            if not moving:
                return (yield from self._by_itself())
        return ""

    def _lengthen(self, counts: int) -> Steps[bool]:
        """IP and a reading of where the axis is; whether it still moves."""
        reads = ((f"_RP{self.axis}", COUNTS), (f"_BG{self.axis}", FLAG))
        command = f"IP {at(self.axis, f'{counts}*_BG{self.axis}')}" if counts else ""
        line = f"{command};{framed('xx', reads)}" if counts else framed("xx", reads)
        if len(line) <= self.exchange.columns:
            nonce = next(self.exchange.nonces)
            data = line.replace('"xx"', f'"{nonce}"').encode() + b"\r"
            shapes = tuple(shape for _, shape in reads)
            frame = Frame(nonce, shapes, before=1 if counts else 0)
            answer = yield Send(data, frame, self.exchange.patience(len(data) + 24), refusal_s=0.04)
            values = answer.values if answer.kind is Kind.VALUES else None
        else:
            answer = yield from self.exchange.prove(command)
            values = (yield from self._read_singly(reads)) if answer.kind is Kind.ACCEPTED else None
        if values is None:
            return (yield from self._not_lengthened(answer))
        self.target += counts
        self._saw(int(values[0]))
        return bool(values[1])

    def _read_singly(self, reads: Sequence[tuple[str, Shape]]) -> Steps[tuple[float, ...] | None]:
        values: list[float] = []
        for line in fitting(reads, self.exchange.columns):
            answer = yield from read_once(self.exchange.nonces, *line, timeout_s=self.exchange.patience(64))
            if answer.kind is not Kind.VALUES:
                return None
            values += answer.values
        return tuple(values)

    def _not_lengthened(self, answer: Answer) -> Steps[bool]:
        """Refused: a limit is near, or the axis was stopped by something else. No answer: it is told to end."""
        if "?" not in answer.text:
            yield from self._stop()
            raise LinkError(f"Axis {self.axis} was stopped: the controller did not answer while it was held.")
        if (yield from self.exchange.code()) == OUT_OF_RANGE:  # it runs to the end that was accepted
            self._reason = f"Axis {self.axis}: {LIMIT_NEAR}"
        return False

    def _saw(self, place: int) -> None:
        """A reading that came just now, taken before its characters travelled."""
        now = self.exchange.clock() - REPLY * self.exchange.byte_s
        if self._seen and now > self._seen:
            self._velocity = abs(place - self._place) / (now - self._seen)
        self._place, self._seen = place, now

    def _watch(self) -> Steps[str]:
        """A latched jog: only looks whether something else ended it."""
        while self.held:
            yield Wait(EXTEND_S)
            if self.resting():
                raise NotAllowed(f"The jog of axis {self.axis} was stopped: {self.resting()}")
            if self.held and not (yield from self._lengthen(0)):
                return (yield from self._by_itself())
        return ""

    def _by_itself(self) -> Steps[str]:
        if self._reason:
            return self._reason
        forward = self.speed > 0
        switch, limit = ("_LF", "_FL") if forward else ("_LR", "_BL")
        values = yield from self.exchange.read(
            (f"_SC{self.axis}", CODE), (f"{switch}{self.axis}", FLAG), (f"{limit}{self.axis}", COUNTS)
        )
        if values is None:
            return f"Axis {self.axis} stopped."
        code, free, furthest = (int(value) for value in values)
        if code != AT_TARGET:
            return ended(self.axis, code)
        beyond = self._place >= furthest if forward else self._place <= furthest
        if beyond or not free:  # an IP 0 that met the standing axis has overwritten the code
            return f"Axis {self.axis} stands at its {'forward' if forward else 'reverse'} limit."
        return f"Axis {self.axis} was stopped by something else."

    def _stop(self) -> Steps[None]:
        for _ in range(STOP_TRIES):
            answer = yield from self.exchange.prove(f"ST {self.axis}", stops=True)
            if answer.kind is Kind.ACCEPTED:
                return
        if self.latched:
            raise StopNeeded(f"The stop of axis {self.axis} was not confirmed.")
        raise LinkError(f"The stop of axis {self.axis} was not confirmed; its move ends by itself. Press STOP.")

    def _stand(self, let_go: float, sentence: str) -> Steps[Ran]:
        """Waits for the end of the deceleration; then speed and ramps are as they were."""
        since = let_go - self._seen if self._seen else 0.0  # below 0 where it was read after it was let go
        start = self._place + self._signed(int(min(self._velocity, self.true_speed) * since))
        end = self.exchange.clock() + self.stopping_s * 1.5 + 2.0
        while True:
            values = yield from self.exchange.read((f"_RP{self.axis}", COUNTS), (f"_BG{self.axis}", FLAG))
            stands = values is not None and not values[1]
            if values is not None:
                self._place = int(values[0])
            if stands or self.exchange.clock() > end:
                break
            yield Wait(LOOK_S)
        seconds = self.exchange.clock() - let_go
        self._velocity = 0.0
        if not stands:
            raise LinkError(f"Axis {self.axis} was told to stop but still moves. Press STOP.")
        yield from self.exchange.put_back(self.as_before)
        run_on = abs(self._place - start)
        return Ran(self.axis, self._place, run_on, seconds, sentence or f"Axis {self.axis} stopped.")


class StopNeeded(LinkError):
    """Only the STOP of everything can end a latched jog now."""
