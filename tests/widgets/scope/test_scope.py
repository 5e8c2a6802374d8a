"""The scope by mouse and keys, against a simulated controller over a line at 19 200 baud."""

from __future__ import annotations

import dataclasses as dc
import math
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import shiboken6
from PySide6.QtCore import QEvent, QPoint, QPointF, Qt
from PySide6.QtGui import QGuiApplication, QMouseEvent, QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QComboBox, QFileDialog, QMenu, QWidget

from app.theme import Theme
from codegen.models import MODELS
from codegen.setup import Setup, Unit
from codegen.setup_axis import Axis
from device.capture import Capture, Channel
from device.capture_file import load, save
from device.curves import Derived
from tests.long import record
from tests.stage import Stage, make_studio
from widgets.scope.bar import SPANS, View
from widgets.scope.body import Body

SCALE = 500  # counts per mm
LEFT = Qt.MouseButton.LeftButton
LIVE = ("Position X", "Position Y", "Position error X", "Motor command X")


@pytest.fixture
def stage(qapp: QApplication, tmp_path: Path) -> Iterator[Stage]:
    made = make_studio(tmp_path)
    document = made.studio.session.document
    axis = dc.replace(document.setup.axes[0], unit=Unit.MM, counts_per_unit=str(SCALE))
    setup = dc.replace(document.setup, model="ssc2", axes=(axis,) * 4)
    made.studio.session.set_document(dc.replace(document, setup=setup), "Table")
    made.studio.window.show()
    made.go()
    yield made
    made.clear_away()


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


@pytest.fixture
def body(qapp: QApplication) -> Iterator[Body]:
    """The scope without a studio: for what is seen of a capture."""
    theme = Theme(qapp)
    made = Body()
    axis = Axis(unit=Unit.MM, counts_per_unit=str(SCALE))
    made.show_machine(MODELS["ssc2"], Setup(model="ssc2", axes=(axis,) * 4))
    made.resize(1180, 600)
    made.show()
    qapp.processEvents()
    yield made
    theme.release()
    made.hide()
    shiboken6.delete(made)


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


def drag(widget: QWidget, start: QPoint, end: QPoint) -> None:
    QTest.mouseMove(widget, start)  # a hand is there before it presses
    QTest.qWait(12)
    QTest.mousePress(widget, LEFT, pos=start)
    for part in (0.3, 0.6, 1.0):
        place = QPoint(*(round(a + part * (b - a)) for a, b in zip(start.toTuple(), end.toTuple(), strict=True)))
        event = QMouseEvent(QEvent.Type.MouseMove, QPointF(place), widget.mapToGlobal(QPointF(place)), LEFT, LEFT,
            Qt.KeyboardModifier.NoModifier)  # fmt: skip
        QTest.qWait(12)  # the scene drops moves that follow each other faster than no hand can
        QApplication.sendEvent(widget, event)
    QTest.mouseRelease(widget, LEFT, pos=end)


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


def test_a_move_is_captured_by_keys_and_mouse(stage: Stage) -> None:
    body = scope(stage)
    choose(body.choices.slots[2].what, "Motor command X")
    QTest.mouseClick(body.choices.derived[Derived.VELOCITY], LEFT, pos=QPoint(12, 12))
    choose(body.choices.every, body.choices.every.itemText(1))  # each 4 samples
    enter(body.choices.count, "140")
    choose(body.choices.begin, "Motion begins")
    assert "because Commanded position X is recorded" in body.choices.hint.text()
    click(body.bar.capture)
    stage.until(lambda: body.bar.words.text().startswith("Waiting"))
    stage.go(25)
    stage.rig.controller.ask("PR 4000;BG X")
    stage.until(lambda: "left" in body.bar.words.text())
    partly = False
    while stage.studio.at_machine.scope.job is not None:
        stage.go(1)
        shown = body.shown
        partly |= shown is not None and 0 < shown.count < 140 and not body.empty.isVisible()
    found = finished(stage)
    assert partly and found.complete and found.count == 140 and found.early == 0
    assert [line.label for _, line in body._drawn] == [
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
    assert not body.bar.capture.isEnabled() and "Take Control first" in body.bar.capture.toolTip()
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


@pytest.mark.alone  # drags go by the clock of the scene
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
    QTest.qWait(50)  # the readings of the cursors have taken their room beside the chart

    def at(place: float) -> QPoint:
        return box.mapViewToDevice(QPointF(place, 10.0)).toPoint()

    period = 1 / hertz
    drag(view, at(after[0]), at(period / 4))
    QTest.qWait(50)
    drag(view, at(after[1]), at(period / 4 + 2 * period))
    first, second = body.chart.cursors or [0, 0]
    pixel = (box.viewRange()[0][1] - box.viewRange()[0][0]) / box.width()
    assert first == pytest.approx(period / 4, abs=2 * pixel)
    assert second == pytest.approx(2.25 * period, abs=2 * pixel)
    top = float(body.readings.reading("At A", "Position X").split()[0])
    assert top == pytest.approx(10 + 3 * math.sin(2 * math.pi * hertz * first), abs=3 * 2 * math.pi * hertz * 4 / 1024)
    step = float(body.readings.reading("B − A", "Position Y").split()[0])
    assert abs(step) < 3.0
    assert f"{second - first:.2g}"[:3] in body.between.text() or "ms" in body.between.text()


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
    stage.go()
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
    assert body.bar.words.text().startswith("broken.csv is not a capture: ")


def pick(body: Body, *keys: Qt.Key) -> None:
    """An entry of the menu that is open, by keys."""
    menu = next(each for each in body.findChildren(QMenu) if each.isVisible())
    for key in (*keys, Qt.Key.Key_Return):
        QTest.keyClick(menu, key)


def test_saving_asks_for_a_file_and_writes_it(stage: Stage, tmp_path: Path) -> None:
    body = scope(stage)
    capture, _ = given(body)
    stage.go()
    click(body.bar.save)
    pick(body, Qt.Key.Key_Down)
    dialog = next(each for each in stage.studio.window.findChildren(QFileDialog) if each.isVisible())
    dialog.fileSelected.emit(str(tmp_path / "mine.npz"))
    dialog.close()
    assert np.array_equal(load(tmp_path / "mine.npz").values, capture.values)
    assert body.bar.words.text() == "Saved as mine.npz."
    body.chart.show_range(1.0, 2.0)
    click(body.bar.save)
    pick(body, Qt.Key.Key_Down, Qt.Key.Key_Down)
    dialog = next(each for each in stage.studio.window.findChildren(QFileDialog) if each.isVisible())
    dialog.fileSelected.emit(str(tmp_path / "part.csv"))
    dialog.close()
    part = load(tmp_path / "part.csv")
    assert part.times[0] == pytest.approx(1.0, abs=0.004) and part.times[-1] == pytest.approx(2.0, abs=0.004)
    assert np.array_equal(part.values, capture.values[:, 256:513])  # 1 s to 2 s at 4/1024 s
    stage.studio.at_machine.scope.save(capture, tmp_path / "no folder" / "mine.csv")
    assert body.bar.words.text().startswith("Not saved: mine.csv")


def pictures(body: Body, span: str) -> Iterator[float]:
    """The window's own seconds for each of some pictures of that stretch."""
    body.bar.span.setCurrentText(span)
    for _ in range(4):
        begin = time.thread_time()
        body.roll_on(time.monotonic())
        body.chart.grab()
        yield time.thread_time() - begin
    low, high = body.chart.range
    assert high - low == pytest.approx(SPANS[span], rel=0.02)


@pytest.mark.alone
def test_an_hour_of_live_values_never_blocks_the_window(stage: Stage) -> None:
    """Each new picture, painted: less than 50 ms of the window's own time, from ten seconds to a whole hour."""
    body = scope(stage)
    for slot, label in zip(body.choices.slots, LIVE, strict=True):
        slot.what.setCurrentIndex(slot.what.findText(label))
    click(body.bar.live)
    stage.go(3)
    roll = stage.studio.at_machine.scope.roll
    assert roll is not None and len(roll.tracks) == 4
    t = np.arange(roll.end + 1, 3600, 0.015)
    for track in roll.tracks.values():
        for start in range(0, len(t), 4000):
            part = t[start : start + 4000]
            track.add(part, 500 * np.sin(part) + np.sin(40 * part))
    for _ in range(3):  # again where another process was in the way
        times = [took for span in SPANS for took in pictures(body, span)]
        if max(times) < 0.05:
            break
    record("scope, 4 live channels of an hour: a picture", "pytest tests/widgets/scope", None, 1000 * max(times), "ms")
    assert max(times) < 0.05
    click(body.bar.live)


def test_live_shows_the_channels_as_fast_as_the_line_carries(stage: Stage) -> None:
    body = scope(stage)
    choose(body.choices.slots[2].what, "Motor command X")
    stage.studio.window.hide()
    stage.studio.window.docks["Scope"].show()
    click(body.bar.live)
    stage.go(30)
    stage.rig.controller.ask("PR 20000;BG X")
    stage.until(lambda: not stage.rig.moving)
    stage.go(40)
    roll = stage.studio.at_machine.scope.roll
    assert roll is not None
    counts = {key: track.count / roll.end for key, track in roll.tracks.items()}
    baud = stage.controller.line.baud or 19200
    assert min(counts.values()) > 7 * baud / 19200  # three channels, each in every round
    _, y = body.chart.strips["Position"].items[0].getData()
    assert y[0] == pytest.approx(0, abs=0.01) and y[-1] == pytest.approx(40, abs=0.05)  # 20000 counts
    assert body.chart.range[1] >= roll.end - 0.2
    strip = body.chart.strips["Position"]
    strip.setFocus()
    QTest.keyClick(strip, Qt.Key.Key_Plus)
    near = body.chart.range
    stage.go(20)
    assert body.chart.range == pytest.approx(near)  # the person looks elsewhere
    QTest.keyClick(strip, Qt.Key.Key_Home)
    stage.go(5)
    assert body.chart.range != pytest.approx(near)
    click(body.bar.live)
    stage.go()
    assert stage.studio.at_machine.scope.roll is None and not stage.controller.poller.hurry
    assert "scope" not in stage.controller.poller._wanted
