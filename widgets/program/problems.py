"""What is wrong with the program, as a list; a click leads to the step."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QLabel, QListWidget, QListWidgetItem, QStackedLayout, QVBoxLayout, QWidget

from codegen import read
from codegen.document import Document
from codegen.generate import Listing
from codegen.program import Step
from widgets.parts.icons import icon

STEP = Qt.ItemDataRole.UserRole


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
        self.shown: tuple[tuple[str, str, str], ...] = ()

    def show_problems(self, document: Document, listing: Listing) -> None:
        """Shows the problems of a listing; the same ones again change nothing."""
        found = sorted(listing.problems, key=lambda problem: problem.severity != "error")
        entries = tuple((problem.severity, problem.message, problem.step) for problem in found)
        if entries == self.shown:
            return
        counted = len(entries) != len(self.shown)
        self.shown = entries
        self.list.clear()
        steps = {step.id: step for step in document.program.steps()} if entries else {}
        for severity, message, step_id in entries:
            self.list.addItem(self._item(severity, message, steps.get(step_id), document))
        self.stack.setCurrentWidget(self.list if entries else self.none)
        if counted:
            self.count_changed.emit(len(entries))

    def _item(self, severity: str, message: str, step: Step | None, document: Document) -> QListWidgetItem:
        where = "" if step is None else read.sentence(step.instruction, document.working_setup)
        item = QListWidgetItem(icon("problem" if severity == "error" else "warning"), f"{message}    {where}".rstrip())
        item.setData(STEP, "" if step is None else step.id)
        item.setData(Qt.ItemDataRole.AccessibleTextRole, f"{severity}: {message}. {where}")
        item.setToolTip("Enter or a click goes to the step" if step is not None else "")
        return item

    def _chosen(self, item: QListWidgetItem) -> None:
        if item.data(STEP):
            self.chosen.emit(item.data(STEP))
