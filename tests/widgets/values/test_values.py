"""Variables and arrays against a simulated controller: nothing rounded, nothing changed in Watch, recipes as files."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QLineEdit

from app.variables import RecipeUnreadable, read_recipe, recipe_text
from codegen.difference_values import number_text
from codegen.twoletter.fixed import ONE, read_decimal, string_value
from device.values import letters_of
from tests.long import count
from tests.stage import Stage, make_studio
from widgets.values.panel import OFFLINE, VALUE, ValuesPanel
from widgets.values.typed import assignment

PROGRAM = '#A\nLEN=12.5\nNAME="CUT"\nDM POS[5]\nPOS[0]=1;POS[1]=4;POS[2]=9\nPOS[3]=16;POS[4]=-2.25\nEN'


@pytest.fixture
def stage(qapp: QApplication, tmp_path: Path) -> Iterator[Stage]:
    made = make_studio(tmp_path)
    made.studio.window.resize(1280, 900)
    made.studio.window.show()
    made.go()
    made.studio.desk.bring("Variables")
    made.go()
    yield made
    made.clear_away()


def connected(stage: Stage, kind: str = "simulator", model: str = "ssc2") -> ValuesPanel:
    """A controller in which the program has run."""
    rig = stage.connect(kind, model)
    rig.start(PROGRAM)
    stage.later(0.5)
    panel = stage.studio.at_machine.values
    panel.read.click()
    stage.until(lambda: "LEN 12.5" in panel.words())
    return panel


def row_of(panel: ValuesPanel, name: str) -> int:
    return next(row for row in range(panel.table.rowCount()) if panel._name(row) == name)


def typed(stage: Stage, name: str, text: str) -> None:
    """A value changed as a person does it: the row, F2, the text, Enter."""
    panel = stage.studio.at_machine.values
    panel.table.setFocus()
    panel.table.setCurrentCell(row_of(panel, name), VALUE)
    QTest.keyClick(panel.table, Qt.Key.Key_F2)
    editor = panel.table.findChild(QLineEdit)
    assert editor is not None
    editor.selectAll()
    QTest.keyClicks(editor, text)
    QTest.keyClick(editor, Qt.Key.Key_Return)
    stage.go(30)


@pytest.mark.parametrize("model", ["ssc2", "dmc1412"])
def test_numbers_texts_and_arrays_are_shown(stage: Stage, model: str) -> None:
    stage.go()
    assert stage.studio.at_machine.values.words() == OFFLINE
    panel = connected(stage, model=model)
    assert "NAME " in panel.words() and '"CUT"' in panel.words()
    panel.table.setCurrentCell(row_of(panel, "POS[ ]"), 0)
    stage.until(lambda: panel.elements.rowCount() == 5)
    shown = [panel.elements.item(row, 1).text() for row in range(5)]
    assert shown == ["1", "4", "9", "16", "-2.25"]
    assert panel.chosen.text() == "POS, 5 elements" and panel.plot is not None


def test_a_value_is_changed_in_control_and_read_back(stage: Stage) -> None:
    panel = connected(stage)
    typed(stage, "LEN", "7.25")
    assert stage.rig.simulation.state()["variables"]["LEN"] == 7.25
    stage.until(lambda: "LEN 7.25" in panel.words())
    typed(stage, "NAME", '"SAW"')
    stage.until(lambda: '"SAW"' in panel.words())
    typed(stage, "LEN", "12,5")
    assert "12.5" in panel.words_.text()
    assert stage.rig.simulation.state()["variables"]["LEN"] == 7.25


def test_names_that_were_typed_are_shown_and_kept_for_this_controller(stage: Stage) -> None:
    """The SSC has no LV (its list of commands): it tells no name that its program does not hold."""
    panel = connected(stage)
    stage.type("SPARE=4.5", "DM TAB[3]")
    stage.studio.desk.bring("Variables")
    stage.until(lambda: "SPARE 4.5" in panel.words() and "TAB[ ]" in panel.words())
    for name in ("KP", "TOOLONGNAME", "DEPTH"):
        panel.new.setText(name)
        QTest.keyClick(panel.new, Qt.Key.Key_Return)
        stage.go(30)
        assert ("is no name" in panel.words_.text()) == (name != "DEPTH")
    typed(stage, "DEPTH", "2.25")  # not there yet: this is what makes it
    stage.until(lambda: "DEPTH 2.25" in panel.words())
    stage.connect("simulator", "ssc1")
    panel.read.click()
    stage.until(lambda: "no variable" in panel.words())
    assert "SPARE" not in panel.words()
    stage.connect("simulator", "ssc2").type("SPARE=6")
    panel.read.click()
    stage.until(lambda: "SPARE 6" in panel.words())
    panel.table.setCurrentCell(row_of(panel, "SPARE"), VALUE)
    panel.forget.trigger()
    stage.until(lambda: "SPARE" not in panel.words() and "DEPTH" in panel.words())


def test_in_watch_it_reads_and_changes_nothing(stage: Stage) -> None:
    panel = connected(stage, "machine")
    panel.table.setCurrentCell(row_of(panel, "LEN"), VALUE)
    QTest.keyClick(panel.table, Qt.Key.Key_F2)
    assert panel.table.findChild(QLineEdit) is None and not panel.send.isEnabled()
    panel.set_wanted.emit("LEN", "1")  # whatever the window lets through, the door does not
    stage.go(30)
    assert stage.rig.simulation.state()["variables"]["LEN"] == 12.5
    assert "Watch" in panel.words_.text()


def test_a_recipe_is_saved_compared_and_sent(stage: Stage, tmp_path: Path) -> None:
    panel, path = connected(stage), tmp_path / "long.tlr"
    stage.studio.at_machine.variables.save_recipe(path)
    stage.until(path.exists)
    assert read_recipe(path.read_text(encoding="utf-8"))["LEN"] == "12.5"
    typed(stage, "LEN", "3")
    stage.until(lambda: "LEN 3" in panel.words())
    stage.studio.at_machine.variables.open_recipe(path)
    assert "LEN 3 ≠ 12.5" in panel.words()
    assert stage.rig.simulation.state()["variables"]["LEN"] == 3
    panel.send.click()
    question = stage.studio.desk.question
    assert question is not None
    question.buttons["Send"].click()
    stage.until(lambda: stage.rig.simulation.state()["variables"]["LEN"] == 12.5)
    stage.until(lambda: "LEN 12.5 12.5" in panel.words())


def test_an_element_is_changed_and_read_alone(stage: Stage) -> None:
    panel = connected(stage)
    panel.table.setCurrentCell(row_of(panel, "POS[ ]"), 0)
    stage.until(lambda: panel.elements.rowCount() == 5)
    panel.elements.setFocus()
    panel.elements.setCurrentCell(3, 1)
    QTest.keyClick(panel.elements, Qt.Key.Key_F2)
    editor = panel.elements.findChild(QLineEdit)
    assert editor is not None
    editor.selectAll()
    QTest.keyClicks(editor, "-7.5")
    before = len(stage.rig.lines)
    QTest.keyClick(editor, Qt.Key.Key_Return)
    stage.go(30)
    assert list(stage.rig.simulation.state()["arrays"]["POS"]) == [1, 4, 9, -7.5, -2.25]
    assert panel.elements.item(3, 1).text() == "-7.5"
    reads = [line for line in stage.rig.lines[before:] if "POS[" in line and "$8.4" in line]
    assert len(reads) == 1 and "POS[0]" not in reads[0]  # a long array would take minutes again


def test_a_long_array_tells_how_far_it_is_and_another_one_ends_it(stage: Stage) -> None:
    panel, size = connected(stage), count(120, 500)
    last = size - 1
    stage.rig.type(f"DM LONG[{size}]", f"LONG[{last}]=3")
    panel.show_names(["LEN"], ["LONG", "POS"])
    panel.table.setCurrentCell(row_of(panel, "LONG[ ]"), 0)
    stage.until(lambda: panel.elements.rowCount() > 40)
    assert panel.words_.text() == f"Reading LONG: {panel.elements.rowCount()} of {size}…"
    assert panel.chosen.text() == f"LONG, {size} elements"
    panel.table.setCurrentCell(row_of(panel, "POS[ ]"), 0)
    stage.until(lambda: panel.chosen.text() == "POS, 5 elements", 10.0)
    stage.until(lambda: not panel.words_.text(), 5.0)
    assert panel.elements.rowCount() == 5
    panel.table.setCurrentCell(row_of(panel, "LONG[ ]"), 0)
    stage.until(lambda: panel.elements.rowCount() == size, 60.0)
    stage.until(lambda: not panel.words_.text(), 5.0)
    assert [panel.elements.item(row, 1).text() for row in (0, last - 1, last)] == ["0", "0", "3"]


def test_arrays_are_part_of_a_recipe(stage: Stage, tmp_path: Path) -> None:
    panel, path = connected(stage), tmp_path / "long.tlr"
    stage.studio.at_machine.variables.save_recipe(path)
    stage.until(path.exists)
    recipe = read_recipe(path.read_text(encoding="utf-8"))
    assert [recipe[f"POS[{place}]"] for place in range(5)] == ["1", "4", "9", "16", "-2.25"]
    stage.rig.type("POS[1]=40", "POS[4]=0")
    panel.table.setCurrentCell(row_of(panel, "POS[ ]"), 0)
    stage.until(lambda: panel.elements.rowCount() == 5)
    stage.studio.at_machine.variables.open_recipe(path)
    assert "POS[ ] ≠ 2 of 5 elements" in panel.words()
    assert [panel.elements.item(row, 2).text() for row in range(5)] == ["1", "≠ 4", "9", "16", "≠ -2.25"]
    QTest.mouseClick(panel.send, Qt.MouseButton.LeftButton)
    question = stage.studio.desk.question
    assert question is not None
    QTest.mouseClick(question.buttons["Send"], Qt.MouseButton.LeftButton)
    stage.until(lambda: list(stage.rig.simulation.state()["arrays"]["POS"]) == [1, 4, 9, 16, -2.25])
    stage.until(lambda: "LEN 12.5" in panel.words())
    assert all(len(line) <= 80 for line in stage.rig.lines)  # ssc-tol-o-motion.txt: 80 characters a line


@given(st.integers(-(2**47), 2**47 - 1))
def test_a_number_is_shown_exactly(value: int) -> None:
    assert Fraction(number_text(value)) == Fraction(value, ONE)


@given(st.text(st.characters(min_codepoint=32, max_codepoint=126), min_size=1, max_size=6))
def test_texts_are_recognised(text: str) -> None:
    kept = text.rstrip("\0")
    assert letters_of(string_value(kept)) == kept


@given(st.fractions(-(2**31), 2**31 - 1, max_denominator=ONE).filter(lambda each: ONE % each.denominator == 0))
def test_what_is_typed_arrives_exactly(number: Fraction) -> None:
    command, problem = assignment("V", number_text(int(number * ONE)))
    assert not problem
    assert read_decimal(command.removeprefix("V=")) == int(number * ONE)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("12,5", "12.5"), ("abc", "number"), ("", "number"), ('"ABCDEFG"', "6 characters"), ('"A;B"', "semicolon"),
        ('"A', "quotation"), ("2147483648", "2147483647"), ("1;MO", "number"), ("V+1", "number"),
    ],
)  # fmt: skip
def test_what_is_no_value_is_told(text: str, words: str) -> None:
    command, problem = assignment("V", text)
    assert not command and words in problem


@pytest.mark.parametrize(
    "text", ["", "{}", "[1]", '{"kind": "twoletter recipe", "version": 2}', recipe_text({"A": "1;MO"}), '{"kind": 1']
)
def test_what_is_no_recipe_is_one_sentence(text: str) -> None:
    with pytest.raises(RecipeUnreadable) as reason:
        read_recipe(text)
    assert str(reason.value).endswith(".") or "line" in str(reason.value)
