"""How fast the simulator runs, and what it costs when nothing happens."""

from __future__ import annotations

import time

from codegen.models import model
from device.simulator.process import SimulatorProcess
from device.simulator.simulation import Simulation
from tests.benchmarks.figure import Figure
from tests.device.simulator.served import processor_seconds, served_with_load

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
ARCS = """#A
VS 20000;VA 200000;VD 200000
GAX;GR ,,1.5,-0.5
#B
VMXY
CR 5000,0,360
VP 8000,2000
CR 3000,90,-180
VP 0,0
VE
BGS
AMS
WT 20
N=N+1
JP#B
"""
WAITING = """#A
PR 20000,10000;BGXY
#L;JP#L,_BGX=1
WT 20
PR -20000,-10000;BGXY
#K
NO until both are back
JP#K,(_BGX=1)|(_TPY>5)
WT 20
N=N+1
JP#A
"""
SETTING = """#A
PR 20000,10000;BGXY
#L;V=_TPX;JP#L,V<19990
AMXY
PR -20000,-10000;BGXY
#K;JS#S;JP#K,_BGX=1
AMXY
N=N+1
JP#A
#S;K=K+1
EN
"""
BUSY = f"""V=0;XQ#V,1;XQ#C,2
{MOVES}#V
V=V+1
JP#V
#C
C=@ABS[_TPX]
JP#C
"""
LOOP = "#A;JP#A\n"
IDLE_S = 4.0
LOADED_FOR_S = 8.0
LOADED_S = 120.0


def times_real_time(source: str, seconds: float) -> tuple[float, float]:
    """Virtual over processor time: cold (the first run of this process) and warm (the best of ten).

    Processor time is what the wall clock shows on an idle computer; busy neighbours do not count.
    """
    ratios = []
    for _ in range(11):
        simulation = Simulation(model("ssc4"))
        simulation.load_program("N=0\n" + source)
        simulation.execute(0)
        began = time.process_time()
        simulation.advance(round(seconds * TICKS))
        simulation.rest(1000)  # every sample up to now is taken
        ratios.append(seconds / (time.process_time() - began))
        state = simulation.state()
        assert not state["errors"] and state["threads"][0]["running"], state["errors"]
    return ratios[0], max(ratios[1:])


def four_axes_of_moves() -> Figure:
    """60 s of moves and waits on four axes."""
    cold, warm = times_real_time(MOVES, 60)
    return Figure("60 s of four-axis moves and waits", warm, "× real time", least=1500, note=f"cold {cold:.0f}")


def arcs_with_gearing() -> Figure:
    """60 s of arcs and lines with two axes geared to one of theirs."""
    cold, warm = times_real_time(ARCS, 60)
    return Figure("60 s of arcs with gearing", warm, "× real time", least=1500, note=f"cold {cold:.0f}")


def waiting_loops() -> Figure:
    """Moves that loops of jumps wait for; the loops are left out up to the next event."""
    cold, warm = times_real_time(WAITING, 60)
    return Figure("60 s of loops that wait for moves", warm, "× real time", least=2000, note=f"cold {cold:.0f}")


def setting_loops() -> Figure:
    """The same where the loops set variables, count and call a subroutine."""
    cold, warm = times_real_time("V=0;K=0\n" + SETTING, 60)
    return Figure("60 s of loops that set variables", warm, "× real time", least=2000, note=f"cold {cold:.0f}")


def moves_beside_busy_threads() -> Figure:
    """Four axes move while two threads count and look."""
    cold, warm = times_real_time(BUSY, 20)
    return Figure("moves beside two busy threads", warm, "× real time", least=150, note=f"cold {cold:.0f}")


def tight_loop() -> Figure:
    """A program that does nothing but jump."""
    cold, warm = times_real_time(LOOP, 20)
    return Figure("a tight #A;JP#A loop", warm, "× real time", least=2000, note=f"cold {cold:.0f}")


def served_with_axes_and_threads() -> Figure:
    """A served controller whose four axes move while two threads are busy."""
    served = served_with_load(LOADED_FOR_S)
    note = f"virtual time {1000 * served.late:.1f} ms off"
    return Figure(
        "a served simulator, four axes and two busy threads", 100 * served.share, "% of one core", most=5, note=note
    )


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
