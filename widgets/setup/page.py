"""First page of the setup: controller model, unit and scale of every axis, names of inputs and outputs."""

from __future__ import annotations

import dataclasses as dc

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QComboBox,
    QDialog,
    QFrame,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QTabWidget,
    QVBoxLayout,
    QWidget,
)

from codegen.fields import Context, fields_of
from codegen.models import MODELS
from codegen.setup import Axis, Setup, Unit, setup_problems
from widgets.parts.look import look

UNIT_WORDS = {
    Unit.INCH: "inch", Unit.FOOT: "foot", Unit.MM: "mm", Unit.CM: "cm", Unit.METRE: "m",
    Unit.DEGREE: "degree", Unit.COUNT: "count", Unit.OWN: "own unit…",
}  # fmt: skip


class AxisRow(QWidget):
    """Unit and scale of one axis."""

    edited = Signal()

    def __init__(self, letter: str, axis: Axis, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.letter, self._axis = letter, axis
        self.unit, self.own, self.scale, self.words = (
            QComboBox(),
            QLineEdit(axis.unit_name),
            QLineEdit(axis.counts_per_unit),
            QLabel(),
        )
        for unit, word in UNIT_WORDS.items():
            self.unit.addItem(word, unit)
        self.unit.setCurrentIndex(self.unit.findData(axis.unit))
        self.unit.setAccessibleName(f"Unit of {letter}")
        self.own.setAccessibleName(f"Own unit of {letter}")
        self.own.setPlaceholderText("name")
        self.own.setMaxLength(12)
        self.scale.setAccessibleName(f"Counts per unit of {letter}")
        self.scale.setPlaceholderText("not set up: 1")
        name = QLabel(letter)
        name.setStyleSheet(f"color: {look().axis(letter).name()}; font-weight: 700;")
        name.setMinimumWidth(24)
        self.own.setFixedWidth(96)
        self.unit.setFixedWidth(128)
        self.scale.setFixedWidth(144)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        for widget in (name, self.unit, self.own, self.scale):
            row.addWidget(widget)
        row.addWidget(self.words, 1)
        self.words.setProperty("role", "quiet")
        self.unit.currentIndexChanged.connect(self._changed)
        self.own.textChanged.connect(self._changed)
        self.scale.textChanged.connect(self._changed)
        self._changed()

    @property
    def axis(self) -> Axis:
        """The axis as it stands in the row."""
        unit = self.unit.currentData()
        return dc.replace(
            self._axis, unit=Unit(unit), unit_name=self.own.text().strip(), counts_per_unit=self.scale.text().strip()
        )

    def _changed(self) -> None:
        axis = self.axis
        self.own.setVisible(axis.unit is Unit.OWN)
        self.scale.setEnabled(axis.unit is not Unit.COUNT)
        self.words.setText(scale_words(axis))
        self.edited.emit()


def scale_words(axis: Axis) -> str:
    """What the scale means, in a sentence."""
    if axis.unit is Unit.COUNT:
        return "positions are encoder counts"
    if not axis.is_set_up:
        return f"! not set up: 1 count is taken for 1 {axis.symbol}"
    return f"1 {axis.symbol} = {axis.counts_per_unit} counts"


def _scale_problems(setup: Setup) -> list[str]:
    """What is wrong with the scales as they were typed."""
    field = fields_of(Axis)["counts_per_unit"]
    found = []
    for letter in setup.letters:
        axis = setup.axis(letter)
        problem = field.problem(axis.counts_per_unit, Context(setup, letter)) if axis.counts_per_unit else None
        if problem and axis.unit is not Unit.COUNT:
            found.append(f"{letter}: {problem}")
    return found


class NameGrid(QWidget):
    """Names of inputs or outputs."""

    edited = Signal()

    def __init__(self, what: str, names: tuple[str, ...], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        grid = QGridLayout(self)
        grid.setHorizontalSpacing(12)
        self.lines: list[QLineEdit] = []
        for index, name in enumerate(names):
            line = QLineEdit(name)
            line.setAccessibleName(f"Name of {what} {index + 1}")
            line.setPlaceholderText(f"{what} {index + 1}")
            line.textChanged.connect(self.edited)
            grid.addWidget(QLabel(str(index + 1)), index % 4, 2 * (index // 4))
            grid.addWidget(line, index % 4, 2 * (index // 4) + 1)
            self.lines.append(line)

    @property
    def names(self) -> tuple[str, ...]:
        """The names as typed."""
        return tuple(line.text().strip() for line in self.lines)


class SetupPage(QDialog):
    """Not modal; `accepted_setup(setup, keep)` with keep "units" or "counts" when the person is done."""

    accepted_setup = Signal(object, str)

    def __init__(self, setup: Setup, has_content: bool, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle("Setup")
        self.setProperty("helpPage", "Setup")
        self.setModal(False)
        self._before, self._has_content = setup, has_content
        self.model = QComboBox()
        self.model.setAccessibleName("Controller model")
        for model in MODELS.values():
            self.model.addItem(model.title, model.name)
        self.model.setCurrentIndex(max(0, self.model.findData(setup.model)))
        self.rows = {letter: AxisRow(letter, setup.axis(letter)) for letter in "XYZW"}
        self.inputs = NameGrid("Input", setup.input_names)
        self.outputs = NameGrid("Output", setup.output_names)
        self.serial, self.take_serial = QLineEdit(setup.serial_number), QPushButton("Take the connected one's")
        self.serial.setAccessibleName("Serial number of the controller")
        self.serial.setPlaceholderText("any")
        self.serial.setToolTip("Before download, execute and burn on a controller with another number you are asked")
        self.show_connected(None)
        self.facts, self.problem = QLabel(), QLabel()
        self.done_button, self.cancel = QPushButton("Done"), QPushButton("Cancel")
        self.question = self._make_question()
        self._lay_out()
        self.model.currentIndexChanged.connect(self._judge)
        self.serial.textChanged.connect(self._judge)
        for widget in (*self.rows.values(), self.inputs, self.outputs):
            widget.edited.connect(self._judge)
        self.take_serial.clicked.connect(self._take_serial)
        self.cancel.clicked.connect(self.reject)
        self.done_button.clicked.connect(self._finish)
        self._judge()

    @property
    def setup(self) -> Setup:
        """The setup as it stands on the page."""
        wanted = dc.replace(
            self._before,
            model=str(self.model.currentData()),
            serial_number=self.serial.text().strip(),
            input_names=self.inputs.names,
            output_names=self.outputs.names,
        )
        for letter, row in self.rows.items():
            wanted = wanted.with_axis(letter, row.axis)
        return wanted

    def show_connected(self, serial: int | None) -> None:
        """The serial number of the controller that is connected, if it tells one."""
        self._connected = serial
        self.take_serial.setEnabled(bool(serial))
        self.take_serial.setToolTip(
            f"{serial}, of the controller that is connected" if serial else "No controller that tells a serial number"
        )

    def _take_serial(self) -> None:
        self.serial.setText(str(self._connected))

    def rescaled(self) -> str:
        """Letters of the axes whose scale differs from before."""
        wanted = self.setup
        return "".join(
            letter for letter in wanted.letters if wanted.axis(letter).scale != self._before.axis(letter).scale
        )

    def _finish(self) -> None:
        if self.setup == self._before:
            self.reject()
        elif self._has_content and self.rescaled():
            self.question.show()
            self.keep_units.setFocus()
        else:
            self._keep("units")

    def _keep(self, what: str) -> None:
        self.accepted_setup.emit(self.setup, what)
        self.accept()

    def _judge(self) -> None:
        wanted = self.setup
        model = MODELS[wanted.model]
        self.facts.setText(
            f"{'Axis' if len(model.axes) == 1 else 'Axes'} {' '.join(model.axes)}, {model.inputs} inputs, "
            f"{model.outputs} outputs, "
            f"{model.lines} lines of {model.columns} characters, {model.threads} threads"
            if model.family != "smartmotor"
            else "1 axis, speaks its own language"
        )
        for letter, row in self.rows.items():
            row.setVisible(letter in wanted.letters)
        errors = _scale_problems(wanted)
        if wanted.serial_number and not (wanted.serial_number.isascii() and wanted.serial_number.isdigit()):
            errors.append("Serial number: write digits only, as the controller tells it (MG _BN), or nothing")
        errors += [each.message for each in setup_problems(wanted) if each.severity == "error"]
        self.problem.setText(errors[0] if errors else "")
        self.problem.setVisible(bool(errors))
        self.done_button.setEnabled(not errors)
        self.done_button.setToolTip(errors[0] if errors else "Takes the setup over (one step back with Undo)")
        self.question.hide()

    def _make_question(self) -> QFrame:
        frame = QFrame()
        frame.setProperty("role", "card")
        words = QLabel(
            "The scale has changed and the program already holds positions. What should stay the same?\n"
            "In units: 10 in stays 10 in, other counts are sent. "
            "In counts: the machine moves as before, the numbers change."
        )
        words.setWordWrap(True)
        self.keep_units, self.keep_counts = QPushButton("Keep the numbers in units"), QPushButton("Keep the counts")
        self.keep_units.clicked.connect(lambda: self._keep("units"))
        self.keep_counts.clicked.connect(lambda: self._keep("counts"))
        buttons = QHBoxLayout()
        buttons.addStretch(1)
        buttons.addWidget(self.keep_counts)
        buttons.addWidget(self.keep_units)
        column = QVBoxLayout(frame)
        column.addWidget(words)
        column.addLayout(buttons)
        frame.hide()
        return frame

    def _lay_out(self) -> None:
        self.facts.setProperty("role", "quiet")
        self.problem.setProperty("role", "warning")
        self.problem.setWordWrap(True)
        self.done_button.setProperty("role", "primary")
        tabs = QTabWidget()
        tabs.addTab(self._machine(), "Controller and units")
        tabs.addTab(self._named(), "Inputs and outputs")
        foot = QHBoxLayout()
        foot.addStretch(1)
        foot.addWidget(self.cancel)
        foot.addWidget(self.done_button)
        column = QVBoxLayout(self)
        column.setContentsMargins(24, 16, 24, 16)
        column.setSpacing(16)
        column.addWidget(tabs, 1)
        column.addWidget(self.problem)
        column.addWidget(self.question)
        column.addLayout(foot)
        self.setMinimumWidth(680)

    def _machine(self) -> QWidget:
        page = QWidget()
        column = QVBoxLayout(page)
        column.setContentsMargins(0, 16, 0, 8)
        column.setSpacing(12)
        controller = QGridLayout()
        controller.setHorizontalSpacing(16)
        controller.addWidget(QLabel("Controller model"), 0, 0)
        controller.addWidget(self.model, 0, 1)
        controller.addWidget(self.facts, 1, 1, 1, 3)
        controller.addWidget(QLabel("Serial number"), 2, 0)
        controller.addWidget(self.serial, 2, 1)
        controller.addWidget(self.take_serial, 2, 2)
        controller.setColumnStretch(3, 1)
        column.addLayout(controller)
        column.addSpacing(8)
        heading = QLabel("Unit of each axis, and encoder counts (or steps) in one unit")
        heading.setProperty("role", "heading")
        column.addWidget(heading)
        for row in self.rows.values():
            column.addWidget(row)
        column.addStretch(1)
        return page

    def _named(self) -> QWidget:
        page = QWidget()
        column = QVBoxLayout(page)
        column.setContentsMargins(0, 16, 0, 8)
        for words, grid in (("Inputs", self.inputs), ("Outputs", self.outputs)):
            heading = QLabel(f"{words}: names that programs, display and sentences use")
            heading.setProperty("role", "heading")
            column.addWidget(heading, 0, Qt.AlignmentFlag.AlignLeft)
            column.addWidget(grid)
        column.addStretch(1)
        return page
