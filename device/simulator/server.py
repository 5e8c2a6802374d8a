"""Serves a simulated controller in real time: its ports on TCP sockets or pseudo-terminals."""

from __future__ import annotations

import gc
import json
import sys
import threading
import time
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final, Protocol, TextIO

from device.simulator.lines import wait
from device.simulator.times import CHARACTER_BITS, TICKS
from device.simulator.uart_faults import Fault

if TYPE_CHECKING:
    from codegen.models import Model
    from device.simulator.eeprom import Eeprom
    from device.simulator.lines import Line
    from device.simulator.loops import SampleLoop
    from device.simulator.motion import Motion
    from device.simulator.plant import Plant
    from device.simulator.twoletter.profile import Profile
    from device.simulator.uart import Uart

SLICE_S: Final = 0.005
FELL_BEHIND_S: Final = 0.5  # after that (a suspended computer) virtual time does not hurry to catch up
UNPACED_BYTES: Final = 4096
MOST_IN_CHAIN: Final = 8  # dmc-1412-1414.txt l.1302
RECORDS_KEPT: Final = 200  # newest messages and errors that `state` tells; a served controller runs for days


class Served(Protocol):
    """What is served: one simulated controller, or a chain of them behind one line."""

    @property
    def ticks(self) -> int: ...
    @property
    def motions(self) -> Sequence[Motion]: ...
    def line(self, port: int) -> Uart: ...
    def advance(self, ticks: int) -> None: ...
    def rest(self, records: int) -> None: ...
    def receive(self, port: int, data: bytes) -> None: ...
    def transmit(self, port: int) -> bytes: ...
    def stimulus(self, signal: str, value: float | str) -> None: ...
    def state(self) -> dict[str, Any]: ...


def tell_tick(simulation: Served, began: float, first: int, now: float) -> int:
    """The tick that belongs to a moment of real time."""
    return first + int((now - began) * TICKS) - simulation.ticks


class Server:
    """Keeps virtual time on real time by absolute deadlines, and carries bytes and control lines."""

    def __init__(
        self, simulation: Served, line: Line, control: ControlLines | None = None, second: Line | None = None
    ) -> None:
        self.simulation = simulation
        self.lines = {1: line} if second is None else {1: line, 2: second}
        self.control = control
        self._began = time.monotonic()
        self._first = simulation.ticks
        self._slices = 0

    def run(self) -> None:
        """Until the control lines end; for ever without them."""
        while self.control is None or not self.control.ended:
            self.step()
        for line in self.lines.values():
            line.close()

    def step(self) -> None:
        """One slice: waits for bytes up to its deadline, then brings the simulation up to now."""
        most = {port: self._most(self.simulation.line(port)) for port in self.lines}
        wait([(line, most[port] > 0) for port, line in self.lines.items()], self._deadline() - time.monotonic())
        self._catch_up()
        for port, line in self.lines.items():
            uart = self.simulation.line(port)
            uart.host_baud = line.host_baud() if uart.fault is Fault.SPEED else None
            data = line.read(most[port]) if most[port] > 0 else b""
            if data:
                self.simulation.receive(port, data)
        if self.control is not None:
            self.control.carry_out(self.simulation, self.facts)
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
            self.simulation.rest(RECORDS_KEPT)

    def _most(self, uart: Uart) -> int:
        """Characters the line can take now: two slices' worth, so that what the host still queues stays its own."""
        if uart.held:
            return max(0, UNPACED_BYTES - len(uart.line))  # an XON may be among them
        if not uart.clear_to_send:
            return 0
        if uart.baud is None:
            return UNPACED_BYTES
        return 2 + int(2 * SLICE_S * uart.baud / CHARACTER_BITS) - len(uart.line)

    def use(self, loop: SampleLoop) -> None:
        """The compiled loop is ready; what was loaded for it lives on, and need not be looked through for garbage."""
        for motion in self.simulation.motions:
            motion.use(loop)
        gc.freeze()

    def facts(self) -> dict[str, Any]:
        """Beside the state: the last characters clocked in (`time.monotonic()`, code), CTS, and which loop runs."""
        history = self.simulation.line(1).history
        return {
            "received": [[self._began + (tick - self._first) / TICKS, byte] for tick, byte in history],
            "clear_to_send": self.simulation.line(1).clear_to_send,
            "compiled": all(motion.compiled for motion in self.simulation.motions),
        }

    def _send(self) -> None:
        for port, line in self.lines.items():
            uart = self.simulation.line(port)
            data = self.simulation.transmit(port)
            taken = line.write(data if uart.host_ready or uart.handshake else b"")  # else nobody is there to take it
            if taken != uart.host_ready:
                uart.set_host_ready(taken, self.simulation.ticks)


class ControlLines:
    """Lines of standard input: `signal,value` is a stimulus, `fault,NAME` spoils the connection; `state` tells all."""

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

    def carry_out(self, simulation: Served, facts: Callable[[], dict[str, Any]]) -> None:
        """Everything that has been asked for."""
        while self._lines:
            self._one(simulation, self._lines.popleft(), facts)

    def _one(self, simulation: Served, line: str, facts: Callable[[], dict[str, Any]]) -> None:
        if line == "state":
            print(json.dumps({**simulation.state(), **facts()}), file=self._answers, flush=True)
        elif line:
            signal, _, value = line.partition(",")
            try:
                if signal == "fault":
                    simulation.line(1).fault = Fault(value)
                else:
                    simulation.stimulus(signal, value)
            except (KeyError, ValueError) as reason:
                print(f"twoletter: {reason.args[0]}", file=sys.stderr, flush=True)


def maker(
    model: Model,
    plants: Mapping[str, Plant] | None,
    eeproms: Sequence[Eeprom],
    *,
    chain: bool = False,
    baud: int | None = None,
    seed: int = 0,
    handshake: bool = True,
    profile: Profile | None = None,
) -> Callable[[], Served]:
    """Makes one controller, or a chain of as many as there are EEPROMs, on the plain loop; loads them only then."""

    def make() -> Served:
        if chain:
            from device.simulator.chain import make_chain

            return make_chain(
                model, plants, eeproms, baud=baud, seed=seed, compiled=False, handshake=handshake, profile=profile
            )
        from device.simulator.simulation import Simulation

        return Simulation(
            model, plants, eeproms[0], baud=baud, seed=seed, compiled=False, handshake=handshake, profile=profile
        )

    return make


def serve(
    make: Callable[[], Served],
    line: Line,
    *,
    second: Line | None = None,
    control: bool = False,
    fault: Fault = Fault.NONE,
) -> None:
    """Announces the lines, makes what is served, and serves it until interrupted or until standard input ends."""
    print(f"listening on {line.address}", flush=True)
    if second is not None:
        print(f"port 2 on {second.address}", flush=True)
    lines = ControlLines(sys.stdin, sys.stdout) if control else None
    try:
        from device.simulator.loops import Loading  # heavy, like what `make` loads: the line is announced before

        server = Server(make(), line, lines, second)
        server.simulation.line(1).fault = fault
        loading = Loading(server.use)
        loading.begin()
        try:
            server.run()
        finally:
            loading.end()
    except KeyboardInterrupt:
        for each in (line, second):
            if each is not None:
                each.close()
