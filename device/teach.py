"""Play-back of taught rows: each is sent when the one before has ended, so that nothing goes on without us.

It runs from here and not as a program in the controller: the program that is in there stays, a dead computer or a
pulled cable ends it with the row in hand, and each stop ends all of it. It is work of one hand (`Motion.undertake`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from device.jog import Places, Plan, told
from device.lease import AT_TARGET, CODE, COUNTS, FLAG, LOOK_S, Exchange, at, ended
from device.moving import Going
from device.tasks import LinkError, NotAllowed, Steps, Wait
from device.wire import Kind, Shape

if TYPE_CHECKING:
    from codegen.setup import Setup

AXES = "XY"
INPUT_S = 0.05  # between two looks at the inputs
SHORTEST_S = 0.02
SILENT = 3  # readings without an answer, each asked twice


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


class RowEnded(LinkError):
    """A row did not end as it should, on a controller that still answers."""


@dataclass
class PlayBack(Going):
    """The rows one after the other; `step` holds before each until `go_on`. What it does now is in `row`, `doing`."""

    actions: Sequence[Action] = ()
    step: bool = False
    resting: Callable[[], str] = lambda: ""
    row: int = -1
    doing: str = ""
    holds: bool = False  # waits for `go_on`
    end: Mapping[str, int] = field(default_factory=dict)  # of the move that is on its way, counts
    _wanted: bool = False
    _sequence: bool = False
    _sent: dict[str, str] = field(default_factory=dict)  # speeds and ramps along the path, as they were sent last

    @classmethod
    def of(
        cls,
        actions: Sequence[Action],
        owner: str,
        step: bool,
        exchange: Exchange,
        endangered: Callable[[str], str],
    ) -> PlayBack:
        """A play-back of both axes, for `Motion.undertake`."""

        def resting() -> str:
            return next(filter(None, map(endangered, AXES)), "")

        return cls(Plan("Play-back", AXES, (), {}), owner, exchange, actions=actions, step=step, resting=resting)

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
        yield from self._ended(row, ["_BGS"] if move.sequence else [f"_BG{letter}" for letter in AXES])
        self._sequence, self.end = False, {}
        if not self.released:
            yield from self._arrived(row, move)

    def _ended(self, row: int, flags: Sequence[str]) -> Steps[None]:
        """Waits until nothing of the move is left; a release stops it."""
        stopped, silent = False, 0
        while True:
            if self.released and not stopped:
                stopped = yield from self._stop()
            values = yield from self.exchange.read(*((flag, FLAG) for flag in flags))
            if values is not None and not any(values):
                return
            silent = silent + 1 if values is None else 0
            if silent == SILENT:
                raise LinkError(f"Play-back ended in row {row + 1}: the controller does not answer.")
            yield Wait(LOOK_S)

    def _new(self, command: str) -> bool:
        """Whether a speed or ramp of the path is another one than before; everything else is."""
        name, _, value = command.partition(" ")
        if name not in ("VS", "VA", "VD"):
            return True
        known, self._sent[name] = self._sent.get(name), value
        return known != value

    def _arrived(self, row: int, move: Move) -> Steps[None]:
        """Both axes are commanded to be where the row ends; else something stopped them, and nothing goes on."""
        reads = [(f"_RP{letter}", COUNTS) for letter in AXES] + [(f"_SC{letter}", CODE) for letter in AXES]
        values = yield from self.exchange.read(*reads)
        if values is None:
            raise LinkError(f"Play-back ended in row {row + 1}: the controller did not say where the axes are.")
        for letter, place, end, code in zip(AXES, values, move.end, values[2:], strict=False):
            if abs(place - end) > move.slack:
                why = "It was stopped by something else." if code == AT_TARGET else ended(letter, int(code))
                raise RowEnded(f"Play-back ended in row {row + 1}: axis {letter} did not arrive. {why}")

    def _taken(self, row: int, line: str) -> Steps[None]:
        answer = yield from self.exchange.prove(line)
        if answer.kind is not Kind.ACCEPTED:
            why = yield from self.exchange.why()
            yield from self._stop()
            yield from self.exchange.put_back(["CS"])  # segments that wait belong to no move any more
            raise RowEnded(f"Play-back ended in row {row + 1}: “{line}” was refused: {why}.")
