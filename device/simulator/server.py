"""Serves a simulated controller in real time: its port 1 on a TCP socket or a pseudo-terminal."""

from __future__ import annotations

import json
import select
import socket
import sys
import threading
import time
from collections import deque
from typing import Final, Protocol, TextIO

from device.simulator.simulation import Simulation
from device.simulator.times import CHARACTER_BITS, TICKS

SLICE_S: Final = 0.005
FELL_BEHIND_S: Final = 0.5  # after that (a suspended computer) virtual time does not hurry to catch up
UNPACED_BYTES: Final = 4096
RECORDS_KEPT: Final = 200  # newest messages and errors that `state` tells; a served controller runs for days


class Line(Protocol):
    """The host's end of port 1."""

    address: str

    def wait(self, seconds: float, *, want: bool) -> None: ...
    def read(self, most: int) -> bytes: ...
    def write(self, data: bytes) -> bool: ...
    def close(self) -> None: ...


class TcpLine:
    """One client at a time; a newer one takes over, as a plug does."""

    def __init__(self, address: str) -> None:
        host, _, port = address.rpartition(":")
        self._listener = socket.create_server((host or "127.0.0.1", int(port)))
        self._listener.setblocking(False)
        self._client: socket.socket | None = None
        self._pending = bytearray()
        name = self._listener.getsockname()
        self.address = f"{name[0]}:{name[1]}"

    def wait(self, seconds: float, *, want: bool) -> None:
        """Until a client has something to say (when it is wanted), or the time is over."""
        watched = [self._listener]
        if want and self._client is not None:
            watched.append(self._client)
        readable, _, _ = select.select(watched, [], [], max(0.0, seconds))
        if self._listener in readable:
            self._accept()

    def _accept(self) -> None:
        try:
            client, _ = self._listener.accept()
        except OSError:  # it has gone again
            return
        self._drop()
        client.setblocking(False)
        client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._client = client

    def _drop(self) -> None:
        if self._client is not None:
            self._client.close()
        self._client = None
        self._pending.clear()

    def read(self, most: int) -> bytes:
        if self._client is None:
            return b""
        try:
            data = self._client.recv(most)
        except BlockingIOError:
            return b""
        except OSError:
            data = b""
        if not data:
            self._drop()
        return data

    def write(self, data: bytes) -> bool:
        """Sends; False while the client does not take it."""
        if self._client is None:
            return True
        self._pending += data
        try:
            if self._pending:
                del self._pending[: self._client.send(self._pending)]
        except BlockingIOError:
            return False
        except OSError:
            self._drop()
        return not self._pending

    def close(self) -> None:
        self._drop()
        self._listener.close()


def tell_tick(simulation: Simulation, began: float, first: int, now: float) -> int:
    """The tick that belongs to a moment of real time."""
    return first + int((now - began) * TICKS) - simulation.ticks


class Server:
    """Keeps virtual time on real time by absolute deadlines, and carries bytes and control lines."""

    def __init__(self, simulation: Simulation, line: Line, control: ControlLines | None = None) -> None:
        self.simulation = simulation
        self.line = line
        self.control = control
        self._began = time.monotonic()
        self._first = simulation.ticks
        self._slices = 0

    def run(self) -> None:
        """Until the control lines end; for ever without them."""
        while self.control is None or not self.control.ended:
            self.step()
        self.line.close()

    def step(self) -> None:
        """One slice: waits for bytes up to its deadline, then brings the simulation up to now."""
        most = self._most()
        self.line.wait(self._deadline() - time.monotonic(), want=most > 0)
        self._catch_up()
        data = self.line.read(most) if most > 0 else b""
        if data:
            self.simulation.receive(1, data)
        if self.control is not None:
            self.control.carry_out(self.simulation, self.received())
        self._send()

    def _deadline(self) -> float:
        now = time.monotonic()
        if now - self._began > self._slices * SLICE_S + FELL_BEHIND_S:
            self._began, self._first, self._slices = now, self.simulation.ticks, 0
        while self._began + self._slices * SLICE_S <= now:
            self._slices += 1
        return self._began + self._slices * SLICE_S

    def _catch_up(self) -> None:
        due = tell_tick(self.simulation, self._began, self._first, time.monotonic())
        if due > 0:
            self.simulation.advance(due)
            self.simulation.unit.clock.catch_up(self.simulation.ticks)

    def _most(self) -> int:
        """Characters the line can take now: two slices' worth, so that what the host still queues stays its own."""
        uart = self.simulation.uarts[0]
        if not uart.clear_to_send:
            return 0
        if uart.baud is None:
            return UNPACED_BYTES
        return 2 + int(2 * SLICE_S * uart.baud / CHARACTER_BITS) - len(uart.line)

    def received(self) -> list[list[float]]:
        """The last characters clocked in: moments of `time.monotonic()` and codes."""
        history = self.simulation.uarts[0].history
        return [[self._began + (tick - self._first) / TICKS, byte] for tick, byte in history]

    def _send(self) -> None:
        uart = self.simulation.uarts[0]
        taken = self.line.write(self.simulation.transmit(1))
        self.simulation.unit.records.keep(RECORDS_KEPT)
        if taken != uart.host_ready:
            uart.set_host_ready(taken, self.simulation.ticks)


class ControlLines:
    """Lines of standard input: `signal,value` is a stimulus, `state` prints the state as one JSON line."""

    def __init__(self, source: TextIO, answers: TextIO) -> None:
        self.ended = False
        self._answers = answers
        self._lines: deque[str] = deque()
        self._reader = threading.Thread(target=self._read, args=(source,), daemon=True)
        self._reader.start()

    def _read(self, source: TextIO) -> None:
        for line in source:
            self._lines.append(line.strip())
        self.ended = True

    def carry_out(self, simulation: Simulation, received: list[list[float]]) -> None:
        """Everything that has been asked for."""
        while self._lines:
            self._one(simulation, self._lines.popleft(), received)

    def _one(self, simulation: Simulation, line: str, received: list[list[float]]) -> None:
        if line == "state":
            print(json.dumps({**simulation.state(), "received": received}), file=self._answers, flush=True)
        elif line:
            signal, _, value = line.partition(",")
            try:
                simulation.stimulus(signal, value)
            except (KeyError, ValueError) as reason:
                print(f"twoletter: {reason.args[0]}", file=sys.stderr, flush=True)


def open_line(*, pty: bool, tcp: str | None) -> Line:
    """The pseudo-terminal (not on Windows) or the socket."""
    if pty:
        from device.simulator.terminal_line import TerminalLine

        return TerminalLine()
    return TcpLine(tcp or "127.0.0.1:0")


def serve(simulation: Simulation, *, pty: bool = False, tcp: str | None = None, control: bool = False) -> None:
    """Serves until interrupted, or until standard input ends where it controls."""
    line = open_line(pty=pty, tcp=tcp)
    print(f"listening on {line.address}", flush=True)
    lines = ControlLines(sys.stdin, sys.stdout) if control else None
    try:
        Server(simulation, line, lines).run()
    except KeyboardInterrupt:
        line.close()
