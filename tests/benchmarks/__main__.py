"""Prints every figure with what is wanted of it: `python -m tests.benchmarks`."""

from __future__ import annotations

import sys

from tests.benchmarks.all import measured


def main() -> int:
    """Measures everything; 1 when a bound is not kept."""
    missed = 0
    for figure in measured():
        missed += not figure.reached
        mark = "  " if figure.reached else "✗ "
        print(f"{mark}{figure.name:52}{figure.value:10.2f} {figure.unit:18} {figure.bound:8} {figure.note}", flush=True)
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
