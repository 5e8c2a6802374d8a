"""The grid of a table: typed, pasted, filled, undone, read and written; always a text that is read alike."""

from __future__ import annotations

import locale
from collections.abc import Callable
from pathlib import Path

import pytest
from PySide6.QtCore import QLocale, Qt
from PySide6.QtGui import QGuiApplication
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QLineEdit
from pytestqt.qtbot import QtBot

from codegen.instructions import ContourMode, ElectronicCam, Instruction
from codegen.laws import Law
from tests.widgets.form.clipping import machine_offers, open_dialog, settle
from widgets.form.fields_form import FieldsForm
from widgets.form.grid_editor import GridEditor

CONTROL = Qt.KeyboardModifier.ControlModifier
CAM = ElectronicCam(cycle="4", table="0\n1\n2\n1\n0", slaves="Y")


@pytest.fixture
def show(qtbot: QtBot) -> Callable[[Instruction], tuple[FieldsForm, GridEditor]]:
    """The form of an instruction with a table, and its grid."""

    def made(instruction: Instruction) -> tuple[FieldsForm, GridEditor]:
        form = FieldsForm(machine_offers("ssc4"))
        qtbot.addWidget(form)
        form.show_item(instruction)
        form.show()
        settle()
        editor = form.cells["table", ""].editor
        assert isinstance(editor, GridEditor)
        return form, editor

    return made


def type_in(editor: GridEditor, row: int, column: int, text: str, key: Qt.Key = Qt.Key.Key_Return) -> None:
    """As a person does: over what stands there, closed by a key."""
    editor.view.go_to(row, column)
    editor.view.setFocus()
    editor.view.edit_current()
    line = editor.view.findChild(QLineEdit)
    assert line is not None
    line.selectAll()
    QTest.keyClicks(line, text)
    QTest.keyClick(line, key)
    settle()


def clip(text: str) -> None:
    QGuiApplication.clipboard().setText(text)


def press(editor: GridEditor, name: str) -> None:
    QTest.mouseClick(editor.buttons[name], Qt.MouseButton.LeftButton)
    settle()


def test_a_number_is_typed_into_a_cell(show: Callable[..., tuple[FieldsForm, GridEditor]]) -> None:
    form, editor = show(CAM)
    type_in(editor, 2, 0, "2.5")
    assert form.item.table == "0\n1\n2.5\n1\n0"
    assert editor.model.data(editor.model.index(2, 0)) == "2"  # the master, 4 in in 4 stretches


@pytest.mark.parametrize(
    ("typed", "told"), [("2,5", "write 2.5"), ("1e3", "write 1000 without an exponent"), ("two", "is not a number")]
)
def test_what_is_no_number_stays_in_its_cell(
    show: Callable[..., tuple[FieldsForm, GridEditor]], typed: str, told: str
) -> None:
    form, editor = show(CAM)
    type_in(editor, 2, 0, typed)
    assert told in editor.message.text() and editor.message.isVisible()
    assert editor.view.findChild(QLineEdit) is not None  # it is still open
    QTest.keyClick(editor.view.findChild(QLineEdit), Qt.Key.Key_Escape)
    assert form.item.table == CAM.table


def test_rows_come_and_go_and_everything_is_undone(show: Callable[..., tuple[FieldsForm, GridEditor]]) -> None:
    form, editor = show(CAM)
    editor.view.go_to(1, 0)
    press(editor, "insert")
    assert form.item.table == "0\n0.5\n1\n2\n1\n0"
    press(editor, "append")
    assert form.item.table == "0\n0.5\n1\n2\n1\n0\n0"
    editor.view.go_to(1, 0)
    press(editor, "delete")
    assert form.item.table == "0\n1\n2\n1\n0\n0"
    for _ in range(3):
        QTest.keyClick(editor.view, Qt.Key.Key_Z, CONTROL)
    assert form.item.table == CAM.table
    QTest.keyClick(editor.view, Qt.Key.Key_Y, CONTROL)
    assert form.item.table == "0\n0.5\n1\n2\n1\n0"


def test_cells_go_to_a_spreadsheet_and_back(show: Callable[..., tuple[FieldsForm, GridEditor]]) -> None:
    form, editor = show(ElectronicCam(cycle="4", table="0\t5\n1\t6\n2\t7", slaves="YZ"))
    press(editor, "copy")
    assert QGuiApplication.clipboard().text() == "0\t5\n1\t6\n2\t7"
    clip("0,25\t0,5\r\n1,25\t1,5\r\n2\t3\r\n4\t5\r\n")  # a German spreadsheet
    editor.view.go_to(1, 0)
    press(editor, "paste")
    assert form.item.table == "0\t5\n0.25\t0.5\n1.25\t1.5\n2\t3\n4\t5"
    clip("9\n8")
    editor.view.selectAll()
    press(editor, "paste")
    assert "Nothing" not in editor.message.text()
    assert form.item.table == "9\t\n8\t"  # all of it instead; the other column waits for its numbers


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("0,5\n1,5", "Nothing was pasted: row 1: '0,5' can be one number or two"),
        ("1\nabc", "Nothing was pasted: row 2, cell 1: 'abc' is not a number"),
        ("1\t2\t3", "Nothing was pasted: it has 3 columns; from “Y in” on there is 1"),
        ("1 000\n2", "Nothing was pasted: row 1, cell 1: write 1000 without blanks"),
    ],
)
def test_nothing_is_half_pasted(show: Callable[..., tuple[FieldsForm, GridEditor]], text: str, told: str) -> None:
    form, editor = show(CAM)
    clip(text)
    editor.view.go_to(0, 0)
    QTest.keyClick(editor.view, Qt.Key.Key_V, CONTROL)
    assert editor.message.text().startswith(f"! {told}")
    assert form.item.table == CAM.table


@pytest.mark.parametrize("name", ["C", "de_DE"])
def test_a_file_is_the_same_in_every_country(
    show: Callable[..., tuple[FieldsForm, GridEditor]], tmp_path: Path, name: str
) -> None:
    before = QLocale()
    QLocale.setDefault(QLocale(name))
    try:
        _, editor = show(ElectronicCam(cycle="4", table="0.125\t5\n-1234.5\t6", slaves="YZ"))
        editor.write_file(tmp_path / "cam.csv")
        assert (tmp_path / "cam.csv").read_bytes() == b"Y in;Z in\r\n0.125;5\r\n-1234.5;6\r\n"
        form, other = show(ElectronicCam(cycle="4", slaves="YZ"))
        other.read_file(tmp_path / "cam.csv")
        assert form.item.table == "0.125\t5\n-1234.5\t6"
        type_in(other, 0, 0, "2.25")
        assert form.item.table == "2.25\t5\n-1234.5\t6"
        assert locale.str(0.5) == "0.5"
    finally:
        QLocale.setDefault(before)


def test_a_file_that_is_no_table_is_told(show: Callable[..., tuple[FieldsForm, GridEditor]], tmp_path: Path) -> None:
    form, editor = show(CAM)
    for content, told in ((b"\xff\xfe\x00", "it is no text in UTF-8"), (b"a;b\nc;d", "'c' is not a number")):
        (tmp_path / "x.csv").write_bytes(content)
        editor.read_file(tmp_path / "x.csv")
        assert editor.message.text().startswith("! x.csv was not read: ") and told in editor.message.text()
    editor.read_file(tmp_path / "none.csv")
    assert "No such file" in editor.message.text()
    assert form.item.table == CAM.table


def test_a_column_is_filled_by_a_law(show: Callable[..., tuple[FieldsForm, GridEditor]]) -> None:
    """Cycloidal from 0 to 2: half the way in the middle, u - sin(2πu)/2π = 0.0908 at a quarter."""
    form, editor = show(ElectronicCam(cycle="4", slaves="Y"))
    press(editor, "fill")
    dialog = editor.fill_dialog
    assert dialog is not None and dialog.isVisible() and not dialog.isModal()
    dialog.how.setCurrentIndex(dialog.how.findData(Law.CYCLOIDAL))
    for line, text in ((dialog.last, "5"), (dialog.end, "2")):
        line.selectAll()
        QTest.keyClicks(line, text)
    QTest.mouseClick(dialog.fill, Qt.MouseButton.LeftButton)
    assert form.item.table == "0\n0.18169\n1\n1.81831\n2"  # 2(1/4 - 1/2π) = 0.181690
    dialog.how.setCurrentIndex(0)
    dialog.formula.selectAll()
    QTest.keyClicks(dialog.formula, "N+N*2")
    assert not dialog.fill.isEnabled() and "group it with brackets" in dialog.preview.text()
    dialog.formula.selectAll()
    QTest.keyClicks(dialog.formula, "N*0.5")
    QTest.keyClick(dialog.formula, Qt.Key.Key_Return)
    assert form.item.table == "0\n0.5\n1\n1.5\n2"
    dialog.close()


def test_a_law_over_steps_ends_where_it_says(show: Callable[..., tuple[FieldsForm, GridEditor]]) -> None:
    form, editor = show(ContourMode(table="0\n0\n0\n0"))
    press(editor, "fill")
    dialog = editor.fill_dialog
    assert dialog is not None
    dialog.how.setCurrentIndex(dialog.how.findData(Law.STRAIGHT))
    dialog.end.selectAll()
    QTest.keyClicks(dialog.end, "2")
    QTest.mouseClick(dialog.fill, Qt.MouseButton.LeftButton)
    assert form.item.table == "0.5\n0.5\n0.5\n0.5"
    dialog.close()


def test_steps_are_shown_and_typed_as_positions(show: Callable[..., tuple[FieldsForm, GridEditor]]) -> None:
    form, editor = show(ContourMode(table="1\n1\n1"))
    QTest.mouseClick(editor.added_up, Qt.MouseButton.LeftButton)
    assert [editor.model.text(row, 0) for row in range(3)] == ["1", "2", "3"]
    type_in(editor, 1, 0, "2.5")
    assert form.item.table == "1\n1.5\n0.5"
    QTest.mouseClick(editor.added_up, Qt.MouseButton.LeftButton)
    assert editor.model.text(1, 0) == "1.5"


def test_columns_follow_the_axes_and_come_back(show: Callable[..., tuple[FieldsForm, GridEditor]]) -> None:
    form, editor = show(ElectronicCam(cycle="4", table="0\t5\n1\t6", slaves="YZ"))
    slaves = form.cells["slaves", ""].editor
    QTest.mouseClick(slaves.buttons["Y"], Qt.MouseButton.LeftButton)
    assert (form.item.slaves, form.item.table) == ("Z", "5\n6")
    QTest.mouseClick(slaves.buttons["Y"], Qt.MouseButton.LeftButton)
    assert (form.item.slaves, form.item.table) == ("YZ", "0\t5\n1\t6")
    assert editor.model.columnCount() == 3


def test_another_step_is_shown_and_not_changed(show: Callable[..., tuple[FieldsForm, GridEditor]]) -> None:
    form, editor = show(ElectronicCam(cycle="4", table="0\t5\n1\t6", slaves="YZ"))
    edited: list[object] = []
    form.edited.connect(edited.append)
    form.show_item(ElectronicCam(cycle="4", table="7\n8", slaves="W"))
    assert edited == [] and editor.cells == (("7",), ("8",))
    form.show_item(ElectronicCam(cycle="4", table="7\n1,234;5", slaves="W"))  # as somebody typed it into a file
    assert edited == [] and editor.value() == "7\n1,234;5"
    QApplication.processEvents()


def test_what_is_being_typed_is_not_lost_when_the_dialog_is_left_by_its_key(qtbot: QtBot) -> None:
    dialog = open_dialog(ElectronicCam, "ssc4", "example")
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose, False)
    qtbot.addWidget(dialog)
    added: list[Instruction] = []
    dialog.added.connect(lambda instruction, section, stay: added.append(instruction))
    editor = dialog.form.fields.cells["table", ""].editor
    editor.view.go_to(1, 0)
    editor.view.setFocus()
    editor.view.edit_current()
    line = editor.view.findChild(QLineEdit)
    line.selectAll()
    QTest.keyClicks(line, "0.5")
    QTest.keyClick(line, Qt.Key.Key_Return, CONTROL)
    settle()
    if not added:  # the first one closed the cell
        QTest.keyClick(dialog, Qt.Key.Key_Return, CONTROL)
    (cam,) = added
    assert cam.table.split("\n")[1] == "0.5"  # type: ignore[attr-defined]


def test_a_cell_that_holds_no_number_is_not_passed_over_by_a_click_on_add(qtbot: QtBot) -> None:
    dialog = open_dialog(ElectronicCam, "ssc4", "example")
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose, False)
    qtbot.addWidget(dialog)
    added: list[object] = []
    dialog.added.connect(lambda *what: added.append(what))
    editor = dialog.form.fields.cells["table", ""].editor
    editor.view.go_to(1, 0)
    editor.view.setFocus()
    editor.view.edit_current()
    line = editor.view.findChild(QLineEdit)
    line.selectAll()
    QTest.keyClicks(line, "0,5")
    assert not dialog.buttons["Add"].isEnabled() and "write 0.5" in dialog.buttons["Add"].toolTip()
    dialog.note.setFocus()  # the cell closes; its text was not taken
    settle()
    assert "keeps 0.25" in editor.message.text()
    QTest.mouseClick(dialog.buttons["Add"], Qt.MouseButton.LeftButton)
    assert added == [] and dialog.isVisible()
    editor.view.go_to(2, 0)  # seen: another cell is chosen
    assert dialog.buttons["Add"].isEnabled()
