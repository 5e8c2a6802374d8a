"""Every entry of every menu by mouse: something opens or happens, or a sentence says why not; Esc leaves it."""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Collection, Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from PySide6.QtCore import QEvent, Qt
from PySide6.QtGui import QAction
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QDialog, QMenu, QWidget

from codegen.document import Document
from codegen.instructions import Output, Repeat, Subroutine, Wait
from codegen.program import Program, Step
from codegen.setup import Setup
from device.api import Kind
from tests.stage import Stage, make_studio

LEFT = Qt.MouseButton.LeftButton
FIFTY = tuple(Step(f"s{number}", Wait(time=str(number + 1))) for number in range(40))
BODY = tuple(Step(f"b{number}", Output(output=str(number + 1))) for number in range(8))
STEPS = Program(
    "MENUS", main=(*FIFTY, Step("r", Repeat(count="3"), body=BODY)), routines=(Step("u", Subroutine(name="GRIP")),)
)
EDITS = {"Undo", "Redo", "Cut", "Paste", "Duplicate", "Delete", "Comment out", "Bring back", "Move up", "Move down"}
STATES = {  # entries that only make it so: what must hold afterwards, also where it did before
    "Program": lambda stage: stage.studio.program.isVisible(),
    "Both": lambda stage: stage.studio.program.mode == "both",
    "Code": lambda stage: stage.studio.program.mode == "code",
    "Unfold all": lambda stage: not stage.studio.program.tree.folded_names(),
    "Layout: Program": lambda stage: stage.studio.settings.get("layout") == "Program",
    "Layout: Run": lambda stage: stage.studio.settings.get("layout") == "Run",
    "Layout: Tune": lambda stage: stage.studio.settings.get("layout") == "Tune",
    "Colours as the system": lambda stage: stage.studio.theme.choice == "system",
    "Light colours": lambda stage: stage.studio.theme.choice == "light",
    "Dark colours": lambda stage: stage.studio.theme.choice == "dark",
    "Display": lambda stage: not stage.studio.display.visibleRegion().isEmpty(),
    "Copy": lambda stage: bool(QApplication.clipboard().mimeData().formats()),
    "STOP": lambda stage: True,  # offline there is nothing to stop; it never asks and never refuses
}


@pytest.fixture
def stage(qapp: QApplication, tmp_path: Path) -> Iterator[Stage]:
    made = make_studio(tmp_path)
    made.studio.window.resize(1280, 800)
    made.studio.window.show()
    made.go(5)
    yield made
    made.clear_away()
    QApplication.clipboard().clear()


def windows() -> list[QWidget]:
    """Everything that stands on the screen of its own, without menus and tool tips."""
    quiet = (Qt.WindowType.Popup, Qt.WindowType.ToolTip)
    return [each for each in QApplication.topLevelWidgets() if each.isVisible() and each.windowType() not in quiet]


def looks(stage: Stage) -> tuple[object, ...]:
    """What a person can see of the studio."""
    studio = stage.studio
    program, desk = studio.program, studio.desk
    docks = [(name, dock.isVisible(), dock.isFloating()) for name, dock in sorted(studio.window.docks.items())]
    front = [name for name, dock in sorted(studio.window.docks.items()) if not dock.visibleRegion().isEmpty()]
    help = desk._help_panel.list.currentRow() if desk._help_panel is not None else None
    controller = studio.connection.controller
    return (
        [(id(each), each.windowTitle()) for each in windows()], docks, front, help,
        said(stage), program.mode, program.find_bar.isVisible(), program.run.bar.isVisible(),
        program.tree.folded_names(), program.tree.chosen(),
        studio.session.document, studio.session.before, studio.session.open_body, QApplication.focusWidget(),
        controller.kind, controller.state, controller.control, studio.run.doing,
    )  # fmt: skip


def said(stage: Stage) -> list[str]:
    """All sentences so far, and the one in the status bar that is not what an entry under the mouse does."""
    texts, now = stage.studio.messages.list, stage.studio.window.status.currentMessage()
    tips = {action.statusTip() for action in stage.studio.window.findChildren(QAction)}
    return [*[texts.item(row).text() for row in range(texts.count())], "" if now in tips else now]


def ready(stage: Stage) -> None:
    """A document of 50 steps that is not saved, a step chosen, something to undo, to do again and to paste."""
    studio = stage.studio
    session, program = studio.session, studio.program
    another = replace(STEPS, description=str(time.monotonic_ns()))  # whatever was saved: this is not
    session.set_document(Document(another, Setup(model=studio.model())), "Fifty steps")
    session.set_note("s3", "one")
    session.set_note("s3", "two")
    session.undo()
    program.set_view("program")
    studio.window.status.clearMessage()
    studio.window.activateWindow()
    program.tree.setFocus()
    program.tree.choose(["s5"])
    program.copy()
    stage.go(1)


def way_to(stage: Stage, path: tuple[str, ...]) -> tuple[QMenu, QAction]:
    """Opens the menus by mouse, as far as the entry."""
    bar = stage.studio.window.header.menus
    action = next(each for each in bar.actions() if plain(each) == path[0])
    QTest.mouseClick(bar, LEFT, pos=bar.actionGeometry(action).center())
    menu = action.menu()
    assert isinstance(menu, QMenu) and menu.isVisible(), path
    for text in path[1:]:
        entry = next(each for each in menu.actions() if plain(each) == text)
        inner = entry.menu()
        if inner is None:
            return menu, entry
        QTest.mouseClick(menu, LEFT, pos=menu.actionGeometry(entry).center())
        stage.until(inner.isVisible)
        assert isinstance(inner, QMenu)
        menu = inner
    raise AssertionError(path)


def plain(action: QAction) -> str:
    """Its words, without what changes: what would be undone, how many problems there are."""
    text = re.sub(r" \d+$", "", action.text().replace("&", ""))
    return text.split(":")[0] if text.startswith(("Undo", "Redo")) else text


def entries(stage: Stage) -> list[tuple[str, ...]]:
    """The way to every entry, as the menus have it now."""

    def below(menu: QMenu, path: tuple[str, ...]) -> Iterator[tuple[str, ...]]:
        for action in menu.actions():
            if action.isSeparator():
                continue
            inner = action.menu()
            if isinstance(inner, QMenu):
                yield from below(inner, (*path, plain(action)))
            else:
                yield (*path, plain(action))

    return [
        each
        for action in stage.studio.window.header.menus.actions()
        for each in below(action.menu(), (plain(action),))  # type: ignore[arg-type]
    ]


def leave(stage: Stage, there: list[QWidget]) -> list[str]:
    """Esc in everything that has been opened; what stays open. Panels go back into the window."""
    for dock in stage.studio.window.docks.values():
        dock.setFloating(False)
    program = stage.studio.program
    bars = [bar for bar in (program.find_bar, program.run.bar) if bar.isVisible()]
    for bar in bars:
        QTest.keyClick(bar.text if bar is program.find_bar else bar.chooser, Qt.Key.Key_Escape)
    for _ in range(4):
        new = [each for each in windows() if each not in there]
        for window in reversed(new):
            if window.isVisible():
                target = QApplication.focusWidget() if window.isActiveWindow() else None
                QTest.keyClick(target or window, Qt.Key.Key_Escape)
                stage.go(1)
    open_ = [each for each in windows() if each not in there] + [bar for bar in bars if bar.isVisible()]
    return [f"{type(each).__name__} {each.windowTitle()!r}" for each in open_]


def tried(stage: Stage, path: tuple[str, ...]) -> list[str]:
    """What is wrong with an entry."""
    there, session = windows(), stage.studio.session
    before, document = looks(stage), session.document
    menu, entry = way_to(stage, path)
    words = path[-1]
    if not entry.isEnabled():
        why = entry.statusTip() if entry.statusTip() else entry.text()
        for each in QApplication.topLevelWidgets():
            if isinstance(each, QMenu):
                each.close()
        return [] if len(why.split()) > 2 else [f"grey without a reason: {why!r}"]
    QTest.mouseClick(menu, LEFT, pos=menu.actionGeometry(entry).center())
    stage.go(4)
    found = []
    happened = looks(stage) != before
    if not happened and not (words in STATES and STATES[words](stage)):
        found.append("nothing happens")
    if left := leave(stage, there):
        found.append(f"Esc does not close {left}")
    if session.document != document:
        if words not in EDITS:
            found.append("it changed the program")
        else:
            session.redo() if words == "Undo" else session.undo()
            if session.document != document:
                found.append("undo does not restore the program")
    return found


def walked(stage: Stage, begin: Callable[[Stage], None], menus: Collection[str]) -> list[str]:
    """All entries of some menus; after each the studio is as it was."""
    problems = []
    for path in entries(stage):
        if path[0] not in menus:
            continue
        begin(stage)
        problems += [f"{' > '.join(path)}: {each}" for each in tried(stage, path)]
        for window in windows():
            if isinstance(window, QDialog):
                window.close()
        stage.studio.desk.arrange("Program")
        QApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    return problems


def with_control(stage: Stage) -> None:
    """Connected to a controller of the program's type, in Control, nothing under way."""
    stage.until(lambda: not stage.studio.run.doing)
    if stage.controller.kind is not Kind.SIMULATOR:
        stage.connect("simulator", stage.studio.model())
    if not stage.controller.control:
        stage.controller.take_control()
    stage.go(3)


MENUS = ("File", "Edit", "View", "Machine", "Controller", "Help")


@pytest.mark.parametrize("menus", [MENUS[:2], *[pytest.param((each,), marks=pytest.mark.long) for each in MENUS[2:]]])
def test_every_entry_offline(stage: Stage, menus: tuple[str, ...]) -> None:
    problems = walked(stage, ready, menus)
    assert not problems, "\n".join(problems)


@pytest.mark.parametrize("menu", [pytest.param(each, marks=pytest.mark.long) for each in MENUS])
def test_every_entry_with_control(stage: Stage, menu: str) -> None:
    def begin(stage: Stage) -> None:
        with_control(stage)
        ready(stage)

    problems = walked(stage, begin, (menu,))
    assert not problems, "\n".join(problems)
