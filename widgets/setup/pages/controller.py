"""Which controller it is: model, type plate, loop rate, serial number, and a name for the machine."""

from __future__ import annotations

import dataclasses as dc

from PySide6.QtWidgets import QComboBox, QGridLayout, QLabel, QLineEdit, QPushButton, QWidget

from codegen.fields import Context, fields_of
from codegen.models import MODELS, Model
from codegen.setup import Setup
from codegen.setup_differences import loop_words
from codegen.setup_plate import plate_problem, read_plate, with_plate
from widgets.parts.look import look
from widgets.setup.pages.page import Page, Shown, quiet, say

WIDE = 320


def facts_of(model: Model) -> str:
    """What a model has."""
    if model.family == "smartmotor":
        return "1 axis, speaks its own language"
    axes = "Axis" if len(model.axes) == 1 else "Axes"
    return (
        f"{axes} {' '.join(model.axes)}, {model.inputs} inputs, {model.outputs} outputs, {model.lines} lines of "
        f"{model.columns} characters, {model.threads} threads"
    )


def serial_problem(text: str) -> str:
    """Why a serial number cannot be one."""
    if not text or (text.isascii() and text.isdigit()):
        return ""
    return "Serial number: write digits only, as the controller tells it (MG _BN), or nothing"


class ControllerPage(Page):
    """Everything about the controller itself."""

    title = "Controller"
    help_page = "Setup: Controller"

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.name, self.plate, self.rate, self.serial = QLineEdit(), QLineEdit(), QLineEdit(), QLineEdit()
        self.model = QComboBox()
        self.use_plate, self.take_serial = QPushButton("Use it"), QPushButton("Take the connected one's")
        self.facts, self.plate_words, self.loop = quiet(), quiet(), quiet("warning")
        for model in MODELS.values():
            self.model.addItem(model.title, model.name)
        self._name_editors()
        self._lay_out()
        self.model.activated.connect(lambda _: self._put(model=str(self.model.currentData())))
        self.name.textEdited.connect(lambda text: self._put(name=text))
        self.plate.textEdited.connect(lambda text: self._put(plate=text))
        self.rate.textEdited.connect(lambda text: self._put(sample_us=text.strip()))
        self.serial.textEdited.connect(lambda text: self._put(serial_number=text.strip()))
        self.use_plate.clicked.connect(self._use_plate)
        self.take_serial.clicked.connect(self._take_serial)

    def refresh(self, shown: Shown) -> None:
        setup = shown.setup
        self.model.setCurrentIndex(max(0, self.model.findData(setup.model)))
        for line, text in (
            (self.name, setup.name),
            (self.plate, setup.plate),
            (self.rate, setup.sample_us),
            (self.serial, setup.serial_number),
        ):
            if line.text().strip() != text.strip():
                line.setText(text)
        self._show_plate(setup)
        self.facts.setText(facts_of(setup.limits))
        rate = fields_of(setup)["sample_us"].problem(setup.sample_us, Context(setup))
        say(self.loop, f"! {rate}" if rate else loop_words(setup, shown.readings))
        self.take_serial.setEnabled(bool(shown.serial))
        self.take_serial.setToolTip(
            f"{shown.serial}, of the controller that is connected"
            if shown.serial
            else "No controller that tells a serial number"
        )

    def _show_plate(self, setup: Setup) -> None:
        plate = read_plate(setup.plate)
        same = plate is not None and with_plate(setup, plate) == setup
        self.use_plate.setEnabled(plate is not None and not same)
        self.use_plate.setToolTip(
            "Sets model and motor types as the plate says"
            if self.use_plate.isEnabled()
            else "Model and motor types are as the plate says"
            if same
            else "Write what the type plate says first"
        )
        say(self.plate_words, plate.words if plate is not None else plate_problem(setup.plate))

    def _put(self, **values: str) -> None:
        if self.shown is not None:
            self.change(dc.replace(self.shown.setup, **values))  # type: ignore[arg-type]

    def _use_plate(self) -> None:
        if self.shown is not None and (plate := read_plate(self.shown.setup.plate)) is not None:
            self.change(with_plate(self.shown.setup, plate))

    def _take_serial(self) -> None:
        if self.shown is not None and self.shown.serial:
            self._put(serial_number=str(self.shown.serial))

    def _name_editors(self) -> None:
        for widget, words, hint in (
            (self.name, "Name of the machine", "for example Wire cutter 2"),
            (self.model, "Controller model", ""),
            (self.plate, "Type plate", "SSC10 … SSC48, or 3600-…"),
            (self.rate, "Loop rate in µs", ""),
            (self.serial, "Serial number of the controller", "any"),
        ):
            widget.setAccessibleName(words)
            widget.setMinimumHeight(look().control)
            if isinstance(widget, QLineEdit):
                widget.setPlaceholderText(hint)
                widget.setFixedWidth(WIDE)
        self.model.setMinimumWidth(WIDE)
        self.use_plate.setAccessibleName("Use the type plate")
        self.serial.setToolTip("Before download, execute and burn on a controller with another number you are asked")

    def _lay_out(self) -> None:
        grid = QGridLayout()
        grid.setHorizontalSpacing(12)
        grid.setVerticalSpacing(8)
        rows: tuple[tuple[str, QWidget, QWidget | None, QLabel | None], ...] = (
            ("Machine", self.name, None, None),
            ("Controller model", self.model, None, self.facts),
            ("Type plate", self.plate, self.use_plate, self.plate_words),
            ("Serial number", self.serial, self.take_serial, None),
            ("Loop rate, µs", self.rate, None, self.loop),
        )
        row = 0
        for words, editor, button, below in rows:
            grid.addWidget(QLabel(words), row, 0)
            grid.addWidget(editor, row, 1)
            if button is not None:
                grid.addWidget(button, row, 2)
            if below is not None:
                row += 1
                grid.addWidget(below, row, 1, 1, 3)
            row += 1
        grid.setColumnStretch(3, 1)
        self.column.addLayout(grid)
        self.column.addStretch(1)
