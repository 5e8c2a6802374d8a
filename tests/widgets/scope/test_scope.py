"""The scope by mouse and keys, against a simulated controller over a line at 19 200 baud."""

from __future__ import annotations

import dataclasses as dc
import math
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QGuiApplication, QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QFileDialog

from device.capture_file import load, save
from device.curves import Derived
from tests.stage import Stage
from tests.widgets.scope.hands import LEFT, SCALE, choose, click, drag, enter, finished, given, pick, scope, settled
from widgets.scope.bar import View
from widgets.scope.body import Body


def test_a_move_is_captured_by_keys_and_mouse(stage: Stage) -> None:
    body = scope(stage)
    choose(body.choices.slots[2].what, "Motor command X")
    QTest.mouseClick(body.choices.derived[Derived.VELOCITY], LEFT, pos=QPoint(12, 12))
    choose(body.choices.every, body.choices.every.itemText(2))  # each 8 samples
    enter(body.choices.count, "70")
    choose(body.choices.begin, "Motion begins")
    assert "because Commanded position X is recorded" in body.choices.hint.text()
    click(body.bar.capture)
    stage.until(lambda: body.bar.words.text().startswith("Waiting:"))
    stage.go(25)
    stage.rig.controller.ask("PR 4000;BG X")
    stage.until(lambda: "left" in body.bar.words.text())
    partly = False
    while stage.studio.at_machine.scope.job is not None:
        stage.go(1)
        shown = body.shown
        partly |= shown is not None and 0 < shown.count < 70 and not body.empty.isVisible()
    found = finished(stage)
    assert partly and found.complete and found.count == 70 and found.early == 0
    assert body.picture is not None and [line.label for line in body.picture.lines] == [
        "Position X", "Commanded position X", "Motor command X", "Velocity X",
    ]  # fmt: skip
    x, y = body.chart.strips["Position"].items[1].getData()
    assert y[0] == 0 and y[-1] == pytest.approx(4000 / SCALE)  # 8 mm were commanded
    assert y[x < 0].max() == 0 < y[x == 0][0]  # 0 is the first value that moves
    # SP 40000 is never reached: AC 512000 over half of 4000 counts gives sqrt(512000·4000) = 45255, so it is: 80 mm/s
    assert float(body.readings.reading("Most", "Velocity X").split()[0]) == pytest.approx(80, rel=0.35)
    assert stage.rig.simulation.state()["arrays"] == {}


def test_why_a_capture_can_not_begin_is_told(stage: Stage) -> None:
    body = scope(stage, "machine")
    assert body.bar.capture.isEnabled()
    stage.controller.release_control()
    stage.go()
    assert not body.bar.capture.isEnabled() and "switch to Control first" in body.bar.capture.toolTip()
    stage.controller.take_control()
    choose(body.choices.begin, "Level")
    enter(body.choices.level, "12,5")
    stage.go()
    assert not body.bar.capture.isEnabled() and "12.5" in body.choices.hint.text()
    enter(body.choices.level, "12.5")
    stage.go()
    assert body.bar.capture.isEnabled()
    assert body.choices.trigger.level == 12.5 * SCALE  # typed in mm, waited for in counts
    for slot in body.choices.slots:
        choose(slot.what, "–")
    stage.go()
    assert body.choices.hint.text() == "Choose at least one channel."


def test_a_141x_offers_two_channels(stage: Stage) -> None:
    body = scope(stage, model="dmc1412")
    assert [slot.isVisible() for slot in body.choices.slots] == [True, True, False, False]
    assert body.choices.count.maximum() == 500  # 1000 elements (dmc-1412-1414.txt l.3325) for two
    enter(body.choices.count, "10")
    click(body.bar.capture)
    assert finished(stage).complete


def test_cancel_and_stop_keep_a_part(stage: Stage) -> None:
    body = scope(stage)
    choose(body.choices.every, body.choices.every.itemText(5))  # each 64 samples, 62.5 ms
    click(body.bar.capture)
    stage.until(lambda: body.shown is not None and body.shown.count > 8)
    click(body.bar.finish)
    first = finished(stage)
    assert 8 < first.count < 60 and not first.complete
    click(body.bar.capture)
    stage.until(lambda: body.shown is not first and body.shown is not None and body.shown.count > 5)
    click(body.bar.cancel)
    second = finished(stage)
    assert 5 < second.count < 60
    assert body.kept.list.count() == 2 and "(part)" in body.kept.list.item(0).text()
    assert stage.rig.simulation.state()["arrays"] == {}


def test_readings_and_cursors_tell_what_mathematics_tells(qapp: QApplication, body: Body) -> None:
    _, hertz = given(body)
    qapp.processEvents()
    assert body.readings.reading("Mean", "Position X") == "10 mm"
    assert body.readings.reading("Peak to peak", "Position X") == "6 mm"
    assert float(body.readings.reading("RMS", "Position X").split()[0]) == pytest.approx(math.sqrt(104.5), rel=1e-4)
    assert float(body.readings.reading("Frequency", "Position X").split()[0]) == pytest.approx(hertz, rel=1e-3)
    click(body.bar.cursors)
    strip = body.chart.strips["Position"]
    strip.setFocus()
    for _ in range(12):
        QTest.keyClick(strip, Qt.Key.Key_Right, Qt.KeyboardModifier.ControlModifier)
    QTest.keyClick(strip, Qt.Key.Key_B)
    before = list(body.chart.cursors or [])
    QTest.keyClick(strip, Qt.Key.Key_Left, Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier)
    after = list(body.chart.cursors or [])
    assert after[0] == before[0] and after[1] - before[1] == pytest.approx(-10 * 4 / 1024)
    box = strip.getViewBox()
    view = strip.viewport()
    settled(body.chart)  # the readings of the cursors have taken their room beside the chart

    def at(place: float) -> QPoint:
        return box.mapViewToDevice(QPointF(place, 10.0)).toPoint()

    period = 1 / hertz
    drag(view, at(after[0]), at(period / 4))
    settled(body.chart)
    drag(view, at(after[1]), at(period / 4 + 2 * period))
    first, second = body.chart.cursors or [0, 0]
    pixel = (box.viewRange()[0][1] - box.viewRange()[0][0]) / box.width()
    assert first == pytest.approx(period / 4, abs=2 * pixel)
    assert second == pytest.approx(2.25 * period, abs=2 * pixel)
    top = float(body.readings.reading("At A", "Position X").split()[0])
    assert top == pytest.approx(10 + 3 * math.sin(2 * math.pi * hertz * first), abs=3 * 2 * math.pi * hertz * 4 / 1024)
    step = float(body.readings.reading("B − A", "Position Y").split()[0])
    values = 10 + 3 * np.cos(2 * math.pi * hertz * np.array([first, second]))
    assert step == pytest.approx(float(values[1] - values[0]), abs=2 * 3 * 2 * math.pi * hertz * 2 / 1024)
    assert f"B − A {(second - first) * 1000:.5g} ms" in body.between.text().replace("\xa0", " ")
    assert f"1/(B − A) {1 / (second - first):.5g} Hz" in body.between.text().replace("\xa0", " ")


def test_the_spectrum_has_the_right_height_and_names_its_window(qapp: QApplication, body: Body) -> None:
    _, hertz = given(body)
    choose(body.bar.views, str(View.SPECTRUM))
    qapp.processEvents()
    for window in ("Hann", "Flat top", "None (rectangular)"):
        choose(body.bar.windows, window)
        qapp.processEvents()
        height, rest = body.readings.reading("Highest line", "Position X").split(" mm at ")
        assert float(height) == pytest.approx(3.0, rel=1e-3)
        assert float(rest.split()[0]) == pytest.approx(hertz, rel=1e-3)
        assert f"window: {window}" in body.chart.strips["Position"].getAxis("bottom").labelText
    choose(body.bar.views, str(View.PLANE))
    qapp.processEvents()
    x, y = next(iter(body.chart.strips.values())).items[0].getData()
    np.testing.assert_allclose(np.hypot(x - 10, y - 10), 3.0, rtol=1e-9)  # sine over cosine is a circle


def test_wheel_drag_double_click_and_copy(qapp: QApplication, body: Body) -> None:
    given(body)
    body.choices.derived[Derived.VELOCITY].click()
    qapp.processEvents()
    upper, lower = body.chart.strips.values()
    whole = upper.viewRange()[0]
    view = upper.viewport()
    middle = view.rect().center()
    wheel = QWheelEvent(QPointF(middle), view.mapToGlobal(QPointF(middle)), QPoint(), QPoint(0, 240),
        Qt.MouseButton.NoButton, Qt.KeyboardModifier.NoModifier, Qt.ScrollPhase.NoScrollPhase, False)  # fmt: skip
    QApplication.sendEvent(view, wheel)
    qapp.processEvents()
    near = upper.viewRange()[0]
    assert near[1] - near[0] < 0.9 * (whole[1] - whole[0])
    assert lower.viewRange()[0] == pytest.approx(near, rel=0.02, abs=0.02)  # one time for all strips
    settled(body.chart)
    drag(view, middle, middle + QPoint(60, 0))
    assert upper.viewRange()[0][0] < near[0]
    QTest.mouseDClick(view, LEFT, pos=middle)
    qapp.processEvents()
    assert upper.viewRange()[0] == pytest.approx(whole, rel=0.05, abs=0.05)
    upper.setFocus()
    QTest.keyClick(upper, Qt.Key.Key_C, Qt.KeyboardModifier.ControlModifier)
    assert QGuiApplication.clipboard().pixmap().size() == body.chart.grab().size()  # all strips


def test_an_earlier_capture_is_opened_and_laid_over(stage: Stage, tmp_path: Path) -> None:
    body = scope(stage)
    enter(body.choices.count, "20")
    click(body.bar.capture)
    mine = finished(stage)
    kept = stage.studio.at_machine.scope._folder
    assert [load(path).count for path in kept.glob("*.npz")] == [20]
    other = dc.replace(mine, values=mine.values + 50, when="2026-11-20 07:00:00")
    save(tmp_path / "before.csv", other)
    click(body.bar.open)
    dialog = next(each for each in stage.studio.window.findChildren(QFileDialog) if each.isVisible())
    dialog.fileSelected.emit(str(tmp_path / "before.csv"))
    dialog.close()
    stage.until(lambda: body.bar.words.text() == "before.csv: 20 values a channel.")
    assert body.shown is not None and np.array_equal(body.shown.values, other.values)
    body.side.setCurrentWidget(body.kept)
    stage.go()
    first = body.kept.list.visualItemRect(body.kept.list.item(1))
    QTest.mouseClick(body.kept.list.viewport(), LEFT, pos=first.topLeft() + QPoint(12, first.height() // 2))
    body.kept.list.setFocus()
    body.kept.list.setCurrentRow(1)
    QTest.keyClick(body.kept.list, Qt.Key.Key_Up)
    if not body.kept.overlaid:
        body.kept.list.setCurrentRow(1)
        QTest.keyClick(body.kept.list, Qt.Key.Key_Space)
        QTest.keyClick(body.kept.list, Qt.Key.Key_Up)
    stage.go()
    assert len(body.kept.overlaid) == 1 and body.shown is not body.kept.overlaid[0]
    lines = [item.getData()[1] for item in body.chart.strips["Position"].items]
    np.testing.assert_allclose(lines[0] - lines[2], 50 / SCALE)
    (tmp_path / "broken.csv").write_text("1;2;3", encoding="utf-8")
    stage.studio.at_machine.scope.open(tmp_path / "broken.csv")
    stage.until(lambda: body.bar.words.text().startswith("broken.csv is not a capture: "))


def test_saving_asks_for_a_file_and_writes_it(stage: Stage, tmp_path: Path) -> None:
    body = scope(stage)
    capture, _ = given(body)
    stage.go()
    click(body.bar.save)
    pick(body, Qt.Key.Key_Down)
    dialog = next(each for each in stage.studio.window.findChildren(QFileDialog) if each.isVisible())
    dialog.fileSelected.emit(str(tmp_path / "mine.npz"))
    dialog.close()
    stage.until(lambda: body.bar.words.text() == "Saved as mine.npz.")
    assert np.array_equal(load(tmp_path / "mine.npz").values, capture.values)
    body.chart.show_range(1.0, 2.0)
    click(body.bar.save)
    pick(body, Qt.Key.Key_Down, Qt.Key.Key_Down)
    dialog = next(each for each in stage.studio.window.findChildren(QFileDialog) if each.isVisible())
    dialog.fileSelected.emit(str(tmp_path / "part.csv"))
    dialog.close()
    stage.until(lambda: body.bar.words.text() == "Saved as part.csv.")
    part = load(tmp_path / "part.csv")
    assert part.times[0] == pytest.approx(1.0, abs=0.004) and part.times[-1] == pytest.approx(2.0, abs=0.004)
    assert np.array_equal(part.values, capture.values[:, 256:513])  # 1 s to 2 s at 4/1024 s
    stage.studio.at_machine.scope.save(capture, tmp_path / "no folder" / "mine.csv")
    stage.until(lambda: body.bar.words.text().startswith("Not saved: mine.csv"))
