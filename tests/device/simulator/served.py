"""What a served simulator costs while four axes move and two threads are busy, and whether it keeps its time."""

from __future__ import annotations

import os
import time
from dataclasses import dataclass
from pathlib import Path

from device.simulator.process import SimulatorProcess

PROGRAM = """#A
XQ#B,1;XQ#C,2
SP 20000,40000,30000,25000
#M
PR 4000,8000,-4000,2000
BG
AM
PR -4000,-8000,4000,-2000
BG
AM
N=N+1
JP#M
#B
V=V+1
JP#B
#C
JP#C,@ABS[_TPX]<1000000
"""
LOADED_S = 120.0


@dataclass(frozen=True)
class Served:
    """What was seen of it."""

    share: float  # of one core
    late: float  # s that virtual time moved against real time
    moves: float
    seconds: float


def processor_seconds(process: int) -> float:
    """Processor time a process has used so far."""
    words = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    return (int(words[11]) + int(words[12])) / os.sysconf("SC_CLK_TCK")


def served_with_load(seconds: float) -> Served:
    """Lets it serve for so long with the program above."""
    with SimulatorProcess("ssc4") as process:
        lines = "\r".join(PROGRAM.strip().split("\n"))
        process.stimulus("type", f"N=0;V=0\rDL\r{lines}\r\\XQ#A\r")
        end = time.monotonic() + LOADED_S
        while not process.state()["compiled"]:  # it starts on the plain loop and loads the compiled one beside it
            assert time.monotonic() < end, "the compiled loop was not loaded"
            time.sleep(0.2)
        time.sleep(1.0)
        first, began, used = process.state(), time.monotonic(), processor_seconds(process.pid)
        time.sleep(seconds)
        last, ended, now_used = process.state(), time.monotonic(), processor_seconds(process.pid)
    assert [thread["running"] for thread in last["threads"][:3]] == [True] * 3, last["errors"]
    return Served(
        share=(now_used - used) / (ended - began),
        late=abs(last["virtual_seconds"] - first["virtual_seconds"] - (ended - began)),
        moves=last["variables"]["N"] - first["variables"]["N"],
        seconds=ended - began,
    )
