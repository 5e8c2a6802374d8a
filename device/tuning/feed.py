"""Feed-forwards from what an axis is: the torque that a move needs is given at once, no error has to make it.

ssc-tol-o-motion.txt l.2922-2934: FA for the inertia of the load, FV for friction that grows with speed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy

from codegen.twoletter.commands import COMMANDS
from device.simulator.kernel.servo import ACCELERATION_VOLTS, VELOCITY_VOLTS
from device.tuning.automatic import grain
from device.tuning.plant import AxisPlant, Vector

SPEED_UNIT = 1024.0  # samples a second at TM 1000: SP and AC count in samples
PUSH = 0.4  # of the torque limit for the acceleration of the move that compares
SLOWEST = (2, 1024)  # SP and AC
SHORTEST_S, REST_S = 0.2, 0.25  # of that move, and of the record behind it


@dataclass(frozen=True)
class Feeds:
    """FV and FA as the controller holds them, and what to know about them."""

    fv: float
    fa: float
    words: str


@dataclass(frozen=True)
class Sweep:
    """A move of thirds: gaining speed, at speed, losing it; `speed` and `acceleration` as SP and AC take them."""

    counts: int
    speed: int
    acceleration: int
    seconds: float  # of the record
    period: float  # s, of a sample

    def commanded(self, interval: float, elements: int) -> Vector:
        """The commanded position of every element, from 0."""
        unit = SPEED_UNIT * self.period
        speed, rise = self.speed / unit, self.acceleration / unit**2
        way = float(abs(self.counts))
        ramp = min(speed / rise, math.sqrt(way / rise))
        top = rise * ramp
        end = way / top + ramp
        t = numpy.clip(numpy.arange(elements) * interval, 0.0, end)
        found = numpy.where(t < ramp, 0.5 * rise * t**2, top * (t - 0.5 * ramp))
        found = numpy.where(t > end - ramp, way - 0.5 * rise * (end - t) ** 2, found)
        whole: Vector = math.copysign(1.0, self.counts) * found
        return whole


def feeds(plant: AxisPlant, period: float) -> Feeds:
    """What makes the following error zero: x'' = gain u - pole x', so that u = x'' / gain + pole / gain x'."""
    unit = SPEED_UNIT * period
    wanted = {
        "FV": plant.pole / (plant.gain * VELOCITY_VOLTS * unit),
        "FA": 1.0 / (plant.gain * ACCELERATION_VOLTS * unit**2),
    }
    told = [
        f"{name} would have to be {value:.0f}; the controller takes {COMMANDS[name].high} at most."
        for name, value in wanted.items()
        if value > float(COMMANDS[name].high or 0)
    ]
    fv, fa = (grain(name, value) for name, value in wanted.items())
    return Feeds(fv, fa, " ".join([f"For moves: FV {fv:g} against friction, FA {fa:g} for the inertia.", *told]))


def sweep(plant: AxisPlant, counts: int, period: float, torque: float, tops: tuple[int, int]) -> Sweep:
    """As quick as an acceleration with a part of the torque allows; `tops`: the machine's SP and AC, never passed."""
    way, unit = abs(counts), SPEED_UNIT * period
    tops = max(tops[0], SLOWEST[0]), max(tops[1], SLOWEST[1])
    shortest = (
        SHORTEST_S, math.sqrt(4.5 * way / (PUSH * torque * plant.gain)),
        1.5 * way * unit / tops[0], math.sqrt(4.5 * way / tops[1]) * unit,
    )  # fmt: skip
    seconds = max(shortest)
    speed, rise = 1.5 * way / seconds * unit, 4.5 * way / seconds**2 * unit**2
    held = int(COMMANDS["SP"].stored(round(speed) << 16)) >> 16, int(COMMANDS["AC"].stored(round(rise) << 16)) >> 16
    speed, rise = (max(least, min(one, top)) for one, top, least in zip(held, tops, SLOWEST, strict=True))
    ramp = min(speed / rise, math.sqrt(way / rise))  # as the controller will, with what its registers keep
    return Sweep(counts, speed, rise, (way / (rise * ramp) + ramp) * unit + REST_S, period)
