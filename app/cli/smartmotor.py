"""`twoletter compile --controller smartmotor`: what the small emitter can write, and a sentence about the rest."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Final

from app.cli.failure import Failure
from codegen import smartmotor
from codegen.document import Document
from codegen.fields import fields_of
from codegen.instructions import Comment, Instruction, MotionParameters, SingleAxisMove, StopMotion
from codegen.instructions.motion import WaitFor, Which
from codegen.program import Section, Step
from codegen.read import problems, shown
from codegen.setup import Setup

MODEL: Final = "smartmotor"
END: Final = "END"
ONE_AXIS: Final = "dmc1412"  # whose limits every value is held to: one axis, eight million counts/s
WRITTEN: Final[Mapping[type[Instruction], tuple[str, ...]]] = {
    Comment: ("text", "in_code"),
    MotionParameters: ("speed", "acceleration"),
    SingleAxisMove: (
        *("axis", "mode", "distance", "position", "jog_speed", "speed", "acceleration", "begin"),
        *("wait", "time_out"),
    ),
    StopMotion: ("which", "axes", "wait"),
}
"""The fields that reach the code; another one has to be as it was."""


def source_of(document: Document, path: Path) -> str:
    """The program as SmartMotor source; refused with instruction and step where something is not written yet."""
    found = [line for step, where in _steps(document) for line in _lines(step, where, document.setup, path)]
    return "\n".join([*found, *([END] if END not in found[-1:] else [])]) + "\n"


def _steps(document: Document) -> Iterator[tuple[Step, str]]:
    """Every enabled step of the outer level, and where it stands; containers are among what is refused."""
    for section in Section:
        for number, step in enumerate(document.program.section(section), 1):
            if step.enabled:
                yield step, f"step {number} of the {section.value} section"


def _lines(step: Step, where: str, setup: Setup, path: Path) -> tuple[str, ...]:
    kind = type(step.instruction)
    named = f"{path}: {where}, {kind.title}"
    if reason := smartmotor.CANNOT.get(kind) or _unwritten(step.instruction):
        raise Failure(f"{named}: {reason}")
    judged = problems(step.instruction, dataclasses.replace(setup, model=ONE_AXIS))
    if errors := [each.message for each in judged if each.severity == "error"]:
        raise Failure(f"{named}: {errors[0]}")
    try:
        return smartmotor.lines(step.instruction, setup)
    except smartmotor.NotYet as unwritten:
        raise Failure(f"{named}: {unwritten}") from unwritten


def _unwritten(instruction: Instruction) -> str:
    """What is set in an instruction that the emitter would drop."""
    match instruction:
        case SingleAxisMove(begin=True, wait=WaitFor.POSITION):
            return "waiting for the position is not written for a SmartMotor yet"
        case StopMotion(which=Which.PATH):
            return "a SmartMotor has no path"
    for name, field in fields_of(instruction).items():
        as_it_was = next(each.default for each in dataclasses.fields(instruction) if each.name == name)
        value = getattr(instruction, name)
        if name not in WRITTEN[type(instruction)] and shown(instruction, name) and value != as_it_was:
            return f"{field.label} is not written for a SmartMotor yet"
    return ""
