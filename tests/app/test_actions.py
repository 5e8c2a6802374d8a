"""Actions: every row has a handler, a reason when grey, and a key of its own."""

from __future__ import annotations

from collections import Counter

import pytest
from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtWidgets import QMenu

from app.actions import MAIN, ROWS, RUN, SUBMENUS
from app.facts import Facts
from device.api import Badge, Kind, State
from tests.stage import Stage

OWN = [row for row in ROWS if not row.program]
READY = Facts(kind=Kind.MACHINE, state=State.READY, control=True, badge=Badge.SAME, steps=3)


def test_names_are_unique() -> None:
    assert max(Counter(row.name for row in ROWS).values()) == 1


@pytest.mark.parametrize("row", OWN, ids=lambda row: row.name)
def test_every_row_is_complete(row: object) -> None:
    from app.actions import MENUS, Row

    assert isinstance(row, Row)
    assert row.text
    assert row.help
    assert row.menu in MENUS


def test_every_row_has_a_handler_and_every_handler_a_row(stage: Stage) -> None:
    handlers = stage.studio._handlers()
    assert set(handlers) == {row.name for row in OWN} - SUBMENUS


def test_every_program_row_exists_in_the_program_window(stage: Stage) -> None:
    names = {row.name for row in ROWS if row.program and not row.name.startswith("-")}
    assert names <= set(stage.studio.program.commands)


def test_no_key_is_given_twice(stage: Stage) -> None:
    mine = [action.shortcut() for action in stage.studio.actions.actions.values()]
    theirs = [action.shortcut() for action in stage.studio.program.commands.values()]
    keys = [key.toString() for key in (*mine, *theirs) if not key.isEmpty()]
    assert [key for key, times in Counter(keys).items() if times > 1] == []
    assert QKeySequence("F12").toString() not in keys


@pytest.mark.parametrize(
    ("name", "facts", "words"),
    [
        ("download", Facts(), "Connect a controller"),
        ("download", Facts(kind=Kind.MACHINE, state=State.LOST, steps=1), "does not answer"),
        ("download", Facts(kind=Kind.MACHINE, state=State.READY, steps=1), "switch to Control"),
        ("download", Facts(kind=Kind.REPLAY, state=State.READY, control=True, steps=1), "recording"),
        ("download", Facts(kind=Kind.MACHINE, state=State.READY, control=True), "program is empty"),
        ("download", Facts(kind=Kind.MACHINE, state=State.READY, control=True, steps=1, busy="Uploading"), "Uploading"),
        ("execute", Facts(kind=Kind.MACHINE, state=State.READY, control=True, prompt=True), "waits for an answer"),
        ("halt", Facts(kind=Kind.MACHINE, state=State.READY), "switch to Control"),
        ("burn", Facts(kind=Kind.MACHINE, state=State.READY), "switch to Control"),
        ("disconnect", Facts(), "Nothing is connected"),
    ],
)
def test_a_grey_action_says_why(stage: Stage, name: str, facts: Facts, words: str) -> None:
    stage.studio.actions.show_facts(facts)
    action = stage.studio.actions[name]
    assert not action.isEnabled()
    assert words in action.statusTip()
    assert words in action.toolTip()


@pytest.mark.parametrize("name", ["download", "execute", "halt", "burn", "upload"])
def test_with_control_and_a_program_everything_is_possible(stage: Stage, name: str) -> None:
    stage.studio.actions.show_facts(READY)
    assert stage.studio.actions[name].isEnabled()
    assert stage.studio.actions[name].statusTip() == stage.studio.actions.rows[name].help


def test_uploading_needs_no_control(stage: Stage) -> None:
    stage.studio.actions.show_facts(Facts(kind=Kind.MACHINE, state=State.READY))
    assert stage.studio.actions["upload"].isEnabled()


def test_stop_is_never_grey(stage: Stage) -> None:
    for facts in (Facts(), READY, Facts(kind=Kind.MACHINE, state=State.LOST)):
        stage.studio.actions.show_facts(facts)
        assert stage.studio.actions["stop"].isEnabled()


def test_the_toolbar_has_the_buttons_of_the_manual(stage: Stage) -> None:
    # ssc-tol-o-motion.txt, chapter 5, "Controller Online": the table names twelve
    table = {
        "exit", "save", "open", "setup", "terminal", "program", "teach", "display", "scope", "tune", "jog", "help",
    }  # fmt: skip
    names = {name for group in MAIN for name in group}
    assert names == table


def test_no_row_is_grey_for_ever(stage: Stage) -> None:
    stage.studio.actions.show_facts(READY)
    assert [name for name, action in stage.studio.actions.actions.items() if not action.isEnabled()] == []


def test_the_program_window_has_download_execute_halt_burn() -> None:
    # ssc-tol-o-motion.txt, chapter 5, "Menus and Buttons"
    assert {"download", "execute", "halt", "burn"} <= {name for group in RUN for name in group}


def test_every_row_is_in_its_menu(stage: Stage) -> None:
    menus = {action.text().replace("&", ""): action.menu() for action in stage.studio.window.header.menus.actions()}
    for row in OWN:
        menu = stage.studio.window.submenus[row.submenu] if row.submenu else menus[row.menu]
        assert isinstance(menu, QMenu)
        texts = [action.text() for action in menu.actions()]
        assert row.text in texts


def test_each_toolbar_action_is_the_one_of_the_menu(stage: Stage) -> None:
    for bar in (stage.studio.window.header.toolbar, stage.studio.window.run_bar.toolbar):
        shown = [action for action in bar.actions() if not action.isSeparator()]
        actions: list[QAction] = [action for action in shown if bar.widgetForAction(action).objectName() != "arrow"]
        assert all(stage.studio.actions[action.objectName()] is action for action in actions)


def test_dark_and_light_are_chosen_and_remembered(stage: Stage) -> None:
    stage.studio.actions["theme_dark"].trigger()
    assert stage.studio.settings.get("theme") == "dark"
    assert stage.studio.actions["theme_dark"].isChecked()
    assert not stage.studio.actions["theme_light"].isChecked()
    stage.studio.actions["theme_light"].trigger()
    assert stage.studio.settings.get("theme") == "light"
