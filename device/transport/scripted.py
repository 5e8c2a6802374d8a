"""A transport that plays a script: exactly these bytes must be sent, and these come back."""

from __future__ import annotations

from collections.abc import Callable

from device.transport import TransportLost

Answer = bytes | Callable[[bytes], bytes]


class Scripted:
    """`Scripted((b"TPX\\r", b" 0000000012\\r\\n:"), …)`: pairs of what is sent and what comes back, in order.

    Waiting advances its own clock, so nothing in a test sleeps.
    """

    def __init__(self, *script: tuple[bytes, Answer]) -> None:
        self._script = list(script)
        self._sent = b""
        self._incoming = b""
        self.everything_sent = b""
        self.now = 0.0
        self.lost = False
        self.discarded = 0

    @property
    def description(self) -> str:
        return "script"

    def clock(self) -> float:
        return self.now

    def say(self, data: bytes) -> None:
        """Bytes that come without being asked for."""
        self._incoming += data

    def read(self, timeout_s: float) -> bytes:
        if self.lost:
            raise TransportLost("The script pulled the plug.")
        if not self._incoming:
            self.now += timeout_s
        data, self._incoming = self._incoming, b""
        return data

    def write(self, data: bytes) -> int:
        if self.lost:
            raise TransportLost("The script pulled the plug.")
        self.everything_sent += data
        self._sent += data
        while self._script and self._sent:
            expected, answer = self._script[0]
            if len(self._sent) < len(expected):
                assert expected.startswith(self._sent), f"sent {self._sent!r}, expected {expected!r}"
                break
            assert self._sent.startswith(expected), f"sent {self._sent!r}, expected {expected!r}"
            self._sent = self._sent[len(expected) :]
            self._script.pop(0)
            self._incoming += answer(expected) if callable(answer) else answer
        return len(data)

    def unsent(self) -> int:
        return 0

    def discard_output(self) -> None:
        self.discarded += 1

    def close(self) -> None:
        """Nothing to close."""

    def assert_finished(self) -> None:
        """Everything expected was sent, and nothing else."""
        assert not self._script, f"never sent: {self._script[0][0]!r}"
        assert not self._sent, f"sent beyond the script: {self._sent!r}"
