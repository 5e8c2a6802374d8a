"""The event list: what happened, when, where, why, and what to do next."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import (
    QAbstractItemView,
    QComboBox,
    QHeaderView,
    QLabel,
    QLineEdit,
    QPushButton,
    QTableWidget,
    QTableWidgetItem,
    QVBoxLayout,
    QWidget,
)

from device.api import Event, What
from widgets.display.readings import unit_of
from widgets.panel import Panel, set_text
from widgets.parts.icons import icon
from widgets.parts.units import shown
from widgets.parts.wrapping import WrappingRow

if TYPE_CHECKING:
    from codegen.document import Document
    from codegen.setup import Setup
    from device.api import EventList, Row

COLUMNS = ("Time", "What", "Where", "What happened", "Cause", "What to do next")
ALL = "Everything"
MOST = 1000  # rows shown; the search looks at all
AT_ONCE = 60  # rows that are made in one turn
SEARCH = 120  # px, its least width
EMPTY = "Nothing has happened yet. Faults, limits, program errors, resets, STOP, downloads and burns appear here."
NO_HIT = "No event has these words."
ICONS = {
    What.FAULT: ("problem", "fault"), What.LIMIT: ("limit", "warning"), What.STOPPED: ("wait", "text"),
    What.PROGRAM: ("problem", "fault"), What.REFUSED: ("problem", "warning"), What.RESET: ("refresh", "warning"),
    What.LOST: ("disconnect", "fault"), What.BACK: ("connect", "text"), What.STOP: ("stop", "stop"),
    What.DOWNLOAD: ("download", "text"), What.BURN: ("burn", "text"),
}  # fmt: skip
CODES, TROUBLE = "Error and stop codes", "Troubleshooting"
HELP_PAGES = {
    What.FAULT: CODES, What.LIMIT: CODES, What.STOPPED: CODES, What.PROGRAM: CODES, What.REFUSED: CODES,
    What.RESET: TROUBLE, What.LOST: TROUBLE, What.BACK: "Connecting", What.STOP: "STOP",
    What.DOWNLOAD: "Program window", What.BURN: "Program window",
}  # fmt: skip
ICON_COLUMN, WIDEST = 1, 300  # px of a column of text


class EventsPanel(Panel):
    """Newest first. It is handed the list once and looks at it with each tick while visible."""

    title = "Events"
    bundle_wanted = Signal()
    line_wanted = Signal(int)  # a line of the program in the controller
    help_wanted = Signal(str)  # page

    def __init__(
        self, parent: QWidget | None = None, local: Callable[[float], time.struct_time] = time.localtime
    ) -> None:
        super().__init__(parent)
        self._local = local
        self._events: EventList | None = None
        self._setup: Setup | None = None
        self._told: tuple[object, ...] = ()
        self.search, self.kind = QLineEdit(), QComboBox()
        self.bundle, self.words_, self.more = QPushButton("Service bundle…"), QLabel(EMPTY), QPushButton("More help")
        self.table = QTableWidget(0, len(COLUMNS))
        self.rows: tuple[Event, ...] = ()  # those in the table
        self._found: tuple[Event, ...] = ()  # those that are to be there, by and by
        self._lay_out()
        self.bundle.clicked.connect(self.bundle_wanted)
        self.more.clicked.connect(lambda: self.help_wanted.emit(self.help_page()))
        self.more.setEnabled(False)
        self.search.textChanged.connect(lambda _: self._fill())
        self.kind.currentIndexChanged.connect(lambda _: self._fill())
        self.table.cellDoubleClicked.connect(self._opened)
        self.table.currentCellChanged.connect(lambda row, *_: self._explain(row))

    def show_events(self, events: EventList) -> None:
        """The list that is shown from now on."""
        self._events = events

    def show_document(self, old: Document | None, new: Document) -> None:
        if old is None or old.setup is not new.setup:
            self._setup, self._told, self.rows = new.setup, (), ()  # places are told in its units

    def refresh(self, row: Row) -> None:
        self._fill_when_changed()
        if len(self.rows) < len(self._found):
            self._show_some()

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        self._fill_when_changed()

    def words(self) -> str:
        """What is shown, as text."""
        lines = []
        for row in range(self.table.rowCount()):
            cells = [self.table.item(row, column) for column in range(len(COLUMNS))]
            lines.append(" | ".join(cell.text() for cell in cells if cell is not None))
        return "\n".join(lines) or self.words_.text()

    # ---- inside

    def _fill_when_changed(self) -> None:
        if self._events is None:
            return
        told = (self._events.changes, self._events.problem)
        if told != self._told:
            self._told = told
            self._fill()

    def _fill(self) -> None:
        if self._events is None:
            return
        chosen = self.kind.currentData()
        found = self._events.search(self.search.text(), (chosen,) if chosen is not None else ())
        self._found = tuple(found[:MOST])
        self._make_room()
        self._show_some()
        count = f"{len(found)} of {len(self._events)} events" if len(found) < len(self._events) else ""
        words = self._events.problem or ((EMPTY if not len(self._events) else NO_HIT) if not found else count)
        set_text(self.words_, words)

    def _make_room(self) -> None:
        """New events come in above those that stand there already, which stay as they are, with their selection."""
        top = self.rows[0].number if self.rows else 0
        new = next((at for at, event in enumerate(self._found) if event.number == top), 0)
        if new > AT_ONCE:
            self.rows, new = (), 0
        for row in range(new):
            self.table.insertRow(row)
            self._show(row, self._found[row])
        self.rows = (*self._found[:new], *self.rows)

    def _show_some(self) -> None:
        """Rows that are not right yet, so many at once: a long list comes in a few ticks."""
        wrong = [at for at, event in enumerate(self._found) if at >= len(self.rows) or self.rows[at] is not event]
        now = wrong[:AT_ONCE]
        right = wrong[AT_ONCE] if len(wrong) > AT_ONCE else len(self._found)
        self.table.setRowCount(right)
        for row in now:
            self._show(row, self._found[row])
        self.rows = self._found[:right]

    def _show(self, row: int, event: Event) -> None:
        stamp = time.strftime("%d %b %H:%M:%S", self._local(event.at))
        texts = (stamp, str(event.what), self._where(event), event.text, event.cause, event.step)
        for column, text in enumerate(texts):
            item = self.table.item(row, column)
            if item is None:
                item = QTableWidgetItem()
                self.table.setItem(row, column, item)
            if item.text() != text:
                item.setText(text)
                item.setToolTip(text)
            if column == ICON_COLUMN:
                item.setIcon(icon(*ICONS[event.what]))

    def _where(self, event: Event) -> str:
        """The axis concerned, or else all of them, and the lines of the program."""
        parts = []
        for letter, place in ((event.axis, event.place),) if event.axis else event.places.items():
            if place is not None and self._setup is not None:
                axis = self._setup.axis(letter)
                parts.append(f"{letter} {shown(place, axis)} {unit_of(axis)}")
            else:
                parts.append(letter)
        for thread, line in event.lines:
            parts.append(f"line {line}" if thread is None else f"thread {thread} line {line}")
        return ", ".join(parts)

    def help_page(self) -> str:
        """The page of the selected event."""
        row = self.table.currentRow()
        return HELP_PAGES[self.rows[row].what] if 0 <= row < len(self.rows) else self.title

    def _explain(self, row: int) -> None:
        """Cause and next step of the selected event, also where its columns are out of sight."""
        self.more.setEnabled(0 <= row < len(self.rows))
        if 0 <= row < len(self.rows):
            event = self.rows[row]
            cause = f"Cause: {event.cause.removesuffix('.')}." if event.cause else ""
            step = f"Next: {event.step}" if event.step else ""
            words = " ".join(part for part in (cause, step) if part)
            set_text(self.words_, words or time.strftime("%A, %d %B %Y, %H:%M:%S", self._local(event.at)))

    def _opened(self, row: int, column: int) -> None:
        for _, line in self.rows[row].lines[:1]:
            self.line_wanted.emit(line)

    def _lay_out(self) -> None:
        column = QVBoxLayout(self)
        column.setContentsMargins(8, 4, 8, 4)
        self.search.setMinimumWidth(SEARCH)
        self.search.setPlaceholderText("Search")
        self.search.setAccessibleName("Search events")
        self.search.setClearButtonEnabled(True)
        self.kind.setAccessibleName("Sort of event")
        self.kind.addItem(ALL, None)
        for what in What:
            self.kind.addItem(f"{what[:1].upper()}{what[1:]}", what)  # “Operator STOP” stays so
        self.more.setToolTip("The help page of the selected event (F1)")
        self.bundle.setToolTip(
            "Events, traffic, program, setup, back-up, versions and a picture of the window in one file"
        )
        column.addLayout(WrappingRow(self.search, self.kind, self.more, self.bundle))
        self.table.setHorizontalHeaderLabels(list(COLUMNS))
        self.table.setAccessibleName("Events")
        self.table.verticalHeader().hide()
        self.table.setShowGrid(False)
        self.table.setTabKeyNavigation(False)
        self.table.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.table.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        header = self.table.horizontalHeader()
        header.setDefaultAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        header.setSectionResizeMode(QHeaderView.ResizeMode.Interactive)
        header.setStretchLastSection(True)
        for place, width in enumerate((150, 130, 140, WIDEST, WIDEST)):
            self.table.setColumnWidth(place, width)
        column.addWidget(self.table, 1)
        self.words_.setProperty("role", "quiet")
        self.words_.setWordWrap(True)
        column.addWidget(self.words_)
