"""Trace and Program Status on the simulator: two threads, one of them followed, and what each waits for."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from codegen.document import Document
from codegen.instructions import Execute, Instruction, Jump, Label, Subroutine, Wait, WaitForCondition
from codegen.instructions.waits import WaitKind
from codegen.program import Program, Step
from tests.stage import Stage
from widgets.program.tracing import waits_for

MANY = 60  # steps in front of the one that is waited at, so that it is out of sight


def two_threads(stage: Stage) -> None:
    """Thread 0 waits for input 1 at the end of a long program; thread 1 goes round waiting for time."""
    steps: list[Instruction] = [Execute(label="LAMP", thread="1"), *(Wait(time="1") for _ in range(MANY))]
    main = tuple(
        Step(f"s{number}", each)
        for number, each in enumerate([*steps, WaitForCondition(kind=WaitKind.INPUT, input="1")])
    )
    lamp = (Step("label", Label(name="AGAIN")), Step("pause", Wait(time="400")), Step("back", Jump(target="AGAIN")))
    program = Program("TRACE", main=main, routines=(Step("lamp", Subroutine(name="LAMP"), body=lamp),))
    session = stage.studio.session
    session.set_document(Document(program, session.document.setup), "the two threads")
    stage.connect("simulator", stage.studio.model()).simulation.stimulus("in1", 0)
    stage.download()
    stage.studio.run.execute()
    waiting = f"s{MANY + 1}"
    stage.until(lambda: dict(stage.studio.program.delegate.executing) == {waiting: (0,), "pause": (1,)})


def test_a_followed_thread_alone_is_marked_and_kept_in_sight(stage: Stage) -> None:
    two_threads(stage)
    view = stage.studio.program
    tree, bar = view.tree, view.run.bar
    tree.verticalScrollBar().setValue(0)
    view.tree.fold("lamp", True)
    tree.choose(["s0"])
    QTest.keySequence(tree, "F8")
    assert bar.isVisible()
    bar.chooser.setFocus()
    QTest.keyClick(bar.chooser, Qt.Key.Key_Down)
    stage.go()
    assert bar.chooser.currentText() == "Thread 0"
    assert dict(view.delegate.executing) == {f"s{MANY + 1}": (0,)}
    seen = tree.viewport().rect().contains(tree.visualRect(view.model.index_of(f"s{MANY + 1}")).center())
    assert seen
    assert tree.chosen() == ["s0"]  # what the person chose is theirs
    assert bar.text.text().startswith("► Thread 0: line ")
    assert bar.text.text().endswith("Wait until input 1 is high, waiting: after input")
    QTest.keyClick(bar.chooser, Qt.Key.Key_Down)
    stage.go()
    assert dict(view.delegate.executing) == {"pause": (1,)}
    assert not view.model.nodes["lamp"].folded  # the step it is at is to be seen
    QTest.mouseClick(bar.close_button, Qt.MouseButton.LeftButton)
    assert bar.isHidden()
    assert dict(view.delegate.executing) == {f"s{MANY + 1}": (0,), "pause": (1,)}


def test_program_status_names_threads_lines_and_what_they_wait_for(stage: Stage) -> None:
    two_threads(stage)
    view = stage.studio.program
    QTest.keySequence(view.tree, "Shift+F8")
    window = view.run.window
    assert window is not None
    stage.go()
    lines = view.session.listing
    at, pause = lines.lines_of(f"s{MANY + 1}")[0], lines.lines_of("pause")[0]
    table = window.table
    cells = [[table.item(row, column).text() for column in range(5)] for row in range(table.rowCount())]
    assert cells[0][:4] == ["0", "► running", str(at), "Wait until input 1 is high"]
    assert cells[1][:3] == ["1", "► running", str(pause)]
    assert cells[1][3].startswith("Wait 400 ms")
    assert [row[1] for row in cells[2:]] == ["■ not running"] * (len(cells) - 2)
    table.setCurrentCell(1, 0)
    table.cellActivated.emit(1, 0)
    assert view.tree.chosen() == ["pause"]
    stage.studio.run.halt()
    stage.until(lambda: table.item(0, 1).text() == "■ not running")
    window.close()


@pytest.mark.parametrize(
    ("code", "words"), [("AI 1", True), ("BG X;AM X", True), ("WT 20", True), ("PR 100", False), ("#A", False)]
)
def test_what_a_line_waits_for_comes_from_the_command_table(code: str, words: bool) -> None:
    assert bool(waits_for(code)) is words
