"""The open instruction dialogs of one program window."""

from __future__ import annotations

import dataclasses as dc
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal
from PySide6.QtWidgets import QWidget

from codegen.instructions import Instruction
from codegen.program import Place, Section, find, open_routine, place_of, section_of
from codegen.read import cannot, sentence
from widgets.form.dialog import InstructionDialog
from widgets.form.offers import Offers, offers_of
from widgets.program.node import TITLES

if TYPE_CHECKING:
    from widgets.program.editing import Editing


class Dialogs(QObject):
    """Opens dialogs beside each other; none of them blocks anything."""

    said = Signal(str)
    help_requested = Signal(str)

    def __init__(self, view: QWidget, session: Editing) -> None:
        super().__init__(view)
        self.view, self.session = view, session
        self.open: list[InstructionDialog] = []

    def add(
        self, kind: type[Instruction], *, before: str | None = None, place: Place | None = None
    ) -> InstructionDialog:
        """The dialog of a new step."""
        where = self._where(kind, before, place)
        place_of_it = place or self.session.next_place(kind(), before)
        dialog = self._show(kind(), new=True, where=where, section=self._section(before), place=place_of_it)
        dialog.added.connect(
            lambda instruction, section, stay: self._added(instruction, section, before, place, dialog.note.text())
        )
        return dialog

    def add_possible(self, kind: type[Instruction]) -> None:
        """The same, unless the setup's controller does not know the instruction: then the reason is said."""
        reason = cannot(kind, self.session.document.working_setup)
        if reason:
            self.said.emit(reason)
        else:
            self.add(kind)

    def modify(self, step_id: str) -> InstructionDialog:
        """The dialog of a step that is there; a second call brings the open one to the front."""
        for dialog in self.open:
            if dialog.property("step") == step_id:
                dialog.raise_()
                dialog.activateWindow()
                return dialog
        program = self.session.document.program
        step = find(program, step_id)
        dialog = self._show(step.instruction, new=False, where="", note=step.note, place=place_of(program, step_id))
        dialog.setProperty("step", step_id)
        dialog.changed.connect(lambda instruction: self._changed(step_id, instruction, dialog.note.text()))
        return dialog

    def show_offers(self, offers: Offers) -> None:
        """Labels, variables and units as they are now; dialogs of steps that are gone close."""
        there = {step.id for step in self.session.document.program.steps()} if self.open else set()
        for dialog in list(self.open):
            step_id = dialog.property("step")
            if step_id and step_id not in there:
                dialog.reject()
            else:
                dialog.show_offers(self._offers(dialog, offers))

    def _offers(self, dialog: InstructionDialog, offers: Offers) -> Offers:
        """The same at the place of its step; of a new one, what was known when it was opened."""
        step_id, document = dialog.property("step"), self.session.document
        if not step_id:
            return dc.replace(offers, standing=dialog.form.offers.standing)
        return offers_of(document, offers.live, place_of(document.program, step_id))

    def _mirror(self, letter: str) -> None:
        """Pictures show an axis the other way round: a setting of the machine."""
        document = self.session.document
        axis = document.setup.axis(letter)
        setup = document.setup.with_axis(letter, dc.replace(axis, mirrored=not axis.mirrored))
        self.session.set_document(dc.replace(document, setup=setup), f"Turn {letter} in pictures")
        self.said.emit(f"{letter} points the other way in pictures; angles are those of the picture.")

    # ---- inside

    def _show(
        self, instruction: Instruction, *, new: bool, where: str, place: Place, section: str = "", note: str = ""
    ) -> InstructionDialog:
        offers = offers_of(self.session.document, getattr(self.view, "live", None), place)
        window = self.view.window()
        dialog = InstructionDialog(
            instruction, offers, new=new, where=where, section=section, note=note, parent=window, at_once=False
        )
        self.open.append(dialog)
        dialog.finished.connect(lambda _: self.open.remove(dialog))
        dialog.help_requested.connect(self.help_requested)
        dialog.mirror_wanted.connect(self._mirror)
        dialog.show_when_made()
        return dialog

    def _added(
        self, instruction: Instruction, section: str, before: str | None, place: Place | None, note: str
    ) -> None:
        if place is not None:
            step_id = self.session.insert_at(instruction, place, note)
        else:
            inside = Section.CONFIGURATION if section == "configuration" else None  # else Main or the open subroutine
            (step_id,) = self.session.insert([instruction], before, inside, note)
        self.view.reveal_step(step_id)  # type: ignore[attr-defined]
        self.said.emit(f"Added: {instruction.title}")

    def _changed(self, step_id: str, instruction: Instruction, note: str) -> None:
        self.session.replace(step_id, instruction, note=note)
        self.said.emit(f"Changed: {instruction.title}")

    def _section(self, before: str | None) -> str:
        """Configuration, when the step to insert before stands there; else what is usual."""
        ahead = before or self.session.before
        if ahead is None:
            return ""
        inside = section_of(self.session.document.program, ahead)
        return "configuration" if inside is Section.CONFIGURATION else "main"

    def _where(self, kind: type[Instruction], before: str | None, place: Place | None) -> str:
        if before or self.session.before:
            return "before the selected step"
        if place is not None:
            return ""
        if self.session.open_body is not None and kind.section not in ("C", "S"):
            return "inside the repeat"
        program = self.session.document.program
        routine = open_routine(program)
        if routine is not None and "M" in kind.section:
            return f"into {sentence(find(program, routine).instruction, self.session.document.working_setup)}"
        return {"C": f"to {TITLES['configuration']}", "S": f"to {TITLES['routines']}"}.get(kind.section, "")
