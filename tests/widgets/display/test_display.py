"""The display: user units, states in words, stale values, outputs that only switch when told so."""

from __future__ import annotations

import dataclasses as dc
import math

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot

from app.theme import Choice, Theme
from codegen.document import Document
from codegen.setup import Axis, Setup, Unit
from device.api import Kind
from tests.fakes import FakeController, live_row, row_of
from widgets.display.display import DisplayPanel
from widgets.display.messages import MessagesPanel
from widgets.display.readings import age_of, axis_shown, bit, fault_of, switches_of
from widgets.display.threads import thread_words
from widgets.parts.units import decimals_of, shown

INCH = Axis(unit=Unit.INCH, counts_per_unit="637", reverse_limit="0", forward_limit="20")


@pytest.fixture(scope="module", autouse=True)
def _theme(qapp: object) -> object:
    return Theme(qapp, Choice.LIGHT)  # type: ignore[arg-type]


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
    values = axis_shown(live_row(), "X", INCH, 0.0)
    assert values.position == "10.000"
    assert values.commanded == "10.002"  # 6371 / 637
    assert values.speed == "5.00 in/s"  # 3185 / 637
    assert values.moving
    assert values.fraction == pytest.approx(0.5)  # 10 of 0..20 in


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


@pytest.fixture
def panel(qtbot: QtBot) -> DisplayPanel:
    clock = [0.0]
    panel = DisplayPanel(clock=lambda: clock[0])
    panel.hand = clock  # type: ignore[attr-defined]
    qtbot.addWidget(panel)
    setup = dc.replace(Setup(model="ssc2"), input_names=("Start", *("",) * 7)).with_axis("X", INCH)
    panel.show_document(None, Document(setup=setup))
    panel.attach(FakeController(Kind.SIMULATOR))  # type: ignore[arg-type]
    panel.resize(380, 700)
    panel.show()
    return panel


def fake(panel: DisplayPanel) -> FakeController:
    controller = panel.controller
    assert isinstance(controller, FakeController)
    return controller


def test_offline_it_says_how_to_fill_it(qtbot: QtBot) -> None:
    panel = DisplayPanel()
    qtbot.addWidget(panel)
    panel.attach(FakeController())  # type: ignore[arg-type]
    assert "Connect a controller" in panel.words()


def test_it_watches_what_it_shows(panel: DisplayPanel) -> None:
    assert {"position.x", "position.y", "switches.x", "inputs", "outputs", "thread3"} <= set(panel.watches())
    assert "position.z" not in panel.watches()


def test_everything_is_said_in_words(panel: DisplayPanel) -> None:
    panel.refresh(live_row())
    words = panel.words()
    assert "X axis: 10.000 in, ▲ 5.00 in/s" in words
    assert "! at forward limit" in words
    assert "input 1 Start, off" in words
    assert "output 3, on" in words
    assert "Thread 0: line 4" in words


def test_stale_values_are_greyed_with_their_age(panel: DisplayPanel) -> None:
    panel.hand[0] = 12.0  # type: ignore[attr-defined]
    panel.refresh(live_row(0.0))
    assert panel.axes["X"].age.text() == "12 s old"
    assert "stale" in panel.inputs.lamps[0].words
    panel.hand[0] = 0.1  # type: ignore[attr-defined]
    panel.refresh(live_row(0.0))
    assert panel.axes["X"].age.text() == ""


def test_suspended_reading_says_why(panel: DisplayPanel) -> None:
    fake(panel).polling, fake(panel).polling_text = False, "waiting for an answer"
    panel.refresh(live_row())
    assert panel.rate.text() == "waiting for an answer"
    asked: list[bool] = []
    panel.read_wanted.connect(lambda: asked.append(True))
    assert panel.read_now.isVisible()
    panel.read_now.click()
    assert asked == [True]
    fake(panel).polling = True
    panel.refresh(live_row())
    assert not panel.read_now.isVisible()


def test_outputs_switch_only_with_io_control(panel: DisplayPanel, qtbot: QtBot) -> None:
    wanted: list[tuple[int, bool]] = []
    panel.output_wanted.connect(lambda number, on: wanted.append((number, on)))
    panel.refresh(live_row())
    lamp = panel.outputs.lamps[1]
    QTest.mouseClick(lamp, Qt.MouseButton.LeftButton)
    assert wanted == []
    assert "I/O control" in lamp.toolTip()
    fake(panel).io_control = True
    panel.refresh(live_row())
    QTest.mouseClick(lamp, Qt.MouseButton.LeftButton)
    QTest.keyClick(panel.outputs.lamps[0], Qt.Key.Key_Space)
    assert wanted == [(2, True), (1, False)]


def test_in_watch_io_control_is_grey_and_says_why(panel: DisplayPanel) -> None:
    fake(panel).control = False
    panel.refresh(live_row())
    assert not panel.io_control.isEnabled()
    assert "Control" in panel.io_control.toolTip()


def test_inputs_never_switch(panel: DisplayPanel) -> None:
    fake(panel).io_control = True
    panel.refresh(live_row())
    assert all(lamp.focusPolicy() == Qt.FocusPolicy.NoFocus for lamp in panel.inputs.lamps)


def test_another_model_brings_its_own_axes_and_lamps(panel: DisplayPanel) -> None:
    panel.attach(FakeController(Kind.MACHINE, "dmc1412"))  # type: ignore[arg-type]
    panel.refresh(row_of({"position.x": 1.0}))
    assert set(panel.axes) == {"X"}
    # dmc-1412: 7 inputs, 3 outputs (models.json)
    assert (len(panel.inputs.lamps), len(panel.outputs.lamps)) == (7, 3)


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
