"""Another controller, or none: at once nothing of the former is seen or sent to; then the panels follow, one a tick."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QColor
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from device.api import State
from tests.stage import TICK_S, Stage
from widgets.panel import Panel

WHOLE = True  # the panels at the machine are there from the beginning
FOLLOWERS = ("Display", "Simulator", "Jog", "X-Y view", "Teach", "Operator terminal", "Tuner", "Scope", "Variables")


def colours(panel: Panel) -> set[str]:
    """Of all that is seen of it."""
    image = panel.grab().toImage()
    places = ((x, y) for x in range(0, image.width(), 5) for y in range(0, image.height(), 5))
    return {QColor(image.pixel(x, y)).name() for x, y in places}


def tick(stage: Stage) -> None:
    """One, without what the stage does beside it."""
    stage.clock.pass_by(TICK_S)
    stage.studio.tick.once()
    QApplication.processEvents()


@pytest.fixture
def display(stage: Stage) -> Panel:
    """In sight, with places of a simulator in it."""
    stage.studio.window.show()
    stage.connect("simulator", "ssc2")
    stage.studio.desk.bring("Display")
    stage.until(lambda: not stage.studio.tick._to_show)  # the simulator is shown everywhere
    stage.go(5)
    assert len(colours(stage.studio.display)) > 3
    return stage.studio.display


@pytest.mark.parametrize("offline", [False, True])
def test_nothing_of_the_former_is_seen_in_any_panel(stage: Stage, display: Panel, offline: bool) -> None:
    followers = [panel for panel in stage.studio.panels if panel.title in FOLLOWERS]
    assert len(followers) == len(FOLLOWERS)
    made = [panel for panel in followers if len(colours(panel)) > 1]
    assert len(made) >= 5  # the others have nothing in them yet
    if offline:
        stage.studio.connection.go_offline()
    else:
        stage.machine("simulator", "ssc4")()
    for panel in followers:
        assert panel.controller is stage.controller, panel.title
        assert len(colours(panel)) == 1, panel.title
    for _ in followers:
        tick(stage)
    assert [panel.title for panel in made if len(colours(panel)) == 1] == []
    assert display.words().startswith("Nothing is connected") == offline


def test_what_is_in_sight_comes_first_and_alone(stage: Stage, display: Panel) -> None:
    stage.studio.desk.bring("Variables")
    stage.go(3)
    stage.studio.connection.go_offline()
    values = stage.studio.at_machine.values
    in_sight = [panel for panel in (display, values) if panel.in_sight]
    assert in_sight == [display, values]
    tick(stage)
    assert [len(colours(panel)) > 1 for panel in (display, values)] == [True, False]
    tick(stage)
    assert len(colours(values)) > 1


def test_a_click_in_between_does_nothing(stage: Stage, display: Panel) -> None:
    stage.controller.take_control()
    stage.controller.set_io_control(True)
    stage.go(5)
    lamp = stage.studio.display.outputs.lamps[0]
    place = lamp.mapTo(stage.studio.window, lamp.rect().center())
    asked: list[int] = []
    stage.studio.display.output_wanted.connect(lambda number, on: asked.append(number))

    def click() -> None:
        window = stage.studio.window.windowHandle()
        QTest.mouseClick(window, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, QPoint(place))

    click()
    assert asked == [1]
    stage.machine("simulator", "ssc2")()
    click()
    assert asked == [1]


def test_the_first_values_come_with_the_panel_that_is_in_sight(stage: Stage, display: Panel) -> None:
    rig = stage.machine("machine", "ssc2")()
    while rig.controller.state is not State.READY:
        tick(stage)
    for _ in range(10):
        tick(stage)
    assert set(stage.studio.display.axes) == {"X", "Y"}
    assert rig.controller.last().value("position.x") == 0


def test_offline_no_rate_of_reading_is_told(stage: Stage, display: Panel) -> None:
    assert "reads" in stage.studio.display.rate.text()
    stage.studio.connection.go_offline()
    stage.go(5)
    assert stage.studio.display.rate.text() == ""
