"""The form of the selected step in a panel of its own; every change goes straight into the program."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import QLabel, QStackedWidget, QVBoxLayout, QWidget

from codegen.instructions import Instruction
from codegen.program import Step
from widgets.form.dialog import note_line
from widgets.form.form import InstructionForm
from widgets.form.offers import Offers


class Inspector(QWidget):
    """Shows one step; empty, it says what to do."""

    edited = Signal(str, object, str)  # step id, instruction, key under which changes join for undo
    noted = Signal(str, str)  # step id, the person's own comment on the step
    became_visible = Signal()
    title = "Inspector"

    def __init__(self, offers: Offers, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setAccessibleName("Inspector")
        self.step: Step | None = None
        self.heading = QLabel()
        self.heading.setProperty("role", "title")
        self.empty = QLabel("Select one step of the program to change it here.")
        self.empty.setProperty("role", "quiet")
        self.empty.setWordWrap(True)
        self.note = note_line()
        self.note.textEdited.connect(self._noted)
        self.note.hide()
        self.form = InstructionForm(offers, grows=False)
        self.form.edited.connect(self._edited)
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
        self.form.show_offers(offers)
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
