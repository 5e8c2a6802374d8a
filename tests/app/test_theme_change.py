"""The theme changes piece by piece: the window answers meanwhile, and at the end all is as Qt does it in one go."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QImage
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from app.loading import load
from app.theme import Choice, make_look, make_palette, read_table, style_sheet
from device.api import StopState
from tests.app.pauses import Ticks, too_long
from tests.long import is_long
from tests.stage import Stage
from widgets.panel import show_role
from widgets.parts.look import PROPERTY

COMMAND = "pytest tests/app/test_theme_change.py"
SEEN = ("Display", "Jog", "Tuner", "Terminal")


def everything_made(stage: Stage) -> None:
    """Every panel has been seen once, a controller connected."""
    load()
    stage.studio.window.resize(1280, 800)
    stage.studio.window.show()
    stage.connect("simulator", "ssc2")
    for title in SEEN:
        stage.studio.late.bring(title)
        stage.go(5)


def changed(stage: Stage, choice: Choice) -> None:
    stage.studio.theme.choose(choice)
    stage.until(lambda: stage.studio.theme.making.done)
    stage.go(3)


def pictures(stage: Stage) -> dict[str, QImage]:
    """Every panel and the whole window, as they are on the screen."""
    found = {}
    for title in SEEN:
        stage.studio.desk.bring(title)
        stage.go(2)
        found[title] = stage.studio.window.docks[title].grab().toImage()
    found["window"] = stage.studio.window.grab().toImage()
    return found


def dressed_by_qt(stage: Stage, dark: bool) -> None:
    """The same in one go."""
    application, table = QApplication.instance(), read_table()
    assert isinstance(application, QApplication)
    look = make_look(table, dark)
    application.setProperty(PROPERTY, look)
    application.setPalette(make_palette(look))
    application.setStyleSheet("")
    application.setStyleSheet(style_sheet(table, look))
    stage.go(3)


def test_at_the_end_all_is_as_qt_does_it_in_one_go(stage: Stage) -> None:
    everything_made(stage)
    stage.studio.connection.go_offline()  # nothing changes by itself any more
    pictures(stage)  # each has the room now that it keeps
    dressed_by_qt(stage, dark=True)
    dark = pictures(stage)
    dressed_by_qt(stage, dark=False)
    light = pictures(stage)
    assert all(dark[title] != light[title] for title in dark)
    for choice, expected in ((Choice.DARK, dark), (Choice.LIGHT, light)):
        changed(stage, choice)
        found = pictures(stage)
        assert [title for title in found if found[title] != expected[title]] == [], choice


def test_a_label_that_changes_its_role_later_has_no_colour_of_the_theme_before(stage: Stage) -> None:
    label = stage.studio.display.empty
    stage.studio.window.show()
    stage.go(3)
    before = label.palette().windowText().color()
    changed(stage, Choice.DARK)
    dark = read_table()["dark"]
    assert label.palette().windowText().color().name() == dark["quiet"] != before.name()
    show_role(label, "")
    try:
        assert label.palette().windowText().color().name() == dark["text"]
    finally:
        show_role(label, "quiet")
        changed(stage, Choice.LIGHT)


def test_stop_is_heard_in_the_midst_of_it(stage: Stage) -> None:
    everything_made(stage)
    stage.studio.theme.choose(Choice.DARK)
    stage.go(4)
    assert not stage.studio.theme.making.done
    QTest.keyClick(stage.studio.window, Qt.Key.Key_F12)
    assert stage.controller.stop_state is StopState.STOPPING
    changed(stage, Choice.LIGHT)
    assert stage.controller.stop_state is StopState.STOPPED


@pytest.mark.alone
def test_no_piece_of_it_holds_the_window_up(stage: Stage) -> None:
    everything_made(stage)
    theme = stage.studio.theme

    def changing() -> dict[str, float]:
        ticks = Ticks(stage)
        for choice in (Choice.DARK, Choice.LIGHT):
            name = f"longest tick while the theme becomes {choice}"
            ticks.phase(name, lambda choice=choice: theme.choose(choice), lambda: theme.making.done, then=3)
        return ticks.worst

    assert too_long(COMMAND, changing, bare=is_long()) == {}
