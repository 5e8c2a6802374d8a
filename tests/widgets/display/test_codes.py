"""The display's codes in words, its torque, latch, outputs of the amplifier, voltages; names edited in place."""

from __future__ import annotations

import dataclasses as dc

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QLineEdit, QPushButton
from pytestqt.qtbot import QtBot

from app.theme import Choice, Theme
from codegen.document import Document
from codegen.setup import Axis, Setup, Unit
from device.api import Kind
from tests.app.hands import live
from tests.rig import Rig
from tests.widgets.display.test_display import Bench, row_of
from widgets.display.analog import volts_words
from widgets.display.readings import Switches, error_output, switches_of
from widgets.display.stops import said_of
from widgets.display.switches import HEADS, SwitchTable

CODES = ("stop_code.x", "stop_code.y", "error_code")


@pytest.fixture(scope="module", autouse=True)
def _theme(qapp: object) -> object:
    return Theme(qapp, Choice.LIGHT)  # type: ignore[arg-type]


@pytest.fixture
def bench(qtbot: QtBot) -> Bench:
    bench = Bench(Rig())
    qtbot.addWidget(bench.panel)
    return bench


def said(bench: Bench, *keys: str) -> str:
    """What the panel says once these were read afresh."""
    bench.rig.values(keys)
    bench.refresh()
    return bench.panel.words()


# ---- codes


def test_nothing_is_said_of_axes_that_run_arrived_or_found_home() -> None:
    # SC (dmc-1412-1414.txt chapter 5 / ssc manual): 0 50 100 running, 1 51 101 arrived, 9 FE, 10 HM or FI
    for code in (0, 1, 9, 10, 50, 51, 100, 101):
        assert said_of(row_of({"stop_code.x": code, "error_code": 0}), "X", 0.0) == ()


def test_a_code_nobody_knows_is_said_as_such() -> None:
    (found,) = said_of(row_of({"stop_code.x": 77}), "X", 0.0)
    assert found.words == "X: Unknown stop code (code 77)."


def test_a_stop_at_the_limit_is_said_with_the_next_step_and_help(bench: Bench) -> None:
    rig, stops = bench.rig, bench.panel.stops
    said(bench, *CODES)
    assert stops.words() == [] and not stops.isVisible()
    rig.type("JG 5000", "BG X")
    rig.run(0.3)
    rig.simulation.stimulus("fls_x", 0)  # the forward limit
    rig.run(0.6)
    text = said(bench, *CODES)
    line = next(line for line in text.splitlines() if line.startswith("X: "))
    assert "FWD limit switch" in line and "(code 2)" in line
    assert "Next: Move the axis back in reverse" in line
    assert stops.isVisible()
    asked: list[str] = []
    bench.panel.help_wanted.connect(asked.append)
    more = stops.findChild(QPushButton)
    assert more is not None and more.accessibleName() and more.focusPolicy() & Qt.FocusPolicy.TabFocus
    QTest.keyClick(more, Qt.Key.Key_Space)
    assert asked == ["Error and stop codes"]
    # 22: begin not possible due to limit switch
    assert not rig.result(rig.controller.ask("BG X")).accepted
    text = said(bench, *CODES)
    assert "Error 22: Begin not possible due to limit switch. Next: Move away from the limit switch first." in text
    # it goes when it is over: the axis runs again, the error is read
    rig.simulation.stimulus("fls_x", 1)
    rig.type("JG -500", "BG X", "TC")
    said(bench, *CODES)
    assert stops.words() == [] and not stops.isVisible()


def test_old_codes_are_grey(bench: Bench) -> None:
    row = row_of({"stop_code.x": 8.0, "error_code": 1.0})
    assert [each.stale for each in said_of(row, "X", 0.1)] == [False, False]
    assert [each.stale for each in said_of(row, "X", 60.0)] == [True, True]
    bench.panel.stops.show_said(said_of(row, "X", 60.0))
    assert {label.property("role") for pair in bench.panel.stops._labels for label in pair} == {"quiet"}


# ---- torque, latch, amplifier, error output, voltages


def test_motor_command_in_volts(bench: Bench) -> None:
    """OF 1.5 with a motor that is on and no gains is 1.5 V at the output (OF: offset of the motor command, V)."""
    rig = bench.rig
    rig.type("KP 0", "KI 0", "KD 0", "TL 9", "OF 1.5", "SH X")
    rig.run(0.1)
    said(bench, "torque.x", "torque.y", "switches.x")
    heads = dict(zip(HEADS, bench.panel.switches.words("X")[1:], strict=False))
    assert float(heads["Torque, V"]) == pytest.approx(1.5, abs=0.002)
    assert (heads["Motor"], heads["Amplifier"]) == ("● on", "● on")
    rig.type("MO X")
    said(bench, "torque.x", "switches.x")
    heads = dict(zip(HEADS, bench.panel.switches.words("X")[1:], strict=False))
    assert (heads["Motor"], heads["Amplifier"]) == ("○ off", "○ off")


def test_latch_off_armed_and_tripped_with_its_place(bench: Bench) -> None:
    """AL X, then input 1 falls: the place is caught (dmc-1412-1414.txt l.2392-2396); 1274 counts at 637 are 2 in."""
    rig, table = bench.rig, bench.panel.switches
    keys = ("switches.x", "latch.x")
    rig.type("DP 1274")
    said(bench, *keys)
    assert table.words("X")[-1] == "○ off"
    rig.type("AL X")
    said(bench, *keys)
    assert table.words("X")[-1] == "▲ armed"
    rig.simulation.stimulus("in1", 0)
    rig.run(0.1)
    said(bench, *keys)
    assert table.words("X")[-1] == "◆ tripped\n2.000"


def test_what_is_not_read_is_a_question_mark(bench: Bench) -> None:
    table = SwitchTable()
    table.show_axes("X")
    table.show_axis("X", switches_of(row_of({}), "X", 0.0))
    assert table.words("X") == ("X", *["?"] * 8)
    assert table.output.text() == "?"


def test_the_error_output_is_one_for_all_axes() -> None:
    """Low while at least one axis has a position error above ER (dmc-1412-1414.txt l.4098-4100)."""
    good, bad, unknown = Switches(error=False), Switches(error=True), Switches()
    assert error_output([good, bad, unknown]) is True
    assert error_output([good, good]) is False
    assert error_output([good, unknown]) is None
    assert error_output([]) is None


def test_error_output_and_row_follow_the_machine(bench: Bench) -> None:
    rig = bench.rig
    said(bench, "switches.x", "switches.y")
    assert bench.panel.switches.output.text() == "○ off"
    rig.type("OE 0", "MO X", "ER 10")
    rig.type("SH X", "KP 0", "KI 0", "KD 0", "PR 5000", "SP 50000", "BG X")  # commanded away, no force follows
    rig.run(0.3)
    said(bench, "switches.x", "switches.y")
    assert bench.panel.switches.output.text() == "! on (low)"


def test_analog_inputs_in_volts_where_the_model_has_them(bench: Bench) -> None:
    rig = bench.rig
    rig.simulation.stimulus("an2", 2.5)
    bench.panel.resize(380, 1600)  # all in sight: what is out of sight is not read
    live(0.02)
    assert "analog7" in bench.panel.watches() and "analog8" not in bench.panel.watches()
    text = said(bench, *(f"analog{number}" for number in range(1, 8)))
    found = next(line for line in text.splitlines() if line.startswith("analog input 2,"))
    assert float(found.split(", ")[1].removesuffix(" V")) == pytest.approx(2.5, abs=0.005)  # 12 bits of 20 V
    small = Rig(Kind.MACHINE, "dmc1412").ready()
    bench.panel.attach(small.controller)
    before = bench.panel.watches()  # it is not known yet what this one has
    assert not [key for key in before if key.startswith(("analog", "position"))]
    for _ in range(5):  # one group with each tick
        bench.panel.refresh(small.values(("position.x",)).controller.last())
    assert len(bench.panel.analog.words()) == 2  # models.json


def test_voltages_out_of_sight_cost_no_line_time(bench: Bench) -> None:
    bench.panel.resize(380, 1600)
    live(0.02)
    whole = set(bench.panel.watches())
    assert {"torque.x", "torque.y", "analog1"} <= whole
    bench.panel.resize(380, 300)
    live(0.02)
    assert whole - set(bench.panel.watches()) == {"torque.x", "torque.y", *(f"analog{n}" for n in range(1, 8))}


@pytest.mark.parametrize(("volts", "text"), [(-0.28432, "-0.284"), (-0.0001, "0.000"), (float("nan"), "?")])
def test_volts_in_words(volts: float, text: str) -> None:
    assert volts_words(volts) == text


def test_positions_are_read_as_often_as_without_the_slow_values() -> None:
    """Error code, torques and voltages of four axes, read or not: at most a tenth fewer positions a second."""

    def rate(more: tuple[str, ...]) -> float:
        rig = Rig("simulator", "ssc4").ready()
        usual = ("position", "commanded", "error", "velocity", "switches", "stop_code", "latch")
        rig.controller.watch("panel", (*(f"{name}.{axis}" for name in usual for axis in "xyzw"), "inputs", *more))
        rig.run(1.0)
        place, count = rig.controller.last().columns["position.x"], 0
        before = -1.0
        end = rig.clock() + 3.0
        while rig.clock() < end:
            rig.run(0.005)
            at = float(rig.controller.last().times[place])
            count += at != before
            before = at
        return count / 3.0

    volts = (*(f"torque.{axis}" for axis in "xyzw"), *(f"analog{number}" for number in range(1, 8)))
    bare, whole = rate(()), rate(("error_code", *volts))
    print(f"{bare:.1f} readings/s without, {whole:.1f} with")
    assert whole >= 0.9 * bare


# ---- names


def renamed(bench: Bench) -> list[tuple[Setup, str]]:
    wanted: list[tuple[Setup, str]] = []
    bench.panel.setup_wanted.connect(lambda setup, label: wanted.append((setup, label)))
    bench.refresh()
    return wanted


def editor_of(bench: Bench, outputs: bool = False) -> QLineEdit:
    editor = (bench.panel.outputs if outputs else bench.panel.inputs).editor
    assert editor is not None
    return editor


def test_f2_on_a_lamp_edits_its_name(bench: Bench) -> None:
    wanted, lamp = renamed(bench), bench.panel.inputs.lamps[2]
    QTest.keyClick(lamp, Qt.Key.Key_F2)
    editor = editor_of(bench)
    assert editor.accessibleName() == "Name of input 3"
    QTest.keyClicks(editor, "Door  closed ")
    QTest.keyClick(editor, Qt.Key.Key_Return)
    assert bench.panel.inputs.editor is None
    ((setup, label),) = wanted
    assert label == "Rename input 3"
    assert setup.input_names == ("Start", "", "Door closed", *("",) * 5)
    assert dc.replace(setup, input_names=bench.panel._setup.input_names) == bench.panel._setup  # type: ignore[union-attr]


def test_esc_keeps_the_name_and_the_menu_asks_too(bench: Bench) -> None:
    wanted, lamp = renamed(bench), bench.panel.outputs.lamps[0]
    (rename,) = [action for action in lamp.actions() if action.text().startswith("Rename…")]
    rename.trigger()
    QTest.keyClicks(editor_of(bench, outputs=True), "Cutter")
    QTest.keyClick(editor_of(bench, outputs=True), Qt.Key.Key_Escape)
    assert bench.panel.outputs.editor is None and wanted == []
    rename.trigger()
    QTest.keyClicks(editor_of(bench, outputs=True), "Cutter")
    QTest.keyClick(editor_of(bench, outputs=True), Qt.Key.Key_Return)
    assert [(setup.output_names[0], label) for setup, label in wanted] == [("Cutter", "Rename output 1")]


@pytest.mark.parametrize(("name", "why"), [("Start", "is used twice"), ("12", "is a number")])
def test_a_name_that_would_be_none_is_refused_in_a_sentence(bench: Bench, name: str, why: str) -> None:
    wanted = renamed(bench)
    said_: list[str] = []
    bench.panel.said.connect(said_.append)
    QTest.keyClick(bench.panel.inputs.lamps[1], Qt.Key.Key_F2)
    QTest.keyClicks(editor_of(bench), name)
    QTest.keyClick(editor_of(bench), Qt.Key.Key_Return)
    assert wanted == []
    assert len(said_) == 1 and "Input 2 was not renamed" in said_[0] and why in said_[0]


def test_renaming_never_switches_an_output(bench: Bench) -> None:
    bench.rig.controller.set_io_control(True)
    bench.refresh()
    asked: list[object] = []
    bench.panel.output_wanted.connect(lambda *each: asked.append(each))
    QTest.keyClick(bench.panel.outputs.lamps[4], Qt.Key.Key_F2)
    QTest.keyClicks(editor_of(bench, outputs=True), "Door open")
    QTest.mouseClick(editor_of(bench, outputs=True), Qt.MouseButton.LeftButton)
    QTest.keyClick(editor_of(bench, outputs=True), Qt.Key.Key_Return)
    assert asked == []


def test_a_new_setup_shows_the_name(bench: Bench) -> None:
    old = Document(setup=bench.panel._setup or Setup())
    setup = dc.replace(old.setup, output_names=("Pump", *("",) * 7)).with_axis("Y", Axis(unit=Unit.COUNT))
    bench.panel.show_document(old, dc.replace(old, setup=setup))
    bench.refresh()
    assert "output 1 Pump" in bench.panel.words()
