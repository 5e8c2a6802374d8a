"""The display: positions, codes, inputs, outputs, switches, threads and voltages of whatever is connected."""

from __future__ import annotations

import dataclasses as dc
import math
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QEvent, QObject, QSize, Qt, Signal
from PySide6.QtWidgets import QCheckBox, QFrame, QHBoxLayout, QLabel, QPushButton, QScrollArea, QVBoxLayout, QWidget

from codegen.setup import setup_problems
from device.api import Kind, State
from device.live import AT
from widgets.display.analog import Voltages
from widgets.display.levels import Levels
from widgets.display.position import AxisReadout
from widgets.display.readings import axis_shown, drive_of, fresh, rate_words, switches_of
from widgets.display.stops import StopList, said_of
from widgets.display.switches import SwitchTable
from widgets.display.threads import ThreadList
from widgets.panel import Panel, set_text, set_tip
from widgets.parts.units import scale_of

if TYPE_CHECKING:
    from codegen.document import Document
    from codegen.setup import Setup
    from device.api import Controller, Row

AXIS_VALUES = ("position", "commanded", "error", AT, "velocity", "switches", "stop_code", "latch")
CODES = "Error and stop codes"  # the help page
LAMP = 24  # px; inputs are read, not clicked
EMPTY = "Nothing is connected. Connect a controller or start the simulator to see positions, inputs and outputs here."


class DisplayPanel(Panel):
    """Reads only, except for outputs when I/O control is switched on."""

    title = "Display"
    moves = True
    io_control_wanted = Signal(bool)
    output_wanted = Signal(int, bool)
    homed_told = Signal(str, bool)  # axis; the person says that it is homed, or that it is not
    connect_wanted = Signal()
    simulator_wanted = Signal()
    help_wanted = Signal(str)  # page
    setup_wanted = Signal(object, str)  # the setup with a name changed, and what was done
    said = Signal(str)  # why it was not done
    read_wanted = Signal()  # the person knows that no program waits for an answer

    def __init__(self, parent: QWidget | None = None, clock: Callable[[], float] = time.monotonic) -> None:
        super().__init__(parent)
        self._clock = clock
        self._setup: Setup | None = None
        self._source: Sequence[str] = ()
        self._sentences: Mapping[int, str] = {}
        self._letters = ""
        self._threads = 0
        self._analog: tuple[str, ...] = ()
        self.axes: dict[str, AxisReadout] = {}
        self.rate, self.empty = QLabel(), QLabel(EMPTY)
        self.inputs, self.outputs = Levels("Input", LAMP), Levels("Output")
        self.switches, self.threads, self.stops, self.analog = SwitchTable(), ThreadList(), StopList(), Voltages()
        self.io_control = QCheckBox("I/O control")
        self.io_control.setProperty("role", "field")
        self.read_now = QPushButton("Read now")
        self.read_now.setToolTip("Reads live values again: I know that no program waits for an answer.")
        self.read_now.clicked.connect(self.read_wanted)
        self.read_now.hide()
        self._lay_out()
        self.io_control.clicked.connect(self.io_control_wanted)
        self.outputs.wanted.connect(self.output_wanted)
        self.inputs.renamed.connect(partial(self._rename, "input"))
        self.outputs.renamed.connect(partial(self._rename, "output"))
        self.stops.more_wanted.connect(partial(self.help_wanted.emit, CODES))

    def take(self, controller: Controller) -> None:
        super().take(controller)
        self._letters, self._analog = "", ()  # nothing is asked for that this one may not have

    def show_controller(self) -> None:
        self._voltages.hide()
        set_text(self.rate, "")
        self._show_linked()

    def show_document(self, old: Document | None, new: Document) -> None:
        if old is None or old.setup is not new.setup:
            self._setup = new.setup
            self._show_linked()

    def show_source(self, lines: Sequence[str], sentences: Mapping[int, str]) -> None:
        """What the controller holds; `sentences`: the instructions of its lines when it is the open program."""
        self._source, self._sentences = lines, sentences

    def show_homed(self, marks: Mapping[str, tuple[str, str]]) -> None:
        """Of each axis whether it is known to be homed, in words, and why, for the tooltip."""
        for letter, readout in self.axes.items():
            readout.show_homed(*marks.get(letter, ("", "")))

    def show_ghost(self, ghost: Mapping[str, int], homed: Iterable[str]) -> None:
        """Where axes will stop, counts; and which are known to be homed."""
        if self._setup is None:
            return
        known = set(homed)
        for letter, readout in self.axes.items():
            place = ghost.get(letter, math.nan) / scale_of(self._setup.axis(letter))
            readout.show_mark(place, letter in known)

    def watches(self) -> tuple[str, ...]:
        axes = tuple(f"{name}.{letter.lower()}" for letter in self._letters for name in AXIS_VALUES)
        threads = (f"thread{number}" for number in range(self._threads))
        return (*axes, "inputs", "outputs", "period", "error_code", *threads, *self._in_sight())

    def _in_sight(self) -> Iterator[str]:
        """Voltages cost time of the line only while they can be seen: the others would come later by it."""
        if not self.switches.visibleRegion().isEmpty():
            yield from (f"torque.{letter.lower()}" for letter in self._letters)
        if not self.analog.visibleRegion().isEmpty():
            yield from self._analog

    def refresh(self, row: Row) -> None:
        if self.controller is None or self._setup is None or self.controller.kind is Kind.OFFLINE or not self._fits():
            return
        now = self._clock()
        for letter, readout in self.axes.items():
            axis, switches = self._setup.axis(letter), switches_of(row, letter, now)
            readout.show_axis(axis_shown(row, letter, axis, now))
            if letter in self.switches.letters:
                self.switches.show_axis(letter, switches, drive_of(row, letter, axis, switches, now))
        self.stops.show_said(said_of(row, self.axes, now))
        self.analog.show_volts([(row.value(key), row.stale(key, now)) for key in self._analog])
        self.inputs.show_byte(row.value("inputs"), row.stale("inputs", now))
        self.outputs.show_byte(row.value("outputs"), row.stale("outputs", now))
        lines = [fresh(row, f"thread{number}", now) for number in range(self._threads)]
        self.threads.show_threads(lines, self._source, self._sentences)
        self._show_rate()
        self._show_io_control()

    def words(self) -> str:
        """Everything it shows, as text."""
        if self.empty.isVisibleTo(self):
            return self.empty.text()
        axes = [f"{readout.accessibleName()}, {readout.commanded.text()}" for readout in self.axes.values()]
        inputs = [f"input {lamp.words}" for lamp in self.inputs.lamps]
        outputs = [f"output {lamp.words}" for lamp in self.outputs.lamps]
        switches = [" ".join(self.switches.words(letter)) for letter in self.axes]
        homed = [f"{letter} {readout.homed.text()}" for letter, readout in self.axes.items() if readout.homed.text()]
        io = (*inputs, *outputs, *switches, f"error output {self.switches.output.text()}", *self.analog.words())
        return "\n".join([self.rate.text(), *axes, *self.stops.words(), *io, *homed, *self.threads.words()])

    def _rename(self, kind: str, number: int, name: str) -> None:
        """A name that was typed goes into the setup, unless it would be no name there."""
        if self._setup is None:
            return
        field = f"{kind}_names"
        names = list(getattr(self._setup, field))
        names[number - 1] = name
        setup = dc.replace(self._setup, **{field: tuple(names)})
        wrong = [
            each for each in setup_problems(setup) if each.field == field and each not in setup_problems(self._setup)
        ]
        if wrong:
            self.said.emit(f"{kind.capitalize()} {number} was not renamed. {wrong[0].message}.")
        else:
            self.setup_wanted.emit(setup, f"Rename {kind} {number}")

    def _show_rate(self) -> None:
        controller = self.controller
        assert controller is not None
        text = rate_words(controller.rate_hz) if controller.polling else controller.polling_text
        if controller.state is not State.READY:
            text = controller.state_text
        set_text(self.rate, text)
        self.read_now.setVisible(not controller.polling and controller.state is State.READY)

    def _show_io_control(self) -> None:
        controller = self.controller
        assert controller is not None
        self.io_control.setEnabled(controller.control)
        set_tip(
            self.io_control,
            "Outputs switch when clicked." if controller.control else "This is Watch: switch to Control first.",
        )
        if self.io_control.isChecked() != controller.io_control:
            self.io_control.setChecked(controller.io_control)
        allowed = controller.control and controller.io_control
        self.outputs.show_switchable(allowed, "" if allowed else "Switch on I/O control to switch outputs by a click.")

    def _show_linked(self) -> None:
        """How to connect where nothing is connected; the rest comes with the ticks."""
        linked = self.controller is not None and self.controller.kind is not Kind.OFFLINE and self._setup is not None
        self.empty.setVisible(not linked)
        self._ways.setVisible(not linked)
        self._body.setVisible(linked)

    def _fits(self) -> bool:
        """Whether axes, lamps and threads are as model and setup have them; if not, one group is made now."""
        controller, setup = self.controller, self._setup
        assert controller is not None and setup is not None
        model = controller.model
        self._threads = model.threads if model is not None else 1
        inputs, outputs = (model.inputs, model.outputs) if model is not None else (8, 8)
        groups: tuple[tuple[object, Any, Callable[[Any], None]], ...] = (
            (self._letters, controller.axes or setup.letters, self._show_axes),
            (self.switches.letters, self._letters, self.switches.show_axes),
            (self.inputs.names, _names(setup.input_names, inputs), self.inputs.show_names),
            (self.outputs.names, _names(setup.output_names, outputs), self.outputs.show_names),
            (len(self._analog), model.analog_inputs if model is not None else 0, self._show_voltages),
        )
        for there, wanted, show in groups:
            if there != wanted:
                show(wanted)
                return False
        return True

    def _show_voltages(self, count: int) -> None:
        self._analog = tuple(f"analog{number}" for number in range(1, count + 1))
        self.analog.show_count(count)
        self._voltages.setVisible(count > 0)

    def _show_axes(self, letters: str) -> None:
        self._letters = letters
        for letter in tuple(self.axes):
            if letter not in letters:
                gone = self.axes.pop(letter)
                gone.hide()
                gone.deleteLater()
        for index, letter in enumerate(letters):
            if letter not in self.axes:
                self.axes[letter] = AxisReadout(letter)
                self.axes[letter].homed_told.connect(partial(self.homed_told.emit, letter))
            self._positions.insertWidget(index, self.axes[letter])

    def _lay_out(self) -> None:
        outer = QVBoxLayout(self)
        outer.setContentsMargins(8, 0, 8, 4)
        head = QHBoxLayout()
        head.addWidget(self.read_now)
        head.addWidget(self.rate, 1)
        self.rate.setWordWrap(True)
        self.rate.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        self.rate.setProperty("role", "quiet")
        outer.addLayout(head)
        self.empty.setWordWrap(True)
        self.empty.setProperty("role", "quiet")
        outer.addWidget(self.empty)
        self._ways = QWidget()
        ways = QHBoxLayout(self._ways)
        ways.setContentsMargins(0, 8, 0, 0)
        for text, signal in (("Connect…", self.connect_wanted), ("Start the simulator", self.simulator_wanted)):
            button = QPushButton(text)
            button.clicked.connect(signal)
            ways.addWidget(button)
        ways.addStretch(1)
        outer.addWidget(self._ways)
        inside = QWidget()
        self._body = Column(inside)
        outer.addWidget(self._body, 1)
        outer.addStretch(0)
        column = QVBoxLayout(inside)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(8)
        card = QFrame()
        card.setProperty("role", "card")
        self._positions = QVBoxLayout(card)
        self._positions.setContentsMargins(0, 4, 0, 4)
        column.addWidget(card)
        column.addWidget(self.stops)
        self._add(column, "Inputs", self.inputs)
        self._add(column, "Outputs", self.outputs, self.io_control)
        self._add(column, "Switches", self.switches)
        self._add(column, "Program", self.threads)
        self._voltages = QWidget()
        voltages = QVBoxLayout(self._voltages)
        voltages.setContentsMargins(0, 0, 0, 0)
        self._add(voltages, "Analog inputs, V", self.analog)
        column.addWidget(self._voltages)
        self._voltages.hide()
        column.addStretch(1)

    def _add(self, column: QVBoxLayout, heading: str, widget: QWidget, beside: QWidget | None = None) -> None:
        line = QHBoxLayout()
        label = QLabel(heading)
        label.setProperty("role", "heading")
        line.addWidget(label)
        line.addStretch(1)
        if beside is not None:
            line.addWidget(beside)
        column.addLayout(line)
        column.addWidget(widget)


class Column(QScrollArea):
    """Scrolls up and down, and is never narrower than what is in it: a number cut off is another number."""

    def __init__(self, inside: QWidget) -> None:
        super().__init__()
        self.setWidgetResizable(True)
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setWidget(inside)

    def minimumSizeHint(self) -> QSize:
        least = super().minimumSizeHint()
        bar = self.verticalScrollBar().sizeHint().width()
        return least.expandedTo(QSize(self.widget().minimumSizeHint().width() + bar, 0))

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if watched is self.widget() and event.type() is QEvent.Type.LayoutRequest:
            self.updateGeometry()
        return super().eventFilter(watched, event)


def _names(given: tuple[str, ...], count: int) -> list[str]:
    return [given[index] if index < len(given) else "" for index in range(count)]
