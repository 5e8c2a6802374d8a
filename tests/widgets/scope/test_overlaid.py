"""What lies over what: one unit a scale, the picture in a file, colours, and what a cursor tells."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QImage
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QFileDialog, QMenu

from codegen.setup import Setup, Unit
from codegen.setup_axis import Axis
from device.capture import Capture, Channel
from device.curves import Derived
from tests.widgets.scope.hands import LEFT, choose, click, given
from widgets.parts.look import look
from widgets.scope.bar import View
from widgets.scope.body import Body

X, Y = Channel("position", "X"), Channel("position", "Y")


def title(body: Body, strip: str) -> str:
    return str(body.chart.strips[strip].getAxis("left").labelText)


def tick(body: Body, row: int) -> None:
    """A capture is laid over by its box."""
    body.side.setCurrentWidget(body.kept)
    QApplication.processEvents()
    place = body.kept.list.visualItemRect(body.kept.list.item(row))
    QTest.mouseClick(body.kept.list.viewport(), LEFT, pos=QPoint(place.left() + 12, place.center().y()))
    if not body.kept.overlaid:  # a style that puts the box elsewhere
        body.kept.list.setCurrentRow(row)
        QTest.keyClick(body.kept.list, Qt.Key.Key_Space)
        body.kept.list.setCurrentRow(0)
    assert len(body.kept.overlaid) == 1


def test_a_capture_of_a_machine_in_inches_gets_a_scale_of_its_own(qapp: QApplication, body: Body) -> None:
    """1000 counts are 2 mm on the one and 0.25 in on the other; a picture of both on one scale would be misread."""
    setup = Setup(model="ssc4", axes=(Axis(unit=Unit.INCH, counts_per_unit="4000"),) * 4)
    other = Capture((X, Y), np.full((2, 50), 1000.0), 2, 1000.0, model="ssc4", when="2026-11-20 07:00:00", setup=setup)
    body.add(other)
    mine, _ = given(body)
    tick(body, 1)
    assert title(body, "Position") == "Position, mm" and title(body, "Position, in") == "Position, in"
    drawn = {name: [item.getData()[1] for item in strip.items] for name, strip in body.chart.strips.items()}
    assert [len(each) for each in drawn.values()] == [2, 2]
    np.testing.assert_allclose(drawn["Position"][0], mine.of(X) / 500)
    np.testing.assert_allclose(drawn["Position, in"][0], 0.25)
    choose(body.bar.views, str(View.PLANE))
    strip = next(iter(body.chart.strips.values()))
    assert strip.getAxis("bottom").labelText == "Position X, mm" and len(strip.items) == 1  # no inches in there


def test_axes_of_different_units_have_strips_of_their_own(qapp: QApplication, body: Body) -> None:
    axes = (Axis(unit=Unit.MM, counts_per_unit="500"), Axis(unit=Unit.DEGREE, counts_per_unit="10"))
    setup = Setup(model="ssc2", axes=(*axes, *axes))
    body.add(Capture((X, Y), np.full((2, 50), 100.0), 2, 1000.0, setup=setup))
    assert [title(body, name) for name in body.chart.strips] == ["Position, mm", "Position, deg"]
    assert [body.readings.reading("Mean", name) for name in ("Position X", "Position Y")] == ["0.2 mm", "10 deg"]


def test_what_lies_between_the_cursors_is_measured(qapp: QApplication, body: Body) -> None:
    """X runs 3 counts an interval (0.006 mm in 1/256 s: 1.536 mm/s), from A at value 20 to B at value 60, both counted.

    41 values in equal steps d around their mean m: rms² = m² + d² (41² - 1)/12.
    """
    n = np.arange(100.0)
    dt, d = 1 / 256, 3 / 500
    body.add(Capture((X,), 3 * n[None, :], 2, 1000.0, setup=body._setup))
    body.choices.derived[Derived.VELOCITY].click()
    body.choices.derived[Derived.ACCELERATION].click()
    body.chart.show_cursors((60 * dt, 20 * dt))  # whichever is first in time
    read = body.readings.reading
    assert [read(row, "Position X") for row in ("At A", "At B", "B − A")] == ["0.36 mm", "0.12 mm", "-0.24 mm"]
    assert [read(row, "Position X") for row in ("Least", "Most", "Mean", "Peak to peak")] == [
        "0.12 mm", "0.36 mm", "0.24 mm", "0.24 mm"
    ]  # fmt: skip
    assert read("RMS", "Position X") == f"{math.sqrt((40 * d) ** 2 + d**2 * (41**2 - 1) / 12):.5g} mm"
    assert read("Rise 10–90 %", "Position X").split()[1] == "ms"
    assert [read(row, "Velocity X") for row in ("At A", "B − A", "RMS")] == ["1.536 mm/s", "0 mm/s", "1.536 mm/s"]
    assert read("Most", "Acceleration X") == "0 mm/s²" and read("Frequency", "Position X") == "–"
    assert body.between.text().replace("\xa0", " ") == "A 234.38 ms   B 78.125 ms   B − A -156.25 ms   1/(B − A) 6.4 Hz"
    body.chart.show_cursors((0.0, 99 * dt))
    assert [read(row, "Velocity X") for row in ("At A", "At B")] == ["1.536 mm/s"] * 2  # ends of a straight line too
    body.chart.show_cursors((-dt, 99.5 * dt))
    assert [read(row, "Position X") for row in ("At A", "At B", "B − A")] == ["–"] * 3  # nothing was captured there


def test_the_picture_goes_into_a_file_and_colours_are_chosen(qapp: QApplication, body: Body, tmp_path: Path) -> None:
    given(body)
    slot = body.choices.slots[0]
    click(slot.pen)
    menu = next(each for each in slot.findChildren(QMenu) if each.isVisible())
    words = [action.text() for action in menu.actions()]
    for _ in range(words.index("Purple") + 1):
        QTest.keyClick(menu, Qt.Key.Key_Down)
    QTest.keyClick(menu, Qt.Key.Key_Return)
    qapp.processEvents()
    colour = look().colour("axis_w")
    assert body.picture is not None and body.picture.lines[0].colour.name() == colour.name()
    click(body.bar.picture)
    dialog = next(each for each in body.window().findChildren(QFileDialog) if each.isVisible())
    dialog.fileSelected.emit(str(tmp_path / "scope.png"))
    dialog.close()
    found = QImage(str(tmp_path / "scope.png"))
    assert found.size() == body.chart.grab().size()
    small = found.scaled(found.width() // 2, found.height() // 2)
    near = [small.pixelColor(x, y) for x in range(small.width()) for y in range(0, small.height(), 2)]
    assert any(abs(each.red() - colour.red()) + abs(each.blue() - colour.blue()) < 60 for each in near)


def test_many_values_are_drawn_as_far_as_a_picture_shows_them(qapp: QApplication, body: Body) -> None:
    """All of their peaks from afar, every one of them from near; the whole of them whenever everything is shown."""
    times, values = np.arange(50_000) * 0.07, np.zeros((1, 50_000))
    values[0, 12_345] = 1000.0
    body.add(Capture((X,), values, 1, 1000.0, trigger_text="live", moments=times, setup=body._setup))
    item = body.chart.strips["Position"].items[0]
    x, y = item.getData()
    assert len(x) < 2100 and (x[0], x[-1]) == (times[0], times[-1]) and y.max() == 2.0
    body.chart.show_range(times[12_340], times[12_350])
    qapp.processEvents()
    x, y = item.getData()
    np.testing.assert_array_equal(x, times[12_339:12_352])  # one beyond at either side
    assert y[6] == 2.0 and body.chart.strips["Position"].viewRange()[1][1] > 2.0
    click(body.bar.fit)
    qapp.processEvents()
    low, high = body.chart.range
    assert low <= times[0] and high >= times[-1] and item.getData()[0][-1] == times[-1]
    body.add(
        Capture((X, Y), np.stack([np.cos(times), np.sin(times)]) * 500, 1, 1000.0, moments=times, setup=body._setup)
    )
    choose(body.bar.views, str(View.PLANE))
    x, y = next(iter(body.chart.strips.values())).items[0].getData()
    assert 5000 < len(x) <= 10_000
    np.testing.assert_allclose(np.hypot(x, y), 1.0)
