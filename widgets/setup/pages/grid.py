"""Values of the axes side by side: a row for each field, a column for each axis."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Iterator, Sequence
from typing import Any

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QComboBox, QGridLayout, QLabel, QLineEdit, QWidget

from codegen.fields import Choice, Context, Field, Flag, fields_of
from codegen.setup import Axis, Setup
from codegen.setup_differences import mark
from codegen.setup_registers import OF_FIELD
from widgets.form.cell import Cell
from widgets.form.editors import FlagEditor, LineEditor, choice_list
from widgets.form.offers import Offers
from widgets.parts.look import look
from widgets.parts.pieces import Pieces
from widgets.setup.pages.page import Shown

COLUMN = 148  # px of an axis


class AxisGrid(QWidget):
    """Shows fields of some axes; emits the whole setup after each change."""

    edited = Signal(object)

    def __init__(self, names: Sequence[str], empty: str = "not set") -> None:
        super().__init__()
        self.names, self._empty = tuple(names), empty
        self.letters = ""
        self.cells: dict[tuple[str, str], Cell] = {}
        self._inside = QWidget(self)
        self._whole = QGridLayout(self)
        self._whole.setContentsMargins(0, 0, 0, 0)
        self._shown: Shown | None = None
        self._making: Pieces | None = None

    def show_axes(self, shown: Shown, letters: str) -> None:
        """Shows these axes; other axes build the grid anew."""
        for _ in self.showing(shown, letters):
            pass

    def showing(self, shown: Shown, letters: str) -> Iterator[None]:
        """The same in pieces; whoever cannot wait takes over what is there already."""
        self._shown = shown
        if letters != self.letters or self._making is None:
            self.letters = letters
            self._making = Pieces(self._build(shown.setup))
        while not self._making.step():
            yield
        for (name, letter), cell in self.cells.items():
            held = getattr(shown.setup.axis(letter), name)
            if cell.editor.value() != held:
                cell.editor.setValue(held)
            self._facts(cell, name, letter, shown)

    def _facts(self, cell: Cell, name: str, letter: str, shown: Shown) -> None:
        """Unit, counts, what is wrong, and what the controller holds otherwise."""
        setup, axis = shown.setup, shown.setup.axis(letter)
        field, held, context = fields_of(axis)[name], getattr(axis, name), Context(setup, letter)
        counts_for = self.counts_for(name, axis)
        cell.setVisible(counts_for)
        problem = field.problem(held, context) if counts_for else None
        counts = None if problem or field.empty(held) else field.counts(held, context)
        sent = counts.text if counts is not None and counts.text != held else ""
        other = mark(setup, shown.readings, name, letter)
        cell.show_facts(
            field.unit(context), sent, f"controller: {other}" if other else None, _short(problem, field.label)
        )
        if isinstance(cell.editor, QComboBox):
            cell.editor.setToolTip(f"{cell.editor.currentText()}\n{field.help}")

    @staticmethod
    def counts_for(name: str, axis: Axis) -> bool:
        """Whether the field means something for the motor of that axis."""
        registers = OF_FIELD.get(name, ())
        return not registers or any(each.counts_for(axis) for each in registers)

    def _build(self, setup: Setup) -> Iterator[None]:
        old, self._inside = self._inside, QWidget(self)
        self.cells.clear()
        grid = QGridLayout(self._inside)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(12)
        grid.setVerticalSpacing(0)
        for column, letter in enumerate(self.letters, start=1):
            head = QLabel(letter)
            head.setStyleSheet(f"color: {look().axis(letter).name()}; font-weight: 700;")
            grid.addWidget(head, 0, column)
            grid.setColumnMinimumWidth(column, COLUMN)
        for row, name in enumerate(self.names, start=1):
            field = fields_of(Axis)[name]
            label = QLabel(field.label)
            label.setToolTip(field.help)
            label.setMinimumHeight(look().control)
            grid.addWidget(label, row, 0, Qt.AlignmentFlag.AlignTop)
            for column, letter in enumerate(self.letters, start=1):
                grid.addWidget(self._cell(name, letter, field, setup), row, column, Qt.AlignmentFlag.AlignTop)
                yield
        grid.setColumnStretch(len(self.letters) + 1, 1)
        self._whole.addWidget(self._inside)
        self._whole.removeWidget(old)
        old.hide()
        old.deleteLater()

    def _cell(self, name: str, letter: str, field: Field, setup: Setup) -> Cell:
        editor: Any
        if isinstance(field, Choice):
            editor = choice_list(field)
            editor.setMinimumContentsLength(8)
            editor.setFixedWidth(COLUMN + 40 if len(self.letters) < 3 else COLUMN)
        elif isinstance(field, Flag):
            editor = FlagEditor(dc.replace(field, label="Yes"), Offers(setup))
        else:
            editor = LineEditor(field, Offers(setup))
            editor.setFixedWidth(COLUMN - 48)
            if isinstance(editor, QLineEdit):
                editor.setPlaceholderText(self._empty)
        cell = Cell(editor, f"{field.label} {letter}", field.help, wide=False, speaks=True, parent=self._inside)
        cell.changed.connect(lambda value: self._changed(name, letter, value))
        self.cells[name, letter] = cell
        return cell

    def _changed(self, name: str, letter: str, value: Any) -> None:
        if self._shown is None:
            return
        setup = self._shown.setup
        axis = setup.axis(letter)
        new = dc.replace(axis, **{name: value})
        if new.is_stepper != axis.is_stepper:  # the numbers of one kind mean nothing to the other
            new = dc.replace(new, smoothing="")
        if new != axis:
            self.edited.emit(setup.with_axis(letter, new))


def _short(message: str | None, label: str) -> str | None:
    """A message below its field need not say which field it means."""
    if message is None:
        return None
    message = message.removeprefix(f"{label}: ").removeprefix(f"{label} ")
    return message[:1].upper() + message[1:]
