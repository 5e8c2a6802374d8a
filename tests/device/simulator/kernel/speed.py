"""How many times faster than real time the motion runs: moves and waits, as a program would make them."""

from __future__ import annotations

import time

from device.simulator.motion import Motion, Register, Watch


def moves_and_waits(motion: Motion, seconds: float) -> tuple[float, float]:
    """Moves all axes to and fro with 100 ms rests for `seconds` of virtual time; (times real time, CPU seconds)."""
    for axis in range(motion.axes):
        motion.set(axis, Register.KD, 200)
    begin, first, sign = time.process_time(), motion.sample, 1
    while motion.sample - first < seconds * 1024:
        for axis in range(motion.axes):
            motion.begin_position(axis, sign * (20000 + 3000 * axis))
        for axis in range(motion.axes):
            number = motion.watch(Watch.AFTER_MOVE, axis)
            while not motion.tripped(number):
                motion.run(100_000)
            motion.drop(number)
        number = motion.watch(Watch.TIME, 0, motion.sample + 102)
        while not motion.tripped(number):
            motion.run(100_000)
        motion.drop(number)
        sign = -sign
    took = time.process_time() - begin
    return (motion.sample - first) / 1024 / took, took
