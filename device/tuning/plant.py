"""What an axis is to the servo filter: inertia, friction, weight, delay, resonance (dmc-1412-1414.txt l.4338-4445)."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy
from numpy.typing import NDArray

Vector = NDArray[numpy.float64]
VELOCITY_POLE = 40.0  # rad/s; friction alone brakes slower, a drive with a velocity loop of its own faster
SERIES = 10  # terms of the exponential behind a scaling to below 1/8


@dataclass(frozen=True)
class Resonance:
    """Motor and load with a spring between them."""

    frequency: float  # Hz
    damping: float  # part of the critical one
    ratio: float  # inertia of the load over that of the motor
    on_load: bool = False  # where the encoder sits


@dataclass(frozen=True, kw_only=True)
class AxisPlant:
    """Motor command to encoder: x'' = gain (u - gravity - coulomb sign x') - pole x', with u late by `delay`."""

    gain: float  # counts/s² for one volt, all inertia together
    pole: float = 0.0  # rad/s: viscous friction, back EMF or a velocity loop
    coulomb: float = 0.0  # V
    gravity: float = 0.0  # V that hold the load
    delay: float = 0.0  # s
    resonance: Resonance | None = None

    @property
    def velocity_mode(self) -> bool:
        """The drive makes a speed of the command, not a torque."""
        return self.pole >= VELOCITY_POLE


@dataclass(frozen=True)
class Sampled:
    """The plant behind its hold: x⁺ = transition x + now u[k-late] + before u[k-late-1], counts = output x."""

    transition: Vector
    now: Vector
    before: Vector
    late: int
    output: Vector
    weight: Vector  # what one volt of gravity takes off in a sample


def exponential(matrix: Vector) -> Vector:
    """exp(matrix) by scaling, series and squaring."""
    norm = float(numpy.abs(matrix).sum(axis=1).max())
    squarings = max(0, math.ceil(math.log2(norm * 8.0))) if norm > 0.125 else 0
    scaled = matrix / 2.0**squarings
    result = term = numpy.eye(len(matrix))
    for order in range(1, SERIES + 1):
        term = term @ scaled / order
        result = result + term
    for _ in range(squarings):
        result = result @ result
    return result


def rates(plant: AxisPlant) -> tuple[Vector, Vector, Vector, Vector]:
    """x' = A x + B u - G gravity, counts = C x; x is motor place and speed, behind a spring also the load's."""
    found = plant.resonance
    if found is None:
        a = numpy.array([[0.0, 1.0], [0.0, -plant.pole]])
        b = numpy.array([0.0, plant.gain])
        return a, b, b, numpy.array([1.0, 0.0])
    whole = 1.0 + found.ratio
    omega = 2.0 * math.pi * found.frequency
    stiff_load, rub_load = omega**2 / whole, 2.0 * found.damping * omega / whole
    stiff, rub = stiff_load * found.ratio, rub_load * found.ratio
    a = numpy.array(
        [
            [0.0, 1.0, 0.0, 0.0],
            [-stiff, -rub - plant.pole * whole, stiff, rub],
            [0.0, 0.0, 0.0, 1.0],
            [stiff_load, rub_load, -stiff_load, -rub_load],
        ]
    )
    motor = numpy.array([0.0, plant.gain * whole, 0.0, 0.0])
    load = numpy.array([0.0, 0.0, 0.0, plant.gain * whole / found.ratio])
    return a, motor, load, numpy.array([0.0, 0.0, 1.0, 0.0] if found.on_load else [1.0, 0.0, 0.0, 0.0])


def held(a: Vector, inputs: Vector, time: float) -> tuple[Vector, Vector]:
    """Transition over `time`, and what inputs (columns) held through it add."""
    size, count = inputs.shape
    whole = numpy.zeros((size + count, size + count))
    whole[:size, :size], whole[:size, size:] = a * time, inputs * time
    result = exponential(whole)
    return result[:size, :size], result[:size, size:]


def sampled(plant: AxisPlant, period: float) -> Sampled:
    """The plant behind a zero-order hold; a delay may be any part of a sample."""
    a, motor, load, output = rates(plant)
    late = math.floor(plant.delay / period + 1e-9)
    part = max(0.0, plant.delay - late * period)
    inputs = numpy.column_stack([motor, load])
    transition, added = held(a, inputs, period)
    now, before = added[:, 0], numpy.zeros(len(a))
    if part > 1e-9 * period:
        rest, now_only = held(a, inputs, period - part)
        now = now_only[:, 0]
        before = rest @ held(a, inputs, part)[1][:, 0]
    return Sampled(transition, now, before, late, output, added[:, 1])


def response(plant: AxisPlant, period: float, frequency: Vector) -> NDArray[numpy.complex128]:
    """Counts per volt of hold, plant and delay at these frequencies (rad/s)."""
    system = sampled(plant, period)
    z = numpy.exp(1j * frequency * period)
    drive = numpy.outer(z**-system.late, system.now) + numpy.outer(z ** -(system.late + 1), system.before)
    stack = z[:, None, None] * numpy.eye(len(system.output)) - system.transition
    states = numpy.linalg.solve(stack, drive[:, :, None])[:, :, 0]
    return numpy.asarray(states @ system.output, dtype=numpy.complex128)


def shifted(plant: AxisPlant, part: float) -> AxisPlant:
    """The same axis with its resonance at `part` times the frequency."""
    if plant.resonance is None:
        return plant
    return replace(plant, resonance=replace(plant.resonance, frequency=plant.resonance.frequency * part))
