"""What an edit of a large program costs: new document, difference, code and English of every step."""

from __future__ import annotations

import dataclasses
import random
import time
from collections.abc import Callable

from codegen.changes import changes
from codegen.document import Document
from codegen.generate import generate
from codegen.instructions import Instruction, Jump, Label, Output, SingleAxisMove, Wait
from codegen.program import Place, Program, Section, Step, insert, move, remove, replace
from codegen.read import sentence
from codegen.setup import Setup, Unit
from tests.benchmarks.figure import Figure

STEPS = 1000
USES = 300
SEED = 7


def instruction(number: int) -> Instruction:
    """Instructions as a program of a machine mixes them; three in ten jump to one label."""
    if number == STEPS - 1:
        return Jump(target="LOOP")
    match number % 10:
        case 0 | 3 | 7:
            return Jump(target="LOOP")
        case 1 | 5:
            return SingleAxisMove(axis="X", distance=str(1 + number / 8), speed="5")
        case 2 | 8:
            return Wait(time=str(10 + number))
        case _:
            return Output(output=str(1 + number % 8))


def large_document() -> Document:
    """A program of 1000 steps with a scale of 637 counts an inch."""
    setup = Setup(model="ssc4")
    axis = dataclasses.replace(setup.axis("X"), unit=Unit.INCH, counts_per_unit="637")
    steps = [Step("s0", Label(name="LOOP"))]
    steps += [Step(f"s{number}", instruction(number)) for number in range(1, STEPS)]
    return Document(Program(name="LARGE", main=tuple(steps)), setup.with_axis("X", axis))


def shown(old: Document, new: Document) -> int:
    """What the program window does after an edit; returns how much there was."""
    differences = changes(old.program, new.program)
    listing = generate(new)
    setup = new.working_setup
    texts = [sentence(step.instruction, setup) for step in new.program.steps()]
    return len(differences) + len(listing.lines) + len(texts)


def random_edit(chance: random.Random, document: Document, number: int) -> Document:
    """One of the edits a person makes: change, insert, remove, move."""
    program = document.program
    steps = program.main
    chosen = steps[chance.randrange(1, len(steps))]
    match chance.randrange(5):
        case 0 | 1:
            made = dataclasses.replace(chosen, instruction=Wait(time=str(5000 + number)))
            changed = replace(program, made)
        case 2:
            place = Place(Section.MAIN, chance.randrange(1, len(steps)))
            changed = insert(program, [Step(f"n{number}", Output(output="2"))], place)
        case 3:
            changed = remove(program, [chosen.id])
        case _:
            changed = move(program, [chosen.id], Place(Section.MAIN, chance.randrange(1, len(steps))))
    return dataclasses.replace(document, program=changed)


def timed(action: Callable[[], object]) -> float:
    """Milliseconds of one action, in processor time: busy neighbours do not count."""
    began = time.process_time()
    action()
    return 1000 * (time.process_time() - began)


def many_edits(count: int = 500) -> Figure:
    """500 random edits of 1000 steps; the figure is the 95th percentile."""
    chance = random.Random(SEED)
    document = large_document()
    shown(document, document)
    spent = []
    for number in range(count):

        def one(before: Document = document, which: int = number) -> Document:
            after = random_edit(chance, before, which)
            shown(before, after)
            return after

        began = time.process_time()
        document = one()
        spent.append(1000 * (time.process_time() - began))
    spent.sort()
    return Figure("an edit of 1000 steps", spent[int(len(spent) * 0.95)], "ms (p95)", most=16, note=f"of {count}")


def rename() -> Figure:
    """A label that 300 jumps use gets another name."""
    document = large_document()
    shown(document, document)

    def renamed(step: Step) -> Step:
        old = step.instruction
        if isinstance(old, Jump):
            return dataclasses.replace(step, instruction=dataclasses.replace(old, target="AGAIN"))
        if isinstance(old, Label):
            return dataclasses.replace(step, instruction=dataclasses.replace(old, name="AGAIN"))
        return step

    def act() -> None:
        program = dataclasses.replace(document.program, main=tuple(map(renamed, document.program.main)))
        after = dataclasses.replace(document, program=program)
        assert shown(document, after) > STEPS

    uses = sum(isinstance(step.instruction, Jump) for step in document.program.main)
    assert uses == USES, uses
    return Figure("rename of a label used 300 times", timed(act), "ms", most=100)


def rescale() -> Figure:
    """The axis gets another scale: every move is written anew."""
    document = large_document()
    shown(document, document)

    def act() -> None:
        axis = dataclasses.replace(document.setup.axis("X"), counts_per_unit="1000")
        after = dataclasses.replace(document, setup=document.setup.with_axis("X", axis))
        assert shown(document, after) > STEPS

    return Figure("change of scale", timed(act), "ms", most=100)
