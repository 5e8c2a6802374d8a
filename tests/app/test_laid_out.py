"""What changes all the time lays out nothing around it: neither the window nor any other panel of it."""

from __future__ import annotations

from collections import Counter

import pytest
from PySide6.QtCore import QEvent, QObject, QPoint, QRect
from PySide6.QtWidgets import QApplication, QWidget

from app.docks import Contained, settle
from tests.stage import Stage

WHOLE = True  # the panels at the machine are there from the beginning


class LaidOut(QObject):
    """Counts the times that each widget is laid out anew."""

    def __init__(self) -> None:
        super().__init__()
        self.count: Counter[QObject] = Counter()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() is QEvent.Type.LayoutRequest:
            self.count[watched] += 1
        return False


@pytest.mark.parametrize("title", ["Display", "Jog", "Teach", "Variables"])
def test_a_moving_axis_lays_out_no_window(stage: Stage, title: str) -> None:
    window = stage.studio.window
    window.resize(1280, 800)
    window.show()
    stage.connect("simulator", "ssc2")
    stage.studio.desk.bring(title)
    stage.controller.take_control()
    stage.go(10)
    stage.rig.type("SH", "JG 1000", "BG X")
    stage.go(10)
    counting, before = LaidOut(), window.status.position.text()
    QApplication.instance().installEventFilter(counting)  # type: ignore[union-attr]
    stage.go(20)
    QApplication.instance().removeEventFilter(counting)  # type: ignore[union-attr]
    assert window.status.position.text() != before
    assert counting.count[window.status.position.parent()] >= 5, "its digits have changed"
    assert counting.count[window] == 0


def test_the_status_bar_has_room_for_what_it_says_and_gives_way_in_a_small_window(stage: Stage) -> None:
    window, status = stage.studio.window, stage.studio.window.status
    window.resize(1280, 800)
    window.show()
    stage.connect("simulator", "ssc2")
    stage.go(3)
    status.show_program("▲  Thread 0: line 4, Wait until input 1 is high (AI 1)")
    settle()
    assert not status.program.cut and not status.link.cut
    window.resize(window.minimumSizeHint())
    settle()
    assert status.badge.mapTo(status, status.badge.rect().topRight()).x() < status.width()


def test_more_room_is_asked_for_when_it_is_needed(stage: Stage) -> None:
    stage.studio.window.show()
    dock = stage.studio.window.docks["Display"]
    inside, around = QWidget(), Contained(dock)
    inside.setMinimumSize(100, 50)
    dock.setWidget(around)
    around.hold(inside)
    inside.show()
    settle()
    assert inside.size() == around.size()
    wide = dock.width()
    inside.setMinimumWidth(wide + 100)
    settle()
    assert dock.width() >= wide + 100 and inside.width() == around.width()


def test_progress_takes_no_room_from_the_panels(stage: Stage) -> None:
    window = stage.studio.window
    window.resize(1280, 800)
    window.show()
    stage.connect("simulator", stage.studio.model())
    stage.controller.take_control()
    stage.go(10)
    QApplication.processEvents()
    before = window.centralWidget().height(), window.status.height()
    stage.studio.actions["download"].trigger()
    stage.until(lambda: window.status.progress.cancel.isVisible())
    QApplication.processEvents()
    cancel = window.status.progress.cancel
    assert window.status.rect().contains(QRect(cancel.mapTo(window.status, QPoint()), cancel.size())), "all of it"
    assert (window.centralWidget().height(), window.status.height()) == before
    stage.until(lambda: not window.status.progress.isVisible())
    stage.go(1)
    assert (window.centralWidget().height(), window.status.height()) == before
