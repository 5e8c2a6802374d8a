"""The page of one axis: increments, holding, a place to go to, home and zero."""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Callable
from fractions import Fraction
from functools import partial

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QSlider,
    QVBoxLayout,
    QWidget,
)

from codegen.by_hand import OneAxis
from codegen.fields import Dimension
from codegen.numbers import parse_number, plain
from codegen.setup import Setup
from device.jog import Plan, Routine
from widgets.display.readings import unit_of
from widgets.form.fields_form import FieldsForm
from widgets.form.offers import Offers
from widgets.jog import plans
from widgets.jog.hold import HoldButton
from widgets.jog.plans import Pace
from widgets.jog.travel import TravelBar
from widgets.panel import set_text
from widgets.parts.look import look
from widgets.parts.units import shown

STEPS = 100  # of the speed slider; each is the same factor
SPAN = 100_000.0  # between the slowest and the fastest speed of the slider
INCREMENTS = ("0.01", "0.1", "1", "10")
ROUTINES = {
    Routine.HOME: "Home switch, then index (HM)",
    Routine.EDGE: "Edge of the home switch (FE)",
    Routine.INDEX: "Index pulse (FI)",
}
NEEDS_PLACE = ("place",)


class OneAxisPage(QWidget):
    """Emits plans and holds; knows nothing of the controller."""

    plan_wanted = Signal(object)  # Plan
    hold_wanted = Signal(str, int)  # owner, sign
    let_go = Signal(str)  # owner
    run_wanted = Signal(int)  # sign; 0 stops
    latch_wanted = Signal(bool)
    zero_wanted = Signal(str)  # axis
    axis_changed = Signal()

    def __init__(self, setup: Setup, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.item = beginning(setup)
        self._setup = setup
        self._letters = setup.letters
        self._reason = ""
        self.form = FieldsForm(Offers(setup), narrow=False)
        self.form.edited.connect(self._edited)
        self.place, self.ghost = QLabel("–"), QLabel()
        self.travel, self.slider = TravelBar(), QSlider(Qt.Orientation.Horizontal)
        self.back, self.forward = QPushButton(), QPushButton()
        self.hold_back, self.hold_forward = HoldButton("◀◀  Hold"), HoldButton("Hold  ▶▶")
        self.latch = QCheckBox("Let it run on without holding")
        self.run_back, self.stop_run, self.run_forward = QPushButton("<<"), QPushButton("[ ]"), QPushButton(">>")
        self.go = QPushButton("Go to position")
        self.routine, self.home, self.zero = QComboBox(), QPushButton("Home"), QPushButton("Zero here")
        self.presets = [QPushButton(text) for text in INCREMENTS]
        self._lay_out()
        self._connect()
        self.form.show_item(self.item)
        self._edited(self.item)

    # ---- what it shows

    def show_setup(self, setup: Setup, letters: str) -> None:
        """Another machine."""
        self._setup, self._letters = setup, letters or setup.letters
        if self.item.axis not in self._letters:
            self.item = dc.replace(self.item, axis=self._letters[0])
        self.form.show_offers(Offers(setup))
        self.form.show_item(self.item)
        self._edited(self.item)

    def show_place(self, counts: float, ghost: float) -> None:
        """Where the axis is, and where it will stop when it is let go now (NaN: nothing moves by hand)."""
        axis = self._setup.axis(self.item.axis)
        set_text(self.place, f"{self.item.axis}  {shown(counts, axis)} {unit_of(axis)}")
        set_text(self.ghost, f"stops at {shown(ghost, axis)} {unit_of(axis)}" if math.isfinite(ghost) else "")
        low, high = (_limit(text) for text in (axis.reverse_limit, axis.forward_limit))
        scale = float(axis.scale)
        self.travel.show_axis(self.item.axis, low, high, counts / scale, ghost / scale)

    def show_usable(self, reason: str, latched: bool) -> None:
        """Why nothing may be moved now, or nothing; and whether jogs may run on."""
        self._reason = reason
        wrong = reason or self.problem
        for button in (
            self.back,
            self.forward,
            self.hold_back,
            self.hold_forward,
            self.home,
            self.run_back,
            self.run_forward,
        ):
            enable(button, wrong)
        enable(self.go, wrong or plans.problem_of(self.item, self._setup, NEEDS_PLACE))
        for widget in (self.zero, self.latch, self.stop_run):
            enable(widget, reason)
        if self.latch.isChecked() != latched:
            self.latch.setChecked(latched)
        for button in (self.run_back, self.stop_run, self.run_forward):
            button.setVisible(latched)
        for button in (self.hold_back, self.hold_forward):
            button.setVisible(not latched)

    @property
    def problem(self) -> str:
        """What is wrong with the fields, or nothing."""
        return plans.problem_of(self.item, self._setup)

    @property
    def pace(self) -> Pace:
        return plans.pace_of(self.item, self._setup)

    # ---- inside

    def _edited(self, item: OneAxis) -> None:
        moved = item.axis != self.item.axis
        self.item = item
        self.form.item = item
        if not self.problem:
            self.slider.blockSignals(True)
            self.slider.setValue(self._notch(float(parse_number(item.speed) or 1)))
            self.slider.blockSignals(False)
        unit = unit_of(self._setup.axis(item.axis))
        distance = item.distance.strip() or "?"
        self.back.setText(f"◀  −{distance} {unit}")
        self.forward.setText(f"+{distance} {unit}  ▶")
        self.show_usable(self._reason, self.latch.isChecked())
        if moved:
            self.hold_back.let_go()
            self.hold_forward.let_go()
            self.axis_changed.emit()

    def _top(self) -> float:
        return float(self._setup.bounds(Dimension.SPEED, self.item.axis)[1])

    def _notch(self, speed: float) -> int:
        top = self._top()
        return round(STEPS * (1 + math.log(max(speed, 1e-12) / top) / math.log(SPAN))) if top > 0 else 0

    def _slid(self, notch: int) -> None:
        """The same factor for every notch; two figures are enough for a hand."""
        speed = self._top() * SPAN ** (notch / STEPS - 1)
        text = plain(Fraction(f"{speed:.2g}"))
        self._set(speed=text)

    def _set(self, **values: str) -> None:
        self.item = dc.replace(self.item, **values)
        self.form.show_item(self.item)
        self._edited(self.item)

    def _plan(self, make: Callable[[], Plan]) -> None:
        if not self._reason and not self.problem:
            self.plan_wanted.emit(make())

    def _increment(self, sign: int) -> None:
        self._plan(lambda: plans.by(self.item, self._setup, sign))

    def _go(self) -> None:
        if not plans.problem_of(self.item, self._setup, NEEDS_PLACE):
            self._plan(lambda: plans.to(self.item, self._setup))

    def _home(self) -> None:
        self._plan(lambda: plans.home(self.item, self._setup, self.routine.currentData()))

    def _connect(self) -> None:
        self.back.clicked.connect(partial(self._increment, -1))
        self.forward.clicked.connect(partial(self._increment, 1))
        for button, sign in ((self.hold_back, -1), (self.hold_forward, 1)):
            button.began.connect(partial(self.hold_wanted.emit, "mouse", sign))
            button.ended.connect(partial(self.let_go.emit, "mouse"))
        for plain_button, sign in ((self.run_back, -1), (self.stop_run, 0), (self.run_forward, 1)):
            plain_button.clicked.connect(partial(self.run_wanted.emit, sign))
        self.latch.clicked.connect(self.latch_wanted)
        self.go.clicked.connect(self._go)
        self.home.clicked.connect(self._home)
        self.zero.clicked.connect(lambda: self.zero_wanted.emit(self.item.axis))
        self.slider.valueChanged.connect(self._slid)
        for preset in self.presets:
            preset.clicked.connect(partial(self._set, distance=preset.text()))

    def _lay_out(self) -> None:
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(8)
        font = look().body_font()
        font.setPointSizeF(look().fonts["digits_points"] * 0.8)
        self.place.setFont(font)
        self.ghost.setProperty("role", "quiet")
        head = QHBoxLayout()
        head.addWidget(self.place, 1)
        head.addWidget(self.ghost)
        column.addLayout(head)
        column.addWidget(self.travel)
        grid = QGridLayout()
        grid.setSpacing(8)
        for button in (self.back, self.forward, self.run_back, self.stop_run, self.run_forward):
            button.setMinimumHeight(look().space["touch"])
        for row, pair in enumerate(((self.back, self.forward), (self.hold_back, self.hold_forward))):
            for place, button in zip((0, 3), pair, strict=True):
                grid.addWidget(button, row, place, 1, 3)
        for place, run in zip((0, 2, 4), (self.run_back, self.stop_run, self.run_forward), strict=True):
            grid.addWidget(run, 2, place, 1, 2)
        self.run_back.setAccessibleName("Run backward")
        self.stop_run.setAccessibleName("Stop running")
        self.run_forward.setAccessibleName("Run forward")
        column.addLayout(grid)
        self.latch.setProperty("role", "field")
        self.latch.setProperty(
            "hint", "A jog goes on until [ ], STOP or a limit. It is off at start and off again after STOP."
        )
        column.addWidget(self.latch)
        self.slider.setRange(0, STEPS)
        self.slider.setAccessibleName("Speed")
        self.slider.setToolTip("Speed, up to the top speed of the axis")
        fast = QHBoxLayout()
        fast.addWidget(QLabel("Speed"))
        fast.addWidget(self.slider, 1)
        column.addLayout(fast)
        small = QHBoxLayout()
        small.addWidget(QLabel("Increments"))
        for preset in self.presets:
            preset.setProperty("role", "segment")
            preset.setAccessibleName(f"Increment {preset.text()}")
            small.addWidget(preset)
        small.addStretch(1)
        column.addLayout(small)
        column.addWidget(self.form)
        last = QHBoxLayout()
        for widget in (self.go, self.zero):
            last.addWidget(widget)
        last.addStretch(1)
        column.addLayout(last)
        homing = QHBoxLayout()
        self.routine.setAccessibleName("Way home")
        for routine, words in ROUTINES.items():
            self.routine.addItem(words, routine)
        homing.addWidget(self.routine, 1)
        homing.addWidget(self.home)
        column.addLayout(homing)


def beginning(setup: Setup) -> OneAxis:
    """Slow and short on any machine: about 2000 counts/s and 1000 counts, in round numbers of its unit."""
    scale = setup.axis(setup.letters[0]).scale
    return OneAxis(
        axis=setup.letters[0],
        distance=plain(round_number(1000 / scale)),
        speed=plain(round_number(2000 / scale)),
        acceleration=plain(round_number(20_000 / scale)),
        deceleration=plain(round_number(20_000 / scale)),
    )


def round_number(number: Fraction) -> Fraction:
    """The next 1, 2 or 5 times a power of ten below."""
    power = Fraction(10) ** math.floor(math.log10(number))
    return max(power * step for step in (1, 2, 5) if power * step <= number)


def _limit(text: str) -> float:
    number = parse_number(text)
    return math.nan if number is None else float(number)


def enable(widget: QWidget, reason: str) -> None:
    """Grey with its reason, or usable."""
    if widget.isEnabled() == bool(reason):
        widget.setEnabled(not reason)
    words = reason or str(widget.property("hint") or "")
    if widget.toolTip() != words:
        widget.setToolTip(words)
