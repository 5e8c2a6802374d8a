"""Another program, or a piece of code, as a part of this one: its names that clash get new ones, nothing is guessed."""

from __future__ import annotations

import dataclasses as dc
import re
from collections.abc import Iterator, Mapping
from typing import Any, Literal

from codegen.document import Document
from codegen.expressions import KEYWORDS
from codegen.fields import (
    SYSTEM_LABELS,
    Code,
    Condition,
    ExpressionField,
    Field,
    InputNumber,
    LabelName,
    ListOf,
    Number,
    OutputNumber,
    PerAxis,
    Quantity,
    VariableName,
    fields_of,
)
from codegen.instructions import AutoExecution, Instruction, Label, LoopRate, Subroutine, TwoLetterCode
from codegen.program import Place, Program, Section, Step, Steps, assigned, insert, program_label, renewed
from codegen.read import axes_of
from codegen.setup import Setup
from codegen.twoletter.nodes import Command, Dimension, Element, Span, Target, Variable
from codegen.twoletter.nodes import Label as LabelNode
from codegen.twoletter.parse import parse_line

Kind = Literal["label", "variable"]
LONGEST: dict[Kind, int] = {"label": 7, "variable": 8}
NAME = re.compile(r'"[^"]*"|(?<![\w@#$.])([A-Za-z][A-Za-z0-9]{0,7})(?![\w.])', re.ASCII)  # or a text, which stays
WITH_NAMES = Quantity | Number | Condition | ExpressionField | VariableName


@dc.dataclass(frozen=True, slots=True)
class Rename:
    """A name that both programs use, and what the imported one becomes."""

    kind: Kind
    name: str
    new: str


@dc.dataclass(frozen=True, slots=True)
class Plan:
    """What an import does, before it is done; `cannot` says why it is not possible at all."""

    document: Document
    renames: tuple[Rename, ...] = ()
    left_out: tuple[str, ...] = ()
    cannot: str = ""


def plan(host: Document, module: Document) -> Plan:
    """How a module comes into a program."""
    if reason := _cannot(host, module):
        return Plan(module, cannot=reason)
    steps, left_out = _fitting(host, module.program)
    module = dc.replace(module, program=_numbered(steps, module.setup, host.setup))
    theirs, ours = names_of(module.program), names_of(host.program)
    taken: dict[Kind, set[str]] = {
        "label": {*ours.labels, program_label(host.program), *SYSTEM_LABELS, *theirs.labels},
        "variable": {*ours.variables, *theirs.variables, *KEYWORDS},
    }
    renames: list[Rename] = []
    defined: tuple[tuple[Kind, set[str], list[str]], ...] = (
        ("label", {*ours.labels, program_label(host.program)}, theirs.labels),
        ("variable", set(ours.variables), theirs.assigned),
    )
    for kind, known, names in defined:
        for name in names:
            if name in known:
                new = _free(name, kind, taken[kind], host.setup)
                taken[kind].add(new)
                renames.append(Rename(kind, name, new))
    return Plan(module, tuple(renames), left_out)


def imported(
    host: Document, made: Plan, place: Place, shared: frozenset[str] = frozenset()
) -> tuple[Document, tuple[str, ...]]:
    """The program with the module in it, its main steps at a place, and the ids of what is new; `shared`: variables
    that are one and the same in both."""
    words: dict[Kind, dict[str, str]] = {"label": {}, "variable": {}}
    for each in made.renames:
        if each.kind == "label" or each.name not in shared:
            words[each.kind][each.name] = each.new
    program, ids = host.program, []
    for section in Section:
        steps = renewed(program, tuple(_renamed(step, words) for step in made.document.program.section(section)))
        at = place if section is Section.MAIN else Place(section, len(program.section(section)))
        program = insert(program, steps, at)
        ids += [step.id for step in steps]
    return dc.replace(host, program=program), tuple(ids)


# --------------------------------------------------------------------- names


@dc.dataclass(frozen=True, slots=True)
class Names:
    """Labels a program defines, variables it gives a value, and all variables that stand in it."""

    labels: list[str]
    assigned: list[str]
    variables: list[str]


def names_of(program: Program) -> Names:
    """The names of a program, in their order, each once."""
    labels: dict[str, None] = {}
    given: dict[str, None] = {}
    used: dict[str, None] = {}
    for step in program.steps():
        instruction = step.instruction
        if isinstance(instruction, Label | Subroutine):
            labels[instruction.name if isinstance(instruction, Label) else instruction.label] = None
        given.update(dict.fromkeys(assigned(instruction)))
        used.update(dict.fromkeys(_used(instruction)))
        if isinstance(instruction, TwoLetterCode):
            for kind, name, _, sets in _in_code(instruction.text):
                if kind == "variable":
                    used[name] = None
                    if sets:
                        given[name] = None
                elif sets:
                    labels[name] = None
    for name in (*SYSTEM_LABELS, ""):
        labels.pop(name, None)
    return Names(list(labels), list(given), list({**given, **used}))


def _used(item: Any) -> Iterator[str]:
    for name, field in fields_of(item).items():
        value = getattr(item, name)
        if isinstance(field, ListOf):
            for row in value:
                yield from _used(row)
        elif isinstance(field, WITH_NAMES):
            yield from filter(None, NAME.findall(value))
        elif isinstance(field, PerAxis):
            for text in value:
                yield from filter(None, NAME.findall(text))


def _in_code(text: str) -> Iterator[tuple[Kind, str, tuple[int, Span], bool]]:
    """Names in two-letter code: kind, name, line and place, whether it is defined there."""
    for number, line in enumerate(text.split("\n")):
        for statement in parse_line(line).statements:
            for node, sets in _walk(statement, False):
                if isinstance(node, LabelNode):
                    yield "label", node.name, (number, node.span), True
                elif isinstance(node, Target) and node.label:
                    yield "label", node.label, (number, node.span), False
                elif isinstance(node, Variable | Element | Dimension) and node.name not in ("*", ""):
                    yield "variable", node.name, (number, node.span), sets


def _walk(node: Any, sets: bool) -> Iterator[tuple[Any, bool]]:
    """Every node below, and whether it is given a value there."""
    yield node, sets
    for field in dc.fields(node):
        value = getattr(node, field.name)
        below = value if isinstance(value, tuple) else (value,)
        for each in below:
            if dc.is_dataclass(each) and not isinstance(each, type | Span):
                given = field.name == "target" or isinstance(each, Dimension)
                given = given or (
                    isinstance(node, Command) and node.name in ("IN", "RA") and isinstance(each, Variable)
                )
                yield from _walk(each, given)


def _free(name: str, kind: Kind, taken: set[str], setup: Setup) -> str:
    """The name with the first number behind it that nobody uses."""
    number = 2
    while True:
        tail = str(number)
        new = name.rstrip("0123456789")[: LONGEST[kind] - len(tail)] + tail
        if new not in taken and not (len(new) == 2 and setup.is_command(new)):
            return new
        number += 1


# ------------------------------------------------------------------ renaming


def _renamed(step: Step, words: Mapping[Kind, Mapping[str, str]]) -> Step:
    instruction = _item(step.instruction, words)
    return dc.replace(step, instruction=instruction, body=tuple(_renamed(each, words) for each in step.body))


def _item(item: Any, words: Mapping[Kind, Mapping[str, str]]) -> Any:
    new: dict[str, Any] = {}
    for name, field in fields_of(item).items():
        value = getattr(item, name)
        made = _value(field, value, words)
        if made != value:
            new[name] = made
    return dc.replace(item, **new) if new else item


def _value(field: Field, value: Any, words: Mapping[Kind, Mapping[str, str]]) -> Any:
    variables = words["variable"]
    match field:
        case ListOf():
            return tuple(_item(row, words) for row in value)
        case LabelName():
            return words["label"].get(value, value)
        case Code():
            return _code(value, words)
        case Quantity() | Number() | ExpressionField() | VariableName():
            return NAME.sub(lambda found: variables.get(found[1], found[0]), value)
        case PerAxis():
            return tuple(NAME.sub(lambda found: variables.get(found[1], found[0]), text) for text in value)
        case _:
            return value


def _code(text: str, words: Mapping[Kind, Mapping[str, str]]) -> str:
    """Code with its names exchanged at the places where the parser found them, from the last to the first."""
    lines = text.split("\n")
    found = [(place, words[kind][name], name) for kind, name, place, _ in _in_code(text) if name in words[kind]]
    for (number, span), new, name in sorted(found, key=lambda each: (each[0][0], each[0][1].start), reverse=True):
        start = lines[number].index(name, span.start)
        lines[number] = lines[number][:start] + new + lines[number][start + len(name) :]
    return "\n".join(lines)


# ---------------------------------------------------------------- what fits


def _cannot(host: Document, module: Document) -> str:
    """Numbers are never read in another unit, and nothing may jump to a line that is another one here."""
    for step in module.program.steps():
        for letter in axes_of(step.instruction):
            ours, theirs = host.setup.axis(letter), module.setup.axis(letter)
            if ours.symbol != theirs.symbol:
                return (
                    f"Its axis {letter} is in {theirs.symbol}, here it is in {ours.symbol}: the numbers would mean "
                    "something else. Give both the same unit in the setup first"
                )
    for step in module.program.steps():
        if isinstance(step.instruction, TwoLetterCode) and (line := _jumps_to_line(step.instruction.text)):
            return f"It jumps to a line number ({line}), which is another line here. Give that line a label first"
    return ""


def _jumps_to_line(text: str) -> str:
    for line in text.split("\n"):
        for statement in parse_line(line).statements:
            if any(isinstance(node, Target) and node.line is not None for node, _ in _walk(statement, False)):
                return line.strip()
    return ""


def _fitting(host: Document, program: Program) -> tuple[Program, tuple[str, ...]]:
    """The module without what a program has once."""
    left_out: list[str] = []
    once = (AutoExecution, LoopRate)
    kept = tuple(step for step in program.configuration if not isinstance(step.instruction, once))
    left_out += [step.instruction.title for step in program.configuration if isinstance(step.instruction, once)]
    automatic = {label for step in host.program.routines if (label := _automatic(step.instruction))}
    routines = []
    for step in program.routines:
        label = _automatic(step.instruction)
        if label in automatic:
            left_out.append(f"#{label} is kept, commented out: this program has its own")
            step = dc.replace(step, enabled=False)
        routines.append(step)
    return dc.replace(program, configuration=kept, routines=tuple(routines)), tuple(left_out)


def _automatic(instruction: Instruction) -> str:
    label = instruction.label if isinstance(instruction, Subroutine) else ""
    return label if label in SYSTEM_LABELS else ""


def _numbered(program: Program, theirs: Setup, ours: Setup) -> Program:
    """Inputs and outputs that are called by a name of the other setup get their number."""

    def item(each: Any) -> Any:
        new: dict[str, Any] = {}
        for name, field in fields_of(each).items():
            value = getattr(each, name)
            if isinstance(field, ListOf):
                new[name] = tuple(item(row) for row in value)
            elif isinstance(field, InputNumber) and theirs.input_number(value) != ours.input_number(value):
                new[name] = str(theirs.input_number(value) or value)
            elif isinstance(field, OutputNumber) and theirs.output_number(value) != ours.output_number(value):
                new[name] = str(theirs.output_number(value) or value)
        return dc.replace(each, **new) if new else each

    def each_of(steps: Steps) -> Steps:
        return tuple(dc.replace(step, instruction=item(step.instruction), body=each_of(step.body)) for step in steps)

    return dc.replace(
        program,
        configuration=each_of(program.configuration),
        main=each_of(program.main),
        routines=each_of(program.routines),
    )
