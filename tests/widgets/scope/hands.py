"""A scope with a machine behind it, and the hands of a person at it."""

from __future__ import annotations

import math

import numpy as np
import pyqtgraph
from PySide6.QtCore import QEvent, QPoint, QPointF, Qt
from PySide6.QtGui import QMouseEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QComboBox, QMenu, QWidget

from device.capture import Capture, Channel
from tests.stage import Stage
from widgets.scope.body import Body
from widgets.scope.chart import Chart

SCALE = 500  # counts per mm
LEFT = Qt.MouseButton.LeftButton


def scope(stage: Stage, kind: str = "simulator", model: str = "ssc2") -> Body:
    """The panel in its window, a machine behind it with its motors on."""
    rig = stage.connect(kind, model)
    stage.controller.take_control()
    rig.type("SH", "SP 40000", "AC 512000", "DC 512000")
    stage.studio.actions["scope"].trigger()
    stage.studio.window.docks["Scope"].resize(1180, 720)
    stage.go()
    body = stage.studio.at_machine.curves.body
    assert body is not None
    return body


def choose(box: QComboBox, words: str) -> None:
    """By keys, as somebody without a mouse does."""
    box.setFocus()
    QTest.keyClick(box, Qt.Key.Key_Home)
    for _ in range(box.count()):
        if box.currentText() == words:
            return
        QTest.keyClick(box, Qt.Key.Key_Down)
    assert box.currentText() == words


def enter(widget: QWidget, text: str) -> None:
    widget.setFocus()
    QTest.keyClick(widget, Qt.Key.Key_A, Qt.KeyboardModifier.ControlModifier)
    QTest.keyClicks(widget, text)
    QTest.keyClick(widget, Qt.Key.Key_Tab)


def click(button: QWidget) -> None:
    assert button.isVisible() and button.isEnabled(), button.toolTip()
    QTest.mouseClick(button, LEFT)


def finished(stage: Stage, seconds: float = 120) -> Capture:
    stage.until(lambda: stage.studio.at_machine.scope.job is None, seconds)
    stage.go(2)
    shown = stage.studio.at_machine.curves.body.shown
    assert shown is not None
    return shown


def settled(chart: Chart) -> None:
    """Until the picture stands still: in a slow process one look at the events is not enough."""
    before: object = None
    while (now := [(each.geometry(), each.viewRange()) for each in chart.strips.values()]) != before:
        before = now
        QTest.qWait(30)


def drag(widget: QWidget, start: QPoint, end: QPoint) -> None:
    """Pressed, moved and let go. The scene drops moves within 10 ms of another one, also of one that Qt makes up when
    something else is laid out: then a drag would be a click. So its clock has no say here. Every move is sent to the
    widget itself: a cursor that is put somewhere may be over a window that another test left there."""
    rate = pyqtgraph.getConfigOption("mouseRateLimit")
    pyqtgraph.setConfigOption("mouseRateLimit", 0)
    try:
        _move(widget, start, Qt.MouseButton.NoButton)  # a hand is there before it presses
        QTest.mousePress(widget, LEFT, pos=start)
        for part in (0.3, 0.6, 1.0):
            place = QPoint(*(round(a + part * (b - a)) for a, b in zip(start.toTuple(), end.toTuple(), strict=True)))
            _move(widget, place, LEFT)
        QTest.mouseRelease(widget, LEFT, pos=end)
    finally:
        pyqtgraph.setConfigOption("mouseRateLimit", rate)


def _move(widget: QWidget, place: QPoint, held: Qt.MouseButton) -> None:
    there, none = QPointF(place), Qt.KeyboardModifier.NoModifier
    QApplication.sendEvent(
        widget, QMouseEvent(QEvent.Type.MouseMove, there, widget.mapToGlobal(there), held, held, none)
    )
    QApplication.processEvents()


def given(body: Body) -> tuple[Capture, float]:
    """A capture whose readings mathematics tells: 3 mm of 8 Hz around 10 mm, and its cosine, over whole periods."""
    dt, count, line = 4 / 1024, 1024, 32
    hertz = line / (count * dt)
    t = np.arange(count) * dt
    values = np.stack([10 + 3 * np.sin(2 * math.pi * hertz * t), 10 + 3 * np.cos(2 * math.pi * hertz * t)]) * SCALE
    setup = body._setup
    channels = (Channel("position", "X"), Channel("position", "Y"))
    capture = Capture(channels, values, 2, 1000.0, when="2026-11-23 08:00:00", setup=setup)
    body.add(capture)
    return capture, hertz


def pick(body: Body, *keys: Qt.Key) -> None:
    """An entry of the menu that is open, by keys."""
    menu = next(each for each in body.findChildren(QMenu) if each.isVisible())
    for key in (*keys, Qt.Key.Key_Return):
        QTest.keyClick(menu, key)
