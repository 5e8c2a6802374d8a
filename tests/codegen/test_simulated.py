"""Every instruction's example is accepted by the simulated controller when its program runs."""

from __future__ import annotations

from pathlib import Path

import pytest

from codegen import files
from codegen.docs import EXAMPLE_SETUP
from codegen.document import Document
from codegen.generate import generate
from codegen.instructions import ALL, End, Instruction, Label, Subroutine, VariableArray
from codegen.models import model
from codegen.program import Program, Step
from device.simulator.simulation import Simulation
from resources import path

TICKS_PER_SECOND = 1_024_000
EXAMPLES = sorted(Path(path("examples")).glob("*.tlp"))
KINDS = [kind for kind in ALL if not kind.needs]


def around(instruction: Instruction) -> Document:
    """A program in which the instruction makes sense: the variable and the labels that examples name exist."""
    before = (Step("v", VariableArray(variable="LEN", number="4")), Step("l", Label(name="A")))
    tail = (Step("w", Label(name="WATCH")),)
    routines: tuple[Step, ...] = ()
    main: tuple[Step, ...] = ()
    if isinstance(instruction, Subroutine):
        routines = (Step("x", instruction, body=(Step("e", End()),)),)
    elif isinstance(instruction, End):
        routines = (Step("r", Subroutine(name="CUT"), body=(Step("x", instruction),)),)
    elif not isinstance(instruction, Label):
        main = (Step("x", instruction),)
    return Document(Program("P", main=(*before, *main, *tail), routines=routines), EXAMPLE_SETUP)


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
def test_the_controller_takes_every_example(kind: type[Instruction]) -> None:
    document = around(kind.example())
    if kind.section == "C" and document.program.main:
        steps = document.program.main
        document = Document(Program("P", configuration=steps[2:3], main=(*steps[:2], *steps[3:])), EXAMPLE_SETUP)
    assert generate(document).is_complete
    assert errors_of(document, seconds=1) == []


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda each: each.stem)
def test_the_controller_takes_every_program(example: Path) -> None:
    assert errors_of(files.load(example), seconds=3) == []


def errors_of(document: Document, seconds: int) -> list[object]:
    """What goes wrong in the first seconds of a program, all inputs high."""
    simulation = Simulation(model(document.setup.model))
    listing = generate(document)
    simulation.load_program(listing.text)
    simulation.execute(0, 0)
    for number in range(1, 9):
        simulation.stimulus(f"in{number}", 1)
    simulation.advance(seconds * TICKS_PER_SECOND)
    return list(simulation.errors)
