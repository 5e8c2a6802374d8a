"""Lines typed to a controller by a script: one at a time, and everything that comes back until the line is quiet."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Final, TypeAlias, TypeVar

from device.simulator.twoletter.setting import Value
from device.transport import Transport

QUIET_S: Final = 0.06  # after a prompt; adapters keep characters up to 16 ms
SILENCE_S: Final = 0.4  # after anything else
FIRST_S: Final = 1.0  # until the first character
MOST_S: Final = 60.0  # for one answer: a thousand lines at 19 200 baud take 43 s
LOOKS: Final = 5  # at what a busy computer may have handed over too late
LINE: Final = 60  # characters of a line that every controller takes
T = TypeVar("T")
PROMPTS: Final = (b":", b"?")
NOBODY: Final = "ZZQXW"  # a name that no program uses
Seen: TypeAlias = Iterator[tuple[str, Value]]
"""Settings with the value that the controller shows."""
NUMBER: Final = re.compile(r"[- ]?\d+(?:\.\d+)?")


class Odd(Exception):
    """An answer that fits nothing; the text says what was asked and what came."""


@dataclass(frozen=True, slots=True)
class Reply:
    """What came back for one line, without its echo; `raw` has bit 7."""

    line: str
    raw: bytes

    @property
    def data(self) -> bytes:
        return bytes(byte & 0x7F for byte in self.raw)

    @property
    def accepted(self) -> bool:
        return self.data.endswith(b":")

    @property
    def refused(self) -> bool:
        return self.data.endswith(b"?")

    @property
    def text(self) -> str:
        """The data without prompts and line ends."""
        return self.data.decode("ascii").strip(":?").replace("\r\n", "\n").strip("\n")

    def odd(self) -> Odd:
        return Odd(f"{self.line!r} was answered by {self.data!r}")


class Talk:
    """The script's end of the line; it types like a person and takes what comes."""

    def __init__(self, transport: Transport, *, byte_s: float) -> None:
        self._transport = transport
        self._byte_s = byte_s
        self.echoing = False

    def send(self, data: bytes) -> None:
        """Hands over characters, all of them."""
        while data:
            taken = self._transport.write(data)
            data = data[taken:]
            if data:
                self._transport.read(0.01)

    def say(self, data: bytes, line: str = "") -> Reply:
        """Sends, and takes what comes until it is quiet; what was there before answers something else."""
        self._transport.read(0.0)
        self.send(data)
        came, waited = bytearray(), 0.0
        while waited < MOST_S:
            quiet = self._quiet(bytes(came), len(data))
            more = self._transport.read(quiet)
            if not more:
                break
            waited += len(more) * self._byte_s
            came += more
        return Reply(line or repr(data), self._without_echo(bytes(came), data))

    def _quiet(self, came: bytes, sent: int) -> float:
        """How long nothing must come for the answer to be over."""
        if not came:
            return FIRST_S + 2 * sent * self._byte_s
        ends = bytes((came[-1] & 0x7F,)) in PROMPTS
        return (QUIET_S if ends else SILENCE_S) + 4 * self._byte_s

    def _without_echo(self, came: bytes, sent: bytes) -> bytes:
        if not self.echoing:
            return came
        body = sent.rstrip(b"\r")
        if not came.startswith(body):
            return came
        return re.sub(rb"^\r\n?", b"", came[len(body) :])

    # ---------------------------------------------------------------- lines

    def line(self, text: str) -> Reply:
        """One command line."""
        return self.say(text.encode("ascii") + b"\r", text)

    def ask(self, text: str) -> str:
        """The answer of a line that must be accepted."""
        reply = self.line(text)
        if not reply.accepted:
            raise reply.odd()
        return reply.text

    def do(self, text: str) -> None:
        """A line that must be accepted and answers nothing."""
        self.ask(text)

    def settle(self) -> None:
        """Waits until nothing more comes."""
        while self.listen(SILENCE_S):
            continue

    def again(self, ask: Callable[[], T]) -> T:
        """Asks what changes nothing, and again where the answer was odd."""
        for _ in range(LOOKS - 1):
            try:
                return ask()
            except Odd:
                self.settle()
        return ask()

    def number(self, expression: str, digits: str = "F10.4") -> float:
        """The value of an expression, in a format of our own (dmc-1412-1414.txt l.3676)."""
        return self.again(lambda: self._number(expression, digits))

    def _number(self, expression: str, digits: str) -> float:
        reply = self.line(f"MG {expression}{{{digits}}}")
        found = NUMBER.search(reply.text)
        if not reply.accepted or found is None:
            raise reply.odd()
        return float(found.group().replace(" ", ""))

    def numbers(self, expressions: Sequence[str], digits: int) -> list[int]:
        """Several whole numbers in as few lines as they fit."""
        found: list[int] = []
        items = [f"{expression}{{F{digits}.0}}" for expression in expressions]
        fit = max(1, (LINE - len("MG ")) // (1 + max(map(len, items), default=0)))
        for first in range(0, len(items), fit):
            found += self.again(partial(self._row, items[first : first + fit], digits))
        return found

    def _row(self, items: Sequence[str], digits: int) -> list[int]:
        reply = self.line("MG " + ",".join(items))
        parts = re.findall(f"[- ]\\d{{{digits}}}", reply.text)
        if not reply.accepted or len(parts) != len(items):
            raise reply.odd()
        return [int(part.replace(" ", "")) for part in parts]

    def code(self) -> int:
        """The error code, by TC."""
        reply = self.line("TC")
        found = re.search(r"\d+", reply.text)
        if found is None:
            raise reply.odd()
        return int(found.group())

    def refusal(self, text: str) -> int:
        """The code of a line that must be refused and does nothing; 0 when it was accepted."""
        return self.again(lambda: self._refusal(text))

    def _refusal(self, text: str) -> int:
        reply = self.line(text)
        if reply.accepted:
            return 0
        if not reply.refused:
            raise reply.odd()
        return self.code()

    def listen(self, seconds: float) -> bytes:
        """Waits, and answers what came unasked meanwhile."""
        return self._transport.read(seconds)


def highest(fits: Callable[[int], bool], low: int, high: int) -> int:
    """The highest of a range that fits, by halving."""
    while low < high:
        middle = (low + high + 1) // 2
        low, high = (middle, high) if fits(middle) else (low, middle - 1)
    return low
