"""The recorder: how much is kept, opening and saving recordings, and the hand on one that is played."""

from __future__ import annotations

import time
from bisect import bisect_right
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QAbstractItemView,
    QComboBox,
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QLineEdit,
    QPushButton,
    QSlider,
    QTableWidget,
    QTableWidgetItem,
    QVBoxLayout,
    QWidget,
)

from widgets.panel import Panel, set_text, show_role
from widgets.parts.icons import icon
from widgets.parts.wrapping import WrappingRow

COLUMNS = ("Time", "Who", "What happened")
SPEEDS = (0.5, 1.0, 2.0, 5.0, 20.0)
MOST, SEARCH = 1000, 160  # rows shown, the newest ones; least width of the search, px
STEP = 10  # of the slider, in a second
SECOND, PAGE = 1, 10  # s: a key, a page
EMPTY = (
    "Everything that goes over the line is recorded all the time, with what you do here and what happened. "
    "Replay it to see what came before a fault, or send it with a service bundle."
)


@dataclass(frozen=True, slots=True)
class Happening:
    """Something that happened in a recording; `place` is in seconds from its beginning, `at` the time of day."""

    place: float
    at: float
    who: str
    text: str
    capture: bool = False  # that can be looked at


def clock_words(seconds: float) -> str:
    """`0:12:03`."""
    whole = int(seconds)
    return f"{whole // 3600}:{whole // 60 % 60:02d}:{whole % 60:02d}"


class RecorderPanel(Panel):
    """Emits what the person wants; is told what is recorded, or where the replay is."""

    title = "Recorder"
    open_wanted = Signal()
    save_wanted = Signal()
    replay_wanted = Signal()
    leave_wanted = Signal()
    play_wanted = Signal(bool)
    speed_wanted = Signal(float)
    place_wanted = Signal(float)  # seconds from the beginning
    capture_wanted = Signal(float)  # the one that was made there

    def __init__(
        self, parent: QWidget | None = None, local: Callable[[float], time.struct_time] = time.localtime
    ) -> None:
        super().__init__(parent)
        self._local = local
        self.state, self.problem = QLabel(EMPTY), QLabel()
        self.replay, self.open = QPushButton("Replay what was recorded"), QPushButton("Open…")
        self.save, self.leave = QPushButton("Save recording…"), QPushButton("End replay")
        self.play, self.slider, self.where = QPushButton("Pause"), QSlider(Qt.Orientation.Horizontal), QLabel()
        self.speed, self.search = QComboBox(), QLineEdit()
        self.table = QTableWidget(0, len(COLUMNS))
        self.rows: tuple[Happening, ...] = ()
        self._happenings: tuple[Happening, ...] = ()
        self._playing = True
        self.bar = QWidget()
        self._lay_out()
        self.show_recorded("")
        self.open.clicked.connect(self.open_wanted)
        self.save.clicked.connect(self.save_wanted)
        self.replay.clicked.connect(self.replay_wanted)
        self.leave.clicked.connect(self.leave_wanted)
        self.play.clicked.connect(lambda: self.play_wanted.emit(not self._playing))
        self.speed.activated.connect(lambda _: self.speed_wanted.emit(self.speed.currentData()))
        self.slider.valueChanged.connect(lambda value: self.place_wanted.emit(value / STEP))
        self.search.textChanged.connect(lambda _: self._fill())
        self.table.cellActivated.connect(lambda row, _: self._go_to(self.rows[row]))

    # -------------------------------------------------------------- being told

    def show_recorded(self, words: str, problem: str = "") -> None:
        """Nothing is played: what is kept."""
        self._arrange(False)
        set_text(self.state, words or EMPTY)
        self._complain(problem)

    def show_recording(self, name: str, length: float, happenings: Sequence[Happening], problem: str = "") -> None:
        """This recording is played from now on."""
        self._happenings = tuple(happenings)
        self.slider.blockSignals(True)
        self.slider.setRange(0, max(round(length * STEP), 1))
        self.slider.blockSignals(False)
        set_text(self.state, f"Replay of {name}. Nothing can be sent, and there is nothing to stop.")
        self._complain(problem)
        self._arrange(True)
        self._fill()

    def show_place(self, place: float, at: float, length: float, playing: bool, speed: float) -> None:
        """Where the replay is; called with each tick."""
        stamp = time.strftime("%d %b %Y %H:%M:%S", self._local(at))
        set_text(self.where, f"{stamp}   {clock_words(place)} of {clock_words(length)}")
        if not self.slider.isSliderDown() and self.slider.value() != round(place * STEP):
            self.slider.blockSignals(True)
            self.slider.setValue(round(place * STEP))
            self.slider.blockSignals(False)
        if playing != self._playing or self.play.icon().isNull():
            self._playing = playing
            self.play.setText("Pause" if playing else "Play")
            self.play.setIcon(icon("pause" if playing else "play"))
        index = self.speed.findData(speed)
        if index != self.speed.currentIndex():
            self.speed.setCurrentIndex(index)
        self._follow(place)

    def words(self) -> str:
        """What is shown, as text."""
        lines = []
        for row in range(self.table.rowCount()):
            cells = [self.table.item(row, column) for column in range(len(COLUMNS))]
            lines.append(" | ".join(cell.text() for cell in cells if cell is not None))
        return "\n".join([self.state.text(), *lines])

    # ----------------------------------------------------------------- inside

    def _arrange(self, replay: bool) -> None:
        for widget in (self.bar, self.where, self.search, self.table, self.leave):
            widget.setVisible(replay)
        self.replay.setVisible(not replay)
        self.save.setVisible(not replay)

    def _complain(self, problem: str) -> None:
        set_text(self.problem, problem)
        self.problem.setVisible(bool(problem))

    def _fill(self) -> None:
        words = self.search.text().casefold().split()
        found = [
            each for each in self._happenings if all(word in f"{each.who} {each.text}".casefold() for word in words)
        ]
        self.rows = tuple(found[-MOST:])
        self.table.setRowCount(len(self.rows))
        for number, each in enumerate(self.rows):
            stamp = time.strftime("%d %b %H:%M:%S", self._local(each.at))
            for column, text in enumerate((stamp, each.who, each.text)):
                item = self.table.item(number, column)
                if item is None:
                    item = QTableWidgetItem()
                    self.table.setItem(number, column, item)
                item.setText(text)
                item.setToolTip(text)

    def _go_to(self, row: Happening) -> None:
        """A row that was chosen: from there on, and what was captured there."""
        self.place_wanted.emit(row.place)
        if row.capture:
            self.capture_wanted.emit(row.place)

    def _follow(self, place: float) -> None:
        """The row of what happened last is the selected one, unless somebody looks through the list."""
        row = bisect_right(self.rows, place, key=lambda each: each.place) - 1
        if row != self.table.currentRow() and not self.table.hasFocus():
            self.table.setCurrentCell(row, 0)

    def _lay_out(self) -> None:
        column = QVBoxLayout(self)
        column.setContentsMargins(8, 4, 8, 4)
        self.state.setWordWrap(True)
        column.addWidget(self.state)
        self.problem.setWordWrap(True)
        show_role(self.problem, "warning")
        column.addWidget(self.problem)
        column.addWidget(self._bar())
        column.addWidget(self.where)
        self.search.setPlaceholderText("Search what happened")
        self.search.setAccessibleName("Search what happened")
        self.search.setClearButtonEnabled(True)
        self.search.setMinimumWidth(SEARCH)
        for button, name in ((self.replay, "play"), (self.open, "open"), (self.save, "save"), (self.leave, "exit")):
            button.setIcon(icon(name))
        self.replay.setToolTip("Plays everything that is kept; the connection is closed first")
        self.open.setToolTip("A recording (.tape) or a service bundle (.zip), also from another computer")
        self.open.setAccessibleName("Open recording or bundle")
        self.save.setToolTip("Writes everything that is kept into one file")
        self.leave.setToolTip("Closes the recording")
        column.addLayout(WrappingRow(self.search, self.replay, self.open, self.save, self.leave))
        self._set_up_table()
        column.addWidget(self.table, 1)
        column.addStretch()

    def _bar(self) -> QWidget:
        row = QHBoxLayout(self.bar)
        row.setContentsMargins(0, 0, 0, 0)
        self.play.setToolTip("Play or stand still")
        self.slider.setAccessibleName("Place in the recording")
        self.slider.setToolTip("Drag, or use the arrow keys: a second; Page keys: ten seconds")
        self.slider.setTracking(False)
        self.slider.setSingleStep(SECOND * STEP)
        self.slider.setPageStep(PAGE * STEP)
        self.speed.setAccessibleName("Speed of the replay")
        for speed in SPEEDS:
            self.speed.addItem(f"{speed:g} ×", speed)
        for widget, stretch in ((self.play, 0), (self.slider, 1), (self.speed, 0)):
            row.addWidget(widget, stretch)
        return self.bar

    def _set_up_table(self) -> None:
        table = self.table
        table.setHorizontalHeaderLabels(list(COLUMNS))
        table.setAccessibleName("What happened in the recording")
        table.setToolTip("Double click or Enter: play from there; a capture is shown in the Scope")
        table.verticalHeader().hide()
        table.setShowGrid(False)
        table.setTabKeyNavigation(False)
        table.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        table.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        header = table.horizontalHeader()
        header.setDefaultAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        header.setSectionResizeMode(QHeaderView.ResizeMode.Interactive)
        header.setStretchLastSection(True)
        for place, width in enumerate((130, 110)):
            table.setColumnWidth(place, width)
