"""What is captured: up to four channels, how often, how long, and what it begins with."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from PySide6.QtCore import QSignalBlocker, Qt, Signal
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QSpinBox,
    QVBoxLayout,
    QWidget,
)

from codegen.models import Model
from codegen.numbers import number_problem, parse_number
from codegen.setup import Setup
from device.capture import (
    FEWEST,
    SLOWEST,
    TICKS_S,
    Channel,
    Plan,
    Trigger,
    When,
    channels,
    most,
    objection,
    scale_of,
    shown_by,
    too_short,
)
from device.curves import Derived
from widgets.panel import set_text
from widgets.parts.pieces import Pieces
from widgets.parts.spin import indented
from widgets.scope.bit_menu import Bits
from widgets.scope.slot import Slot, as_wide_as_there_is_room

SLOTS = 4
COUNT_WIDTH = 96  # px: four digits
WHENS = {
    When.NOW: "At once",
    When.MOTION: "Motion begins",
    When.INPUT: "Edge of input",
    When.LEVEL: "Level",
}
EDGES = {True: ("goes on", "rises above"), False: ("goes off", "falls below")}
USUAL = (Channel("position", "X"), Channel("commanded", "X"), None, None)


class Choices(QWidget):
    """The column of choices; `plan` is what they ask for, `problem` why it cannot be done."""

    changed = Signal()

    def __init__(self, parent: QWidget | None = None, at_once: bool = True) -> None:
        super().__init__(parent)
        self._model: Model | None = None
        self._setup: Setup | None = None
        self._tm = 0.0  # what the controller says; 0: not known
        self._count, self._axis, self._input = 500, "X", 1  # what the person wants, also where it does not fit now
        self.making = Pieces(self._pieces())
        if at_once:
            self.making.finish()

    def _pieces(self) -> Iterator[None]:
        """Channels, then how often, how long, from when on."""
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(0, 0, 8, 0)
        self._column.setSpacing(4)
        self.slots = [Slot(number, self) for number in range(1, SLOTS + 1)]
        for slot, usual in zip(self.slots, USUAL, strict=True):
            slot.wanted = usual
            self._column.addWidget(slot)
        yield
        self.derived = {kind: QCheckBox(kind, self) for kind in Derived}
        self.every, self.begin, self.axis, self.edge, self.level_of = (QComboBox(self) for _ in range(5))
        self.count, self.input, self.before = (QSpinBox(self) for _ in range(3))
        self.length, self.hint, self.level_unit = QLabel(self), QLabel(self), QLabel(self)
        self.level = QLineEdit("0", self)
        for box in (self.count, self.input, self.before):
            indented(box)
        self._name_all()
        self._lay_out()
        yield
        self._fill()
        self._connect()
        self._follow()

    # ---------------------------------------------------------------- asked for

    @property
    def channels(self) -> tuple[Channel, ...]:
        """Those that are chosen, each once."""
        found = [slot.channel for slot in self.slots if slot.isVisibleTo(self) and slot.channel is not None]
        return tuple(dict.fromkeys(found))

    @property
    def shown(self) -> set[Derived]:
        return {kind for kind, box in self.derived.items() if box.isChecked()}

    def colour_of(self, channel: Channel) -> str:
        """The token of a channel's colour; of one that is not chosen now, that of its axis."""
        for slot in self.slots:
            if slot.channel == channel:
                return slot.colour
        return f"axis_{channel.axis.lower()}" if channel.axis else "quiet"

    def bits_of(self, channel: Channel) -> Bits:
        """Which bits of a channel are tracks; of one that is not chosen now, those that are worth it."""
        return next((slot.bits for slot in self.slots if slot.channel == channel), None)

    @property
    def model(self) -> Model | None:
        """Of the controller, or of the setup while none is known."""
        return self._model

    @property
    def plan(self) -> Plan:
        return Plan(self.channels, self.every.currentIndex() + 1, self.count.value(), self.trigger)

    @property
    def when(self) -> When:
        return When(self.begin.currentData())

    @property
    def trigger(self) -> Trigger:
        when = self.when
        if when is When.NOW:
            return Trigger()
        pre, rising = self.before.value() / 100, bool(self.edge.currentData())
        if when is When.MOTION:
            return Trigger(when, axis=self.axis.currentText(), pre=pre)
        if when is When.INPUT:
            return Trigger(when, number=self.input.value(), rising=rising, pre=pre)
        channel = self.level_of.currentData()
        number = parse_number(self.level.text())
        level = float(number) * scale_of(channel, self._setup)[0] if number is not None and channel else 0.0
        return Trigger(when, channel=channel, level=level, rising=rising, pre=pre)

    @property
    def problem(self) -> str:
        """Why this cannot be captured, as one sentence, or nothing."""
        if self._model is None:
            return "Which controller it is, is not known."
        if self.when is When.LEVEL and (words := number_problem(self.level.text())):
            return f"Level: {words}"
        return objection(self.plan, self._model) or too_short(self.plan, self._sample_s * TICKS_S)

    # ------------------------------------------------------------------- offered

    def show_machine(self, model: Model, setup: Setup | None) -> None:
        """What this controller records, in the units of this setup."""
        if model == self._model and setup is self._setup:
            return
        self._model, self._setup = model, setup
        self._offer()
        self._follow()

    def show_period(self, tm: float) -> None:
        """The sample time that the controller works with; where it is not known, that of the setup counts."""
        tm = abs(tm) if math.isfinite(tm) else 0.0
        if tm != self._tm:
            self._tm = tm
            self._follow()

    @property
    def _sample_s(self) -> float:
        setup = float(self._setup.sample) if self._setup is not None else 1000.0
        return (self._tm or setup) / TICKS_S

    def _offer(self) -> None:
        """What there is on this controller, with what the person wants chosen as far as it is there."""
        if self._model is None:
            return
        known = channels(self._model)
        for slot in self.slots:
            slot.setVisible(slot.number <= self._model.recorded_channels)
            slot.offer(known, self._model, self._setup)
        with QSignalBlocker(self.axis), QSignalBlocker(self.input):
            self.axis.clear()
            self.axis.addItems(list(self._model.axes))
            self.axis.setCurrentIndex(max(self.axis.findText(self._axis), 0))
            self.input.setRange(1, self._model.inputs)
            self.input.setValue(self._input)

    # --------------------------------------------------------------- remembered

    def state(self) -> dict[str, Any]:
        """What was chosen, for the next start."""
        return {
            "channels": [slot.state() for slot in self.slots],
            "derived": sorted(self.shown),
            "every": self.every.currentIndex() + 1,
            "count": self._count,
            "start": self.begin.currentData(),
            "axis": self._axis,
            "input": self._input,
            "rising": bool(self.edge.currentData()),
            "level": self.level.text(),
            "before": self.before.value(),
        }

    def restore(self, found: Mapping[str, Any]) -> None:
        """What was chosen at the last start, as far as it is something that can be chosen."""
        listed, derived = found.get("channels"), found.get("derived")
        for slot, each in zip(self.slots, listed if isinstance(listed, list) else [], strict=False):
            slot.restore(each)
        for kind, box in self.derived.items():
            box.setChecked(isinstance(derived, list) and str(kind) in derived)
        self.every.setCurrentIndex(_whole(found, "every", 1, SLOWEST, self.every.currentIndex() + 1) - 1)
        self._count = _whole(found, "count", FEWEST, 8000, self._count)
        self.begin.setCurrentIndex(max(self.begin.findData(found.get("start")), 0))
        self._axis = str(found.get("axis", self._axis))
        self._input = _whole(found, "input", 1, 99, self._input)
        self.edge.setCurrentIndex(int(found.get("rising") is False))
        if isinstance(found.get("level"), str):
            self.level.setText(found["level"])
        self.before.setValue(_whole(found, "before", 0, 90, self.before.value()))
        self._offer()
        self._follow()

    def _follow(self) -> None:
        """Everything that depends on something else."""
        when, several = self.when, max(1, len(self.channels))
        sample_s = self._sample_s
        for place in range(SLOWEST):
            every = 2 << place
            self.every.setItemText(place, f"{every} samples, {every * sample_s * 1000:.3g} ms")
        if self._model is not None:
            with QSignalBlocker(self.count):  # what is wanted stays so where fewer fit
                self.count.setRange(FEWEST, most(self._model, several))
                self.count.setValue(self._count)
        set_text(self.length, f"{self.count.value() * (2 << self.every.currentIndex()) * sample_s:.3g} s")
        for widget, whens in self._only.items():
            self._form.setRowVisible(widget, when in whens)
        self._offer_levels()
        words = self.edge_words
        for place in range(2):
            self.edge.setItemText(place, words[place])
        set_text(self.hint, self.problem or self._sureness())
        self.hint.setProperty("role", "problem" if self.problem else "quiet")
        self.hint.style().polish(self.hint)
        self.changed.emit()

    @property
    def edge_words(self) -> tuple[str, str]:
        place = int(self.when is When.LEVEL)
        return EDGES[True][place], EDGES[False][place]

    def _offer_levels(self) -> None:
        wanted = [channel for channel in self.channels if channel.live_key]
        if [self.level_of.itemData(place) for place in range(self.level_of.count())] != wanted:
            chosen = self.level_of.currentData()
            self.level_of.blockSignals(True)
            self.level_of.clear()
            for channel in wanted:
                self.level_of.addItem(channel.label, channel)
            self.level_of.setCurrentIndex(wanted.index(chosen) if chosen in wanted else 0)
            self.level_of.blockSignals(False)
        channel = self.level_of.currentData()
        set_text(self.level_unit, scale_of(channel, self._setup)[1] if channel is not None else "")

    def _sureness(self) -> str:
        """How exactly the trigger will be known."""
        trigger = self.trigger
        if trigger.when is When.NOW:
            return ""
        channel = shown_by(trigger, self.channels)
        if channel is not None:
            return f"Found to the very value, because {channel.label} is recorded. Looked for from here, so what is " \
                "over within some 0.1 s may be missed."  # fmt: skip
        wanted = "Inputs" if trigger.when is When.INPUT else f"Commanded position {trigger.axis}"
        return f"Known to some 0.1 s only; record {wanted} as well to find the very value."

    # ------------------------------------------------------------------- details

    def _fill(self) -> None:
        for _ in range(SLOWEST):
            self.every.addItem("")
        for when, words in WHENS.items():
            self.begin.addItem(words, when.value)
        self.edge.addItem("", True)
        self.edge.addItem("", False)
        self.count.setRange(FEWEST, 8000)
        self.count.setValue(self._count)
        self.count.setSingleStep(100)
        self.before.setRange(0, 90)
        self.before.setValue(25)
        self.before.setSuffix(" %")
        for box in self.derived.values():
            box.setChecked(False)

    def _name_all(self) -> None:
        for widget, name, tip in (
            (self.every, "Interval", "The controller records one value each 2, 4, … 256 samples"),
            (self.count, "Values a channel", "More values need more array elements of the controller"),
            (self.begin, "Start of the recording", "What the recording begins with"),
            (self.axis, "Axis that begins to move", "Its commanded position begins to change"),
            (self.input, "Number of the input", "The input that is waited for"),
            (self.edge, "Direction", "Upwards or downwards"),
            (self.level_of, "Channel of the level", "One of the recorded channels"),
            (self.level, "Level", "In the unit behind it"),
            (self.before, "Share before the trigger", "How much of the recording is kept from before the trigger"),
        ):
            widget.setAccessibleName(name)
            widget.setToolTip(tip)
        for box in (self.every, self.begin, self.axis, self.edge, self.level_of):
            as_wide_as_there_is_room(box)
        for kind, box in self.derived.items():
            box.setAccessibleName(f"Also show {kind.lower()}")
        self.hint.setWordWrap(True)
        self.length.setProperty("role", "quiet")
        self.level_unit.setProperty("role", "quiet")

    def _lay_out(self) -> None:
        also = QVBoxLayout()
        also.setSpacing(0)
        for box in self.derived.values():
            also.addWidget(box)
        self._column.addLayout(also)
        form = self._form = QFormLayout()
        form.setContentsMargins(0, 4, 0, 0)
        form.setVerticalSpacing(4)
        form.setHorizontalSpacing(8)
        form.setLabelAlignment(Qt.AlignmentFlag.AlignVCenter)
        form.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
        values, level = QHBoxLayout(), QHBoxLayout()
        self.count.setMinimumWidth(COUNT_WIDTH)
        values.setSpacing(8)
        values.addWidget(self.count, 1)
        values.addWidget(self.length)
        level.addWidget(self.level, 1)
        level.addWidget(self.level_unit)
        rows: Sequence[tuple[str, QWidget | QHBoxLayout]] = (
            ("Every", self.every), ("Values", values), ("Start", self.begin), ("Axis", self.axis),
            ("Input", self.input), ("Channel", self.level_of), ("", self.edge), ("Level", level),
            ("Keep before", self.before),
        )  # fmt: skip
        for words, field in rows:
            form.addRow(words, field)
        waits = (When.MOTION, When.INPUT, When.LEVEL)
        self._only: dict[QWidget | QHBoxLayout, tuple[When, ...]] = {
            self.axis: (When.MOTION,), self.input: (When.INPUT,), self.level_of: (When.LEVEL,), level: (When.LEVEL,),
            self.edge: (When.INPUT, When.LEVEL), self.before: waits,
        }  # fmt: skip
        for field in self._only:  # what is never shown is never dressed
            form.setRowVisible(field, False)
        self._column.addLayout(form)
        self._column.addWidget(self.hint)
        self._column.addStretch(1)

    def _connect(self) -> None:
        for slot in self.slots:
            slot.changed.connect(self._follow)
        for box in self.derived.values():
            box.toggled.connect(self._follow)
        for chosen in (self.every, self.begin, self.edge, self.level_of):
            chosen.currentIndexChanged.connect(self._follow)
        self.axis.currentTextChanged.connect(self._want_axis)
        self.count.valueChanged.connect(self._want_count)
        self.input.valueChanged.connect(self._want_input)
        self.before.valueChanged.connect(self._follow)
        self.level.textChanged.connect(self._follow)

    def _want_axis(self, axis: str) -> None:
        self._axis = axis
        self._follow()

    def _want_count(self, count: int) -> None:
        self._count = count
        self._follow()

    def _want_input(self, number: int) -> None:
        self._input = number
        self._follow()


def _whole(found: Mapping[str, Any], name: str, low: int, high: int, else_: int) -> int:
    """A whole number of what was remembered, where it is one and fits."""
    number = found.get(name)
    fits = isinstance(number, int) and not isinstance(number, bool) and low <= number <= high
    return int(number) if fits else else_  # type: ignore[arg-type]
