"""What one instruction becomes in two-letter code: the memo of the generator."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Sequence
from functools import lru_cache

from codegen.drift import cut
from codegen.instructions import Execute, Instruction, Jump, Label, LoopRate, Subroutine, TwoLetterCode
from codegen.numbers import parse_number
from codegen.program import assigned
from codegen.read import axes_of, needed, problems
from codegen.setup import Finding, Setup
from codegen.twoletter.calls import BODY, Call
from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.emit import statements
from codegen.twoletter.emit.build import FIRST_NUMBER, Build
from codegen.twoletter.fixed import scaled
from codegen.twoletter.nodes import Label as LabelNode
from codegen.twoletter.parse import parse
from codegen.twoletter.rows import Takes


@dc.dataclass(frozen=True, slots=True)
class Compiled:
    """What one instruction became: lines before and after the steps it holds, and what the program must know."""

    before: tuple[str, ...]
    after: tuple[str, ...]
    numbers: int  # how many unique numbers it needs
    defines: tuple[str, ...]  # labels
    target: str  # the label it jumps to
    arrays: tuple[str, ...]  # arrays it dimensions
    names: tuple[str, ...]  # variables it gives a value
    errors: tuple[Finding, ...]
    warnings: tuple[Finding, ...]
    unscaled: str  # axes it needs whose scale was never set up
    noteworthy: bool  # whether the last pass has more to do than to add the lines


NOTHING = Compiled((), (), 0, (), "", (), (), (), (), "", False)


def compiled(instruction: Instruction, setup: Setup) -> Compiled:
    """Everything about one instruction that does not depend on its place."""
    made: Compiled | None = instruction.recall("_compiled", setup)
    if made is None:
        made = _compiled(instruction, needed(instruction, setup))
        instruction.remember("_compiled", setup, made)
    return made


@lru_cache(maxsize=32768)
def _compiled(instruction: Instruction, setup: Setup) -> Compiled:
    found = problems(instruction, setup)
    errors = tuple(finding for finding in found if finding.severity == "error")
    warnings = tuple(finding for finding in found if finding.severity != "error")
    if advice := cut(instruction):
        warnings += (Finding("distance", advice, "warning", rule="rounded-down"),)
    defines, target = _labels(instruction)
    if errors:
        return Compiled((), (), 0, defines, target, (), (), errors, warnings, "", True)
    build = Build(setup)
    made = statements(instruction, build)
    texts = [statement.text for statement in made]
    limit = setup.limits.columns
    long = next((text for text in texts if len(text) > limit), None)
    if long is not None:
        message = f"This becomes a line of {len(long)} characters; the controller takes {limit}"
        errors = (Finding("", message, rule="line-too-long"),)
    elif refusal := next(filter(None, (refused(each, setup) for each in made if isinstance(each, Call))), None):
        errors = (Finding("", refusal, rule="not-on-model"),)
    if errors:
        return Compiled((), (), 0, defines, target, (), (), errors, warnings, "", True)
    unscaled = "".join(letter for letter in axes_of(instruction) if not setup.axis(letter).is_set_up)
    split = made.index(BODY) if BODY in made else len(made)
    arrays = tuple(each.arguments.split("[")[0] for each in made if isinstance(each, Call) and each.name == "DM")
    return Compiled(
        tuple(texts[:split]),
        tuple(texts[split + 1 :]),
        build.given,
        defines,
        target,
        arrays,
        assigned(instruction),
        errors,
        warnings,
        unscaled,
        bool(
            errors
            or warnings
            or unscaled
            or defines
            or target
            or arrays
            or isinstance(instruction, LoopRate | TwoLetterCode)
        ),
    )


def refused(call: Call, setup: Setup) -> str | None:
    """Why this controller model cannot take a call that is right in itself."""
    row, limits = COMMANDS[call.name], setup.limits
    if not row.known_to(limits):
        return f"The {limits.title} has no {row.title.lower()} ({call.name})"
    if row.takes is Takes.AXES_S and call.arguments == "S" and not limits.coordinated:
        return f"The {limits.title} has no coordinated motion"
    if row.takes is not Takes.NUMBERS or row.fields:
        return None
    value = parse_number(call.arguments)
    if value is None or row.accepts(scaled(value), limits):
        return None
    low, high = row.range_for(limits)
    return f"{row.title} must lie between {low:g} and {high:g} on the {limits.title}"


def _labels(instruction: Instruction) -> tuple[tuple[str, ...], str]:
    """Labels an instruction defines, and the one it jumps to."""
    match instruction:
        case Label():
            return (instruction.name,), ""
        case Subroutine():
            return (instruction.label,), ""
        case Jump():
            return (), instruction.target
        case Execute():
            return (), instruction.label
        case TwoLetterCode():
            found = parse(instruction.text).statements()
            return tuple(node.name for _, node in found if isinstance(node, LabelNode)), ""
        case _:
            return (), ""


def code(instruction: Instruction, setup: Setup) -> tuple[str, ...]:
    """The lines an instruction alone would add ("View Code"); none while it has problems."""
    made = compiled(instruction, setup)
    if made.errors:
        return ()
    numbers = [str(number + 1) for number in range(made.numbers)]
    return tuple(numbered(text, numbers) for text in (*made.before, *made.after))


def numbered(text: str, numbers: Sequence[str]) -> str:
    if text.isascii():
        return text
    for place, number in enumerate(numbers):
        text = text.replace(chr(FIRST_NUMBER + place), number)
    return text
