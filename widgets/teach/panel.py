"""The teach panel: drive two axes by a stick, record where they are, edit the table, play it back."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, Qt, Signal
from PySide6.QtGui import QHideEvent
from PySide6.QtWidgets import QLabel, QVBoxLayout, QWidget

from codegen.teach import Table
from codegen.teach_drive import Driving, dead_band, share_of
from device.api import NoticeKind
from device.jog import deflection
from widgets.display.display import Column
from widgets.display.readings import unit_of
from widgets.panel import Panel, set_text, show_role
from widgets.parts.pieces import in_breaths
from widgets.parts.units import shown

if TYPE_CHECKING:
    from codegen.document import Document
    from codegen.setup import Setup
    from codegen.teach import Wrong
    from device.api import Controller, Notice, Row
    from widgets.teach.parts import Parts

OFFLINE = "Nothing is connected. Connect a controller or start the simulator to teach places; the table works without."
WATCHED = "This is Watch: switch to Control to drive and to play back."
ONE_AXIS = "Teaching needs two axes; this controller has one."
JOYSTICK, SCREEN, PAD = "joystick", "stick", "pad"
SOURCES = {JOYSTICK: "Joystick", SCREEN: "On-screen stick", PAD: "Gamepad"}
PLACES = ("commanded.x", "commanded.y")
SHOWN = ("position.x", "position.y")
ENDS = {
    NoticeKind.STOP: "STOP was pressed",
    NoticeKind.LOST: "the connection was lost",
    NoticeKind.RESTARTED: "the controller was restarted",
}
VOLTS = ("analog1", "analog2")


OLDEST_S = 0.7  # of a reading that may drive or record; a slow line brings two in a second


def is_fresh(row: Row, key: str, now: float) -> bool:
    """Whether a reading is new enough to act on."""
    return now - row.time(key) <= OLDEST_S


class TeachPanel(Panel):
    """Asks by signals; whoever joins it owns the table and hands it back."""

    title = "Teach"
    moves = True
    enable_wanted = Signal(bool)
    driving_changed = Signal(object)
    record_wanted = Signal()
    way_wanted = Signal(bool)
    wait_added = Signal(str)
    output_added = Signal(str)
    done_wanted = Signal()
    cell_typed = Signal(int, str, str)
    rows_wanted = Signal(str, object, object)  # insert, delete, clear, pace, undo, redo; rows; cells
    play_wanted = Signal(bool)  # step by step
    next_wanted = Signal()
    halt_wanted = Signal()
    file_wanted = Signal(str)  # new, open, save, module
    io_control_wanted = Signal(bool)
    way_chosen = Signal(str, int)  # what it is driven with, how it is played back
    made = Signal()  # its parts are there now

    def __init__(self, parent: QWidget | None = None, clock: Callable[[], float] = time.monotonic) -> None:
        super().__init__(parent)
        self._clock = clock
        self.setup: Setup | None = None
        self.driving = Driving()
        self.table = Table()
        self.wrong: tuple[Wrong, ...] = ()
        self.undo = False  # whether there is a change to take back
        self.enabled = False
        self._pad, self._pad_words = (0.0, 0.0), ""
        self.volts = (math.nan, math.nan)
        self.parts: Parts | None = None
        self.empty, self.result = QLabel(OFFLINE), QLabel()
        self._lay_out()

    # ---- what it shows

    def take(self, controller: Controller) -> None:
        self.ended("")
        super().take(controller)

    def show_controller(self) -> None:
        self._show_usable()

    def show_document(self, old: Document | None, new: Document) -> None:
        if old is None or old.setup is not new.setup:
            self.ended("")
            self.setup = new.working_setup
            self._show()

    def watches(self) -> tuple[str, ...]:
        if self.parts is None:
            return ()
        way = PLACES if self.way else ()
        return (*SHOWN, *way, *(VOLTS if self.source == JOYSTICK else ()), *(("inputs",) if self.enabled else ()))

    @property
    def source(self) -> str:
        """What it is driven with."""
        return str(self.parts.source.currentData()) if self.parts is not None else SCREEN

    @property
    def reason(self) -> str:
        """Why nothing may be driven or played back now, or nothing."""
        why = self.no_control(OFFLINE, WATCHED)
        if why not in ("", WATCHED) or self.controller is None:
            return why
        one = len(self.controller.axes) == 1 or (self.setup is not None and len(self.setup.letters) == 1)
        return ONE_AXIS if one else why

    @property
    def way(self) -> bool:
        """Whether the whole way is recorded."""
        return self.parts is not None and self.parts.way.isChecked()

    @property
    def problem(self) -> str:
        """What is wrong with the numbers in the fields, or nothing."""
        return (self.parts.of_stick.problem or self.parts.of_rows.problem) if self.parts is not None else ""

    @property
    def pushed(self) -> tuple[float, float]:
        """How far the stick that is used is pushed, behind its dead band; NaN where that is not known."""
        if self.source == SCREEN:
            return self.parts.stick.value if self.parts is not None else (0.0, 0.0)
        if self.source == PAD:
            return self._pad
        if not all(map(math.isfinite, self.volts)):
            return math.nan, math.nan
        across, upward = (share_of(volts, self.driving) for volts in self.volts)
        return deflection(across, upward, dead_band(self.driving))

    def refresh(self, row: Row) -> None:
        now = self._clock()
        self.volts = tuple(row.value(key) if is_fresh(row, key, now) else math.nan for key in VOLTS)  # type: ignore[assignment]
        if self.enabled and self.reason:
            self.ended(self.reason)
        self._show_usable()
        if self.parts is None or self.setup is None:
            return
        places = []
        for letter, key in zip("XY", SHOWN, strict=True):
            axis = self.setup.axis(letter)
            counts = math.nan if row.stale(key, now) else row.value(key)
            places.append(f"{letter} {shown(counts, axis)} {unit_of(axis)}")
        set_text(self.parts.place, "    ".join((*places, self._stick_words())))

    def _stick_words(self) -> str:
        if self.source == PAD:
            return self._pad_words
        across, upward = self.pushed
        if self.source == SCREEN or not math.isfinite(across):
            return ""
        return f"joystick {across * 100:.0f} %, {upward * 100:.0f} %"

    def notice(self, notice: Notice) -> None:
        """STOP, a lost line, another controller behind it."""
        if why := ENDS.get(notice.kind):
            self.ended(f"Driving ended: {why}.")

    def show_table(self, table: Table, wrong: tuple[Wrong, ...], undo: bool = False) -> None:
        """The rows as they are now, what is wrong with them, and whether there is a change to take back."""
        self.table, self.wrong, self.undo = table, wrong, undo
        self._show()

    def show_driving(self, driving: Driving) -> None:
        """Speeds, dead band, tolerance."""
        self.driving = driving
        self._show()

    def choose_way(self, source: str, how: int) -> None:
        """What it is driven with and how it is played back, as far as there is such a choice."""
        if self.parts is not None:
            for box, place in ((self.parts.source, self.parts.source.findData(source)), (self.parts.how, how)):
                if 0 <= place < box.count():
                    box.setCurrentIndex(place)

    def show_enabled(self, on: bool) -> None:
        """Whether the stick drives."""
        self.enabled = on
        if self.parts is not None:
            self.parts.show_enabled(on)

    def show_way(self, on: bool) -> None:
        """Whether the whole way is recorded."""
        if self.parts is not None:
            self.parts.way.setChecked(on)

    def show_play(self, playing: bool, row: int, words: str, holds: bool) -> None:
        """A play-back on its way: its row (below 0: none), what it does, whether it waits for a step."""
        if self.parts is not None:
            self.parts.show_play(playing, row, holds)
        if playing and words:
            self.show_result(words)

    def show_result(self, sentence: str, good: bool = True) -> None:
        """How the last thing ended."""
        set_text(self.result, sentence)
        show_role(self.result, "quiet" if good else "problem")

    def words(self) -> str:
        """What it says, as text."""
        return self.empty.text() if self.empty.isVisibleTo(self) else self.result.text()

    # ---- a gamepad (app/pads.py)

    @property
    def pad_wanted(self) -> bool:
        """Whether the pad drives here."""
        return self.enabled and self.source == PAD and self.in_sight

    def pad_dead(self) -> float:
        """The dead band of its stick, a share of the way."""
        return dead_band(self.driving)

    def pad_moved(self, across: float, upward: float) -> None:
        self._pad = across, upward

    def pad_pressed(self, button: int) -> None:
        """The first button records."""
        if button == 0 and self.enabled:
            self.record_wanted.emit()

    def show_pad(self, words: str) -> None:
        self._pad_words = words

    # ---- ends

    def has_keyboard(self, focus: QWidget | None) -> bool:
        """Whether keys go to this panel or to one of its small windows: a wait is added while the stick drives on."""
        return focus is None or focus is self or self.isAncestorOf(focus) or focus.window() in self._entries

    @property
    def _entries(self) -> list[QWidget]:
        """The small windows that are open."""
        return self.findChildren(QWidget, "entry")

    def ended(self, why: str) -> None:
        """The stick drives no more."""
        if self.enabled:
            self.enable_wanted.emit(False)
            self.show_result(why)

    def hideEvent(self, event: QHideEvent) -> None:
        super().hideEvent(event)
        self.ended("Driving ended: the panel was hidden.")

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() is QEvent.Type.ActivationChange and not self._in_front():
            self.ended("Driving ended: another window came to the front.")

    def _in_front(self) -> bool:
        """This window, or one of the small ones of this panel."""
        return self.isActiveWindow() or any(each.isActiveWindow() for each in self._entries)

    # ---- inside

    def pieces(self) -> Iterator[None]:
        """Everything but its words, as the picture takes a while to load and to make."""
        from widgets.teach.parts import Parts

        parts = Parts(self, self._inside)
        yield from in_breaths(parts.pieces())
        yield
        self.parts = parts
        self._show()
        self.made.emit()
        yield
        self._show_usable()
        self._column.insertWidget(2, parts, 1)
        parts.show()

    def _show(self) -> None:
        if self.parts is not None and self.setup is not None:
            self.parts.show_all(self.table, self.setup, self.wrong, self.driving)

    def _show_usable(self) -> None:
        reason = self.reason
        set_text(self.empty, reason)
        self.empty.setVisible(bool(reason))
        if self.parts is not None:
            controller = self.controller
            self.parts.show_usable(reason, controller is not None and controller.io_control)

    def _lay_out(self) -> None:
        inside = self._inside = QWidget()
        self._area = Column(inside)
        self._area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        outer = QVBoxLayout(self)
        outer.setContentsMargins(0, 0, 0, 0)
        outer.addWidget(self._area)
        self._column = QVBoxLayout(inside)
        self._column.setContentsMargins(8, 4, 8, 4)
        self._column.setSpacing(6)
        for label in (self.empty, self.result):
            label.setWordWrap(True)
            label.setProperty("role", "quiet")
            self._column.addWidget(label)
        self.result.setMinimumHeight(self.result.fontMetrics().height())  # nothing moves when it is said
