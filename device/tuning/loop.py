"""The position loop exactly as the controller samples it: filter, hold, plant (dmc-1412-1414.txt l.4445-4500)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy
from numpy.typing import NDArray

from device.simulator.kernel import servo
from device.tuning.plant import AxisPlant, Vector, response, sampled

Complex = NDArray[numpy.complex128]
VOLTS = servo.VOLTS  # of one count of the converter (l.4449-4452)
TM_UNITS = 1_024_000.0  # TM counts in 1/1 024 000 s
POINTS = 3000
LOWEST = 0.1  # rad/s; below, a loop with an integrator is steeper than any phase lead can follow


@dataclass(frozen=True, kw_only=True)
class Gains:
    """The servo filter by its commands; the defaults are the factory's."""

    kp: float = 6.0
    ki: float = 0.0
    kd: float = 64.0
    fv: float = 0.0
    fa: float = 0.0
    integrator_limit: float = 9.9982  # V
    torque_limit: float = 9.9982  # V
    offset: float = 0.0  # V


FACTORY = Gains()


@dataclass(frozen=True)
class Margins:
    """How far the loop is from oscillating."""

    crossover: float | None  # rad/s where the gain first falls through 1
    phase: float | None  # degrees to -180° at the crossover, or less where the gain passes 1 again
    gain: float | None  # dB above the crossover; None: the phase never comes to -180°
    sensitivity: float  # the largest |1 / (1 + A)|
    stable: bool  # all poles of the sampled loop lie inside the unit circle


@dataclass(frozen=True)
class Bode:
    """Frequency response of the plant (with hold and delay, counts/V) and of the whole open loop."""

    frequency: Vector  # rad/s
    plant: Complex
    loop: Complex


def period(tm_us: float) -> float:
    """The true length of a sample, s."""
    return tm_us / TM_UNITS


def grid(period: float, points: int = POINTS) -> Vector:
    """Frequencies from far below any crossover to half the sampling frequency, rad/s."""
    found: Vector = numpy.geomspace(LOWEST, math.pi / period * (1 - 1e-6), points)
    return found


def filter_response(gains: Gains, period: float, frequency: Vector) -> Complex:
    """Volts per count: 4KP + 4KD (1 - 1/z) + KI/2 / (1 - 1/z) counts of the converter (l.4454-4476)."""
    change = 1.0 - numpy.exp(-1j * frequency * period)
    found: Complex = VOLTS * (4.0 * gains.kp + 4.0 * gains.kd * change + 0.5 * gains.ki / change)
    return found


def bode(plant: AxisPlant, gains: Gains, period: float, points: int = 400) -> Bode:
    """The Bode plot of plant and loop."""
    frequency = grid(period, points)
    of_plant = response(plant, period, frequency)
    return Bode(frequency, of_plant, of_plant * filter_response(gains, period, frequency))


def phase_margin(value: complex) -> float:
    """Degrees that are left to -180°."""
    return math.degrees(math.atan2(-value.imag, -value.real))


def crossings(loop: Complex) -> list[tuple[int, float]]:
    """Where the gain passes 1: the point before, and which part of the (logarithmic) way to the next."""
    size = numpy.log(numpy.abs(loop) + 1e-300)
    places = numpy.flatnonzero((size[:-1] >= 0.0) != (size[1:] >= 0.0))
    return [(int(i), float(size[i] / (size[i] - size[i + 1]))) for i in places]


def between(values: Complex, place: int, part: float) -> complex:
    """A value between two points of the grid, by size and angle."""
    first, turn = complex(values[place]), complex(values[place + 1] / values[place])
    return (
        first
        * math.exp(part * math.log(abs(turn)))
        * complex(math.cos(part * math.atan2(turn.imag, turn.real)), math.sin(part * math.atan2(turn.imag, turn.real)))
    )


def gain_margin(loop: Complex, above: int) -> float | None:
    """dB to oscillation by more gain: the closest passage of the negative real axis above a point of the grid."""
    part = loop[above:]
    places = numpy.flatnonzero(((part.imag[:-1] < 0.0) != (part.imag[1:] < 0.0)) & (part.real[:-1] < 0.0))
    sizes = [abs(between(part, int(i), 0.5)) for i in places]
    return -20.0 * math.log10(max(sizes)) if sizes and max(sizes) > 0.0 else None


def margins_of(loop: Complex, frequency: Vector, stable: bool) -> Margins:
    """The margins of an open loop given over a grid."""
    sensitivity = float(1.0 / numpy.abs(1.0 + loop).min())
    places = crossings(loop)
    if not places:
        return Margins(None, None, None, sensitivity, stable)
    first, part = places[0]
    crossover = float(frequency[first] * (frequency[first + 1] / frequency[first]) ** part)
    at_first, *later = [phase_margin(between(loop, i, share)) for i, share in places]
    # behind the crossover a spring turns the phase either way: what counts is how far it stays from -180°
    nearest = min([at_first, *(abs(margin) for margin in later)])
    return Margins(crossover, nearest, gain_margin(loop, first + 1), sensitivity, stable)


def margins(plant: AxisPlant, gains: Gains, period: float) -> Margins:
    """Crossover, margins and stability of the sampled loop."""
    frequency = grid(period)
    loop = response(plant, period, frequency) * filter_response(gains, period, frequency)
    return margins_of(loop, frequency, is_stable(plant, gains, period))


def closed_loop(plant: AxisPlant, gains: Gains, period: float) -> Vector:
    """The transition of the whole loop: plant, commands under way, last error, integrator."""
    system = sampled(plant, period)
    size, under_way = len(system.output), system.late + 1
    whole = numpy.zeros((size + under_way + 2, size + under_way + 2))
    last, total = size + under_way, size + under_way + 1
    volts = numpy.zeros(len(whole))  # of this sample, from the whole state
    volts[:size] = -VOLTS * (4.0 * gains.kp + 4.0 * gains.kd + 0.5 * gains.ki) * system.output
    volts[last], volts[total] = -VOLTS * 4.0 * gains.kd, 1.0
    whole[:size, :size] = system.transition
    commands = [volts, *(numpy.eye(len(whole))[size + n] for n in range(under_way))]
    whole[:size] += numpy.outer(system.now, commands[system.late])
    whole[:size] += numpy.outer(system.before, commands[system.late + 1])
    for n in range(under_way):
        whole[size + n] = commands[n]
    whole[last, :size] = -system.output
    whole[total, :size], whole[total, total] = -VOLTS * 0.5 * gains.ki * system.output, 1.0
    return whole if gains.ki else whole[:total, :total]


def is_stable(plant: AxisPlant, gains: Gains, period: float) -> bool:
    """Whether a disturbance dies away."""
    return bool(numpy.abs(numpy.linalg.eigvals(closed_loop(plant, gains, period))).max() < 1.0)
