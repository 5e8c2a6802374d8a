"""STOP in real time: from the call until the simulated port has clocked in its last byte, and over real ports."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import pytest

from device.api import Controller, Kind, State, StopState
from device.simulator.process import SimulatorProcess
from device.transport import LineSettings, Transport, open_transport
from tests.long import count, is_long, record
from tests.slower import queued_s

LISTING = "\n".join(
    ["#A", *(f"PR {n},{n},{n},{n};SP {n};NO A LONG LINE OF A PROGRAM {n}" for n in range(count(10, 100))), "EN"]
)
NO_PTY = pytest.mark.skipif(sys.platform == "win32", reason="no pseudo-terminals there")
LIMIT_MS = {19200: 60.0, 9600: 110.0}


def wait_until(true: Callable[[], bool], seconds: float = 15.0) -> None:
    end = time.monotonic() + seconds
    while not true():
        assert time.monotonic() < end, f"not within {seconds} s"
        time.sleep(0.002)


BURST = b"\x11\x1b\\ST\rST\r"  # from any state but command mode


class Tap:
    """A line that takes nothing behind a stop until it is let go: so the stop is the last that the port clocks in."""

    def __init__(self, inner: Transport) -> None:
        self.inner = inner
        self.look = self.held = False
        self.written = b""

    @property
    def stop(self) -> bytes:
        """The stop that was written last."""
        return BURST if self.written.endswith(BURST) else b"ST\r"

    def let_go(self) -> None:
        self.look = self.held = False

    @property
    def description(self) -> str:
        return self.inner.description

    def read(self, timeout_s: float) -> bytes:
        return self.inner.read(timeout_s)

    def write(self, data: bytes) -> int:
        if self.held:
            return 0
        taken = self.inner.write(data)
        self.written = (self.written + data[:taken])[-len(BURST) :]
        self.held = self.look and self.written.endswith(b"ST\r") and taken == len(data)
        return taken

    def unsent(self) -> int:
        return self.inner.unsent()

    def discard_output(self) -> None:
        self.inner.discard_output()

    def close(self) -> None:
        self.inner.close()


@contextmanager
def connected(
    baud: int, *, pty: bool = False, wrap: Callable[[Transport], Transport] = lambda inner: inner
) -> Iterator[tuple[SimulatorProcess, Controller]]:
    line = LineSettings(baud=baud)
    with SimulatorProcess("ssc4", baud=baud, pty=pty) as process:
        controller = Controller(lambda: wrap(open_transport(process.address, line)), kind=Kind.SIMULATOR, line=line)
        try:
            wait_until(lambda: controller.state is State.READY)
            controller.watch("all", controller.columns)
            yield process, controller
        finally:
            controller.close()


def clocked_in(process: SimulatorProcess, tap: Tap, pressed: float) -> float:
    """Seconds from the press to the last byte of the stop, by the serving process's own clock of arrivals.

    Where that process was kept waiting its clock lags; then the moment counts at which the arrival was seen from here.
    The everyday run leaves out what other programs had of the processors meanwhile.
    """
    queued = queued_s(process.pid)
    for _ in range(500):
        received = process.state()["received"] if tap.held else []
        if received and bytes(int(byte) for _, byte in received).endswith(tap.stop):
            at = float(received[-1][0])
            others = 0.0 if is_long() else queued_s(process.pid) - queued
            return max(0.0, (at if at > pressed else time.monotonic()) - pressed - others)
        time.sleep(0.002)
    raise AssertionError("the stop never arrived")


def busy(controller: Controller, load: str) -> None:
    """Puts the line under load."""
    if load == "download":
        job = controller.download(LISTING)
        wait_until(lambda: job.phase == "sending" and job.done > 5, 40.0)
    elif load == "upload":
        controller.upload()
        time.sleep(0.05)
    else:
        wait_until(lambda: controller.polling)


@pytest.mark.alone
@pytest.mark.timeout(3600)
@pytest.mark.parametrize("baud", [19200, 9600])
def test_latency_of_stop(baud: int) -> None:
    taken: list[float] = []
    taps: list[Tap] = []

    def tapped(inner: Transport) -> Transport:
        taps.append(Tap(inner))
        return taps[-1]

    with connected(baud, pty=sys.platform != "win32", wrap=tapped) as (process, controller):
        controller.download(LISTING).future.result(120)
        for trial in range(count(9, 501)):
            busy(controller, ("polling", "upload", "download")[trial % 3])
            time.sleep((trial * 37 % 50) / 1000)
            taps[-1].look = True
            pressed = time.monotonic()
            controller.stop()
            taken.append(clocked_in(process, taps[-1], pressed) * 1000)
            taps[-1].let_go()
            wait_until(lambda: controller.stop_state is StopState.STOPPED)
            wait_until(lambda: controller.polling)
    taken.sort()
    # of 9 trials the worst is beyond the true p99 in 9 % of runs, the second worst in 0.3 %: that one is judged
    p99 = taken[-2] if len(taken) < 100 else taken[int(len(taken) * 0.99)]
    middle, worst = taken[len(taken) // 2], taken[-1]
    for name, figure in (("median", middle), ("p99", p99), ("worst", worst)):
        record(f"stop latency {name} at {baud}", "pytest tests/device/test_latency.py", 0, figure, "ms")
    print(f"stop latency at {baud}, {len(taken)} trials: median {middle:.1f}, p99 {p99:.1f}, worst {worst:.1f} ms")
    assert p99 <= LIMIT_MS[baud]


STATES = ((), ("DL", "#A"), ("QD Q[],0,9", "1"), ("ED",), ("XQ #B",))


@pytest.mark.paced
@pytest.mark.parametrize("pty", [False, pytest.param(True, marks=NO_PTY)])
def test_stop_over_real_ports(pty: bool) -> None:
    """An axis jogs, and the port is in command mode, takes a program, an array, an editor's line, an answer."""
    with connected(19200, pty=pty) as (process, controller):
        for typed in STATES:
            controller.download('#B\nIN "HOW MANY",N\nJP #B').future.result(20)
            for line in ["DM Q[0]", "DM Q[10]", "SH", "JG 50000;BG X", *typed]:
                assert controller.ask(line).result(5).accepted, line
            wait_until(lambda: process.state()["axes"]["X"]["moving"])
            controller.stop()
            wait_until(lambda: controller.stop_state is StopState.STOPPED)
            state = process.state()
            assert not any(axis["moving"] for axis in state["axes"].values()), typed
            assert not any(thread["running"] for thread in state["threads"]), typed
        held = controller.upload().future.result(20)
        assert "ST" not in held.replace("\n", ";").split(";")
