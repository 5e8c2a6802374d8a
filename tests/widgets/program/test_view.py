"""The program window under real keys and clicks."""

from __future__ import annotations

import dataclasses as dc

from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QKeySequence
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QWidget
from pytestqt.qtbot import QtBot

from codegen.instructions import (
    Comment,
    Instruction,
    Jump,
    Label,
    Output,
    Repeat,
    SingleAxisMove,
    Subroutine,
    TwoLetterCode,
    Wait,
)
from codegen.program import Section
from codegen.setup import Unit
from tests.widgets.program.conftest import Window
from widgets.form.dialog import InstructionDialog
from widgets.program.model import CODE

# spec/instructions.md, "An example, whole": the wire cutter of dmc-1412-1414.txt, chapter 7
WIRE_CUTTER = [
    "#CUTTER", "AC 254976", "DC 254976", "#A", "AI 1", "PR 6370", "SP 3184", "BG X", "AM X",
    "SB 1", "WT 20", "CB 1", "WT 80", "JP #A", "EN",
]  # fmt: skip


def dialog_of(window: Window) -> InstructionDialog:
    """The dialog that was opened last."""
    return window.view.dialogs.open[-1]


def pick(qtbot: QtBot, window: Window, words: str) -> InstructionDialog:
    """Searches an instruction and takes it, with keys only."""
    search = window.view.instructions.search
    search.clear()
    qtbot.keyClicks(search, words)
    qtbot.keyClick(search, Qt.Key.Key_Return)
    return dialog_of(window)


def tab_to(qtbot: QtBot, dialog: InstructionDialog, name: str, axis: str = "") -> QWidget:
    """Presses Tab until the focus is in the wanted field."""
    cell = dialog.form.fields.cells[name, axis]
    for _ in range(60):
        focus = dialog.focusWidget()
        if focus is not None and cell.isAncestorOf(focus):
            return focus
        QTest.keyClick(focus or dialog, Qt.Key.Key_Tab)
    raise AssertionError(f"Tab never came to {name} {axis}")


def type_into(qtbot: QtBot, dialog: InstructionDialog, name: str, text: str, axis: str = "") -> None:
    """Types a value, with keys only."""
    focus = tab_to(qtbot, dialog, name, axis)
    qtbot.keyClick(focus, Qt.Key.Key_A, Qt.KeyboardModifier.ControlModifier)
    qtbot.keyClicks(focus, text)


def press_until(qtbot: QtBot, dialog: InstructionDialog, name: str, words: str) -> None:
    """Chooses among buttons or in a list, with the arrow keys only."""
    focus = tab_to(qtbot, dialog, name)
    editor = dialog.form.fields.cells[name, ""].editor
    for _ in range(12):
        now = editor.currentText() if hasattr(editor, "currentText") else editor.focus_target().text()
        if now == words:
            return
        qtbot.keyClick(focus, Qt.Key.Key_Down)
        focus = editor.focus_target() if hasattr(editor, "focus_target") else editor
    raise AssertionError(f"{words} cannot be reached with the arrow keys")


def add(qtbot: QtBot, dialog: InstructionDialog) -> None:
    """Ctrl+Enter adds. The dialog outlives its closing, because the test's key comes up after it."""
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose, False)
    qtbot.keyClick(dialog, Qt.Key.Key_Return, Qt.KeyboardModifier.ControlModifier)


def build_by_keyboard(qtbot: QtBot, window: Window) -> None:
    """The wire cutter, without touching the mouse."""
    dialog = pick(qtbot, window, "accel and")
    type_into(qtbot, dialog, "acceleration", "400", "X")
    type_into(qtbot, dialog, "deceleration", "400", "X")
    add(qtbot, dialog)
    dialog = pick(qtbot, window, "label")
    type_into(qtbot, dialog, "name", "A")
    add(qtbot, dialog)
    dialog = pick(qtbot, window, "wait for")
    press_until(qtbot, dialog, "kind", "Input")
    add(qtbot, dialog)
    dialog = pick(qtbot, window, "single")
    type_into(qtbot, dialog, "distance", "10")
    type_into(qtbot, dialog, "speed", "5")
    add(qtbot, dialog)
    add(qtbot, pick(qtbot, window, "output"))
    dialog = pick(qtbot, window, "wait")
    type_into(qtbot, dialog, "time", "20")
    add(qtbot, dialog)
    dialog = pick(qtbot, window, "output")
    press_until(qtbot, dialog, "level", "Off")
    add(qtbot, dialog)
    dialog = pick(qtbot, window, "wait")
    type_into(qtbot, dialog, "time", "80")
    add(qtbot, dialog)
    dialog = pick(qtbot, window, "jump")
    type_into(qtbot, dialog, "target", "A")
    add(qtbot, dialog)


def test_the_wire_cutter_is_built_by_keyboard_alone(qtbot: QtBot, window: Window) -> None:
    build_by_keyboard(qtbot, window)
    assert window.code() == WIRE_CUTTER


def test_undo_takes_every_step_back_and_redo_brings_all_again(qtbot: QtBot, window: Window) -> None:
    empty = window.session.document
    build_by_keyboard(qtbot, window)
    whole = window.session.document
    while window.session.can_undo:
        assert window.session.undo_text.startswith("Add ")
        window.view.undo()
    assert window.session.document == empty
    assert window.view.model.nodes.keys() == {section.value for section in Section}
    while window.session.can_redo:
        window.view.redo()
    assert window.session.document == whole
    assert window.code() == WIRE_CUTTER


def click(qtbot: QtBot, widget: QWidget) -> None:
    """A real click into the middle of a widget."""
    qtbot.mouseClick(widget, Qt.MouseButton.LeftButton)


def close_with(qtbot: QtBot, dialog: InstructionDialog) -> None:
    """Clicks Add; the dialog outlives its closing, because the button comes up after it."""
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose, False)
    click(qtbot, dialog.buttons["Add"])


def take(qtbot: QtBot, window: Window, kind: type[Instruction]) -> InstructionDialog:
    """Double-clicks an instruction in the palette."""
    tree = window.view.instructions.tree
    item = window.view.instructions.items[kind.title]
    tree.scrollToItem(item)
    at = tree.visualItemRect(item).center()
    qtbot.mouseClick(tree.viewport(), Qt.MouseButton.LeftButton, pos=at)
    qtbot.mouseDClick(tree.viewport(), Qt.MouseButton.LeftButton, pos=at)
    return dialog_of(window)


def test_a_program_is_built_by_mouse(qtbot: QtBot, window: Window) -> None:
    dialog = take(qtbot, window, SingleAxisMove)
    cells = dialog.form.fields.cells
    click(qtbot, cells["axis", ""].editor.buttons["Y"])
    click(qtbot, cells["distance", ""].editor)
    qtbot.keyClicks(cells["distance", ""].editor, "2")
    close_with(qtbot, dialog)
    dialog = take(qtbot, window, Output)
    close_with(qtbot, dialog)
    assert [step.instruction for step in window.main()] == [SingleAxisMove(axis="Y", distance="2"), Output()]
    assert "PR ,2000" in window.code()


def fill(window: Window, *instructions: Instruction) -> list[str]:
    """Steps in Main."""
    return list(window.session.insert(list(instructions)))


def test_selection_and_scroll_survive_an_edit_elsewhere(window: Window) -> None:
    ids = fill(window, *(Wait(time=str(number + 1)) for number in range(80)))
    tree = window.view.tree
    tree.choose([ids[60]])
    at = tree.verticalScrollBar().value()
    window.session.replace(ids[2], Wait(time="7"))
    window.session.remove([ids[3]])
    window.session.undo()
    assert tree.chosen() == [ids[60]]
    assert tree.verticalScrollBar().value() == at


def test_enter_and_double_click_change_a_step(qtbot: QtBot, window: Window) -> None:
    (step_id,) = fill(window, Wait(time="20"))
    tree = window.view.tree
    tree.choose([step_id])
    qtbot.keyClick(tree, Qt.Key.Key_Return)
    dialog = dialog_of(window)
    type_into(qtbot, dialog, "time", "30")
    add(qtbot, dialog)
    assert window.main()[0].instruction == Wait(time="30")
    at = tree.visualRect(window.view.model.index_of(step_id)).center()
    qtbot.mouseClick(tree.viewport(), Qt.MouseButton.LeftButton, pos=at)
    qtbot.mouseDClick(tree.viewport(), Qt.MouseButton.LeftButton, pos=at)
    assert dialog_of(window).windowTitle() == "Change: Wait"


def test_a_second_modify_brings_the_same_dialog(window: Window) -> None:
    (step_id,) = fill(window, Wait(time="20"))
    assert window.view.dialogs.modify(step_id) is window.view.dialogs.modify(step_id)


def test_an_open_dialog_follows_the_names_of_the_program(qtbot: QtBot, window: Window) -> None:
    dialog = window.view.dialogs.add(Jump)
    box = dialog.form.fields.cells["target", ""].editor
    qtbot.keyClicks(box, "en")
    window.session.insert([Label(name="AGAIN")])
    assert [box.itemText(index) for index in range(box.count())] == ["AGAIN"]
    assert box.currentText() == "EN"
    dialog.reject()


def test_an_open_dialog_follows_the_units_of_the_machine(window: Window) -> None:
    dialog = window.view.dialogs.add(SingleAxisMove)
    dialog.form.show_instruction(SingleAxisMove(distance="10"))
    setup = window.session.document.setup
    axis = dc.replace(setup.axis("X"), counts_per_unit="1000", unit=Unit.MM)
    window.session.set_setup(setup.with_axis("X", axis))
    cell = dialog.form.fields.cells["distance", ""]
    assert (cell.editor.value(), cell.unit.text(), cell.counts.text()) == ("10", "mm", "10000 counts")
    dialog.reject()


def test_the_note_of_a_step_is_written_in_its_dialog(qtbot: QtBot, window: Window) -> None:
    dialog = window.view.dialogs.add(Wait)
    qtbot.keyClicks(dialog.form.fields.cells["time", ""].editor, "20")
    qtbot.keyClicks(dialog.note, "lamp")
    qtbot.mouseClick(dialog.buttons["Add"], Qt.MouseButton.LeftButton)
    (step,) = window.main()
    assert (step.instruction, step.note) == (Wait(time="20"), "lamp")
    again = window.view.dialogs.modify(step.id)
    assert again.note.text() == "lamp"
    qtbot.keyClicks(again.note, "s")
    qtbot.mouseClick(again.buttons["Change"], Qt.MouseButton.LeftButton)
    assert window.main()[0].note == "lamps"
    window.session.undo()
    assert window.main()[0].note == "lamp"


def test_the_dialog_of_a_deleted_step_closes(window: Window) -> None:
    (step_id,) = fill(window, Wait(time="20"))
    window.view.dialogs.modify(step_id)
    window.session.remove([step_id])
    assert window.view.dialogs.open == []


def test_insert_goes_before_the_selected_step_and_ctrl_enter_back_to_the_end(qtbot: QtBot, window: Window) -> None:
    ids = fill(window, Wait(time="1"), Wait(time="2"))
    window.view.tree.choose([ids[1]])
    window.view.commands["insert"].trigger()
    assert not window.view.bar.isHidden()
    assert "before: Wait 2 ms" in window.view.bar.text.text()
    dialog = pick(qtbot, window, "wait")
    type_into(qtbot, dialog, "time", "9")
    add(qtbot, dialog)
    assert [step.instruction.time for step in window.main()] == ["1", "9", "2"]  # type: ignore[attr-defined]
    window.view.commands["end_of_repeat"].trigger()
    assert window.view.bar.isHidden()


def test_steps_go_into_a_repeat_until_it_is_left(window: Window) -> None:
    fill(window, Repeat())
    fill(window, Wait(time="1"))
    fill(window, Wait(time="2"))
    assert len(window.main()[0].body) == 2
    assert "inside: Repeat" in window.view.bar.text.text()
    window.view.end_of_repeat()
    fill(window, Wait(time="3"))
    assert len(window.main()) == 2


def test_steps_go_into_a_subroutine_until_its_end(window: Window) -> None:
    from codegen.instructions import End

    fill(window, Subroutine(name="FEED"))
    fill(window, Wait(time="1"))
    fill(window, End())
    fill(window, Wait(time="2"))
    assert [type(step.instruction) for step in window.session.document.program.routines[0].body] == [Wait, End]
    assert [step.instruction for step in window.main()] == [Wait(time="2")]


def test_a_step_for_either_section_goes_into_the_open_subroutine(qtbot: QtBot, window: Window) -> None:
    window.session.insert([Subroutine(name="CUT")])
    dialog = window.view.dialogs.add(Comment)
    assert dialog.place.text() == "into Subroutine CUT"
    qtbot.keyClicks(dialog.form.fields.cells["text", ""].editor, "blade")
    assert dialog.section.chosen() == ["main"]
    qtbot.mouseClick(dialog.buttons["Add"], Qt.MouseButton.LeftButton)
    (routine,) = window.session.document.program.routines
    assert [step.instruction for step in routine.body] == [Comment(text="blade")]


def test_comment_out_shows_a_quote_and_sends_nothing_and_comes_back(window: Window) -> None:
    (step_id,) = fill(window, Wait(time="20"))
    window.view.tree.choose([step_id])
    before = window.code()
    window.view.commands["comment_out"].trigger()
    index = window.view.model.index_of(step_id)
    assert index.data().startswith("' Wait 20 ms")
    assert "WT 20" not in window.code()
    assert window.view.commands["comment_out"].text() == "Bring back"
    window.view.commands["comment_out"].trigger()
    assert window.code() == before


def test_cut_copy_paste_and_duplicate(window: Window) -> None:
    ids = fill(window, Wait(time="1"), Wait(time="2"), Label(name="A"))
    view = window.view
    view.tree.choose(ids[:2])
    view.cut()
    assert [step.instruction for step in window.main()] == [Label(name="A")]
    view.tree.choose([ids[2]])
    view.paste()
    times = [getattr(step.instruction, "time", "label") for step in window.main()]
    assert times == ["1", "2", "label"]
    view.duplicate()
    assert [getattr(step.instruction, "time", "label") for step in window.main()] == ["1", "2", "1", "2", "label"]
    assert len({step.id for step in window.main()}) == 5


def test_pasted_code_becomes_a_two_letter_step(window: Window) -> None:
    QApplication.clipboard().setText("SP 1000\nBG X")
    window.view.paste()
    assert [step.instruction for step in window.main()] == [TwoLetterCode(text="SP 1000\nBG X")]


def test_delete_selects_the_next_step(window: Window) -> None:
    ids = fill(window, Wait(time="1"), Wait(time="2"), Wait(time="3"))
    window.view.tree.choose([ids[1]])
    window.view.commands["delete"].trigger()
    assert window.view.tree.chosen() == [ids[2]]


def test_insert_comment_asks_for_the_text(qtbot: QtBot, window: Window) -> None:
    window.view.commands["comment"].trigger()
    dialog = dialog_of(window)
    type_into(qtbot, dialog, "text", "feed the wire")
    add(qtbot, dialog)
    assert [step.instruction for step in window.main()] == [Comment(text="feed the wire")]


def test_the_two_panes_keep_their_selection_in_step(window: Window) -> None:
    ids = fill(window, Label(name="A"), SingleAxisMove(distance="10"), Jump(target="A"))
    window.view.set_view("both")
    window.view.tree.choose([ids[1]])
    assert [window.code()[line] for line in window.view.code.chosen] == ["PR 6370", "BG X", "AM X"]
    window.view.code.line_chosen.emit(window.code().index("JP #A"))
    assert window.view.tree.chosen() == [ids[2]]


def test_running_lines_and_the_error_stand_on_their_steps(qtbot: QtBot, window: Window) -> None:
    ids = fill(window, Label(name="A"), SingleAxisMove(distance="10"), Jump(target="A"))
    window.view.show_executing({0: window.code().index("AM X"), 1: None})
    assert dict(window.view.delegate.executing) == {ids[1]: (0,)}
    with qtbot.waitSignal(window.view.said) as said:
        window.view.show_error(window.code().index("JP #A"), "Command not valid while running")
    assert window.view.tree.chosen() == [ids[2]]
    assert window.view.delegate.error == (ids[2], "Command not valid while running")
    assert "Command not valid while running" in said.args[0]
    window.view.clear_error()
    assert window.view.delegate.error is None


def test_problems_are_listed_and_lead_to_their_step(window: Window) -> None:
    ids = fill(window, Wait(time="1"), Wait(time="12,5"))
    panel = window.view.problems
    assert panel.list.count() == 1
    assert "12.5" in panel.list.item(0).text()
    panel.list.itemActivated.emit(panel.list.item(0))
    assert window.view.tree.chosen() == [ids[1]]
    window.session.replace(ids[1], Wait(time="12"))
    assert panel.stack.currentWidget() is panel.none


def test_name_and_description_are_edited_in_place_with_the_label_beside(qtbot: QtBot, window: Window) -> None:
    header = window.view.header
    header.name.selectAll()
    qtbot.keyClicks(header.name, "wire cutter 2")
    assert window.session.document.program.name == "wire cutter 2"
    assert header.label.text() == "#WIRECUT"
    qtbot.keyClicks(header.description, "10 in")
    assert window.session.document.program.description == "10 in"


def test_every_command_says_why_it_is_grey_and_has_its_key(window: Window) -> None:
    keys = {"modify": "Ctrl+M", "insert": "Ctrl+I", "comment": "Ctrl+E", "comment_out": "Ctrl+U", "view_code": "Ctrl+D"}
    for name, shortcut in keys.items():  # ssc-tol-o-motion.txt, chapter 5, Edit menu
        assert window.view.commands[name].shortcut() == QKeySequence(shortcut)
    assert not window.view.commands["copy"].isEnabled()
    assert window.view.commands["copy"].statusTip() == "Select a step first"


def test_the_palette_finds_and_greys_with_the_reason(qtbot: QtBot, window: Window) -> None:
    palette = window.view.instructions
    qtbot.keyClicks(palette.search, "gear ratio of nothing")
    assert not palette.nothing.isHidden()
    palette.search.clear()
    qtbot.keyClicks(palette.search, "single")
    shown = [title for title, item in palette.items.items() if not item.isHidden()]
    assert shown[0] == "Single Axis Move"
    assert palette.tree.currentItem().text(0) == "Single Axis Move"


def test_the_code_column_is_for_the_program_view_only(window: Window) -> None:
    window.view.set_view("both")
    assert window.view.tree.isColumnHidden(CODE)
    assert not window.view.code.isHidden()
    window.view.set_view("program")
    assert not window.view.tree.isColumnHidden(CODE)
    assert window.view.code.isHidden()


def test_a_right_click_offers_the_commands(qtbot: QtBot, window: Window) -> None:
    (step_id,) = fill(window, Wait(time="1"))
    window.view.tree.choose([step_id])
    window.view.tree.customContextMenuRequested.emit(QPoint(10, 10))
    menu = QApplication.activePopupWidget()
    assert menu is not None
    assert [action.text() for action in menu.actions() if action.text()][:2] == ["Modify…", "Insert before…"]
    menu.close()
