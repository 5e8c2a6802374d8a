"""The tuner's pages beside its step: manual, automatic, model-based, logbook."""

from __future__ import annotations

import math
from collections.abc import Sequence

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtWidgets import (
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QListWidget,
    QListWidgetItem,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from codegen.numbers import parse_number
from device.tuning.entry import Entry, gains_words
from device.tuning.loop import Gains, Margins
from widgets.panel import set_text, show_role
from widgets.tuner.gains import GainsBox

HERTZ = 2 * math.pi
ROW = 30  # px of a run: its box to tick fits
NO_RUNS = "No run is kept yet for this machine. Every step that is measured comes here by itself."
AUTOMATIC = (
    "Moves the axis to and fro by the step and raises KD and KP while it tests the response, then KI. It stops where "
    "the axis begins to vibrate. Only for drives in torque mode."
)
DUAL = (
    "The axis works with a dual loop (DV 1): first KD is raised as far as it goes while KP and KI are 0, then KP, then "
    "KI. An axis with weight on it would sink meanwhile: hold it otherwise, or tune it by hand."
)
UNKNOWN = "Identify the axis first."
BACK = "The gains of the chosen run into the fields of the manual page"
IDENTIFY = "The axis has not been identified. It jumps to and fro within the step while error and torque are recorded."


def _column(widget: QWidget) -> QVBoxLayout:
    column = QVBoxLayout(widget)
    column.setContentsMargins(0, 0, 0, 0)
    column.setSpacing(6)
    return column


def _words(text: str = "", role: str = "quiet") -> QLabel:
    label = QLabel(text)
    label.setWordWrap(True)
    label.setProperty("role", role)
    label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
    return label


class ManualPage(QWidget):
    """Gains by hand."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.gains = GainsBox(self)
        self.defaults, self.present = QPushButton("Restore defaults", self), QPushButton("As in the controller", self)
        self.defaults.setToolTip("KP 6, KI 0, KD 64 into the fields; nothing is sent")
        self.present.setToolTip("The gains that the controller holds into the fields")
        column = _column(self)
        column.addWidget(self.gains)
        row = QHBoxLayout()
        row.addWidget(self.defaults)
        row.addWidget(self.present)
        row.addStretch(1)
        column.addLayout(row)


class AutomaticPage(QWidget):
    """What it does, every trial with its reason, what it recommends."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.trials, self.about, self.result = QListWidget(), _words(AUTOMATIC), _words()
        self.trials.setAccessibleName("Trials")
        self.trials.setWordWrap(True)
        self.trials.setSpacing(3)
        self.trials.setMinimumHeight(120)
        self.trials.hide()  # until there is one: the fields below are what is needed first
        column = _column(self)
        column.addWidget(self.about)
        column.addWidget(self.trials, 1)
        column.addWidget(self.result)

    def show_loop(self, dual: bool) -> None:
        """What will be done, with one encoder or two."""
        set_text(self.about, f"{AUTOMATIC} {DUAL}" if dual else AUTOMATIC)

    def add_trial(self, why: str, gains: Gains, words: str) -> None:
        """One more, in sight."""
        self.trials.addItem(QListWidgetItem(f"{gains_words(gains)}\n{why} {words}"))
        self.trials.show()
        self.trials.scrollToBottom()

    def clear(self) -> None:
        """No trials yet."""
        self.trials.clear()
        self.trials.hide()
        self.show_result("")

    def show_result(self, words: str, good: bool = True) -> None:
        """What it recommends, or why it gave up."""
        set_text(self.result, words)
        show_role(self.result, "ok" if good else "problem")


class ModelPage(QWidget):
    """An estimate of the axis, a wanted crossover and margin, the gains that give them."""

    target_wanted = Signal(float, float)  # rad/s, degrees
    run_wanted = Signal()
    moves_wanted = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.estimate, self.result, self.margins = _words(IDENTIFY), _words(), _words()
        self.crossover, self.phase = QLineEdit(), QLineEdit()
        self.apply, self.run = QPushButton("Design"), QPushButton("Run this step")
        self.feeds, self.compare = _words(), QPushButton("Compare moves")
        self.crossover.setAccessibleName("Crossover, Hz")
        self.phase.setAccessibleName("Phase margin, degrees")
        grid = QGridLayout()
        grid.setHorizontalSpacing(8)
        for row, (name, field) in enumerate((("Crossover, Hz", self.crossover), ("Phase margin, °", self.phase))):
            field.setFixedWidth(84)
            field.returnPressed.connect(self._typed)
            grid.addWidget(QLabel(name), row, 0)
            grid.addWidget(field, row, 1)
        grid.addWidget(self.apply, 0, 2)
        grid.addWidget(self.run, 1, 2)
        grid.setColumnStretch(3, 1)
        self.apply.clicked.connect(self._typed)
        self.run.clicked.connect(self.run_wanted)
        column = _column(self)
        column.addWidget(self.estimate)
        column.addLayout(grid)
        column.addWidget(self.margins)
        column.addWidget(self.result)
        row = QHBoxLayout()
        row.addWidget(self.compare, 0, Qt.AlignmentFlag.AlignTop)
        row.addWidget(self.feeds, 1)
        column.addLayout(row)
        column.addStretch(1)
        self.compare.clicked.connect(self.moves_wanted)
        self.show_usable(False)

    def clear(self) -> None:
        """Nothing is known, of another axis or another machine."""
        self.show_estimate(IDENTIFY)
        show_role(self.estimate, "quiet")
        self.show_design(Gains(), None, "")
        set_text(self.result, "")
        self.show_feeds("")
        for field in (self.crossover, self.phase):
            field.clear()
        self.show_usable(False)

    def show_usable(self, designed: bool, reason: str = "") -> None:
        """Whether there is an estimate to design for, and why there are no gains to run."""
        for field in (self.crossover, self.phase, self.apply):
            field.setEnabled(designed)
            field.setToolTip("" if designed else UNKNOWN)
        self._no_gains = reason if designed else UNKNOWN
        self.show_runnable("")

    def show_runnable(self, reason: str) -> None:
        """Whether the step with the proposed gains can be run now."""
        why = self._no_gains or reason
        self.run.setEnabled(not why)
        self.run.setToolTip(why or "One step with the proposed gains, drawn over the predicted one")
        self.compare.setEnabled(not why)
        self.compare.setToolTip(why or "A move of the step's size without FV and FA, and back with them")

    def show_feeds(self, words: str) -> None:
        """What FV and FA would be."""
        set_text(self.feeds, words)

    def show_target(self, crossover: float, phase: float) -> None:
        """Where the handles stand."""
        self.crossover.setText(f"{crossover / HERTZ:.3g}")
        self.phase.setText(f"{phase:.0f}")

    def show_estimate(self, words: str, good: bool = True) -> None:
        """What is known of the axis, or why nothing is."""
        set_text(self.estimate, words)
        show_role(self.estimate, "" if good else "problem")

    def show_design(self, gains: Gains | None, margins: Margins | None, words: str) -> None:
        """The gains proposed and what they give; or why not."""
        set_text(self.result, (f"Proposed: {gains_words(gains)}. " if gains is not None else "") + words)
        show_role(self.result, "problem" if gains is None else "")
        set_text(self.margins, margin_words(margins) if margins is not None else "")

    def _typed(self) -> None:
        hertz, phase = parse_number(self.crossover.text()), parse_number(self.phase.text())
        for field, number in ((self.crossover, hertz), (self.phase, phase)):
            show_role(field, "problem" if number is None else "")
        if hertz is not None and phase is not None and hertz > 0:
            self.target_wanted.emit(float(hertz) * HERTZ, float(phase))


def margin_words(margins: Margins) -> str:
    """Crossover and margins in one line."""
    if not margins.stable:
        return "With these gains the loop is unstable."
    crossover = "–" if margins.crossover is None else f"{margins.crossover / HERTZ:.3g} Hz"
    phase = "–" if margins.phase is None else f"{margins.phase:.0f}°"
    gain = "no limit" if margins.gain is None else f"{margins.gain:.1f} dB"
    return f"Crossover {crossover}, phase margin {phase}, gain margin {gain}."


class LogbookPage(QWidget):
    """Every run: ticked ones are drawn over each other; the chosen one has a note and a way back."""

    shown = Signal(object)  # numbers of the ticked runs and the chosen one
    note_wanted = Signal(int, str)
    back_wanted = Signal(int)
    report_wanted = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.runs, self.note, self.words = QListWidget(), QLineEdit(), _words(NO_RUNS)
        self.back, self.report = QPushButton("Back to these gains"), QPushButton("Commissioning report…")
        self.runs.setAccessibleName("Runs")
        self.runs.setMinimumHeight(160)
        self.runs.setSpacing(2)
        self.note.setAccessibleName("Note of the chosen run")
        self.note.setPlaceholderText("Note on the chosen run")
        self._filling = False
        column = _column(self)
        column.addWidget(self.runs, 1)
        column.addWidget(self.words)
        column.addWidget(self.note)
        row = QHBoxLayout()
        row.addWidget(self.back)
        row.addWidget(self.report)
        row.addStretch(1)
        column.addLayout(row)
        self.runs.itemChanged.connect(lambda _item: self.tell())
        self.runs.currentRowChanged.connect(lambda _row: self._chosen())
        self.note.editingFinished.connect(self._noted)
        self.back.clicked.connect(lambda: self.back_wanted.emit(self.chosen))
        self.report.clicked.connect(self.report_wanted)
        self._entries: tuple[Entry, ...] = ()
        self.show_entries(())

    @property
    def chosen(self) -> int:
        """Number of the chosen run; 0: none."""
        item = self.runs.currentItem()
        return int(item.data(Qt.ItemDataRole.UserRole)) if item is not None else 0

    @property
    def ticked(self) -> tuple[int, ...]:
        """Numbers of the ticked runs."""
        items = (self.runs.item(row) for row in range(self.runs.count()))
        return tuple(
            int(item.data(Qt.ItemDataRole.UserRole)) for item in items if item.checkState() is Qt.CheckState.Checked
        )

    def show_entries(self, entries: Sequence[Entry]) -> None:
        """All runs of the machine, the newest first; ticks and choice stay, and so does what is drawn."""
        ticked, chosen = set(self.ticked), self.chosen
        self._entries, self._filling = tuple(entries), True
        self.runs.clear()
        for entry in reversed(self._entries):
            item = QListWidgetItem(row_words(entry))
            item.setData(Qt.ItemDataRole.UserRole, entry.number)
            item.setSizeHint(QSize(0, ROW))
            item.setFlags(item.flags() | Qt.ItemFlag.ItemIsUserCheckable)
            item.setCheckState(Qt.CheckState.Checked if entry.number in ticked else Qt.CheckState.Unchecked)
            self.runs.addItem(item)
            if entry.number == chosen:
                self.runs.setCurrentItem(item)
        self._filling = False
        self._describe()

    def _entry(self) -> Entry | None:
        return next((each for each in self._entries if each.number == self.chosen), None)

    def _chosen(self) -> None:
        if self._filling:
            return
        self._describe()
        self.tell()

    def _describe(self) -> None:
        entry = self._entry()
        told = NO_RUNS if not self._entries else "Choose a run to see it; tick others to lay them over it."
        set_text(self.words, told if entry is None else f"{gains_words(entry.gains)}. {entry.words}")
        for widget in (self.note, self.back):
            widget.setEnabled(entry is not None)
            widget.setToolTip("Choose a run first." if entry is None else BACK if widget is self.back else "")
        self.report.setEnabled(bool(self._entries))
        self.report.setToolTip("" if self._entries else "No run is kept yet.")
        self.note.setText(entry.note if entry is not None else "")

    def tell(self) -> None:
        """What is ticked and chosen is to be drawn."""
        if not self._filling:
            self.shown.emit((*(each for each in self.ticked if each != self.chosen), self.chosen))

    def _noted(self) -> None:
        entry = self._entry()
        if entry is not None and self.note.text() != entry.note:
            self.note_wanted.emit(entry.number, self.note.text())


def row_words(entry: Entry) -> str:
    """A run in one row."""
    settled = "–"
    if entry.metrics is not None and entry.metrics.settling_time is not None:
        settled = f"{entry.metrics.settling_time * 1000:.0f} ms"
    note = f"  “{entry.note}”" if entry.note else ""
    return f"{entry.title}  {entry.when[5:16].replace('T', ' ')}  settled {settled}{note}"
