"""Steps dragged by mouse and moved by keys, into and out of repeats and subroutines."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QMimeData, QPoint, Qt
from PySide6.QtGui import QDragEnterEvent, QDragMoveEvent, QDropEvent
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from codegen.instructions import AccelDecel, End, Repeat, Subroutine, Wait
from codegen.program import Section, Step
from tests.widgets.program.conftest import Window
from tests.widgets.program.test_view import add, dialog_of, fill, type_into
from widgets.program.model import NEW_MIME
from widgets.program.tree import ProgramTree

MIDDLE, TOP, BOTTOM = 0.5, 0.1, 0.9  # of the height of a row
FAR_OUT, FAR_IN = 24, 400  # pixels from the left


def drop(
    window: Window,
    data: QMimeData,
    name: str,
    height: float = MIDDLE,
    x: int = FAR_IN,
    action: Qt.DropAction = Qt.DropAction.MoveAction,
) -> None:
    """Drags over a row (of a step or a section) and lets the mouse button go there."""
    tree = window.view.tree
    row = tree.visualRect(window.view.model.index_of(name))
    at = QPoint(x, row.top() + round(height * (row.height() - 1)))
    _let_go(tree, data, at, action)


def _let_go(tree: ProgramTree, data: QMimeData, at: QPoint, action: Qt.DropAction) -> None:
    left, none, both = Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, tree.model().supportedDropActions()
    enter = QDragEnterEvent(at, both, data, left, none)
    move, fall = QDragMoveEvent(at, both, data, left, none), QDropEvent(at, both, data, left, none)
    for event in (enter, move, fall):
        event.setDropAction(action)
        QApplication.sendEvent(tree.viewport(), event)
    QApplication.processEvents()


def dragged(window: Window, ids: list[str]) -> QMimeData:
    """What a drag of these steps carries."""
    model = window.view.model
    return model.mimeData([model.index_of(step_id) for step_id in ids])


def test_several_steps_are_dragged_into_a_repeat_and_out_again(window: Window) -> None:
    ids = fill(window, Wait(time="1"), Wait(time="2"), Wait(time="3"))
    (repeat,) = fill(window, Repeat())
    drop(window, dragged(window, ids[:2]), repeat)
    assert [step.id for step in window.main()] == [ids[2], repeat]
    assert [step.id for step in window.main()[1].body] == ids[:2]
    assert window.view.tree.chosen() == ids[:2]
    drop(window, dragged(window, [ids[1]]), Section.MAIN, BOTTOM)
    assert [step.id for step in window.main()] == [ids[1], ids[2], repeat]
    window.view.undo()
    window.view.undo()
    assert [step.id for step in window.main()] == [*ids, repeat]


def test_a_copying_drag_adds_copies(window: Window) -> None:
    ids = fill(window, Wait(time="1"))
    drop(window, dragged(window, ids), Section.MAIN, action=Qt.DropAction.CopyAction)
    assert [step.instruction for step in window.main()] == [Wait(time="1"), Wait(time="1")]


def test_a_drop_that_does_not_fit_is_refused_in_words(qtbot: QtBot, window: Window) -> None:
    (step_id,) = fill(window, AccelDecel(acceleration=("400", "", "", "")))
    before = window.session.document
    with qtbot.waitSignal(window.view.said) as said:
        drop(window, dragged(window, [step_id]), Section.MAIN)
    assert said.args == ["Accel and Decel belongs to Configuration"]
    assert window.session.document is before


def test_an_instruction_dragged_out_of_the_palette_opens_its_dialog_for_that_place(
    qtbot: QtBot, window: Window
) -> None:
    ids = fill(window, Wait(time="1"), Wait(time="2"))
    data = QMimeData()
    data.setData(NEW_MIME, b"Wait")
    drop(window, data, ids[1], TOP, action=Qt.DropAction.CopyAction)
    dialog = dialog_of(window)
    type_into(qtbot, dialog, "time", "9")
    add(qtbot, dialog)
    assert [step.instruction.time for step in window.main()] == ["1", "9", "2"]  # type: ignore[attr-defined]


def test_moving_up_and_down_with_keys(window: Window) -> None:
    ids = fill(window, Wait(time="1"), Wait(time="2"), Wait(time="3"))
    window.view.tree.choose([ids[2]])
    window.view.commands["move_up"].trigger()
    assert [step.id for step in window.main()] == [ids[0], ids[2], ids[1]]
    window.view.commands["move_down"].trigger()
    assert [step.id for step in window.main()] == ids


# ---- every place a step can be dropped on


def shape(window: Window) -> dict[str, object]:
    """The three sections: times of waits, and what the others hold."""

    def word(step: Step) -> object:
        said = getattr(step.instruction, "time", None) or getattr(step.instruction, "name", None)
        return (
            [said or step.instruction.title, *map(word, step.body)]
            if step.instruction.container
            else said or step.instruction.title
        )

    program = window.session.document.program
    return {section.value: [word(step) for step in program.section(section)] for section in Section}


def blocks(window: Window) -> dict[str, str]:
    """Main: wait 1, repeat (wait 2, repeat (wait 3)), wait 4. Subroutines: FEED (wait 5, End), CUT (wait 6, End)."""
    ids: dict[str, str] = {}
    session, view = window.session, window.view

    def put(name: str, instruction: object) -> None:
        (ids[name],) = session.insert([instruction])  # type: ignore[list-item]

    put("1", Wait(time="1"))
    put("outer", Repeat())
    put("2", Wait(time="2"))
    put("inner", Repeat())
    put("3", Wait(time="3"))
    view.end_of_repeat()
    view.end_of_repeat()
    put("4", Wait(time="4"))
    for name, wait in (("FEED", "5"), ("CUT", "6")):
        put(name, Subroutine(name=name))
        put(wait, Wait(time=wait))
        put(f"{name} end", End())
    return ids


PLAIN = {
    "configuration": [],
    "main": ["1", ["Repeat", "2", ["Repeat", "3"]], "4"],
    "routines": [["FEED", "5", "End"], ["CUT", "6", "End"]],
}


def test_the_program_of_these_tests_is_as_drawn(window: Window) -> None:
    blocks(window)
    assert shape(window) == PLAIN


LEVEL = {0: 30, 1: 50, 2: 70, 3: 90}  # pixels from the left: a step stands 20 further in for each block


@pytest.mark.parametrize(
    ("target", "height", "x", "wanted"),
    [
        ("1", TOP, 60, ["4", "1", ["Repeat", "2", ["Repeat", "3"]]]),
        ("1", BOTTOM, 60, ["1", "4", ["Repeat", "2", ["Repeat", "3"]]]),
        ("outer", TOP, 60, ["1", "4", ["Repeat", "2", ["Repeat", "3"]]]),
        ("outer", MIDDLE, 60, ["1", ["Repeat", "2", ["Repeat", "3"], "4"]]),
        ("outer", BOTTOM, 60, ["1", ["Repeat", "4", "2", ["Repeat", "3"]]]),
        ("inner", TOP, 80, ["1", ["Repeat", "2", "4", ["Repeat", "3"]]]),
        ("inner", MIDDLE, 80, ["1", ["Repeat", "2", ["Repeat", "3", "4"]]]),
        ("inner", BOTTOM, 80, ["1", ["Repeat", "2", ["Repeat", "4", "3"]]]),
        ("3", TOP, 100, ["1", ["Repeat", "2", ["Repeat", "4", "3"]]]),
        ("3", BOTTOM, LEVEL[3], ["1", ["Repeat", "2", ["Repeat", "3", "4"]]]),
        ("3", BOTTOM, LEVEL[2], ["1", ["Repeat", "2", ["Repeat", "3"], "4"]]),
        ("3", BOTTOM, LEVEL[1], ["1", ["Repeat", "2", ["Repeat", "3"]], "4"]),
        ("main", BOTTOM, 60, ["4", "1", ["Repeat", "2", ["Repeat", "3"]]]),
        ("main", MIDDLE, 60, ["1", ["Repeat", "2", ["Repeat", "3"]], "4"]),
    ],
)
def test_a_step_dropped_on_open_blocks(
    window: Window, target: str, height: float, x: int, wanted: list[object]
) -> None:
    ids = blocks(window)
    drop(window, dragged(window, [ids["4"]]), ids.get(target, target), height, x)
    assert shape(window) == {**PLAIN, "main": wanted}
    assert window.view.tree.chosen() == [ids["4"]]


@pytest.mark.parametrize(
    ("height", "wanted"),
    [
        (TOP, ["1", "4", ["Repeat", "2", ["Repeat", "3"]]]),
        (MIDDLE, ["1", ["Repeat", "2", ["Repeat", "3"], "4"]]),
        (BOTTOM, ["1", ["Repeat", "2", ["Repeat", "3"]], "4"]),
    ],
)
def test_a_step_dropped_on_a_folded_repeat(window: Window, height: float, wanted: list[object]) -> None:
    ids = blocks(window)
    window.view.tree.fold(ids["outer"], True)
    drop(window, dragged(window, [ids["4"]]), ids["outer"], height)
    assert shape(window) == {**PLAIN, "main": wanted}
    assert window.view.tree.chosen() == [ids["4"]]


@pytest.mark.parametrize("folded", [False, True])
def test_a_step_dropped_on_a_closed_subroutine_goes_in_front_of_its_end(window: Window, folded: bool) -> None:
    ids = blocks(window)
    window.view.tree.fold(ids["FEED"], folded)
    drop(window, dragged(window, [ids["4"], ids["1"]]), ids["FEED"], MIDDLE)
    assert shape(window)["routines"] == [["FEED", "5", "1", "4", "End"], ["CUT", "6", "End"]]
    assert shape(window)["main"] == [["Repeat", "2", ["Repeat", "3"]]]


@pytest.mark.parametrize("x", [LEVEL[0], LEVEL[1], LEVEL[2], FAR_IN])
def test_below_the_end_of_a_subroutine_is_in_front_of_it(window: Window, x: int) -> None:
    ids = blocks(window)
    drop(window, dragged(window, [ids["4"]]), ids["CUT end"], BOTTOM, x)
    assert shape(window)["routines"] == [["FEED", "5", "End"], ["CUT", "6", "4", "End"]]


@pytest.mark.parametrize(("target", "height"), [("routines", MIDDLE), ("FEED", TOP), ("routines", BOTTOM)])
def test_a_step_dropped_between_subroutines_is_refused_in_words(
    qtbot: QtBot, window: Window, target: str, height: float
) -> None:
    ids = blocks(window)
    with qtbot.waitSignal(window.view.said) as said:
        drop(window, dragged(window, [ids["4"]]), ids.get(target, target), height)
    assert said.args == ["Wait belongs inside a subroutine: drop it on one"]
    assert shape(window) == PLAIN


def test_a_subroutine_dropped_inside_another_is_refused_in_words(qtbot: QtBot, window: Window) -> None:
    ids = blocks(window)
    with qtbot.waitSignal(window.view.said) as said:
        drop(window, dragged(window, [ids["FEED"]]), ids["CUT"], MIDDLE)
    assert said.args == ["Subroutine belongs to Subroutines"]
    assert shape(window) == PLAIN


def test_subroutines_change_places(window: Window) -> None:
    ids = blocks(window)
    drop(window, dragged(window, [ids["FEED"]]), ids["CUT end"], BOTTOM, LEVEL[0])
    assert shape(window)["routines"] == [["CUT", "6", "End"], ["FEED", "5", "End"]]
    drop(window, dragged(window, [ids["FEED"]]), ids["CUT"], TOP)
    assert shape(window) == PLAIN


def test_a_repeat_dropped_into_itself_is_refused_in_words(qtbot: QtBot, window: Window) -> None:
    ids = blocks(window)
    with qtbot.waitSignal(window.view.said) as said:
        drop(window, dragged(window, [ids["outer"]]), ids["3"], TOP)
    assert said.args == ["A step cannot go into itself"]
    assert shape(window) == PLAIN


def test_steps_of_several_blocks_are_dropped_together_in_their_order(window: Window) -> None:
    ids = blocks(window)
    drop(window, dragged(window, [ids["4"], ids["3"], ids["1"], ids["inner"]]), ids["2"], TOP)
    assert shape(window)["main"] == [["Repeat", "1", ["Repeat", "3"], "4", "2"]]


def test_steps_dropped_below_the_last_row_go_to_the_end_of_their_section(window: Window) -> None:
    ids = blocks(window)
    data = dragged(window, [ids["1"]])
    tree = window.view.tree
    window.frame.resize(1280, 1400)
    QApplication.processEvents()
    last = tree.visualRect(window.view.model.index_of(ids["CUT end"]))
    at = QPoint(200, last.bottom() + 20)
    assert tree.rowAt(at.y()) == -1
    _let_go(tree, data, at, Qt.DropAction.MoveAction)
    assert shape(window)["main"] == [["Repeat", "2", ["Repeat", "3"]], "4", "1"]


def test_steps_of_another_window_are_copied_even_when_they_are_numbered_alike(window: Window, qtbot: QtBot) -> None:
    from app.session import Session
    from widgets.program.view import ProgramView

    fill(window, Wait(time="1"))
    other = ProgramView(Session())
    qtbot.addWidget(other)
    (step_id,) = other.session.insert([Wait(time="9")], None, None)
    data = other.model.mimeData([other.model.index_of(step_id)])
    drop(window, data, Section.MAIN, MIDDLE)
    assert [step.instruction for step in window.main()] == [Wait(time="1"), Wait(time="9")]


def test_a_new_instruction_dropped_on_a_subroutine_goes_in_front_of_its_end(qtbot: QtBot, window: Window) -> None:
    ids = blocks(window)
    data = QMimeData()
    data.setData(NEW_MIME, b"Wait")
    drop(window, data, ids["FEED"], MIDDLE, action=Qt.DropAction.CopyAction)
    dialog = dialog_of(window)
    type_into(qtbot, dialog, "time", "9")
    add(qtbot, dialog)
    assert shape(window)["routines"] == [["FEED", "5", "9", "End"], ["CUT", "6", "End"]]


# ---- the same with keys


def in_front(window: Window) -> ProgramTree:
    """The program has the focus, so that its keys work."""
    window.frame.activateWindow()
    window.view.tree.setFocus()
    return window.view.tree


def test_alt_down_walks_into_and_out_of_open_blocks(window: Window, qtbot: QtBot) -> None:
    ids, _ = blocks(window), in_front(window)
    window.view.tree.choose([ids["1"]])
    seen = []
    for _ in range(7):
        qtbot.keyClick(window.view.tree, Qt.Key.Key_Down, Qt.KeyboardModifier.AltModifier)
        seen.append(shape(window)["main"])
    assert seen == [
        [["Repeat", "1", "2", ["Repeat", "3"]], "4"],
        [["Repeat", "2", "1", ["Repeat", "3"]], "4"],
        [["Repeat", "2", ["Repeat", "1", "3"]], "4"],
        [["Repeat", "2", ["Repeat", "3", "1"]], "4"],
        [["Repeat", "2", ["Repeat", "3"], "1"], "4"],
        [["Repeat", "2", ["Repeat", "3"]], "1", "4"],
        [["Repeat", "2", ["Repeat", "3"]], "4", "1"],
    ]
    for wanted in (*reversed(seen[:-1]), PLAIN["main"]):
        qtbot.keyClick(window.view.tree, Qt.Key.Key_Up, Qt.KeyboardModifier.AltModifier)
        assert shape(window)["main"] == wanted
    with qtbot.waitSignal(window.view.said) as said:
        qtbot.keyClick(window.view.tree, Qt.Key.Key_Up, Qt.KeyboardModifier.AltModifier)
    assert said.args == ["This is the first place in Main"]


def test_alt_down_passes_a_folded_block(window: Window, qtbot: QtBot) -> None:
    ids, _ = blocks(window), in_front(window)
    window.view.tree.fold(ids["outer"], True)
    window.view.tree.choose([ids["1"]])
    qtbot.keyClick(window.view.tree, Qt.Key.Key_Down, Qt.KeyboardModifier.AltModifier)
    assert shape(window)["main"] == [["Repeat", "2", ["Repeat", "3"]], "1", "4"]


def test_alt_down_goes_from_one_subroutine_into_the_next_and_never_behind_an_end(window: Window, qtbot: QtBot) -> None:
    ids, _ = blocks(window), in_front(window)
    window.view.tree.choose([ids["5"]])
    qtbot.keyClick(window.view.tree, Qt.Key.Key_Down, Qt.KeyboardModifier.AltModifier)
    assert shape(window)["routines"] == [["FEED", "End"], ["CUT", "5", "6", "End"]]
    qtbot.keyClick(window.view.tree, Qt.Key.Key_Down, Qt.KeyboardModifier.AltModifier)
    assert shape(window)["routines"] == [["FEED", "End"], ["CUT", "6", "5", "End"]]
    with qtbot.waitSignal(window.view.said) as said:
        qtbot.keyClick(window.view.tree, Qt.Key.Key_Down, Qt.KeyboardModifier.AltModifier)
    assert said.args == ["This is the last place in Subroutines"]


def test_pasting_on_a_subroutine_goes_in_front_of_its_end(window: Window) -> None:
    ids = blocks(window)
    window.view.tree.choose([ids["1"]])
    window.view.copy()
    window.view.tree.choose([ids["FEED"]])
    window.view.paste()
    assert shape(window)["routines"] == [["FEED", "5", "1", "End"], ["CUT", "6", "End"]]


def test_insert_on_a_subroutine_says_that_steps_go_inside(qtbot: QtBot, window: Window) -> None:
    ids = blocks(window)
    window.view.tree.choose([ids["FEED"]])
    window.view.insert()
    assert window.view.bar.text.text() == "New steps go inside: Subroutine FEED"
    window.session.insert([Wait(time="9")])
    assert shape(window)["routines"] == [["FEED", "5", "9", "End"], ["CUT", "6", "End"]]


def test_a_whole_program_is_copied_and_pasted_section_by_section(window: Window, qtbot: QtBot) -> None:
    blocks(window)
    window.session.insert([AccelDecel(acceleration=("400", "", "", ""))])
    before = shape(window)
    window.view.tree.setFocus()
    qtbot.keyClick(window.view.tree, Qt.Key.Key_A, Qt.KeyboardModifier.ControlModifier)
    window.view.copy()
    window.view.delete()
    assert shape(window) == {section.value: [] for section in Section}
    window.view.paste()
    assert shape(window) == before
    window.view.undo()
    assert shape(window) == {section.value: [] for section in Section}
