"""Fills a column of a table: by a formula of the row, or from one position to another by a law of motion."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QComboBox,
    QDialog,
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from codegen.expressions import Bad
from codegen.formula import ROW, fill
from codegen.laws import LAW_HELP, LAW_WORDS, Law, rise
from codegen.numbers import number_problem, parse_number
from codegen.sheets import Column, Sheet
from widgets.parts.foot import foot
from widgets.parts.look import look

FORMULA = "formula"
FORMULA_HELP = f"{ROW} is the number of the row, from 0. Functions and operators are those of every expression."
SHOWN = 6  # values in the preview
HELP = "Tables"


@dataclass(frozen=True, slots=True)
class Filling:
    """What goes into a column; `places`: positions, also where the table holds steps."""

    letter: str
    first: int
    texts: tuple[str, ...]
    places: bool


class FillDialog(QDialog):
    """Not modal; it stays open, so that one part of a cam can be filled after the other."""

    wanted = Signal(object)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle("Fill a column")
        self.setModal(False)
        self.setProperty("helpPage", HELP)
        self.columns: Sequence[Column] = ()
        self.sheet: Sheet | None = None
        self.column = QComboBox()
        self.how = QComboBox()
        self.how.addItem("Formula", FORMULA)
        for law, words in LAW_WORDS.items():
            self.how.addItem(words, law)
        self.formula, self.start, self.end = self._line(), self._line(), self._line()
        self.first, self.last = self._line(), self._line()
        self.about, self.preview = self._words(), self._words()
        self.about.setProperty("role", "quiet")
        self.fill = QPushButton("Fill")
        self.fill.setProperty("role", "primary")
        self.fill.setDefault(True)
        self.fill.clicked.connect(self._fill)
        self.done_button = QPushButton("Close")
        self.done_button.setAutoDefault(False)
        self.done_button.clicked.connect(self.close)
        self._lay_out()
        for box in (self.column, self.how):
            box.currentIndexChanged.connect(self._refresh)
        for line in (self.formula, self.start, self.end, self.first, self.last):
            line.textEdited.connect(self._refresh)

    @staticmethod
    def _line() -> QLineEdit:
        line = QLineEdit()
        line.setMinimumHeight(look().control)
        return line

    @staticmethod
    def _words() -> QLabel:
        label = QLabel()
        label.setWordWrap(True)
        label.setAlignment(Qt.AlignmentFlag.AlignTop)
        label.setMinimumHeight(2 * label.fontMetrics().height())
        return label

    def _lay_out(self) -> None:
        self.form = QFormLayout()
        self.form.setHorizontalSpacing(12)
        rows = QWidget()
        between = QHBoxLayout(rows)
        between.setContentsMargins(0, 0, 0, 0)
        for widget in (self.first, QLabel("to"), self.last):
            between.addWidget(widget)
        named: list[tuple[str, QWidget, str]] = [
            ("Column", self.column, ""), ("By", self.how, ""), ("Rows", rows, ""),
            ("Formula", self.formula, ""), ("From", self.start, ""), ("To", self.end, ""),
        ]  # fmt: skip
        for words, widget, _ in named:
            self.form.addRow(words, widget)
            if not isinstance(widget, QLineEdit):
                widget.setMinimumHeight(look().control)
            widget.setAccessibleName(words)
        self.first.setAccessibleName("First row")
        self.last.setAccessibleName("Last row")
        whole = QVBoxLayout(self)
        whole.setContentsMargins(16, 12, 16, 12)
        whole.addLayout(self.form)
        whole.addWidget(self.about)
        whole.addWidget(self.preview)
        whole.addWidget(foot(self.fill, away=self.done_button))
        self.setMinimumWidth(400)

    # ---- showing

    def show_for(self, columns: Sequence[Column], present: str, first: int, last: int, sheet: Sheet) -> None:
        """For these columns and rows (from 0)."""
        self.sheet = sheet
        if tuple(columns) != tuple(self.columns):
            self.columns = tuple(columns)
            self.column.clear()
            for column in columns:
                self.column.addItem(column.heading, column.letter)
        self.column.setCurrentIndex(max(self.column.findData(present), 0))
        self.first.setText(str(first + 1))
        self.last.setText(str(last + 1))
        for line, text in ((self.formula, f"{ROW}*0.1"), (self.start, "0"), (self.end, "1")):
            if not line.text():
                line.setText(text)
        self._refresh()
        self.show()
        self.raise_()
        self.activateWindow()

    def filling(self) -> Filling | str:
        """What the fields say, or what is wrong with them in one sentence."""
        if self.sheet is None or not self.columns:
            return "There is no column to fill"
        rows = self._rows(self.sheet)
        if isinstance(rows, str):
            return rows
        first, count = rows
        letter, how = self.column.currentData(), self.how.currentData()
        if how == FORMULA:
            made = fill(self.formula.text(), count, 0)
            if isinstance(made, Bad):
                return f"Formula: {made.message}"
            return Filling(letter, first, made, places=False)
        ends: list[Fraction] = []
        for words, line in (("From", self.start), ("To", self.end)):
            number = parse_number(line.text())
            if number is None:
                return f"{words}: {number_problem(line.text())}"
            ends.append(number)
        places = next(each.places for each in self.columns if each.letter == letter)
        if self.sheet.steps:  # the first row ends where the first part of the way is done
            return Filling(letter, first, rise(Law(how), count + 1, *ends, places)[1:], places=True)
        return Filling(letter, first, rise(Law(how), count, *ends, places), places=True)

    def _rows(self, sheet: Sheet) -> tuple[int, int] | str:
        first, last = parse_number(self.first.text()), parse_number(self.last.text())
        whole = all(each is not None and each.denominator == 1 for each in (first, last))
        if first is None or last is None or not whole or not 1 <= first <= last:
            return "Rows: write the first and the last one, counted from 1"
        if last > sheet.most_rows:
            return f"Rows: at most {sheet.most_rows}"
        return int(first) - 1, int(last - first) + 1

    def _refresh(self) -> None:
        formula = self.how.currentData() == FORMULA
        for line, on in ((self.formula, formula), (self.start, not formula), (self.end, not formula)):
            self.form.setRowVisible(line, on)
        self.about.setText(FORMULA_HELP if formula else LAW_HELP[Law(self.how.currentData())])
        made = self.filling()
        wrong = isinstance(made, str)
        self.fill.setEnabled(not wrong)
        self.preview.setProperty("role", "warning" if wrong else "code")
        self.preview.style().polish(self.preview)
        self.preview.setText(f"! {made}" if isinstance(made, str) else _some(made.texts))

    def _fill(self) -> None:
        made = self.filling()
        if isinstance(made, Filling):
            self.wanted.emit(made)


def _some(texts: Sequence[str]) -> str:
    if len(texts) <= SHOWN:
        return "   ".join(texts)
    return "   ".join((*texts[: SHOWN - 2], "…", *texts[-1:])) + f"   ({len(texts)} rows)"
