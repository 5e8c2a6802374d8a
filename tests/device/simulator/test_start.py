"""A served simulator answers at once, on the plain loop, and goes over to the compiled one when that is ready."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest

from device.simulator import loops
from device.simulator.kernel.compiled import cache_folder, compiled_loop, plain_loop
from device.simulator.loops import Compiler, Loading, Readiness, SampleLoop, ThriftyLoop
from device.simulator.motion import Motion, Register, Watch
from device.simulator.process import SimulatorProcess
from tests.device.simulator.test_server import connect, until

SOON_S = 0.5
TIMES_NUMPY = 5.0  # where others use the processor, the start may take so many times as long as loading numpy


def numpy_s() -> float:
    """How long a process that only loads numpy takes now."""
    began = time.monotonic()
    subprocess.run([sys.executable, "-c", "import numpy"], check=True)
    return time.monotonic() - began


def start_s() -> tuple[float, float]:
    """Seconds from the start of the process to its address, and to its first answer."""
    began = time.monotonic()
    with SimulatorProcess("ssc4") as simulator:
        listening = time.monotonic() - began
        client = connect(simulator.address)
        client.sendall(b"TC\r")
        assert until(client, b":") == b"000\r\n:"
        return listening, time.monotonic() - began


@pytest.fixture
def cold(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty cache in which another process seems to compile; its folder."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setenv("LOCALAPPDATA", str(tmp_path))
    folder = cache_folder()
    if not folder.is_relative_to(tmp_path):
        pytest.skip("the cache cannot be moved here")
    assert loops.take_lock()
    return folder


@pytest.mark.alone
def test_a_warm_start() -> None:
    compiled_loop()
    limit = max(SOON_S, TIMES_NUMPY * numpy_s())
    starts = [start_s() for _ in range(3)]
    assert min(listening for listening, _ in starts) < limit / 2
    assert min(answered for _, answered in starts) < limit


@pytest.mark.alone
def test_a_cold_start(cold: Path) -> None:
    limit = max(SOON_S, TIMES_NUMPY * numpy_s())
    starts = [start_s() for _ in range(3)]
    assert min(listening for listening, _ in starts) < limit / 2
    assert min(answered for _, answered in starts) < limit
    assert not loops.cached()


@pytest.mark.alone
def test_a_cold_simulator_takes_the_compiled_loop_when_it_is_ready(cold: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with SimulatorProcess("ssc1") as simulator:
        client = connect(simulator.address)
        client.sendall(b"PR 4000;BGX;AMX;RPX\r")
        assert until(client, b"\r\n:") == b"::: 0000004000\r\n:"
        assert simulator.state()["compiled"] is False
        monkeypatch.undo()
        compiled_loop()
        warm = cache_folder()
        assert loops.cached()
        shutil.copytree(warm, cold, dirs_exist_ok=True)
        (cold / loops.LOCK).unlink()
        give_up = time.monotonic() + 60
        while not simulator.state()["compiled"]:
            assert time.monotonic() < give_up
            time.sleep(0.05)
        client.sendall(b"PR -1000;BGX;AMX;RPX\r")
        assert until(client, b"\r\n:") == b"::: 0000003000\r\n:"


class Ready(Compiler):
    """A compiler that says what it is told to."""

    def __init__(self, *said: Readiness) -> None:
        super().__init__()
        self.said = list(said)

    def readiness(self) -> Readiness:
        return self.said.pop(0)


def wait_for(motion: Motion) -> None:
    """A jog with watches that trip at the end of a chunk, next to it, and elsewhere."""
    motion.set(0, Register.JOG_SPEED, 10240)
    motion.begin_jog(0)
    for moment in (1, loops.CHUNK, loops.CHUNK + 1, 3 * loops.CHUNK, 1777):
        motion.watch(Watch.TIME, 0, moment)


@pytest.mark.parametrize("switch_after", [0.0, 1e-9, 1e9])
def test_going_over_changes_nothing(switch_after: float) -> None:
    ends = []
    for thrifty in (False, True):
        motion = Motion(2, compiled=False)
        if thrifty:
            loop = ThriftyLoop(Ready(Readiness.COMPILING, Readiness.CACHED), switch_after)
            motion.use(loop)
        wait_for(motion)
        runs = []
        while motion.sample < 4000:
            runs.append(motion.run(4000 - motion.sample))
        ends.append((runs, motion.snapshot().tobytes()))
    assert ends[0] == ends[1]
    assert loop.compiled == (switch_after < 1)
    assert ends[0][0][:4] == [1, loops.CHUNK - 1, 1, 3 * loops.CHUNK - loops.CHUNK - 1]


def test_a_full_trace_ends_a_run() -> None:
    motion = Motion(1, compiled=False)
    motion.use(ThriftyLoop(Ready(), 1e9))
    motion.trace(2 * loops.CHUNK)
    assert motion.run(10 * loops.CHUNK) == 2 * loops.CHUNK
    assert len(motion.trace_rows()) == 2 * loops.CHUNK


def test_short_runs_do_not_wait_for_the_compiled_loop() -> None:
    loop = ThriftyLoop(Ready(), 1e9)  # asked for nothing: it has nothing to say
    motion = Motion(1, compiled=False)
    motion.use(loop)
    motion.run(100)
    assert not loop.compiled


@pytest.mark.parametrize(("said", "taken"), [(Readiness.CACHED, 1), (Readiness.NEVER, 0), (Readiness.UNKEPT, 0)])
def test_what_is_handed_over_in_real_time(said: Readiness, taken: int) -> None:
    handed: list[SampleLoop] = []
    loading = Loading(handed.append, Ready(said))
    loading.begin()
    loading.join(60)
    assert len(handed) == taken
    assert all(loop.compiled for loop in handed)


def test_a_forgotten_lock_does_not_keep_others_from_compiling(cold: Path) -> None:
    assert loops.locked() and not loops.take_lock()
    assert Compiler().readiness() is Readiness.COMPILING
    old = time.time() - 2 * loops.STALE_S
    os.utime(cold / loops.LOCK, (old, old))
    assert not loops.locked()
    assert loops.take_lock() and loops.locked()
    loops.give_lock()
    assert not loops.locked()


def test_without_numba_nothing_is_compiled(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "numba", None)
    assert Compiler().readiness() is Readiness.NEVER
    assert plain_loop() is not None


def test_the_cache_is_where_it_is_looked_for() -> None:
    compiled_loop()
    assert loops.cached()
