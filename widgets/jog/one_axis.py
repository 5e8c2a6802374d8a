"""The page of one axis: increments, holding, a place to go to, home and zero."""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Callable, Iterator, Mapping
from functools import partial

from PySide6.QtCore import Signal
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from codegen.by_hand import OneAxis
from codegen.fields import Dimension
from codegen.numbers import plain
from codegen.setup import Setup
from device.jog import Places, Plan, Routine
from widgets.display.readings import unit_of
from widgets.form.fields_form import FieldsForm
from widgets.form.offers import Offers
from widgets.jog import plans
from widgets.jog.ends import OPEN, ends_words
from widgets.jog.hold import HoldButton
from widgets.jog.plans import Pace
from widgets.jog.speed import SpeedRow, round_number
from widgets.panel import set_text, show_role
from widgets.parts.axis_bar import AxisBar, Marks
from widgets.parts.look import look
from widgets.parts.pieces import Pieces, dressed
from widgets.parts.units import scale_of, shown

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
    speed_kept = Signal(str, str)  # slow, medium or fast; the speed

    def __init__(self, setup: Setup, parent: QWidget | None = None, at_once: bool = True) -> None:
        super().__init__(parent)
        self.item = beginning(setup, setup.letters[0])
        self._setup = setup
        self._letters = setup.letters
        self._unit = unit_of(setup.axis(self.item.axis))
        self._numbers: dict[str, OneAxis] = {}  # what was typed, by its unit
        self._reason = ""
        self.form = FieldsForm(Offers(setup), narrow=False, parent=self)
        self.form.edited.connect(self._edited)
        self.place, self.ghost = QLabel("–"), QLabel()
        self.travel, self.fast = AxisBar(self.item.axis), SpeedRow()
        self.ends, self.there = QLabel(), QLabel()
        self._told_for: object = None
        self.back, self.forward = QPushButton(), QPushButton()
        self.hold_back, self.hold_forward = HoldButton("◀◀  Hold"), HoldButton("Hold  ▶▶")
        self.latch = QCheckBox("Let it run on without holding")
        self.run_back, self.stop_run, self.run_forward = QPushButton("<<"), QPushButton("[ ]"), QPushButton(">>")
        self.go = QPushButton("Go to position")
        self.routine, self.home, self.zero = QComboBox(), QPushButton("Home"), QPushButton("Zero here")
        self.presets = [QPushButton(text) for text in INCREMENTS]
        self.making = Pieces(self._fill())
        if at_once:
            self.making.finish()

    def _fill(self) -> Iterator[None]:
        """In pieces."""
        self._lay_out()
        yield
        self._connect()
        yield
        yield from self.form.showing(self.item)
        self._edited(self.item)
        yield
        yield from dressed(self)

    # ---- what it shows

    def show_setup(self, setup: Setup, letters: str) -> None:
        """Another machine."""
        self._setup, self._letters = setup, letters or setup.letters
        self.item = self._in_its_unit(self.item.axis if self.item.axis in self._letters else self._letters[0])
        self.form.show_offers(Offers(setup))
        self.form.show_item(self.item)
        self._edited(self.item)

    def show_marks(self, marks: Marks, ghost: float) -> None:
        """Where the axis is, in its unit, and where it will stop (NaN: nothing moves by hand and none is looked at)."""
        axis, scale = self._setup.axis(self.item.axis), scale_of(self._setup.axis(self.item.axis))
        set_text(self.place, f"{self.item.axis}  {shown(marks.actual * scale, axis)} {unit_of(axis)}")
        ends = f"stops at {shown(ghost, axis)} {unit_of(axis)}" if math.isfinite(ghost) else ""
        set_text(self.ghost, ends)
        self.travel.show_axis(self.item.axis)
        self.travel.show_marks(dc.replace(marks, ghost=ghost / scale))

    def show_ends(self, places: Places) -> None:
        """Where increments and Go would end from here, and which limit they pass."""
        key = (self.item, places, self._setup, self._letters)
        if key == self._told_for:
            return
        self._told_for = key
        plans_now = [] if self.problem else [plans.by(self.item, self._setup, sign) for sign in (-1, 1)]
        told = [ends_words(plan, places, self._setup) for plan in plans_now]
        words = [f"{arrow} {text}" for arrow, (text, _) in zip("◀▶", told, strict=False)]
        missing = plans.missing(self.item.axis, self._letters)
        set_text(self.ends, missing or "\n".join(words))
        show_role(self.ends, "problem" if missing or any(passes for _, passes in told) else "quiet")
        going = self.plan_there()
        there, passes = ends_words(going, places, self._setup) if going is not None else ("", False)
        set_text(self.there, there)
        show_role(self.there, "problem" if passes else "quiet")

    def looked_at(self) -> Plan | None:
        """The planned move under the mouse, else the one with the focus; typing shows what is typed."""
        if self.problem:
            return None
        moves = (
            (self.back, partial(plans.by, self.item, self._setup, -1)),
            (self.forward, partial(plans.by, self.item, self._setup, 1)),
            (self.go, self.plan_there),
        )
        fields = {"place": self.plan_there, "distance": partial(plans.by, self.item, self._setup, 1)}
        for seen in (QWidget.underMouse, QWidget.hasFocus):
            for button, plan in moves:
                if seen(button):
                    return plan()
        name = self.form.typed_into()
        return fields[name]() if name in fields else None

    def plan_there(self) -> Plan | None:
        """To the place in the field, when there is one."""
        if self.problem or plans.problem_of(self.item, self._setup, NEEDS_PLACE):
            return None
        return plans.to(self.item, self._setup)

    def show_speeds(self, kept: Mapping[str, str]) -> None:
        """The three speeds kept for this axis."""
        self.fast.show_presets(kept)

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
        enable(self.zero, reason or plans.missing(self.item.axis, self._letters))
        for widget in (self.latch, self.stop_run):
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
        return plans.missing(self.item.axis, self._letters) or plans.problem_of(self.item, self._setup)

    @property
    def pace(self) -> Pace:
        return plans.pace_of(self.item, self._setup)

    # ---- inside

    def _in_its_unit(self, axis: str) -> OneAxis:
        """The page for this axis: a number never goes over into another unit; those typed in it before come back."""
        unit = unit_of(self._setup.axis(axis))
        if unit != self._unit:
            self._numbers[self._unit], self._unit = self.item, unit
            self.item = self._numbers.get(unit) or beginning(self._setup, axis)
        return dc.replace(self.item, axis=axis)

    def _edited(self, item: OneAxis) -> None:
        moved = item.axis != self.item.axis
        if moved and unit_of(self._setup.axis(item.axis)) != self._unit:
            item = self._in_its_unit(item.axis)
            self.form.show_item(item)
        self.item = item
        self.form.item = item
        unit = unit_of(self._setup.axis(item.axis))
        self.fast.show_speed(item.speed, float(self._setup.bounds(Dimension.SPEED, item.axis)[1]), unit)
        distance = item.distance.strip() or "?"
        self.back.setText(f"◀  −{distance} {unit}")
        self.forward.setText(f"+{distance} {unit}  ▶")
        self.show_usable(self._reason, self.latch.isChecked())
        if moved:
            self.hold_back.let_go()
            self.hold_forward.let_go()
            self.axis_changed.emit()

    def _set(self, **values: str) -> None:
        item = dc.replace(self.item, **values)
        self.form.show_item(item)
        self._edited(item)

    def _plan(self, make: Callable[[], Plan]) -> None:
        if not self._reason and not self.problem:
            self.plan_wanted.emit(make())

    def _increment(self, sign: int) -> None:
        self._plan(lambda: plans.by(self.item, self._setup, sign))

    def _go(self) -> None:
        if (plan := self.plan_there()) is not None:
            self._plan(lambda: plan)

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
        self.fast.chosen.connect(lambda text: self._set(speed=text))
        self.fast.kept.connect(self.speed_kept)
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
        for label in (self.ends, self.there):
            label.setWordWrap(True)
            label.setProperty("role", "quiet")
        column.addWidget(self.ends)
        self.latch.setProperty("role", "field")
        self.latch.setProperty(
            "hint", "A jog goes on until [ ], STOP or a limit. It is off at start and off again after STOP."
        )
        column.addWidget(self.latch)
        column.addWidget(self.fast)
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
        column.addWidget(self.there)
        homing = QHBoxLayout()
        self.routine.setAccessibleName("Way home")
        for routine, words in ROUTINES.items():
            self.routine.addItem(words, routine)
        homing.addWidget(self.routine, 1)
        self.home.setProperty("hint", OPEN)
        homing.addWidget(self.home)
        column.addLayout(homing)


def beginning(setup: Setup, axis: str) -> OneAxis:
    """Slow and short on any machine: about 2000 counts/s and 1000 counts, in round numbers of its unit."""
    scale = setup.axis(axis).scale
    return OneAxis(
        axis=axis,
        distance=plain(round_number(1000 / scale)),
        speed=plain(round_number(2000 / scale)),
        acceleration=plain(round_number(20_000 / scale)),
        deceleration=plain(round_number(20_000 / scale)),
    )


def enable(widget: QWidget, reason: str) -> None:
    """Grey with its reason, or usable."""
    if widget.isEnabled() == bool(reason):
        widget.setEnabled(not reason)
    words = reason or str(widget.property("hint") or "")
    if widget.toolTip() != words:
        widget.setToolTip(words)
