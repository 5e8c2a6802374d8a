"""Builds an expression: what it is made of, what is wrong with it, and the value it would have now."""

from __future__ import annotations

import re
from collections.abc import Mapping
from fractions import Fraction
from functools import partial

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QCloseEvent, QKeyEvent
from PySide6.QtWidgets import (
    QDialog,
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QScrollArea,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from codegen.expressions import Bad, Expression, Operand, parse_expression, write
from codegen.formula import Unknown, evaluate, leaves
from codegen.ingredients import Ingredient, ingredients
from codegen.numbers import number_problem, parse_number, shown
from widgets.form.judge import Judge
from widgets.form.offers import Offers
from widgets.parts.foot import foot
from widgets.parts.look import look

WHAT = Qt.ItemDataRole.UserRole
HELP = "Expressions"
RAW = "Positions and speeds of the controller are raw counts here."
OFFLINE = "not known offline: assume a value below to see the result"


class ExpressionBuilder(QDialog):
    """Not modal. `accepted_text` brings the finished expression."""

    accepted_text = Signal(str)

    def __init__(self, offers: Offers, judge: Judge, text: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.offers, self.judge = offers, judge
        self.watcher = object()  # under this name values are read for it
        if offers.live is not None:
            self.destroyed.connect(partial(offers.live.forget, self.watcher))
        self.live: Mapping[str, float | str] = {}
        self.assumed: dict[str, QLineEdit] = {}
        self.kept: dict[str, str] = {}  # what was assumed for names that are gone for the moment
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setModal(False)
        self.setProperty("helpPage", HELP)
        self.setWindowTitle(f"Expression: {judge.label}")
        self.line = _line("Expression")
        self.line.setFont(look().code_font())
        self.line.setText(text)
        self.search = _line("Search what it can be made of")
        self.search.setPlaceholderText("Search: position, input, sine …")
        self.search.setClearButtonEnabled(True)
        self.tree = QTreeWidget()
        self.tree.setColumnCount(2)
        self.tree.setHeaderLabels(["What", "Written"])
        self.tree.setAccessibleName("What an expression is made of")
        self.tree.setUniformRowHeights(True)
        self.verdict, self.value, self.about = _words("warning"), _words("sentence"), _words("quiet")
        self.verdict.setAccessibleName("Check")
        self.value.setAccessibleName("Value now")
        self.assumptions = QWidget()
        self.rows = QFormLayout(self.assumptions)
        self.use, self.cancel = QPushButton("Use it"), QPushButton("Cancel")
        self._fill_tree()
        self._lay_out()
        self._join()
        self._refresh()
        self.line.setFocus()

    def _fill_tree(self) -> None:
        groups: dict[str, QTreeWidgetItem] = {}
        for each in ingredients(self.offers.variables, self.offers.arrays, self.offers.setup.limits):
            if each.group not in groups:
                groups[each.group] = QTreeWidgetItem(self.tree, [each.group])
                groups[each.group].setFlags(Qt.ItemFlag.ItemIsEnabled | Qt.ItemFlag.ItemIsSelectable)
            item = QTreeWidgetItem(groups[each.group], [each.meaning, each.text])
            item.setData(0, WHAT, each)
            item.setToolTip(0, each.help or each.meaning)
            item.setFont(1, look().code_font())
        self.tree.setColumnWidth(0, 330)

    def _lay_out(self) -> None:
        column = QVBoxLayout(self)
        column.setContentsMargins(16, 12, 16, 12)
        column.setSpacing(6)
        top = QHBoxLayout()
        top.addWidget(self.line, 1)
        top.addWidget(QLabel(self.judge.unit))
        column.addLayout(top)
        for label in (self.verdict, self.value):
            label.setMinimumHeight(label.fontMetrics().height() + 4)
            column.addWidget(label)
        self.area = QScrollArea()
        self.area.setWidgetResizable(True)
        self.area.setFrameShape(QScrollArea.Shape.NoFrame)
        self.area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.area.setMaximumHeight(4 * (look().control + 6))
        self.rows.setContentsMargins(0, 0, 0, 0)
        self.area.setWidget(self.assumptions)
        column.addWidget(self.area)
        column.addWidget(self.search)
        column.addWidget(self.tree, 1)
        self.about.setMinimumHeight(2 * self.about.fontMetrics().height())
        column.addWidget(self.about)
        for button in (self.use, self.cancel):
            button.setAutoDefault(False)
        self.use.setProperty("role", "primary")
        column.addWidget(foot(self.use, away=self.cancel))
        self.resize(560, 560)

    def _join(self) -> None:
        self.line.textChanged.connect(self._refresh)
        self.search.textChanged.connect(self._filter)
        self.tree.itemActivated.connect(lambda item, _: self._put_in(item))
        self.tree.currentItemChanged.connect(lambda item, _: self._tell_about(item))
        self.use.clicked.connect(self._use)
        self.cancel.clicked.connect(self.close)

    # ---- putting in

    def _put_in(self, item: QTreeWidgetItem) -> None:
        what = item.data(0, WHAT)
        if not isinstance(what, Ingredient):
            item.setExpanded(not item.isExpanded())
            return
        chosen = self.line.selectedText()
        if what.back and chosen:  # brackets go around what is selected
            self.line.insert(what.text[: -what.back] + chosen + what.text[-what.back :])
        else:
            self.line.insert(what.text)
            self.line.setCursorPosition(self.line.cursorPosition() - what.back)
        self.line.setFocus()

    def _tell_about(self, item: QTreeWidgetItem | None) -> None:
        what = item.data(0, WHAT) if item is not None else None
        self.about.setText(what.help or what.meaning if isinstance(what, Ingredient) else "")

    def _filter(self, text: str) -> None:
        """Every word must be in the meaning, the spelling or the group; where none is found, in the help."""
        words = text.lower().split()
        everything = [group.child(place) for group in self._groups() for place in range(group.childCount())]
        deep = not any(self._matches(item, words, deep=False) for item in everything)
        first: QTreeWidgetItem | None = None
        for group in self._groups():
            found = [self._matches(group.child(place), words, deep=deep) for place in range(group.childCount())]
            for place, shown_ in enumerate(found):
                group.child(place).setHidden(not shown_)
                first = first or (group.child(place) if shown_ and words else None)
            group.setHidden(not any(found))
            group.setExpanded(bool(words))
        if first is not None:
            self.tree.setCurrentItem(first)

    def _groups(self) -> list[QTreeWidgetItem]:
        found = (self.tree.topLevelItem(number) for number in range(self.tree.topLevelItemCount()))
        return [group for group in found if group is not None]

    @staticmethod
    def _matches(item: QTreeWidgetItem, words: list[str], *, deep: bool) -> bool:
        what: Ingredient = item.data(0, WHAT)
        everything = f"{what.group} {what.meaning} {what.text} {what.help if deep else ''}".lower()
        alone = set(re.findall(r"\w+", everything))  # a single letter is an axis
        return all(word in (alone if len(word) == 1 and word.isalpha() else everything) for word in words)

    # ---- checking and working out

    def tree_of_text(self) -> Expression | None:
        """The expression, when it is right."""
        tree = parse_expression(self.line.text())
        return None if isinstance(tree, Bad) or self.judge.problem(self.line.text()) else tree

    def _refresh(self) -> None:
        text = self.line.text()
        problem = self.judge.problem(text) if text.strip() else ""
        self.verdict.setText(f"! {problem}" if problem else RAW if self.judge.raw else self.judge.counts(text))
        self.verdict.setProperty("role", "warning" if problem else "quiet")
        self.verdict.style().polish(self.verdict)
        self.use.setEnabled(not problem)
        tree = self.tree_of_text()
        wanted = tuple(map(write, leaves(tree))) if tree is not None else ()
        if tree is not None or not text.strip():
            self._show_assumptions(wanted)
        self.live = {}
        if self.offers.live is not None:
            if wanted:
                self.offers.live.watch(self.watcher, wanted, self._read)
            else:
                self.offers.live.forget(self.watcher)
        self._show_value()

    def _read(self, values: Mapping[str, float | str]) -> None:
        """What the controller says of the names now; nothing while there is none."""
        self.live = values
        self._show_value()

    def _show_assumptions(self, wanted: tuple[str, ...]) -> None:
        """A field for each name, to try values without a machine."""
        if tuple(self.assumed) == wanted:
            return
        self.kept.update({name: line.text() for name, line in self.assumed.items()})
        while self.rows.rowCount():
            self.rows.removeRow(0)
        self.assumed = {}
        for name in wanted:
            line = _line(f"Assumed value of {name}")
            line.setText(self.kept.get(name, ""))
            line.setPlaceholderText("assumed value, raw" if name.startswith("_") else "assumed value")
            line.textEdited.connect(self._show_value)
            self.assumed[name] = line
            self.rows.addRow(f"{name} =", line)
        self.area.setVisible(bool(wanted))

    def _show_value(self) -> None:
        tree = self.tree_of_text()
        self.value.setText("" if tree is None else self._worked_out(tree))

    def _worked_out(self, tree: Expression) -> str:
        """`Now 12.5 in`, `With the assumed values 3 in`, or why it has no value."""
        values: dict[str, Fraction] = {}
        assumed = False
        for leaf in leaves(tree):
            name = write(leaf)
            typed = self.assumed[name].text().strip() if name in self.assumed else ""
            read = self.live.get(name)
            if typed:
                number = parse_number(typed)
                if number is None:
                    return f"{name}: {number_problem(typed)}"
                values[name], assumed = number, True
            elif isinstance(read, str):
                return f"{name}: {read}"
            elif read is None:
                return f"Value now: {OFFLINE}" if not self.live else f"Value now: {name} is being read"
            else:
                values[name] = Fraction(read)
            if isinstance(leaf, Operand):
                values[name] /= self.judge.factor(leaf)
        try:
            result = f"{shown(evaluate(tree, values), 8)} {self.judge.unit}".strip()
        except Unknown as unknown:
            return f"Value now: {unknown}"
        if not values:
            return f"It is {result}"
        return f"With the assumed values: {result}" if assumed else f"Now: {result}"

    # ---- leaving

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Enter in the line takes the expression; in the search it puts in what is marked."""
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            present = self.tree.currentItem()
            if self.search.hasFocus() and present is not None:
                self._put_in(present)
            elif not self.tree.hasFocus():
                self._use()
            return
        if event.key() == Qt.Key.Key_Down and self.search.hasFocus():
            self.tree.setFocus()
            return
        super().keyPressEvent(event)

    def _use(self) -> None:
        if self.use.isEnabled():
            self.accepted_text.emit(self.line.text())
            self.close()

    def reject(self) -> None:
        """Escape closes it."""
        self.close()

    def closeEvent(self, event: QCloseEvent) -> None:
        """Nothing is read for it any more."""
        if self.offers.live is not None:
            self.offers.live.forget(self.watcher)
        super().closeEvent(event)


def _line(name: str) -> QLineEdit:
    line = QLineEdit()
    line.setAccessibleName(name)
    line.setMinimumHeight(look().control)
    return line


def _words(role: str) -> QLabel:
    label = QLabel()
    label.setProperty("role", role)
    label.setWordWrap(True)
    label.setTextFormat(Qt.TextFormat.PlainText)
    return label
