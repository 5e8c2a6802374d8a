"""A program as frozen trees of steps, and the pure functions that edit it."""

from __future__ import annotations

import dataclasses as dc
import re
from collections.abc import Callable, Collection, Iterator, Sequence
from enum import StrEnum
from itertools import chain, count

from codegen.expressions import Bad, names, parse_expression
from codegen.fields import SYSTEM_LABELS
from codegen.instructions import (
    AutoExecution,
    End,
    Instruction,
    Label,
    MathematicalEquation,
    Subroutine,
    UserInterface,
    VariableArray,
)
from codegen.instructions.configuration import Declare


class Section(StrEnum):
    """The three sections of a program."""

    CONFIGURATION = "configuration"
    MAIN = "main"
    ROUTINES = "routines"


@dc.dataclass(frozen=True, slots=True)
class Step:
    """One line of the visual program; a container holds further steps."""

    id: str
    instruction: Instruction
    note: str = ""
    enabled: bool = True
    body: tuple[Step, ...] = ()


@dc.dataclass(frozen=True, slots=True)
class Place:
    """Where a step stands: in a section or a container step, at an index."""

    parent: str
    index: int


Steps = tuple[Step, ...]


@dc.dataclass(frozen=True)
class Program:
    """Name, description and the three sections."""

    name: str = ""
    description: str = ""
    configuration: Steps = ()
    main: Steps = ()
    routines: Steps = ()

    def section(self, section: Section) -> Steps:
        """The steps of a section."""
        match section:
            case Section.CONFIGURATION:
                return self.configuration
            case Section.MAIN:
                return self.main
            case Section.ROUTINES:
                return self.routines

    def steps(self) -> Iterator[Step]:
        """All steps in order, containers before what they hold."""
        for section in Section:
            yield from walk(self.section(section))

    @property
    def auto(self) -> bool:
        """Whether it starts when the controller is switched on."""
        return any(step.enabled and isinstance(step.instruction, AutoExecution) for step in self.configuration)


def walk(steps: Steps) -> Iterator[Step]:
    """Steps with what they hold, containers first."""
    for step in steps:
        yield step
        if step.body:
            yield from walk(step.body)


def with_section(program: Program, section: Section, steps: Steps) -> Program:
    """The program with one section replaced."""
    if steps is program.section(section):
        return program
    match section:
        case Section.CONFIGURATION:
            return dc.replace(program, configuration=steps)
        case Section.MAIN:
            return dc.replace(program, main=steps)
        case Section.ROUTINES:
            return dc.replace(program, routines=steps)


# ------------------------------------------------------------------------ edits


def insert(program: Program, steps: Sequence[Step], place: Place) -> Program:
    """Puts steps in at a place."""
    return _edit(program, place.parent, lambda present: (*present[: place.index], *steps, *present[place.index :]))


def remove(program: Program, ids: Collection[str]) -> Program:
    """Takes steps out, with what they hold."""
    unwanted = frozenset(ids)
    return _everywhere(program, lambda steps: _without(steps, unwanted))


def replace(program: Program, step: Step) -> Program:
    """The program with the step of that id replaced."""
    return _everywhere(program, lambda steps: _with(steps, step))


def move(program: Program, ids: Collection[str], place: Place) -> Program:
    """Moves steps, in their order in the program, to a place counted before the move; into itself nothing moves."""
    moving = frozenset(ids)
    taken = _outermost(program, moving)
    if not taken or any(step.id == place.parent for one in taken for step in walk((one,))):
        return program
    siblings = children(program, place.parent)
    before = sum(1 for step in siblings[: place.index] if step.id in moving)
    return insert(remove(program, moving), taken, Place(place.parent, place.index - before))


def _outermost(program: Program, ids: frozenset[str]) -> Steps:
    """The steps of these ids, without those that are inside another of them."""

    def among(steps: Steps) -> Iterator[Step]:
        for step in steps:
            if step.id in ids:
                yield step
            else:
                yield from among(step.body)

    return tuple(step for section in Section for step in among(program.section(section)))


def _edit(program: Program, parent: str, change: Callable[[Steps], Steps]) -> Program:
    if parent in tuple(Section):
        section = Section(parent)
        return with_section(program, section, change(program.section(section)))
    found = find(program, parent)
    return replace(program, dc.replace(found, body=change(found.body)))


def _everywhere(program: Program, change: Callable[[Steps], Steps]) -> Program:
    for section in Section:
        program = with_section(program, section, change(program.section(section)))
    return program


def _without(steps: Steps, unwanted: frozenset[str]) -> Steps:
    kept: list[Step] = []
    for step in steps:
        if step.id in unwanted:
            continue
        body = _without(step.body, unwanted) if step.body else step.body
        kept.append(step if body is step.body else dc.replace(step, body=body))
    same = len(kept) == len(steps) and all(map(_is, kept, steps))
    return steps if same else tuple(kept)


def _is(one: object, other: object) -> bool:
    return one is other


def _with(steps: Steps, wanted: Step) -> Steps:
    for place, step in enumerate(steps):
        if step.id == wanted.id:
            return (*steps[:place], wanted, *steps[place + 1 :])
        if step.body:
            body = _with(step.body, wanted)
            if body is not step.body:
                return (*steps[:place], dc.replace(step, body=body), *steps[place + 1 :])
    return steps


# ---------------------------------------------------------------------- look-up


def find(program: Program, id: str) -> Step:
    """The step of that id; KeyError when there is none."""
    for step in program.steps():
        if step.id == id:
            return step
    raise KeyError(f"there is no step {id}")


def children(program: Program, parent: str) -> Steps:
    """The steps directly in a section or a container."""
    return program.section(Section(parent)) if parent in tuple(Section) else find(program, parent).body


def place_of(program: Program, id: str) -> Place:
    """Where a step stands; KeyError when there is none."""

    def among(parent: str, steps: Steps) -> Place | None:
        for index, step in enumerate(steps):
            if step.id == id:
                return Place(parent, index)
            if step.body and (found := among(step.id, step.body)):
                return found
        return None

    for section in Section:
        if found := among(section.value, program.section(section)):
            return found
    raise KeyError(f"there is no step {id}")


def section_of(program: Program, id: str) -> Section:
    """The section a step belongs to."""
    parent = place_of(program, id).parent
    while parent not in tuple(Section):
        parent = place_of(program, parent).parent
    return Section(parent)


def fresh(program: Program, instruction: Instruction, note: str = "", body: Steps = ()) -> Step:
    """A new step with an id that the program does not use."""
    return Step(f"s{_highest(program) + 1}", instruction, note, True, body)


def renewed(program: Program, steps: Sequence[Step]) -> Steps:
    """Copies of steps with ids of their own, to be pasted."""
    next_number = _highest(program)

    def copy(step: Step) -> Step:
        nonlocal next_number
        next_number += 1
        return dc.replace(step, id=f"s{next_number}", body=tuple(copy(inner) for inner in step.body))

    return tuple(copy(step) for step in steps)


def _highest(program: Program) -> int:
    ours = [step.id[1:] for step in program.steps() if step.id[:1] == "s" and len(step.id) <= 10]
    return max([int(number) for number in ours if number.isdecimal() and number.isascii()], default=0)


# -------------------------------------------------------- where new steps belong


def place_for(
    program: Program,
    instruction: Instruction | type[Instruction],
    selected: str | None = None,
    section: Section | None = None,
) -> Place:
    """Where a new instruction goes: before the selected step if that fits, else to the end of its section.

    After "Subroutine" everything goes into that subroutine until an End closes it. `section` is the answer for
    instructions that may stand in the configuration or in the program.
    """
    kind = instruction.section
    if kind == "S":
        return Place(Section.ROUTINES, len(program.routines))
    if selected is not None:
        place = place_of(program, selected)
        inside = section_of(program, selected)
        if place.parent != Section.ROUTINES and fits(kind, inside) and section in (None, inside):
            return place
        if place.parent == Section.ROUTINES and fits(kind, inside) and section in (None, inside):
            return end_of(find(program, selected))
    if kind == "C" or section is Section.CONFIGURATION:
        return Place(Section.CONFIGURATION, len(program.configuration))
    opened = open_routine(program)
    if opened is not None and section is not Section.MAIN:
        return Place(opened, len(find(program, opened).body))
    return Place(Section.MAIN, len(program.main))


def fits(kind: str, section: Section) -> bool:
    """Whether an instruction of that kind of section may stand in `section`."""
    return "C" in kind if section is Section.CONFIGURATION else "M" in kind


def is_closed(routine: Step) -> bool:
    """Whether a subroutine ends with an End."""
    last = next((step for step in reversed(routine.body) if step.enabled), None)
    return last is not None and isinstance(last.instruction, End)


def end_of(routine: Step) -> Place:
    """The last place in a subroutine at which a step still runs: in front of the End that closes it."""
    if not is_closed(routine):
        return Place(routine.id, len(routine.body))
    last = max(index for index, step in enumerate(routine.body) if step.enabled)
    return Place(routine.id, last)


def open_routine(program: Program) -> str | None:
    """The last subroutine, when no End closes it yet."""
    last = program.routines[-1] if program.routines else None
    return last.id if last is not None and isinstance(last.instruction, Subroutine) and not is_closed(last) else None


# ------------------------------------------------------------------------ names


def labels(program: Program) -> tuple[str, ...]:
    """Labels and subroutines that a Jump can name, in their order."""
    found: dict[str, None] = {}
    for step in program.steps():
        if isinstance(step.instruction, Label | Subroutine) and step.enabled:
            found |= dict.fromkeys(jump_label(step.instruction))
    return tuple(found)


def jump_label(place: Label | Subroutine) -> tuple[str, ...]:
    """The name that a Jump can give; none of an automatic routine."""
    name = place.name if isinstance(place, Label) else place.label
    return (name,) if name and name not in SYSTEM_LABELS else ()


def variables(program: Program) -> tuple[str, ...]:
    """Variables and arrays that the program gives a value, in their order."""
    found: dict[str, None] = {}
    for step in program.steps():
        for name in assigned(step.instruction):
            found[name] = None
    return tuple(found)


def assigned(instruction: Instruction) -> tuple[str, ...]:
    """The names an instruction gives a value."""
    match instruction:
        case VariableArray(mode=Declare.VARIABLE):
            return _name(instruction.variable)
        case VariableArray(mode=Declare.ARRAY):
            return _name(instruction.array)
        case UserInterface():
            return _name(instruction.variable)
        case MathematicalEquation():
            return tuple(name for equation in instruction.equations for name in _name(equation.variable))
        case _:
            return ()


def _name(text: str) -> tuple[str, ...]:
    tree = parse_expression(text)
    return () if isinstance(tree, Bad) else names(tree)[:1]


def program_label(program: Program, taken: Collection[str] = ()) -> str:
    """The label of the program: the first 7 letters and digits of its name, in capitals, a letter first."""
    return label_for(program.name, {*labels(program), *taken})


def label_for(name: str, taken: Collection[str]) -> str:
    """The label of a program of that name, when these are taken."""
    letters = re.sub(r"[^A-Z0-9]", "", name.upper())
    label = re.sub(r"^[0-9]+", "", letters)[:7]
    used = {*taken, *SYSTEM_LABELS}
    candidates = chain((label, "MAIN"), (f"MAIN{number}" for number in count(1)))
    return next(candidate for candidate in candidates if candidate and candidate not in used)
