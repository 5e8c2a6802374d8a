"""Hold-to-run over a pseudo-terminal, with the simulator in a process that survives the studio (safety.md, 4)."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from typing import IO

import pytest

from device.simulator.process import SimulatorProcess
from tests.device.holding import ACCELERATION, SPEED
from tests.device.test_latency import NO_PTY, wait_until
from tests.long import count, is_long, record

STOPPING_S = SPEED / ACCELERATION
LEASE_S, DEAD_S = 0.15, 0.5  # safety.md, 4: beyond the stopping time; where the computer is dead
SEEN_S = 0.03  # between two looks at the simulator
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
        wait_until(lambda: axis(machine)["moving"], 5.0)
        wait_until(lambda: not axis(machine)["moving"] or axis(machine)["commanded"] - start > SPEED * 0.25, 5.0)  # noqa: B023
        if axis(machine)["moving"]:
            return
        studio.told(letting_go)
        time.sleep(0.3)
    raise AssertionError("the axis was never held")


def stopped(machine: SimulatorProcess, began: float, limit: float) -> float:
    """Seconds until the axis stands."""
    wait_until(lambda: not axis(machine)["moving"], 5.0)
    taken = time.monotonic() - began
    place = axis(machine)["commanded"]
    time.sleep(0.1)
    assert axis(machine)["commanded"] == place
    assert taken <= limit + STOPPING_S + SEEN_S
    return taken


def trial(machine: SimulatorProcess, studio: Studio, way: str) -> float:
    run(machine, studio)
    began = time.monotonic()
    if way.startswith("SIG"):
        studio.process.send_signal(getattr(signal, way))
    else:
        studio.tell(way)
    taken = stopped(machine, began, WITHIN[way])
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
    return taken


def test_an_axis_that_is_let_go_stands_in_time(machine: tuple[SimulatorProcess, int]) -> None:
    process, baud = machine
    ways = [way for way in WITHIN if way != "SIGKILL"] * count(2, 100) + ["SIGKILL"] * count(1, 100)
    worst: dict[str, float] = {}
    studio = Studio(process, baud)
    try:
        for way in ways:
            if studio.process.poll() is not None:
                studio = Studio(process, baud)
            taken = trial(process, studio, way)
            worst[way] = max(worst.get(way, 0.0), taken)
            if way == "SIGKILL":
                studio.end()
    finally:
        studio.end()
    for way, seconds in worst.items():
        record(f"hold: {way} to standstill, {baud} baud", "pytest tests/device/test_lease_real.py", None, seconds, "s")
    print({way: round(seconds, 3) for way, seconds in worst.items()})
    assert set(worst) == set(WITHIN)
