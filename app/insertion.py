"""Which instructions may stand where, and which steps take new ones in."""

from __future__ import annotations

from codegen.instructions import Instruction
from codegen.program import Place, Program, Section, Step, section_of


def is_there(program: Program, name: str | None) -> bool:
    """Whether the program has a step of that id."""
    return name is not None and any(step.id == name for step in program.steps())


def is_open_body(program: Program, name: str) -> bool:
    """Whether that is a step which takes new steps until it is left."""
    return any(step.id == name and takes_new_steps(step) for step in program.steps())


def takes_new_steps(step: Step) -> bool:
    """Whether new steps go into it until the user leaves it (a subroutine is closed by its End)."""
    return step.instruction.container and step.instruction.section != "S"


def refusal_of(program: Program, instruction: Instruction, place: Place) -> str:
    """Why an instruction cannot stand there: configuration, main and subroutines each take their own."""
    title, wanted = instruction.title, instruction.section
    if wanted == "S":
        return "" if place.parent == Section.ROUTINES else f"{title} belongs to Subroutines"
    if place.parent == Section.ROUTINES:
        return f"{title} belongs inside a subroutine: drop it on one"
    if _in_configuration(program, place):
        return "" if "C" in wanted else f"{title} belongs to Main or into a subroutine"
    return "" if "M" in wanted else f"{title} belongs to Configuration"


def _in_configuration(program: Program, place: Place) -> bool:
    return (
        place.parent if place.parent in tuple(Section) else section_of(program, place.parent)
    ) == Section.CONFIGURATION
