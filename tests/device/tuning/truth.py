"""The true sampled loop of a simulated machine, worked out from the equations of chapter 10 alone."""

from __future__ import annotations

import functools
import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy
from numpy.typing import NDArray

from device.simulator.plant import Place, Plant
from device.tuning.loop import Gains
from tests.device.simulator.reference import PERIOD, VOLT, counts_a_radian, held, is_coupled, matrices

Complex = NDArray[numpy.complex128]
Real = NDArray[numpy.float64]
OMEGA: Real = numpy.geomspace(1.0, math.pi / PERIOD * 0.9999, 8000)


@dataclass(frozen=True)
class Loop:
    """What is true of a loop."""

    crossover: float  # rad/s, where the gain first falls through 1
    phase: float  # degrees to -180° there, or less where it passes 1 again
    apart: float  # the smallest |1 + A| above the crossover
    stable: bool


def sampled(plant: Plant) -> tuple[Real, Real, Real]:
    """Transition, drive and output row of the machine without weight and dry friction, in counts and volts."""
    bare = replace(plant, gravity=0.0, coulomb_friction=0.0)
    transition, drive = held(*matrices(bare), PERIOD)
    row = numpy.zeros(5)
    row[3 if plant.main is Place.LOAD else 0] = counts_a_radian(plant)
    if not is_coupled(plant):  # the load's states are the motor's
        return transition[:3, :3], drive[:3], row[:3]
    return transition, drive, row


@functools.lru_cache(maxsize=4)
def machine_over_all(plant: Plant) -> Complex:
    """`machine_response` at OMEGA."""
    return machine_response(plant, OMEGA)


def machine_response(plant: Plant, omega: Real) -> Complex:
    """Counts per volt."""
    transition, drive, row = sampled(plant)
    z = numpy.exp(1j * omega * PERIOD)
    stack = z[:, None, None] * numpy.eye(len(row)) - transition
    states = numpy.linalg.solve(stack, numpy.broadcast_to(drive[:, None], (len(omega), len(row), 1)))[:, :, 0]
    found: Complex = (states @ row) * z**-plant.delay_samples
    return found


def open_loop(plant: Plant, gains: Gains) -> Complex:
    """Filter (dmc-1412-1414.txt l.4454-4476), hold, machine, encoder at OMEGA."""
    change = 1 - numpy.exp(-1j * OMEGA * PERIOD)
    filtered = 4 * gains.kp + 4 * gains.kd * change + gains.ki / 2 / change
    found: Complex = VOLT * filtered * machine_over_all(plant)
    return found


def poles(plant: Plant, gains: Gains) -> Real:
    """Sizes of the closed loop's poles: states, error before, integral, commands under way."""
    transition, drive, row = sampled(plant)
    n, late = len(row), plant.delay_samples
    size = n + 2 + late
    command = numpy.zeros(size)
    command[:n] = -VOLT * (4 * gains.kp + 4 * gains.kd + gains.ki / 2) * row
    command[n], command[n + 1] = -VOLT * 4 * gains.kd, VOLT * gains.ki / 2
    whole = numpy.zeros((size, size))
    whole[:n, :n] = transition
    whole[n, :n] = -row
    whole[n + 1, :n], whole[n + 1, n + 1] = -row, 1.0
    pipe = [command, *(numpy.eye(size)[n + 2 + i] for i in range(late))]
    whole[:n] += numpy.outer(drive, pipe[late])
    for i in range(late):
        whole[n + 2 + i] = pipe[i]
    keep = [i for i in range(size) if gains.ki or i != n + 1]
    if plant.drive != "voltage":  # no current of its own
        keep.remove(2)
    found: Real = numpy.abs(numpy.linalg.eigvals(whole[numpy.ix_(keep, keep)]))
    return found


def loop(plant: Plant, gains: Gains) -> Loop:
    """Crossover, margin, distance and stability."""
    values = open_loop(plant, gains)
    size = numpy.abs(values)
    places = numpy.flatnonzero((size[:-1] >= 1) != (size[1:] >= 1))
    margins = [math.degrees(numpy.angle(-values[i])) for i in places]
    first = int(places[0])
    phase = min([margins[0], *(abs(margin) for margin in margins[1:])])
    apart = float(numpy.abs(1 + values[first:]).min())
    return Loop(float(OMEGA[first]), phase, apart, bool(poles(plant, gains).max() < 1))


def reachable(
    plant: Plant,
    crossover: float,
    phase: float,
    corners: Sequence[float] = (0, 0.05, 0.1, 0.2, 0.4),
    slack: Sequence[float] = (0, 0.5, 1),
    close: tuple[float, float] = (0.11, 5.5),
) -> bool:
    """Whether any KP, KD, KI within the commands' ranges come to a target within 10 % and 5°, stable, 6 dB apart.

    At one frequency |A| and the phase are two equations for KP and KD once KI is chosen as its corner. `slack` 0 tries
    the target itself alone.
    """
    sides = sorted({side * part for part in slack for side in (-1, 1)})
    for part, lead, corner in itertools.product([1 + 0.1 * s for s in sides], [5 * s for s in sides], corners):
        omega = crossover * part
        change = 1 - complex(math.cos(omega * PERIOD), -math.sin(omega * PERIOD))
        at = complex(machine_response(plant, numpy.array([omega]))[0])
        angle = math.radians(phase + lead - 180)
        needed = complex(math.cos(angle), math.sin(angle)) / at / VOLT
        first = 1 + corner * omega * PERIOD / change
        p, d = numpy.linalg.solve([[first.real, change.real], [first.imag, change.imag]], [needed.real, needed.imag])
        gains = Gains(kp=p / 4, kd=d / 4, ki=2 * corner * omega * PERIOD * p)
        if not (0 < gains.kp <= 1023.875 and 0 <= gains.kd <= 4095.875 and gains.ki <= 2047.875):
            continue
        found = loop(plant, gains)
        near = abs(found.crossover / crossover - 1) <= close[0] and abs(found.phase - phase) <= close[1]
        if near and found.stable and found.apart >= 0.5:
            return True
    return False
