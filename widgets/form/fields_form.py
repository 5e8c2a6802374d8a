"""The fields of one frozen value as a form; built from the definitions, refreshed in place."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Iterator, Mapping
from itertools import groupby, pairwise
from typing import Any

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import QGridLayout, QLabel, QVBoxLayout, QWidget

from codegen import fields, read
from widgets.form.cell import Cell, focus_in
from widgets.form.editors import AXIS_EDITORS, EDITORS, choice_list, maker_for
from widgets.form.offers import Offers
from widgets.form.rows import RowsEditor
from widgets.parts.look import look

Key = tuple[str, str]  # field name, axis letter ("" for a field that is not per axis)


class FieldsForm(QWidget):
    """Shows one instruction (or row of a list) and emits the new one after each change."""

    edited = Signal(object)

    def __init__(self, offers: Offers, *, narrow: bool = False, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.offers = offers
        self.narrow = narrow  # labels above their fields, lists instead of rows of buttons
        self.item: Any = None
        self.cells: dict[Key, Cell] = {}
        self.labels: dict[str, list[QWidget]] = {}
        self.column = QVBoxLayout(self)
        self.column.setContentsMargins(0, 0, 0, 0)
        self.inside = QWidget()
        self.grid = QGridLayout(self.inside)

    # ---- showing

    def show_item(self, item: Any) -> None:
        """Shows `item`; only another kind of item builds the form anew."""
        if type(item) is not type(self.item):
            self.item = item
            self._build()
        self.item = item
        for (name, axis), cell in self.cells.items():
            cell.editor.setValue(_part(getattr(item, name), axis))
        self.refresh()

    def refresh(self) -> None:
        """Shows and hides fields, and tells units, counts and problems as they are now."""
        for name, widgets in self.labels.items():
            visible = read.shown(self.item, name)
            for widget in widgets:
                widget.setVisible(visible)
        for key, cell in self.cells.items():
            self._refresh_cell(key, cell)

    def _refresh_cell(self, key: Key, cell: Cell) -> None:
        name, axis = key
        visible = read.shown(self.item, name)
        cell.setVisible(visible)
        if not visible:
            return
        setup = self.offers.setup
        problem = read.problem_of(self.item, name, setup, axis)
        if isinstance(cell.editor, RowsEditor) and cell.editor.rows:
            problem = None  # the open row says it at the field
        cell.show_facts(
            read.unit_text(self.item, name, setup, axis),
            read.counts_text(self.item, name, setup, axis),
            read.warning_of(self.item, name, setup, axis),
            problem,
        )

    def focus_first(self) -> None:
        """Puts the cursor into the first field that has a problem, else into the first one."""
        shown = [(key, cell) for key, cell in self.cells.items() if read.shown(self.item, key[0])]
        wrong = [cell for (name, axis), cell in shown if read.problem_of(self.item, name, self.offers.setup, axis)]
        for cell in wrong or [cell for _, cell in shown]:
            focus_in(cell.editor)
            return

    # ---- building

    def _build(self) -> None:
        old, self.inside = self.inside, QWidget()
        self.cells.clear()
        self.labels.clear()
        self.grid = QGridLayout(self.inside)
        self.grid.setContentsMargins(0, 0, 0, 0)
        self.grid.setHorizontalSpacing(12)
        self.grid.setVerticalSpacing(8)
        row = 0
        for per_axis, group in groupby(fields.fields_of(self.item).items(), key=_table_key):
            members = dict(group)
            row = self._add_table(members, row) if per_axis is not None else self._add_rows(members, row)
        self.grid.setRowStretch(row, 1)
        self.grid.setColumnStretch(5, 1)
        self.column.addWidget(self.inside)
        old.hide()
        self.column.removeWidget(old)
        old.deleteLater()
        if self.isVisible():
            self._order_tabs()

    def showEvent(self, event: QShowEvent) -> None:
        """Tab order can only be set once all editors stand in one window."""
        super().showEvent(event)
        self._order_tabs()

    def _add_rows(self, members: Mapping[str, fields.Field], row: int) -> int:
        for name, field in members.items():
            editor = make_editor(field, self.offers, narrow=self.narrow)
            cell = self._cell(name, "", field, editor, field.label, wide=not self.narrow)
            label = self._label(field, editor)
            self.labels[name] = [label]
            if self.narrow:
                self.grid.addWidget(label, row, 0, 1, 6)
                row += not isinstance(field, fields.Flag)
                self.grid.addWidget(cell, row, 0, 1, 6)
            else:
                self.grid.addWidget(label, row, 0, Qt.AlignmentFlag.AlignTop)
                self.grid.addWidget(cell, row, 1, 1, 5)
            row += 1
        return row

    def _label(self, field: fields.Field, editor: QWidget) -> QLabel:
        """The words before an editor; a flag carries its own."""
        label = QLabel("" if isinstance(field, fields.Flag) else field.label)
        label.setBuddy(editor)
        if not self.narrow:
            label.setFixedHeight(look().control)
        label.setToolTip(field.help)
        return label

    def _add_table(self, members: Mapping[str, fields.Field], row: int) -> int:
        """Values of several axes: one row for each axis, one column for each field."""
        for column, (name, field) in enumerate(members.items(), start=1):
            heading = QLabel(field.label)
            heading.setToolTip(field.help)
            self.grid.addWidget(heading, row, column)
            self.labels[name] = [heading]
        letters = []
        for offset, letter in enumerate(self.offers.setup.letters, start=1):
            axis = QLabel(letter)
            axis.setProperty("role", "title")
            axis.setAlignment(Qt.AlignmentFlag.AlignTop | Qt.AlignmentFlag.AlignRight)
            axis.setContentsMargins(0, 6, 0, 0)
            letters.append(axis)
            self.grid.addWidget(axis, row + offset, 0)
            for column, (name, field) in enumerate(members.items(), start=1):
                editor = make_axis_editor(field, self.offers)
                cell = self._cell(name, letter, field, editor, f"{field.label} {letter}", wide=False)
                self.grid.addWidget(cell, row + offset, column, Qt.AlignmentFlag.AlignTop)
        self.labels[next(iter(members))] += letters
        return row + 1 + len(letters)

    def _cell(self, name: str, axis: str, field: fields.Field, editor: QWidget, words: str, *, wide: bool) -> Cell:
        cell = Cell(editor, words, field.help, wide=wide, parent=self.inside)
        cell.changed.connect(lambda value: self._changed(name, axis, value))
        self.cells[name, axis] = cell
        return cell

    def _changed(self, name: str, axis: str, value: Any) -> None:
        if axis:
            texts = list(getattr(self.item, name))
            texts[fields.AXES.index(axis)] = value
            value = tuple(texts)
        if value == getattr(self.item, name):
            return
        self.item = dc.replace(self.item, **{name: value})
        self.refresh()
        self.edited.emit(self.item)

    def _order_tabs(self) -> None:
        """Tab follows the eye: row by row."""
        stops = [stop for cell in self.cells.values() for stop in _stops(cell)]
        for one, other in pairwise(stops):
            QWidget.setTabOrder(one, other)


def make_editor(field: fields.Field, offers: Offers, *, narrow: bool = False) -> QWidget:
    """The editor for a field that stands alone."""
    if isinstance(field, fields.ListOf):
        return RowsEditor(field, offers, lambda offers: FieldsForm(offers, narrow=narrow), narrow=narrow)
    if narrow and isinstance(field, fields.Choice):
        return choice_list(field)
    editor: QWidget = maker_for(field, EDITORS)(field, offers)
    return editor


def make_axis_editor(field: fields.Field, offers: Offers) -> QWidget:
    """The editor for one axis of a per-axis field; it can be left empty."""
    inner = field.of if isinstance(field, fields.PerAxis) else field
    make = maker_for(inner, AXIS_EDITORS) or maker_for(inner, EDITORS)
    editor: QWidget = make(inner, offers)
    return editor


def _table_key(item: tuple[str, fields.Field]) -> str | None:
    """Neighbouring per-axis fields that are shown together share a table."""
    field = item[1]
    return repr(sorted(field.when.items())) if isinstance(field, fields.PerAxis) else None


def _part(value: Any, axis: str) -> Any:
    return value[fields.AXES.index(axis)] if axis else value


def _stops(cell: QWidget) -> Iterator[QWidget]:
    for child in cell.findChildren(QWidget):
        own_window = child.window() is not cell.window()
        if child.focusPolicy() & Qt.FocusPolicy.TabFocus and child.focusProxy() is None and not own_window:
            yield child
