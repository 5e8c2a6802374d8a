"""Two axes in one hand, at speeds that change while it holds: for sticks of every kind.

The same lease as `device.lease`, over the same short moves: each axis has at most its speed × 0.4 s and its stopping
distance ahead, never beyond its limits, lengthened by `IP n*_BGX`. SP may change while an axis moves, DC and the
target may not (dmc-1412-1414.txt l.1700): to slow down, nothing is lengthened, and the speed follows the way that is
left, so that a pulled cable still ends after 0.4 s. To turn round an axis is stopped, stands, and starts again.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from device.identify import read_once
from device.lease import (
    AHEAD_S,
    AT_TARGET,
    CODE,
    COUNTS,
    EXTEND_S,
    FLAG,
    LEASE_S,
    LIMIT_NEAR,
    LOOK_S,
    OUT_OF_RANGE,
    STOP_TRIES,
    Exchange,
    at,
    ended,
    not_started,
    ramps_of,
)
from device.tasks import LinkError, NotAllowed, Send, Steps, Wait
from device.wire import Answer, Frame, Kind, Shape, framed

AT_SWITCH = 22  # a start towards a limit switch that is active
SLOWEST = 2  # counts/s; the grain of SP
Reads = Sequence[tuple[str, Shape]]


@dataclass(frozen=True, slots=True)
class Drove:
    """How a drive ended: where the axes stand, how far each ran on after it was let go, and for how long."""

    places: dict[str, int]
    run_on: dict[str, int]
    seconds: float
    sentence: str


@dataclass
class Track:
    """One axis of a drive."""

    axis: str
    acceleration: int
    deceleration: int
    exchange: Exchange
    low: int = 0  # no way ahead before the limits are known
    high: int = 0
    wanted: int = 0  # counts/s with sign; set by whoever steers
    speed: int = 0  # what SP is, with the direction of the move
    target: int = 0
    place: int = 0  # commanded, when it was read last
    moving: bool = False
    stopping: bool = False
    scale: float = 1.0  # true counts/s in one of SP; other than 1 where TM is not 1000
    former: tuple[int, ...] = ()  # SP, AC, DC
    said: str = ""  # why it does not go further
    blocked: int = 0  # the direction in which it does not
    _seen: float = 0.0
    _velocity: float = 0.0

    @property
    def sign(self) -> int:
        return 1 if self.speed >= 0 else -1

    def ahead(self, speed: int) -> int:
        """Counts that may lie ahead at this speed."""
        true = abs(speed) * self.scale
        return int(true * AHEAD_S + true * true / (2 * self.deceleration * self.scale**2))

    def now(self) -> int:
        """Where it is commanded to be by now at least."""
        way = min(self._velocity, abs(self.speed) * self.scale) * max(self.exchange.clock() - self._seen, 0.0)
        reached = self.place + self.sign * int(way if self.moving else 0)
        return min(reached, self.target) if self.sign > 0 else max(reached, self.target)

    @property
    def ghost(self) -> int:
        """Where it comes to stand when it is let go now."""
        return self.now() + self.sign * int(self._velocity**2 / (2 * self.deceleration * self.scale**2))

    @property
    def stopping_s(self) -> float:
        return abs(self.speed) / (self.deceleration * self.scale)

    # ------------------------------------------------------------ on the link

    def meet(self) -> Steps[None]:
        """Where it is, that it stands with its motor on, and what SP, AC and DC are."""
        standing = yield from self.exchange.standing(self.axis)
        self.scale = 1000.0 / standing.period if standing.period is not None else 1.0
        self.place = self.target = standing.place
        self.former = standing.former

    def turn(self, held: Callable[[], bool]) -> Steps[None]:
        """What this axis needs now: a start, a longer way, another speed, a stop, or nothing."""
        wanted = self.wanted
        if self.stopping:
            yield from self._look()
        elif not self.moving:
            if wanted and wanted * self.blocked <= 0 and held():
                yield from self._start(wanted, held)
        elif wanted * self.speed <= 0:
            self.stopping = yield from self._stop()
        else:
            yield from self._go_on(wanted)

    def _start(self, wanted: int, held: Callable[[], bool]) -> Steps[None]:
        self.speed, self.blocked, self.said = wanted, 0, ""
        end = self._within(self.place + self.sign * self.ahead(wanted))
        if end == self.place:
            self._block(f"Axis {self.axis} stands at its {'forward' if wanted > 0 else 'reverse'} limit.")
            return
        commands = [f"AC {at(self.axis, self.acceleration)}", f"DC {at(self.axis, self.deceleration)}"]
        commands += [f"SP {at(self.axis, abs(wanted))}", f"PR {at(self.axis, end - self.place)}", f"BG {self.axis}"]
        for line in self.exchange.packed(commands):
            if not held():
                return
            began = self.exchange.clock()
            answer = yield from self.exchange.prove(line)
            if answer.kind is not Kind.ACCEPTED:
                yield from self._not_started()
                return
        self.target, self.moving, self._seen, self._velocity = end, True, began, 0.0

    def _not_started(self) -> Steps[None]:
        code = yield from self.exchange.code()
        yield from self._stop()
        why = f"Axis {self.axis} did not start: {not_started(code)}"
        if code not in (OUT_OF_RANGE, AT_SWITCH):
            raise NotAllowed(why)
        self._block(why)

    def _block(self, why: str) -> None:
        self.blocked, self.said, self.moving = self.sign, why, False

    def _within(self, place: int) -> int:
        """A target inside the limits; one behind the axis is none."""
        if self.sign > 0:
            return max(min(place, self.high), self.target if self.moving else self.place)
        return min(max(place, self.low), self.target if self.moving else self.place)

    def _go_on(self, wanted: int) -> Steps[None]:
        new = self._pace(abs(wanted))
        more = self.sign * (self._within(self.now() + self.sign * self.ahead(new)) - self.target)
        commands = [f"SP {at(self.axis, new)}"] if new != abs(self.speed) else []
        if more > 0:
            commands.append(f"IP {at(self.axis, f'{self.sign * more}*_BG{self.axis}')}")
        self.speed = self.sign * new
        yield from self._look(commands, max(more, 0))

    def _pace(self, wanted: int) -> int:
        """SP for now: no slower than what comes to the end of the way that is left in time."""
        present = abs(self.speed)
        if wanted >= present:
            return wanted
        left, hardest = abs(self.target - self.now()), self.deceleration * self.scale**2
        in_time = hardest * (math.sqrt(AHEAD_S**2 + 2 * left / hardest) - AHEAD_S) / self.scale
        return max(wanted, min(present, int(in_time) // SLOWEST * SLOWEST), SLOWEST)

    def _look(self, commands: Sequence[str] = (), more: int = 0) -> Steps[None]:
        """Commands that must be accepted, and a reading of where the axis is, in one line where that fits."""
        reads = ((f"_RP{self.axis}", COUNTS), (f"_BG{self.axis}", FLAG))
        nonce = next(self.exchange.nonces)
        line = ";".join((*commands, framed(nonce, reads)))
        if len(line) > self.exchange.columns:
            answer = yield from self.exchange.prove(";".join(commands))
            if answer.kind is Kind.ACCEPTED:
                answer = yield from read_once(self.exchange.nonces, *reads)
        else:
            data = line.encode() + b"\r"
            shapes = tuple(shape for _, shape in reads)
            frame = Frame(nonce, shapes, before=";".join(commands).count(";") + 1 if commands else 0)
            answer = yield Send(data, frame, self.exchange.patience(len(data) + 24), refusal_s=0.04)
        if answer.kind is not Kind.VALUES:
            yield from self._refused(answer)
            return
        self.target += self.sign * more
        yield from self._saw(int(answer.values[0]), bool(answer.values[1]))

    def _refused(self, answer: Answer) -> Steps[None]:
        if "?" not in answer.text:
            yield from self._stop()
            raise LinkError(f"Axis {self.axis} was stopped: the controller did not answer while it was driven.")
        if (yield from self.exchange.code()) == OUT_OF_RANGE:  # it runs to the end that was accepted
            self.high, self.low = (self.target, self.low) if self.sign > 0 else (self.high, self.target)
            self.said = f"Axis {self.axis}: {LIMIT_NEAR}"

    def _saw(self, place: int, moving: bool) -> Steps[None]:
        now = self.exchange.clock()
        if now > self._seen > 0:
            self._velocity = abs(place - self.place) / (now - self._seen)
        self.place, self._seen = place, now
        if moving:
            return
        told, self.moving, self.stopping, self._velocity = self.stopping, False, False, 0.0
        self.target = place
        if told:
            return
        side, switch = ("forward", "_LF") if self.sign > 0 else ("reverse", "_LR")
        values = yield from self.exchange.read((f"_SC{self.axis}", CODE), (f"{switch}{self.axis}", FLAG))
        code, free = values if values is not None else (AT_TARGET, 1)
        if code != AT_TARGET:
            raise NotAllowed(ended(self.axis, int(code)))
        if not free:  # an IP 0 that met the standing axis has overwritten the code
            raise NotAllowed(f"Axis {self.axis} stands at its {side} limit switch.")
        if place in (self.low, self.high):
            self._block(self.said or f"Axis {self.axis} stands at its {side} limit.")

    def _stop(self) -> Steps[bool]:
        for _ in range(STOP_TRIES):
            answer = yield from self.exchange.prove(f"ST {self.axis}", stops=True)
            if answer.kind is Kind.ACCEPTED:
                return True
        raise LinkError(f"The stop of axis {self.axis} was not confirmed; its move ends by itself. Press STOP.")


@dataclass
class Drive:
    """The axes of one hand; `renew` is called every 50 ms, `steer` whenever the hand moves."""

    tracks: dict[str, Track]
    exchange: Exchange
    owner: str
    resting: Callable[[], str]
    one_at_a_time: bool = False  # a slow line: the stronger axis alone
    along: Sequence[Sequence[tuple[str, str, Shape]]] = ()  # key, expression, shape: lines that are read meanwhile
    told: Callable[[dict[str, float]], None] = lambda values: None
    renewed: float = 0.0
    released_at: float | None = None
    changed: bool = field(default=True)

    # ------------------------------------------------------- for every thread

    def renew(self) -> None:
        """Goes on holding; what has lapsed is not taken up again."""
        if self.held:
            self.renewed = self.exchange.clock()

    def release(self) -> None:
        if self.released_at is None:
            self.released_at = self.exchange.clock()

    @property
    def held(self) -> bool:
        return self.released_at is None and self.exchange.clock() - self.renewed < LEASE_S

    @property
    def axes(self) -> str:
        return "".join(self.tracks)

    @property
    def ghost(self) -> dict[str, int]:
        return {letter: track.ghost for letter, track in self.tracks.items() if track.moving}

    def steer(self, speeds: Mapping[str, float]) -> None:
        """Speeds with sign, counts/s; an axis that is not named stands."""
        wanted = {letter: int(speeds.get(letter, 0) / SLOWEST) * SLOWEST for letter in self.tracks}
        if self.one_at_a_time:
            strongest = max(wanted, key=lambda letter: abs(wanted[letter]))
            wanted = {letter: speed if letter == strongest else 0 for letter, speed in wanted.items()}
        for letter, track in self.tracks.items():
            self.changed |= track.wanted != wanted[letter]
            track.wanted = wanted[letter]

    # ------------------------------------------------------------ on the link

    def steps(self) -> Steps[Drove]:
        """Follows the hand while it holds, then stops all axes, waits until they stand, puts speeds and ramps back."""
        for track in self.tracks.values():
            yield from track.meet()
        sentence = ""
        try:
            yield from self._follow()
        except NotAllowed as reason:
            if self.resting():
                raise
            sentence = str(reason)  # an axis was stopped by something else: so are the others
        let_go = self.released_at or (self.exchange.clock() if sentence else self.renewed)
        self.release()
        begins = {letter: track.now() for letter, track in self.tracks.items()}
        yield from self._stop()
        yield from self._stand()
        places = {letter: track.place for letter, track in self.tracks.items()}
        run_on = {letter: abs(place - begins[letter]) for letter, place in places.items()}
        said = " ".join(track.said for track in self.tracks.values() if track.said)
        return Drove(places, run_on, self.exchange.clock() - let_go, sentence or said)

    def _follow(self) -> Steps[None]:
        began = -EXTEND_S
        while self.held:
            if self.exchange.clock() - began < EXTEND_S and not self.changed:
                yield Wait(0.01)
                continue
            if self.resting():
                raise NotAllowed(f"Driving ended: {self.resting()}")
            began, self.changed = self.exchange.clock(), False
            for track in self.tracks.values():
                if self.held:
                    yield from track.turn(lambda: self.held)
            for request in self.along if self.held else ():
                yield from self._read(request)
            yield Wait(0.005)  # on a slow line too there is room for what somebody else wants

    def _read(self, request: Sequence[tuple[str, str, Shape]]) -> Steps[None]:
        answer = yield from read_once(self.exchange.nonces, *((expression, shape) for _, expression, shape in request))
        if answer.kind is Kind.VALUES:
            self.told({key: value for (key, _, _), value in zip(request, answer.values, strict=True)})

    def _stop(self) -> Steps[None]:
        going = "".join(letter for letter, track in self.tracks.items() if track.moving and not track.stopping)
        for _ in range(STOP_TRIES if going else 0):
            answer = yield from self.exchange.prove(f"ST {going}", stops=True)
            if answer.kind is Kind.ACCEPTED:
                return
        if going:
            raise LinkError(f"The stop of {going} was not confirmed; the moves end by themselves. Press STOP.")

    @property
    def as_before(self) -> list[str]:
        """What sets speeds and ramps as they were; nothing where they were not read yet."""
        return [line for track in self.tracks.values() for line in ramps_of(track.axis, track.former)]

    def _stand(self) -> Steps[None]:
        """Waits for the end of the deceleration; then speeds and ramps are as they were."""
        end = self.exchange.clock() + max(track.stopping_s for track in self.tracks.values()) * 1.5 + 2.0
        letters = list(self.tracks)
        reads = [(f"_RP{letter}", COUNTS) for letter in letters] + [(f"_BG{letter}", FLAG) for letter in letters]
        while True:
            values = yield from self.exchange.read(*reads)
            if values is not None:
                for letter, place in zip(letters, values, strict=False):
                    self.tracks[letter].place = int(place)
            if values is not None and not any(values[len(letters) :]):
                break
            if self.exchange.clock() > end:
                raise LinkError(f"{self.axes} were told to stop but still move. Press STOP.")
            yield Wait(LOOK_S)
        for track in self.tracks.values():
            track.moving = False
            yield from self.exchange.put_back(ramps_of(track.axis, track.former))
