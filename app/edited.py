"""A document that is worked on: its history, where new steps go, and every change a person can make."""

from __future__ import annotations

import dataclasses as dc
import time
from collections.abc import Callable, Collection, Sequence

from PySide6.QtCore import QObject, Signal

from app.insertion import is_open_body, is_there, refusal_of, takes_new_steps
from codegen import files
from codegen.document import Document
from codegen.generate import Listing, generate
from codegen.history import History
from codegen.instructions import Instruction
from codegen.program import (
    Place,
    Program,
    Section,
    Step,
    find,
    fresh,
    insert,
    move,
    place_for,
    place_of,
    remove,
    renewed,
    replace,
)
from codegen.setup import Setup


class Edited(QObject):
    """Owns the document and its history; says what changed. It knows nothing of files."""

    document_changed = Signal(object, object)  # old Document, new Document
    history_changed = Signal()
    insertion_changed = Signal()

    def __init__(
        self, document: Document, clock: Callable[[], float] = time.monotonic, parent: QObject | None = None
    ) -> None:
        super().__init__(parent)
        self._clock = clock
        self.history = History(document)
        self._listing: tuple[Document, Listing] | None = None
        self.open_body: str | None = None  # the repeat that new steps go into
        self.before: str | None = None  # the step that new steps go in front of

    @property
    def document(self) -> Document:
        return self.history.present

    @property
    def listing(self) -> Listing:
        """The code of the document; made once for each document."""
        if self._listing is None or self._listing[0] is not self.document:
            self._listing = (self.document, generate(self.document))
        return self._listing[1]

    # ---- editing

    def insert(
        self,
        instructions: Sequence[Instruction],
        before: str | None = None,
        section: Section | None = None,
        note: str = "",
    ) -> tuple[str, ...]:
        """Adds new steps where new steps go, or in front of a step; gives their ids."""
        program = self.document.program
        ids: list[str] = []
        at: Place | None = None
        for instruction in instructions:
            step = fresh(program, instruction, note=note)
            at = Place(at.parent, at.index + 1) if at is not None else self.next_place(instruction, before, section)
            program = insert(program, [step], at)
            ids.append(step.id)
        self._push_program(program, "Add " + _titles(instructions))
        self._follow_insertion(ids)
        return tuple(ids)

    def insert_at(self, instruction: Instruction, place: Place, note: str = "") -> str:
        """Adds one new step at a place of the tree."""
        step = fresh(self.document.program, instruction, note=note)
        self._push_program(insert(self.document.program, [step], place), f"Add {instruction.title}")
        self._follow_insertion([step.id])
        return step.id

    def replace(self, step_id: str, instruction: Instruction, key: str | None = None, note: str | None = None) -> None:
        """Gives a step another instruction; changes with the same key shortly after another are undone as one."""
        step = find(self.document.program, step_id)
        new = dc.replace(step, instruction=instruction, note=step.note if note is None else note)
        if new != step:
            self._push_program(replace(self.document.program, new), f"Change {instruction.title}", key)

    def set_note(self, step_id: str, note: str) -> None:
        """The person's own comment on a step."""
        step = find(self.document.program, step_id)
        self._push_program(
            replace(self.document.program, dc.replace(step, note=note)), "Change note", f"note {step_id}"
        )

    def remove(self, ids: Collection[str]) -> None:
        """Takes steps out, with everything inside them."""
        if ids:
            label = f"Delete {self._words_for(ids)}"
            self._push_program(remove(self.document.program, ids), label)

    def move(self, ids: Collection[str], place: Place) -> None:
        """Puts steps elsewhere, also into and out of repeats; `place` is counted before the move."""
        self._push_program(move(self.document.program, ids, place), f"Move {self._words_for(ids)}")

    def comment_out(self, ids: Sequence[str]) -> None:
        """Steps that emit nothing for the time being; when all of them are already, brings them back."""
        steps = [find(self.document.program, name) for name in ids]
        on = not any(step.enabled for step in steps)
        program = self.document.program
        for step in steps:
            if step.enabled != on:
                program = replace(program, dc.replace(find(program, step.id), enabled=on))
        self._push_program(program, f"{'Bring back' if on else 'Comment out'} {self._words_for(ids)}")

    def copy(self, ids: Sequence[str]) -> str:
        """Steps as text for the clipboard."""
        return files.steps_to_text([find(self.document.program, name) for name in ids])

    def paste(self, text: str, before: str | None = None, place: Place | None = None) -> tuple[str, ...]:
        """Adds steps from text, with ids of their own; none when the text holds none."""
        program = self.document.program
        steps = renewed(program, files.steps_from_text(text))
        if not steps:
            return ()
        at = place or self.next_place(steps[0].instruction, before, None)
        self._push_program(insert(program, steps, at), f"Paste {_count(len(steps))}")
        return tuple(step.id for step in steps)

    def set_program(self, *, name: str | None = None, description: str | None = None) -> None:
        """Name and description."""
        program = self.document.program
        new = dc.replace(
            program,
            name=program.name if name is None else name,
            description=program.description if description is None else description,
        )
        self._push_program(new, "Rename program" if name is not None else "Change description", "title")

    def set_setup(self, setup: Setup, label: str = "Change setup") -> None:
        """The machine's configuration."""
        self.set_document(dc.replace(self.document, setup=setup), label)

    def set_document(self, document: Document, label: str, key: str | None = None) -> None:
        """Any other change, as one step of the history."""
        if document is not self.document and document != self.document:
            old = self.document
            self.history = self.history.push(document, label, key=key, now=self._clock())
            self._changed(old)

    # ---- where new steps go

    def next_place(self, instruction: Instruction, before: str | None = None, section: Section | None = None) -> Place:
        """Where a new step goes: before the chosen one, into the open repeat, or after the last of its section."""
        program = self.document.program
        ahead = before if before is not None else self.before
        if ahead is None and self.open_body is not None and section != Section.CONFIGURATION:
            place = Place(self.open_body, len(find(program, self.open_body).body))
            if not refusal_of(program, instruction, place):
                return place
        return place_for(program, instruction, ahead, section)

    def refusal(self, steps: Sequence[Step], place: Place) -> str:
        """Why steps cannot stand at a place of the tree; empty when they can."""
        return next(
            (reason for step in steps if (reason := refusal_of(self.document.program, step.instruction, place))), ""
        )

    def insert_before(self, step_id: str | None) -> None:
        """New steps go in front of this one; None: back to the end."""
        self.before = step_id
        self.insertion_changed.emit()

    def leave_body(self) -> None:
        """New steps go behind the open repeat again."""
        if self.open_body is None:
            return
        parent = place_of(self.document.program, self.open_body).parent
        self.open_body = parent if is_open_body(self.document.program, parent) else None
        self.insertion_changed.emit()

    def _follow_insertion(self, ids: Sequence[str]) -> None:
        last = find(self.document.program, ids[-1])
        if takes_new_steps(last):
            self.open_body, self.before = last.id, None
        elif last.instruction.container:  # a subroutine: it takes the next steps until its End
            self.open_body = self.before = None
        self.insertion_changed.emit()

    # ---- history

    @property
    def can_undo(self) -> bool:
        return self.history.can_undo

    @property
    def can_redo(self) -> bool:
        return self.history.can_redo

    @property
    def undo_text(self) -> str:
        return self.history.undo_label if self.can_undo else ""

    @property
    def redo_text(self) -> str:
        return self.history.redo_label if self.can_redo else ""

    def undo(self) -> None:
        """Takes the last change back."""
        if self.can_undo:
            self._travel(self.history.undo())

    def redo(self) -> None:
        """Makes the change again that was taken back."""
        if self.can_redo:
            self._travel(self.history.redo())

    # ---- inside

    def _push_program(self, program: Program, label: str, key: str | None = None) -> None:
        if program is not self.document.program:
            self.set_document(dc.replace(self.document, program=program), label, key)

    def _travel(self, history: History) -> None:
        old, self.history = self.document, history
        self._changed(old)

    def _changed(self, old: Document) -> None:
        moved = self._keep_insertion_valid()
        self.document_changed.emit(old, self.document)
        if moved:  # after the document: who shows the place asks for its steps
            self.insertion_changed.emit()
        self.history_changed.emit()

    def _keep_insertion_valid(self) -> bool:
        """Forgets places that are gone; whether there was one."""
        program = self.document.program
        before = (self.open_body, self.before)
        self.open_body = self.open_body if is_there(program, self.open_body) else None
        self.before = self.before if is_there(program, self.before) else None
        return before != (self.open_body, self.before)

    def _words_for(self, ids: Collection[str]) -> str:
        names = list(ids)
        return find(self.document.program, names[0]).instruction.title if len(names) == 1 else _count(len(names))


def _titles(instructions: Sequence[Instruction]) -> str:
    return instructions[0].title if len(instructions) == 1 else _count(len(instructions))


def _count(number: int) -> str:
    return f"{number} step" if number == 1 else f"{number} steps"
