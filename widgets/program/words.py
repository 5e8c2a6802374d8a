"""What a row of the program says: English, code, problems; read from the document and its listing."""

from __future__ import annotations

from codegen import read
from codegen.document import Document
from codegen.generate import Listing
from codegen.program import Step


class Words:
    """The words of the document on show; asked for visible rows only."""

    def __init__(self) -> None:
        self.document: Document | None = None
        self.listing: Listing | None = None
        self.problems: dict[str, list[str]] = {}
        self.errors: set[str] = set()

    def show(self, document: Document, listing: Listing) -> None:
        """Speaks of `document` from now on."""
        self.document, self.listing = document, listing
        self.problems, self.errors = {}, set()
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

    def code(self, step: Step) -> str:
        """The step's own lines of code on one line."""
        return "; ".join(self.code_lines(step))

    def code_lines(self, step: Step) -> list[str]:
        """The lines the step stands for in the whole program, without those of its body."""
        listing = self.listing
        if listing is None or not step.enabled:
            return []
        lines = [listing.lines[number] for number in listing.lines_of(step.id)]
        return [line.text for line in lines if line.step == step.id]

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
