"""F1 opens the page of what has the focus: instruction, field, command; and shows the place in it."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QTextBrowser

from codegen.docs import command_page
from codegen.fields import fields_of
from codegen.instructions import ALL, TwoLetterCode
from tests.app.hands import Keys
from tests.stage import Stage
from widgets.form.text_area import CodeArea
from widgets.help.topic import topic_of


def page(stage: Stage) -> tuple[str, str]:
    """The page that is open, and the line at its top."""
    stage.go(1)
    help = stage.studio.desk.help
    assert help is not None
    browser = help.findChildren(QTextBrowser)[0]
    title = browser.document().begin().text()
    return title, browser.textCursor().block().text()


def test_a_field_opens_its_line_on_the_page_of_its_instruction(stage: Stage) -> None:
    hands = Keys(stage.studio)
    dialog = hands.pick("Single Axis Move")
    editor = dialog.form.fields.cells["speed", ""].findChildren(type(dialog.note))[0]
    hands.go_to(editor)
    assert topic_of(editor) == "Single Axis Move#Speed"
    QTest.keySequence(editor, "F1")
    QApplication.processEvents()
    title, line = page(stage)
    assert title == "Single Axis Move" and line.startswith("Speed (")
    dialog.close()


def test_a_command_opens_its_entry_where_the_cursor_is(stage: Stage) -> None:
    studio = stage.studio
    studio.program.commands["mode_code"].trigger()
    stage.go()
    code = studio.program.code
    number = studio.session.listing.text.split("\n").index("PR 6370")
    cursor = code.textCursor()
    cursor.setPosition(code.document().findBlockByNumber(number).position() + 1)
    code.setTextCursor(cursor)
    assert topic_of(code) == "Commands: Motion#PR:"
    code.setFocus()
    QTest.keySequence(code, "F1")
    QApplication.processEvents()
    title, line = page(stage)
    assert title == "Commands: Motion" and line.startswith("PR: ")


def test_a_command_in_the_field_of_two_letter_code_opens_its_entry(stage: Stage) -> None:
    program = stage.studio.program
    program.dialogs.add(TwoLetterCode)
    stage.go()
    dialog = program.dialogs.open[-1]
    field = dialog.findChild(CodeArea)
    assert field is not None
    field.setFocus()
    QTest.keyClicks(field, "V1=5;PR 4000")
    assert topic_of(field) == "Commands: Motion#PR:"
    QTest.keyClick(field, Qt.Key.Key_Home)
    assert topic_of(field) == "2-Letter Code#Code"  # an assignment is no command
    QTest.keyClick(field, Qt.Key.Key_End)
    QTest.keySequence(field, "F1")
    QApplication.processEvents()
    title, line = page(stage)
    assert title == "Commands: Motion" and line.startswith("PR: ")
    dialog.close()


def test_a_typed_command_opens_its_entry(stage: Stage) -> None:
    stage.connect("simulator")
    line = stage.studio.terminal.line
    line.setText("KP 5;MG _TPX")
    line.setCursorPosition(2)
    assert topic_of(line) == "Commands: Servo#KP:"
    line.setText("")
    assert topic_of(line) == "Terminal"


@pytest.mark.parametrize(("line", "column", "wanted"), [("#A", 1, ""), ("V1=5", 1, ""), ("XX 5", 0, "")])
def test_what_is_no_command_has_no_page_of_its_own(line: str, column: int, wanted: str) -> None:
    assert command_page(line, column) == wanted


def test_every_field_of_every_instruction_is_a_line_of_its_page(stage: Stage) -> None:
    """The place that F1 goes to is there."""
    pages = stage.studio.desk._pages
    for kind in ALL:
        for field in fields_of(kind).values():
            assert f"**{field.label}**" in pages[kind.title], (kind.title, field.label)
