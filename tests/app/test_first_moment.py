"""From the first moment at which something of a panel is seen, nothing is enabled that a moment later is grey.

A click in that moment would do what the panel says cannot be done: without a controller, in Watch, with a lost line.
"""

from __future__ import annotations

from collections.abc import Callable

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QAbstractButton, QApplication, QButtonGroup, QComboBox, QLineEdit, QWidget

from device.api import State
from tests.stage import TICK_S, Stage
from widgets.panel import Panel

GROWN, SETTLED = 60, 10  # ticks
LINGER = 3
CONTROLS = (QAbstractButton, QLineEdit, QComboBox)


def nobody(stage: Stage) -> None:
    """Offline."""


def watched(stage: Stage) -> None:
    stage.connect("machine")
    assert not stage.controller.control


def lost(stage: Stage) -> None:
    rig = stage.connect("machine")
    stage.controller.take_control()
    stage.go()
    rig.cut()
    stage.until(lambda: stage.controller.state is State.LOST)


def lost_meanwhile(stage: Stage) -> None:
    """Every panel was worked with before."""
    rig = stage.connect("machine")
    stage.controller.take_control()
    for title in stage.studio.window.docks:
        stage.studio.desk.bring(title)
        stage.go()
    rig.cut()
    stage.until(lambda: stage.controller.state is State.LOST)


def enabled(content: QWidget) -> set[QWidget]:
    """What could be clicked or typed into now."""
    return {
        each
        for kind in CONTROLS
        for each in content.findChildren(kind)
        if each.isVisible() and each.isEnabled() and not each.visibleRegion().isEmpty()
    }


def tick(stage: Stage) -> None:
    """One, as in the program: a panel grows by a piece."""
    stage.clock.pass_by(TICK_S)
    stage.studio.tick.once()
    QApplication.processEvents()


def name_of(widget: QWidget) -> str:
    text = widget.text() if isinstance(widget, QAbstractButton) else ""
    return f"{type(widget).__name__} {widget.accessibleName() or text or widget.objectName()}"


def too_early(stage: Stage, content: QWidget, begin: Callable[[], object]) -> list[str]:
    """What was enabled at some moment from then on, and is grey in the end though it is still seen."""
    begin()
    QApplication.processEvents()
    seen = enabled(content)
    for _ in range(GROWN):
        tick(stage)
        if not isinstance(content, Panel) or content.making.done:
            break
        seen |= enabled(content)
    seen |= enabled(content)
    for _ in range(LINGER):
        tick(stage)
        seen |= enabled(content)
    for _ in range(SETTLED):
        tick(stage)
    return sorted(name_of(each) for each in seen if each.isVisible() and not each.isEnabled())


def pages(content: QWidget) -> list[QAbstractButton]:
    """Buttons that choose what is shown, by their groups."""
    groups = content.findChildren(QButtonGroup)
    found = [each for group in groups if group.exclusive() for each in group.buttons()]
    return [each for each in found if each.isVisible() and each.isEnabled()]


@pytest.mark.parametrize("state", [nobody, watched, lost, lost_meanwhile], ids=lambda each: each.__name__)
def test_nothing_is_enabled_for_a_moment_only(state: Callable[[Stage], None], stage: Stage) -> None:
    stage.studio.late.making.finish()  # the panels, empty; each is filled when it is looked at
    state(stage)
    found: dict[str, list[str]] = {}
    for title, dock in stage.studio.window.docks.items():
        found[title] = too_early(stage, dock.content, lambda title=title: stage.studio.desk.bring(title))
        for button in pages(dock.content):
            if not button.isVisible() or not button.isEnabled():
                continue
            name = f"{title}, {name_of(button)}"
            found[name] = too_early(
                stage, dock.content, lambda button=button: QTest.mouseClick(button, Qt.MouseButton.LeftButton)
            )
    assert state is nobody or len(found) > len(stage.studio.window.docks)  # some have pages
    assert {name: each for name, each in found.items() if each} == {}
