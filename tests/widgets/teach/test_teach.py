"""Teaching by mouse and keys against a simulated table over its byte stream at 19 200 baud."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from codegen.teach import Row, Table
from tests.widgets.teach.bench import LEFT, Bench
from widgets.teach.entries import OutputEntry, WaitEntry
from widgets.teach.panel import OFFLINE, SCREEN, WATCHED

PACE = {"speed": "20", "acceleration": "512", "deceleration": "512"}


@pytest.fixture
def bench(qapp: QApplication, tmp_path: Path) -> Iterator[Bench]:
    made = Bench(tmp_path)
    yield made
    made.stage.clear_away()


def test_the_joystick_drives_in_its_direction_and_its_buttons_record_and_end(bench: Bench) -> None:
    bench.connect().enable()
    bench.push(1, -0.5)
    bench.stage.go(60)
    assert bench.moving and bench.places[0] > 2000 and -bench.places[0] * 0.7 < bench.places[1] < -bench.places[0] * 0.2
    bench.push(0, 0)
    bench.still()
    bench.press(7)
    bench.stage.until(lambda: len(bench.rows) == 1)
    x, y = bench.places
    assert bench.rows[0]["x"] == f"{x / 1000:g}" and bench.rows[0]["y"] == f"{y / 1000:g}"
    bench.press(8)
    assert not bench.panel.enabled and bench.panel.words() == "Done: 1 rows."


def test_a_press_while_the_axes_move_is_recorded_when_they_stand(bench: Bench) -> None:
    bench.connect().enable()
    bench.push(0, 1)
    bench.stage.go(40)
    QTest.mouseClick(bench.parts.record, LEFT)
    bench.stage.go(5)
    assert bench.rows == ()
    bench.push(0, 0)
    bench.still()
    bench.stage.until(lambda: len(bench.rows) == 1)
    assert bench.rows[0]["y"] == f"{bench.places[1] / 1000:g}"


def test_it_does_not_drive_before_the_stick_stood_in_its_middle(bench: Bench) -> None:
    """A joystick that is not plugged in reads 0 V: fully pushed."""
    bench.connect()
    bench.push(-1, -1)
    bench.stage.go(10)
    bench.enable()
    bench.stage.go(30)
    assert not bench.moving and bench.places == (0, 0)
    bench.push(0, 0)
    bench.stage.go(10)
    bench.push(-1, 0)
    bench.stage.go(20)
    assert bench.moving


@pytest.mark.parametrize("how", ["stop", "watch", "focus", "hidden", "cable", "let go"])
def test_whatever_ends_driving_stops_both_axes(bench: Bench, how: str) -> None:
    bench.connect().enable()
    bench.push(1, 1)
    bench.stage.go(40)
    assert bench.moving
    if how == "stop":
        bench.stage.studio.connection.stop()
    elif how == "watch":
        bench.stage.controller.release_control()
    elif how == "focus":
        bench.stage.studio.program.tree.setFocus()
    elif how == "hidden":
        bench.stage.studio.desk.bring("Display")
    elif how == "cable":
        bench.stage.rig.cut()
    else:
        bench.push(0, 0)
    bench.stage.go(60)
    assert not bench.moving
    if how != "let go":
        assert not bench.panel.enabled
    if how == "cable":
        return
    place = bench.places
    bench.push(0, 0)
    bench.stage.go(10)
    bench.push(1, 1)
    bench.stage.go(20)
    assert (bench.places == place) == (how != "let go")


def test_the_stick_on_the_screen_drives_too(bench: Bench) -> None:
    bench.connect()
    bench.parts.source.setCurrentIndex(bench.parts.source.findData(SCREEN))
    bench.enable()
    stick = bench.parts.stick
    stick.setFocus()
    QTest.keyPress(stick, Qt.Key.Key_Right)
    bench.stage.go(40)
    assert bench.moving and bench.places[0] > 500 and bench.places[1] == 0
    QTest.keyRelease(stick, Qt.Key.Key_Right)
    bench.still()


def test_waits_and_outputs_are_added_by_their_windows(bench: Bench) -> None:
    bench.connect()
    QTest.mouseClick(bench.parts.wait, LEFT)
    wait = bench.panel.findChild(WaitEntry)
    wait.input.setCurrentIndex(2)
    wait.level.setCurrentIndex(1)
    wait.add.click()
    for multiple in (False, True):
        QTest.mouseClick(bench.parts.io_control, LEFT)
        bench.stage.go(2)
        QTest.mouseClick(bench.parts.output, LEFT)
        output = next(each for each in bench.panel.findChildren(OutputEntry) if each.isVisible())
        (output.multiple if multiple else output.single).setChecked(True)
        output.output.setCurrentIndex(3)
        output.byte.setValue(0x21)
        output.add.click()
        bench.stage.go(10)
        assert bench.outputs == 8  # the second time I/O control is off again: nothing is switched
    assert bench.rows == ({"wait": "-3"}, {"output": "4"}, {"output": "0x21"})


def test_the_table_is_edited_by_keys(bench: Bench) -> None:
    rows = (Row(x="1", y="2", **PACE), Row(wait="3"))
    bench.stage.studio.at_machine.teach.change(Table(("mm", "mm"), rows))
    bench.typed(0, 0, "7.25")
    assert bench.rows[0]["x"] == "7.25"
    bench.typed(0, 1, "12,5")
    assert bench.rows[0]["y"] == "2" and "write 12.5" in bench.parts.message.text()
    bench.typed(1, 5, "x")
    assert bench.rows[1] == {}
    view = bench.parts.view
    view.go_to(1, 0)
    QTest.keyClick(view, Qt.Key.Key_Insert)
    assert len(bench.rows) == 3
    QTest.keyClick(view, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    assert len(bench.rows) == 2
    QTest.keyClick(view, Qt.Key.Key_Minus, Qt.KeyboardModifier.ControlModifier)
    assert bench.rows == ({"x": "7.25", "y": "2", **PACE},)
    view.go_to(0, 2)
    bench.parts.of_rows.fields["speed"].setFocus()
    bench.parts.of_rows.fields["speed"].selectAll()
    QTest.keyClicks(bench.parts.of_rows.fields["speed"], "33")
    bench.click(bench.parts.edits["pace"])
    assert bench.rows[0]["speed"] == "33"
    bench.parts.of_rows.fields["speed"].selectAll()
    QTest.keyClick(bench.parts.of_rows.fields["speed"], Qt.Key.Key_Delete)
    assert "Speed is missing" in bench.parts.of_rows.message.text() == f"{bench.panel.problem}."


def test_play_back_says_where_it_goes_asks_and_steps(bench: Bench) -> None:
    rows = (Row(x="8", y="4", **PACE), Row(x="10", y="4", output="2", **PACE), Row(x="10", y="6", **PACE))
    bench.connect()
    bench.stage.studio.at_machine.teach.change(Table(("mm", "mm"), rows))
    bench.parts.how.setCurrentIndex(1)
    bench.click(bench.parts.play)
    assert "Switch I/O control on" in bench.panel.words()
    bench.click(bench.parts.io_control)
    bench.click(bench.parts.play)
    bench.stage.go(10)
    bench.answer("Play back?", "Play back")
    for words in (
        "at 1.25 mm/s",
        "row 1",
        "X from 0 mm to 8 mm",
        "Y from 0 mm to 4 mm",
        "not seen homed",
        "outputs: 2",
    ):
        assert words in bench.question, bench.question  # a quarter of the full speed of 5 mm/s
    for expected in ((8000, 4000), (10_000, 4000), (10_000, 6000)):
        bench.stage.until(lambda: bench.parts.next.isEnabled())
        bench.click(bench.parts.next)
        bench.stage.until(lambda expected=expected: bench.places == expected)
    bench.stage.until(lambda: bench.panel.words() == "Played back.")
    assert bench.outputs == 2 and not bench.parts.halt.isEnabled()


def test_stop_ends_play_back_and_a_row_beyond_a_limit_is_named(bench: Bench) -> None:
    bench.connect()
    bench.stage.rig.type("FL 50000")
    rows = (Row(x="1", y="1", **PACE), Row(x="60", y="1", **PACE))
    teach = bench.stage.studio.at_machine.teach
    teach.change(Table(("mm", "mm"), rows))
    bench.click(bench.parts.play)
    bench.stage.go(10)
    assert bench.panel.words() == "Not played back. Row 2: 60 mm lies beyond the forward limit of X, 50 mm."
    bench.typed(1, 0, "45")
    bench.click(bench.parts.play)
    bench.stage.go(10)
    bench.answer("Play back?", "Play back")
    bench.stage.until(lambda: bench.places[0] > 3000)
    bench.click(bench.parts.halt)
    bench.still()
    assert "stopped in row 2" in bench.panel.words() and bench.places[0] < 45_000


def test_offline_and_watch_say_why_nothing_drives(bench: Bench) -> None:
    assert bench.panel.words() == OFFLINE and not bench.parts.enable.isEnabled()
    bench.connect("machine")
    assert bench.panel.words() == WATCHED and not bench.parts.enable.isEnabled()
    assert bench.parts.view.isEnabled()


def test_a_whole_way_with_a_pause_becomes_rows(bench: Bench) -> None:
    bench.connect().enable()
    bench.click(bench.parts.way)
    for x, y in ((1, 0), (0, 0), (0, 1)):
        bench.push(x, y)
        bench.stage.go(45)
    bench.push(0, 0)
    bench.still()
    bench.click(bench.parts.way)
    rows = bench.rows
    assert 3 <= len(rows) <= 6, rows
    assert any(float(row.get("pause", 0)) > 500 for row in rows[1:-1]), rows
    assert (float(rows[-1]["x"]) * 1000, float(rows[-1]["y"]) * 1000) == bench.places
    assert bench.panel.wrong == ()
