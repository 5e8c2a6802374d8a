"""From a document to two-letter code, with the step of every line.

What each stretch of steps becomes is kept (`stretch`, a memo on frozen steps and setup); what is done anew at each
edit is only the last pass: it numbers generated labels, compares labels with jumps, and joins the lines.
"""

from __future__ import annotations

import dataclasses as dc
from fractions import Fraction
from itertools import accumulate

from codegen.compiled import NOTHING, Compiled, code, compiled
from codegen.conversion import CALIBRATED_US
from codegen.document import Document
from codegen.drift import MANY, judged, repeated, turns
from codegen.fields import SYSTEM_LABELS
from codegen.handover import first_line
from codegen.instructions import LoopRate, Repeat, Subroutine
from codegen.laps import Course, Item, courses, loops
from codegen.packing import Line, Piece, Places, filled, frame, packed, parted, places_of, stacked
from codegen.program import Program, Step, Steps, label_for
from codegen.setup import Finding, never_set_up, setup_problems
from codegen.stretch import Found, Run, Stretch, closed, opened, runs, stands_alone, stretch
from codegen.twoletter.calls import Call

__all__ = ["Line", "Listing", "code", "compiled", "generate"]


@dc.dataclass(frozen=True)
class Listing:
    """The code of a program, its source map, and what stands in its way."""

    lines: tuple[Line, ...]
    problems: tuple[Finding, ...] = ()
    places: tuple[tuple[int, Places], ...] | None = dc.field(default=None, compare=False, repr=False)

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
        places = self.places if self.places is not None else ((0, places_of(self.lines)),)
        return tuple([start + line for start, known in places for line in known.get(step, ())])


@dc.dataclass(slots=True)
class _Part:
    """A stretch at its place in the program."""

    made: Stretch
    piece: Piece
    sharing: _Part | None = None  # whose numbers it has; None: its own
    numbers: tuple[str, ...] = ()
    more: list[Found] = dc.field(default_factory=list)  # what is wrong because of other stretches

    def findings(self) -> list[Finding]:
        """In the order of the steps."""
        found = self.made.findings
        if self.more:
            found = sorted([*found, *self.more], key=lambda each: each[0])
        return [finding for _, finding in found]


@dc.dataclass(frozen=True, slots=True)
class _Loop:
    """What repeats: it is judged when all subroutines are known."""

    part: _Part
    at: int
    step: str
    words: str
    turn: Course
    count: Fraction


Items = list[tuple[Item, _Part]]


class _Pass:
    """The last pass: goes through the stretches of a program."""

    def __init__(self, document: Document) -> None:
        self.program, self.handover = document.program, document.handover
        self.setup = document.working_setup
        self.parts: list[_Part] = []
        self.loops: list[_Loop] = []
        self.routines: dict[str, Course] = {}
        self.label = ""
        self.defined: set[str] = set()
        self.number = 0

    # ---- the stretches

    def gather(self) -> None:
        """All of them in the order of the code; where each of the three sections ends."""
        self.level(self.program.configuration, True)
        self.level(self.program.main, False)
        self.put(Stretch(), frame("EN"))
        for routine in self.program.routines:
            if not routine.enabled:
                self.put(stretch(Run((routine,), self.setup), False))
                continue
            body = self.holder(routine, False)
            self.put(closed(Run((routine,), self.setup)))
            if isinstance(routine.instruction, Subroutine):
                self.routines[routine.instruction.label] = courses([item for item, _ in body])
        self.label = label_for(self.program.name, {label for part in self.parts for label in part.made.labels})
        self.judge_loops()
        self.compare_labels()
        self.find_unscaled()

    def put(self, made: Stretch, piece: Piece | None = None, sharing: _Part | None = None) -> _Part:
        part = _Part(made, piece or made.piece, sharing)
        self.parts.append(part)
        return part

    def level(self, steps: Steps, configuration: bool) -> Items:
        """Steps of one holder; gives how they move the axes."""
        items: Items = []
        for run in runs(steps):
            if stands_alone(run):
                (step,) = run
                body = courses([item for item, _ in self.holder(step, configuration)])
                if isinstance(step.instruction, Repeat):
                    items.append((repeated(step.instruction, body), self.parts[-1]))
                continue
            part = self.put(stretch(Run(run, self.setup), configuration))
            items += [(item, part) for item in part.made.items]
        for mark, part, turn in loops(items):
            self.loops.append(_Loop(part, mark.at, mark.step, "This loop", turn, MANY))
        return items

    def holder(self, step: Step, configuration: bool) -> Items:
        """A step with what it holds."""
        made, closing = opened(Run((step,), self.setup), configuration)
        head = self.put(made)
        body = self.level(step.body, configuration)
        if isinstance(step.instruction, Repeat):
            turn = courses([item for item, _ in body])
            self.loops.append(_Loop(head, 0, step.id, "This repeat", turn, turns(step.instruction)))
        if closing.lines:
            self.put(Stretch(), closing, head)
        return body

    # ---- what the stretches say of each other

    def judge_loops(self) -> None:
        for loop in self.loops:
            if text := judged(loop.words, loop.turn, self.setup, loop.count, self.routines):
                loop.part.more.append((loop.at, Finding("", text, "warning", "", loop.step, "drift")))

    def compare_labels(self) -> None:
        """Labels that are there twice."""
        defined = {self.label}
        for part in self.parts:
            for at, label, step in part.made.defines:
                if label in defined:
                    part.more.append(
                        (at, Finding("name", f"The label {label} is used twice", "error", "", step, "duplicate-label"))
                    )
                defined.add(label)
        self.defined = defined

    def find_unscaled(self) -> None:
        """The first step that needs the scale of an axis that has none."""
        told: set[str] = set()
        for part in self.parts:
            for at, letter, step in part.made.unscaled:
                if letter not in told:
                    told.add(letter)
                    part.more.append(
                        (at, Finding("", never_set_up(self.setup, letter), "warning", letter, step, "axis-not-set-up"))
                    )

    # ---- the lines

    def pieces(self) -> list[Piece]:
        """All lines in their order."""
        taken = {name for part in self.parts for name in part.made.taken}
        found = self.begin()
        arrays = list(dict.fromkeys(name for part in self.parts for name in part.made.arrays))
        for part in self.parts:
            if part.piece.marked:
                part.numbers = part.sharing.numbers if part.sharing else self.give(part.made.numbers, taken)
                part.piece = filled(part.piece, part.numbers)
            if arrays and part.made.arrays:
                found += self.free(arrays, part)
                arrays = []
            else:
                found.append(part.piece)
        return found

    def begin(self) -> list[Piece]:
        """The lines in front of the first step."""
        stamp = first_line(self.handover, self.program.name, self.setup.limits)
        texts = (stamp, "#AUTO" if self.program.auto else "", f"#{self.label}", *self.loop_rate().before)
        return [frame(*[text for text in texts if text])]

    def loop_rate(self) -> Compiled:
        """The loop rate of the setup, which everything is converted for, unless the program sets its own."""
        if self.setup.sample == CALIBRATED_US or _own_rate(self.program):
            return NOTHING
        return compiled(LoopRate(period=self.setup.sample_us), self.setup)

    def give(self, count: int, taken: set[str]) -> tuple[str, ...]:
        """Numbers that make names unique."""
        given: list[str] = []
        while len(given) < count:
            self.number += 1
            if f"R{self.number}" not in taken and f"RC{self.number}" not in taken:
                given.append(str(self.number))
        return tuple(given)

    def free(self, arrays: list[str], part: _Part) -> list[Piece]:
        """Frees the program's own arrays before the first is made, so that it can be run again."""
        limit = self.setup.limits.columns
        before, behind = parted(part.piece, part.made.first_array)
        calls: list[str] = []
        for name in arrays:
            if calls and len(calls[-1]) + len(name) + 3 <= limit:
                calls[-1] += f",{name}[]"
            else:
                calls.append(Call("DA", f"{name}[]").text)
        return [before, frame(*calls, step=behind.lines[0].step), behind]

    def problems(self) -> list[Finding]:
        """Of the machine, of the steps in their order, and jumps that lead nowhere."""
        found = [finding for finding in setup_problems(self.setup) if finding.severity == "error"]
        found += self.loop_rate().errors
        for part in self.parts:
            if part.more or part.made.findings:
                found += part.findings()
        for part in self.parts:
            for label, step in part.made.targets:
                if label not in self.defined and label not in SYSTEM_LABELS:
                    found.append(Finding("target", f"There is no label {label}", "error", "", step, "missing-label"))
        return found


def _own_rate(program: Program) -> bool:
    return any(step.enabled and isinstance(step.instruction, LoopRate) for step in program.configuration)


def generate(document: Document) -> Listing:
    """The code of a program; compact when it is asked for or when the program is too long otherwise."""
    work = _Pass(document)
    work.gather()
    limits = work.setup.limits
    pieces, problems = work.pieces(), work.problems()
    stacks = stacked(pieces)
    if document.compact or sum(len(stack.lines) for stack in stacks) > limits.lines:
        stacks = packed(pieces, limits.columns)
    lines = tuple([line for stack in stacks for line in stack.lines])
    if len(lines) > limits.lines:
        text = f"The program has {len(lines)} lines; the controller takes {limits.lines}"
        problems.append(Finding("", text, rule="too-many-lines"))
    starts = accumulate((len(stack.lines) for stack in stacks), initial=0)
    return Listing(lines, tuple(problems), tuple(zip(starts, (stack.places for stack in stacks), strict=False)))
