"""How bytes reach a controller: one small protocol, and one function that opens an address."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, Protocol, runtime_checkable

Handshake = Literal["none", "rts", "xon", "both"]
Parity = Literal["none", "even", "odd"]
ONLY_WATCHED = "This is a recording: it can only be watched, nothing is sent."


class OpenFailed(Exception):
    """The port could not be opened; the text is the sentence to show."""


class TransportLost(Exception):
    """The cable, device or socket is gone; the text is the sentence to show."""


@dataclass(frozen=True, slots=True)
class LineSettings:
    """How the serial line is set; `baud` None is a line without a speed of its own (a simulator)."""

    baud: int | None = 9600
    bits: int = 8
    parity: Parity = "none"
    stop_bits: int = 1
    handshake: Handshake = "none"
    address: int | None = None

    @property
    def byte_s(self) -> float:
        """Seconds one byte takes on the line (0 where the line has no speed)."""
        if self.baud is None:
            return 0.0
        return (1 + self.bits + (self.parity != "none") + self.stop_bits) / self.baud


class Transport(Protocol):
    """A line to a controller."""

    @property
    def description(self) -> str:
        """What it is, in words for the status bar."""
        ...

    def read(self, timeout_s: float) -> bytes:
        """Bytes that have come, or nothing after the time-out; raises TransportLost."""
        ...

    def write(self, data: bytes) -> int:
        """Hands bytes to the operating system, says how many it took, never waits; raises TransportLost."""
        ...

    def unsent(self) -> int:
        """Bytes written that have not left the machine yet, as far as the system tells."""
        ...

    def discard_output(self) -> None:
        """Throws away what was written and has not left yet, as far as the system can."""
        ...

    def close(self) -> None: ...


@runtime_checkable
class Wired(Protocol):
    """A line that has handshake wires."""

    def clear_to_send(self) -> bool | None:
        """Whether the other end lets us send (CTS); None where the port cannot tell."""
        ...


def open_transport(address: str, line: LineSettings | None = None) -> Transport:
    """Opens `socket://host:port` or a serial device; raises OpenFailed with one sentence."""
    line = line or LineSettings()
    if address.startswith("socket://"):
        from device.transport.tcp import Tcp

        return Tcp(address, line)
    from device.transport.serial_port import SerialPort

    return SerialPort(address, line)
