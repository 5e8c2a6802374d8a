"""The display: user units, states in words, stale values, outputs that only switch when told so."""

from __future__ import annotations

import dataclasses as dc
import math
import re

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QLabel
from pytestqt.qtbot import QtBot

from app.theme import Choice, Theme
from codegen.document import Document
from codegen.setup import Axis, Setup, Unit
from device.api import Controller, Kind, Row, State
from tests.rig import Rig
from widgets.display.display import DisplayPanel
from widgets.display.messages import MessagesPanel
from widgets.display.readings import age_of, axis_shown, bit, fault_of, switches_of
from widgets.display.threads import thread_words
from widgets.parts.units import decimals_of, shown

X = ("position.x", "commanded.x", "error.x", "velocity.x", "switches.x", "stop_code.x")
Y = ("position.y", "commanded.y", "error.y", "velocity.y", "switches.y", "stop_code.y")
PLAIN = ("inputs", "outputs", "thread0")
INCH = Axis(unit=Unit.INCH, counts_per_unit="637", reverse_limit="0", forward_limit="20")


@pytest.fixture(scope="module", autouse=True)
def _theme(qapp: object) -> object:
    return Theme(qapp, Choice.LIGHT)  # type: ignore[arg-type]


def row_of(values: dict[str, float], at: float = 0.0, period_s: float = 0.1) -> Row:
    """A row with these values, all read at `at`."""
    places = {name: place for place, name in enumerate(values)}
    return Row(places, np.array([float(value) for value in values.values()]), np.full(len(values), at), period_s)


@pytest.mark.parametrize(
    ("counts", "axis", "text"),
    [
        (6370.0, INCH, "10.000"),  # 637 counts an inch: a count is 0.0016 in, three decimals show it
        (-1.0, INCH, "-0.002"),
        (0.0, INCH, "0.000"),
        (-0.2, INCH, "0.000"),
        (12345.0, Axis(unit=Unit.COUNT), "12345"),
        (math.nan, INCH, "–"),
        (1000.0, Axis(unit=Unit.MM, counts_per_unit="1000"), "1.000"),
    ],
)
def test_counts_in_user_units(counts: float, axis: Axis, text: str) -> None:
    assert shown(counts, axis) == text


def test_decimals_still_show_one_count() -> None:
    for scale in ("1", "10", "100", "1000", "4000", "637"):
        axis = Axis(counts_per_unit=scale)
        assert 10.0 ** -decimals_of(axis) <= 1 / float(scale) * (10 if decimals_of(axis) == 4 else 1.0000001)


def test_switches_come_from_the_ts_byte() -> None:
    # spec/tables.json TS_bits: 7 in motion, 6 error, 5 motor off, 3 forward not active, 2 reverse not active, 1 home
    switches = switches_of(row_of({"switches.x": 0b10001100}), "X", 0.0)
    assert (switches.moving, switches.error, switches.motor_on) == (True, False, True)
    assert (switches.forward, switches.reverse, switches.home) == (False, False, False)
    switches = switches_of(row_of({"switches.x": 0b01100010}), "X", 0.0)
    assert (switches.moving, switches.error, switches.motor_on) == (False, True, False)
    assert (switches.forward, switches.reverse, switches.home) == (True, True, True)


def test_what_is_not_polled_is_not_known() -> None:
    assert switches_of(row_of({}), "X", 0.0).moving is None
    assert bit(math.nan, 1) is None


@pytest.mark.parametrize(
    ("byte", "code", "words"),
    [
        (12, 6, "abort input"),
        (12, 8, "off on error"),
        (12, 1, ""),
        (4, 2, "at forward limit"),
        (8, 3, "at reverse limit"),
    ],
)
def test_faults_in_words(byte: int, code: int, words: str) -> None:
    assert fault_of(switches_of(row_of({"switches.x": byte}), "X", 0.0), code) == words


def test_one_axis_in_units_with_speed_and_travel() -> None:
    row = row_of({
        "position.x": 6370, "commanded.x": 6371, "error.x": 1, "velocity.x": 3185, "switches.x": 128 + 8 + 4 + 1,
        "stop_code.x": 0, "period": 1000,
    })  # fmt: skip
    values = axis_shown(row, "X", INCH, 0.0)
    assert values.position == "10.000"
    assert values.commanded == "10.002"  # 6371 / 637
    assert values.speed == "5.00 in/s"  # 3185 / 637
    assert values.moving
    assert (values.marks.low, values.marks.actual, values.marks.high) == (0, 10, 20)  # in


@pytest.mark.parametrize(("period", "speed"), [(500, "10.00 in/s"), (2000, "2.50 in/s"), (-1, "moving")])
def test_a_speed_is_true_at_any_sample_period(period: int, speed: str) -> None:
    """TV is calibrated at TM 1000 only (commands.md, TM); an external clock (TM -1) may run at any rate."""
    assert axis_shown(row_of({"velocity.x": 3185, "period": period}), "X", INCH, 0.0).speed == speed


def test_age_of_a_value() -> None:
    row = row_of({"position.x": 1.0}, at=0.0, period_s=0.1)
    assert age_of(row, "position.x", 0.5) == ""
    assert age_of(row, "position.x", 4.0) == "4.0 s old"
    assert age_of(row, "position.x", 60.0) == "60 s old"
    assert age_of(row, "position.x", 600.0) == "10 min old"


def test_threads_in_words() -> None:
    source = ["#A", "AI 1", "PR 100"]
    assert thread_words(0, 1, source) == "▲  Thread 0: line 1, waiting: after input (AI 1)"
    assert thread_words(1, 2, source) == "▲  Thread 1: line 2, (PR 100)"
    assert thread_words(2, -1, source).startswith("■")
    assert thread_words(3, math.nan, source).startswith("?")
    assert thread_words(0, 99, source) == "▲  Thread 0: line 99"


class Bench:
    """The panel on a simulated machine."""

    def __init__(self, rig: Rig) -> None:
        self.rig = rig.ready()
        self.panel = DisplayPanel(clock=rig.clock)
        setup = dc.replace(Setup(model="ssc2"), input_names=("Start", *("",) * 7)).with_axis("X", INCH)
        self.panel.show_document(None, Document(setup=setup))
        self.panel.attach(rig.controller)
        self.panel.resize(380, 700)
        self.panel.show()
        for _ in range(5):  # one group of it is made with each tick
            self.refresh()
        rig.controller.watch("panel", self.panel.watches())

    def refresh(self) -> None:
        self.panel.refresh(self.rig.controller.last())

    def until(self, words: str) -> str:
        """Refreshes until it says so; everything it says then."""

        def said() -> bool:
            self.refresh()
            return words in self.panel.words()

        self.rig.until(said)
        return self.panel.words()


@pytest.fixture
def bench(qtbot: QtBot) -> Bench:
    bench = Bench(Rig())
    qtbot.addWidget(bench.panel)
    return bench


@pytest.fixture
def panel(bench: Bench) -> DisplayPanel:
    return bench.panel


def test_offline_it_says_how_to_fill_it(qtbot: QtBot) -> None:
    panel = DisplayPanel()
    qtbot.addWidget(panel)
    panel.attach(Controller.offline())
    assert "Connect a controller" in panel.words()


def test_it_watches_what_it_shows(panel: DisplayPanel) -> None:
    assert {"position.x", "position.y", "switches.x", "inputs", "outputs", "thread3"} <= set(panel.watches())
    assert "position.z" not in panel.watches()


def test_everything_is_said_in_words(bench: Bench) -> None:
    rig = bench.rig
    rig.type("DP 6370,-1250", "SB 1", "SB 3")
    rig.simulation.stimulus("in1", 0)
    rig.simulation.stimulus("fls_y", 0)
    rig.start("#A\nN=1\nN=2\nN=3\nAI 1\nEN")
    rig.values((*X, *Y, *PLAIN))
    bench.refresh()
    lines = bench.panel.words().splitlines()
    # 6370 counts at 637 an inch; Y counts as it has no scale
    assert "X axis: 10.000 in, ■ stopped, commanded 10.000" in lines
    assert any(line.startswith("Y axis: -1250 counts,") and "! at forward limit" in line for line in lines)
    assert "input 1 Start, off" in lines
    assert [line.split(", ")[1] for line in lines if line.startswith("input ")] == ["off", *["on"] * 7]
    on = ["on", "off", "on", *["off"] * 5]
    assert [line.split(", ")[1] for line in lines if line.startswith("output ")] == on
    assert any("Thread 0: line 4" in line for line in lines)


def test_an_axis_without_a_scale_is_shown_in_counts_and_says_so(qtbot: QtBot) -> None:
    """Not "-1250 in": nobody has said how many counts make an inch."""
    bare = axis_shown(
        row_of({"position.x": -1250.0, "velocity.x": 7.0, "error.x": 1.0, "period": 1000.0}),
        "X",
        Axis(unit=Unit.INCH),
        0.0,
    )
    assert (bare.position, bare.unit, bare.speed, bare.error) == ("-1250", "counts", "7.00 counts/s", "1 counts")


def test_a_moving_axis_says_so_with_its_speed(bench: Bench) -> None:
    pace = 19_200 / (bench.rig.controller.line.baud or 19_200)
    bench.rig.type("JG 3184", "BGX")
    bench.rig.run(1.0 * pace)  # every value was read since it runs evenly
    words = bench.until("in/s")
    found = re.search(r"X axis: ([-\d.]+) in, ▲ ([-\d.]+) in/s", words)
    assert found is not None
    assert float(found[2]) == pytest.approx(3184 / 637, abs=0.02)
    # where it was when it was read, from where it is now
    row, clock = bench.rig.controller.last(), bench.rig.clock()
    actual = bench.rig.simulation.state()["axes"]["X"]["actual"]
    read_at = actual - 3184 * (clock - max(row.time("at.x"), row.time("position.x")))
    reach = 3184 / 637 * 0.05 * pace  # an answer takes up to 50 ms at 19 200
    assert float(found[1]) == pytest.approx(read_at / 637, abs=reach)


def test_where_the_axis_stands_between_its_limits(bench: Bench) -> None:
    bench.rig.type("DP 6370")
    bench.rig.values(X)
    shown_now = axis_shown(bench.rig.controller.last(), "X", INCH, bench.rig.clock())
    assert (shown_now.marks.low, shown_now.marks.actual, shown_now.marks.high) == (0, 10, 20)  # in


def test_no_number_is_cut_off_at_the_right(qtbot: QtBot) -> None:
    panel, rig = DisplayPanel(), Rig("simulator", "ssc4")
    qtbot.addWidget(panel)
    panel.show_document(None, Document(setup=Setup(model="ssc4")))
    rig.until(lambda: rig.controller.state is State.READY)
    panel.attach(rig.controller)
    rig.type("DP -1234567,7654321,-99999,123456789")
    rig.values(tuple(f"{name}.{axis}" for name in ("position", "commanded", "error", "switches") for axis in "xyzw"))
    panel.resize(200, 600)
    panel.show()
    for _ in range(6):  # five groups are made, one with each look, then all has its value
        panel.refresh(rig.controller.last())
    qtbot.wait(50)
    panel.resize(panel.minimumSizeHint().width(), 600)  # as a dock does
    qtbot.wait(50)
    seen = panel._body.viewport()
    for label in panel._body.findChildren(QLabel):
        if not label.isVisible():
            continue
        right = label.mapTo(seen, QPoint(label.width(), 0)).x()
        assert right <= seen.width(), f"{label.text()!r} ends {right - seen.width()} px outside"
        wide_enough = label.wordWrap() or label.width() >= label.sizeHint().width()
        assert wide_enough, f"{label.text()!r} is cut"
    assert panel.axes["Y"].commanded.text() == "commanded 7654321"


def test_stale_values_are_greyed_with_their_age(bench: Bench) -> None:
    panel, rig = bench.panel, bench.rig
    rig.type("DP 6370")
    rig.values((*X, "inputs"))
    bench.until("10.000 in")
    assert panel.axes["X"].age.text() == ""
    assert "stale" not in panel.inputs.lamps[0].words
    rig.cut()
    rig.run(1.0)
    rig.run_to(rig.controller.last().time("position.x") + 12.0)
    bench.refresh()
    assert panel.axes["X"].age.text() == "12 s old"
    assert panel.axes["X"].position.text() == "10.000"
    assert "stale" in panel.inputs.lamps[0].words
    assert "X axis: 10.000 in, ? unknown, commanded 10.000" in panel.words()  # it may move by now
    assert "Thread 0: not known" in panel.words()
    rig.loopback.unplugged = False
    rig.until(lambda: rig.controller.state is State.READY)
    rig.values((*X, "inputs"))
    bench.refresh()
    assert panel.axes["X"].age.text() == ""


def test_suspended_reading_says_why(bench: Bench) -> None:
    panel, rig = bench.panel, bench.rig
    bench.until("reads/s")
    assert not panel.read_now.isVisible()
    rig.simulation.load_program('#A\nIN "Length?",LEN\nEN')
    rig.result(rig.controller.execute(anyway=True))
    rig.until(lambda: rig.controller.pending_prompt is not None)
    bench.refresh()
    assert panel.rate.text() == "The program waits for an answer “Length?”."
    asked: list[bool] = []
    panel.read_wanted.connect(lambda: asked.append(True))
    assert panel.read_now.isVisible()
    panel.read_now.click()
    assert asked == [True]
    rig.result(rig.controller.answer("5"))
    bench.until("reads/s")
    assert not panel.read_now.isVisible()


def test_outputs_switch_only_with_io_control(bench: Bench) -> None:
    panel, rig = bench.panel, bench.rig
    wanted: list[tuple[int, bool]] = []
    panel.output_wanted.connect(lambda number, on: wanted.append((number, on)))
    rig.type("SB 1")
    bench.until("output 1, on")
    lamp = panel.outputs.lamps[1]
    QTest.mouseClick(lamp, Qt.MouseButton.LeftButton)
    assert wanted == []
    assert "I/O control" in lamp.toolTip()
    rig.controller.set_io_control(True)
    bench.refresh()
    QTest.mouseClick(lamp, Qt.MouseButton.LeftButton)
    QTest.keyClick(panel.outputs.lamps[0], Qt.Key.Key_Space)
    assert wanted == [(2, True), (1, False)]


def test_in_watch_io_control_is_grey_and_says_why(bench: Bench) -> None:
    bench.rig.controller.release_control()
    bench.refresh()
    assert not bench.panel.io_control.isEnabled()
    assert "Control" in bench.panel.io_control.toolTip()


def test_inputs_never_switch(bench: Bench) -> None:
    """They can be reached by keys, for their names; nothing switches them."""
    bench.rig.controller.set_io_control(True)
    bench.refresh()
    wanted: list[object] = []
    bench.panel.output_wanted.connect(lambda *asked: wanted.append(asked))
    for lamp in bench.panel.inputs.lamps:
        lamp.wanted.connect(wanted.append)
        QTest.mouseClick(lamp, Qt.MouseButton.LeftButton)
        QTest.keyClick(lamp, Qt.Key.Key_Space)
    assert wanted == []


def test_another_model_brings_its_own_axes_and_lamps(bench: Bench) -> None:
    other = Rig(Kind.MACHINE, "dmc1412").ready()
    bench.panel.attach(other.controller)
    for _ in range(5):  # one group with each tick
        bench.panel.refresh(other.values(("position.x",)).controller.last())
    assert set(bench.panel.axes) == {"X"}
    # dmc-1412: 7 inputs, 3 outputs (models.json)
    assert (len(bench.panel.inputs.lamps), len(bench.panel.outputs.lamps)) == (7, 3)


def test_messages_keep_their_order_and_count_repeats(qtbot: QtBot) -> None:
    messages = MessagesPanel()
    qtbot.addWidget(messages)
    for text in ("one", "two", "two", "two", ""):
        messages.say(text)
    assert messages.texts() == ["one", "two"]
    assert "(3 times)" in messages.list.item(1).text()
    messages.clear.click()
    assert messages.texts() == []
    assert not messages.empty.isHidden()
