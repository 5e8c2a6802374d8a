"""The form of the selected step in a panel of its own; every change goes straight into the program."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import QLabel, QLineEdit, QStackedWidget, QVBoxLayout, QWidget

from codegen.instructions import Instruction
from codegen.program import Step
from widgets.form.form import InstructionForm
from widgets.form.offers import Offers
from widgets.parts.look import look


class Inspector(QWidget):
    """Shows one step; empty, it says what to do."""

    edited = Signal(str, object, str)  # step id, instruction, key under which changes join for undo
    noted = Signal(str, str)  # step id, the person's own comment on the step
    became_visible = Signal()
    title = "Inspector"

    def __init__(self, offers: Offers, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setAccessibleName("Inspector")
        self.offers = offers
        self.step: Step | None = None
        self.heading = QLabel()
        self.heading.setProperty("role", "title")
        self.empty = QLabel("Select one step of the program to change it here.")
        self.empty.setProperty("role", "quiet")
        self.empty.setWordWrap(True)
        self.note = QLineEdit()
        self.note.setPlaceholderText("Note: why this step is here")
        self.note.setAccessibleName("Note")
        self.note.setMinimumHeight(look().control)
        self.note.textEdited.connect(self._noted)
        self.note.hide()
        self.form = self._new_form()
        self.stack = QStackedWidget()
        self.stack.addWidget(self.empty)
        self.stack.addWidget(self.form)
        self.empty.setAlignment(Qt.AlignmentFlag.AlignTop)
        self.setMinimumWidth(280)
        column = QVBoxLayout(self)
        column.addWidget(self.heading)
        column.addWidget(self.note)
        column.addWidget(self.stack, 1)
        self.heading.hide()

    def show_nothing(self) -> None:
        """The hint, while no step (or more than one) is selected."""
        self.step = None
        self.heading.hide()
        self.note.hide()
        self.stack.setCurrentWidget(self.empty)

    def showEvent(self, event: QShowEvent) -> None:
        """While hidden it follows nothing; shown again it asks for the selected step."""
        super().showEvent(event)
        self.became_visible.emit()

    def show_step(self, step: Step, offers: Offers) -> None:
        """Shows `step`."""
        if offers.setup != self.offers.setup:
            self._rebuild(offers)
        self.offers = offers
        self.form.offers = self.form.fields.offers = offers
        self.step = step
        self.heading.show()
        self.note.show()
        if self.note.text() != step.note:
            self.note.setText(step.note)
        self.stack.setCurrentWidget(self.form)
        self.heading.setText(step.instruction.title)
        if step.instruction != self.form.fields.item or type(step.instruction) is not type(self.form.fields.item):
            self.form.show_instruction(step.instruction)

    def _noted(self, text: str) -> None:
        if self.step is not None:
            self.noted.emit(self.step.id, text)

    def _edited(self, instruction: Instruction) -> None:
        if self.step is not None:
            self.edited.emit(self.step.id, instruction, f"inspector {self.step.id}")

    def _new_form(self) -> InstructionForm:
        form = InstructionForm(self.offers, grows=False)
        form.edited.connect(self._edited)
        return form

    def _rebuild(self, offers: Offers) -> None:
        """Other axes or units: the form is built anew."""
        self.offers = offers
        old, self.form = self.form, self._new_form()
        self.stack.addWidget(self.form)
        self.stack.removeWidget(old)
        old.deleteLater()
