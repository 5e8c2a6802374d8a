"""Teaching by mouse and keys against a simulated table over its byte stream at 19 200 baud."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from app.asked import ANOTHER
from codegen import teach_file
from codegen.setup import Unit
from codegen.teach import Row, Table
from device.gamepad import Held
from tests.long import is_long
from tests.widgets.jog.test_pad import HandPad
from tests.widgets.teach.bench import ALONE, LEFT, PRESS, Bench
from widgets.teach.entries import OutputEntry, WaitEntry
from widgets.teach.panel import OFFLINE, PAD, SCREEN, WATCHED

PACE = {"speed": "20", "acceleration": "512", "deceleration": "512"}
ENDINGS = ("stop", "watch", "focus", "hidden", "cable") if is_long() else ("focus", "stop")


@pytest.fixture
def bench(qapp: QApplication, tmp_path: Path) -> Iterator[Bench]:
    made = Bench(tmp_path)
    yield made
    made.stage.clear_away()


def test_the_joystick_drives_and_its_buttons_record_and_end(bench: Bench) -> None:
    bench.connect()
    bench.push(-1, -1)  # not plugged in: 0 V, fully pushed
    bench.stage.go(10)
    bench.enable()
    bench.stage.go(20)
    assert not bench.moving and bench.places == (0, 0)
    bench.push(0, 0)
    bench.stage.go(10)
    bench.push(1, -0.5)
    bench.stage.go(40)
    x, y = bench.places
    assert bench.moving and x > 2000
    assert y == 0 if ALONE else -x * 0.7 < y < -x * 0.2
    bench.stage.rig.simulation.stimulus("in7", 0)
    bench.stage.go(PRESS)
    assert bench.rows == ()  # pressed while the axes move: once they stand
    bench.push(0, 0)
    bench.stage.rig.simulation.stimulus("in7", 1)
    bench.still()
    bench.stage.until(lambda: len(bench.rows) == 1)
    x, y = bench.places
    assert (bench.rows[0]["x"], bench.rows[0]["y"]) == (f"{x / 1000:g}", f"{y / 1000:g}")
    bench.press(8)
    assert not bench.panel.enabled and bench.panel.words() == "Done: 1 rows."
    a_whole_way_with_a_pause(bench)


def drive_by_pad(bench: Bench) -> None:
    """A gamepad drives while its dead-man button is down."""
    pad = HandPad(Held(0.0, 0.0, False))
    bench.stage.studio.at_machine.pads.opened = lambda: pad
    bench.parts.source.setCurrentIndex(bench.parts.source.findData(PAD))
    bench.fill(bench.parts.of_stick, "dead", "40")
    bench.enable()
    pad.push(0, 0.38)  # within the dead band of its field
    bench.stage.go(12)
    assert bench.places == (0, 0)
    pad.push(0, 1)
    bench.stage.until(lambda: bench.places[1] > 300, 3)
    assert bench.moving and bench.places[0] == 0
    pad.push(0, 1, dead_man=False)
    bench.stage.go(20)
    assert not bench.moving
    bench.click(bench.parts.enable)
    assert not bench.panel.enabled


def test_whatever_ends_driving_stops_both_axes(bench: Bench) -> None:
    bench.connect()
    drive_by_pad(bench)
    bench.parts.source.setCurrentIndex(bench.parts.source.findData(SCREEN))
    stick, across = bench.parts.stick, bench.places[1]
    for how in ENDINGS:
        bench.enable()
        stick.setFocus()
        QTest.keyPress(stick, Qt.Key.Key_Right)
        bench.stage.go(30)
        assert bench.moving and bench.places[1] == across
        if how == "stop":
            bench.stage.studio.connection.stop()
        elif how == "watch":
            bench.stage.controller.release_control()
        elif how == "focus":
            bench.stage.studio.program.tree.setFocus()
        elif how == "hidden":
            bench.stage.studio.desk.bring("Display")
        else:
            bench.stage.rig.cut()
        bench.stage.go(40)
        assert not bench.moving
        bench.stage.until(lambda: not bench.panel.enabled, 5)
        QTest.keyRelease(stick, Qt.Key.Key_Right)
        if how == "cable":
            return
        bench.stage.studio.desk.bring("Teach")
        bench.stage.controller.take_control()
        place = bench.places
        stick.setFocus()
        QTest.keyClick(stick, Qt.Key.Key_Right)
        bench.stage.go(5)
        assert bench.places == place


def a_whole_way_with_a_pause(bench: Bench) -> None:
    """Becomes rows: along X, a pause, along Y."""
    bench.enable()
    bench.click(bench.parts.way)
    bench.stage.until(lambda: bench.stage.controller.motion.busy)
    bench.stage.go(4 * PRESS)
    for x, y in ((1, 0), (0, 0), (0, 1)):
        bench.push(x, y)
        bench.stage.go(70 if ALONE else 35)
    bench.push(0, 0)
    bench.still()
    bench.click(bench.parts.way)
    bench.stage.until(lambda: "readings became" in bench.panel.words())
    rows = bench.rows[1:]
    assert 3 <= len(rows) <= 6, rows
    assert any(float(row.get("pause", 0)) > 500 for row in rows[1:-1]), rows
    assert (float(rows[-1]["x"]) * 1000, float(rows[-1]["y"]) * 1000) == bench.places
    assert bench.panel.wrong == ()


def test_numbers_of_other_units_never_come_among_the_rows(bench: Bench) -> None:
    """Rows of a table in mm, a setup in inches: 1 in would be 1 mm when the setup is in mm again."""
    bench.connect()
    teach, session = bench.stage.studio.at_machine.teach, bench.stage.studio.session
    teach.change(Table(("mm", "mm"), (Row(x="1", y="2", **PACE),)))
    document = session.document
    axis = dc.replace(document.setup.axes[0], unit=Unit.INCH, counts_per_unit="25400", forward_limit="8")
    session.set_document(dc.replace(document, setup=dc.replace(document.setup, axes=(axis,) * 4)), "Inches")
    bench.stage.go(3)
    before = bench.rows
    for press in (bench.parts.record, bench.parts.way, bench.parts.edits["pace"]):
        bench.parts.view.go_to(0, 2)
        QTest.mouseClick(press, LEFT, pos=QPoint(8, press.height() // 2))
        bench.stage.go(15)
        assert "were taught in mm, the axes of the setup are in in" in bench.panel.words()
        bench.panel.show_result("")
    assert bench.rows == before and not bench.parts.way.isChecked()


def test_the_table_is_edited_by_keys_also_offline_and_by_windows(bench: Bench, tmp_path: Path) -> None:
    assert bench.panel.words() == OFFLINE and not bench.parts.enable.isEnabled()
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
    bench.fill(bench.parts.of_rows, "speed", "33")
    bench.click(bench.parts.edits["pace"])
    assert bench.rows[0]["speed"] == "33"
    bench.fill(bench.parts.of_rows, "speed", "")
    assert "Speed is missing" in bench.parts.of_rows.message.text() == f"{bench.panel.problem}."

    waits_and_outputs(bench, tmp_path)


def waits_and_outputs(bench: Bench, tmp_path: Path) -> None:
    """Added by their windows; the file comes back."""
    bench.fill(bench.parts.of_rows, "speed", "33")
    bench.stage.studio.at_machine.teach.change(Table(("mm", "mm")))
    bench.connect("machine")
    assert bench.panel.words() == WATCHED and not bench.parts.enable.isEnabled()
    bench.stage.controller.take_control()
    bench.stage.go(3)
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
    teach, file = bench.stage.studio.at_machine.teach, tmp_path / "path.tlt"
    before = teach.table
    teach.save(file)
    teach.change(Table(("mm", "mm")))
    teach.open(file)
    assert teach.table == before
    assert Table(("mm", "mm"), before.rows) == teach_file.load(tmp_path / "teach.tlt")  # there again at the next start


def test_play_back_says_where_it_goes_asks_steps_and_stops(bench: Bench) -> None:
    rows = (Row(x="8", y="4", **PACE), Row(x="10", y="4", output="2", **PACE), Row(x="60", y="6", **PACE))
    bench.connect()
    bench.stage.rig.type("FL 50000")
    bench.stage.studio.at_machine.teach.change(Table(("mm", "mm"), rows))
    bench.fill(bench.parts.of_stick, "full", "40")
    bench.parts.how.setCurrentIndex(1)
    bench.click(bench.parts.play)
    assert "Switch I/O control on" in bench.panel.words()
    bench.click(bench.parts.io_control)
    bench.click(bench.parts.play)
    bench.stage.go(10)
    assert bench.panel.words() == "Not played back. Row 3: 60 mm lies beyond the forward limit of X, 50 mm."
    bench.typed(2, 0, "45")
    bench.click(bench.parts.play)
    bench.stage.go(10)
    bench.answer("Play back?", "Play back")
    for words in (
        "at 5 mm/s",
        "row 1",
        "X from 0 mm to 8 mm",
        "Y from 0 mm to 4 mm",
        "not seen homed",
        "It switches output 2.",
    ):
        assert words in bench.question, bench.question  # a quarter of 20 mm/s, the slower of both
    for expected in ((8000, 4000), (10_000, 4000)):
        bench.stage.until(lambda: bench.parts.next.isEnabled())
        bench.click(bench.parts.next)
        bench.stage.until(lambda expected=expected: bench.places == expected)
    bench.stage.until(lambda: bench.parts.next.isEnabled())
    assert bench.outputs == 2 and bench.panel.words() == "Row 3 is next."
    bench.click(bench.parts.next)
    bench.stage.until(lambda: bench.places[0] > 13_000)
    bench.click(bench.parts.halt)
    bench.stage.until(lambda: "stopped in row 3" in bench.panel.words())
    assert not bench.moving and bench.places[0] < 45_000
    assert not bench.parts.halt.isEnabled()


def test_a_question_answered_too_late_plays_nothing_and_choices_are_there_again(bench: Bench, tmp_path: Path) -> None:
    bench.connect()
    bench.stage.studio.at_machine.teach.change(Table(("mm", "mm"), (Row(x="8", y="4", output="-2", **PACE),)))
    bench.fill(bench.parts.of_stick, "dead", "22")
    bench.fill(bench.parts.of_stick, "full", "35")
    bench.fill(bench.parts.of_rows, "tolerance", "0.25")
    source = bench.parts.source
    source.setFocus()
    QTest.keyClick(source, Qt.Key.Key_End)
    bench.click(bench.parts.io_control)
    bench.click(bench.parts.play)
    bench.stage.go(10)
    bench.stage.connect("simulator", "ssc2")
    bench.stage.go(10)
    bench.answer("Play back?", "Play back")
    assert "It switches output 2." in bench.question
    bench.stage.go(20)
    assert bench.panel.words() == ANOTHER and bench.places == (0, 0) and not bench.moving
    again = Bench(tmp_path)  # the same machine at the next start
    try:
        found = again.panel.driving
        assert (found.dead, found.full, found.tolerance) == ("22", "35", "0.25")
        assert again.panel.source == PAD == bench.panel.source
        document = again.stage.studio.session.document
        axis = dc.replace(document.setup.axes[0], counts_per_unit="1")
        setup = dc.replace(document.setup, axes=(axis,) * 4)
        again.stage.studio.session.set_document(dc.replace(document, setup=setup), "Table")
        again.stage.go()
        assert again.panel.driving.full != "35"  # another machine: slow again
        assert again.panel.driving.dead == "22"  # the same stick
    finally:
        again.stage.clear_away()
