"""Which sample loop runs: plain Python at once, the compiled one when it is ready and worth its loading; same bits."""

from __future__ import annotations

import functools
import hashlib
import importlib.util
import os
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from enum import Enum, auto
from pathlib import Path
from typing import Final

import device
from device.simulator.kernel import layout
from device.simulator.kernel.compiled import (
    CompilerMissing,
    Loop,
    Vector,
    cache_folder,
    compiled_loop,
    make_cache_folder,
    plain_loop,
)

LOADING_S: Final = 0.5  # about what loading the compiled loop from its cache costs
COMPILING_S: Final = 10.0  # about what compiling it costs
ASK_AGAIN_S: Final = 1.0  # how often a long run looks whether the compiling is done
CHUNK: Final = 500  # samples that a plain loop runs between two looks at the clock
LOCK: Final = "compiling"
FIRST_S: Final = 0.25  # the first answers of a served simulator go before the loading
STALE_S: Final = 180.0  # a compiling that has not ended by then was killed
SWITCH_S: Final = 0.0005  # how long one thread keeps the interpreter while the compiled loop is loaded


class SampleLoop:
    """A loop to run samples with."""

    def __init__(self, run: Loop, *, compiled: bool) -> None:
        self.run = run
        self.compiled = compiled


class Readiness(Enum):
    """How the compiled loop can be had."""

    CACHED = auto()  # by loading it
    COMPILING = auto()  # soon: another process works on it
    UNKEPT = auto()  # only by compiling here: there is nowhere to keep it
    NEVER = auto()  # no numba


def cached() -> bool:
    """A compiled loop of these sources and this Python is in the cache."""
    version = f"py{sys.version_info.major}{sys.version_info.minor}"
    return any((cache_folder() / place_in_cache()).glob(f"*{version}*.nbc"))


def place_in_cache() -> str:
    """The folder within the cache that numba gives to the modules of the folder where the kernel is."""
    folder = str(Path(layout.__file__).parent)
    return f"{Path(folder).name}_{hashlib.sha1(folder.encode(), usedforsecurity=False).hexdigest()}"


def take_lock() -> bool:
    """Announces that this process compiles; False while another one does."""
    folder = make_cache_folder()
    if folder is None:
        return False
    if not locked():
        (folder / LOCK).unlink(missing_ok=True)
    try:
        (folder / LOCK).touch(exist_ok=False)
    except FileExistsError:
        return False
    return True


def give_lock() -> None:
    """The compiling has ended."""
    (cache_folder() / LOCK).unlink(missing_ok=True)


def locked() -> bool:
    """Another process compiles."""
    try:
        begun = (cache_folder() / LOCK).stat().st_mtime
    except OSError:
        return False
    return time.time() - begun < STALE_S


class Compiler:
    """Fills a cold cache in a process of its own, so that whatever runs here goes on."""

    def __init__(self) -> None:
        self._process: subprocess.Popen[bytes] | None = None

    def readiness(self) -> Readiness:
        """Where the compiled loop is; begins to compile it when nobody does."""
        ended = self._process is not None and self._process.poll() is not None
        if importlib.util.find_spec("numba") is None:
            return Readiness.NEVER
        if cached():
            return Readiness.CACHED
        if locked():
            return Readiness.COMPILING
        if ended:
            return Readiness.NEVER
        if make_cache_folder() is None:
            return Readiness.UNKEPT
        if self._process is None:
            self._process = begin_compiling()
        return Readiness.COMPILING


def begin_compiling() -> subprocess.Popen[bytes]:
    """A process at low priority that compiles the loop and ends; it also ends well when this one does not wait."""
    root = str(Path(device.__file__).resolve().parents[1])
    path = os.environ.get("PYTHONPATH", "")
    return subprocess.Popen(
        [sys.executable, "-m", "device.simulator.kernel", "--beside"],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        env={**os.environ, "PYTHONPATH": os.pathsep.join([root, path] if path else [root])},
        creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
    )


class ThriftyLoop(SampleLoop):
    """For runs in virtual time: plain until they have cost about what loading costs, so that short ones never wait."""

    def __init__(self, compiler: Compiler | None = None, patience_s: float = LOADING_S) -> None:
        super().__init__(self._plain, compiled=False)
        self._loop = plain_loop()
        self._spent = 0.0
        self._limit = patience_s
        self._compiler = compiler or Compiler()

    def _plain(self, state: Vector, trace: Vector, samples: int) -> int:
        """As `loop.run`, looking at the clock now and then."""
        done = 0
        while done < samples:
            if self._spent >= self._limit and self._compiled():
                return done + self.run(state, trace, samples - done)
            events, full, most = state[layout.EVENTS], trace_full(state), min(CHUNK, samples - done)
            began = time.perf_counter()
            done += self._loop(state, trace, most)
            self._spent += time.perf_counter() - began
            if ended(state, events) or (trace_full(state) and not full):
                break
        return done

    def _compiled(self) -> bool:
        """Takes the compiled loop when it is there; else looks again later, or never."""
        found = self._compiler.readiness()
        if found is Readiness.COMPILING or (found is Readiness.UNKEPT and self._spent < COMPILING_S):
            self._limit = self._spent + min(ASK_AGAIN_S, self._limit)
            return False
        self._limit = float("inf")
        if found is not Readiness.NEVER:
            try:
                self.run, self.compiled = compiled_loop(), True
            except CompilerMissing:
                return False
        return self.compiled


def ended(state: Vector, events: float) -> bool:
    """The loop had a reason to end after its last sample."""
    return bool(state[layout.TRIPS] > 0.0 or state[layout.EVENTS] != events or state[layout.GUARD_BROKEN] != 0.0)


def trace_full(state: Vector) -> bool:
    """The trace has no room for another row."""
    capacity = state[layout.TRACE_CAPACITY]
    return bool(capacity > 0.0 and state[layout.TRACE_ROWS] >= capacity)


@functools.cache
def thrifty_loop() -> ThriftyLoop:
    """One for all runs of this process: many short ones are a long one."""
    return ThriftyLoop()


def loop_for(compiled: bool | None) -> SampleLoop:
    """The plain loop, the compiled one (waits for it; CompilerMissing), or for `None` whichever is faster by then."""
    if compiled is None:
        return thrifty_loop()
    return SampleLoop(compiled_loop() if compiled else plain_loop(), compiled=compiled)


class Loading:
    """Gets the compiled loop ready beside a simulation in real time, and hands it over."""

    def __init__(self, use: Callable[[SampleLoop], None], compiler: Compiler | None = None) -> None:
        self._use = use
        self._compiler = compiler or Compiler()
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._work, name="loads the sample loop", daemon=True)

    def begin(self) -> None:
        self._thread.start()

    def end(self) -> None:
        """The simulation ends: nothing is handed over any more."""
        self._ended.set()

    def join(self, seconds: float) -> None:
        """Waits until it is done."""
        self._thread.join(seconds)

    def _work(self) -> None:
        if self._ended.wait(FIRST_S):
            return
        while (found := self._compiler.readiness()) is Readiness.COMPILING:
            if self._ended.wait(ASK_AGAIN_S / 4):
                return
        if found is not Readiness.CACHED:
            return
        before = sys.getswitchinterval()
        sys.setswitchinterval(SWITCH_S)
        try:
            loop = SampleLoop(compiled_loop(), compiled=True)
        except CompilerMissing:
            return
        finally:
            sys.setswitchinterval(before)
        if not self._ended.is_set():
            self._use(loop)
