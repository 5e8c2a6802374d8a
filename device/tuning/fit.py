"""Least squares of a plant's shape against every sample: gain, weight, friction and starting states are linear."""

from __future__ import annotations

import math
from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass

import numpy
from numpy.typing import NDArray

from device.tuning.plant import AxisPlant, Vector, sampled
from device.tuning.recording import Samples

LENGTH = 128  # samples of a window; within one a double integrator does not drift away
SHORTEST = 24
SMOOTH = 5  # samples on each side over which a speed is taken
SLOW = 0.15  # counts a sample; below, a machine with friction may stand
ROUNDS = 30
ENOUGH = 1e-5  # relative gain of a round below which it ends


@dataclass(frozen=True)
class Windows:
    """Pieces of recordings, all of one length; weight 0 where a piece is shorter or a sample is unsure."""

    period: float
    counts: Vector  # piece × sample
    weight: Vector
    volts: tuple[Vector, ...]  # the command so many samples earlier: piece × sample, for 0, 1, 2 ...
    direction: Vector  # -1..1: which way it moves

    @property
    def samples(self) -> int:
        """How many samples count."""
        return int(self.weight.sum())


@dataclass(frozen=True)
class Fit:
    """One shape at its best."""

    plant: AxisPlant  # gain, gravity and friction filled in
    residual: Vector  # weighted, starting states taken out
    cost: float  # sum of squares
    spread: tuple[float, ...]  # one sigma of gain, gravity·gain, friction·gain for white noise of the size seen


def speed(counts: Vector) -> Vector:
    """Counts a sample, by a straight line through the neighbours."""
    width = min(SMOOTH, (len(counts) - 1) // 2)
    slope = numpy.arange(-width, width + 1) / sum(n * n for n in range(-width, width + 1))
    padded = numpy.pad(counts, width, mode="edge")
    found: Vector = numpy.convolve(padded, slope[::-1], mode="valid")
    return found


def moving_runs(samples: Samples, rubbing: bool) -> list[tuple[int, int]]:
    """First and last-but-one sample of the pieces that can be told by linear equations."""
    total, first = len(samples.counts), max(0, (samples.jumps or (0,))[0] - 4)
    if not rubbing:
        return [(begin, min(begin + LENGTH, total)) for begin in range(first, total - SHORTEST, LENGTH)]
    fast = numpy.abs(speed(samples.counts)) > SLOW
    fast[:first] = False
    edges = numpy.flatnonzero(numpy.diff(numpy.concatenate([[False], fast, [False]]).astype(int)))
    runs: list[tuple[int, int]] = []
    for begin, end in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True):
        if runs and begin - runs[-1][1] <= 2 and runs[-1][1] - runs[-1][0] + end - begin < 2 * LENGTH:
            runs[-1] = (runs[-1][0], end)  # a reversal, no stop
        else:
            runs.append((begin, end))
    pieces = [(at, min(at + LENGTH, end)) for begin, end in runs for at in range(begin, end, LENGTH)]
    return [(begin, end) for begin, end in pieces if end - begin >= SHORTEST]


def windows(recordings: Sequence[Samples], rubbing: bool, latest: int) -> Windows | None:
    """Cuts recordings into pieces; None where nothing moves long enough."""
    counts, weight, direction = [], [], []
    volts: list[list[Vector]] = [[] for _ in range(latest + 2)]
    for samples in recordings:
        way = numpy.clip(speed(samples.counts) / SLOW, -1.0, 1.0)
        for begin, end in moving_runs(samples, rubbing):
            room = (0, LENGTH - (end - begin))
            counts.append(numpy.pad(samples.counts[begin:end] - samples.counts[begin], room))
            weight.append(numpy.pad(samples.sure[begin:end].astype(float), room))
            direction.append(numpy.pad(way[begin:end], room))
            for late, rows in enumerate(volts):
                places = numpy.arange(begin - late, end - late).clip(0)
                rows.append(numpy.pad(samples.volts[places], room))
    if not counts:
        return None
    period = recordings[0].period
    stacked = tuple(numpy.array(rows) for rows in volts)
    return Windows(period, numpy.array(counts), numpy.array(weight), stacked, numpy.array(direction))


def answers(plant: AxisPlant, period: float) -> tuple[Vector, Vector, Vector]:
    """For gain 1: what starting states, one sample's command and one sample's weight do later."""
    system = sampled(plant, period)
    free, power = system.output[None, :], system.transition
    while len(free) < LENGTH:  # rows C, CF, CF², ... by doubling
        free, power = numpy.concatenate([free, free @ power]), power @ power
    pulse, load = numpy.zeros((LENGTH, 2)), numpy.zeros(LENGTH)
    pulse[1:] = free[:-1] @ numpy.column_stack([system.now, system.before])
    load[1:] = free[:-1] @ system.weight
    return free, pulse, load


def lower(pulse: Vector) -> Vector:
    """The matrix that turns commands into what they have done: row n sums pulse[n-k] u[k]."""
    padded = numpy.concatenate([numpy.zeros(LENGTH - 1), pulse])
    rows: Vector = numpy.lib.stride_tricks.sliding_window_view(padded, LENGTH)[:, ::-1]
    return rows


def solve(data: Windows, shape: AxisPlant, rubbing: bool) -> Fit:
    """The best gain, weight and friction for a pole, a delay and a resonance."""
    free, pulse, load = answers(shape, data.period)
    late = math.floor(shape.delay / data.period + 1e-9)
    driven = data.volts[late] @ lower(pulse[:, 0]).T
    if shape.delay > late * data.period:
        driven = driven + data.volts[late + 1] @ lower(pulse[:, 1]).T
    columns = [driven, numpy.broadcast_to(numpy.cumsum(load), driven.shape)]
    if rubbing:
        columns.append(data.direction @ lower(pulse.sum(axis=1)).T)
    weight = data.weight[:, :, None]
    basis, _ = numpy.linalg.qr(free[None] * weight)
    whole = numpy.stack([*columns, data.counts], axis=2) * weight
    whole = whole - basis @ (basis.transpose(0, 2, 1) @ whole)
    flat = whole.reshape(-1, whole.shape[2])
    x, y = flat[:, :-1], flat[:, -1]
    scale = numpy.sqrt((x * x).sum(axis=0)) + 1e-30
    found, *_ = numpy.linalg.lstsq(x / scale, y, rcond=1e-10)
    residual = y - (x / scale) @ found
    found = found / scale
    cost = float(residual @ residual)
    inverse = numpy.linalg.pinv((x / scale).T @ (x / scale))
    noise = cost / max(1, data.samples - len(found))
    spread = tuple(float(v) for v in numpy.sqrt(noise * numpy.diag(inverse)) / scale)
    gain = float(found[0])
    part = 1.0 / gain if gain else 0.0
    plant = AxisPlant(
        gain=gain,
        pole=shape.pole,
        gravity=-float(found[1]) * part,
        coulomb=max(0.0, -float(found[2]) * part) if rubbing else 0.0,
        delay=shape.delay,
        resonance=shape.resonance,
    )
    return Fit(plant, residual, cost, spread)


Values = NDArray[numpy.float64]


def refining(
    data: Windows,
    start: Values,
    shape: Callable[[Values], AxisPlant],
    rubbing: bool,
    low: Values,
    high: Values,
    done: float,
) -> Generator[float, None, tuple[Values, Fit, Vector]]:
    """Levenberg's method over what is not linear; yields `done` each round, the last result is the curvature."""
    values, damping = numpy.clip(start, low, high), 1e-2
    best = solve(data, shape(values), rubbing)
    curvature = numpy.eye(len(values))
    for _ in range(ROUNDS):
        yield done
        jacobian = numpy.empty((len(best.residual), len(values)))
        for n in range(len(values)):
            step = 1e-4 * max(1e-2, abs(values[n]))
            near = values.copy()
            near[n] += step if values[n] + step <= high[n] else -step
            jacobian[:, n] = (solve(data, shape(near), rubbing).residual - best.residual) / (near[n] - values[n])
        curvature = jacobian.T @ jacobian
        slope = jacobian.T @ best.residual
        before = best.cost
        for _ in range(8):
            change = numpy.linalg.lstsq(
                curvature + damping * numpy.diag(numpy.diag(curvature) + 1e-12), -slope, rcond=None
            )[0]
            there = numpy.clip(values + change, low, high)
            fit = solve(data, shape(there), rubbing)
            if fit.cost < best.cost:
                values, best, damping = there, fit, max(1e-9, damping * 0.2)
                break
            damping *= 5.0
        if before - best.cost <= ENOUGH * before:
            break
    return values, best, curvature
