"""MC waits for the move that runs now, however long the axis has stood before it (dmc-1412-1414.txt l.2784)."""

from __future__ import annotations

import pytest

from codegen.models import model
from device.simulator.simulation import Simulation
from device.simulator.times import TICKS

STOOD = "SH\nTW 100\nPR 100\nBGX\nAMX\nWT 1000\n"  # longer than the time-out of MC
MOVES = {
    "position": "PR 20000\nSP 20000\nBGX\n",
    "increment": "IP 20000\n",
    "sequence": "LMXY\nLI 20000,0\nLE\nVS 20000\nBGS\n",
    "contour": "CMX\nDT 8\nCD 20000\nWC\nDT 0\nCD 0\n",
}


@pytest.mark.parametrize("move", MOVES)
def test_in_position_does_not_count_the_time_before_the_move(move: str) -> None:
    simulation = Simulation(model("ssc2"))
    simulation.load_program(f"{STOOD}{MOVES[move]}MCX\nR=_RPX\nM=_BGX\nEN\n")
    simulation.execute(0)
    assert simulation.run_until_idle(20 * TICKS) == "end"
    state = simulation.state()
    assert state["variables"]["R"] == 20100
    assert state["variables"]["M"] == 0
    assert state["axes"]["X"]["stop_code"] != 99
