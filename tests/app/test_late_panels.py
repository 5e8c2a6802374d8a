"""Panels that are made after the window: tabs of their side at first, later where they were left."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication, QGraphicsView

from app.loading import load
from device.api import State
from tests.app.pauses import Ticks, too_long
from tests.long import is_long
from tests.stage import Stage, make_studio
from widgets.panel import Panel

WHOLE = True  # the panels at the machine are there from the beginning


def shown(folder: Path) -> Stage:
    made = make_studio(folder)
    made.studio.window.show()
    made.go()
    return made


def test_they_are_tabs_of_their_side(stage: Stage) -> None:
    window = stage.studio.window
    window.show()
    stage.go()
    for title, neighbour in (("Jog", "Display"), ("X-Y view", "Display"), ("Events", "Messages")):
        stage.studio.desk.bring(title)
        stage.go()
        beside = {dock.windowTitle() for dock in window.tabifiedDockWidgets(window.docks[title])}
        assert neighbour in beside, title


def test_one_that_was_open_is_open_where_it_was(qapp: QApplication, tmp_path: Path) -> None:
    first = shown(tmp_path)
    dock = first.studio.window.docks["Jog"]
    dock.bring()
    first.studio.window.addDockWidget(Qt.DockWidgetArea.LeftDockWidgetArea, dock)
    first.go()
    first.studio.desk.leave()
    first.clear_away()
    again = shown(tmp_path)
    window = again.studio.window
    assert window.docks["Jog"].isVisible()
    assert window.dockWidgetArea(window.docks["Jog"]) == Qt.DockWidgetArea.LeftDockWidgetArea
    assert not window.docks["Events"].isVisible()
    again.clear_away()


COMMAND = "pytest tests/app/test_late_panels.py"
ACTIONS = {  # what a person opens them with; the others have a tab in the first window
    "Jog": "jog", "X-Y view": "plane", "Teach": "teach", "Operator terminal": "operator", "Tuner": "tune",
    "Scope": "scope", "Variables": "variables", "Events": "events", "Recorder": "recorder",
}  # fmt: skip


def opened(stage: Stage, title: str) -> None:
    """Brought in front as a person does it."""
    if title in ACTIONS:
        stage.studio.actions[ACTIONS[title]].trigger()
    else:
        stage.studio.desk.bring(title)


def first_looks(folder: Path) -> dict[str, float]:
    """A studio from its first tick on; then each panel is seen for the first time, a controller connected."""
    folder.mkdir()
    stage = make_studio(folder)
    ticks, studio = Ticks(stage), stage.studio
    studio.window.resize(1280, 800)
    studio.window.show()
    QApplication.processEvents()
    assert not studio.late.making.done
    ticks.phase("longest tick after the start", true=lambda: studio.late.making.done, seconds=2.0)
    ticks.phase("longest tick while connecting", stage.machine("simulator", "ssc4"),
        lambda: stage.controller.state is State.READY, then=10)  # fmt: skip
    for title in studio.window.docks:
        name = f"longest tick of the first look at {title}"
        ticks.phase(name, lambda title=title: opened(stage, title), then=4)
        ticks.phase(name, true=lambda title=title: in_front(stage, title), then=10)
    stage.clear_away()
    return ticks.worst


def in_front(stage: Stage, title: str) -> bool:
    """It can be seen, and all of it is made."""
    content = stage.studio.window.docks[title].content
    return not isinstance(content, Panel) or (content.in_sight and content.making.done)


@pytest.mark.alone
def test_no_first_look_holds_the_window_up(qapp: QApplication, tmp_path: Path) -> None:
    """The window's own time on the processor, tick by tick, once what panels are made of is loaded."""
    load()
    folders = iter(range(100))
    assert too_long(COMMAND, lambda: first_looks(tmp_path / str(next(folders))), bare=is_long()) == {}


@pytest.mark.alone
def test_connecting_with_each_panel_in_front(stage: Stage) -> None:
    """Panels make what they show when a controller is there: so each is in front once when that happens."""
    load()
    studio = stage.studio

    def connecting() -> dict[str, float]:
        ticks = Ticks(stage)
        for title in studio.window.docks:
            studio.connection.go_offline()
            opened(stage, title)
            stage.go(6)
            ticks.phase(
                f"longest tick while connecting, {title} in front",
                stage.machine("simulator", "ssc2"),
                lambda: stage.controller.state is State.READY,
                then=5,
            )
        return ticks.worst

    assert too_long(COMMAND, connecting, bare=is_long()) == {}


def early(folder: Path) -> dict[str, float]:
    """A panel that is wanted in the first moment, when it is not made yet; each time in a studio of its own."""
    worst: dict[str, float] = {}
    for title in ("Jog", "Recorder", "Tuner"):
        (folder / title).mkdir(parents=True)
        stage = make_studio(folder / title)
        ticks = Ticks(stage)
        stage.studio.window.resize(1280, 800)
        stage.studio.window.show()
        QApplication.processEvents()
        ticks.phase("window", then=2)
        del ticks.worst["window"]
        assert title not in stage.studio.window.docks
        name = f"longest tick while {title} is made because somebody waits for it"
        ticks.phase(name, partial(opened, stage, title), partial(seen, stage, title), seconds=1.5)
        assert stage.studio.window.docks[title].isVisible()
        worst |= ticks.worst
        stage.clear_away()
    return worst


def seen(stage: Stage, title: str) -> bool:
    """It has come in front."""
    dock = stage.studio.window.docks.get(title)
    return dock is not None and not dock.visibleRegion().isEmpty()


@pytest.mark.alone
def test_a_panel_that_is_wanted_at_once_holds_nothing_up(qapp: QApplication, tmp_path: Path) -> None:
    load()
    folders = iter(range(100))
    assert too_long(COMMAND, lambda: early(tmp_path / str(next(folders))), bare=is_long()) == {}


def test_of_two_panels_that_are_wanted_before_they_are_made_the_later_one_comes(
    qapp: QApplication, tmp_path: Path
) -> None:
    stage = make_studio(tmp_path)
    stage.studio.window.show()
    QApplication.processEvents()
    opened(stage, "Recorder")
    opened(stage, "X-Y view")
    assert "X-Y view" not in stage.studio.window.docks
    stage.until(lambda: seen(stage, "X-Y view"))
    stage.go(5)
    assert seen(stage, "X-Y view") and not seen(stage, "Recorder")
    stage.clear_away()


def test_diagrams_that_a_panel_makes_smaller_are_painted_in_turn(stage: Stage) -> None:
    load()
    stage.studio.window.resize(1280, 800)
    stage.studio.window.show()
    stage.connect("simulator", "ssc2")
    opened(stage, "Tuner")
    panel = stage.studio.at_machine.tuning.panel
    stage.until(lambda: panel.bode_plot is not None)
    stage.go(10)
    before = {each: each.size() for each in stage.studio.window.findChildren(QGraphicsView) if each.isVisible()}
    opened(stage, "Variables")
    smaller = [each for each, size in before.items() if each.size() != size]
    assert len(smaller) > 1
    assert not any(each.updatesEnabled() for each in smaller)
    left = []
    while waiting := [each for each in smaller if not each.updatesEnabled()]:
        left.append(len(waiting))
        assert len(left) < 1000
        QApplication.processEvents()
    assert set(left) == set(range(1, len(smaller) + 1))  # one after the other
