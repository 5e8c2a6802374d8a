"""What a row of the program says: English, code, problems; read from the document and its listing."""

from __future__ import annotations

from codegen import read
from codegen.document import Document
from codegen.generate import Line, Listing
from codegen.program import Step


class Words:
    """The words of the document on show; asked for visible rows only."""

    def __init__(self) -> None:
        self.document: Document | None = None
        self.listing: Listing | None = None
        self.problems: dict[str, list[str]] = {}
        self.errors: set[str] = set()
        self._codes: dict[str, str] = {}  # of steps that were asked for since the listing is another one

    def show(self, document: Document, listing: Listing) -> None:
        """Speaks of `document` from now on."""
        self.document, self.listing = document, listing
        self.problems, self.errors, self._codes = {}, set(), {}
        for problem in listing.problems:
            self.problems.setdefault(problem.step, []).append(problem.message)
            if problem.severity == "error":
                self.errors.add(problem.step)

    def english(self, step: Step) -> str:
        """The sentence; a leading ' when the step is commented out."""
        if self.document is None:
            return ""
        sentence = read.sentence(step.instruction, self.document.working_setup)
        return sentence if step.enabled else f"' {sentence}"

    def sentence_of(self, step_id: str) -> str:
        """The sentence of a step by its id; nothing when the program does not have it."""
        steps = self.document.program.steps() if self.document is not None else ()
        return next((self.english(step) for step in steps if step.id == step_id), "")

    def lines_of(self, step_id: str) -> tuple[int, ...]:
        """The lines of code a step stands for, without those of its body."""
        return self.listing.lines_of(step_id) if self.listing is not None else ()

    def code(self, step: Step) -> str:
        """The step's own lines of code on one line."""
        known = self._codes.get(step.id)
        if known is None:
            known = self._codes[step.id] = "; ".join(self.code_lines(step))
        return known

    def code_lines(self, step: Step) -> list[str]:
        """The text of those lines; of a line that holds several steps, the step's part."""
        if self.listing is None:
            return []
        lines = [self.listing.lines[number] for number in self.lines_of(step.id)]
        return [_part(line, step.id) for line in lines if not line.problem]

    def plain(self, step: Step) -> str:
        """For other programs: the step's lines of code, or its sentence when it has none."""
        return "\n".join(self.code_lines(step)) or self.english(step)

    def problem_lines(self) -> dict[int, str]:
        """The first problem of each line of code that has one."""
        return {
            line: messages[0] for step, messages in self.problems.items() if step for line in self.lines_of(step)[:1]
        }

    def problem(self, step: Step) -> str:
        """The first problem of a step, or nothing."""
        return self.problems.get(step.id, [""])[0]

    def tip(self, step: Step) -> str:
        """All of it: sentence, note, problems, code."""
        parts = [self.english(step), step.note, *self.problems.get(step.id, []), "\n".join(self.code_lines(step))]
        return "\n\n".join(part for part in parts if part)

    def spoken(self, step: Step) -> str:
        """For a screen reader: the sentence, whether it is commented out, and its problem."""
        problem = self.problem(step)
        off = "" if step.enabled else "Commented out: "
        return off + self.english(step).removeprefix("' ") + (f". Problem: {problem}" if problem else "")

    def holds_steps(self, step: Step) -> bool:
        """Whether steps can stand inside this one."""
        return step.instruction.container


def _part(line: Line, step_id: str) -> str:
    parts = [line.text[start:end] for start, end, step in line.spans if step == step_id]
    return ";".join(parts) if parts else line.text
