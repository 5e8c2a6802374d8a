"""`python -m device.simulator.kernel` compiles the sample loop into its cache and says so in one line."""

from __future__ import annotations

import sys
import time

from device.simulator.kernel.compiled import CompilerMissing, cache_folder, compiled_loop, drop_old_caches


def main() -> int:
    """0 when the compiled loop is ready, 1 when only the plain one is."""
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
    sys.exit(main())
