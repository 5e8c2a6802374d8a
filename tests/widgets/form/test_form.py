"""What a form tells while it is filled in, and what its dialog does."""

from __future__ import annotations

import dataclasses as dc

import pytest
from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

from codegen.instructions import (
    AccelDecel,
    Instruction,
    Jump,
    Label,
    MathematicalEquation,
    PidGains,
    Print,
    SingleAxisMove,
    TwoLetterCode,
    Wait,
)
from codegen.instructions.math import Equation
from codegen.program import Step
from codegen.twoletter.commands import COMMANDS
from tests.widgets.form.samples import offers, plain
from widgets.form.command_list import CommandList
from widgets.form.dialog import InstructionDialog
from widgets.form.fields_form import FieldsForm
from widgets.form.form import InstructionForm
from widgets.form.inspector import Inspector


@pytest.fixture
def dialog(qtbot: QtBot) -> InstructionDialog:
    """The dialog of a new move."""
    dialog = InstructionDialog(SingleAxisMove(), offers(), new=True)
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose, False)
    qtbot.addWidget(dialog)
    dialog.show()
    return dialog


def test_add_is_grey_until_all_is_right_and_says_why(qtbot: QtBot, dialog: InstructionDialog) -> None:
    add = dialog.buttons["Add"]
    assert not add.isEnabled()
    assert add.toolTip() == "Distance is missing"
    qtbot.keyClicks(dialog.form.fields.cells["distance", ""].editor, "10")
    assert add.isEnabled()


def test_counts_and_unit_stand_beside_the_field(qtbot: QtBot, dialog: InstructionDialog) -> None:
    cell = dialog.form.fields.cells["distance", ""]
    qtbot.keyClicks(cell.editor, "10")
    assert cell.unit.text() == "in"
    assert cell.counts.text() == "6370 counts"  # 10 in x 637 counts/in
    assert not cell.problem.isVisible()


def test_a_decimal_comma_is_a_problem_at_the_field_at_once(qtbot: QtBot, dialog: InstructionDialog) -> None:
    cell = dialog.form.fields.cells["distance", ""]
    qtbot.keyClicks(cell.editor, "12,5")
    assert "12.5" in cell.problem.text()
    assert cell.problem.isVisible()
    assert not dialog.buttons["Add"].isEnabled()


def test_sentence_and_code_follow_every_key(qtbot: QtBot, dialog: InstructionDialog) -> None:
    qtbot.keyClicks(dialog.form.fields.cells["distance", ""].editor, "10")
    qtbot.keyClicks(dialog.form.fields.cells["speed", ""].editor, "5")
    assert plain(dialog.form.preview.sentence.text()).startswith("Move X by 10 in at 5 in/s")
    # 5 in/s x 637 = 3185, and speeds are even: 3184
    assert plain(dialog.form.preview.code.text()).split("   ") == [
        "PR 6370",
        "SP 3184",
        "BG X",
        "AM X",
    ]


def test_another_axis_changes_the_counts_of_all_fields(qtbot: QtBot, dialog: InstructionDialog) -> None:
    cells = dialog.form.fields.cells
    qtbot.keyClicks(cells["distance", ""].editor, "10")
    qtbot.mouseClick(cells["axis", ""].editor.buttons["Y"], Qt.MouseButton.LeftButton)
    assert cells["distance", ""].counts.text() == "10000 counts"
    assert dialog.form.instruction == SingleAxisMove(axis="Y", distance="10")


def test_add_and_next_adds_and_stays(qtbot: QtBot, dialog: InstructionDialog) -> None:
    added: list[tuple[Instruction, str, bool]] = []
    dialog.added.connect(lambda *what: added.append(what))
    qtbot.keyClicks(dialog.form.fields.cells["distance", ""].editor, "10")
    qtbot.mouseClick(dialog.buttons["Add and next"], Qt.MouseButton.LeftButton)
    assert added == [(SingleAxisMove(distance="10"), "", True)]
    assert dialog.isVisible()
    qtbot.mouseClick(dialog.buttons["Add"], Qt.MouseButton.LeftButton)
    assert len(added) == 2
    assert not dialog.isVisible()


def test_enter_with_a_problem_leads_to_the_field_and_adds_nothing(qtbot: QtBot, dialog: InstructionDialog) -> None:
    added: list[object] = []
    dialog.added.connect(lambda *what: added.append(what))
    qtbot.keyClick(dialog, Qt.Key.Key_Return, Qt.KeyboardModifier.ControlModifier)
    assert added == []
    assert dialog.isVisible()


def test_the_dialog_is_never_modal(dialog: InstructionDialog) -> None:
    assert not dialog.isModal()
    assert dialog.windowModality() == Qt.WindowModality.NonModal


def test_help_asks_for_the_page_of_the_instruction(qtbot: QtBot, dialog: InstructionDialog) -> None:
    with qtbot.waitSignal(dialog.help_requested) as asked:
        qtbot.mouseClick(dialog.buttons["Help"], Qt.MouseButton.LeftButton)
    assert asked.args == ["Single Axis Move"]


def test_an_instruction_for_either_section_asks_which(qtbot: QtBot) -> None:
    from codegen.instructions import Comment

    dialog = InstructionDialog(Comment(text="hello"), offers(), new=True)
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose, False)
    qtbot.addWidget(dialog)
    dialog.show()
    added: list[tuple[Instruction, str, bool]] = []
    dialog.added.connect(lambda *what: added.append(what))
    qtbot.mouseClick(dialog.section.buttons["configuration"], Qt.MouseButton.LeftButton)
    qtbot.mouseClick(dialog.buttons["Add"], Qt.MouseButton.LeftButton)
    assert added == [(Comment(text="hello"), "configuration", False)]


def test_a_table_of_axes_leaves_empty_axes_alone(qtbot: QtBot) -> None:
    form = FieldsForm(offers())
    qtbot.addWidget(form)
    form.show_item(AccelDecel())
    qtbot.keyClicks(form.cells["acceleration", "Y"].editor, "400")
    assert form.item.acceleration == ("", "400", "", "")


def test_rows_of_a_list_are_added_moved_and_removed(qtbot: QtBot) -> None:
    form = FieldsForm(offers())
    qtbot.addWidget(form)
    one, two = Equation(variable="A", expression="1"), Equation(variable="B", expression="2")
    form.show_item(MathematicalEquation(equations=(one, two)))
    editor = form.cells["equations", ""].editor
    qtbot.mouseClick(editor.buttons["down"], Qt.MouseButton.LeftButton)
    assert form.item.equations == (two, one)
    qtbot.mouseClick(editor.buttons["remove"], Qt.MouseButton.LeftButton)
    assert form.item.equations == (two,)
    qtbot.mouseClick(editor.buttons["add"], Qt.MouseButton.LeftButton)
    assert len(form.item.equations) == 2
    qtbot.mouseClick(editor.buttons["clear"], Qt.MouseButton.LeftButton)
    assert form.item.equations == ()
    assert not editor.buttons["remove"].isEnabled()


def test_the_inspector_sends_every_change_with_one_key(qtbot: QtBot) -> None:
    inspector = Inspector(offers())
    qtbot.addWidget(inspector)
    inspector.show_step(Step("s1", Wait(time="2")), offers())
    sent: list[tuple[str, Instruction, str]] = []
    inspector.edited.connect(lambda *what: sent.append(what))
    qtbot.keyClicks(inspector.form.fields.cells["time", ""].editor, "0")
    assert [(step, instruction) for step, instruction, _ in sent] == [("s1", Wait(time="20"))]
    assert sent[0][2]


def test_the_inspector_keeps_the_cursor_while_its_own_change_comes_back(qtbot: QtBot) -> None:
    inspector = Inspector(offers())
    qtbot.addWidget(inspector)
    step = Step("s1", Wait(time="20"))
    inspector.show_step(step, offers())
    editor = inspector.form.fields.cells["time", ""].editor
    editor.setCursorPosition(1)
    qtbot.keyClicks(editor, "5")
    inspector.show_step(dc.replace(step, instruction=Wait(time="250")), offers())
    assert editor is inspector.form.fields.cells["time", ""].editor
    assert (editor.text(), editor.cursorPosition()) == ("250", 2)


def test_without_a_step_the_inspector_says_what_to_do(qtbot: QtBot) -> None:
    inspector = Inspector(offers())
    qtbot.addWidget(inspector)
    inspector.show_nothing()
    assert inspector.stack.currentWidget() is inspector.empty
    assert "Select" in inspector.empty.text()


def test_labels_are_typed_in_capitals(qtbot: QtBot) -> None:
    form = FieldsForm(offers())
    qtbot.addWidget(form)
    form.show_item(Label())
    qtbot.keyClicks(form.cells["name", ""].editor, "feed1")
    assert form.item == Label(name="FEED1")
    form.show_item(Jump())
    qtbot.keyClicks(form.cells["target", ""].editor, "feed1")
    assert form.item.target == "FEED1"


def test_a_picked_command_becomes_the_next_line_of_the_code(qtbot: QtBot) -> None:
    form = InstructionForm(offers())
    qtbot.addWidget(form)
    form.show_instruction(TwoLetterCode(text="SH X"))
    picture = form.picture
    assert isinstance(picture, CommandList)
    qtbot.keyClicks(picture.search, "sp")
    assert picture.list.currentItem().text().startswith("SP ")
    picture.list.itemActivated.emit(picture.list.currentItem())
    assert form.instruction == TwoLetterCode(text=f"SH X\n{COMMANDS['SP'].example}")
    assert COMMANDS["SP"].help in picture.about.text()


def test_gains_go_to_the_configuration_unless_told_otherwise(qtbot: QtBot) -> None:
    dialog = InstructionDialog(PidGains(), offers(), new=True)
    qtbot.addWidget(dialog)
    assert dialog.section.chosen() == ["configuration"]


def test_a_note_is_told_apart_from_the_values(qtbot: QtBot) -> None:
    inspector = Inspector(offers())
    qtbot.addWidget(inspector)
    inspector.show_step(Step("s1", Wait(time="20"), note="lamp"), offers())
    assert inspector.note.text() == "lamp"
    noted: list[tuple[str, str]] = []
    inspector.noted.connect(lambda *what: noted.append(what))
    qtbot.keyClicks(inspector.note, "s")
    assert noted == [("s1", "lamps")]


def test_an_empty_list_says_what_to_do(qtbot: QtBot) -> None:
    dialog = InstructionDialog(Print(), offers(), new=True)
    qtbot.addWidget(dialog)
    cell = dialog.form.fields.cells["items", ""]
    assert cell.problem.text() == "! Add at least one entry to “Items”"
    assert dialog.buttons["Add"].toolTip() == "Add at least one entry to “Items”"
    qtbot.mouseClick(cell.editor.buttons["add"], Qt.MouseButton.LeftButton)
    assert "Text" in dialog.buttons["Add"].toolTip()
