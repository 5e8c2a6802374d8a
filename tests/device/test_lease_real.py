"""Hold-to-run over a pseudo-terminal, with the simulator in a process that survives the studio (safety.md, 4)."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator, Sequence
from typing import IO

import pytest

from device.simulator.process import SimulatorProcess
from tests.device.holding import ACCELERATION, SPEED
from tests.device.test_latency import NO_PTY, wait_until
from tests.long import count, is_long, record
from tests.slower import queued_s

STOPPING_S = SPEED / ACCELERATION
LEASE_S, DEAD_S = 0.15, 0.5  # safety.md, 4: beyond the stopping time; where the computer is dead
SEEN_S = 0.03  # between two looks at the simulator
BEAT_S, STALL_S = 0.004, 0.05
MOST_DISTURBED = count(5, 100)  # trials that are repeated because the computer stood still
pytestmark = [NO_PTY, pytest.mark.alone, pytest.mark.timeout(1800)]
WITHIN = {
    "release": LEASE_S,
    "freeze": 2 * LEASE_S,  # from the last renewal: the lease lapses, then the stop is sent
    "unplug": DEAD_S,
    "SIGSTOP": DEAD_S,
    "SIGKILL": DEAD_S,
}


class Studio:
    """The process that holds, and the machine it holds; `more` and another module hold by a window."""

    def __init__(
        self, machine: SimulatorProcess, baud: int, module: str = "tests.device.holding", more: Sequence[str] = ()
    ) -> None:
        self.machine = machine
        self.process = subprocess.Popen(
            [sys.executable, "-m", module, machine.address, str(baud), *more],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env={**os.environ, "PYTHONPATH": os.getcwd()},
        )
        assert self._out.readline() == "ready\n"

    @property
    def _out(self) -> IO[str]:
        assert self.process.stdout is not None
        return self.process.stdout

    def tell(self, word: str) -> None:
        assert self.process.stdin is not None
        self.process.stdin.write(f"{word}\n")
        self.process.stdin.flush()

    def told(self, word: str) -> None:
        self.tell(word)
        assert self._out.readline() == f"{word}\n"

    def end(self) -> None:
        self.process.kill()
        self.process.wait()
        for pipe in (self.process.stdin, self.process.stdout):
            if pipe is not None:
                pipe.close()


@pytest.fixture(params=[9600, 19200] if is_long() else [19200])
def machine(request: pytest.FixtureRequest) -> Iterator[tuple[SimulatorProcess, int]]:
    with SimulatorProcess("ssc2", baud=request.param, pty=True) as process:
        yield process, request.param


def axis(machine: SimulatorProcess) -> dict[str, float]:
    found: dict[str, float] = machine.state()["axes"]["X"]
    return found


def run(machine: SimulatorProcess, studio: Studio, letting_go: str = "freeze") -> None:
    """Held, at speed; pressed again where a busy computer let the lease lapse."""
    for _ in range(10):
        start = axis(machine)["commanded"]
        studio.told("hold")
        begins(machine)
        wait_until(lambda: not axis(machine)["moving"] or axis(machine)["commanded"] - start > SPEED * 0.25, 5.0)  # noqa: B023
        if axis(machine)["moving"]:
            return
        studio.told(letting_go)
        time.sleep(0.3)
    raise AssertionError("the axis was never held")


def begins(machine: SimulatorProcess) -> None:
    """Until it moves, for two seconds; a press may come while what was before is still being put back."""
    end = time.monotonic() + 2.0
    while not axis(machine)["moving"] and time.monotonic() < end:
        time.sleep(0.01)


class Disturbed(AssertionError):
    """The computer itself stood still meanwhile, as far as a pseudo-terminal that nobody else uses can tell."""


class Heart:
    """Sends a byte through a pseudo-terminal every few milliseconds: how long this computer lets a line wait."""

    def __init__(self) -> None:
        import tty  # there is none on Windows

        self._ends = os.openpty()
        tty.setraw(self._ends[1])
        self.worst = 0.0
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._beat, daemon=True)

    def __enter__(self) -> Heart:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._over.set()
        self._thread.join()
        for end in self._ends:
            os.close(end)

    def _beat(self) -> None:
        before = time.monotonic()
        while not self._over.wait(BEAT_S):
            os.write(self._ends[0], b"x")
            os.read(self._ends[1], 1)
            now = time.monotonic()
            self.worst = max(self.worst, now - before - BEAT_S)
            before = now


def stopped(machine: SimulatorProcess, began: float) -> float:
    """Seconds until the axis stands; and it stays there."""
    wait_until(lambda: not axis(machine)["moving"], 5.0)
    taken = time.monotonic() - began
    place = axis(machine)["commanded"]
    time.sleep(0.1)
    assert axis(machine)["commanded"] == place
    return taken


def trial(machine: SimulatorProcess, studio: Studio, way: str) -> float:
    """Seconds from what ends the hold until the axis stands; too long, while the computer stood still, is Disturbed."""
    run(machine, studio)
    pids = machine.pid, studio.process.pid
    with Heart() as heart:
        began, queued = time.monotonic(), queued_s(*pids)
        if way.startswith("SIG"):
            studio.process.send_signal(getattr(signal, way))
        else:
            studio.tell(way)
        taken = stopped(machine, began)
        if not is_long():
            taken -= max(0.0, queued_s(*pids) - queued)  # what other programs had of the processors
    after(machine, studio, way)
    if taken > WITHIN[way] + STOPPING_S + SEEN_S and heart.worst > STALL_S:
        raise Disturbed(f"{way}: {taken:.3f} s, while a line had to wait for {heart.worst:.3f} s")
    assert taken <= WITHIN[way] + STOPPING_S + SEEN_S, (way, heart.worst)
    return taken


def after(machine: SimulatorProcess, studio: Studio, way: str) -> None:
    """As it was, for the next one."""
    if way == "SIGSTOP":
        studio.process.send_signal(signal.SIGCONT)
        time.sleep(0.3)
        assert not axis(machine)["moving"]  # it wakes, and nothing starts again
        studio.told("freeze")
    elif way == "unplug":
        assert studio._out.readline() == "unplug\n"
        studio.told("plug")
    elif way != "SIGKILL":
        assert studio._out.readline() == f"{way}\n"


def tried(machine: SimulatorProcess, studio: Studio, way: str, disturbed: list[str]) -> float | None:
    """A trial; nothing where the computer stood still, which is noted."""
    try:
        return trial(machine, studio, way)
    except Disturbed as reason:
        disturbed.append(str(reason))
        return None


def test_an_axis_that_is_let_go_stands_in_time(machine: tuple[SimulatorProcess, int]) -> None:
    process, baud = machine
    ways = [way for way in WITHIN if way != "SIGKILL"] * count(1, 100) + ["SIGKILL"] * count(1, 100)
    worst: dict[str, float] = {}
    disturbed: list[str] = []
    studio = Studio(process, baud)
    try:
        while ways:
            if studio.process.poll() is not None:
                studio = Studio(process, baud)
            way = ways[0]
            taken = tried(process, studio, way, disturbed)
            if way == "SIGKILL":
                studio.end()
            if taken is not None:
                ways.pop(0)
                worst[way] = max(worst.get(way, 0.0), taken)
            assert len(disturbed) <= MOST_DISTURBED, disturbed
    finally:
        studio.end()
    for way, seconds in worst.items():
        record(f"hold: {way} to standstill, {baud} baud", "pytest tests/device/test_lease_real.py", None, seconds, "s")
    print({way: round(seconds, 3) for way, seconds in worst.items()}, disturbed)
    assert set(worst) == set(WITHIN)
