"""Play-back of taught rows: each is sent when the one before has ended, so that nothing goes on without us.

It runs from here and not as a program in the controller: the program that is in there stays, a dead computer or a
pulled cable ends it with the row in hand, and each stop ends all of it. It is work of one hand (`Motion.undertake`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from codegen.twoletter.problems import ERROR_TEXTS
from device.going import Going
from device.jog import Places, Plan, told
from device.lease import AT_TARGET, CODE, COUNTS, FLAG, LOOK_S, Exchange, at, ended
from device.tasks import LinkError, NotAllowed, Steps, Wait
from device.teach_time import seconds_of
from device.wire import Kind, Shape, framed

if TYPE_CHECKING:
    from codegen.setup import Setup

AXES = "XY"
INPUT_S = 0.02  # between two looks at the inputs
SHORTEST_S = 0.02
SILENT = 3  # readings without an answer, each asked twice
REPLY = 12  # characters that prove a line
POLL = 140  # characters of a reading of live values, there and back
LATER_S = 0.004  # behind the end that was worked out; more where that was too soon
LATEST_S = 0.04
BREATH_S = 0.25  # the longest that live values wait for one of theirs
Read = tuple[str, Shape]


@dataclass(frozen=True, slots=True)
class Move:
    """A move of one row or more: what is sent, and where both axes are commanded to be then, counts."""

    commands: tuple[str, ...]
    end: tuple[int, int]
    slack: int = 0
    sequence: bool = True  # a coordinated one (BG S)


@dataclass(frozen=True, slots=True)
class Await:
    """An input that has to be high or low."""

    number: int
    high: bool

    @property
    def words(self) -> str:
        return f"waits until input {self.number} is {'high' if self.high else 'low'}"


@dataclass(frozen=True, slots=True)
class Send:
    """Commands that switch outputs."""

    commands: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Stand:
    """A pause."""

    seconds: float


@dataclass(frozen=True, slots=True)
class Action:
    """What a row does (from 0), one thing after the other."""

    row: int
    what: Move | Await | Send | Stand


@dataclass(frozen=True, slots=True)
class Played:
    """How a play-back ended."""

    row: int
    finished: bool
    sentence: str


def approach(place: tuple[int, int], speeds: Mapping[str, int], ramps: Mapping[str, int]) -> Move:
    """To the first place, each axis by itself, absolutely; speeds and ramps by axis."""
    commands: list[str] = []
    for letter, counts in zip(AXES, place, strict=True):
        commands += [f"AC {at(letter, ramps[letter])}", f"DC {at(letter, ramps[letter])}"]
        commands += [f"SP {at(letter, speeds[letter])}", f"PA {at(letter, counts)}"]
    return Move((*commands, f"BG {AXES}"), place, sequence=False)


def passes(ends: Sequence[tuple[int, tuple[int, int]]], places: Places, setup: Setup | None = None) -> str:
    """The first row (from 0) that ends beyond a limit, as a sentence, or nothing."""
    for row, end in ends:
        for letter, counts in zip(AXES, end, strict=True):
            for word, limits, sign in (("forward", places.forward, 1), ("reverse", places.reverse, -1)):
                if letter in limits and sign * (counts - limits[letter]) > 0:
                    place, limit = told(counts, letter, setup), told(limits[letter], letter, setup)
                    return f"Row {row + 1}: {place} lies beyond the {word} limit of {letter}, {limit}."
    return ""


def _there(move: Move) -> Read:
    """A digit that is 0 where a move has ended and both axes are commanded to be at its end."""
    away = "".join(f"+@ABS[_RP{letter}{-end:+d}]" for letter, end in zip(AXES, move.end, strict=True))
    return f"_BGS{away}", FLAG


class RowEnded(LinkError):
    """A row did not end as it should, on a controller that still answers."""


@dataclass
class PlayBack(Going):
    """The rows one after the other; `step` holds before each until `go_on`. What it does now is in `row`, `doing`."""

    actions: Sequence[Action] = ()
    step: bool = False
    resting: Callable[[], str] = lambda: ""
    switches: Callable[[], bool] = lambda: True
    row: int = -1
    doing: str = ""
    holds: bool = False  # waits for `go_on`
    end: Mapping[str, int] = field(default_factory=dict)  # of the move that is on its way, counts
    _wanted: bool = False
    _sequence: bool = False
    _ratio: float = 1.0  # VR
    _stretch: float = 1.0  # true seconds to one of 1024 samples (TM)
    _later: float = LATER_S
    _breath: float = 0.0  # when live values had the line last
    _sent: dict[str, str] = field(default_factory=dict)  # speeds and ramps along the path, as they were sent last

    @classmethod
    def of(
        cls,
        actions: Sequence[Action],
        owner: str,
        step: bool,
        exchange: Exchange,
        endangered: Callable[[str], str],
        switches: Callable[[], bool] = lambda: True,
    ) -> PlayBack:
        """A play-back of both axes, for `Motion.undertake`; `switches`: whether outputs may be (I/O control)."""

        def resting() -> str:
            return next(filter(None, map(endangered, AXES)), "")

        plan = Plan("Play-back", AXES, (), {})
        return cls(plan, owner, exchange, actions=actions, step=step, resting=resting, switches=switches)

    @property
    def axes(self) -> str:
        return "S" if self._sequence else AXES

    def go_on(self) -> None:
        """The next row."""
        self._wanted = True

    # ------------------------------------------------------------ on the link

    def steps(self) -> Steps[Played]:  # type: ignore[override]
        """All rows, or as many until it is released; then speeds and ramps are as they were."""
        yield from self._meet()
        try:
            yield from self._rows()
        except (NotAllowed, RowEnded):
            self.holds, self.doing = False, ""
            yield from self._put_back()
            raise
        self.holds, self.doing = False, ""
        yield from self._put_back()
        if self.released:
            return Played(self.row, False, f"Play-back was stopped in row {self.row + 1}.")
        return Played(self.row, True, "Played back.")

    def _rows(self) -> Steps[None]:
        for action in self.actions:
            if self.step and action.row != self.row:
                yield from self._hold(action.row)
            if self.released:
                return
            self.row = action.row
            yield from self._do(action)

    def _meet(self) -> Steps[None]:
        """Both axes stand with their motors on; what speeds and ramps are."""
        values = yield from self.exchange.read(*((f"_{name}{axis}", FLAG) for name in ("BG", "MO") for axis in AXES))
        if values is None:
            raise LinkError("Not played back: the controller did not answer.")
        for letter, moving, off in zip(AXES, values[:2], values[2:], strict=True):
            if moving:
                raise NotAllowed(f"Not played back: axis {letter} moves already; stop it first.")
            if off:
                raise NotAllowed(f"Not played back: the motor of axis {letter} is off. Switch it on (SH) first.")
        names = [(name, axis) for axis in AXES for name in ("SP", "AC", "DC")] + [(n, "") for n in ("VS", "VA", "VD")]
        numbers = yield from self.exchange.read(*((f"_{name}{axis}", Shape(8, 0)) for name, axis in names))
        if numbers is None:
            raise LinkError("Not played back: the controller did not tell its speeds.")
        self.former = [(name, axis, int(value)) for (name, axis), value in zip(names, numbers, strict=True)]
        pace = yield from self.exchange.read(("_VR", Shape(2, 4)), ("_TM", Shape(5, 0)))
        if pace is not None:
            self._ratio, self._stretch = pace[0], (pace[1] if pace[1] > 0 else 1000) / 1000

    def _hold(self, row: int) -> Steps[None]:
        """Step by step: waits for the person."""
        self._wanted, self.holds, self.doing = False, True, f"Row {row + 1} is next."
        while not self._wanted and not self.released:
            self._look_up()
            yield Wait(0.02)
        self.holds = False

    def _do(self, action: Action) -> Steps[None]:
        match action.what:
            case Move():
                yield from self._move(action.row, action.what)
            case Await():
                yield from self._await(action.row, action.what)
            case Send():
                self.doing = f"Row {action.row + 1} switches outputs."
                if not self.switches():
                    raise NotAllowed(
                        f"Play-back ended in row {action.row + 1}: I/O control was switched off meanwhile."
                    )
                for line in self.exchange.packed(action.what.commands):
                    yield from self._taken(action.row, line)
            case Stand():
                self.doing = f"Row {action.row + 1} pauses {action.what.seconds:g} s."
                yield from self._stand(action.what.seconds)

    def _look_up(self) -> None:
        if self.resting():
            raise NotAllowed(f"Play-back ended in row {self.row + 1}: {self.resting()}")

    def _stand(self, seconds: float) -> Steps[None]:
        end = self.exchange.clock() + seconds
        while not self.released and (left := end - self.exchange.clock()) > 0:
            self._look_up()
            yield Wait(min(left, SHORTEST_S))

    def _await(self, row: int, wait: Await) -> Steps[None]:
        self.doing = f"Row {row + 1} {wait.words}."
        while not self.released:
            self._look_up()
            values = yield from self.exchange.read(("_TI", Shape(3, 0)))
            if values is None:
                raise LinkError(f"Play-back ended in row {row + 1}: the controller did not tell its inputs.")
            if bool(int(values[0]) >> (wait.number - 1) & 1) == wait.high:
                return
            yield Wait(INPUT_S)

    def _move(self, row: int, move: Move) -> Steps[None]:
        self.doing = f"Row {row + 1} moves."
        self.end = dict(zip(AXES, move.end, strict=True))
        commands = [each for each in move.commands if self._new(each)]
        for line in self.exchange.packed(commands):
            if self.released:
                break
            self._sequence = move.sequence
            yield from self._taken(row, line)
        places = yield from self._ended(row, move)
        self._sequence, self.end = False, {}
        if not self.released:
            yield from self._arrived(row, move, places)

    def _ended(self, row: int, move: Move) -> Steps[Sequence[float]]:
        """Waits until nothing of the move is left; a release stops it. Where both axes are commanded to be then.

        Its end is known beforehand: the first look travels so that it is answered just behind it, in one digit, and
        the next row leaves with that answer. It is one exchange a row, whatever lies between.
        """
        flags: list[Read] = [("_BGS", FLAG)] if move.sequence else [(f"_BG{letter}", FLAG) for letter in AXES]
        reads = [*flags, *((f"_RP{letter}", COUNTS) for letter in AXES)]
        first = [_there(move)] if move.sequence and not move.slack else reads
        due = self._due(move, first)
        stopped, silent = False, 0
        while True:
            yield from self._until(due)
            if self.released and not stopped:
                stopped = yield from self._stop()
            values = yield from self.exchange.read(*first)
            if values is not None and not any(values[: len(flags)]):
                return values[len(flags) :] or move.end
            silent, first = (silent + 1 if values is None else 0), reads
            if silent == SILENT:
                raise LinkError(f"Play-back ended in row {row + 1}: the controller does not answer.")
            soon = self.exchange.clock() - due < LATEST_S
            self._later = min(self._later + LATER_S, LATEST_S) if soon else self._later
            due = max(due, self.exchange.clock() + (0.0 if soon else LOOK_S))

    def _due(self, move: Move, reads: Sequence[Read]) -> float:
        """When the look at the end of a move that has just begun has to leave; now, where its end is not known."""
        now, byte_s = self.exchange.clock(), self.exchange.byte_s
        lasts = seconds_of(move.commands, self._ratio) * self._stretch if move.sequence else 0.0
        return now + max(lasts + self._later - (REPLY + len(framed("xx", reads)) + 1) * byte_s, 0.0)

    def _until(self, due: float) -> Steps[None]:
        """The line is others' until shortly before; then it is kept, so that no live value is in the way."""
        kept_s = POLL * self.exchange.byte_s
        while not self.released and (left := due - self.exchange.clock()) > 0:
            keeps = left <= kept_s and self.exchange.clock() - self._breath < BREATH_S
            if not keeps:
                self._breath = self.exchange.clock()
            yield Wait(min(left, SHORTEST_S) if keeps else min(max(left - kept_s, 0.001), SHORTEST_S), hold=keeps)

    def _new(self, command: str) -> bool:
        """Whether a speed or ramp of the path is another one than before; everything else is."""
        name, _, value = command.partition(" ")
        if name not in ("VS", "VA", "VD"):
            return True
        known, self._sent[name] = self._sent.get(name), value
        return known != value

    def _arrived(self, row: int, move: Move, places: Sequence[float]) -> Steps[None]:
        """Both axes are commanded to be where the row ends; else something stopped them, and nothing goes on."""
        if all(abs(place - end) <= move.slack for place, end in zip(places, move.end, strict=True)):
            return
        codes = yield from self.exchange.read(*((f"_SC{letter}", CODE) for letter in AXES))
        if codes is None:
            raise LinkError(f"Play-back ended in row {row + 1}: the controller did not say why the axes stand.")
        for letter, place, end, code in zip(AXES, places, move.end, codes, strict=True):
            if abs(place - end) > move.slack:
                why = "It was stopped by something else." if code == AT_TARGET else ended(letter, int(code))
                raise RowEnded(f"Play-back ended in row {row + 1}: axis {letter} did not arrive. {why}")

    def _taken(self, row: int, line: str) -> Steps[None]:
        answer = yield from self.exchange.prove(line)
        if answer.kind is not Kind.ACCEPTED:
            code = yield from self.exchange.code()
            yield from self._stop()
            yield from self.exchange.put_back(["CS"])  # segments that wait belong to no move any more
            why = f"error {code}, {ERROR_TEXTS.get(code, 'unknown error')}"
            raise RowEnded(f"Play-back ended in row {row + 1}: “{line}” was refused: {why}.")
