"""Repeats: the loops that the instruction of that name writes are put together again."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

from codegen.instructions import Instruction, Jump, Label, MathematicalEquation, Repeat
from codegen.instructions.flow import JumpIf, JumpKind, RepeatMode
from codegen.instructions.math import Equation
from codegen.program import Step

GENERATED = re.compile(r"R(\d+)\Z")
FALSE = re.compile(r"\((.*)\)=0\Z")


def folded(found: Sequence[Instruction]) -> list[Any]:
    """The same with every loop of a generated label as a repeat and its body."""
    items: list[Any] = []
    place = 0
    while place < len(found):
        loop = _loop(found, place)
        if loop is None:
            items.append(found[place])
            place += 1
            continue
        repeat, first, last, after = loop
        if repeat.mode is RepeatMode.COUNT:
            items.pop()  # the counter's first value, which stood before the label
        items.append((repeat, folded(found[first:last])))
        place = after
    return items


def _loop(found: Sequence[Instruction], place: int) -> tuple[Repeat, int, int, int] | None:
    """A repeat whose label stands here: it, the ends of its body, and where the program goes on."""
    label = found[place]
    match = GENERATED.match(label.name) if isinstance(label, Label) else None
    if match is None:
        return None
    assert isinstance(label, Label)
    counter, closing = f"RC{match[1]}", f"R{int(match[1]) + 1}"
    back = next((n for n in range(place + 1, len(found)) if _jumps(found[n], label.name)), None)
    if back is None:
        return None
    last = found[back]
    assert isinstance(last, Jump)
    first_value = _assigned(found[place - 1], counter) if place else None
    counted = back > place + 1 and _assigned(found[back - 1], counter) == f"{counter}-1"
    if last.when is JumpIf.CONDITION:
        if first_value and counted and last.condition == f"{counter}>0":
            return Repeat(mode=RepeatMode.COUNT, count=first_value), place + 1, back - 1, back + 1
        turned = FALSE.match(last.condition) or re.match(r"(@\w+\[.*\]|\w+)=0\Z", last.condition)
        return (Repeat(mode=RepeatMode.UNTIL, until=turned[1]), place + 1, back, back + 1) if turned else None
    closed = back + 1 < len(found) and found[back + 1] == Label(name=closing)
    entry = found[place + 1] if back > place + 1 else None
    if closed and isinstance(entry, Jump) and entry.target == closing and entry.when is JumpIf.CONDITION:
        if first_value and counted and entry.condition == f"{counter}<=0":
            return Repeat(mode=RepeatMode.COUNT, count=first_value), place + 2, back - 1, back + 2
        if turned := FALSE.match(entry.condition):
            return Repeat(mode=RepeatMode.WHILE, condition=turned[1]), place + 2, back, back + 2
    return Repeat(mode=RepeatMode.FOREVER), place + 1, back, back + 1


def _jumps(each: Instruction, label: str) -> bool:
    return (
        isinstance(each, Jump)
        and each.kind is JumpKind.GO
        and each.target == label
        and each.when in (JumpIf.ALWAYS, JumpIf.CONDITION)
    )


def _assigned(each: Instruction, name: str) -> str | None:
    """What an instruction gives a variable, when it does just that."""
    match each:
        case MathematicalEquation(equations=(Equation(variable=variable, expression=expression),)) if variable == name:
            return expression
    return None


def steps(items: Sequence[Any], ids: Any) -> tuple[Step, ...]:
    """Steps of instructions and repeats."""
    made = []
    for item in items:
        own = next(ids)
        if isinstance(item, tuple):
            made.append(Step(own, item[0], body=steps(item[1], ids)))
        else:
            made.append(Step(own, item))
    return tuple(made)
