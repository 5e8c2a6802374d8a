"""Steps that go somewhere: copied, pasted, duplicated, deleted, moved with keys, dragged here from near and far."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Sequence
from typing import TYPE_CHECKING

from PySide6.QtCore import QMimeData, QObject, Qt, Signal

from codegen import files, read
from codegen.instructions import ALL, TwoLetterCode
from codegen.program import Place, Step, find, place_for, place_of
from widgets.program import clipboard
from widgets.program.model import NEW_MIME, STEPS_MIME, ProgramModel
from widgets.program.node import TITLES
from widgets.program.pasting import put_in
from widgets.program.places import neighbour
from widgets.program.tree import ProgramTree
from widgets.program.words import Words

if TYPE_CHECKING:
    from widgets.program.editing import Editing


class Arranging(QObject):
    """Asks whether the steps can stand there, changes the document, and selects them in their new place."""

    said = Signal(str)
    new_wanted = Signal(object, object)  # kind of instruction, Place

    def __init__(self, session: Editing, model: ProgramModel, tree: ProgramTree, words: Words) -> None:
        super().__init__(tree)
        self.session, self.model, self.tree, self.words = session, model, tree, words
        tree.refusal = self._refusal_of
        queued = Qt.ConnectionType.QueuedConnection  # the drag is over first
        tree.moved.connect(self.move_to, queued)
        tree.pasted.connect(self._drop_text, queued)
        tree.taken.connect(self._drop_new, queued)

    def step(self, step_id: str) -> Step:
        """A step of the document."""
        return find(self.session.document.program, step_id)

    def shift(self, by: int) -> None:
        """One place up or down, into and out of open blocks, as far as the section goes."""
        ids = self.tree.chosen()
        if not ids:
            return
        steps = [self.step(step_id) for step_id in ids]
        place = neighbour(self.model.nodes, ids, by, lambda place: self.session.refusal(steps, place))
        if place is None:
            section = TITLES[self.model.nodes[ids[0]].section_name()]
            self.said.emit(f"This is {'the first' if by < 0 else 'the last'} place in {section}")
        else:
            self.move_to(ids, place)

    def copy(self) -> None:
        """The chosen steps onto the clipboard: as steps, and as plain code for other programs."""
        ids = self.tree.chosen()
        if ids:
            plain = "\n".join(self.words.plain(self.step(step_id)) for step_id in ids)
            clipboard.put(ids, self.session.copy(ids), plain)

    def paste_clipboard(self) -> None:
        """Steps as steps; text from elsewhere as 2-Letter Code."""
        kind, text = clipboard.take()
        before = self.tree.current() if self.tree.chosen() else None
        if kind == "steps":
            self.paste(text, before=before)
        elif kind == "code":
            self.tree.choose(self.session.insert([TwoLetterCode(text=text)], before, None))

    def delete(self) -> None:
        """The chosen steps go; the focus stays where they were."""
        ids = self.tree.chosen()
        if ids:
            after = self._after(ids[-1])
            self.session.remove(ids)
            if self.model.index_of(after).isValid():
                self.tree.choose([after])
            self.said.emit("Deleted. Ctrl+Z brings it back.")

    def _after(self, step_id: str) -> str:
        """The row behind a step and all it holds."""
        node = self.model.nodes[step_id]
        line = node.line + sum(1 for _ in node.unfolded())
        return self.model.rows[line].id if node.line >= 0 and line < len(self.model.rows) else ""

    def paste(self, text: str, before: str | None = None, place: Place | None = None) -> None:
        document, steps = self.session.document, files.steps_from_text(text)
        if not steps:
            self.said.emit("There are no steps to paste")
            return
        if place is None:
            place = self.session.next_place(steps[0].instruction, before)
        program, ids = put_in(document.program, steps, before, place, self.session.refusal)
        counted = "1 step" if len(ids) == 1 else f"{len(ids)} steps"
        self.session.set_document(dc.replace(document, program=program), f"Paste {counted}")
        self.tree.choose(ids)

    def move_to(self, ids: Sequence[str], place: Place | None) -> None:
        """Steps to another place; None: to the end of the section they belong to."""
        steps = [self.step(step_id) for step_id in ids]
        place = place or place_for(self.session.document.program, steps[0].instruction)
        reason = self._cannot_stand(steps, place)
        if reason:
            self.said.emit(reason)
        else:
            self.session.move(ids, place)
            self.tree.choose(ids)

    def duplicate(self) -> None:
        """The chosen steps again, behind themselves."""
        ids = self.tree.chosen()
        if ids:
            last = place_of(self.session.document.program, ids[-1])
            self.paste(self.session.copy(ids), place=Place(last.parent, last.index + 1))

    def _cannot_stand(self, steps: Sequence[Step], place: Place) -> str:
        """Why steps cannot go to a place; empty when they can."""
        node = self.model.nodes[place.parent]
        inside = {node.id, *(above.id for above in node.above())}
        if any(step.id in inside for step in steps):
            return "A step cannot go into itself"
        return self.session.refusal(steps, place)

    def _drop_text(self, text: str, place: Place | None) -> None:
        steps = files.steps_from_text(text)
        reason = self.session.refusal(steps, place) if place is not None else ""
        if reason:
            self.said.emit(reason)
        else:
            self.paste(text, place=place)

    def _drop_new(self, title: str, place: Place | None) -> None:
        kind = next(each for each in ALL if each.title == title)
        reason = read.cannot(kind, self.session.document.working_setup)
        if place is not None:
            reason = reason or self.session.refusal([Step("", kind())], place)
        if reason:
            self.said.emit(reason)
        else:
            self.new_wanted.emit(kind, place)

    def _refusal_of(self, data: QMimeData, place: Place) -> str:
        """Why what is being dragged cannot be dropped at a place."""
        if data.hasFormat(NEW_MIME):
            title = bytes(data.data(NEW_MIME).data()).decode()
            kind = next(each for each in ALL if each.title == title)
            return self.session.refusal([Step("", kind())], place)
        names, _, text = bytes(data.data(STEPS_MIME).data()).decode().partition("\f")
        if not self.model.owns(data):
            return self.session.refusal(files.steps_from_text(text), place)
        there = [self.model.nodes[name].step for name in names.split("\n") if name in self.model.nodes]
        return self._cannot_stand([step for step in there if step is not None], place)
