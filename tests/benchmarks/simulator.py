"""How fast the simulator runs, and what it costs when nothing happens."""

from __future__ import annotations

import os
import time
from pathlib import Path

from codegen.models import model
from device.simulator.process import SimulatorProcess
from device.simulator.simulation import Simulation
from tests.benchmarks.figure import Figure

TICKS = 1_024_000
MOVES = """#A
SP 20000,40000,30000,25000
AC 256000,512000,256000,128000
#B
PR 4000,8000,-4000,2000
BG
AM
WT 100
PR -4000,-8000,4000,-2000
BG
AM
WT 50
N=N+1
JP #B
"""
LOOP = "#A;JP#A\n"
IDLE_S = 4.0
LOADED_S = 120.0


def times_real_time(source: str, seconds: float) -> tuple[float, float]:
    """Virtual over processor time: cold (the first run of this process) and warm (the best of three).

    Processor time is what the wall clock shows on an idle computer; busy neighbours do not count.
    """
    ratios = []
    for _ in range(4):
        simulation = Simulation(model("ssc4"))
        simulation.load_program("N=0\n" + source)
        simulation.execute(0)
        began = time.process_time()
        simulation.advance(round(seconds * TICKS))
        ratios.append(seconds / (time.process_time() - began))
        state = simulation.state()
        assert not state["errors"] and state["threads"][0]["running"], state["errors"]
    return ratios[0], max(ratios[1:])


def four_axes_of_moves() -> Figure:
    """60 s of moves and waits on four axes."""
    cold, warm = times_real_time(MOVES, 60)
    return Figure("60 s of four-axis moves and waits", warm, "× real time", least=1000, note=f"cold {cold:.0f}")


def tight_loop() -> Figure:
    """A program that does nothing but jump."""
    cold, warm = times_real_time(LOOP, 20)
    return Figure("a tight #A;JP#A loop", warm, "× real time", least=150, note=f"cold {cold:.0f}")


def processor_seconds(process: int) -> float:
    """Processor time a process has used so far."""
    words = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    return (int(words[11]) + int(words[12])) / os.sysconf("SC_CLK_TCK")


def served_idle() -> Figure:
    """A served controller that nobody talks to."""
    with SimulatorProcess("ssc4") as process:
        end = time.monotonic() + LOADED_S
        while not process.state()["compiled"]:  # it starts on the plain loop and loads the compiled one beside it
            assert time.monotonic() < end, "the compiled loop was not loaded"
            time.sleep(0.1)
        time.sleep(1.0)
        began, used = time.monotonic(), processor_seconds(process.pid)
        time.sleep(IDLE_S)
        share = (processor_seconds(process.pid) - used) / (time.monotonic() - began)
    return Figure("a served simulator at idle", 100 * share, "% of one core", most=5)
