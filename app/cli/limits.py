"""Gives a simulated controller the limits and loop rate of a machine's setup, as its burned parameters would."""

from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction

from codegen.numbers import parse_number
from codegen.setup import Axis, Setup
from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.fixed import ONE
from device.simulator.simulation import Simulation
from device.simulator.twoletter.behaviour.registers import put

Round = Callable[[Fraction], int]


def in_counts(text: str, axis: Axis, round_to: Round) -> int | None:
    """A position in units as whole counts, rounded so that it never goes beyond what was typed."""
    number = parse_number(text)
    return None if number is None else round_to(number * axis.scale) * ONE


def volts(text: str) -> int | None:
    """Volts as the register holds them."""
    number = parse_number(text)
    return None if number is None else math.floor(number * ONE)


def limits_of(axis: Axis) -> dict[str, int]:
    """The limits that were set up, by command; what was left empty stays as the controller has it."""
    found = {
        "FL": in_counts(axis.forward_limit, axis, math.floor),
        "BL": in_counts(axis.reverse_limit, axis, math.ceil),
        "ER": in_counts(axis.error_limit, axis, math.floor),
        "TL": volts(axis.torque_limit),
        "IL": volts(axis.integrator_limit),
    }
    return {name: value for name, value in found.items() if value is not None}


def apply_limits(simulation: Simulation, setup: Setup) -> None:
    """Sets the loop rate and the limits of every axis; a value the controller would refuse is left out."""
    period = parse_number(setup.sample_us)
    if period is not None and COMMANDS["TM"].accepts(int(period) * ONE, simulation.model):
        put(simulation.unit, "TM", 0, int(period) * ONE)
    for place, letter in enumerate(simulation.model.axes):
        for name, value in limits_of(setup.axis(letter)).items():
            row = COMMANDS[name]
            if row.accepts(value, simulation.model):
                put(simulation.unit, name, place, row.stored(value))
