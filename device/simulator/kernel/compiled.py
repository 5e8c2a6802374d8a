"""Compiles the sample loop with numba into a cache of its own, or hands out the same source as plain Python."""

from __future__ import annotations

import contextlib
import functools
import hashlib
import importlib
import inspect
import os
import shutil
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy
from numpy.typing import NDArray

from device.simulator.kernel import layout
from device.simulator.kernel.layout import State

Vector = NDArray[numpy.float64]
Loop = Callable[[Vector, Vector, int], int]
MODULES = (
    "layout",
    "angle",
    "profile",
    "inputs",
    "homing",
    "servo",
    "commutation",
    "plant",
    "contour",
    "cam",
    "path",
    "events",
    "loop",
)
# Inlining what every sample needs triples the speed; inlining the rest would only make the compiler slow.
INLINED = ("layout", "profile", "inputs", "servo", "plant", "events", "loop")
SELDOM = (
    "shift",
    "freeze",
    "finish",
    "end_of_ramp",
    "raise_event",
    "general",
    "general_substep",
    "rippled",
    "write_trace",
    "check_abort",
    "uniform",
)
PACKAGE = "device.simulator.kernel"
UNUSED_S = 14 * 86400.0  # a cache that nothing has used for so long belongs to a version that is gone


class CompilerMissing(Exception):
    """The compiled loop was asked for and numba is not there."""


def source_version() -> str:
    """Names the cache after the kernel's sources: numba itself does not notice changed constants or callees."""
    folder = Path(__file__).parent
    digest = hashlib.sha256()
    for name in (*MODULES, "compiled"):
        digest.update((folder / f"{name}.py").read_bytes())
    return digest.hexdigest()[:16]


def cache_folder() -> Path:
    """Where the compiled loop is kept."""
    import platformdirs

    return Path(platformdirs.user_cache_dir("twoletter-studio", appauthor=False)) / f"kernel-{source_version()}"


def as_state(array: Vector) -> State:
    """The array as a sequence of plain floats, over the same memory."""
    buffer: Any = array
    view: Any = memoryview(buffer)
    state: State = view
    return state


def make_cache_folder() -> Path | None:
    """The cache folder, made when it is not there; None where that is not allowed."""
    folder = cache_folder()
    try:
        folder.mkdir(parents=True, exist_ok=True)
        os.utime(folder)  # in use
    except OSError:
        return None
    return folder if os.access(folder, os.W_OK) else None


def drop_old_caches() -> None:
    """Removes what earlier versions of the kernel left in the cache; another copy that is in use keeps its own."""
    current, oldest = cache_folder(), time.time() - UNUSED_S
    for folder in current.parent.glob("kernel-*"):
        with contextlib.suppress(OSError):  # another process drops it at the same time
            if folder != current and folder.stat().st_mtime < oldest:
                shutil.rmtree(folder, ignore_errors=True)


def plain_loop() -> Loop:
    """The loop as plain Python; memoryviews read and write plain floats much faster than arrays do."""
    loop = importlib.import_module(f"{PACKAGE}.loop")

    def run(state: Vector, trace: Vector, samples: int) -> int:
        plain_state: State = as_state(state)
        plain_trace: State = as_state(trace)
        return int(loop.run(plain_state, plain_trace, samples))

    return run


def register_slots() -> None:
    """Teaches numba `layout.slots` as bare pointer arithmetic; its own slices count references, 60 ns each."""
    from numba.core import types
    from numba.extending import intrinsic, overload
    from numba.np import arrayobj

    def pointer(context: Any, array: Any, first: Any, length: Any) -> Any:
        def build(target: Any, builder: Any, signature: Any, values: Any) -> Any:
            make = target.make_array(signature.return_type)
            whole, piece = make(target, builder, values[0]), make(target, builder)
            eight = target.get_constant(types.intp, 8)
            data = builder.gep(whole.data, [values[1]])
            fill: Any = arrayobj.populate_array
            fill(piece, data=data, shape=[values[2]], strides=[eight], itemsize=eight, meminfo=None)
            return piece._getvalue()

        return array(array, types.intp, types.intp), build

    pointer_slots: Any = intrinsic(pointer)

    def compiled_slots(S: Any, first: Any, length: Any) -> Any:
        def implementation(S: Any, first: Any, length: Any) -> Any:
            return pointer_slots(S, first, length)

        return implementation

    overload(layout.slots)(compiled_slots)


@functools.cache
def compiled_loop() -> Loop:
    """The loop compiled, from the cache where it is there; raises CompilerMissing without numba."""
    try:
        import numba
        from numba.extending import register_jitable
    except ImportError as missing:
        raise CompilerMissing(f"numba cannot be loaded: {missing}") from missing
    register_slots()
    for name in MODULES:
        module = importlib.import_module(f"{PACKAGE}.{name}")
        for value in list(vars(module).values()):
            if inspect.isfunction(value) and value.__module__ == module.__name__ and value is not layout.slots:
                register_jitable(forceinline=name in INLINED and value.__name__ not in SELDOM)(value)
    loop = importlib.import_module(f"{PACKAGE}.loop")
    settings: Any = numba.config
    before, folder = settings.CACHE_DIR, make_cache_folder()
    if folder is not None:
        settings.CACHE_DIR = str(folder)
    try:
        signature = numba.int64(numba.float64[::1], numba.float64[::1], numba.int64)
        compiled: Loop = numba.njit(signature, nogil=True, cache=folder is not None)(loop.run)
    except numba.core.errors.NumbaError as wrong:
        raise CompilerMissing(f"numba cannot compile the sample loop: {str(wrong).splitlines()[0]}") from wrong
    finally:
        settings.CACHE_DIR = before
    return compiled
