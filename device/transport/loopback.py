"""A simulated controller in this process, driven by its own virtual clock: waiting costs no time."""

from __future__ import annotations

from typing import Protocol

TICKS = 1_024_000  # virtual ticks of one true second
SLICE = 1024  # one true millisecond


class Simulated(Protocol):
    """What the loopback needs of a simulation."""

    @property
    def ticks(self) -> int: ...
    def receive(self, port: int, data: bytes) -> None: ...
    def transmit(self, port: int) -> bytes: ...
    def advance(self, ticks: int) -> None: ...


class Loopback:
    """Reading lets virtual time pass; `clock` is the time to give to the link."""

    def __init__(self, simulation: Simulated) -> None:
        self.simulation = simulation
        self.unplugged = False

    @property
    def description(self) -> str:
        return "simulator in this program"

    def clock(self) -> float:
        return self.simulation.ticks / TICKS

    def read(self, timeout_s: float) -> bytes:
        end = self.simulation.ticks + max(int(timeout_s * TICKS), 1)
        while True:
            data = self.simulation.transmit(1)
            if self.unplugged:
                data = b""
            if data or self.simulation.ticks >= end:
                return data
            self.simulation.advance(min(SLICE, end - self.simulation.ticks))

    def write(self, data: bytes) -> int:
        if not self.unplugged:
            self.simulation.receive(1, data)
        return len(data)

    def unsent(self) -> int:
        return 0

    def discard_output(self) -> None:
        """Everything written is already on the line."""

    def close(self) -> None:
        """Nothing to close."""
