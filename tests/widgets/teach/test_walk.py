"""The joystick teach of the manual from end to end (ssc-tol-o-motion.txt l.2759-2802), by mouse, keys and the stick."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import pytest
from PySide6.QtCore import QEvent, QPointF, Qt
from PySide6.QtGui import QMouseEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QFileDialog, QLineEdit, QWidget

from codegen.bows import Point, distance_to_line
from codegen.teach import COLUMNS
from codegen.teach_steps import drawn
from tests.widgets.teach.bench import ALONE, LEFT, Bench
from widgets.parts.question import Question
from widgets.parts.stick import Stick
from widgets.teach.entries import Entry, OutputEntry, WaitEntry
from widgets.teach.panel import SCREEN

FULL = 20_000  # counts/s: 20 mm/s
PACE = {"speed": "20", "acceleration": "512", "deceleration": "512"}


@pytest.fixture
def bench(qapp: QApplication, tmp_path: Path) -> Iterator[Bench]:
    made = Bench(tmp_path)
    yield made
    made.stage.clear_away()


def speed(bench: Bench) -> tuple[float, float]:
    """Commanded, counts/s of X and Y, once the ramp is over."""
    bench.stage.go(18)
    before, began = bench.places, bench.stage.clock.now
    bench.stage.go(9)
    took = bench.stage.clock.now - began
    return tuple((after - first) / took for after, first in zip(bench.places, before, strict=True))  # type: ignore[return-value]


def opened(bench: Bench, kind: type[Entry], button: QWidget) -> Entry:
    QTest.mouseClick(button, LEFT)
    bench.stage.go(2)
    found = next(each for each in bench.panel.findChildren(kind) if each.isVisible())
    assert isinstance(found, Entry)
    return found


@pytest.mark.skipif(ALONE, reason="the axis that is pushed further goes alone at 9600 baud")
def test_from_enable_to_done_with_waits_and_outputs_in_between(bench: Bench) -> None:
    """Enable once, then one after the other: the stick drives on while the small windows are open."""
    bench.connect()
    bench.fill(bench.parts.of_stick, "dead", "30")
    bench.fill(bench.parts.of_stick, "full", "20")
    bench.enable()
    bench.push(0.28, 0)
    bench.stage.go(10)
    assert bench.places == (0, 0)  # within the dead band
    bench.push(1, 0)
    assert speed(bench) == (pytest.approx(FULL, rel=0.02), 0)
    bench.push(0, -0.65)  # half of what is left behind the dead band: (0.65 - 0.3) / 0.7
    assert speed(bench) == (pytest.approx(0, abs=20), pytest.approx(-FULL / 2, rel=0.02))
    bench.push(0, 0)
    bench.still()
    bench.click(bench.parts.record)
    bench.stage.until(lambda: len(bench.rows) == 1)
    wait = opened(bench, WaitEntry, bench.parts.wait)
    bench.push(-1, 0)
    bench.stage.go(12)
    assert bench.moving and bench.panel.enabled  # its window is open, and the stick drives
    bench.push(0, 0)
    assert isinstance(wait, WaitEntry)
    for box, down in ((wait.input, 2), (wait.level, 1)):
        box.setFocus()
        for _ in range(down):
            QTest.keyClick(box, Qt.Key.Key_Down)
    QTest.keyClick(wait, Qt.Key.Key_Return)
    for multiple in (False, True):
        output = opened(bench, OutputEntry, bench.parts.output)
        assert isinstance(output, OutputEntry)
        button = output.multiple if multiple else output.single
        button.setFocus()
        QTest.keyClick(button, Qt.Key.Key_Space)
        if multiple:
            output.byte.setFocus()
            output.byte.selectAll()
            QTest.keyClicks(output.byte, "255")
        else:
            output.output.setFocus()
            QTest.keyClick(output.output, Qt.Key.Key_End)
            output.level.setFocus()
            QTest.keyClick(output.level, Qt.Key.Key_Down)
        QTest.mouseClick(output.add, LEFT)
        bench.stage.go(2)
    assert bench.panel.enabled, bench.panel.words()
    bench.still()
    bench.click(bench.parts.done)
    assert not bench.panel.enabled and bench.panel.words() == "Done: 4 rows."
    x, y = (float(bench.rows[0][each]) * 1000 for each in "xy")
    assert y == bench.places[1] and x > bench.places[0]  # recorded before the last drive
    assert bench.rows[1:] == ({"wait": "-3"}, {"output": "-8"}, {"output": "0xFF"})
    by_the_stick_on_the_screen(bench)


def by_the_stick_on_the_screen(bench: Bench) -> None:
    """Held by the mouse: it drives while it is held, and no longer."""
    bench.parts.source.setCurrentIndex(bench.parts.source.findData(SCREEN))
    bench.enable()
    stick, before = bench.parts.stick, bench.places
    middle = stick.rect().center()
    QTest.mousePress(stick, LEFT, pos=middle)
    move(stick, QPointF(middle.x() + stick.width(), middle.y()))
    across, upward = speed(bench)
    assert across == pytest.approx(FULL, rel=0.02) and abs(upward) < 0.02 * FULL
    move(stick, QPointF(middle.x(), middle.y() - stick.height()))
    assert speed(bench)[1] == pytest.approx(FULL, rel=0.02)
    QTest.mouseRelease(stick, LEFT, pos=middle)
    bench.still()
    place = bench.places
    bench.stage.go(10)
    assert bench.places == place and place[0] > before[0] and place[1] > before[1]


def move(stick: Stick, place: QPointF) -> None:
    event = QMouseEvent(QEvent.Type.MouseMove, place, stick.mapToGlobal(place), Qt.MouseButton.NoButton, LEFT,
        Qt.KeyboardModifier.NoModifier)  # fmt: skip
    QApplication.sendEvent(stick, event)


def file_named(bench: Bench, path: Path) -> None:
    """The file window that is open gets a name by keys."""
    dialog = next(each for each in bench.stage.studio.window.findChildren(QFileDialog) if each.isVisible())
    line = dialog.findChild(QLineEdit)
    assert line is not None
    line.setText(str(path))
    QTest.keyClick(line, Qt.Key.Key_Return)
    bench.stage.go(3)


def test_a_table_typed_by_hand_goes_through_files_into_a_program(bench: Bench, tmp_path: Path) -> None:
    """Every form of value by keys; saved, opened, saved as a module and imported by their menus and windows."""
    typed = ({"x": "1.5", "y": "-2", **PACE}, {"wait": "8"}, {"wait": "-8"}, {"output": "1"}, {"output": "-1"},
        {"output": "0x00"}, {"output": "0xFF"}, {"x": "3", "y": "4", **PACE})  # fmt: skip
    for button in [*bench.parts.edits.values(), *bench.parts.files.values()]:
        does = button in (bench.parts.edits["insert"], bench.parts.files["open"])
        assert button.isEnabled() == does and (does or button.toolTip().endswith("."))  # why not
    for _ in typed:
        QTest.mouseClick(bench.parts.edits["insert"], LEFT)
    for number, row in enumerate(typed):
        for column, text in row.items():
            bench.typed(number, COLUMNS.index(column), text)
    bench.typed(1, COLUMNS.index("wait"), "9")
    assert "write 1 to 8, or -1 to -8" in bench.parts.message.text()
    bench.typed(5, COLUMNS.index("output"), "0x100")
    assert bench.rows == typed and bench.panel.wrong == ()
    model = bench.parts.model
    assert [model.data(model.index(1, place)) for place in range(7)] == ["x", "x", "x", "x", "x", "8", "x"]
    bench.parts.view.go_to(6, 0)
    QTest.mouseClick(bench.parts.edits["delete"], LEFT)
    assert bench.rows == (*typed[:6], typed[7])
    QTest.mouseClick(bench.parts.edits["undo"], LEFT)
    assert bench.rows == typed
    plane = bench.stage.studio.at_machine.plane
    assert plane._paths["Teach"] == ((1.5, -2.0), (3.0, 4.0))

    QTest.mouseClick(bench.parts.files["save"], LEFT)
    file_named(bench, tmp_path / "mine")
    assert bench.panel.result.text() == "Saved mine.tlt: 8 rows." and (tmp_path / "mine.tlt").is_file()
    QTest.mouseClick(bench.parts.files["new"], LEFT)
    bench.stage.go(2)
    assert bench.rows == () and "Teach" not in plane._paths
    QTest.mouseClick(bench.parts.files["open"], LEFT)
    file_named(bench, tmp_path / "mine.tlt")
    assert bench.rows == typed
    spoiled = (tmp_path / "mine.tlt").read_text(encoding="utf-8").replace("Pos X\tPos Y", "Pos Y\tPos X")
    (tmp_path / "spoiled.tlt").write_text(spoiled, encoding="utf-8")
    QTest.mouseClick(bench.parts.files["open"], LEFT)
    file_named(bench, tmp_path / "spoiled.tlt")
    told = [each for each in bench.stage.studio.window.findChildren(Question) if each.isVisible()][-1]
    assert told.words == "spoiled.tlt: line 2 does not name the columns of a teach table."
    told.close()
    assert bench.rows == typed

    QTest.mouseClick(bench.parts.files["module"], LEFT)
    file_named(bench, tmp_path / "taught")
    assert bench.panel.result.text().startswith("Saved taught.tlp: ")
    before = len(bench.stage.studio.session.document.program.main)
    bench.stage.studio.actions["import_module"].trigger()
    bench.stage.go(1)
    file_named(bench, tmp_path / "taught.tlp")
    assert len(bench.stage.studio.session.document.program.main) > before
    assert bench.stage.studio.messages.texts()[-1].startswith("Imported from taught.tlp: ")


def near(path: list[Point], place: Point) -> float:
    return min(distance_to_line(place, *line) for line in pairwise(path))


@pytest.mark.skipif(ALONE, reason="the axis that is pushed further goes alone at 9600 baud")
def test_a_round_way_by_hand_becomes_arcs_that_are_played_back_near_it(bench: Bench) -> None:
    """Two thirds of a circle at 5 mm/s in 4 s, radius some 5 mm; every place of the hand's and of the play-back's
    way lies by the table's line as near as tolerance and the way between two readings allow."""
    tolerance = 0.2
    bench.connect()
    bench.fill(bench.parts.of_stick, "full", "5")
    bench.fill(bench.parts.of_rows, "tolerance", f"{tolerance:g}")
    bench.fill(bench.parts.of_rows, "speed", "20")
    bench.fill(bench.parts.of_rows, "acceleration", "512")
    bench.fill(bench.parts.of_rows, "deceleration", "512")
    bench.enable()
    bench.click(bench.parts.way)
    bench.stage.go(20)
    driven: list[Point] = []
    for tick in range(120):
        angle = math.radians(240 * tick / 120)
        bench.push(math.cos(angle), math.sin(angle))
        bench.stage.go(1)
        driven.append((bench.places[0] / 1000, bench.places[1] / 1000))
    bench.push(0, 0)
    while bench.moving:
        bench.stage.go(1)
        driven.append((bench.places[0] / 1000, bench.places[1] / 1000))
    bench.still()
    bench.click(bench.parts.way)
    bench.stage.until(lambda: "readings became" in bench.panel.words())
    bench.click(bench.parts.done)
    rows = bench.rows
    assert any("sweep" in row for row in rows) and len(rows) <= 8, rows
    teach = bench.stage.studio.at_machine.teach
    path = drawn(teach.table, teach.setup)
    assert max(near(path, place) for place in driven) < 2 * tolerance
    assert max(near(driven, place) for place in path) < 2 * tolerance
    bench.click(bench.parts.play)
    bench.stage.go(10)
    bench.answer("Play back?", "Play back")
    bench.stage.until(lambda: math.dist(bench.places, (path[0][0] * 1000, path[0][1] * 1000)) <= 1)
    played: list[Point] = []
    while bench.panel.words() != "Played back.":
        bench.stage.go(1)
        played.append((bench.places[0] / 1000, bench.places[1] / 1000))
        assert len(played) < 2000, bench.panel.words()
    assert max(near(path, place) for place in played) < 0.02  # chords of the drawn arcs, and slack of an arc's end
    assert math.dist(played[-1], path[-1]) <= 0.001
