"""What was folded is folded again when the file is opened next time."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.settings import Settings
from codegen import files
from codegen.document import Document
from codegen.instructions import End, Label, Output, Repeat, Subroutine
from codegen.program import Program, Step
from tests.app.hands import until
from tests.stage import Stage


def saved(path: Path) -> Path:
    """A repeat and a subroutine, two steps in each."""
    two = (Step(f"{path.stem}1", Output(output="1")), Step(f"{path.stem}2", Output(output="2")))
    loop = Step("loop", Repeat(count="3"), body=two)
    cut = Step("cut", Subroutine(name="CUT"), body=(Step("c1", Label(name="C")), Step("c2", End())))
    files.save(path, Document(Program(path.stem.upper(), main=(loop,), routines=(cut,))))
    return path


def rows(stage: Stage) -> list[str]:
    return [node.id for node in stage.studio.program.model.rows]


def test_it_is_remembered_with_its_file(stage: Stage, tmp_path: Path) -> None:
    first, second = saved(tmp_path / "a.tlp"), saved(tmp_path / "b.tlp")
    tree = stage.studio.program.tree
    stage.studio.files.open_path(first)
    tree.choose(["loop"])
    tree.setFocus()
    QTest.keyClick(tree, Qt.Key.Key_Left)
    assert rows(stage) == ["configuration", "main", "loop", "routines", "cut", "c1", "c2"]
    until(lambda: str(first) in stage.studio.settings.get("folded"), "the folding to be written down", 5)
    stage.studio.files.open_path(second)  # its steps have the same names
    assert rows(stage) == ["configuration", "main", "loop", "b1", "b2", "routines", "cut", "c1", "c2"]
    stage.studio.files.open_path(first)
    assert rows(stage) == ["configuration", "main", "loop", "routines", "cut", "c1", "c2"]
    assert Settings(stage.studio.settings.path).get("folded") == {str(first): ["loop"]}  # at the next start too


def test_unfolding_is_remembered_too_and_strange_settings_are_no_harm(stage: Stage, tmp_path: Path) -> None:
    path = saved(tmp_path / "a.tlp")
    stage.studio.settings.set("folded", {str(path): ["loop", "gone", 7]})
    stage.studio.files.open_path(path)
    assert "a1" not in rows(stage)
    stage.studio.program.tree.fold_all(False)
    stage.studio.folding.remember()
    assert stage.studio.settings.get("folded") == {}
    stage.studio.settings.set("folded", {str(path): "loop"})
    stage.studio.files.open_path(path)
    assert "a1" in rows(stage)


def test_a_program_without_a_file_begins_unfolded(stage: Stage, tmp_path: Path) -> None:
    stage.studio.files.open_path(saved(tmp_path / "a.tlp"))
    stage.studio.program.tree.fold_all(True)
    stage.studio.session.new()
    stage.studio.session.insert([Repeat(count="3")])
    assert stage.studio.program.tree.folded_names() == []


def test_a_lost_line_is_said_instead_of_what_was_said_before(stage: Stage) -> None:
    rig = stage.connect("simulator", stage.studio.model())
    stage.download()
    stage.studio.run.execute()
    status = stage.studio.window.status
    stage.until(lambda: status.currentMessage() == "The program was started.")
    rig.cut()
    stage.until(lambda: status.currentMessage() != "The program was started.", 30)
    assert status.currentMessage() == stage.controller.state_text
    assert stage.controller.state.value == "connection lost"
