"""`twoletter demo`: the wire cutter from dialogs to a moving machine, without a window."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import numpy as np

from app.cli.failure import DONE, NO
from app.cli.picture import Panel, draw
from app.cli.report import final_state
from app.cli.run import Run, loaded_simulation
from app.cli.sources import Loaded, target, write_text
from app.cli.stimulus import read_stimulus
from app.cli.trace import Columns, Trace
from codegen.document import Document
from codegen.files import load
from codegen.generate import generate
from codegen.models import model
from codegen.program import Step
from codegen.read import sentence
from device.simulator.plant import Plant
from device.simulator.times import TICKS
from resources import path as resource

EXAMPLE = "examples/wire-cutter.tlp"
SECONDS = 7.5
REST_SAMPLES = 20
ROLLER = Plant(viscous_friction=0.006, coulomb_friction=0.002)  # N·m·s/rad and N·m: wire drags
STIMULUS = "ms,signal,value\n0,in1,0\n500,in1,1\n550,in1,0\n3500,in1,1\n3550,in1,0\n"


def program_lines(document: Document) -> list[str]:
    """The program in plain English."""
    program, setup = document.program, document.working_setup
    lines = [f"{program.name}: {program.description}".rstrip(": ")]

    def add(title: str, steps: tuple[Step, ...], depth: int) -> None:
        if title and steps:
            lines.append(f"  {title}")
        for step in steps:
            lines.append("  " * (depth + 1) + sentence(step.instruction, setup))
            add("", step.body, depth + 1)

    add("Configuration", program.configuration, 1)
    add("Main", program.main, 1)
    add("Subroutines", program.routines, 1)
    return lines


def events(columns: Columns) -> list[str]:
    """What happened when: inputs, outputs, moves."""
    found: list[tuple[float, str]] = []
    times = columns["ms"]
    for name, word in (("inputs", "input"), ("outputs", "output")):
        values = columns[name].astype(np.int64)
        for place in np.flatnonzero(np.diff(values)) + 1:
            changed = int(values[place] ^ values[place - 1])
            for bit in range(8):
                if changed >> bit & 1:
                    level = "on" if values[place] >> bit & 1 else "off"
                    found.append((float(times[place]), f"{word} {bit + 1} {level}"))
    found += moves(columns)
    return [f"{when:10.1f} ms  {text}" for when, text in sorted(found)]


def moves(columns: Columns) -> list[tuple[float, str]]:
    """Starts and ends of the moves of axis X; a rest shorter than a few samples belongs to the move."""
    position, times = columns["x_commanded"], columns["ms"]
    steps = np.flatnonzero(np.diff(position))
    if not len(steps):
        return []
    gaps = np.flatnonzero(np.diff(steps) > REST_SAMPLES)
    starts = steps[np.concatenate(([0], gaps + 1))]
    ends = steps[np.concatenate((gaps, [len(steps) - 1]))] + 1
    found = [(float(times[place]), f"X starts at {position[place]:.0f} counts") for place in starts]
    return found + [(float(times[place]), f"X has come to {position[place]:.0f} counts") for place in ends]


def picture(columns: Columns, document: Document) -> str:
    """Position, speed, input 1 and output 1 over time."""
    axis = document.setup.axis("X")
    scale = float(axis.scale)
    return draw(
        f"{document.program.name} on the simulated {document.setup.model}",
        columns["ms"] / 1000,
        [
            Panel("Position X", columns["x_actual"] / scale, axis.symbol),
            Panel("Speed X", columns["x_velocity"] / scale, f"{axis.symbol}/s"),
            Panel("Input 1", columns["inputs"].astype(np.int64) & 1, is_signal=True),
            Panel("Output 1", columns["outputs"].astype(np.int64) & 1, is_signal=True),
        ],
    )


def section(title: str, lines: list[str]) -> None:
    """Prints one part of the demo."""
    print(f"== {title}")
    for line in lines:
        print(line)
    print()


def performed(loaded: Loaded, stimulus: str) -> tuple[Columns, dict[str, Any], float]:
    """Runs the program with its stimulus: the record, the final state, virtual seconds."""
    simulation = loaded_simulation(loaded, {"X": ROLLER}, None)
    trace = Trace(simulation, loaded.model.threads, loaded.model.axes)
    trace.start()
    start = simulation.ticks
    Run(simulation, SECONDS, read_stimulus(stimulus, "stimulus", loaded.model), trace).go()
    return trace.columns(), simulation.state(), (simulation.ticks - start) / TICKS


def demo(options: argparse.Namespace) -> int:
    """Shows the whole way from program to motion."""
    picture_path = target(options.picture, ending=".svg")
    path = Path(resource(EXAMPLE))
    document = load(path)
    listing = generate(document)
    chosen = model(document.setup.model)
    loaded = Loaded(path, listing.text, chosen, document.setup, document, listing)
    columns, state, seconds = performed(loaded, document.stimulus or STIMULUS)
    section("Program", program_lines(document))
    section("Code", listing.text.splitlines())
    said = [f"{ms:10.1f} ms  port {port}  {text}" for ms, port, text in state["messages"]]
    section("Timeline", sorted(events(columns) + said))
    section(f"Final state after {seconds:.1f} s", list(final_state(state, loaded)))
    write_text(picture_path, picture(columns, document))
    print(f"picture of the motion: {picture_path}")
    return NO if state["errors"] else DONE
