"""The scale of one axis worked out from a drawing: screw, belt, wheel or table, gear, encoder."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QDialog, QLabel, QPushButton, QVBoxLayout, QWidget

from codegen.numbers import is_short_decimal, shown
from codegen.setup import Setup
from codegen.setup_scale import Drive, Feedback, Mechanics, Scale, drives_for, scale_of
from widgets.form.fields_form import FieldsForm
from widgets.form.offers import Offers
from widgets.parts.foot import foot
from widgets.setup.pages.page import quiet, say


class Calculator(QDialog):
    """Not modal. `taken` carries the counts per unit, as text."""

    taken = Signal(str)

    def __init__(self, setup: Setup, letter: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle(f"Counts per unit of {letter}")
        self.setProperty("helpPage", "Setup: Axes")
        self.setModal(False)
        self._setup, self._letter = setup, letter
        self.scale: Scale | None = None
        self.form = FieldsForm(Offers(setup))
        self.answer, self.words, self.problem = QLabel(), quiet(), quiet("warning")
        self.answer.setProperty("role", "title")
        self.answer.setAccessibleName("Counts per unit")
        self.take, self.cancel = QPushButton("Take it over"), QPushButton("Cancel")
        self._lay_out()
        axis = setup.axis(letter)
        feedback = Feedback.STEPS if axis.is_stepper else Feedback.LINES
        drives = drives_for(axis.unit)
        self.form.show_item(Mechanics(drive=Drive(drives[0]) if drives else Drive.OWN, feedback=feedback))
        self.form.edited.connect(lambda _: self._work_out())
        self.take.clicked.connect(self._take)
        self.cancel.clicked.connect(self.reject)
        self._work_out()
        self.form.focus_first()

    def _work_out(self) -> None:
        found = scale_of(self.form.item, self._setup, self._letter)
        self.scale = found if isinstance(found, Scale) else None
        self.take.setEnabled(self.scale is not None)
        symbol = self._setup.axis(self._letter).symbol
        if isinstance(found, str):
            fields_say_it = any(cell.isVisibleTo(self) and cell.problem.text() for cell in self.form.cells.values())
            say(self.problem, "" if fields_say_it else found)
            self.take.setToolTip(found)
            self.answer.setText(f"1 {symbol} = … counts")
            say(self.words, " ")
            return
        number = (
            found.text
            if is_short_decimal(found.counts) or not found.exact
            else f"{found.text} = {shown(found.counts, 9)}…"
        )
        say(self.problem, "")
        self.take.setToolTip("Writes it into the setup")
        self.answer.setText(f"1 {symbol} = {number} counts")
        say(self.words, f"{found.words}.\n{found.remark}")

    def _take(self) -> None:
        if self.scale is not None:
            self.taken.emit(self.scale.text)
            self.accept()

    def _lay_out(self) -> None:
        self.take.setProperty("role", "primary")
        self.take.setDefault(True)
        self.cancel.setAutoDefault(False)
        column = QVBoxLayout(self)
        column.setContentsMargins(24, 16, 24, 16)
        column.setSpacing(8)
        column.addWidget(self.form)
        column.addStretch(1)
        column.addWidget(self.answer)
        column.addWidget(self.words)
        column.addWidget(self.problem)
        column.addSpacing(8)
        column.addWidget(foot(self.take, away=self.cancel))
        self.setMinimumSize(920, 440)
