"""The trace: one row a sample, or every n-th, into memory that is made once and used again."""

from __future__ import annotations

import numpy
import pytest

from device.simulator.motion import Motion, Register


def test_a_row_holds_what_the_reads_say() -> None:
    motion = Motion(2)
    motion.set_outputs(5)
    motion.set_input(2, False)
    motion.set(1, Register.JOG_SPEED, -20480)
    motion.begin_jog(1)
    motion.trace(100)
    for _ in range(60):
        motion.run(1)
    row = motion.trace_rows()[-1]
    assert row[0] == motion.sample == 60
    for axis in range(2):
        assert row[1 + 4 * axis] == motion.reference(axis)
        assert row[2 + 4 * axis] == motion.position(axis)
        assert row[3 + 4 * axis] == motion.velocity_now(axis)
        assert row[4 + 4 * axis] == motion.torque(axis)
    assert (row[9], row[10]) == (253, 5)


def test_every_nth_and_full() -> None:
    motion = Motion(1)
    motion.trace(10, every=4)
    assert motion.run(1000) == 37  # the first sample, then every fourth: the tenth row ends the run
    assert list(motion.trace_rows()[:, 0]) == list(range(1, 38, 4))
    motion.trace_clear()
    assert len(motion.trace_rows()) == 0
    assert motion.run(1000) == 40
    motion.trace(0)
    assert motion.run(1000) == 1000


@pytest.mark.parametrize("compiled", [True, False])
def test_a_full_trace_takes_no_more(compiled: bool) -> None:
    motion = Motion(1, compiled=compiled)
    motion.trace(10)
    assert [motion.run(100), motion.run(100)] == [10, 100]  # it ends the run that fills it, and no other
    assert len(motion.trace_rows()) == 10
    assert motion.trace_rows()[-1, 0] == 10


def test_the_memory_is_used_again() -> None:
    motion = Motion(1)
    motion.trace(50)
    motion.run(50)
    first = motion.trace_rows()
    motion.trace_clear()
    motion.run(50)
    assert numpy.shares_memory(first, motion.trace_rows())
    assert first[0, 0] == 51
