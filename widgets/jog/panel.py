"""The jog panel: one axis, two on a line, two on an arc; it shows where everything ends before it starts."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, Qt, QTimer, Signal
from PySide6.QtGui import QHideEvent, QKeyEvent
from PySide6.QtWidgets import QHBoxLayout, QLabel, QPushButton, QStackedWidget, QVBoxLayout, QWidget

from device.api import Kind, State
from widgets.display.display import Column
from widgets.display.readings import unit_of
from widgets.panel import Panel, set_text, show_role
from widgets.parts.units import shown

if TYPE_CHECKING:
    from codegen.document import Document
    from codegen.setup import Setup
    from device.api import Controller, Row
    from device.jog import Places, Plan
    from widgets.jog.one_axis import OneAxisPage
    from widgets.jog.together import TogetherPage

RENEW_MS = 50  # safety.md 4
OFFLINE = "Nothing is connected. Connect a controller or start the simulator to move axes from here."
WATCHED = "This is Watch: switch to Control to move axes."
NOT_READY = "The controller does not answer at the moment."
PAGES = ("One axis", "Line", "Arc")
ARROWS = {Qt.Key.Key_Left: -1, Qt.Key.Key_Right: 1}
KEYS = "keys"


class JogPanel(Panel):
    """Asks by signals; whoever joins it to the controller answers with `show_result`."""

    title = "Jog"
    moves = True
    hold_wanted = Signal(str, int, int, int, str)  # axis, speed with sign, acceleration, deceleration, owner
    run_wanted = Signal(str, int, int, int, str)
    renewed = Signal(str)
    released = Signal(str)
    latch_wanted = Signal(bool)
    plan_wanted = Signal(object)
    zero_wanted = Signal(str)

    def __init__(self, parent: QWidget | None = None, clock: Callable[[], float] = time.monotonic) -> None:
        super().__init__(parent)
        self._clock = clock
        self._setup: Setup | None = None
        self._owner = ""  # who holds now
        self._ghost: dict[str, int] = {}
        self.one: OneAxisPage | None = None
        self.line: TogetherPage | None = None
        self.arc: TogetherPage | None = None
        self.pages, self.buttons = QStackedWidget(), [QPushButton(name) for name in PAGES]
        self.empty, self.result = QLabel(OFFLINE), QLabel()
        self._beat = QTimer(self, interval=RENEW_MS)
        self._beat.setTimerType(Qt.TimerType.PreciseTimer)
        self._beat.timeout.connect(self._renew)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self._lay_out()

    # ---- what it shows

    def attach(self, controller: Controller) -> None:
        self._let_go()
        super().attach(controller)
        self._fit()

    def show_document(self, old: Document | None, new: Document) -> None:
        if old is None or old.setup is not new.setup:
            self._let_go()
            self._setup = new.working_setup
            self._fit()

    def watches(self) -> tuple[str, ...]:
        return () if self.one is None else (f"position.{self.axis.lower()}", f"commanded.{self.axis.lower()}")

    @property
    def axis(self) -> str:
        """The axis of the first page."""
        return self.one.item.axis if self.one is not None else "X"

    @property
    def reason(self) -> str:
        """Why nothing may be moved now, or nothing."""
        controller = self.controller
        if controller is None or controller.kind is Kind.OFFLINE:
            return OFFLINE
        if controller.state is not State.READY:
            return NOT_READY
        return "" if controller.control else WATCHED

    def refresh(self, row: Row) -> None:
        self._fit()
        if self.one is None or self.controller is None:
            return
        now, key = self._clock(), f"position.{self.axis.lower()}"
        place = math.nan if row.stale(key, now) else row.value(key)
        motion = self.controller.motion
        self.one.show_place(place, float(motion.ghost.get(self.axis, math.nan)))
        self.one.show_usable(self.reason, motion.latch)
        for page in (self.line, self.arc):
            if page is not None:
                page.show_usable(self.reason)

    def show_result(self, sentence: str, good: bool = True) -> None:
        """How the last move by hand ended."""
        set_text(self.result, sentence)
        show_role(self.result, "quiet" if good else "problem")

    def ends_at(self, plan: Plan, places: Places) -> str:
        """Where a plan ends, in user units, as a sentence."""
        if self._setup is None or not plan.ends:
            return ""
        ends = []
        for letter, counts in plan.ghost(places).items():
            axis = self._setup.axis(letter)
            ends.append(f"{letter} {shown(counts, axis)} {unit_of(axis)}")
        return f"Ends at {', '.join(ends)}."

    def words(self) -> str:
        """What it says, as text."""
        return self.empty.text() if self.empty.isVisibleTo(self) else self.result.text()

    # ---- holding

    def _hold(self, owner: str, sign: int) -> None:
        if self.one is None or self.reason or self.one.problem:
            return
        pace = self.one.pace
        self._owner = owner
        self.hold_wanted.emit(self.axis, sign * pace.speed, pace.acceleration, pace.deceleration, owner)
        self._beat.start()

    def _run(self, sign: int) -> None:
        if sign == 0:
            self.released.emit("")
        elif self.one is not None and not self.reason and not self.one.problem:
            pace = self.one.pace
            self.run_wanted.emit(self.axis, sign * pace.speed, pace.acceleration, pace.deceleration, "panel")

    def _renew(self) -> None:
        if self._owner:
            self.renewed.emit(self._owner)

    def _released(self, owner: str) -> None:
        if owner == self._owner:
            self._let_go()

    def _let_go(self) -> None:
        """Whatever is held is let go."""
        self._beat.stop()
        owner, self._owner = self._owner, ""
        if owner:
            self.released.emit(owner)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Arrows hold, with Shift they go one increment; only while the panel itself has the focus."""
        sign = ARROWS.get(Qt.Key(event.key()))
        if sign is None or self.pages.currentIndex() != 0 or self.one is None:
            super().keyPressEvent(event)
        elif not event.isAutoRepeat() and event.modifiers() & Qt.KeyboardModifier.ShiftModifier:
            (self.one.forward if sign > 0 else self.one.back).click()
        elif not event.isAutoRepeat() and not self._owner:
            self._hold(KEYS, sign)

    def keyReleaseEvent(self, event: QKeyEvent) -> None:
        if Qt.Key(event.key()) in ARROWS and not event.isAutoRepeat():
            self._released(KEYS)
        else:
            super().keyReleaseEvent(event)

    def hideEvent(self, event: QHideEvent) -> None:
        super().hideEvent(event)
        self._let_go()

    def focusOutEvent(self, event: QEvent) -> None:
        self._released(KEYS)
        super().focusOutEvent(event)  # type: ignore[arg-type]

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() is QEvent.Type.ActivationChange and not self.isActiveWindow():
            self._let_go()

    # ---- arrangement

    def _fit(self) -> None:
        """Pages for the machine that is connected; made when first shown."""
        controller = self.controller
        linked = controller is not None and controller.kind is not Kind.OFFLINE and self._setup is not None
        if self.empty.isVisibleTo(self) == linked:
            self.empty.setVisible(not linked)
            self._area.setVisible(linked)
        if not linked or not self.isVisible() or self._setup is None or controller is None:
            return
        letters = controller.axes or self._setup.letters
        wanted = (self._setup, letters)
        if self.one is None:
            self._make_pages(self._setup)
        if wanted != self._fitted:
            self._fitted = wanted
            assert self.one is not None and self.line is not None and self.arc is not None
            self.one.show_setup(self._setup, letters)
            self.line.show_setup(self._setup)
            self.arc.show_setup(self._setup)
            for button in self.buttons[1:]:
                button.setVisible(len(letters) > 1)
            if len(letters) == 1:
                self._open(0)

    def _make_pages(self, setup: Setup) -> None:
        from codegen.by_hand import Arc, Line
        from widgets.jog import plans
        from widgets.jog.one_axis import OneAxisPage
        from widgets.jog.together import TogetherPage

        self.one = OneAxisPage(setup)
        self.line = TogetherPage(Line(), plans.line, setup)
        self.arc = TogetherPage(Arc(), plans.arc, setup)
        one = self.one
        one.hold_wanted.connect(self._hold)
        one.let_go.connect(self._released)
        one.run_wanted.connect(self._run)
        one.latch_wanted.connect(self.latch_wanted)
        one.zero_wanted.connect(self.zero_wanted)
        one.axis_changed.connect(self._let_go)
        for page in (one, self.line, self.arc):
            page.plan_wanted.connect(self.plan_wanted)
            self.pages.addWidget(page)
        for together in (self.line, self.arc):
            together.stop_wanted.connect(lambda: self.released.emit(""))

    def _open(self, index: int) -> None:
        self._let_go()
        self.pages.setCurrentIndex(index)
        for number, button in enumerate(self.buttons):
            button.setChecked(number == index)

    def _lay_out(self) -> None:
        self._fitted: tuple[Setup, str] | None = None
        outer = QVBoxLayout(self)
        outer.setContentsMargins(8, 4, 8, 4)
        self.empty.setWordWrap(True)
        self.empty.setProperty("role", "quiet")
        outer.addWidget(self.empty)
        inside = QWidget()
        self._area = Column(inside)
        self._area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self._area.hide()
        outer.addWidget(self._area, 1)
        column = QVBoxLayout(inside)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(8)
        row = QHBoxLayout()
        for index, button in enumerate(self.buttons):
            button.setCheckable(True)
            button.setChecked(index == 0)
            button.setProperty("role", "segment")
            button.clicked.connect(lambda _=False, index=index: self._open(index))
            row.addWidget(button)
        row.addStretch(1)
        column.addLayout(row)
        self.result.setWordWrap(True)
        self.result.setProperty("role", "quiet")
        column.addWidget(self.result)
        column.addWidget(self.pages)
        column.addStretch(1)
        outer.addStretch(0)
