"""The fields of one frozen value as a form; built from the definitions, refreshed in place."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Generator, Iterator, Mapping
from functools import partial
from itertools import groupby, pairwise
from typing import Any

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import QApplication, QGridLayout, QHBoxLayout, QLabel, QVBoxLayout, QWidget

from codegen import fields, read
from codegen.docs import field_page
from widgets.form.cell import Cell, focus_in
from widgets.form.editors import AXIS_EDITORS, EDITORS, NUMBER_WIDTH, LineEditor, choice_list, in_little_room, maker_for
from widgets.form.grid_editor import GridEditor
from widgets.form.judge import judge_of
from widgets.form.offers import Offers
from widgets.form.rows import RowsEditor
from widgets.parts.look import look

SILENT = (fields.Flag, fields.Choice, fields.AxisName, fields.ListOf)  # seldom wrong: no line is kept free
COLUMNS = 3  # of a table of axes
TIGHT_WIDTH = 124  # px, of a number where fields stand side by side
AXIS_SETS = ("axes", "slaves")  # names of the fields that say which axes take part
BELOW = 176  # least height of a picture there, px
HIGH = 3  # rows above a list that leave room below its entries
MOST_ROWS = 12  # a form that is longer has its last fields beside the others
Rows = Generator[None, None, int]  # pieces of some rows; the first row below them
Key = tuple[str, str]  # field name, axis letter ("" for a field that is not per axis)


class FieldsForm(QWidget):
    """Shows one instruction (or row of a list) and emits the new one after each change."""

    edited = Signal(object)

    def __init__(
        self, offers: Offers, *, narrow: bool = False, dense: bool = False, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.offers = offers
        self.dense = dense  # beside others, where height is dear
        self.narrow = narrow  # labels above their fields, lists instead of rows of buttons
        self.item: Any = None
        self.tight = False  # no line is kept free below the fields
        self.path = ""  # of a row in a list: the axes that all rows move together
        self.cells: dict[Key, Cell] = {}
        self.labels: dict[str, list[QWidget]] = {}
        self.places: dict[str, tuple[QGridLayout, int]] = {}  # of fields in rows
        self.letters: list[tuple[QLabel, str, tuple[str, ...]]] = []  # before a row of these fields
        self.column = QVBoxLayout(self)
        self.column.setContentsMargins(0, 0, 0, 0)
        self.inside = QWidget(self)
        self.grid = QGridLayout(self.inside)

    # ---- showing

    def show_item(self, item: Any) -> None:
        """Shows `item`; only another kind of item builds the form anew."""
        for _ in self.showing(item):
            pass

    def showing(self, item: Any) -> Iterator[None]:
        """The same in pieces."""
        if type(item) is not type(self.item):
            self.item = item
            yield from self._build()
        self.item = item
        for (name, axis), cell in self.cells.items():
            cell.editor.setValue(_part(getattr(item, name), axis))
            yield
        yield from self._refreshing()

    def show_offers(self, offers: Offers) -> None:
        """Other names in the lists; another machine builds the form anew."""
        before, self.offers = self.offers, offers
        if self.item is None:
            return
        if offers.setup != before.setup:
            item, self.item = self.item, None
            self.show_item(item)
            return
        for cell in self.cells.values():
            follow = getattr(cell.editor, "show_offers", None)
            if follow is not None:
                follow(offers)

    def show_path(self, letters: str) -> None:
        """The axes that the rows of the list move together."""
        if letters != self.path:
            self.path = letters
            if self.item is not None:
                self.refresh()

    def refresh(self) -> None:
        """Shows and hides fields, and tells units, counts and problems as they are now."""
        for _ in self._refreshing():
            pass

    def _refreshing(self) -> Iterator[None]:
        for name, widgets in self.labels.items():
            visible = read.shown(self.item, name)
            for widget in widgets:
                widget.setVisible(visible)
        for axis, letter, names in self.letters:
            axis.setVisible(any(self.is_shown(name, letter) for name in names))
        for key, cell in self.cells.items():
            self._refresh_cell(key, cell)
            yield

    def _refresh_cell(self, key: Key, cell: Cell) -> None:
        name, axis = key
        visible = self.is_shown(name, axis)
        cell.setVisible(visible)
        if not visible:
            return
        setup, field = self.offers.setup, fields.fields_of(self.item)[name]
        if isinstance(field, fields.ListOf):
            cell.editor.show_path(read.row_axes(self.item, field))
        if isinstance(cell.editor, GridEditor):
            cell.editor.show_item(self.item, setup)
        axis = axis or read.row_axis(field, self.path)
        problem = read.problem_of(self.item, name, setup, axis)
        if isinstance(cell.editor, RowsEditor) and cell.editor.rows:
            problem = None  # the open row says it at the field
        elif problem and isinstance(cell.editor, RowsEditor):
            problem = cell.editor.invitation
        label = field.label
        counts = read.counts_text(self.item, name, setup, axis)
        cell.show_facts(
            read.unit_text(self.item, name, setup, axis),
            "" if counts == _part(getattr(self.item, name), key[1]) else counts,
            _short(read.warning_of(self.item, name, setup, axis), label, axis),
            _short(problem, label, axis),
        )

    def is_shown(self, name: str, axis: str = "") -> bool:
        """Whether a field counts now; of the axes, those that take part and those that have a value."""
        if not read.shown(self.item, name):
            return False
        return not axis or axis in self._axes() or bool(_part(getattr(self.item, name), axis))

    def _axes(self) -> str:
        """The axes that take part: those the instruction or the list names, else all."""
        if self.path:
            return self.path
        members = fields.fields_of(self.item)
        for name in AXIS_SETS:
            if isinstance(members.get(name), fields.AxisSet) and read.shown(self.item, name):
                chosen: str = getattr(self.item, name)
                return chosen or self.offers.setup.letters
        return self.offers.setup.letters

    def put_below(self, name: str, widget: QWidget) -> bool:
        """Puts a picture below the entries of a list, when that stands high enough; whether it did."""
        grid, row = self.places[name]
        editor = self.cells[name, ""].editor
        if self.narrow or row > HIGH or not (isinstance(editor, RowsEditor) and editor.beside):
            return False
        editor.put_below(widget)
        widget.setMinimumHeight(max(widget.minimumHeight(), BELOW))
        grid.setRowStretch(row, 10)
        return True

    def typed_into(self) -> str:
        """The name of the field that has the focus, or nothing."""
        inside = QApplication.focusWidget()
        found = (name for (name, _), cell in self.cells.items() if inside is not None and cell.isAncestorOf(inside))
        return next(found, "")

    def focus_first(self) -> None:
        """Puts the cursor into the first field that has a problem, else into the first one."""
        shown = [(key, cell) for key, cell in self.cells.items() if self.is_shown(*key)]
        wrong = [cell for (name, axis), cell in shown if read.problem_of(self.item, name, self.offers.setup, axis)]
        for cell in wrong or [cell for _, cell in shown]:
            focus_in(cell.editor)
            return

    # ---- building

    def _build(self) -> Iterator[None]:
        """From the outside inwards: what is put into something later is dressed anew, and all that is in it."""
        old, self.inside = self.inside, QWidget(self)
        self.cells.clear()
        self.labels.clear()
        self.letters.clear()
        beside = QHBoxLayout(self.inside)
        beside.setContentsMargins(0, 0, 0, 0)
        beside.setSpacing(16)
        columns = _columns(fields.fields_of(self.item), self.narrow)
        self.tight = self.dense or len(columns) > 1
        for members in columns:
            self.grid = QGridLayout()
            self.grid.setContentsMargins(0, 0, 0, 0)
            self.grid.setHorizontalSpacing(8 if self.tight else 12)
            self.grid.setVerticalSpacing(0)
            self.last_column = QVBoxLayout()
            beside.addLayout(self.last_column)
            self.last_column.addLayout(self.grid)
            yield from self._fill(members)
        self.column.addWidget(self.inside)
        old.hide()
        self.column.removeWidget(old)
        old.deleteLater()
        if self.isVisible():
            self._order_tabs()

    def _fill(self, members: Mapping[str, fields.Field]) -> Iterator[None]:
        row = 0
        for per_axis, group in _groups(members):
            add = self._add_rows if not per_axis else self._add_list if self.narrow else self._add_table
            row = yield from add(group, row)
        self.grid.setRowStretch(row, 1)
        self.grid.setColumnStretch(5, 1)

    def showEvent(self, event: QShowEvent) -> None:
        """Tab order can only be set once all editors stand in one window."""
        super().showEvent(event)
        self._order_tabs()

    def _add_rows(self, members: Mapping[str, fields.Field], row: int) -> Rows:
        for name, field in members.items():
            editor = make_editor(field, self.offers, narrow=self.narrow)
            cell = self._cell(name, "", field, editor, field.label, wide=not self.narrow)
            label = self._label(field, editor)
            self.labels[name] = [label]
            self.places[name] = self.grid, row
            if self.narrow:
                self.grid.addWidget(label, row, 0, 1, 6)
                row += not isinstance(field, fields.Flag)
                self.grid.addWidget(cell, row, 0, 1, 6)
            else:
                self.grid.addWidget(label, row, 0, Qt.AlignmentFlag.AlignTop)
                self.grid.addWidget(cell, row, 1, 1, 5)
            row += 1
            yield
        return row

    def _label(self, field: fields.Field, editor: QWidget) -> QLabel:
        """The words before an editor; a flag carries its own."""
        label = QLabel("" if isinstance(field, fields.Flag) else field.label)
        label.setBuddy(editor)
        if not self.narrow:
            label.setFixedHeight(look().control)
        label.setToolTip(field.help)
        return label

    def _add_table(self, members: Mapping[str, fields.Field], row: int) -> Rows:
        """Values of several axes: one row for each axis, one column for each field."""
        for column, (name, field) in enumerate(members.items(), start=1):
            self.labels[name] = [self._heading(field)]
            self.grid.addWidget(self.labels[name][0], row, column)
        for letter in self.offers.setup.letters:
            row += 1
            self._letter(letter, tuple(members), row)
            for column, (name, field) in enumerate(members.items(), start=1):
                editor = make_axis_editor(field, self.offers)
                cell = self._cell(name, letter, field, editor, f"{field.label} {letter}", wide=False)
                self.grid.addWidget(cell, row, column, Qt.AlignmentFlag.AlignTop)
                yield
        return row + 1

    def _add_list(self, members: Mapping[str, fields.Field], row: int) -> Rows:
        """Values of several axes where there is little room: one field after the other, its axes below each other."""
        for name, field in members.items():
            self.labels[name] = [self._heading(field)]
            self.grid.addWidget(self.labels[name][0], row, 0, 1, 6)
            for letter in self.offers.setup.letters:
                row += 1
                self._letter(letter, (name,), row)
                editor = make_axis_editor(field, self.offers, narrow=True)
                cell = self._cell(name, letter, field, editor, f"{field.label} {letter}", wide=False)
                self.grid.addWidget(cell, row, 1, 1, 5, Qt.AlignmentFlag.AlignTop)
                yield
            row += 1
        return row

    def _heading(self, field: fields.Field) -> QLabel:
        """The words above the values of several axes."""
        heading = QLabel(field.label)
        heading.setToolTip(field.help)
        heading.setContentsMargins(0, 0, 0, 4)
        return heading

    def _letter(self, letter: str, names: tuple[str, ...], row: int) -> None:
        """The letter before the values of one axis."""
        axis = QLabel(letter)
        axis.setProperty("role", "title")
        axis.setAlignment(Qt.AlignmentFlag.AlignTop | Qt.AlignmentFlag.AlignRight)
        axis.setContentsMargins(0, 6, 0, 0)
        self.letters.append((axis, letter, names))
        self.grid.addWidget(axis, row, 0)

    def _cell(self, name: str, axis: str, field: fields.Field, editor: QWidget, words: str, *, wide: bool) -> Cell:
        silent = isinstance(field, SILENT) or isinstance(getattr(field, "of", None), SILENT)
        cell = Cell(editor, words, field.help, wide=wide, speaks=not silent, tight=self.tight, parent=self.inside)
        if title := getattr(type(self.item), "title", ""):  # rows of a list have none: theirs is that of the list
            cell.setProperty("helpPage", field_page(title, field.label))
        cell.changed.connect(lambda value: self._changed(name, axis, value))
        line = getattr(editor, "line", editor)
        if isinstance(line, LineEditor):
            if self.tight and line.maximumWidth() == NUMBER_WIDTH:
                line.setFixedWidth(TIGHT_WIDTH)
            line.judge = lambda: judge_of(self.item, name, axis, self.path, self.offers.setup)
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
        return RowsEditor(field, offers, partial(FieldsForm, narrow=narrow), narrow=narrow)
    if narrow and isinstance(field, fields.Choice):
        return in_little_room(choice_list(field))
    if narrow and isinstance(field, fields.Table):
        return GridEditor(field, offers, narrow=True)
    editor: QWidget = maker_for(field, EDITORS)(field, offers)
    return in_little_room(editor) if narrow else editor


def make_axis_editor(field: fields.Field, offers: Offers, *, narrow: bool = False) -> QWidget:
    """The editor for one axis of a per-axis field; it can be left empty."""
    inner = field.of if isinstance(field, fields.PerAxis) else field
    make = maker_for(inner, AXIS_EDITORS) or maker_for(inner, EDITORS)
    editor: QWidget = make(inner, offers)
    return in_little_room(editor) if narrow else editor


def _columns(members: Mapping[str, fields.Field], narrow: bool) -> list[dict[str, fields.Field]]:
    """The fields in one column, or in two of about the same height where one would be too high for a small screen."""
    names = list(members)
    rows = [_rows_of(field) for field in members.values()]
    if narrow or sum(rows) <= MOST_ROWS:
        return [dict(members)]
    split = min(range(1, len(names)), key=lambda at: max(sum(rows[:at]), sum(rows[at:])))
    return [{name: members[name] for name in part} for part in (names[:split], names[split:])]


def _rows_of(field: fields.Field) -> int:
    """About how high a field is."""
    if isinstance(field, fields.ListOf | fields.Table):
        return 9 if isinstance(field, fields.Table) else 8
    return 4 if isinstance(field, fields.PerAxis) else 1


def _groups(members: Mapping[str, fields.Field]) -> Iterator[tuple[bool, dict[str, fields.Field]]]:
    """The fields in the order of the form: up to three per-axis fields share one table, where the first stands."""
    tables = [name for name, field in members.items() if isinstance(field, fields.PerAxis)]
    if 1 < len(tables) <= COLUMNS:
        at = list(members).index(tables[0])
        others = [name for name in members if name not in tables]
        before = [name for name in others if list(members).index(name) < at]
        members = {name: members[name] for name in (*before, *tables, *others[len(before) :])}
    for per_axis, group in groupby(members.items(), key=lambda item: isinstance(item[1], fields.PerAxis)):
        yield per_axis, dict(group)


def _short(message: str | None, label: str, axis: str) -> str | None:
    """A message below its field need not say which field it means."""
    if message is None:
        return None
    message = message.removeprefix(f"{axis}: ")
    for start, instead in ((f"{label}: ", ""), (f"{label} will really be", "Really")):
        if message.startswith(start):
            message = instead + message.removeprefix(start)
    return message[:1].upper() + message[1:]


def _part(value: Any, axis: str) -> Any:
    return value[fields.AXES.index(axis)] if axis else value


def _stops(cell: QWidget) -> Iterator[QWidget]:
    for child in cell.findChildren(QWidget):
        own_window = child.window() is not cell.window()
        if child.focusPolicy() & Qt.FocusPolicy.TabFocus and child.focusProxy() is None and not own_window:
            yield child
