"""Where a program's parts go: its name, configuration, main program, subroutines."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Sequence

from codegen.fields import SYSTEM_LABELS
from codegen.instructions import (
    AutoExecution,
    Comment,
    End,
    Instruction,
    Jump,
    Label,
    Subroutine,
    TwoLetterCode,
)
from codegen.instructions.flow import EndOf, JumpKind, Routine
from codegen.program import Program, Step, program_label
from codegen.stretch import END_OF
from codegen.twoletter.lift.loops import folded, steps

AUTO = "AUTO"
PLAIN_END = End(of=EndOf.SUBROUTINE)


@dataclasses.dataclass(frozen=True, slots=True)
class Way:
    """How boldly the parts of a source are put in their places; the result is proved, else a plainer way is taken."""

    arrays: bool = True  # DM as instructions, with the DA in front of them left to the generator
    loops: bool = True
    routines: bool = True
    named: bool = False  # the source tells its name, of which its label is only the beginning


WAYS = (
    Way(),
    Way(loops=False),
    Way(arrays=False),
    Way(arrays=False, loops=False),
    Way(arrays=False, loops=False, routines=False),
)


def frame(found: list[Instruction], name: str, way: Way) -> Program:
    """The program of a source's instructions."""
    auto = bool(found) and found[0] == Label(name=AUTO)
    found = found[1:] if auto else found
    title, found = _titled(found, name, way)
    main, routines = _split(found) if way.routines else (found, [])
    if main and main[-1] == PLAIN_END:
        main = main[:-1]  # the frame writes it
    leading = _configuring(main)
    ids = (f"s{number}" for number in range(1, 1_000_000))
    first = (Step(next(ids), AutoExecution()),) if auto else ()
    return Program(
        name=title,
        configuration=(*first, *steps([as_code(each) for each in main[:leading]], ids)),
        main=steps(_folded(main[leading:], way), ids),
        routines=tuple(_routine(each, way, ids) for each in routines),
    )


def _titled(found: list[Instruction], name: str, way: Way) -> tuple[str, list[Instruction]]:
    """The name of the program: its first label where nothing jumps there, else the file's."""
    first = found[0] if found else None
    own = first.name if isinstance(first, Label) else ""
    if own and not any(own in _targets(each) for each in found):
        for title in (name, own) if way.named else (own,):
            if program_label(Program(name=title)) == own:
                return title, found[1:]
    taken = {each.name for each in found if isinstance(each, Label)}
    title = name
    for number in range(1, 1000):
        if program_label(Program(name=title)) not in taken:
            return title, found
        title = f"{name[:4]}{number}"
    return name, found


def _targets(each: Instruction) -> tuple[str, ...]:
    """The labels an instruction leads to; code by hand may name any."""
    if isinstance(each, TwoLetterCode):
        return tuple(part.split(",")[0].split(";")[0].strip() for part in each.text.split("#")[1:])
    return tuple(getattr(each, name) for name in ("target", "label") if getattr(each, name, ""))


def _configuring(main: Sequence[Instruction]) -> int:
    """How many steps at the beginning belong to the configuration."""
    count = 0
    while count < len(main) and "C" in main[count].section and not isinstance(main[count], TwoLetterCode):
        count += 1
    return count if not all(isinstance(each, Comment) for each in main[:count]) else 0


def _split(found: list[Instruction]) -> tuple[list[Instruction], list[list[Instruction]]]:
    """Main steps and subroutines: what is called or automatic, at the end of the source, each with its end."""
    called = {each.target for each in found if isinstance(each, Jump) and each.kind is JumpKind.CALL}
    called |= set(SYSTEM_LABELS) - {AUTO}
    starts = [place for place, each in enumerate(found) if isinstance(each, Label) and each.name in called]
    for first in range(len(starts)):
        ends = [*starts[first + 1 :], len(found)]
        parts = [found[start:end] for start, end in zip(starts[first:], ends, strict=True)]
        if all(_is_routine(part) for part in parts) and starts[first] > 0:
            return found[: starts[first]], parts
    return found, []


def _is_routine(part: Sequence[Instruction]) -> bool:
    """A label, steps, and at the end the right End."""
    label, last = part[0], part[-1]
    assert isinstance(label, Label)
    return isinstance(last, End) and last.of is END_OF[_routine_of(label).routine]


def _routine_of(label: Label) -> Subroutine:
    """The beginning of a routine: the system's or the user's own."""
    known = {each.value: each for each in Routine}
    return Subroutine(routine=known[label.name]) if label.name in known else Subroutine(name=label.name)


def _routine(part: list[Instruction], way: Way, ids: Iterator[str]) -> Step:
    label = part[0]
    assert isinstance(label, Label)
    start = _routine_of(label)
    wanted = END_OF[start.routine]
    own = next(ids)
    body = [_end_as_code(each) if isinstance(each, End) and each.of is not wanted else each for each in part[1:]]
    return Step(own, start, body=steps(_folded(body, way), ids))


def _end_as_code(end: End) -> Instruction:
    """The end of another kind of routine, which the source has there for its own reasons."""
    name = {EndOf.ERROR: "RE", EndOf.INPUT: "RI"}.get(end.of, "EN")
    numbers = f"{int(end.keep)},{int(end.restore)}" if end.of is EndOf.COMMUNICATION else f"{int(end.keep)}"
    return TwoLetterCode(text=name if end.of is EndOf.SUBROUTINE else f"{name} {numbers}")


def _folded(found: Sequence[Instruction], way: Way) -> list[object]:
    ready = [as_code(each) for each in found]
    return list(folded(ready)) if way.loops else list(ready)


def as_code(instruction: Instruction) -> Instruction:
    """A label of the system's own that stands by itself stays code."""
    if isinstance(instruction, Label) and instruction.name in SYSTEM_LABELS:
        return TwoLetterCode(text=f"#{instruction.name}")
    return instruction
