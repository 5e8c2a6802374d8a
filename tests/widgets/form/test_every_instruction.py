"""Every instruction of the palette has a form that shows, emits and names all its values."""

from __future__ import annotations

from typing import Any

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QWidget
from pytestqt.qtbot import QtBot

from codegen import fields, read
from codegen.instructions import ALL, Instruction
from tests.widgets.form.samples import offers, other_value, plain, with_value
from widgets.form.fields_form import FieldsForm
from widgets.form.form import InstructionForm

EVERY = pytest.mark.parametrize("kind", ALL, ids=lambda kind: kind.__name__)


def form_of(qtbot: QtBot, instruction: Instruction) -> FieldsForm:
    """The form of an instruction, shown."""
    form = FieldsForm(offers())
    qtbot.addWidget(form)
    form.show_item(instruction)
    form.show()
    return form


def facts(form: FieldsForm) -> list[tuple[Any, ...]]:
    """Everything a form shows."""
    return [
        (key, cell.editor.value(), cell.unit.text(), cell.counts.text(), cell.problem.text(), cell.isHidden())
        for key, cell in form.cells.items()
    ]


@EVERY
def test_the_form_has_an_editor_for_each_value(qtbot: QtBot, kind: type[Instruction]) -> None:
    form = form_of(qtbot, kind())
    assert {name for name, _ in form.cells} == set(fields.fields_of(kind))
    for name, field in fields.fields_of(kind).items():
        axes = [axis for each, axis in form.cells if each == name]
        assert axes == (list("XY") if isinstance(field, fields.PerAxis) else [""])


@EVERY
def test_showing_the_same_value_twice_changes_nothing(qtbot: QtBot, kind: type[Instruction]) -> None:
    form = form_of(qtbot, kind())
    before, said = facts(form), []
    form.edited.connect(said.append)
    form.show_item(kind())
    form.refresh()
    assert facts(form) == before
    assert said == []


@EVERY
def test_a_changed_value_comes_out_as_the_right_frozen_instruction(qtbot: QtBot, kind: type[Instruction]) -> None:
    form = form_of(qtbot, kind())
    said: list[Instruction] = []
    form.edited.connect(said.append)
    for name, field in fields.fields_of(kind).items():
        form.show_item(kind())
        wanted = with_value(kind(), name, other_value(field, getattr(kind(), name)))
        axis = "X" if isinstance(field, fields.PerAxis) else ""
        value = getattr(wanted, name)
        form.cells[name, axis].editor.setValue(value[0] if axis else value)
        assert said == [], name  # setValue is silent: only the person's own change is an edit
        form.cells[name, axis].editor.changed.emit(value[0] if axis else value)
        assert said == [wanted], name
        assert form.item == wanted
        assert hash(form.item) == hash(wanted)
        said.clear()


@EVERY
def test_a_value_shown_is_read_back_the_same(qtbot: QtBot, kind: type[Instruction]) -> None:
    form = form_of(qtbot, kind())
    for name, field in fields.fields_of(kind).items():
        value = other_value(field, getattr(kind(), name))
        form.show_item(with_value(kind(), name, value))
        if isinstance(field, fields.PerAxis):
            assert [form.cells[name, letter].editor.value() for letter in "XY"] == list(value[:2])
        else:
            assert form.cells[name, ""].editor.value() == value, name


@EVERY
def test_fields_are_shown_exactly_when_they_count(qtbot: QtBot, kind: type[Instruction]) -> None:
    form = form_of(qtbot, kind())
    for (name, axis), cell in form.cells.items():
        assert cell.isHidden() == (not form.is_shown(name, axis))


@EVERY
def test_everything_that_takes_the_focus_has_a_name_for_a_screen_reader(qtbot: QtBot, kind: type[Instruction]) -> None:
    form = form_of(qtbot, kind())
    for widget in form.findChildren(QWidget):
        if widget.focusPolicy() != Qt.FocusPolicy.NoFocus and widget.window() is form and widget.focusProxy() is None:
            text = getattr(widget, "text", lambda: "")()
            assert widget.accessibleName() or text, f"{type(widget).__name__} of {kind.title}"


@EVERY
def test_tab_reaches_every_field_that_is_shown(qtbot: QtBot, kind: type[Instruction]) -> None:
    form = form_of(qtbot, kind())
    form.activateWindow()
    form.focus_first()
    shown = {key for key, cell in form.cells.items() if not cell.isHidden()}
    reached = set()
    for _ in range(80):
        focus = form.focusWidget()
        reached |= {key for key in shown if focus is not None and form.cells[key].isAncestorOf(focus)}
        form.focusNextChild()
    assert reached == shown


@EVERY
def test_the_form_says_the_sentence_and_the_reason(qtbot: QtBot, kind: type[Instruction]) -> None:
    form = InstructionForm(offers())
    qtbot.addWidget(form)
    form.show_instruction(kind())
    assert plain(form.preview.sentence.text()) == read.sentence(kind(), offers().setup)
    lists = [field.label for field in fields.fields_of(kind).values() if isinstance(field, fields.ListOf)]
    errors = [each.message for each in read.problems(kind(), offers().setup) if each.severity == "error"]
    if errors:
        assert form.problem() in (errors[0], *(f"Add at least one entry to “{label}”" for label in lists))
        assert form.problem() in form.preview.reason.text()
