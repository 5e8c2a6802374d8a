"""What the threads of the running program are doing: the bar that follows one of them, and the table of all."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import (
    QAbstractItemView,
    QComboBox,
    QDialog,
    QFrame,
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QPushButton,
    QSizePolicy,
    QTableWidget,
    QTableWidgetItem,
    QVBoxLayout,
    QWidget,
)

from codegen.generate import Listing
from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.slow_mark import mark_of
from widgets.parts.foot import foot
from widgets.parts.look import look
from widgets.program.words import Words

ALL = -1
HEADINGS = ("Thread", "State", "Line", "Instruction", "Waiting")
Threads = Mapping[int, int | None]  # the line of the listing each thread is on; None: it does not run


@dataclass(frozen=True)
class Doing:
    """One thread in words; without a line it does not run."""

    thread: int
    line: int | None
    step: str = ""
    sentence: str = ""
    waits: str = ""
    slow: str = ""  # "slowed to 25 %"

    @property
    def text(self) -> str:
        """In one line, for the bar."""
        if self.line is None:
            return f"■ Thread {self.thread} is not running"
        waits = f", waiting: {self.waits}" if self.waits else ""
        slow = f", {self.slow}" if self.slow else ""
        return f"► Thread {self.thread}{slow}: line {self.line}, {self.sentence}{waits}"

    @property
    def cells(self) -> tuple[str, ...]:
        """The same for the table."""
        if self.line is None:
            return (str(self.thread), "■ not running", "", "", "")
        state = f"► {self.slow or 'running'}"
        return (str(self.thread), state, str(self.line), self.sentence, self.waits or "no")


def doing(threads: Threads, listing: Listing, words: Words) -> list[Doing]:
    """Every thread, with the sentence of the instruction its line comes from."""
    found = []
    slow = mark_of([line.text for line in listing.lines[-1:]])
    for thread, line in sorted(threads.items()):
        if line is None or not 0 <= line < len(listing.lines):
            found.append(Doing(thread, None))
            continue
        step, code = listing.step_of(line), listing.lines[line].text
        sentence = words.sentence_of(step) or code
        found.append(Doing(thread, line, step, sentence, waits_for(code), slow))
    return found


def waits_for(code: str) -> str:
    """What a line holds its thread for, in the words of the command table; nothing when it goes on at once."""
    rows = [COMMANDS.get(part.strip()[:2]) for part in code.split(";")]
    title = next((row.title.lower() for row in rows if row is not None and row.trippoint), "")
    return "until its time is over" if title == "wait" else title


class TraceBar(QFrame):
    """Which thread is followed, and what it is doing."""

    followed = Signal(int)  # a thread, or ALL
    status_wanted = Signal()
    closed = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setProperty("role", "card")
        self.setAccessibleName("Trace")
        self.setProperty("helpPage", "Program window")
        self.chooser = QComboBox()
        self.chooser.setAccessibleName("Thread to follow")
        self.chooser.setToolTip("The program scrolls along with this thread")
        self.chooser.setMinimumHeight(look().control)
        self.chooser.addItem("All threads", ALL)
        self.chooser.activated.connect(lambda _: self.followed.emit(self.thread))
        self.text = QLabel()
        self.text.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        self.status = self._button("Program status", self.status_wanted.emit)
        self.close_button = self._button("Close", self.closed.emit)
        row = QHBoxLayout(self)
        row.setContentsMargins(8, 4, 4, 4)
        row.addWidget(QLabel("Trace"))
        row.addWidget(self.chooser)
        row.addWidget(self.text, 1)
        row.addWidget(self.status)
        row.addWidget(self.close_button)
        self.hide()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Escape closes it, as it closes the bar of Find."""
        if event.key() == Qt.Key.Key_Escape:
            self.closed.emit()
        else:
            super().keyPressEvent(event)

    @property
    def thread(self) -> int:
        """The thread that is followed, or ALL."""
        return int(self.chooser.currentData())

    def show_doing(self, found: Sequence[Doing]) -> None:
        """The threads there are, and what the followed ones do."""
        wanted = [ALL, *(each.thread for each in found)]
        if [self.chooser.itemData(at) for at in range(self.chooser.count())] != wanted:
            chosen = self.thread
            self.chooser.clear()
            for thread in wanted:
                self.chooser.addItem("All threads" if thread == ALL else f"Thread {thread}", thread)
            self.chooser.setCurrentIndex(max(0, self.chooser.findData(chosen)))
        followed = [each for each in found if self.thread in (ALL, each.thread)]
        running = [each for each in followed if each.line is not None]
        if not found:
            text = "Nothing is known of a running program: connect, download it and execute it"
        else:
            text = "   ".join(each.text for each in (running or followed[:1]))
        if text != self.text.text():
            self.text.setText(text)
            self.text.setToolTip(text)

    def _button(self, text: str, action: object) -> QPushButton:
        button = QPushButton(text)
        button.setMinimumHeight(look().control)
        button.setAutoDefault(False)
        button.clicked.connect(lambda: action())  # type: ignore[operator]
        return button


class StatusWindow(QDialog):
    """Program status: every thread with its line, instruction and what it waits for. Not modal."""

    step_wanted = Signal(str)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setModal(False)
        self.setWindowTitle("Program status")
        self.setProperty("helpPage", "Program window")
        self.table = QTableWidget(0, len(HEADINGS))
        self.table.setHorizontalHeaderLabels(list(HEADINGS))
        self.table.setAccessibleName("Threads")
        self.table.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.table.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        self.table.setTabKeyNavigation(False)
        self.table.verticalHeader().hide()
        self.table.verticalHeader().setDefaultSectionSize(look().control)
        header = self.table.horizontalHeader()
        header.setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        header.setSectionResizeMode(3, QHeaderView.ResizeMode.Stretch)
        self.table.cellActivated.connect(self._chosen)
        self.nothing = QLabel("Nothing is known of a running program: connect, download it and execute it.")
        self.nothing.setProperty("role", "quiet")
        self.nothing.setWordWrap(True)
        close = QPushButton("Close")
        close.setMinimumHeight(look().control)
        close.clicked.connect(self.accept)
        column = QVBoxLayout(self)
        column.setContentsMargins(16, 16, 16, 16)
        column.setSpacing(12)
        for widget in (self.nothing, self.table):
            column.addWidget(widget)
        column.addWidget(foot(away=close))
        self.resize(720, 4 * look().control + 136)
        self._shown: list[Doing] = []
        self.show_doing([])

    def show_doing(self, found: list[Doing]) -> None:
        """Only cells that differ are written."""
        self.nothing.setVisible(not found)
        self.table.setVisible(bool(found))
        self.table.setRowCount(len(found))
        for row, each in enumerate(found):
            if row < len(self._shown) and self._shown[row] == each:
                continue
            for column, text in enumerate(each.cells):
                self.table.setItem(row, column, QTableWidgetItem(text))
        self._shown = list(found)

    def _chosen(self, row: int, column: int) -> None:
        if self._shown[row].step:
            self.step_wanted.emit(self._shown[row].step)
