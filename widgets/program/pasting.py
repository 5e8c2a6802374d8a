"""Copied steps come in where the person is; what cannot stand there goes to the end of its own section."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from codegen.program import Place, Program, Step, insert, place_for, renewed

Refusal = Callable[[Sequence[Step], Place], str]


def put_in(
    program: Program, steps: Sequence[Step], before: str | None, place: Place | None, refused: Refusal
) -> tuple[Program, tuple[str, ...]]:
    """The program with copies of the steps, in one edit, and their ids."""
    copies = renewed(program, steps)
    for step in copies:
        fitting = place if place is not None and not refused([step], place) else None
        at = fitting or place_for(program, step.instruction, before)
        program = insert(program, [step], at)
        if fitting is not None:
            place = Place(fitting.parent, fitting.index + 1)
    return program, tuple(step.id for step in copies)
