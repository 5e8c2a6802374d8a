"""`python -m device.simulator.kernel` compiles the sample loop into its cache and says so in one line."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Sequence

from device.simulator.kernel.compiled import CompilerMissing, cache_folder, compiled_loop, drop_old_caches
from device.simulator.loops import give_lock, take_lock

KINDNESS = 10  # how much lower the priority is beside a simulation that runs


def main(arguments: Sequence[str] = ()) -> int:
    """0 when the compiled loop is ready, 1 when only the plain one is; `--beside`: kind to who waits for it."""
    if "--beside" not in arguments:
        return compile_now()
    if not take_lock():
        return 0
    try:
        if hasattr(os, "nice"):
            os.nice(KINDNESS)
        return compile_now()
    finally:
        give_lock()


def compile_now() -> int:
    """Compiles, or loads what is compiled already."""
    begin = time.perf_counter()
    try:
        compiled_loop()
    except CompilerMissing as missing:
        print(f"the sample loop runs uncompiled: {missing}")
        return 1
    drop_old_caches()
    print(f"the sample loop is compiled ({time.perf_counter() - begin:.1f} s, {cache_folder()})")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
