"""What stands in the teach panel, made when it is first shown: stick, buttons, table, play-back, picture."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QSizePolicy,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from codegen.setup import Setup
from codegen.teach import Table, Wrong
from codegen.teach_drive import OF_THE_ROWS, OF_THE_STICK, Driving, dead_band
from codegen.teach_steps import drawn
from widgets.jog.one_axis import enable
from widgets.panel import set_text, show_role
from widgets.parts.look import look
from widgets.parts.pieces import dressed
from widgets.parts.stick import Stick
from widgets.parts.wrapping import WrappingRow
from widgets.teach.entries import Entry, OutputEntry, WaitEntry
from widgets.teach.numbers import Numbers
from widgets.teach.table import TeachModel, TeachView

if TYPE_CHECKING:
    from widgets.parts.plot import Plot
    from widgets.teach.panel import TeachPanel

STICK = 156  # px
LOWEST_PICTURE = 150  # px
SWITCHED_NOW = "I/O control is on: the outputs are switched now as well."
ONLY_KEPT = "I/O control is off: the row is added, nothing is switched now."
DRIVING = "● Driving: press to end"
PLAYS = "The table is being played back."
EMPTY = "The table is empty."
EDITS = (
    ("insert", "Insert", "An empty row above the selected one (Ins)"),
    ("delete", "Delete", "Takes the selected rows out (Ctrl+-)"),
    ("pace", "Set speeds", "Gives the selected rows the speed and ramps from the fields above"),
    ("undo", "Undo", "Takes the last change of the table back (Ctrl+Z)"),
)
FILES = (
    ("new", "New", "An empty table"),
    ("open", "Open…", "Teach data of a file instead of these"),
    ("save", "Save…", "This table as a file"),
    ("module", "Save as module…", "A program of its own that File > Import module takes into others"),
)


class Parts(QWidget):
    """Knows the panel it stands in, and emits its signals."""

    def __init__(self, panel: TeachPanel, parent: QWidget) -> None:
        """In its place from the start, unseen until it is filled."""
        super().__init__(parent)
        self.hide()
        self._panel = panel
        self._usable, self._playing = "", False
        self.source, self.enable, self.fold = QComboBox(self), QPushButton("Enable", self), QToolButton(self)
        self.block, self.place, self.message = QWidget(self), QLabel(self), QLabel(self)
        self.stick = Stick(self.block)
        self.plot: Plot | None = None
        self._line = self._dots = self._now = None

    def pieces(self) -> Iterator[None]:
        """What is in it, in the order in which Tab goes; the picture at last."""
        yield
        self.of_stick = Numbers(OF_THE_STICK, parent=self.block)
        yield
        self.of_rows = Numbers(OF_THE_ROWS, 2, parent=self.block)
        yield
        self.record, self.wait = QPushButton("Record", self), QPushButton("Wait…", self)
        self.output, self.done = QPushButton("Output…", self), QPushButton("Done", self)
        self.way, self.io_control = QCheckBox("Record the whole way", self), QCheckBox("I/O control", self)
        self.how, self.play = QComboBox(self), QPushButton("Play back…", self)
        self.next, self.halt = QPushButton("Next row", self), QPushButton("Stop", self)
        yield
        self.model = TeachModel(self)
        self.view = TeachView(self.model, self)
        yield
        self.edits = {name: _button(words, about, self) for name, words, about in EDITS}
        self.files = {name: _button(words, about, self) for name, words, about in FILES}
        yield
        self._lay_out_top()
        yield
        self._lay_out_table()
        yield
        self._connect()
        self._enable_next(False)
        yield
        self._make_plot()
        yield from dressed(self)

    # ---- what it shows

    def show_all(self, table: Table, setup: Setup, wrong: tuple[Wrong, ...], driving: Driving) -> None:
        """Another table, machine or speed."""
        self.model.show_table(table, setup, wrong)
        self.view.show_columns(any(row.pause or row.sweep or row.through for row in table.rows))
        self.view.fit_columns()
        for numbers in (self.of_stick, self.of_rows):
            numbers.show_driving(driving, setup)
        self.stick.dead = dead_band(driving)
        self._tell(wrong[0].sentence if wrong and len(table) else "")
        self._draw(table, setup, wrong)
        self._show_playable()

    def show_usable(self, reason: str, io_control: bool) -> None:
        """Why nothing may be driven now, or nothing."""
        self._usable = reason
        busy = PLAYS if self._playing else ""
        enable(self.enable, "" if self._panel.enabled else reason or self._panel.problem or busy)
        for widget in (self.record, self.way, self.io_control):
            enable(widget, reason)
        if self.io_control.isChecked() != io_control:
            self.io_control.setChecked(io_control)
        usable = self._panel.enabled and self._panel.source == "stick"
        if self.stick.isEnabled() != usable:
            self.stick.setEnabled(usable)
        self._show_playable()

    def show_enabled(self, on: bool) -> None:
        """Whether the stick drives."""
        self.enable.setChecked(on)
        set_text_of(self.enable, DRIVING if on else "Enable")
        self.source.setEnabled(not on)
        self.stick.setEnabled(on and self._panel.source == "stick")

    def show_play(self, playing: bool, row: int, holds: bool) -> None:
        """A play-back on its way, or none."""
        if playing != self._playing:
            self._playing = playing
            self._show_playable()
        self._enable_next(playing and holds)
        if row != self.model.playing:
            self.model.show_playing(row)
            self.view.go_to(row)
            self._draw_now(row)

    def _show_playable(self) -> None:
        wrong, empty = self._panel.wrong, "" if len(self._panel.table) else EMPTY
        reason = self._usable or self._panel.problem or empty
        enable(self.play, reason or (wrong[0].sentence if wrong else "") or (PLAYS if self._playing else ""))
        enable(self.halt, "" if self._playing else "Nothing is played back.")
        for button in (
            self.edits["delete"],
            self.edits["pace"],
            *(self.files[name] for name in ("new", "save", "module")),
        ):
            enable(button, empty)
        enable(self.edits["undo"], "" if self._panel.undo else "There is no change to take back.")

    def _enable_next(self, holds: bool) -> None:
        enable(self.next, "" if holds else "For play-back step by step.")

    def _tell(self, sentence: str) -> None:
        set_text(self.message, f"! {sentence}" if sentence else "")
        self.message.setVisible(bool(sentence))

    # ---- the picture

    def _draw(self, table: Table, setup: Setup, wrong: tuple[Wrong, ...]) -> None:
        if self.plot is None or self._line is None or self._dots is None:
            return
        places = [] if wrong else drawn(table, setup)
        ends = [] if wrong else [(float(row.x), float(row.y)) for row in table.rows if row.moves]
        pen = {"color": look().colour("axis_w"), "width": 2}
        self._line.setData([x for x, _ in places], [y for _, y in places], pen=pen)
        self._dots.setData([x for x, _ in ends], [y for _, y in ends], symbolBrush=look().colour("axis_w"), pen=None)
        self.plot.name_sides(f"X, {table.units[0]}", f"Y, {table.units[1]}")
        self._draw_now(self.model.playing)

    def _draw_now(self, row: int) -> None:
        rows = self._panel.table.rows
        if self._now is None:
            return
        here = [(float(each.x), float(each.y)) for each in rows[: row + 1] if each.moves][-1:] if row >= 0 else []
        self._now.setData([x for x, _ in here], [y for _, y in here], symbolBrush=look().colour("accent"), pen=None)

    def _make_plot(self) -> None:
        from widgets.teach.picture import PathPicture

        self.plot = PathPicture("Path of the teach table", equal=True, parent=self)
        self.plot.setMinimumHeight(LOWEST_PICTURE)
        self._line, self._dots = self.plot.plot(), self.plot.plot(symbol="o", symbolSize=6, symbolPen=None)
        self._now = self.plot.plot(symbol="o", symbolSize=12, symbolPen=None)
        self._column.insertWidget(self._column.count() - 1, self.plot, 2)

    # ---- hands

    def _asked(self, what: str) -> None:
        self._panel.rows_wanted.emit(what, self.view.chosen, self.view.cells)

    def _open_wait(self) -> None:
        if self._panel.setup is not None:
            self._open(WaitEntry(self._panel.setup, self._panel), self._panel.wait_added)

    def _open_output(self) -> None:
        if self._panel.setup is not None:
            switched = SWITCHED_NOW if self.io_control.isChecked() else ONLY_KEPT
            self._open(OutputEntry(self._panel.setup, switched, self._panel), self._panel.output_added)

    def _open(self, entry: Entry, signal: object) -> None:
        entry.setObjectName("entry")
        entry.accepted_text.connect(signal)
        entry.show()

    def _source_chosen(self) -> None:
        """Voltages belong to the joystick at the controller alone."""
        self.show_enabled(self._panel.enabled)
        names = OF_THE_STICK if self._panel.source == "joystick" else OF_THE_STICK[:2]
        self.of_stick.show_only(names)

    def _fold(self) -> None:
        """The stick and the fields go, or come back; what is driven is let go with them."""
        shown = self.block.isHidden()
        self.block.setVisible(shown)
        self.fold.setArrowType(Qt.ArrowType.UpArrow if shown else Qt.ArrowType.DownArrow)

    def _refused(self, sentence: str) -> None:
        self._tell(sentence)

    def _connect(self) -> None:
        panel = self._panel
        self.enable.clicked.connect(panel.enable_wanted)
        self.source.currentIndexChanged.connect(self._source_chosen)
        for box in (self.source, self.how):
            box.activated.connect(lambda: panel.way_chosen.emit(panel.source, self.how.currentIndex()))
        for numbers in (self.of_stick, self.of_rows):
            numbers.edited.connect(panel.driving_changed)
        self.fold.clicked.connect(self._fold)
        self.record.clicked.connect(panel.record_wanted)
        self.way.clicked.connect(panel.way_wanted)
        self.done.clicked.connect(panel.done_wanted)
        self.io_control.clicked.connect(panel.io_control_wanted)
        self.wait.clicked.connect(self._open_wait)
        self.output.clicked.connect(self._open_output)
        self.model.typed.connect(panel.cell_typed)
        self.model.refused.connect(self._refused)
        self.view.asked.connect(self._asked)
        for name, button in self.edits.items():
            button.clicked.connect(partial(self._asked, name))
        for name, button in self.files.items():
            button.clicked.connect(partial(panel.file_wanted.emit, name))
        self.play.clicked.connect(lambda: panel.play_wanted.emit(self.how.currentIndex() == 1))
        self.next.clicked.connect(panel.next_wanted)
        self.halt.clicked.connect(panel.halt_wanted)

    def _lay_out_top(self) -> None:
        """What drives."""
        from widgets.teach.panel import SOURCES

        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(0, 0, 0, 0)
        self._column.setSpacing(6)
        for key, words in SOURCES.items():
            self.source.addItem(words, key)
        self.source.setAccessibleName("Drive with")
        self.source.setToolTip(
            "The joystick at the controller (analog inputs 1 and 2), the stick on the screen, or a gamepad"
        )
        self.source.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.source.setMinimumContentsLength(10)
        self.enable.setCheckable(True)
        self.enable.setProperty("hint", "The stick drives X and Y until you end it, or another window comes in front.")
        self.fold.setAccessibleName("Stick and speeds")
        self.fold.setToolTip("Hides the stick and the fields, so that the table has more room; or shows them again.")
        self.fold.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.fold.setArrowType(Qt.ArrowType.UpArrow)
        self.how.addItems(["Continuous", "Step by step"])
        self.how.setAccessibleName("Play back")
        self.how.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.how.setMinimumContentsLength(9)
        self.stick.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)
        self.stick.setFixedSize(STICK, STICK)
        self.enable.setMinimumWidth(self.enable.fontMetrics().horizontalAdvance(DRIVING) + 28)
        top = QHBoxLayout()
        top.setSpacing(6)
        top.addWidget(self.source, 1)
        top.addWidget(self.enable)
        top.addWidget(self.fold)
        self._column.addLayout(top)
        middle = QGridLayout(self.block)
        middle.setContentsMargins(0, 0, 0, 0)
        middle.setHorizontalSpacing(12)
        middle.addWidget(self.stick, 0, 0, Qt.AlignmentFlag.AlignTop)
        middle.addWidget(self.of_stick, 0, 1, Qt.AlignmentFlag.AlignTop)
        middle.addWidget(self.of_rows, 1, 0, 1, 2)
        middle.setColumnStretch(1, 1)
        self._column.addWidget(self.block)

    def _lay_out_table(self) -> None:
        """What records, the table, what plays it back."""
        self.place.setProperty("role", "quiet")
        self._column.addWidget(self.place)
        for button in (self.record, self.wait, self.output, self.done):
            button.setMinimumHeight(look().space["touch"])
        self._column.addLayout(_row(self.record, self.wait, self.output, self.done))
        ticks = QHBoxLayout()
        ticks.setSpacing(16)
        ticks.addWidget(self.way)
        ticks.addWidget(self.io_control)
        ticks.addStretch(1)
        self._column.addLayout(ticks)
        playing = WrappingRow(self.how, self.play, self.next, self.halt)
        playing.setSpacing(6)
        self._column.addLayout(playing)
        self._column.addWidget(self.view, 3)
        self.message.setWordWrap(True)
        show_role(self.message, "warning")
        self.message.hide()
        self._column.addWidget(self.message)
        self._column.addLayout(_row(*self.edits.values()))
        self._column.addLayout(_row(*self.files.values()))


def _button(words: str, about: str, parent: QWidget) -> QPushButton:
    button = QPushButton(words, parent)
    button.setProperty("role", "segment")
    button.setProperty("hint", about)
    button.setToolTip(about)
    button.setAutoDefault(False)
    return button


def _row(*widgets: QWidget) -> QHBoxLayout:
    row = QHBoxLayout()
    row.setSpacing(6)
    for widget in widgets:
        row.addWidget(widget, 1)
    return row


def set_text_of(button: QPushButton, words: str) -> None:
    """Only where it differs."""
    if button.text() != words:
        button.setText(words)
