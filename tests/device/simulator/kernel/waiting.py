"""Runs until something happens."""

from __future__ import annotations

from device.simulator.motion import Motion, Watch


def run_until(motion: Motion, kind: Watch, axis: int = 0, value: float = 0, limit: int = 200_000) -> int:
    number = motion.watch(kind, axis, value)
    samples = 0
    while not motion.tripped(number) and samples < limit:
        samples += motion.run(limit - samples)
    assert motion.tripped(number)
    motion.drop(number)
    return samples
