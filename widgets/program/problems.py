"""What is wrong with the program, as a list; a click leads to the step."""

from __future__ import annotations

from collections.abc import Iterator

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import QLabel, QListWidget, QListWidgetItem, QStackedLayout, QVBoxLayout, QWidget

from codegen import read
from codegen.document import Document
from codegen.generate import Listing
from widgets.parts.icons import icon

STEP = Qt.ItemDataRole.UserRole
Entry = tuple[str, str, str, str, str]  # severity, message, id of the step, its sentence, code


class ProblemsPanel(QWidget):
    """One line for each problem: errors first."""

    chosen = Signal(str)
    count_changed = Signal(int)
    title = "Problems"

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setAccessibleName(self.title)
        self.list = QListWidget()
        self.list.setAccessibleName("Problems of the program")
        self.list.setWordWrap(True)
        self.list.itemActivated.connect(self._chosen)
        self.list.itemClicked.connect(self._chosen)
        self.none = QLabel("No problems: this program can be sent to the controller.")
        self.none.setProperty("role", "quiet")
        self.none.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.stack = QStackedLayout()
        self.stack.addWidget(self.none)
        self.stack.addWidget(self.list)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.addLayout(self.stack)
        self.shown: tuple[Entry, ...] = ()
        self._count = 0
        self._waiting: tuple[Document, Listing] | None = None  # what is to be shown once this is in sight

    def show_problems(self, document: Document, listing: Listing) -> None:
        """Shows the problems of a listing; rows that stay the same are not touched, out of sight none is."""
        count = len(listing.problems)
        self._waiting = (document, listing)
        if self.isVisible() or not count or not self._count:
            self._fill()
        if count != self._count:
            self._count = count
            self.count_changed.emit(count)

    def showEvent(self, event: QShowEvent) -> None:
        """What happened meanwhile."""
        self._fill()
        super().showEvent(event)

    def _fill(self) -> None:
        if self._waiting is None:
            return
        (document, listing), self._waiting = self._waiting, None
        entries = tuple(_entries(document, listing))
        self.stack.setCurrentWidget(self.list if entries else self.none)
        for row, entry in enumerate(entries):
            if row >= len(self.shown):
                self.list.addItem(QListWidgetItem())
            elif self.shown[row] == entry:
                continue
            _write(self.list.item(row), entry)
        for row in reversed(range(len(entries), len(self.shown))):
            self.list.takeItem(row)
        self.shown = entries

    def _chosen(self, item: QListWidgetItem) -> None:
        if item.data(STEP):
            self.chosen.emit(item.data(STEP))


def _entries(document: Document, listing: Listing) -> Iterator[Entry]:
    """Errors first."""
    steps = {step.id: step for step in document.program.steps()} if listing.problems else {}
    setup = document.working_setup
    for problem in sorted(listing.problems, key=lambda problem: problem.severity != "error"):
        step = steps.get(problem.step)
        where = "" if step is None else read.sentence(step.instruction, setup)
        yield problem.severity, problem.message, problem.step if step is not None else "", where, problem.code


def _write(item: QListWidgetItem, entry: Entry) -> None:
    severity, message, step_id, where, code = entry
    item.setIcon(icon("problem" if severity == "error" else "warning"))
    item.setText(f"{message}    {where}".rstrip())
    item.setToolTip(f"{severity} {code}")
    item.setData(STEP, step_id)
    item.setData(Qt.ItemDataRole.AccessibleTextRole, f"{severity}: {message}. {where}")
    item.setToolTip("Enter or a click goes to the step" if step_id else "")
