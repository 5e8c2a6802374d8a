"""Another word in what a person typed: names, numbers, expressions, code and notes; never in generated wording."""

from __future__ import annotations

import dataclasses as dc
import re
from collections.abc import Collection
from enum import Enum
from typing import Any

from codegen.program import Program, Step, Steps
from codegen.read import has_errors
from codegen.setup import Setup


@dc.dataclass(frozen=True, slots=True)
class Replaced:
    """The program afterwards, the steps that are new, and those that were left because they would be wrong."""

    program: Program
    changed: tuple[str, ...]
    refused: tuple[str, ...]


def pattern_of(text: str, *, words: bool, case: bool) -> re.Pattern[str]:
    """What is searched: the text itself, or only where it stands alone ("5" is not found in "50" or "2.5")."""
    escaped = re.escape(text)
    alone = rf"(?<![\w.]){escaped}(?!\w|\.\d)"
    return re.compile(alone if words else escaped, 0 if case else re.IGNORECASE)


def replaced(
    program: Program, setup: Setup, pattern: re.Pattern[str], by: str, ids: Collection[str] | None = None
) -> Replaced:
    """Puts `by` wherever the pattern stands in typed texts, in all steps or in those given."""
    changed: list[str] = []
    refused: list[str] = []

    def each(steps: Steps) -> Steps:
        made = tuple(one(step) for step in steps)
        return steps if all(new is old for new, old in zip(made, steps, strict=True)) else made

    def one(step: Step) -> Step:
        body = each(step.body)
        new = step if body is step.body else dc.replace(step, body=body)
        if ids is not None and step.id not in ids:
            return new
        instruction, note = _in(step.instruction, pattern, by), pattern.sub(lambda _: by, step.note)
        if instruction == step.instruction and note == step.note:
            return new
        if has_errors(instruction, setup) and not has_errors(step.instruction, setup):
            refused.append(step.id)
            return new
        changed.append(step.id)
        return dc.replace(new, instruction=instruction, note=note)

    configuration, main, routines = each(program.configuration), each(program.main), each(program.routines)
    if changed:
        program = dc.replace(program, configuration=configuration, main=main, routines=routines)
    return Replaced(program, tuple(changed), tuple(refused))


def _in(value: Any, pattern: re.Pattern[str], by: str) -> Any:
    """The same value with the texts in it replaced; choices and switches are not typed."""
    if isinstance(value, Enum | bool):
        return value
    if isinstance(value, str):
        return pattern.sub(lambda _: by, value)
    if isinstance(value, tuple):
        return tuple(_in(each, pattern, by) for each in value)
    if dc.is_dataclass(value) and not isinstance(value, type):
        parts = {field.name: getattr(value, field.name) for field in dc.fields(value)}
        made = {name: _in(part, pattern, by) for name, part in parts.items()}
        return dc.replace(value, **made) if made != parts else value
    return value
