"""Panels that are made after the window: tabs of their side at first, later where they were left."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication

from tests.stage import Stage, make_studio


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
