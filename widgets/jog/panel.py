"""The jog panel: one axis, two on a line or an arc, a stick, saved points; it shows where everything ends first."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, Qt, Signal
from PySide6.QtGui import QFocusEvent, QHideEvent, QKeyEvent
from PySide6.QtWidgets import QHBoxLayout, QLabel, QPushButton, QVBoxLayout, QWidget

from device.api import Kind
from widgets.display.display import Column
from widgets.display.readings import marks_of
from widgets.jog.arrows import ARROWS, MODIFIERS, WITH, ArrowLine
from widgets.jog.ends import ghost_of, places_of
from widgets.jog.hold import Holder
from widgets.jog.more_axes import MoreAxes
from widgets.jog.pages import ARC, LINE, NAMES, ONE, POINTS, STICK, Pages, row_of
from widgets.jog.speed import key_of, speeds_of
from widgets.jog.stack import Stack
from widgets.panel import Panel, set_text, show_role
from widgets.parts.axis_bar import Marks
from widgets.parts.pieces import Pieces, in_breaths

if TYPE_CHECKING:
    from codegen.document import Document
    from codegen.points import Point
    from codegen.setup import Setup
    from device.api import Controller, Row
    from widgets.jog.drive import DrivePage
    from widgets.jog.one_axis import OneAxisPage
    from widgets.jog.saved import SavedPage
    from widgets.jog.together import TogetherPage

OFFLINE = "Nothing is connected. Connect a controller or start the simulator to move axes from here."
WATCHED = "This is Watch: switch to Control to move axes."
KEYS, PAD = "keys", "pad"


class JogPanel(Panel):
    """Asks by signals; whoever joins it to the controller answers with `show_result`."""

    title = "Jog"
    moves = True
    hold_wanted = Signal(str, int, int, int, str)  # axis, speed with sign, acceleration, deceleration, owner
    drive_wanted = Signal(object, str)  # Drive, owner
    steered = Signal(object, str)  # Drive, owner
    run_wanted = Signal(str, int, int, int, str)
    renewed = Signal(str)
    released = Signal(str)
    latch_wanted = Signal(bool)
    plan_wanted = Signal(object)
    point_wanted = Signal(object)  # Plan to a saved point
    zero_wanted = Signal(str)
    speed_kept = Signal(str, str, str)  # axis with its unit; slow, medium or fast; the speed
    point_saved = Signal(str)
    point_renamed = Signal(str, str)
    point_deleted = Signal(str)

    def __init__(self, parent: QWidget | None = None, clock: Callable[[], float] = time.monotonic) -> None:
        super().__init__(parent)
        self._clock = clock
        self._setup: Setup | None = None
        self._letters = ""
        self._kept: Mapping[str, Mapping[str, str]] = {}
        self._points: tuple[Point, ...] = ()
        self._pad_words = ""
        self._leans: set[str] = set()  # sticks that are not in their middle
        self.preview: dict[str, int] = {}  # where the move that is looked at would end, counts
        self.ghost: Mapping[str, int] = {}
        self.holder = Holder(self)
        self.holder.renewed.connect(self.renewed)
        self.holder.released.connect(self.released)
        self._made = Pages(self)
        self._later = Pieces(in_breaths(self._made.others(lambda: self._setup)))
        self.pages, self.buttons = Stack(), [QPushButton(name) for name in NAMES]
        self.open_page = ONE
        self.empty, self.result, self.arrows = QLabel(OFFLINE), QLabel(), ArrowLine()
        self.halt, self.more = QPushButton("Stop this move"), MoreAxes()
        self.halt.setEnabled(False)  # until something moves
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self._lay_out()

    @property
    def one(self) -> OneAxisPage | None:
        """The pages, as far as they were opened."""
        return self._made.one

    @property
    def line(self) -> TogetherPage | None:
        return self._made.line

    @property
    def arc(self) -> TogetherPage | None:
        return self._made.arc

    @property
    def drive(self) -> DrivePage | None:
        return self._made.drive

    @property
    def saved(self) -> SavedPage | None:
        return self._made.saved

    # ---- what it shows

    def take(self, controller: Controller) -> None:
        self.holder.let_go()
        super().take(controller)

    def show_controller(self) -> None:
        self._fit()

    def show_document(self, old: Document | None, new: Document) -> None:
        if old is None or old.setup is not new.setup:
            self.holder.let_go()
            self._setup = new.working_setup
            self._fit()

    def watches(self) -> tuple[str, ...]:
        if self.one is None:
            return ()
        return tuple(f"{name}.{axis.lower()}" for axis in self._moved() for name in ("position", "commanded"))

    @property
    def axis(self) -> str:
        """The axis of the first page."""
        return self.one.item.axis if self.one is not None else "X"

    @property
    def reason(self) -> str:
        """Why nothing may be moved now, or nothing."""
        return self.no_control(OFFLINE, WATCHED)

    def refresh(self, row: Row) -> None:
        self._fit()
        if self.one is None or self.controller is None or self._setup is None:
            return
        now, reason = self._clock(), self.reason
        if reason:
            self.holder.let_go()
        key = f"position.{self.axis.lower()}"
        marks = Marks() if row.stale(key, now) else marks_of(row, self.axis, self._setup.axis(self.axis))
        places = places_of(row, self._moved(), self._setup, now)
        page = self.pages.currentWidget()
        looked_at = getattr(page, "looked_at", None)
        self.preview = {} if reason or looked_at is None else ghost_of(looked_at(), places)
        self.one.show_marks(marks, float(self.ghost.get(self.axis, math.nan)))
        for shows in (self.one, self.line, self.arc, self.saved):
            if shows is page and shows is not None:
                shows.show_ends(places)
        self._show_arrows()
        self._later.step()

    def _show_usable(self, controller: Controller) -> None:
        """Nothing that may not be moved now can be clicked, not for a moment."""
        reason, motion = self.reason, controller.motion
        if self.one is not None:
            self.one.show_usable(reason, motion.latch)
        for each in (self.line, self.arc, self.saved):
            if each is not None:
                each.show_usable(reason)
        if self.drive is not None:
            self.drive.show_usable(reason, motion.alone)
        self.halt.setEnabled(bool(motion.busy))

    def show_ghost(self, ghost: Mapping[str, int]) -> None:
        """Where axes will stop, counts: held, on their way, or looked at. Comes with every tick, seen or not."""
        self.ghost = ghost
        if not self.in_sight:  # a dock behind another one is not hidden for Qt
            self.preview = {}
            self.holder.let_go()

    def show_result(self, sentence: str, good: bool = True) -> None:
        """How the last move by hand ended."""
        set_text(self.result, sentence)
        show_role(self.result, "quiet" if good else "problem")

    def show_speeds(self, kept: Mapping[str, Mapping[str, str]]) -> None:
        """The speeds that were kept, by axis and unit."""
        self._kept = kept
        self._show_kept()

    def show_points(self, points: Sequence[Point]) -> None:
        """The saved points of this machine."""
        self._points = tuple(points)
        if self.saved is not None:
            self.saved.show_points(self._points)

    def show_pad(self, words: str) -> None:
        """What is to be said of the gamepad; nothing while one can be used."""
        self._pad_words = words
        if self.drive is not None:
            self.drive.show_pad(words)

    def words(self) -> str:
        """What it says, as text."""
        return self.empty.text() if self.empty.isVisibleTo(self) else self.result.text()

    def _moved(self) -> str:
        """The axes that the open page moves."""
        page = self.open_page
        together = {LINE: self.line, ARC: self.arc}.get(page)
        if together is not None:
            return "".join(letter for letter in together.item.axes if letter in self._letters)
        if page == STICK and self.drive is not None:
            return "".join(self.drive.axes)
        return self._letters if page == POINTS else self.axis

    # ---- holding

    def hold(self, owner: str, sign: int) -> None:
        """Begins to move the axis of the first page while somebody holds."""
        if self.one is None or self.reason or self.one.problem or not self.holder.begin(owner):
            return
        pace = self.one.pace
        self.hold_wanted.emit(self.axis, sign * pace.speed, pace.acceleration, pace.deceleration, owner)

    def run(self, sign: int) -> None:
        """A latched jog; 0 ends it."""
        if sign == 0:
            self.released.emit("")
        elif self.one is not None and not self.reason and not self.one.problem:
            pace = self.one.pace
            self.run_wanted.emit(self.axis, sign * pace.speed, pace.acceleration, pace.deceleration, "panel")

    def lean(self, owner: str, across: float, upward: float) -> None:
        """A stick stands here; one that was refused or whose hold ended has to go through its middle first."""
        if self.drive is None:
            return
        middle = across == 0 and upward == 0
        if middle:
            self._leans.discard(owner)
            self.holder.let_go(owner)
        elif self.holder.owner == owner:
            self.steered.emit(self.drive.drive_at(across, upward), owner)
        elif owner not in self._leans:
            self._leans.add(owner)
            drive = self.drive.drive_at(across, upward)
            if self._drives() and any(drive.speeds.values()) and self.holder.begin(owner):
                self.drive_wanted.emit(drive, owner)

    def pad_moved(self, across: float, upward: float) -> None:
        """A gamepad whose dead-man button is down stands here."""
        self.lean(PAD, across, upward)

    def pad_pressed(self, button: int) -> None:
        """No other button of a pad does anything here."""

    @property
    def pad_wanted(self) -> bool:
        """Whether a gamepad may move something: only on the page of the stick, in the window in front."""
        return self.open_page == STICK and self.in_sight and self.isActiveWindow()

    def _drives(self) -> bool:
        return not self.reason and self.open_page == STICK and self.in_sight

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Arrows hold, with Shift they go one increment; only while the panel itself has the focus."""
        key = Qt.Key(event.key())
        sign = ARROWS.get(key)
        if self.holder.owner == KEYS and not event.isAutoRepeat():  # another key: it is not clear what is meant
            self.holder.let_go()
        elif sign is None or self.open_page != ONE or self.one is None:
            super().keyPressEvent(event)
        elif not event.isAutoRepeat():
            pressed = event.modifiers() & WITH
            if pressed == Qt.KeyboardModifier.ShiftModifier:
                (self.one.forward if sign > 0 else self.one.back).click()
            elif not pressed and not self.one.latch.isChecked():
                self.hold(KEYS, sign)

    def keyReleaseEvent(self, event: QKeyEvent) -> None:
        key = Qt.Key(event.key())
        if (key in ARROWS or key in MODIFIERS) and not event.isAutoRepeat():
            self.holder.let_go(KEYS)
        else:
            super().keyReleaseEvent(event)

    def hideEvent(self, event: QHideEvent) -> None:
        super().hideEvent(event)
        self.holder.let_go()
        self.preview = {}

    def focusInEvent(self, event: QFocusEvent) -> None:
        super().focusInEvent(event)
        self._show_arrows()

    def focusOutEvent(self, event: QFocusEvent) -> None:
        self.holder.let_go(KEYS)
        super().focusOutEvent(event)
        self._show_arrows()

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() is QEvent.Type.ActivationChange and not self.isActiveWindow():
            self.holder.let_go()

    def _show_arrows(self) -> None:
        """Whether the arrow keys move something now."""
        self.arrows.show_on(self.hasFocus() and not self.reason, self.axis)
        self.arrows.setVisible(self.open_page == ONE)

    # ---- arrangement

    def pieces(self) -> Iterator[None]:
        """The page that is open at first; it is arranged with the tick after."""
        if self._setup is not None:
            yield from in_breaths(self._made.making(self.open_page, self._setup))
            yield self._arrange(self._made.page(self.open_page, self._setup))

    def _fit(self) -> None:
        """The open page for the machine that is connected; made when it is seen, whatever is connected."""
        controller = self.controller
        linked = controller is not None and controller.kind is not Kind.OFFLINE and self._setup is not None
        if self.empty.isVisibleTo(self) == linked:
            self.empty.setVisible(not linked)
            self._area.setVisible(linked)
            self._foot.setVisible(linked)
        if controller is None or self._setup is None or not self.in_sight or not self.making.done:
            return
        page = self._made.page(self.open_page, self._setup)
        if self.pages.currentWidget() is not page:
            if self.pages.indexOf(page) < 0:
                self.pages.addWidget(page)
            self.pages.setCurrentWidget(page)
            self.pages.updateGeometry()
        self._arrange(page)
        self._show_usable(controller)

    def _arrange(self, page: QWidget) -> None:
        setup, linked = self._setup, self.controller is not None and self.controller.kind is not Kind.OFFLINE
        letters = (self.controller and self.controller.axes) or (setup.letters if setup else "")
        if not linked or setup is None or (setup, letters) == self._fitted.get(page):
            return
        self._fitted[page] = setup, letters
        self.more.show_axes(setup, letters)
        self._letters = letters = "".join(letter for letter in letters if letter in setup.letters)
        page.show_setup(setup, letters)  # type: ignore[attr-defined]
        self._show_kept()
        if page is self.saved:
            self.saved.show_points(self._points)
        if self.drive is not None:
            self.drive.show_pad(self._pad_words)
        for button in (self.buttons[LINE], self.buttons[ARC]):
            button.setVisible(len(letters) > 1)
        if len(letters) == 1 and self.open_page in (LINE, ARC):
            self._open(ONE)

    def _show_kept(self) -> None:
        if (setup := self._setup) is None:
            return
        speeds = {each: speeds_of(each, setup, self._kept) for each in self._letters or setup.letters}
        if self.one is not None:
            self.one.show_speeds(speeds.get(self.axis, {}))
        for page in (self.drive, self.saved):
            if page is not None:
                page.show_speeds(speeds)

    def keep_speed(self, name: str, text: str) -> None:
        """The speed of the first page under a name, for its axis."""
        if self._setup is not None:
            self.speed_kept.emit(key_of(self.axis, self._setup), name, text)

    def another_axis(self) -> None:
        """The first page moves another axis from now on."""
        self.holder.let_go()
        self._show_kept()

    def _open(self, index: int) -> None:
        self.holder.let_go()
        self.open_page = index
        for number, button in enumerate(self.buttons):
            button.setChecked(number == index)
        self._fit()

    def _lay_out(self) -> None:
        self._fitted: dict[QWidget, tuple[Setup, str]] = {}
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
        column.addWidget(self.more)
        column.addLayout(row_of(self.buttons, self._open))
        self.result.setWordWrap(True)
        self.result.setProperty("role", "quiet")
        self.result.setMinimumHeight(2 * self.fontMetrics().height())  # what is below does not jump
        column.addWidget(self.arrows)
        column.addWidget(self.pages)
        column.addStretch(1)
        self._foot = QWidget()
        foot = QHBoxLayout(self._foot)
        foot.setContentsMargins(0, 0, 0, 0)
        foot.addWidget(self.result, 1)
        foot.addWidget(self.halt)
        self.halt.clicked.connect(lambda: self.released.emit(""))
        self._foot.hide()
        outer.addWidget(self._foot)
        outer.addStretch(0)
