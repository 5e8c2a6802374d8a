"""EG at the place where the master stands: the slave follows from there on (commands.md, EG)."""

from __future__ import annotations

import pytest

from codegen.models import model
from device.simulator.plant import Place, Plant
from device.simulator.simulation import Simulation
from device.simulator.times import TICKS

TABLE = "#A\nEM 1000,2000\nEP 200,0\nN=0\n#B\nET[N]=N*100\nN=N+1\nJP #B,N<=10\nEB1\n"


@pytest.mark.parametrize(("start", "follows"), [(0, True), (200, True), (700, False), (5000, True)])
def test_the_slave_follows_from_the_place_on(start: int, follows: bool) -> None:
    simulation = Simulation(model("dmc1412"), plants={"X": Plant(auxiliary=Place.EXTERNAL)})
    simulation.load_program(f"{TABLE}EG {start}\nWT 50\nR=_RP\nG=_EG\nEN\n")
    simulation.execute(0)
    assert simulation.run_until_idle(TICKS // 20) == "time"
    simulation.stimulus("aux_x", 600)  # the master goes from 0 to 600 of its cycle of 2000
    assert simulation.run_until_idle(TICKS) == "end"
    variables = simulation.state()["variables"]
    assert variables["G"] == follows
    assert variables["R"] == (300 if follows else 0)  # half of the master's way, as the table says
