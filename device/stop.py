"""STOP: one table of state → bytes → proof. Every stop in the program comes through here. It is no emergency stop.

| state of the line                       | bytes                        | proof                     |
|-----------------------------------------|------------------------------|---------------------------|
| command mode                            | `ST` CR                      | `ST;HX` accepted, and     |
|                                         |                              | no `_BG`, no `_XQn`       |
| DL, QD, ED, data mode, IN, half a line, | `11 1B 5C` `ST` CR `ST` CR   | the same                  |
| XOFF, unknown                           |                              |                           |
| daisy chain                             | the burst with `!ST`         | the same, of ours         |
| second press, or not still in time      | the same with `AB`           | the same                  |

`11` is XON and leaves the line editor, `1B` leaves operator data mode, `5C` (backslash) ends DL and QD. The first
`ST` may be taken as the answer of an IN; the second acts. (A program that does nothing but ask for a text again and
again takes every line: STOP then says NOT CONFIRMED.)
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum

from device.door import LEAVE, choose
from device.tasks import Send, Steps, Wait
from device.undecided import NOTHING
from device.wire import Answer, Frame, Kind, Proof, Shape, fitting, framed

NO_ANSWER_S = 0.5  # this long without an answer is NOT CONFIRMED
GRACE_S = 0.3  # beyond the stopping time before AB
GIVE_UP_S = 15.0  # a burn keeps a controller silent for up to 10 s
LONGEST_S = 10.0  # the longest deceleration that is waited for
UNKNOWN_S = 1.0  # where the controller does not tell how fast it decelerates


class StopState(StrEnum):
    """What the STOP button shows."""

    READY = "ready"
    STOPPING = "stopping…"
    STOPPED = "stopped (confirmed)"
    NOT_CONFIRMED = "NOT CONFIRMED - use the machine's emergency stop"
    NO_LINK = "no link"


def stop_bytes(command_mode: bool, *, chained: bool = False, abort: bool = False) -> bytes:
    """The bytes that stop, for the state the line is in."""
    word = (b"!" if chained else b"") + (b"AB\r" if abort else b"ST\r")
    return word if command_mode else LEAVE + word + word


@dataclass
class Stopping:
    """One stop on its way: sends, then proves that everything is still."""

    command_mode: bool
    axes: str
    sequence: bool
    threads: int
    columns: int
    address: int | None  # in a daisy chain: ours, which proves it
    stopping_time_s: float | None  # None: asked from the controller
    clock: Callable[[], float]
    nonces: Iterator[str]
    show: Callable[[StopState], None]
    abort: bool = False
    heard: float = 0.0

    def steps(self) -> Steps[bool]:
        """Ends with whether stillness was proved."""
        start = self.clock()
        self.heard = self.heard or start
        yield Send(stop_bytes(self.command_mode, chained=self.address is not None, abort=self.abort), hold=True)
        if self.address is not None:
            yield Send(choose(self.address), hold=True)
        halted = False
        while self.clock() - start < GIVE_UP_S:
            if not halted:
                halted = yield from self._halt()
                continue
            still = yield from self._still()
            if still:
                self.show(StopState.STOPPED)
                return True
            if self.stopping_time_s is None:
                self.stopping_time_s = yield from self._ask_stopping_time()
            if not self.abort and self.clock() - start > self.stopping_time_s + GRACE_S:
                self.abort = True
                yield Send(stop_bytes(False, chained=self.address is not None, abort=True), hold=True)
        self.show(StopState.NOT_CONFIRMED)
        return False

    def _halt(self) -> Steps[bool]:
        """The stop once more and `HX`, proved by a frame: what was sent at first may have met half a line.

        A geared axis moves without `_BG`, so only a proof that the stop itself was carried out will do.
        """
        nonce = next(self.nonces)
        line = f"{'AB' if self.abort else 'ST'};HX;{framed(nonce, ())}"
        answer = yield Send(
            line.encode() + b"\r", Proof(nonce, 2, NOTHING), self._patience(), hold=True, refusal_s=0.04
        )
        if answer.kind is Kind.ACCEPTED:
            self._answered()
            return True
        self._unanswered()
        yield Send(stop_bytes(False, chained=self.address is not None, abort=self.abort), hold=True)
        return False

    def _ask_stopping_time(self) -> Steps[float]:
        """How long the deceleration takes: speed / DC of the slowest axis, VS / VD of a sequence."""
        pairs = [((f"_TV{axis}", Shape(8, 0)), (f"_DC{axis}", Shape(10, 0))) for axis in self.axes]
        pairs += [(("_VS", Shape(10, 0)), ("_VD", Shape(10, 0)))] if self.sequence else []
        longest = 0.0
        for pair in pairs:
            nonce = next(self.nonces)
            line = framed(nonce, pair).encode() + b"\r"
            frame = Frame(nonce, (pair[0][1], pair[1][1]))
            answer = yield Send(line, frame, self._patience(), hold=True, refusal_s=0.04)
            if answer.kind is not Kind.VALUES:
                return UNKNOWN_S
            self._answered()
            speed, deceleration = answer.values
            longest = max(longest, abs(speed) / max(deceleration, 1.0))
        return min(max(longest * 1.2, 0.2), LONGEST_S)

    def _still(self) -> Steps[bool]:
        """Whether no axis is commanded and no thread runs, read afresh."""
        values: list[float] = []
        for reads in self._requests():
            nonce = next(self.nonces)
            shapes = tuple(shape for _, shape in reads)
            line = framed(nonce, reads).encode() + b"\r"
            answer = yield Send(line, Frame(nonce, shapes), self._patience(), hold=True, refusal_s=0.04)
            if answer.kind is not Kind.VALUES:
                self._unanswered(answer)
                return False
            self._answered()
            values += answer.values
        moving = len(self.axes) + self.sequence
        if any(values[:moving]) or any(value >= 0 for value in values[moving:]):
            yield Wait(0.01, hold=True)
            return False
        return True

    def _requests(self) -> Iterator[Sequence[tuple[str, Shape]]]:
        """`_BG` of all axes and S, then `_XQn`, in as few lines as fit."""
        reads = [(f"_BG{axis}", Shape(1, 0)) for axis in self.axes + ("S" if self.sequence else "")]
        reads += [(f"_XQ{thread}", Shape(4, 0)) for thread in range(self.threads)]
        return fitting(reads, self.columns)

    def _patience(self) -> float:
        """How long to wait for an answer: never past the moment that is NOT CONFIRMED, longer after it."""
        silent = self.clock() - self.heard
        return min(0.25, NO_ANSWER_S - silent) if silent < NO_ANSWER_S - 0.02 else 0.6

    def _answered(self) -> None:
        self.heard = self.clock()

    def _unanswered(self, answer: Answer | None = None) -> None:
        if self.clock() - self.heard >= NO_ANSWER_S - 0.01:
            self.show(StopState.NOT_CONFIRMED)
