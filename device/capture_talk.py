"""What a capture says to the controller: lines that outlive STOP, framed reads, a pace that leaves others room."""

from __future__ import annotations

from typing import TYPE_CHECKING

from codegen.twoletter.problems import ERROR_TEXTS
from device.poll import SHARE
from device.proof import with_proof
from device.tasks import LinkError, LinkLost, NotAllowed, Refused, Send, Steps, Stopped, Wait
from device.undecided import NOTHING
from device.wire import Answer, Expectation, Frame, Kind, Shape, framed

if TYPE_CHECKING:
    from device.api import Controller

NOT = "Not captured"
LINE_S = 1.5
TRIES = 4
ELEMENT_BYTES = 17  # of QU while VF is 10.4
CHUNK_S = 0.15  # of the line: a STOP never waits behind more
CHUNK_MOST = 60
BRIEF = 2  # elements while somebody holds an axis


class Talk:
    """Exchanges of one capture."""

    def __init__(self, c: Controller) -> None:
        self._c = c
        self._last_s = 0.0

    def chunk(self) -> int:
        """Elements to read at once, so that neither STOP nor a held axis nor a program waits long."""
        if self._c.poller.brief:
            return BRIEF
        byte_s = self._c.line.byte_s
        return max(1, min(CHUNK_MOST, int(CHUNK_S / (ELEMENT_BYTES * byte_s)))) if byte_s else CHUNK_MOST

    def programs_run(self) -> bool:
        return self._c.waiting.position != frozenset()

    def breathe(self) -> Steps[None]:
        """Lets live values in between; while a program runs they and we leave most of the line alone."""
        if not self.programs_run():
            yield from self.pause(0.001)
            return
        yield from self.pause(self._last_s * (1 / SHARE - 1))

    def pause(self, seconds: float) -> Steps[None]:
        try:
            yield Wait(seconds)
        except Stopped:
            return

    def exchange(
        self, data: bytes, expect: Expectation, timeout_s: float = LINE_S, *, keep: bool = False, extends: bool = False
    ) -> Steps[Answer]:
        """Sends where nothing waits for an answer of a person; with `keep` again after a STOP."""
        while True:
            while self._c.resting():
                yield from self.pause(0.1)
            start = self._c.clock()
            try:
                answer = yield Send(data, expect, timeout_s, refusal_s=0.05, extends=extends)
            except Stopped:
                if not keep:
                    raise
                yield from self.pause(0.2)
                continue
            except NotAllowed:
                if not self._c.resting():
                    raise
                continue
            self._last_s = self._c.clock() - start
            if answer.kind is Kind.SILENT:
                raise LinkLost("Capture ended: the controller does not answer.")
            return answer

    def numbers(self, *reads: tuple[str, Shape], keep: bool = False) -> Steps[list[float]]:
        """Values read framed; asked again where a program's text came in between."""
        shapes = tuple(shape for _, shape in reads)
        for _ in range(TRIES):
            nonce = next(self._c.nonces)
            line = framed(nonce, reads).encode() + b"\r"
            answer = yield from self.exchange(line, Frame(nonce, shapes), 0.8, keep=keep)
            if answer.kind is Kind.VALUES:
                return list(answer.values)
        if answer.text.strip() == "?":
            raise LinkError(f"Capture ended: the controller has no {reads[0][0]} any more (was it reset?).")
        raise LinkLost(f"Capture ended: reading {reads[0][0]} was disturbed {TRIES} times.")

    def known(self, expression: str) -> Steps[bool]:
        """Whether the controller can tell this value, which may be an array that is not there."""
        nonce, shape = next(self._c.nonces), Shape(10, 4)
        line = framed(nonce, ((expression, shape),)).encode() + b"\r"
        answer = yield from self.exchange(line, Frame(nonce, (shape,)), 0.8)
        if answer.kind is not Kind.VALUES:
            yield from self.fence()
        return answer.kind is Kind.VALUES

    def line_and_proof(self, line: str) -> tuple[bytes, Expectation]:
        """A line that sends nothing back but its proof: text that comes in between is a program's."""
        return with_proof(next(self._c.nonces), line, NOTHING)

    def accepted(self, line: str) -> Steps[bool]:
        """Sends one line; whether it was accepted."""
        answer = yield from self.exchange(*self.line_and_proof(line))
        if answer.kind is not Kind.ACCEPTED:
            yield from self.fence()
        return answer.kind is Kind.ACCEPTED

    def must(self, line: str, keep: bool = False) -> Steps[None]:
        """Sends one line, which must be accepted."""
        answer = yield from self.exchange(*self.line_and_proof(line), keep=keep)
        if answer.kind is not Kind.ACCEPTED:
            code = yield from self.fence()
            words = ERROR_TEXTS.get(code, "unknown error")
            raise Refused(code, f"{NOT}: “{line}” was refused, error {code}, {words}.")

    def fence(self) -> Steps[int]:
        """The error code; once it is told, everything sent before has been worked off."""
        (code,) = yield from self.numbers(("_TC", Shape(3, 0)), keep=True)
        return int(code)
