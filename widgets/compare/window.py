"""Where file, controller and EEPROM differ: sentences first, then the three side by side."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QColor
from PySide6.QtWidgets import (
    QAbstractItemView,
    QDialog,
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QPlainTextEdit,
    QPushButton,
    QTableWidget,
    QTableWidgetItem,
    QTabWidget,
    QVBoxLayout,
    QWidget,
)

from codegen.difference import PLACES, Difference
from codegen.difference_report import Report
from codegen.difference_values import ValueDifference
from widgets.panel import set_text
from widgets.parts.foot import foot
from widgets.parts.look import look

HEADERS = ("What differs", "In the file", "In the controller", "In the EEPROM")
SAME, NOTHING, UNKNOWN = "the same", "–", "not known"
TABS = ("Program", "Setup values", "Variables")
DONE = "Nothing differs here, as far as it is known."


class CompareWindow(QDialog):
    """Not modal; shows a report and says which step is wanted."""

    read_wanted = Signal()
    cancelled = Signal()
    step_wanted = Signal(int)  # number of the difference of the program

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle("File, controller and EEPROM")
        self.setProperty("helpPage", "Compare")
        self.setModal(False)
        self.summary = QLabel()
        self.summary.setWordWrap(True)
        self.summary.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.doing = QLabel()
        self.doing.setProperty("role", "quiet")
        self.tabs = QTabWidget(self)
        self.tabs.setStyleSheet("QTableWidget::item { padding: 6px 8px; }")
        self.tables = {name: _table(name) for name in TABS}
        self.code = QPlainTextEdit(self)
        self.code.setReadOnly(True)
        self.code.setTabChangesFocus(True)
        self.code.setAccessibleName("The lines of the chosen difference")
        self.code.setFont(look().code_font())
        self.code.setMaximumHeight(148)
        for name, table in self.tables.items():
            self.tabs.addTab(table, name)
        self.read, self.go, self.cancel = QPushButton("Read the controller"), QPushButton("Show step"), _plain("Cancel")
        self.shut = _plain("Close")
        self.read.setToolTip("Reads program, parameters and variables; changes nothing")
        self.go.setToolTip("Shows the instruction in the program (or double click)")
        for button in (self.read, self.go):
            button.setAutoDefault(False)
        self.read.clicked.connect(self.read_wanted)
        self.cancel.clicked.connect(self.cancelled)
        self.go.clicked.connect(self._go)
        self.shut.clicked.connect(self.accept)
        self.report: Report | None = None
        program = self.tables["Program"]
        program.currentCellChanged.connect(lambda *_: self._show_code())
        program.cellDoubleClicked.connect(lambda *_: self._go())
        self.tabs.currentChanged.connect(lambda _: self._show_code())
        self._lay_out()
        self.resize(1040, 640)

    # ---- what is shown

    def show_report(self, report: Report) -> None:
        """The sentences, and every difference in the tab it belongs to."""
        self.report = report
        set_text(self.summary, "\n".join(f"{_shape(each)} {each}" for each in report.summary))
        _fill(self.tables["Program"], [_program_row(each) for each in report.program])
        _fill(self.tables["Setup values"], [_value_row(each) for each in report.settings])
        _fill(self.tables["Variables"], [_value_row(each) for each in report.variables])
        for number, (name, found) in enumerate(
            zip(TABS, (report.program, report.settings, report.variables), strict=True)
        ):
            self.tabs.setTabText(number, f"{name} {len(found)}" if found else name)
        self._show_code()

    def show_read(self, reason: str, doing: str, when: str) -> None:
        """Whether the controller can be read now, what is under way, and when it was read last."""
        self.read.setEnabled(not reason)
        self.read.setToolTip(reason or "Reads program, parameters and variables; changes nothing")
        set_text(self.doing, doing or reason or (f"The controller was read at {when}." if when else ""))
        self.cancel.setVisible(bool(doing))

    def _show_code(self) -> None:
        row = self.tables["Program"].currentRow()
        on = self.tabs.currentIndex() == 0 and self.report is not None and 0 <= row < len(self.report.program)
        self.code.setVisible(self.tabs.currentIndex() == 0)
        self.go.setVisible(self.tabs.currentIndex() == 0)
        found = self.report.program[row] if on and self.report is not None else None
        self.go.setEnabled(found is not None and bool(found.cells[0] and found.cells[0].lines))
        self.code.setPlainText(_code_text(found) if found is not None else "")

    def _go(self) -> None:
        if self.go.isEnabled():
            self.step_wanted.emit(self.tables["Program"].currentRow())

    def _lay_out(self) -> None:
        row = QHBoxLayout()
        row.addWidget(self.read)
        row.addWidget(self.cancel)
        row.addWidget(self.doing, 1)
        row.addWidget(foot(self.go, away=self.shut))
        column = QVBoxLayout(self)
        column.setContentsMargins(16, 16, 16, 16)
        column.setSpacing(12)
        column.addWidget(self.summary)
        column.addWidget(self.tabs, 1)
        column.addWidget(self.code)
        column.addLayout(row)


def _plain(text: str) -> QPushButton:
    button = QPushButton(text)
    button.setAutoDefault(False)
    return button


def _shape(sentence: str) -> str:
    """State by a shape as well as by the word."""
    wrong = ("differ", "otherwise", "There is no program", "Not burned")
    if any(each in sentence for each in wrong):
        return "≠"
    return "?" if "not known" in sentence else "✓"


def _table(name: str) -> QTableWidget:
    table = QTableWidget(0, len(HEADERS))
    table.setAccessibleName(f"Differences: {name.lower()}")
    table.setHorizontalHeaderLabels(list(HEADERS))
    table.verticalHeader().hide()
    table.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
    table.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
    table.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
    table.setTabKeyNavigation(False)
    table.setWordWrap(True)
    header = table.horizontalHeader()
    header.setSectionResizeMode(QHeaderView.ResizeMode.Stretch)
    header.setSectionResizeMode(0, QHeaderView.ResizeMode.ResizeToContents)
    header.setDefaultAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
    header.setHighlightSections(False)
    return table


def _fill(table: QTableWidget, rows: Sequence[Sequence[str]]) -> None:
    """One row for each difference, its cells as high as their words."""
    table.setUpdatesEnabled(False)
    table.clearSpans()
    table.setRowCount(max(len(rows), 1))
    quiet: QColor = look().colour("quiet")
    for number, texts in enumerate(rows or [(DONE, "", "", "")]):
        for column, text in enumerate(texts):
            item = QTableWidgetItem(text)
            item.setTextAlignment(Qt.AlignmentFlag.AlignTop | Qt.AlignmentFlag.AlignLeft)
            if text in (SAME, NOTHING, UNKNOWN, DONE):
                item.setForeground(quiet)
            table.setItem(number, column, item)
    if not rows:
        table.setSpan(0, 0, 1, len(HEADERS))
    table.resizeRowsToContents()
    if rows:
        table.setCurrentCell(0, 0)
    table.setUpdatesEnabled(True)


def _program_row(found: Difference) -> tuple[str, ...]:
    cells = []
    for number, cell in enumerate(found.cells):
        if cell is None:
            cells.append(UNKNOWN)
        elif not cell.lines:
            cells.append(NOTHING)
        elif number and found.same(0, number):
            cells.append(SAME)
        else:
            cells.append(cell.text)
    return (_kind(found), *cells)


def _kind(found: Difference) -> str:
    """In two words, before the details."""
    file, controller, eeprom = found.cells
    line = next((f"Line {cell.first}: " for cell in (controller, file, eeprom) if cell is not None and cell.lines), "")
    if found.same(0, 1):
        return f"{line}not burned" if eeprom is not None and eeprom.lines else f"{line}not in the EEPROM"
    if controller is None or file is None:
        return f"{line}differs"
    if not controller.lines and not file.lines:
        return f"{line}only in the EEPROM"
    if not controller.lines:
        return f"{line}missing in the controller"
    return f"{line}only in the controller" if not file.lines else f"{line}changed"


def _value_row(found: ValueDifference) -> tuple[str, ...]:
    cells = [text or (NOTHING if number == 0 else UNKNOWN) for number, text in enumerate(found.texts)]
    return (found.title, *cells)


def _code_text(found: Difference) -> str:
    """The lines themselves, place by place."""
    parts = []
    for name, cell in zip(PLACES, found.cells, strict=True):
        if cell is not None:
            lines = [f"{cell.first + number:4}  {text}" for number, text in enumerate(cell.lines)] or [
                "      (nothing)"
            ]
            parts.append("\n".join([f"In the {name}:", *lines]))
    return "\n".join(parts)
