"""What is captured: up to four channels, how often, how long, and what it begins with."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QIcon, QPainter, QPixmap
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QMenu,
    QSpinBox,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from codegen.models import Model
from codegen.numbers import number_problem, parse_number
from codegen.setup import Setup
from device.capture import (
    FEWEST,
    SLOWEST,
    Channel,
    Plan,
    Trigger,
    When,
    channels,
    most,
    objection,
    scale_of,
    shown_by,
)
from device.curves import Derived
from widgets.panel import set_text
from widgets.parts.look import look

NONE = "–"
SLOTS = 4
COLOURS = {"Blue": "axis_x", "Orange": "axis_y", "Green": "axis_z", "Purple": "axis_w", "Text": "text", "Grey": "quiet"}
WHENS = {
    When.NOW: "At once",
    When.MOTION: "Motion begins",
    When.INPUT: "Edge of input",
    When.LEVEL: "Level",
}
EDGES = {True: ("goes on", "rises above"), False: ("goes off", "falls below")}
USUAL = (Channel("position", "X"), Channel("commanded", "X"), Channel("error", "X"), Channel("torque", "X"))


class Slot(QWidget):
    """One channel: its colour and what it is."""

    changed = Signal()

    def __init__(self, number: int, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.number = number
        self.token = ""  # a colour the person chose; nothing: that of the axis
        self.what, self.pen = QComboBox(), QToolButton()
        self.what.setAccessibleName(f"Channel {number}")
        self.pen.setAccessibleName(f"Colour of channel {number}")
        self.pen.setToolTip("Colour of the curve")
        self.pen.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.pen.clicked.connect(self._ask_colour)
        self.what.currentIndexChanged.connect(self._chosen)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.addWidget(self.pen)
        row.addWidget(self.what, 1)

    @property
    def channel(self) -> Channel | None:
        found = self.what.currentData()
        return found if isinstance(found, Channel) else None

    @property
    def colour(self) -> str:
        """A token of the theme."""
        if self.token:
            return self.token
        channel = self.channel
        return f"axis_{channel.axis.lower()}" if channel is not None and channel.axis else "quiet"

    def offer(self, known: Sequence[Channel], choose: Channel | None) -> None:
        """The channels there are now; the chosen one stays where it can."""
        self.what.blockSignals(True)
        self.what.clear()
        self.what.addItem(NONE, None)
        for channel in known:
            self.what.addItem(channel.label, channel)
        self.what.setCurrentIndex(known.index(choose) + 1 if choose in known else 0)
        self.what.blockSignals(False)
        self.paint_pen()

    def paint_pen(self) -> None:
        picture = QPixmap(32, 32)
        picture.fill(Qt.GlobalColor.transparent)
        painter = QPainter(picture)
        painter.fillRect(3, 12, 26, 8, look().colour(self.colour))
        painter.end()
        self.pen.setIcon(QIcon(picture))

    def _chosen(self) -> None:
        self.paint_pen()
        self.changed.emit()

    def _ask_colour(self) -> None:
        menu = QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        menu.addAction("As the axis").triggered.connect(lambda: self.choose_colour(""))
        for name, token in COLOURS.items():
            menu.addAction(name).triggered.connect(lambda _=False, token=token: self.choose_colour(token))
        menu.popup(self.pen.mapToGlobal(self.pen.rect().bottomLeft()))

    def choose_colour(self, token: str) -> None:
        self.token = token
        self._chosen()


class Choices(QWidget):
    """The column of choices; `plan` is what they ask for, `problem` why it can not be done."""

    changed = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._model: Model | None = None
        self._setup: Setup | None = None
        self.slots = [Slot(number) for number in range(1, SLOTS + 1)]
        self.derived = {kind: QCheckBox(kind) for kind in Derived}
        self.every, self.count, self.begin = QComboBox(), QSpinBox(), QComboBox()
        self.length, self.hint = QLabel(), QLabel()
        self.axis, self.input, self.edge = QComboBox(), QSpinBox(), QComboBox()
        self.level_of, self.level, self.level_unit = QComboBox(), QLineEdit("0"), QLabel()
        self.before = QSpinBox()
        self._name_all()
        self._lay_out()
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
        """Why this can not be captured, as one sentence, or nothing."""
        if self._model is None:
            return "Which controller it is, is not known."
        if self.when is When.LEVEL and (words := number_problem(self.level.text())):
            return f"Level: {words}"
        return objection(self.plan, self._model)

    # ------------------------------------------------------------------- offered

    def show_machine(self, model: Model, setup: Setup | None) -> None:
        """What this controller records, in the units of this setup."""
        if model == self._model and setup is self._setup:
            return
        first = self._model is None
        self._model, self._setup = model, setup
        known = channels(model)
        several = model.recorded_channels
        for slot, usual in zip(self.slots, USUAL, strict=True):
            slot.setVisible(slot.number <= several)
            slot.offer(known, usual if first and slot.number <= min(several, 2) else slot.channel)
        self.axis.clear()
        self.axis.addItems(list(model.axes))
        self.input.setRange(1, model.inputs)
        self._follow()

    def _follow(self) -> None:
        """Everything that depends on something else."""
        when, several = self.when, max(1, len(self.channels))
        sample_s = float(self._setup.sample) / 1_024_000 if self._setup is not None else 1000 / 1_024_000
        for place in range(SLOWEST):
            every = 2 << place
            self.every.setItemText(place, f"{every} samples, {every * sample_s * 1000:.3g} ms")
        if self._model is not None:
            self.count.setRange(FEWEST, most(self._model, several))
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
        self.count.setValue(500)
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
        for box in (*(slot.what for slot in self.slots), self.every, self.begin, self.axis, self.edge, self.level_of):
            box.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
            box.setMinimumContentsLength(8)
        for kind, box in self.derived.items():
            box.setAccessibleName(f"Also show {kind.lower()}")
        self.hint.setWordWrap(True)
        self.length.setProperty("role", "quiet")
        self.level_unit.setProperty("role", "quiet")

    def _lay_out(self) -> None:
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 8, 0)
        column.setSpacing(4)
        for slot in self.slots:
            column.addWidget(slot)
        also = QVBoxLayout()
        also.setSpacing(0)
        for box in self.derived.values():
            also.addWidget(box)
        column.addLayout(also)
        form = self._form = QFormLayout()
        form.setContentsMargins(0, 4, 0, 0)
        form.setVerticalSpacing(4)
        form.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
        values, level = QHBoxLayout(), QHBoxLayout()
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
        column.addLayout(form)
        column.addWidget(self.hint)
        column.addStretch(1)

    def _connect(self) -> None:
        for slot in self.slots:
            slot.changed.connect(self._follow)
        for box in self.derived.values():
            box.toggled.connect(self._follow)
        for chosen in (self.every, self.begin, self.axis, self.edge, self.level_of):
            chosen.currentIndexChanged.connect(self._follow)
        for number in (self.count, self.input, self.before):
            number.valueChanged.connect(self._follow)
        self.level.textChanged.connect(self._follow)
