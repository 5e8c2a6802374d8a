"""Bytes on their way out: at most 32 of them wait in the operating system, where they could not be taken back."""

from __future__ import annotations

from collections.abc import Callable

from device.transport import LineSettings, Transport

AHEAD = 32  # bytes that may wait in the operating system
LAST_S = 0.3  # for the stop of what moves by hand, when the line is closed


class Outgoing:
    """What is still to be handed over, and when the line will be clear of what was."""

    def __init__(self, line: LineSettings, clock: Callable[[], float]) -> None:
        self._line, self._clock = line, clock
        self._left = bytearray()
        self.clear_at = 0.0  # when the last byte handed over has travelled
        self._handed = 0  # bytes of this round

    def __bool__(self) -> bool:
        """Whether a line is only begun."""
        return bool(self._left)

    def put(self, data: bytes) -> None:
        self._left += data

    def opened(self) -> None:
        """A fresh line: nothing waits in it."""
        self.clear()
        self.clear_at = self._clock()

    def clear(self) -> None:
        """What was not handed over yet never leaves."""
        self._left.clear()

    def discarded(self) -> None:
        """What the operating system held was thrown away, too."""
        self.clear()
        self.clear_at = min(self.clear_at, self._clock() + AHEAD * self._line.byte_s)

    def new_round(self) -> None:
        """Replies have been looked for; so much may leave again before they are."""
        self._handed = 0

    @property
    def room_in_round(self) -> bool:
        """Whether something was handed over in this round, and less than may wait."""
        return 0 < self._handed < AHEAD

    def hand_over(self, transport: Transport, urgent: bool) -> bool:
        """Gives the transport as much as may wait there, all of it where it is urgent; whether that was the last."""
        if not self._left:
            return False
        now, byte_s = self._clock(), self._line.byte_s
        waiting = int(max(self.clear_at - now, 0.0) / byte_s) if byte_s else 0
        room = len(self._left) if urgent else AHEAD - max(waiting, transport.unsent())
        if room <= 0:
            return False
        sent = transport.write(bytes(self._left[:room]))
        del self._left[:sent]
        self._handed += sent
        self.clear_at = max(self.clear_at, now) + sent * byte_s
        return not self._left


class Echo:
    """What a controller that echoes (EO 1) sends back of lines that get no answer: no reply to them, and no text."""

    def __init__(self) -> None:
        self.on = False  # as the last answer has shown
        self._pending = bytearray()
        self._returned = False  # a return was echoed just now: a line feed may follow

    def sent(self, data: bytes, transfer: bool) -> None:
        """Lines of a transfer come back byte by byte; behind it whole lines are recognised."""
        if not transfer:
            self._pending.clear()
        elif self.on:
            self._pending += data

    def taken_from(self, data: bytes) -> bytes:
        """What came besides."""
        if not self._pending and not self._returned:
            return data
        kept = bytearray()
        for byte in data:
            if self._pending and byte & 0x7F == self._pending[0]:
                del self._pending[0]
                self._returned = byte & 0x7F == 0x0D
            elif not (self._returned and byte & 0x7F == 0x0A):
                kept.append(byte)
        return bytes(kept)


def say_last(transport: Transport, words: bytes, clock: Callable[[], float]) -> None:
    """Closing a port throws away what has not left: so the stop of what moves by hand is waited for."""
    end = clock() + LAST_S
    while words and clock() < end:
        words = words[transport.write(words) :]
        transport.read(0.005)
    while words == b"" and transport.unsent() and clock() < end:
        transport.read(0.005)
