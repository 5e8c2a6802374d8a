"""The hand of the outside world on the simulated machine: switches, inputs, voltages, a push on the load."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QLocale, Qt, Signal
from PySide6.QtWidgets import (
    QCheckBox,
    QDoubleSpinBox,
    QFrame,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QScrollArea,
    QSlider,
    QVBoxLayout,
    QWidget,
)

from device.api import Kind
from widgets.panel import Panel, set_text
from widgets.parts.pieces import Pieces, dressed
from widgets.parts.spin import indented

if TYPE_CHECKING:
    from codegen.document import Document
    from codegen.setup import Setup
    from device.api import Controller

STARTING = "The simulator is starting."
EMPTY = "The simulator is not running. Start it to flip its switches and push its load from here."
SWITCHES = (("fls", "Forward limit"), ("rls", "Reverse limit"), ("home", "Home"))


class SimulatorPanel(Panel):
    """Everything goes up as `stimulus(signal, value)` with the names of the command line's --stimulus."""

    title = "Simulator"
    moves = True
    stimulus = Signal(str, float)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._setup: Setup | None = None
        self._built: tuple[object, ...] | None = None  # for the simulator that is connected
        self.inputs: dict[int, QCheckBox] = {}
        self.switches: dict[str, QCheckBox] = {}
        self.volts: dict[int, QDoubleSpinBox] = {}
        self.pushes: dict[str, QDoubleSpinBox] = {}
        self.buttons: dict[str, QPushButton] = {}
        self.reset = QPushButton("Reset")
        self.empty = QLabel(EMPTY)
        self.empty.setWordWrap(True)
        self.empty.setProperty("role", "quiet")
        self._area = QScrollArea()
        self._area.setWidgetResizable(True)
        self._area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self._area.setFrameShape(QFrame.Shape.NoFrame)
        column = QVBoxLayout(self)
        column.setContentsMargins(8, 0, 8, 4)
        column.addWidget(self.empty)
        column.addWidget(self._area, 1)
        column.addStretch(0)
        self._show()

    def take(self, controller: Controller) -> None:
        super().take(controller)
        self._built = None

    def show_controller(self) -> None:
        self._show()

    def show_document(self, old: Document | None, new: Document) -> None:
        if old is None or old.setup is not new.setup:
            self._setup = new.setup

    def refresh(self, row: object) -> None:
        """Controls are made, piece by piece, when axes, inputs or their names are others than those there are."""
        self._show()
        wanted = self._wanted()
        if wanted is not None and wanted != self._built:
            self.making = Pieces(self._controls(*wanted))

    def _wanted(self) -> tuple[int, int, str, tuple[str, ...]] | None:
        """Inputs, analog inputs, axes, names; nothing before it is known what there is to flip."""
        controller = self.controller
        if controller is None or controller.kind is not Kind.SIMULATOR or controller.model is None:
            return None
        names = self._setup.input_names if self._setup is not None else ()
        return controller.model.inputs, controller.model.analog_inputs, controller.axes or "X", tuple(names)

    def _show(self) -> None:
        """What was made for this simulator stays until the next is ready."""
        there = self._built is not None and self._wanted() is not None
        simulated = self.controller is not None and self.controller.kind is Kind.SIMULATOR
        set_text(self.empty, STARTING if simulated else EMPTY)
        self.empty.setVisible(not there)
        self._area.setVisible(there)

    def _controls(self, inputs: int, analog: int, letters: str, names: tuple[str, ...]) -> Iterator[None]:
        inside = QWidget(self)
        column = QVBoxLayout(inside)
        column.setContentsMargins(0, 0, 8, 0)
        column.setSpacing(8)
        for heading, grid in (
            ("Inputs (ticked: high, as with nothing connected)", partial(self._input_grid, inputs, names)),
            ("Switches (ticked: pressed)", partial(self._switch_grid, letters)),
            ("Analog inputs", partial(self._analog_grid, analog)),
            ("Push the load", partial(self._push_grid, letters)),
        ):
            self._heading(column, heading)
            column.addLayout(grid())
            yield
        column.addLayout(self._system_row())
        column.addStretch(1)
        yield from dressed(inside)
        self._area.setWidget(inside)
        self._built = inputs, analog, letters, names
        self._show()

    def _heading(self, column: QVBoxLayout, text: str) -> None:
        label = QLabel(text)
        label.setWordWrap(True)
        label.setProperty("role", "heading")
        column.addWidget(label)

    def _input_grid(self, count: int, names: tuple[str, ...]) -> QGridLayout:
        grid = QGridLayout()
        grid.setVerticalSpacing(0)
        self.inputs = {}
        for number in range(1, count + 1):
            name = names[number - 1] if number <= len(names) else ""
            box = _box(f"{number}  {name}".rstrip())
            box.setAccessibleName(f"Input {number} {name}".strip())
            box.setChecked(True)
            box.toggled.connect(lambda high, number=number: self.stimulus.emit(f"in{number}", float(high)))
            rows = (count + 1) // 2
            grid.addWidget(box, (number - 1) % rows, (number - 1) // rows)
            self.inputs[number] = box
        return grid

    def _switch_grid(self, letters: str) -> QGridLayout:
        grid = QGridLayout()
        grid.setVerticalSpacing(0)
        self.switches = {}
        for column, letter in enumerate(letters):
            for row, (signal, words) in enumerate(SWITCHES):
                box = _box(f"{letter} {words.lower()}")
                name = f"{signal}_{letter.lower()}"
                box.toggled.connect(lambda pressed, name=name: self.stimulus.emit(name, 0.0 if pressed else 1.0))
                grid.addWidget(box, row + 3 * (column // 2), column % 2)
                self.switches[name] = box
        return grid

    def _analog_grid(self, count: int) -> QGridLayout:
        grid = QGridLayout()
        self.volts = {}
        for number in range(1, count + 1):
            label, slider, box = QLabel(str(number)), QSlider(Qt.Orientation.Horizontal), QDoubleSpinBox()
            box.setLocale(QLocale.c())
            box.setRange(-10.0, 10.0)
            box.setSingleStep(0.1)
            box.setSuffix(" V")
            indented(box)
            box.setFixedWidth(88)
            slider.setMinimumWidth(72)
            box.setAccessibleName(f"Analog input {number} in volts")
            slider.setRange(-1000, 1000)
            slider.setAccessibleName(f"Analog input {number}")
            slider.valueChanged.connect(lambda value, box=box: box.setValue(value / 100))
            box.valueChanged.connect(lambda value, slider=slider: _quietly(slider, round(value * 100)))
            box.valueChanged.connect(lambda value, number=number: self.stimulus.emit(f"an{number}", float(value)))
            for column, widget in enumerate((label, slider, box)):
                grid.addWidget(widget, number, column)
            self.volts[number] = box
        grid.setColumnStretch(1, 1)
        return grid

    def _push_grid(self, letters: str) -> QGridLayout:
        grid = QGridLayout()
        self.pushes, self.buttons = {}, {}
        for row, letter in enumerate(letters):
            box, button = QDoubleSpinBox(), QPushButton(f"Push {letter}")
            box.setLocale(QLocale.c())  # a point, whatever the system writes
            box.setRange(-1_000_000, 1_000_000)
            box.setDecimals(0)
            box.setValue(100)
            box.setSuffix(" counts")
            indented(box)
            box.setAccessibleName(f"Push on {letter} in counts")
            button.clicked.connect(
                lambda _=False, letter=letter, box=box: self.stimulus.emit(f"position_{letter.lower()}", box.value())
            )
            grid.addWidget(QLabel(letter), row, 0)
            grid.addWidget(box, row, 1)
            grid.addWidget(button, row, 2)
            self.pushes[letter], self.buttons[letter] = box, button
        grid.setColumnStretch(1, 1)
        return grid

    def _system_row(self) -> QHBoxLayout:
        row = QHBoxLayout()
        abort = _box("Abort input pressed")
        abort.toggled.connect(lambda pressed: self.stimulus.emit("abort", 0.0 if pressed else 1.0))
        self.switches["abort"] = abort
        reset = self.reset = QPushButton("Reset")
        reset.setToolTip("As if the power had been off for a moment: what is not burned is gone.")
        reset.clicked.connect(lambda: self.stimulus.emit("reset", 0.0))
        row.addWidget(abort)
        row.addStretch(1)
        row.addWidget(reset)
        return row


def _box(words: str) -> QCheckBox:
    """A check box in line with the fields."""
    box = QCheckBox(words)
    box.setProperty("role", "field")
    return box


def _quietly(slider: QSlider, value: int) -> None:
    """Moves the slider without telling anybody."""
    slider.blockSignals(True)
    slider.setValue(value)
    slider.blockSignals(False)
