"""Steps beside each other, worked out once: after an edit the stretches that it did not touch are found again.

A program is cut where the ids of its steps say, so a step put in or taken out moves no cut behind it. What a stretch
becomes depends on its steps, the setup and whether it is configuration, on nothing else.
"""

from __future__ import annotations

import dataclasses as dc
import re
from collections.abc import Iterator
from functools import lru_cache

from codegen.compiled import Compiled, compiled
from codegen.drift import along, drift, judged
from codegen.fields import Choice, fields_of
from codegen.instructions import End, Jump, Label, LoopRate, Subroutine, TwoLetterCode
from codegen.instructions.flow import EndOf, Routine
from codegen.laps import Item, loops
from codegen.packing import Line, Piece
from codegen.program import Step, Steps, is_closed, jump_label, walk
from codegen.setup import Finding, Setup
from codegen.twoletter.nodes import Command
from codegen.twoletter.parse import parse

END_OF = {
    Routine.USER: EndOf.SUBROUTINE,
    Routine.MCTIME: EndOf.SUBROUTINE,
    Routine.CMDERR: EndOf.SUBROUTINE,
    Routine.ININT: EndOf.INPUT,
    Routine.POSERR: EndOf.ERROR,
    Routine.LIMSWI: EndOf.ERROR,
    Routine.COMINT: EndOf.COMMUNICATION,
}
TYPICAL = 32  # steps of a stretch
SMALL = 16  # steps; a repeat of more is cut up itself
GENERATED = re.compile(r"RC?[0-9]+")  # names that would clash with generated ones

Found = tuple[int, Finding]  # which step of the stretch


class Run:
    """Steps on a machine; two are the same when they are the very same objects."""

    __slots__ = ("_key", "setup", "steps")

    def __init__(self, steps: Steps, setup: Setup) -> None:
        self.steps, self.setup = steps, setup
        self._key = (id(setup), *map(id, steps))

    def __hash__(self) -> int:
        return hash(self._key)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Run) and self._key == other._key


@dc.dataclass(eq=False)
class Stretch:
    """What some steps become: lines, findings, and what the rest of the program must know of them."""

    piece: Piece = dc.field(default_factory=lambda: Piece(()))
    numbers: int = 0  # how many unique numbers it needs
    findings: list[Found] = dc.field(default_factory=list)
    defines: list[tuple[int, str, str]] = dc.field(default_factory=list)  # labels, with the step
    targets: list[tuple[str, str]] = dc.field(default_factory=list)  # labels that it goes to, with the step
    unscaled: list[tuple[int, str, str]] = dc.field(default_factory=list)  # axes whose scale was never set up
    arrays: list[str] = dc.field(default_factory=list)
    first_array: int = -1  # the line in front of which the first one is made
    labels: list[str] = dc.field(default_factory=list)  # those that a Jump can name, also while commented out
    taken: set[str] = dc.field(default_factory=set)  # names that generated ones must differ from
    items: tuple[Item, ...] = ()  # how it moves the axes


def runs(steps: Steps) -> Iterator[Steps]:
    """Cuts steps up; what holds many others stands alone."""
    start = 0
    for place in [
        place for place, step in enumerate(steps) if step.instruction.container or hash(step.id) % TYPICAL == 0
    ]:
        alone = stands_alone(steps[place : place + 1])
        if start < place and (alone or hash(steps[place].id) % TYPICAL == 0):
            yield steps[start:place]
            start = place
        if alone:
            yield steps[place : place + 1]
            start = place + 1
    if start < len(steps):
        yield steps[start:]


def stands_alone(run: Steps) -> bool:
    """Whether it is a step that holds many others, which are stretches of their own."""
    return len(run) == 1 and run[0].instruction.container and run[0].enabled and not _is_small(run[0])


def _is_small(step: Step) -> bool:
    if len(step.body) > SMALL or isinstance(step.instruction, Subroutine):
        return False
    return not any(inner.body or isinstance(inner.instruction, Jump) for inner in step.body)


@lru_cache(maxsize=4096)
def stretch(run: Run, configuration: bool) -> Stretch:
    """Everything about a run of steps that does not depend on its place."""
    work = _Work(run.setup, configuration)
    work.walk(run.steps)
    work.made.items = along(run.steps, run.setup)
    return work.finished()


@lru_cache(maxsize=4096)
def opened(run: Run, configuration: bool) -> tuple[Stretch, Piece]:
    """A step that stands alone without what it holds; and its last lines, which share its numbers."""
    work, closing = _Work(run.setup, configuration), _Work(run.setup, configuration)
    (step,) = run.steps
    made = compiled(step.instruction, run.setup)
    work.note(step, made)
    work.add(made.before, step.id, made.numbers)
    work.made.numbers = made.numbers
    closing.add(made.after, step.id, made.numbers)
    return work.finished(), closing.finished().piece


@lru_cache(maxsize=4096)
def closed(run: Run) -> Stretch:
    """The right end where a subroutine has none, and what is wrong about the ends it has."""
    work = _Work(run.setup, False)
    (routine,) = run.steps
    if not isinstance(routine.instruction, Subroutine):
        work.find(Finding("", "This step stands outside a subroutine", "error", "", routine.id, "outside-subroutine"))
        return work.finished()
    wanted = END_OF[routine.instruction.routine]
    if not is_closed(routine):
        work.add(compiled(End(of=wanted), run.setup).before, routine.id, 0)
        work.find(
            Finding("", "This subroutine is not closed yet: add an End", "warning", "", routine.id, "subroutine-open")
        )
    for step in routine.body:
        end = step.instruction
        if step.enabled and isinstance(end, End) and end.of is not wanted:
            text = f"{routine.instruction.label} needs the end of {_words(wanted)}"
            work.find(Finding("of", text, "error", "", step.id, "wrong-end"))
    return work.finished()


class _Work:
    """Walks the steps of one stretch."""

    def __init__(self, setup: Setup, configuration: bool) -> None:
        self.setup, self.configuration = setup, configuration
        self.made = Stretch()
        self.lines: list[Line] = []
        self.marked: list[tuple[int, int, int]] = []
        self.at = 0  # which step of the stretch

    def finished(self) -> Stretch:
        self.made.piece = Piece(tuple(self.lines), tuple(self.marked))
        return self.made

    def walk(self, steps: Steps) -> None:
        for number, step in enumerate(steps):
            self.at = number
            self.step(step)

    def keep_names(self, step: Step) -> None:
        """What is commented out may be brought back."""
        for each in walk((step,)):
            self.names(each, compiled(each.instruction, self.setup))

    def step(self, step: Step) -> None:
        if not step.enabled:
            self.keep_names(step)
            return
        made = compiled(step.instruction, self.setup)
        self.note(step, made)
        first = self.made.numbers
        self.made.numbers += made.numbers
        if step.body and (text := drift(step, self.setup)):
            self.find(Finding("", text, "warning", "", step.id, "drift"))
        self.add(made.before, step.id, made.numbers, first)
        if step.body:
            for inner in step.body:
                self.step(inner)
            for mark, _, turn in loops([(item, 0) for item in along(step.body, self.setup)]):
                if text := judged("This loop", turn, self.setup):
                    self.find(Finding("", text, "warning", "", mark.step, "drift"))
        self.add(made.after, step.id, made.numbers, first)

    def add(self, texts: tuple[str, ...], step: str, numbers: int, first: int = 0) -> None:
        if numbers:
            self.marked += [(len(self.lines) + place, first, first + numbers) for place in range(len(texts))]
        self.lines += [Line(text, step) for text in texts]

    def find(self, finding: Finding) -> None:
        self.made.findings.append((self.at, finding))

    def names(self, step: Step, made: Compiled) -> None:
        """Labels and variables of the person, so that generated ones differ."""
        if made.defines or made.names:
            self.made.taken |= {name for name in (*made.defines, *made.names) if GENERATED.fullmatch(name)}
            self.made.labels += made.defines if isinstance(step.instruction, TwoLetterCode) else ()
        if step.enabled and isinstance(step.instruction, Label | Subroutine):
            self.made.labels += jump_label(step.instruction)

    def note(self, step: Step, made: Compiled) -> None:
        """Problems, labels, jumps and arrays of a step."""
        self.names(step, made)
        if not made.noteworthy:
            return
        for finding in (*made.errors, *made.warnings):
            self.find(dc.replace(finding, step=step.id))
        if made.errors:
            problem = made.errors[0].message
            self.lines.append(Line(f"' {problem}", step.id, problem))
        self.made.unscaled += [(self.at, letter, step.id) for letter in made.unscaled]
        self.made.defines += [(self.at, label, step.id) for label in made.defines]
        if made.target:
            self.made.targets.append((made.target, step.id))
        if made.arrays:
            if self.made.first_array < 0:
                self.made.first_array = len(self.lines)
            self.made.arrays += made.arrays
        if isinstance(step.instruction, TwoLetterCode) and _sets_loop_rate(step.instruction):
            text = "The loop rate set here does not rescale the other instructions; use Loop Rate"
            self.find(Finding("text", text, "warning", "", step.id, "loop-rate-in-code"))
        if not self.configuration and isinstance(step.instruction, LoopRate):
            text = "Loop Rate belongs to the configuration: speeds and waits of the whole program depend on it"
            self.find(Finding("", text, "error", "", step.id, "loop-rate-late"))


def _sets_loop_rate(code: TwoLetterCode) -> bool:
    return any(isinstance(node, Command) and node.name == "TM" for _, node in parse(code.text).statements())


def _words(end: EndOf) -> str:
    field = fields_of(End)["of"]
    assert isinstance(field, Choice)
    return field.words[end]
