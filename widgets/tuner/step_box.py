"""How large a step, how long a record, how much torque; what will move how far, and the person's yes to it."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from codegen.fields import Dimension
from codegen.numbers import looks_like_number, parse_number, plain, shown
from widgets.display.readings import unit_of
from widgets.panel import set_text, show_role
from widgets.tuner.asked import DRIVES, UNSURE, Judged

if TYPE_CHECKING:
    from codegen.setup import Setup

SECONDS = {0.25: "0.25 s", 0.5: "0.5 s", 1.0: "1 s", 2.0: "2 s", 4.0: "4 s"}
USUAL_COUNTS = 500  # of the first step that is offered
TOP_VOLTS = Fraction("9.9982")


class StepBox(QWidget):
    """What starts and ends a run; `fields` has a place of its own, in `beside`.

    Emits `edited` with every change; the tick of `free` falls whenever what would happen has changed.
    """

    edited = Signal()
    start = Signal()
    cancel = Signal()

    def __init__(self, parent: QWidget, beside: QWidget) -> None:
        super().__init__(parent)
        self.fields = fields = QWidget(beside)
        self.step, self.volts = QLineEdit(fields), QLineEdit("9.9982", fields)
        self.seconds, self.drive = QComboBox(fields), QComboBox(fields)
        self.unit, self.words = QLabel(fields), QLabel(self)
        self.free = QCheckBox("I have looked: this way is free", self)
        self.begin, self.end = QPushButton("Start step", self), QPushButton("Cancel", self)
        for each in (self.free, self.begin, self.end):
            each.setEnabled(False)  # until it was judged
        self._setup: Setup | None = None
        self._axis = "X"
        self._agreed = ""
        self._lay_out()

    # ---- what it shows

    def show_axis(self, setup: Setup, letter: str) -> None:
        """Another axis or another machine: a small step in its unit."""
        self._setup, self._axis = setup, letter
        self.show_step(shown(setup.from_counts(Dimension.DISTANCE, letter, USUAL_COUNTS), 3))

    def show_step(self, text: str) -> None:
        """Another step, in the axis' unit."""
        self.step.setText(text)
        self._changed()

    @property
    def counts(self) -> int:
        """The step in counts; 0 where it is none."""
        number = parse_number(self.step.text())
        if self._setup is None or number is None:
            return 0
        return self._setup.counts(Dimension.DISTANCE, self._axis, number)

    @property
    def torque(self) -> float:
        """Volts at most."""
        return float(parse_number(self.volts.text()) or 0)

    @property
    def record_s(self) -> float:
        return float(self.seconds.currentData())

    @property
    def problem(self) -> str:
        """What is wrong with the fields, or nothing."""
        for name, field in (("The step", self.step), ("The torque limit", self.volts)):
            text = field.text()
            if parse_number(text) is None:
                comma = " Write a point, not a comma." if "," in text and looks_like_number(text) else ""
                return f"{name} “{text.strip()}” is not a number.{comma}" if text.strip() else f"{name} is missing."
        volts = parse_number(self.volts.text()) or Fraction(0)
        return "" if 0 < volts <= TOP_VOLTS else f"The torque limit must lie between 0 and {plain(TOP_VOLTS)} V."

    def show_judged(self, judged: Judged, reason: str, running: bool, begin: str) -> None:
        """What would happen; why not (`reason`); whether a run is on; what the button does."""
        set_text(self.words, judged.problem or judged.words)
        show_role(self.words, "problem" if judged.problem else "quiet")
        changed = judged.words != self._agreed and not judged.problem
        if changed and self.free.isChecked() and not running:
            self.free.setChecked(False)
        set_text_of(self.begin, begin)
        why = reason or judged.problem or ("" if self.free.isChecked() else "Look whether the way is free first.")
        self.begin.setEnabled(not why and not running)
        self.begin.setToolTip(why)
        self.free.setEnabled(not running and not judged.problem)
        self.free.setToolTip("A run is under way." if running else judged.problem or reason)
        self.end.setEnabled(running)
        self.end.setToolTip("Ends the run; the former values are put back" if running else "Nothing is under way.")
        for field in (self.step, self.volts, self.seconds, self.drive):
            field.setEnabled(not running)

    # ---- inside

    def _changed(self) -> None:
        wrong = self.problem
        show_role(self.step, "problem" if wrong.startswith("The step") else "")
        show_role(self.volts, "problem" if wrong.startswith("The torque") else "")
        if self._setup is not None:
            unit = unit_of(self._setup.axis(self._axis))
            told = "" if unit == "counts" else f" = {self.counts} counts"
            set_text(self.unit, f"{unit}{told}")
        self.edited.emit()

    def _ticked(self, on: bool) -> None:
        self._agreed = self.words.text() if on else ""
        self.edited.emit()

    def _lay_out(self) -> None:
        for value, text in SECONDS.items():
            self.seconds.addItem(text, value)
        self.seconds.setCurrentIndex(1)
        for key, text in DRIVES.items():
            self.drive.addItem(text, key)
        self.drive.setCurrentIndex(list(DRIVES).index(UNSURE))
        names = {
            self.step: "Step size",
            self.volts: "Torque limit, V",
            self.seconds: "Record",
            self.drive: "Drive mode",
        }
        grid = QGridLayout(self.fields)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(8)
        grid.setVerticalSpacing(6)
        for row, (field, name) in enumerate(names.items()):
            field.setAccessibleName(name)
            grid.addWidget(QLabel(name), row, 0)
            grid.addWidget(field, row, 1, 1, 2 if field is self.drive else 1, Qt.AlignmentFlag.AlignLeft)
        for field in (self.step, self.volts):
            field.setFixedWidth(96)
            field.textEdited.connect(lambda _text: self._changed())
        for choice in (self.seconds, self.drive):
            choice.currentIndexChanged.connect(lambda _index: self.edited.emit())
        self.unit.setProperty("role", "quiet")
        grid.addWidget(self.unit, 0, 2)
        grid.setColumnStretch(2, 1)
        self.drive_label = grid.itemAtPosition(3, 0).widget()  # type: ignore[union-attr]
        self.words.setWordWrap(True)
        self.words.setAccessibleName("What will happen")
        self.free.clicked.connect(self._ticked)
        self.begin.setProperty("role", "primary")
        self.begin.clicked.connect(self.start)
        self.end.clicked.connect(self.cancel)
        row_ = QHBoxLayout()
        row_.addWidget(self.begin, 1)
        row_.addWidget(self.end)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(6)
        column.addWidget(self.words)
        column.addWidget(self.free, 0, Qt.AlignmentFlag.AlignLeft)
        column.addLayout(row_)


def set_text_of(button: QPushButton, text: str) -> None:
    """Only when it differs."""
    if button.text() != text:
        button.setText(text)
