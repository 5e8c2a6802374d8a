"""Gives a simulated controller the limits and loop rate of a machine's setup, as its burned parameters would."""

from __future__ import annotations

from codegen.numbers import parse_number
from codegen.setup import Setup
from codegen.setup_registers import limit_registers
from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.fixed import ONE
from device.simulator.simulation import Simulation
from device.simulator.twoletter.behaviour.registers import put


def apply_limits(simulation: Simulation, setup: Setup) -> None:
    """Sets the loop rate and the limits of every axis; a value the controller would refuse is left out."""
    period = parse_number(setup.sample_us)
    if period is not None and COMMANDS["TM"].accepts(int(period) * ONE, simulation.model):
        put(simulation.unit, "TM", 0, int(period) * ONE)
    for place, letter in enumerate(simulation.model.axes):
        for register in limit_registers():
            value, held = register.wanted(setup, letter), simulation.unit.state.registers[register.command][place]
            if value is None or register.same(value, held):
                continue
            if COMMANDS[register.command].accepts(value, simulation.model):
                put(simulation.unit, register.command, place, value)
