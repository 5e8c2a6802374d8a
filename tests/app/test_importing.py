"""Import Module from the File menu: what is shown before, what comes in, and one Undo."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QFileDialog, QLineEdit, QPushButton

from codegen import files
from codegen.document import Document
from codegen.instructions import Label, MathematicalEquation, Output
from codegen.instructions.math import Equation
from codegen.program import Program, Step
from tests.app.hands import Hands, Keys, Mouse, until
from tests.stage import Stage
from widgets.program.import_window import ImportWindow

COUNTING = Equation(variable="LEN", expression="LEN+1")


def module(stage: Stage, tmp_path: Path) -> Path:
    """Two steps whose label and variable the open program has as well."""
    stage.studio.session.insert([MathematicalEquation(equations=(Equation(variable="LEN", expression="1"),))])
    steps = (Step("a", Label(name="A")), Step("b", MathematicalEquation(equations=(COUNTING,))))
    path = tmp_path / "count.tlp"
    files.save(path, Document(Program("COUNT", main=steps), stage.studio.session.document.setup))
    return path


def window(stage: Stage) -> ImportWindow:
    found = [each for each in stage.studio.window.findChildren(ImportWindow) if each.isVisible()]
    assert len(found) == 1
    return found[0]


def texts(shown: ImportWindow) -> list[list[str]]:
    table = shown.table
    cells = [[table.item(row, column) for column in range(3)] for row in range(table.rowCount())]
    return [[cell.text() for cell in row if cell is not None] for row in cells]


@pytest.mark.parametrize("hand", [Mouse, Keys])
def test_the_names_are_shown_first_and_undo_takes_all_of_it_back(
    stage: Stage, tmp_path: Path, hand: type[Hands]
) -> None:
    path, hands, session = module(stage, tmp_path), hand(stage.studio), stage.studio.session
    before = session.document
    hands.act("import_module")
    dialog = next(each for each in stage.studio.window.findChildren(QFileDialog) if each.isVisible())
    line = dialog.findChild(QLineEdit)
    assert line is not None
    line.setText(str(path))
    QTest.keyClick(line, Qt.Key.Key_Return)
    until(lambda: [each for each in stage.studio.window.findChildren(ImportWindow) if each.isVisible()], "the names")
    shown = window(stage)
    assert texts(shown) == [["Label or subroutine", "A", "A2"], ["Variable or array", "LEN", "LEN2"]]
    assert session.document is before  # nothing has happened yet
    hands.press(shown.take)
    stage.go()
    steps = list(session.document.program.main)[-2:]
    assert steps[0].instruction == Label(name="A2")
    assert steps[1].instruction == MathematicalEquation(equations=(Equation(variable="LEN2", expression="LEN2+1"),))
    assert stage.studio.program.tree.chosen() == [step.id for step in steps]
    assert stage.studio.messages.texts()[-1] == "Imported from count.tlp: 2 steps. Ctrl+Z takes all of it back."
    session.undo()
    assert session.document is before


def test_a_variable_can_be_the_same_one_in_both(stage: Stage, tmp_path: Path) -> None:
    stage.studio.importing.take(module(stage, tmp_path))
    stage.go()
    shown = window(stage)
    shown.table.setCurrentCell(1, 3)
    shown.table.setFocus()
    QTest.keyClick(shown.table, Qt.Key.Key_Space)
    assert texts(shown)[1][2] == "LEN (the same one)"
    QTest.keyClick(shown, Qt.Key.Key_Return)
    stage.go()
    last = list(stage.studio.session.document.program.main)[-1].instruction
    assert last == MathematicalEquation(equations=(COUNTING,))


def test_cancel_changes_nothing(stage: Stage, tmp_path: Path) -> None:
    path = module(stage, tmp_path)
    before = stage.studio.session.document
    stage.studio.importing.take(path)
    stage.go()
    QTest.keyClick(window(stage), Qt.Key.Key_Escape)
    stage.go()
    assert stage.studio.session.document is before


def test_code_becomes_instructions_at_once_when_no_name_clashes(stage: Stage, tmp_path: Path) -> None:
    path = tmp_path / "teach.dmc"
    path.write_text("#TEACH\nSB 2\nCB 2\nEN\n")
    stage.studio.importing.take(path)
    stage.go()
    made = [step.instruction for step in stage.studio.session.document.program.main][-2:]
    assert all(isinstance(each, Output) for each in made)
    assert QApplication.activeModalWidget() is None


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("broken.tlp", b'{"format": 1', "not a program file"),
        ("none.tlp", None, "none.tlp"),
        ("empty.dmc", b"", "holds no instruction"),
        ("picture.dmc", b"\x89PNG\0\0", "is not two-letter code"),
        ("lines.dmc", b"V=1\nJP 0\nEN\n", "line number"),
    ],
)
def test_what_can_not_be_imported_is_one_sentence(
    stage: Stage, tmp_path: Path, name: str, content: bytes | None, words: str
) -> None:
    path = tmp_path / name
    if content is not None:
        path.write_bytes(content)
    before = stage.studio.session.document
    stage.studio.importing.take(path)
    stage.go()
    question = stage.studio.desk.question
    assert question is not None
    assert words in question.words
    assert question.words.endswith(".") and "\n" not in question.words
    assert stage.studio.session.document is before
    for button in question.findChildren(QPushButton):
        button.click()
