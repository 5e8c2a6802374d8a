"""A simulated day leaves nothing behind: the memory of a served controller stays what it was."""

from __future__ import annotations

import gc
import tracemalloc

from tests.device.simulator.bench import MS, Bench
from tests.long import count, record

DAY = """
#A
XQ#B,1
SP 40000,20000
#M
PR 4000,-2000
BGXY
AMXY
MG "THERE",N,_TPX
PR -4000,2000
BGXY
#L;JP#L,_BGX=1
N=N+1
WT 700
JP#M
#B
#W;JP#W,@IN[1]=1
K[N&7]=N;V=@SIN[N]+TIME
XX
"""
KEPT = 200  # records of a served controller


def live(bench: Bench, seconds: int) -> None:
    """Simulated seconds with somebody at the line, a second at a time."""
    simulation = bench.simulation
    for second in range(seconds):
        simulation.advance(1000 * MS)
        simulation.rest(KEPT)
        if second % 20 == 0:
            simulation.receive(1, b"MG TIME,_TPX;TB\rTS;NOSUCH 5\r")
        if second % 60 == 0:
            simulation.stimulus("in1", 0)
            simulation.advance(20 * MS)  # thread 1 runs into its error
            simulation.stimulus("in1", 1)
            simulation.receive(1, b"XQ#B,1\r")
        simulation.transmit(1)


def test_memory_stays_flat() -> None:
    bench = Bench("ssc2")
    bench.load(DAY.strip())
    bench.ask("N=0;DM K[8]")
    bench.simulation.execute("#A")
    tracemalloc.start()
    try:
        seen = []
        for _ in range(4):
            live(bench, count(200, 21_600))  # four times six hours are a day
            gc.collect()
            seen.append(tracemalloc.get_traced_memory()[0])
    finally:
        tracemalloc.stop()
    record("memory after a simulated day", "tests/device/simulator/test_memory_of_days.py", 0, seen[-1] / 1e6, "MB")
    assert bench.simulation.unit.state.variables["N"] > 0
    assert bench.simulation.unit.records.unhandled > 2  # the errors of every minute are among what is forgotten
    assert seen[-1] - seen[1] < 60_000, seen  # bytes; the first round fills what is kept
