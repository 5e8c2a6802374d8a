"""The record of a run, one row a sample, and its files."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from app.cli.failure import Failure
from app.cli.sources import sentence
from device.simulator.simulation import Simulation
from device.simulator.times import TICKS_PER_MS

Columns = dict[str, NDArray[np.float64]]
BLOCK_ROWS = 16384
SHORTEST_SAMPLE = 250  # ticks, at TM 250
KINDS = ("commanded", "actual", "velocity", "torque")


@dataclass
class Trace:
    """Collects rows while a simulation runs; `every` n-th sample is kept."""

    simulation: Simulation
    threads: int
    axes: str
    every: int = 1
    began: int = 0
    blocks: list[NDArray[np.float64]] = field(default_factory=list)
    times: list[NDArray[np.float64]] = field(default_factory=list)
    changes: list[tuple[int, int, int]] = field(default_factory=list)

    def start(self) -> None:
        """Begins to record."""
        self.began = self.simulation.ticks
        self.simulation.on_trace = lambda ticks, thread, line: self.changes.append((ticks, thread, line))
        self.simulation.motion.trace(BLOCK_ROWS, self.every)

    def longest_slice(self) -> int:
        """Ticks after which the rows must be taken."""
        return BLOCK_ROWS * self.every * SHORTEST_SAMPLE

    def take(self) -> None:
        """Takes the rows recorded so far."""
        motion, clock = self.simulation.unit.motion, self.simulation.unit.clock
        rows = motion.trace_rows().copy()
        motion.trace_clear()
        self.blocks.append(rows)
        self.times.append(clock.tick - (motion.sample - rows[:, 0]) * clock.period)

    def columns(self) -> Columns:
        """The record as named columns; time is true even where the sample time was changed."""
        width = 1 + len(KINDS) * len(self.axes) + 2
        rows = np.concatenate(self.blocks) if self.blocks else np.zeros((0, width))
        ticks = np.concatenate(self.times) if self.times else np.zeros(0)
        found: Columns = {"ms": (ticks - self.began) / TICKS_PER_MS}
        for index, axis in enumerate(self.axes.lower()):
            for place, kind in enumerate(KINDS):
                found[f"{axis}_{kind}"] = rows[:, 1 + index * len(KINDS) + place]
        found["inputs"], found["outputs"] = rows[:, -2], rows[:, -1]
        for thread in range(self.threads):
            found[f"thread{thread}"] = self.lines_of(thread, ticks)
        return found

    def lines_of(self, thread: int, ticks: NDArray[np.float64]) -> NDArray[np.float64]:
        """The line a thread is on at each time, -1 when it does not run."""
        own = [(when, line) for when, which, line in self.changes if which == thread]
        if not own:
            return np.full(len(ticks), -1.0)
        times = np.array([when for when, _ in own], dtype=np.float64)
        lines = np.array([-1, *(line for _, line in own)], dtype=np.float64)
        found: NDArray[np.float64] = lines[np.searchsorted(times, ticks, side="right")]
        return found


def number(name: str, value: float) -> str:
    """One value of a CSV row: whole numbers without a point, times and volts with what they need."""
    if name == "ms":
        return f"{value:.4f}".rstrip("0").rstrip(".")
    if value == int(value):
        return str(int(value))
    return f"{value:.4f}"


def write_trace(columns: Columns, path: Path) -> None:
    """Writes a trace as CSV or as numpy arrays, by the file's ending."""
    try:
        if path.suffix.lower() == ".npz":
            np.savez_compressed(path, **columns)  # type: ignore[arg-type]
            return
        with path.open("w", encoding="utf-8", newline="") as file:
            file.write(",".join(columns) + "\n")
            names = list(columns)
            for row in zip(*(columns[name].tolist() for name in names), strict=True):
                file.write(",".join(number(name, value) for name, value in zip(names, row, strict=True)) + "\n")
    except OSError as problem:
        raise Failure(f"{path}: {sentence(problem)}") from problem


def check_ending(path: Path) -> None:
    """Refuses a trace file of another kind before anything runs."""
    if path.suffix.lower() not in (".csv", ".npz"):
        raise Failure(f"{path}: a trace is written as .csv or .npz")
