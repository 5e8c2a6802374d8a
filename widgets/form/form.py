"""An instruction as a form: its fields, a live picture where there is one, the sentence and the code it will add."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QScrollArea, QSizePolicy, QVBoxLayout, QWidget

from codegen import read
from codegen.generate import code, compiled
from codegen.instructions import Instruction
from widgets.form.cell import focus_in
from widgets.form.command_list import CommandList
from widgets.form.fields_form import FieldsForm
from widgets.form.offers import Offers
from widgets.form.pictures import PICTURES
from widgets.form.preview import Preview

HIGHEST, WIDEST = 460, 860  # pixels a dialog may ask for its fields: fits 1280 x 800
SPARE = 24  # one line of text


class InstructionForm(QWidget):
    """Emits the edited instruction; `problem` says why it is not right yet."""

    edited = Signal(object)

    def __init__(self, offers: Offers, *, grows: bool = True, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.offers = offers
        self.grows = grows  # whether the window is to make room for all fields
        self.fields = FieldsForm(offers, narrow=not grows)
        self.fields.edited.connect(self._edited)
        self.preview = Preview()
        self.nothing = QLabel("This instruction has nothing to set.")
        self.nothing.setProperty("role", "quiet")
        self.picture: QWidget | None = None
        self._beside = QHBoxLayout()
        self._beside.setSpacing(16)
        self._beside.addWidget(self.fields, 1)
        inside = QWidget()
        inside.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Minimum)
        column = QVBoxLayout(inside)
        column.setContentsMargins(0, 0, 8, 0)
        column.addWidget(self.nothing)
        column.addLayout(self._beside)
        column.addStretch(1)
        self.scroll = QScrollArea()
        self.scroll.setWidgetResizable(True)
        self.scroll.setFrameShape(QFrame.Shape.NoFrame)
        self.scroll.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAsNeeded)
        self.scroll.setWidget(inside)
        self.scroll.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self._inside = inside
        whole = QVBoxLayout(self)
        whole.setContentsMargins(0, 0, 0, 0)
        whole.setSpacing(8)
        whole.addWidget(self.scroll, 1)
        whole.addWidget(self.preview)

    @property
    def instruction(self) -> Instruction:
        """The instruction as it stands on the form."""
        return self.fields.item  # type: ignore[no-any-return]

    def problem(self) -> str:
        """The first reason why the instruction is not right; empty when it is."""
        errors = compiled(self.instruction, self.offers.setup).errors
        return errors[0].message if errors else ""

    def show_instruction(self, instruction: Instruction) -> None:
        """Shows `instruction`; typing places stay where they are if it is of the same kind."""
        other = type(instruction) is not type(self.fields.item)
        self.fields.show_item(instruction)
        if other:
            self._show_picture(instruction)
            self.nothing.setVisible(not self.fields.cells)
            self.setProperty("helpPage", instruction.title)
            self._fit()
        self._refresh()

    def _edited(self, instruction: Instruction) -> None:
        self._refresh()
        self.edited.emit(instruction)

    def _refresh(self) -> None:
        setup = self.offers.setup
        self.preview.show_words(read.sentence(self.instruction, setup), code(self.instruction, setup), self.problem())
        if self.picture is not None:
            self.picture.show_instruction(self.instruction)  # type: ignore[attr-defined]

    def _show_picture(self, instruction: Instruction) -> None:
        if self.picture is not None:
            self.picture.deleteLater()
            self.picture = None
        make = PICTURES.get(type(instruction).__name__)
        if make is not None and self.grows:
            self.picture = make(self.offers)
            if isinstance(self.picture, CommandList):
                self.picture.picked.connect(self._put_in)
            self._beside.addWidget(self.picture, 1)

    def _put_in(self, text: str) -> None:
        """A picked command becomes the next line of the code."""
        editor = self.fields.cells["text", ""].editor
        before = editor.value()
        editor.setValue(f"{before}\n{text}" if before.strip() else text)
        editor.changed.emit(editor.value())
        focus_in(editor)

    def showEvent(self, event: QShowEvent) -> None:
        """Only once it is styled is it known how high the fields are."""
        super().showEvent(event)
        self._fit()

    def _fit(self) -> None:
        """High enough to show all fields, and one more problem, without scrolling; as far as the screen allows."""
        if not self.grows:
            return
        self._inside.ensurePolished()
        layout = self._inside.layout()
        if layout is not None:
            layout.activate()
        wanted = self._inside.sizeHint()
        self.scroll.setMinimumHeight(min(wanted.height() + SPARE, HIGHEST))
        self.scroll.setMinimumWidth(min(wanted.width() + 24, WIDEST))
