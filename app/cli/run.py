"""`twoletter run`: source or a program on the simulator, in virtual or real time."""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from app.cli.failure import DONE, NO, Failure
from app.cli.limits import apply_limits
from app.cli.report import report
from app.cli.sources import Loaded, complete, load_any, read_profile, read_text, readable, target
from app.cli.stimulus import Happening, read_stimulus
from app.cli.trace import Columns, Trace, check_ending, write_trace
from codegen.models import Model
from codegen.twoletter.problems import ERROR_TEXTS
from device.simulator.plant import Plant
from device.simulator.simulation import Simulation
from device.simulator.times import TICKS, TICKS_PER_MS
from device.simulator.twoletter.memory import DownloadRefused
from device.simulator.twoletter.state import CommandError

SLICE_S = 0.02
LONGEST_S = 1e6
STATE_KEYS = (
    "messages",
    "errors",
    "axes",
    "inputs",
    "outputs",
    "analog",
    "error_output",
    "variables",
    "strings",
    "arrays",
    "threads",
)


def read_plants(path: str | None) -> dict[str, Plant] | None:
    """The mechanics behind the controller, where they are given."""
    if path is None:
        return None
    from device.simulator.plant_file import PlantUnreadable, load_plants

    readable(Path(path))
    try:
        return load_plants(Path(path))
    except (PlantUnreadable, OSError) as problem:
        text = str(problem)
        raise Failure(text if path in text else f"{path}: {text}") from problem


@dataclass
class Run:
    """One run of a program, from its first command until nothing runs or moves."""

    simulation: Simulation
    limit_s: float
    happenings: list[Happening] = field(default_factory=list)
    trace: Trace | None = None
    pace: Callable[[float], None] | None = None
    stopped: str = ""

    def go(self) -> None:
        """Runs to the end, the time limit, or an error nobody handles."""
        start = self.simulation.ticks
        end = start + round(self.limit_s * TICKS)
        pending = list(self.happenings)
        while not self.stopped:
            while pending and start + round(pending[0].ms * TICKS_PER_MS) <= self.simulation.ticks:
                happening = pending.pop(0)
                self.simulation.stimulus(happening.signal, happening.value)
            until = min(end, start + round(pending[0].ms * TICKS_PER_MS)) if pending else end
            self.advance_to(until, start, end)

    def advance_to(self, until: int, start: int, end: int) -> None:
        """Runs up to a moment, in slices where they are needed."""
        while not self.stopped and self.simulation.ticks < until:
            outcome = self.simulation.run_until_idle(min(until - self.simulation.ticks, self.slice_ticks()))
            if self.trace:
                self.trace.take()
            if self.pace:
                self.pace((self.simulation.ticks - start) / TICKS)
            if outcome != "time":
                self.stopped = outcome
        if self.simulation.ticks >= end and not self.stopped:
            self.stopped = "time"

    def slice_ticks(self) -> int:
        """How far to run at once."""
        if self.pace:
            return round(SLICE_S * TICKS)
        return self.trace.longest_slice() if self.trace else 1 << 60


def real_time(simulation: Simulation, out: Callable[[str], None]) -> Callable[[float], None]:
    """Waits for the clock on the wall, and shows messages as they come."""
    began = time.monotonic()
    shown = 0

    def pace(virtual_s: float) -> None:
        nonlocal shown
        for ms, port, text in simulation.messages[shown:]:
            out(f"{ms:12.3f} ms  port {port}  {text}")
        shown = len(simulation.messages)
        time.sleep(max(0.0, began + virtual_s - time.monotonic()))

    return pace


def entry_of(text: str | None) -> str | int:
    """Where to start, as the simulator takes it."""
    if text is None:
        return 0
    name = text.lstrip("#")
    return int(name) if name.isdecimal() else f"#{name}"


def loaded_simulation(
    loaded: Loaded, plants: dict[str, Plant] | None, entry: str | None, profile: str | None = None
) -> Simulation:
    """A simulator with the program in it, started."""
    simulation = Simulation(loaded.model, plants=plants, profile=read_profile(profile))
    if not loaded.bare:
        apply_limits(simulation, loaded.setup)
    try:
        simulation.load_program(loaded.text)
    except DownloadRefused as refused:
        raise Failure(f"{loaded.path}: the controller refuses this program: {refused}") from refused
    try:
        simulation.execute(entry_of(entry))
    except CommandError as refused:
        reason = ERROR_TEXTS.get(refused.code, f"error {refused.code}")
        raise Failure(f"{loaded.path}: cannot start at {entry or 'line 0'}: {reason}") from refused
    return simulation


@dataclass(frozen=True)
class Outcome:
    """What a run came to."""

    state: dict[str, Any]
    stopped: str
    virtual_seconds: float
    wall_seconds: float
    columns: Columns | None

    def as_json(self, model: Model) -> dict[str, Any]:
        """The object of `--json`."""
        return {
            "controller": model.name,
            "stopped": self.stopped,
            "virtual_seconds": round(self.virtual_seconds, 6),
            "wall_seconds": round(self.wall_seconds, 6),
            **{key: self.state[key] for key in STATE_KEYS},
        }


def perform(
    loaded: Loaded, options: argparse.Namespace, happenings: list[Happening], out: Callable[[str], None] | None
) -> Outcome:
    """Runs what was loaded."""
    simulation = loaded_simulation(loaded, read_plants(options.plant), options.entry, options.profile)
    trace = Trace(simulation, loaded.model.threads, loaded.model.axes, options.every) if options.trace else None
    pace = real_time(simulation, out or (lambda _: None)) if options.real_time else None
    if trace:
        trace.start()
    run = Run(simulation, options.time, happenings, trace, pace)
    start = simulation.ticks
    began = time.perf_counter()
    run.go()
    wall = time.perf_counter() - began
    return Outcome(
        simulation.state(),
        run.stopped,
        (simulation.ticks - start) / TICKS,
        wall,
        trace.columns() if trace else None,
    )


def run(options: argparse.Namespace) -> int:
    """Runs a file and reports; 1 when the program ended with an error."""
    if not 0 < options.time <= LONGEST_S or options.every < 1:
        raise Failure(f"--time must be between 0 and {LONGEST_S:g} seconds, --every at least 1")
    path = Path(options.file)
    if options.trace:
        read = [Path(each) for each in (options.setup, options.plant, options.stimulus) if each]
        check_ending(target(options.trace, path, *read))
    loaded = load_any(path, options.controller, options.setup)
    complete(path, loaded.text, loaded.listing)
    name = options.stimulus or str(loaded.path)
    text = read_text(Path(options.stimulus)) if options.stimulus else loaded.stimulus
    happenings = read_stimulus(text, name, loaded.model) if options.stimulus or text.strip() else []
    outcome = perform(loaded, options, happenings, None if options.json else print)
    for notice in outcome.state.get("notices", ()):
        print(f"twoletter: {notice}", file=sys.stderr)
    if options.json:
        print(json.dumps(outcome.as_json(loaded.model), ensure_ascii=False))
    else:
        for line in report(outcome.state, outcome.stopped, outcome.virtual_seconds, loaded, options.real_time):
            print(line)
    if options.trace and outcome.columns is not None:
        write_trace(outcome.columns, Path(options.trace))
    return NO if outcome.stopped == "error" else DONE
