"""The X-Y view against a simulated table: the trail is the path that was commanded, in user units."""

from __future__ import annotations

import dataclasses as dc
import math
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QGuiApplication
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QWidget
from pytestqt.qtbot import QtBot

from codegen.setup import Unit
from tests.stage import Stage, make_studio
from widgets.parts.plot import Plot
from widgets.plane.panel import EMPTY, ONE_AXIS
from widgets.plane.trail import Trail

SCALE = 100  # counts per mm


@pytest.fixture
def stage(qapp: QApplication, tmp_path: Path) -> Stage:
    made = make_studio(tmp_path)
    document = made.studio.session.document
    axis = dc.replace(
        document.setup.axes[0], unit=Unit.MM, counts_per_unit=str(SCALE), reverse_limit="-50", forward_limit="200"
    )
    setup = dc.replace(document.setup, model="ssc2", axes=(axis,) * 4)
    made.studio.session.set_document(dc.replace(document, setup=setup), "Table")
    made.studio.window.show()
    made.go()
    made.studio.desk.bring("X-Y view")
    yield made
    made.clear_away()


def test_nothing_connected_and_one_axis_are_said(stage: Stage) -> None:
    stage.go()
    assert stage.studio.at_machine.plane.words() == EMPTY
    stage.connect("simulator", "ssc1")
    stage.go()
    assert stage.studio.at_machine.plane.words() == ONE_AXIS


def test_a_circle_leaves_a_circle(stage: Stage) -> None:
    rig = stage.connect("simulator", "ssc2")
    plane = stage.studio.at_machine.plane
    rig.type("VS 4000", "VA 200000", "VD 200000", "VM XY", "CR 5000,180,360", "VE", "BGS")
    stage.until(lambda: plane.actual.count > 8)
    for _ in range(10):  # cross and point are of one moment, whatever else is in sight
        stage.go(1)
        times = [stage.controller.last().time(key) for key in plane.watches()]
        assert len(times) == 4 and max(times) - min(times) < 0.0005
    stage.until(lambda: not rig.simulation.state()["axes"]["X"]["moving"])
    stage.go(30)
    # CR 5000,180,360 starts at angle 180 degrees: the centre lies one radius, 50 mm, to the right of the start
    radii = np.hypot(plane.commanded.points[:, 0] - 50, plane.commanded.points[:, 1])
    assert np.all(np.abs(radii - 50) < 1.5 / SCALE)
    assert np.ptp(plane.commanded.points[:, 0]) > 60  # all around, not one place of it
    assert plane.words().startswith("X 0.00 mm   Y 0.00 mm") or plane.words().startswith("X -0.01 mm")
    plane.clear.click()
    assert plane.actual.count == 0


def test_the_soft_limits_are_drawn_and_the_other_axis_gives_way(stage: Stage) -> None:
    stage.connect("simulator", "ssc3")
    stage.go()
    plane = stage.studio.at_machine.plane
    across, upward = plane._drawn["limits"].getData()
    assert (min(across), max(across), min(upward), max(upward)) == (-50, 200, -50, 200)
    assert plane.shown == "XY"
    plane.across.setCurrentText("Y")
    assert plane.shown == "YZ"


def test_keys_pan_zoom_and_fit_and_copy(qtbot: QtBot, stage: Stage) -> None:
    window = QWidget()
    qtbot.addWidget(window)
    plot = Plot("A diagram", parent=window)
    plot.plot([0, 10], [0, 10])
    window.show()
    plot.fit()
    (left, right), _ = plot.viewRange()
    QTest.keyClick(plot, Qt.Key.Key_Right)
    (moved, _), _ = plot.viewRange()
    assert moved == pytest.approx(left + (right - left) / 10)
    QTest.keyClick(plot, Qt.Key.Key_Plus)
    (low, high), _ = plot.viewRange()
    assert high - low == pytest.approx(0.8 * (right - left))
    QTest.keyClick(plot, Qt.Key.Key_Home)
    assert plot.viewRange()[0] == pytest.approx([left, right])
    QTest.keyClick(plot, Qt.Key.Key_C, Qt.KeyboardModifier.ControlModifier)
    assert QGuiApplication.clipboard().pixmap().size() == plot.grab().size()


def test_the_memory_of_the_trail_is_bounded() -> None:
    trail = Trail(100)
    for number in range(1000):
        assert trail.add(math.cos(number), math.sin(number))
    assert not trail.add(math.cos(999), math.sin(999))  # stands still
    assert not trail.add(math.nan, 0)
    assert trail.count <= 100
    assert tuple(trail.points[-1]) == (math.cos(999), math.sin(999))
    assert tuple(trail.points[0]) == (1.0, 0.0)  # the beginning is never forgotten


def test_a_path_to_be_driven_lies_under_the_trail_and_turns_with_the_axes(stage: Stage) -> None:
    stage.connect("simulator", "ssc2")
    plane = stage.studio.at_machine.plane
    stage.go()
    plane.show_path("taught", [(0, 0), (3, 0), (3, 4)])
    line = plane._drawn["path taught"]
    assert [list(side) for side in line.getData()] == [[0, 3, 3], [0, 0, 4]]
    plane.across.setCurrentText("Y")  # the other one gives way
    assert plane.shown == "YX"
    assert [list(side) for side in line.getData()] == [[0, 0, 4], [0, 3, 3]]
    plane.show_path("taught", [])
    assert "path taught" not in plane._drawn
