"""Subroutines and repeats are folded by mouse and keys, and stay so; an edit asks for the visible rows only."""

from __future__ import annotations

import sys
from types import FrameType

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from codegen.generate import Listing
from codegen.instructions import Output, Repeat, Wait
from tests.widgets.program.conftest import Window
from tests.widgets.program.test_drag import blocks, in_front
from tests.widgets.program.test_view import fill
from widgets.program.model import ProgramModel


def seen(window: Window) -> list[str]:
    """What is on the screen, by the names of `blocks`."""
    return [node.id for node in window.view.model.rows]


def test_a_click_on_the_arrow_folds_and_unfolds(window: Window, qtbot: QtBot) -> None:
    ids = blocks(window)
    tree, model = window.view.tree, window.view.model
    everything = seen(window)
    at = tree.arrow_of(model.nodes[ids["outer"]]).center()
    qtbot.mouseClick(tree.viewport(), Qt.MouseButton.LeftButton, pos=at)
    assert seen(window) == [name for name in everything if name not in (ids["2"], ids["inner"], ids["3"])]
    qtbot.mouseClick(tree.viewport(), Qt.MouseButton.LeftButton, pos=at)
    assert seen(window) == everything


def test_left_and_right_fold_and_walk_as_in_any_tree(window: Window, qtbot: QtBot) -> None:
    ids, tree = blocks(window), in_front(window)
    everything = seen(window)
    tree.choose([ids["3"]])
    walk = [
        (Qt.Key.Key_Left, "inner", False),  # out to what it stands in
        (Qt.Key.Key_Left, "inner", True),  # which folds
        (Qt.Key.Key_Right, "inner", False),  # and unfolds
        (Qt.Key.Key_Right, "3", False),  # and in again
    ]
    for key, name, folded in walk:
        qtbot.keyClick(tree, key)
        assert (tree.current(), window.view.model.nodes[ids["inner"]].folded) == (ids[name], folded)
    assert seen(window) == everything


def test_enter_folds_a_section(window: Window, qtbot: QtBot) -> None:
    ids, tree = blocks(window), in_front(window)
    tree.choose(["main"])
    qtbot.keyClick(tree, Qt.Key.Key_Return)
    assert not {ids["1"], ids["outer"], ids["4"]} & set(seen(window))
    assert {ids["FEED"], ids["CUT"]} <= set(seen(window))


def test_home_and_end_go_to_the_ends(window: Window, qtbot: QtBot) -> None:
    ids, tree = blocks(window), in_front(window)
    qtbot.keyClick(tree, Qt.Key.Key_End)
    assert tree.current() == ids["CUT end"]
    qtbot.keyClick(tree, Qt.Key.Key_Home)
    assert window.view.model.node(tree.currentIndex()).id == "configuration"
    qtbot.keyClick(tree, Qt.Key.Key_End, Qt.KeyboardModifier.ShiftModifier)
    assert set(tree.chosen()) == {ids[name] for name in ("1", "outer", "4", "FEED", "CUT")}


def test_folded_stays_folded_over_edits_undo_and_a_move(window: Window) -> None:
    ids = blocks(window)
    view = window.view
    view.tree.fold(ids["inner"], True)
    view.tree.fold(ids["FEED"], True)
    window.session.replace(ids["3"], Wait(time="33"))
    window.session.remove([ids["4"]])
    window.session.undo()
    view.set_view("both")
    view.tree.choose([ids["inner"]])
    view.move_up()
    assert view.model.nodes[ids["inner"]].folded
    assert view.model.nodes[ids["FEED"]].folded
    assert not {ids["3"], ids["5"]} & set(seen(window))


def test_folding_takes_the_selection_to_the_row_that_hides_it(window: Window) -> None:
    ids = blocks(window)
    tree = window.view.tree
    tree.choose([ids["3"]])
    tree.fold(ids["outer"], True)
    assert tree.chosen() == [ids["outer"]]


def test_what_is_looked_for_unfolds_what_hides_it(window: Window) -> None:
    ids = blocks(window)
    window.view.tree.fold(ids["inner"], True)
    window.view.tree.fold(ids["outer"], True)
    window.view.reveal_step(ids["3"])
    assert window.view.tree.chosen() == [ids["3"]]
    assert ids["3"] in seen(window)


def test_fold_all_and_unfold_all(window: Window) -> None:
    ids = blocks(window)
    everything = seen(window)
    window.view.fold_all()
    assert set(seen(window)) == {
        "configuration", "main", "routines", ids["1"], ids["outer"], ids["4"], ids["FEED"], ids["CUT"],
    }  # fmt: skip
    window.view.unfold_all()
    assert seen(window) == everything


def test_a_thread_inside_a_folded_block_is_marked_on_the_block(window: Window) -> None:
    ids = blocks(window)
    window.view.tree.fold(ids["outer"], True)
    listing: Listing = window.session.listing
    window.view.show_executing({0: listing.lines_of(ids["3"])[0], 2: listing.lines_of(ids["2"])[0]})
    assert window.view.delegate.marks == {ids["outer"]: (0, 2)}
    window.view.tree.fold(ids["outer"], False)
    assert window.view.delegate.marks == {ids["3"]: (0,), ids["2"]: (2,)}


def test_a_screen_reader_hears_what_is_folded_and_where_a_step_stands(window: Window) -> None:
    ids = blocks(window)
    model = window.view.model
    window.view.tree.fold(ids["FEED"], True)
    role = Qt.ItemDataRole.AccessibleTextRole
    assert model.index_of(ids["FEED"]).data(role) == "Subroutine FEED, folded, 2 inside"
    assert model.index_of(ids["2"]).data(role).startswith("Wait 2 ms")
    assert model.index_of(ids["2"]).data(role).endswith(", inside Repeat")


def test_an_edit_of_1000_steps_asks_for_the_visible_rows_only(window: Window) -> None:
    ids = fill(window, *(Wait(time=str(number + 1)) for number in range(999)), Repeat())
    QApplication.processEvents()
    asked = 0
    codes = {getattr(ProgramModel, name).__code__ for name in ("index", "data", "flags", "rowCount", "columnCount")}

    def count(frame: FrameType, event: str, argument: object) -> None:
        nonlocal asked
        asked += event == "call" and frame.f_code in codes

    sys.setprofile(count)
    window.session.insert([Output(output="1")], ids[500])
    window.session.remove([ids[400]])
    QApplication.processEvents()
    sys.setprofile(None)
    visible = window.view.tree.viewport().height() // 32 + 1
    assert 0 < asked < 20 * visible  # a view that laid out all rows would ask 1000 times and more
