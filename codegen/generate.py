"""From a document to two-letter code, with the step of every line.

The result of each instruction is kept (`compiled`, a memo on the frozen instruction and setup); what is done
anew at each edit is only the last pass: it numbers generated labels and joins the lines.
"""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Iterator
from functools import lru_cache
from typing import Any, NamedTuple

from codegen.compiled import Compiled, code, compiled, numbered
from codegen.conversion import CALIBRATED_US
from codegen.document import Document
from codegen.drift import Sums, closes_a_loop, drift, jump_drift
from codegen.fields import SYSTEM_LABELS, Choice, fields_of
from codegen.handover import first_line
from codegen.instructions import End, Jump, LoopRate, Subroutine, TwoLetterCode
from codegen.instructions.flow import EndOf, Routine
from codegen.program import Program, Section, Step, is_closed, program_label
from codegen.setup import Finding, never_set_up, setup_problems
from codegen.twoletter.calls import Call
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


__all__ = ["Line", "Listing", "code", "compiled", "generate"]


class Line(NamedTuple):
    """One line of code; `step` is the step it comes from ("" = the frame of the program).

    `problem` tells why a step could not be turned into code (then the line is a remark). `parts` are the
    lines that share this one in compact code.
    """

    text: str
    step: str = ""
    problem: str = ""
    parts: tuple[Any, ...] = ()

    @property
    def spans(self) -> tuple[tuple[int, int, str], ...]:
        """Where several statements share the line: (first column, column after it, step) of each."""
        found: list[tuple[int, int, str]] = []
        start = 0
        for part in self.parts:
            found.append((start, start + len(part.text), part.step))
            start += len(part.text) + 1
        return tuple(found)


@dc.dataclass(frozen=True)
class Listing:
    """The code of a program, its source map, and what stands in its way."""

    lines: tuple[Line, ...]
    problems: tuple[Finding, ...] = ()

    @property
    def text(self) -> str:
        """The code as it is sent, one line each."""
        return "\n".join(line.text for line in self.lines)

    @property
    def is_complete(self) -> bool:
        """Whether every step became code, so that the listing may be sent."""
        return not any(finding.severity == "error" for finding in self.problems)

    def step_of(self, line: int, column: int = 0) -> str:
        """The step a place in the code comes from ("" = the frame, or no such line); both count from 0."""
        if not 0 <= line < len(self.lines):
            return ""
        for start, end, step in self.lines[line].spans:
            if start <= column < end:
                return step
        return self.lines[line].step

    def lines_of(self, step: str) -> tuple[int, ...]:
        """The lines that come from a step, from 0."""
        return tuple(
            number
            for number, line in enumerate(self.lines)
            if line.step == step or any(part.step == step for part in line.parts)
        )


class _Pass:
    """The last pass: walks the steps, numbers what is generated, and collects lines and problems."""

    def __init__(self, document: Document) -> None:
        self.program, self.handover = document.program, document.handover
        self.setup = document.working_setup
        self.lines: list[Line] = []
        self.problems: list[Finding] = []
        self.defined: dict[str, str] = {}
        self.jumps: list[tuple[str, str]] = []
        self.arrays: list[str] = []
        self.first_array = -1
        self.made: dict[int, Compiled] = {}
        self.raw_labels: list[str] = []
        self.unscaled = ""
        self.taken = self.names_taken()
        self.number = 0

    def names_taken(self) -> set[str]:
        """Every label and variable of the person, so that generated ones differ; compiles all steps on the way."""
        taken: set[str] = set()
        made_of, setup = self.made, self.setup
        for step in self.program.steps():
            made = made_of[id(step)] = compiled(step.instruction, setup)
            if made.defines:
                taken.update(made.defines)
                if type(step.instruction) is TwoLetterCode:
                    self.raw_labels += made.defines
            if made.names:
                taken.update(made.names)
        return taken

    def next_number(self) -> str:
        self.number += 1
        while f"R{self.number}" in self.taken or f"RC{self.number}" in self.taken:
            self.number += 1
        return str(self.number)

    def run(self) -> None:
        self.problems += [finding for finding in setup_problems(self.setup) if finding.severity == "error"]
        label = program_label(self.program, self.raw_labels)
        if stamp := first_line(self.handover, self.program.name, self.setup.limits):
            self.lines.append(Line(stamp))
        if self.program.auto:
            self.lines.append(Line("#AUTO"))
        self.lines.append(Line(f"#{label}"))
        self.defined[label] = ""
        self.loop_rate()
        self.walk(self.program.configuration, Section.CONFIGURATION)
        self.walk(self.program.main, Section.MAIN)
        self.lines.append(Line("EN"))
        for routine in self.program.routines:
            self.routine(routine)
        self.free_arrays()
        self.check_jumps()

    def loop_rate(self) -> None:
        """The loop rate of the setup, which everything is converted for, unless the program sets its own."""
        if self.setup.sample == CALIBRATED_US or _own_rate(self.program):
            return
        made = compiled(LoopRate(period=self.setup.sample_us), self.setup)
        self.problems += made.errors
        self.lines += [Line(text) for text in made.before]

    def walk(self, steps: tuple[Step, ...], section: Section) -> None:
        sums: Sums | None = None
        for number, step in enumerate(steps):
            if not step.enabled:
                continue
            self.step(step, section)
            if type(step.instruction) is Jump and closes_a_loop(step.instruction):
                sums = sums or Sums(steps, self.setup)
                if text := jump_drift(sums, number, self.setup):
                    self.problems.append(Finding("", text, "warning", "", step.id))

    def step(self, step: Step, section: Section) -> None:
        made = self.made[id(step)]
        if made.noteworthy:
            self.remember(step, made, section)
        numbers = [self.next_number() for _ in range(made.numbers)] if made.numbers else None
        if step.body and (text := drift(step, self.setup)):
            self.problems.append(Finding("", text, "warning", "", step.id))
        self.add(made.before, step.id, numbers)
        if step.body:
            self.walk(step.body, section)
        if made.after:
            self.add(made.after, step.id, numbers)

    def add(self, texts: tuple[str, ...], step: str, numbers: list[str] | None = None) -> None:
        if numbers is None:
            self.lines += _lines(texts, step)
        else:
            self.lines += [Line(numbered(text, numbers), step) for text in texts]

    def remember(self, step: Step, made: Compiled, section: Section) -> None:
        """Problems, labels, jumps and arrays of a step."""
        if made.errors or made.warnings:
            self.problems += [
                Finding(finding.field, finding.message, finding.severity, finding.axis, step.id)
                for finding in (*made.errors, *made.warnings)
            ]
        if made.errors:
            problem = made.errors[0].message
            self.lines.append(Line(f"' {problem}", step.id, problem))
        for letter in made.unscaled:
            if letter not in self.unscaled:
                self.unscaled += letter
                self.problems.append(Finding("", never_set_up(self.setup, letter), "warning", letter, step.id))
        for label in made.defines:
            if label in self.defined:
                self.problems.append(Finding("name", f"The label {label} is used twice", "error", "", step.id))
            self.defined.setdefault(label, step.id)
        if made.target:
            self.jumps.append((made.target, step.id))
        if made.arrays:
            if self.first_array < 0:
                self.first_array = len(self.lines)
            self.arrays += made.arrays
        if isinstance(step.instruction, TwoLetterCode) and _sets_loop_rate(step.instruction):
            text = "The loop rate set here does not rescale the other instructions; use Loop Rate"
            self.problems.append(Finding("text", text, "warning", "", step.id))
        if section is not Section.CONFIGURATION and isinstance(step.instruction, LoopRate):
            text = "Loop Rate belongs to the configuration: speeds and waits of the whole program depend on it"
            self.problems.append(Finding("", text, "error", "", step.id))

    def routine(self, routine: Step) -> None:
        """A subroutine from its label to its end; the right end is added where none closes it."""
        if not routine.enabled:
            return
        self.step(routine, Section.ROUTINES)
        if not isinstance(routine.instruction, Subroutine):
            self.problems.append(Finding("", "This step stands outside a subroutine", "error", "", routine.id))
            return
        wanted = END_OF[routine.instruction.routine]
        if not is_closed(routine):
            self.add(compiled(End(of=wanted), self.setup).before, routine.id)
            self.problems.append(
                Finding("", "This subroutine is not closed yet: add an End", "warning", "", routine.id)
            )
        for step in routine.body:
            end = step.instruction
            if step.enabled and isinstance(end, End) and end.of is not wanted:
                text = f"{routine.instruction.label} needs the end of {_words(wanted)}"
                self.problems.append(Finding("of", text, "error", "", step.id))

    def free_arrays(self) -> None:
        """Frees the program's own arrays before the first is made, so that it can be run again."""
        if not self.arrays:
            return
        limit = self.setup.limits.columns
        step = self.lines[self.first_array].step
        calls: list[str] = []
        for name in dict.fromkeys(self.arrays):
            if calls and len(calls[-1]) + len(name) + 3 <= limit:
                calls[-1] += f",{name}[]"
            else:
                calls.append(Call("DA", f"{name}[]").text)
        self.lines[self.first_array : self.first_array] = [Line(text, step) for text in calls]

    def check_jumps(self) -> None:
        for label, step in self.jumps:
            if label not in self.defined and label not in SYSTEM_LABELS:
                self.problems.append(Finding("target", f"There is no label {label}", "error", "", step))


@lru_cache(maxsize=32768)
def _lines(texts: tuple[str, ...], step: str) -> tuple[Line, ...]:
    """The lines of a step; the same ones as at the last edit."""
    return tuple([Line(text, step) for text in texts])


def _own_rate(program: Program) -> bool:
    return any(step.enabled and isinstance(step.instruction, LoopRate) for step in program.configuration)


def _sets_loop_rate(code: TwoLetterCode) -> bool:
    return any(isinstance(node, Command) and node.name == "TM" for _, node in parse(code.text).statements())


def _words(end: EndOf) -> str:
    field = fields_of(End)["of"]
    assert isinstance(field, Choice)
    return field.words[end]


def generate(document: Document) -> Listing:
    """The code of a program; compact when it is asked for or when the program is too long otherwise."""
    work = _Pass(document)
    work.run()
    limits = work.setup.limits
    lines = work.lines
    if document.compact or len(lines) > limits.lines:
        lines = list(joined_lines(lines, limits.columns))
    if len(lines) > limits.lines:
        text = f"The program has {len(lines)} lines; the controller takes {limits.lines}"
        work.problems.append(Finding("", text))
    return Listing(tuple(lines), tuple(work.problems))


def joined_lines(lines: list[Line], columns: int) -> Iterator[Line]:
    """Statements joined with `;` as far as a line goes; a label starts a line, a remark has one of its own."""
    group: list[Line] = []
    length = 0
    for line in lines:
        text = line.text
        starts = text[:1] in STARTING and (text[0] in "#'" or text[:2] == "NO" or text[:3] == "REM")
        if group and (starts or length + 1 + len(text) > columns):
            yield _joined(group)
            group, length = [], 0
        length += len(text) + (1 if group else 0)
        group.append(line)
        if starts and text[0] != "#":
            yield _joined(group)
            group, length = [], 0
    if group:
        yield _joined(group)


STARTING = frozenset("#'NR")


def _joined(group: list[Line]) -> Line:
    return group[0] if len(group) == 1 else Line(";".join([line[0] for line in group]), group[0][1], "", tuple(group))
