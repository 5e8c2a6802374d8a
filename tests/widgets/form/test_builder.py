"""The expression builder: what it offers by meaning, what it refuses, the value it would have."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import pytest
import shiboken6
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot

from codegen.document import Document
from codegen.expressions import Bad, parse_expression, write
from codegen.formula import leaves
from codegen.instructions import Jump, MathematicalEquation, SingleAxisMove, VariableArray, Wait
from codegen.instructions.configuration import Declare
from codegen.instructions.flow import JumpIf
from codegen.instructions.math import Equation
from codegen.program import Place, Section, fresh, insert
from tests.widgets.form.clipping import settle
from tests.widgets.form.samples import program
from widgets.form.builder import ExpressionBuilder
from widgets.form.dialog import InstructionDialog
from widgets.form.offers import LiveValues, offers_of

Call = Callable[[Mapping[str, float | str]], None]


class Readings:
    """What a controller would say; it is told here, when the test wants it."""

    def __init__(self) -> None:
        self.watched: dict[object, tuple[tuple[str, ...], Call]] = {}

    def watch(self, owner: object, texts: Sequence[str], call: Call) -> None:
        self.watched[owner] = tuple(texts), call

    def forget(self, owner: object) -> None:
        self.watched.pop(owner, None)

    def say(self, values: Mapping[str, float | str]) -> None:
        for _, call in list(self.watched.values()):
            call(values)


def opened(
    qtbot: QtBot, instruction: object, name: str, live: LiveValues | None = None
) -> tuple[InstructionDialog, ExpressionBuilder]:
    """The builder of a field, opened by its key."""
    made, setup = program("ssc4")
    made = insert(
        made, [fresh(made, VariableArray(mode=Declare.ARRAY, array="POS", size="10"))], Place(Section.MAIN, 0)
    )
    dialog = InstructionDialog(instruction, offers_of(Document(made, setup), live), new=True)  # type: ignore[arg-type]
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose, False)
    qtbot.addWidget(dialog)
    dialog.show()
    editor = dialog.form.fields.cells[name, ""].editor
    line = getattr(editor, "line", editor)
    line.setFocus()
    QTest.keyClick(line, Qt.Key.Key_Space, Qt.KeyboardModifier.ControlModifier)
    settle()
    builder = line.builder
    assert builder is not None and builder.isVisible() and not builder.isModal()
    return dialog, builder


def find(builder: ExpressionBuilder, words: str) -> str:
    """What stands first when these words are searched."""
    builder.search.setText(words)
    item = builder.tree.currentItem()
    assert item is not None and not item.isHidden()
    return item.text(1)


def test_everything_is_found_by_its_meaning(qtbot: QtBot) -> None:
    _, builder = opened(qtbot, Wait(), "time")
    assert find(builder, "actual position X") == "_TPX"
    assert find(builder, "following error w") == "_TEW"
    assert find(builder, "sine of an angle") == "@SIN[]"
    assert find(builder, "forward limit switch y") == "_LFY"
    assert find(builder, "clock samples") == "TIME"
    assert find(builder, "array pos") == "POS[]"
    assert find(builder, "variable len") == "LEN"
    assert find(builder, "at least") == ">="


def test_it_is_built_with_keys_and_goes_into_the_field(qtbot: QtBot) -> None:
    dialog, builder = opened(qtbot, SingleAxisMove(axis="X"), "distance")
    for words in ("variable len", "add", "function absolute"):
        builder.search.setFocus()
        builder.search.selectAll()
        QTest.keyClicks(builder.search, words)
        QTest.keyClick(builder.search, Qt.Key.Key_Return)
    assert builder.line.text() == "LEN+@ABS[]"
    QTest.keyClicks(builder.line, "2")  # the cursor stands inside the brackets
    assert builder.line.text() == "LEN+@ABS[2]"
    assert builder.verdict.text() == "LEN+@ABS[2] × 637, rounded down to whole counts"  # counts in an inch
    QTest.keyClick(builder.line, Qt.Key.Key_Return)
    settle()
    assert dialog.form.instruction == SingleAxisMove(axis="X", distance="LEN+@ABS[2]")


@pytest.mark.parametrize(
    ("typed", "told"),
    [
        ("LEN+2*3", "group it with brackets: (LEN+2)*3 or LEN+(2*3)"),
        ("12,5", "write 12.5"),
        ("LEN+", "something is missing at the end"),
        ("@TAN[1]", "there is no function @TAN"),
    ],
)
def test_what_is_wrong_is_told_while_it_is_typed(qtbot: QtBot, typed: str, told: str) -> None:
    dialog, builder = opened(qtbot, SingleAxisMove(axis="X"), "distance")
    QTest.keyClicks(builder.line, typed)
    assert told in builder.verdict.text() and not builder.use.isEnabled()
    QTest.keyClick(builder.line, Qt.Key.Key_Return)
    assert builder.isVisible() and dialog.form.instruction == SingleAxisMove(axis="X")


def test_offline_a_value_needs_what_is_assumed(qtbot: QtBot) -> None:
    """(_TPX + LEN) with 1274 counts of 637 an inch and 3: 5 in."""
    _, builder = opened(qtbot, SingleAxisMove(axis="X"), "distance")
    builder.line.setText("_TPX+LEN")
    assert builder.value.text() == "Value now: not known offline: assume a value below to see the result"
    QTest.keyClicks(builder.assumed["_TPX"], "1274")
    QTest.keyClicks(builder.assumed["LEN"], "3")
    assert builder.value.text() == "With the assumed values: 5 in"
    builder.assumed["LEN"].setText("1,5")
    builder._show_value()
    assert builder.value.text() == "LEN: write 1.5"
    builder.line.setText("2*3")
    assert builder.value.text() == "It is 6 in"


def test_online_it_shows_the_value_now(qtbot: QtBot) -> None:
    live = Readings()
    _, builder = opened(qtbot, SingleAxisMove(axis="X"), "distance", live)
    builder.line.setText("(_TPX/2)+POS[LEN+1]")
    assert [texts for texts, _ in live.watched.values()] == [("_TPX", "POS[LEN+1]")]
    live.say({"_TPX": 1274.0, "POS[LEN+1]": 0.5})
    assert builder.value.text() == "Now: 1.5 in"  # 2 in / 2 + 0.5
    live.say({"_TPX": 1274.0, "POS[LEN+1]": "array does not exist"})
    assert builder.value.text() == "POS[LEN+1]: array does not exist"
    builder.close()
    assert live.watched == {}


def test_a_condition_is_raw_counts_and_true_or_false(qtbot: QtBot) -> None:
    live = Readings()
    _, builder = opened(qtbot, Jump(target="A", when=JumpIf.CONDITION), "condition", live)
    builder.line.setText("(_TPX>1000)&(@IN[1]=1)")
    assert builder.verdict.text() == "Positions and speeds of the controller are raw counts here."
    live.say({"_TPX": 1274.0, "@IN[1]": 1.0})
    assert builder.value.text() == "Now: 1"


def test_an_equation_of_a_list_has_its_own_builder(qtbot: QtBot) -> None:
    made, setup = program("ssc4")
    dialog = InstructionDialog(
        MathematicalEquation(equations=(Equation(variable="A", expression="1"),)),
        offers_of(Document(made, setup)),
        new=True,
    )
    qtbot.addWidget(dialog)
    dialog.show()
    editor = dialog.form.fields.cells["equations", ""].editor.form.cells["expression", ""].editor
    editor.line.build()
    builder = editor.line.builder
    builder.line.setText("LEN*2")
    QTest.mouseClick(builder.use, Qt.MouseButton.LeftButton)
    assert dialog.form.instruction.equations[0].expression == "LEN*2"  # type: ignore[attr-defined]


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("LEN*2", ["LEN"]), ("POS[N+1]", ["POS[N+1]"]), ("@SIN[A]+@IN[3]", ["A", "@IN[3]"]), ("TIME-TIME", ["TIME"]),
        ("3+4", []),
    ],
)  # fmt: skip
def test_leaves_are_what_the_controller_alone_knows(text: str, wanted: list[str]) -> None:
    tree = parse_expression(text)
    assert not isinstance(tree, Bad)
    assert list(map(write, leaves(tree))) == wanted


def test_a_dialog_that_goes_takes_its_builder_along(qtbot: QtBot) -> None:
    """Nothing is read for it any more, and no reading reaches what is gone."""
    live = Readings()
    made, setup = program("ssc4")
    dialog = InstructionDialog(SingleAxisMove(axis="X"), offers_of(Document(made, setup), live), new=True)
    dialog.show()
    line = dialog.form.fields.cells["distance", ""].editor
    line.build()
    line.builder.line.setText("LEN")
    assert len(live.watched) == 1
    dialog.reject()
    shiboken6.delete(dialog)
    assert live.watched == {}
