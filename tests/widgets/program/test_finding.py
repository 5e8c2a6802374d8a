"""Find and replace by mouse and keys, in the English and in the code."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

from codegen.instructions import Comment, Jump, Label, Output, Repeat, SingleAxisMove, TwoLetterCode, Wait
from codegen.program import Program, Step
from codegen.replacing import pattern_of, replaced
from codegen.setup import Setup
from tests.widgets.program.conftest import Window
from tests.widgets.program.test_drag import in_front
from tests.widgets.program.test_view import fill

CONTROL, SHIFT = Qt.KeyboardModifier.ControlModifier, Qt.KeyboardModifier.ShiftModifier


@pytest.mark.parametrize(
    ("text", "line", "found"),
    [
        ("5", "50 2.5 5.5 X5 _5", 0),
        ("5", "5 (5) =5; 5", 4),
        ("LEN", "LEN=LEN2+LEN", 2),
        ("#A", "JP #A;JP #AB", 1),
        ("0.5", "0.5 10.5 0.55", 1),
    ],
)
def test_whole_words_find_no_part_of_a_number_or_name(text: str, line: str, found: int) -> None:
    assert len(pattern_of(text, words=True, case=True).findall(line)) == found


def test_replacing_leaves_what_would_be_wrong_and_what_nobody_typed() -> None:
    main = (
        Step("a", Wait(time="20"), note="20 ms for the lamp"),
        Step("b", Repeat(count="20"), body=(Step("c", SingleAxisMove(distance="20", speed="5")),)),
        Step("d", Output(output="2")),
    )
    done = replaced(Program(main=main), Setup(model="ssc1"), pattern_of("20", words=True, case=True), "30")
    assert done.changed == ("c", "b", "a") or set(done.changed) == {"a", "b", "c"}
    assert done.program.main[0] == Step("a", Wait(time="30"), note="30 ms for the lamp")
    assert done.program.main[1].body[0].instruction == SingleAxisMove(distance="30", speed="5")
    assert done.program.main[2] is main[2]
    wrong = replaced(Program(main=main), Setup(model="ssc1"), pattern_of("20", words=True, case=True), "20,5")
    assert (wrong.changed, set(wrong.refused)) == ((), {"a", "b", "c"})
    assert wrong.program.main == main


def program(window: Window) -> list[str]:
    """Label A, a move, a wait of 20 ms, code with WT 20, a jump to A."""
    return fill(
        window,
        Label(name="A"),
        SingleAxisMove(distance="10", speed="5"),
        Wait(time="20"),
        TwoLetterCode(text="WT 20;SB 1"),
        Jump(target="A"),
    )


def test_ctrl_f_and_f3_go_through_what_is_found_round_the_end(window: Window, qtbot: QtBot) -> None:
    ids, tree, bar = program(window), in_front(window), window.view.find_bar
    tree.choose([ids[0]])
    qtbot.keyClick(tree, Qt.Key.Key_F, CONTROL)
    assert bar.isVisible()
    assert bar.replacing.isHidden()
    qtbot.keyClicks(bar.text, "wt")
    assert window.view.delegate.found == {ids[2], ids[3]}  # the code of the wait, and the written code
    assert bar.said.text() == "2 steps"
    qtbot.keyClick(bar.text, Qt.Key.Key_Return)
    assert (tree.chosen(), bar.said.text()) == ([ids[2]], "1 of 2")
    qtbot.keyClick(bar.text, Qt.Key.Key_F3)
    assert (tree.chosen(), bar.said.text()) == ([ids[3]], "2 of 2")
    qtbot.keyClick(bar.text, Qt.Key.Key_F3)
    assert tree.chosen() == [ids[2]]
    qtbot.keyClick(bar.text, Qt.Key.Key_F3, SHIFT)
    assert tree.chosen() == [ids[3]]
    qtbot.keyClick(bar.text, Qt.Key.Key_Escape)
    assert not bar.isVisible()
    assert window.view.delegate.found == frozenset()


def test_english_and_code_are_searched_apart(window: Window, qtbot: QtBot) -> None:
    ids, bar = program(window), window.view.find_bar
    window.view.find_text()
    bar.text.setText("20")
    assert window.view.finding.found == [ids[2], ids[3]]
    bar.text.setText("Wait")
    found = {}
    for place in ("both", "english", "code"):
        bar.place.setCurrentIndex(bar.place.findData(place))
        found[place] = window.view.finding.found
    assert found == {"both": [ids[1], ids[2]], "english": [ids[1], ids[2]], "code": []}


def test_what_is_found_inside_a_folded_repeat_is_unfolded(window: Window) -> None:
    (repeat,) = fill(window, Repeat())
    (inside,) = fill(window, Comment(text="the blade"))
    window.view.tree.fold(repeat, True)
    window.view.find_text()
    window.view.find_bar.text.setText("blade")
    window.view.find_next()
    assert window.view.tree.chosen() == [inside]


def test_replace_goes_step_by_step_and_replace_all_is_one_undo(window: Window, qtbot: QtBot) -> None:
    ids, tree, bar = program(window), in_front(window), window.view.find_bar
    before = window.session.document
    tree.choose([ids[0]])
    qtbot.keyClick(tree, Qt.Key.Key_H, CONTROL)
    qtbot.keyClicks(bar.text, "20")
    qtbot.keyClicks(bar.by, "25")
    qtbot.keyClick(bar.by, Qt.Key.Key_Return)  # the selected step does not hold it: on to the first that does
    assert tree.chosen() == [ids[2]]
    qtbot.keyClick(bar.by, Qt.Key.Key_Return)
    assert window.main()[2].instruction == Wait(time="25")
    assert window.main()[3].instruction == TwoLetterCode(text="WT 20;SB 1")
    assert tree.chosen() == [ids[3]]
    window.view.undo()
    qtbot.mouseClick(bar.all, Qt.MouseButton.LeftButton)
    assert [window.main()[2].instruction, window.main()[3].instruction] == [
        Wait(time="25"),
        TwoLetterCode(text="WT 25;SB 1"),
    ]
    assert bar.said.text() == "Replaced in 2 steps"
    window.view.undo()
    assert window.session.document == before


def test_a_label_is_renamed_everywhere(window: Window, qtbot: QtBot) -> None:
    program(window)
    window.view.replace_text()
    bar = window.view.find_bar
    bar.text.setText("A")
    bar.by.setText("START")
    qtbot.mouseClick(bar.all, Qt.MouseButton.LeftButton)
    assert [line for line in window.code() if "START" in line or "#A" in line] == ["#START", "JP #START"]


def test_wording_is_not_replaced_and_the_bar_says_so(window: Window, qtbot: QtBot) -> None:
    program(window)
    window.view.replace_text()
    bar = window.view.find_bar
    bar.text.setText("Move")
    bar.by.setText("Go")
    before = window.session.document
    qtbot.mouseClick(bar.all, Qt.MouseButton.LeftButton)
    assert window.session.document is before
    assert bar.said.text() == "“Move” is wording here, not something typed: change the step itself"


def test_f3_without_a_search_says_what_to_do(window: Window, qtbot: QtBot) -> None:
    with qtbot.waitSignal(window.view.said) as said:
        window.view.find_next()
    assert said.args == ["Type what to find (Ctrl+F)"]
