"""Unit, scale and kind of motor of every axis."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Iterator

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QComboBox, QHBoxLayout, QLabel, QLineEdit, QPushButton, QWidget

from codegen.fields import Context, fields_of
from codegen.numbers import is_short_decimal, plain, shown
from codegen.setup import Axis, Setup, Unit
from codegen.setup_scale import in_unit
from widgets.parts.look import look
from widgets.setup.calculator import Calculator
from widgets.setup.pages.grid import AxisGrid
from widgets.setup.pages.page import Page, Shown, quiet

UNIT_WORDS = {
    Unit.INCH: "inch", Unit.FOOT: "foot", Unit.MM: "mm", Unit.CM: "cm", Unit.METRE: "m",
    Unit.DEGREE: "degree", Unit.COUNT: "count", Unit.OWN: "own unit…",
}  # fmt: skip


def scale_words(axis: Axis) -> str:
    """What the scale means, in a sentence; where it never ends, exact and about."""
    if axis.unit is Unit.COUNT:
        return "positions are encoder counts"
    if not axis.is_set_up:
        return f"△ not set up: 1 count is taken for 1 {axis.symbol}"
    if axis.scale_problem:
        return ""
    about = "" if is_short_decimal(axis.scale) else f" = {shown(axis.scale, 9)}… (exact as a quotient)"
    number = plain(axis.scale) if not about else str(axis.scale)
    return f"1 {axis.symbol} = {number} counts{about}"


class AxisRow(QWidget):
    """Unit and scale of one axis."""

    edited = Signal(object)  # the Axis
    calculate = Signal()

    def __init__(self, letter: str) -> None:
        super().__init__()
        self.letter = letter
        self._axis = Axis()
        self.unit, self.own, self.scale, self.words = QComboBox(), QLineEdit(), QLineEdit(), quiet()
        self.work_out = QPushButton("Calculate…")
        for unit, word in UNIT_WORDS.items():
            self.unit.addItem(word, unit)
        name = QLabel(letter)
        name.setStyleSheet(f"color: {look().axis(letter).name()}; font-weight: 700;")
        name.setFixedWidth(24)
        for widget, words, width in (
            (self.unit, f"Unit of {letter}", 128),
            (self.own, f"Own unit of {letter}", 96),
            (self.scale, f"Counts per unit of {letter}", 144),
        ):
            widget.setAccessibleName(words)
            widget.setFixedWidth(width)
            widget.setMinimumHeight(look().control)
        self.own.setPlaceholderText("name")
        self.own.setMaxLength(12)
        self.scale.setPlaceholderText("not set up: 1")
        self.work_out.setAccessibleName(f"Calculate the counts per unit of {letter}")
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(8)
        for each in (name, self.unit, self.own, self.scale, self.work_out):
            row.addWidget(each)
        row.addWidget(self.words, 1)
        self.unit.activated.connect(lambda _: self._change_unit(Unit(self.unit.currentData())))
        self.own.textEdited.connect(lambda text: self._put(unit_name=text.strip()))
        self.scale.textEdited.connect(lambda text: self._put(counts_per_unit=text.strip()))
        self.work_out.clicked.connect(self.calculate)

    def show_axis(self, setup: Setup) -> None:
        """Shows the axis as it stands."""
        axis = self._axis = setup.axis(self.letter)
        self.unit.setCurrentIndex(self.unit.findData(axis.unit))
        for line, text in ((self.own, axis.unit_name), (self.scale, axis.counts_per_unit)):
            if line.text().strip() != text.strip():
                line.setText(text)
        self.own.setVisible(axis.unit is Unit.OWN)
        scaled = axis.unit is not Unit.COUNT
        self.scale.setEnabled(scaled)
        self.work_out.setEnabled(scaled)
        self.work_out.setToolTip("From screw, belt or gear and the encoder" if scaled else "Counts need no scale")
        field = fields_of(axis)["counts_per_unit"]
        problem = field.problem(axis.counts_per_unit, Context(setup, self.letter)) if scaled else None
        words = f"! {problem.removeprefix(f'{field.label}: ')}" if problem else scale_words(axis)
        self.words.setText(words)
        role = "warning" if problem or not axis.is_set_up else "quiet"
        if self.words.property("role") != role:
            self.words.setProperty("role", role)
            self.words.style().polish(self.words)
        self.scale.setAccessibleDescription(words)

    def _change_unit(self, unit: Unit) -> None:
        """The mechanics stay what they are: the scale follows from one unit of length to another."""
        self._put(unit=unit, counts_per_unit=in_unit(self._axis.counts_per_unit, self._axis.unit, unit))

    def _put(self, **values: object) -> None:
        axis = dc.replace(self._axis, **values)  # type: ignore[arg-type]
        if axis != self._axis:
            self.edited.emit(axis)


class AxesPage(Page):
    """Unit and scale, and which motor hangs on the axis."""

    title = "Axes"
    help_page = "Setup: Axes"

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.calculator: Calculator | None = None
        self.heading("Unit of each axis, and encoder counts (or steps) in one unit")
        self.rows = {letter: AxisRow(letter) for letter in "XYZW"}
        for letter, row in self.rows.items():
            self.column.addWidget(row)
            row.edited.connect(lambda axis, letter=letter: self._put(letter, axis))
            row.calculate.connect(lambda letter=letter: self._calculate(letter))
        self.column.addSpacing(16)
        self.heading("Signal to the drive")
        self.motors = AxisGrid(("motor",))
        self.motors.edited.connect(self.change)
        self.column.addWidget(self.motors)
        words = self.words()
        words.setText(
            "Servo: ±10 V, set up on the page Servo. Stepper: step and direction, needs the jumper SM of its axis; "
            "set up on the page Stepper."
        )
        self.column.addStretch(1)

    def filling(self, shown: Shown) -> Iterator[None]:
        return self.motors.showing(shown, shown.setup.letters)

    def refresh(self, shown: Shown) -> None:
        for letter, row in self.rows.items():
            row.setVisible(letter in shown.setup.letters)
            row.show_axis(shown.setup)
        self.motors.show_axes(shown, shown.setup.letters)

    def _put(self, letter: str, axis: Axis) -> None:
        if self.shown is not None:
            self.change(self.shown.setup.with_axis(letter, axis))

    def _calculate(self, letter: str) -> None:
        if self.shown is None:
            return
        self.calculator = Calculator(self.shown.setup, letter, self.window())
        self.calculator.taken.connect(lambda text: self._take(letter, text))
        self.calculator.show()

    def _take(self, letter: str, text: str) -> None:
        if self.shown is not None:
            self._put(letter, dc.replace(self.shown.setup.axis(letter), counts_per_unit=text))
            self.rows[letter].scale.setFocus()
