"""The simulator panel speaks the signals of the command line's --stimulus (spec/cli.md)."""

from __future__ import annotations

import re

import pytest
from pytestqt.qtbot import QtBot

from app.theme import Choice, Theme
from codegen.document import Document
from device.api import Kind
from tests.rig import Rig
from widgets.simulator.panel import SimulatorPanel

SIGNAL = re.compile(r"in[1-8]|an[1-7]|(fls|rls|home|position)_[xyzw]|abort|reset")


@pytest.fixture(scope="module", autouse=True)
def _theme(qapp: object) -> object:
    return Theme(qapp, Choice.LIGHT)  # type: ignore[arg-type]


@pytest.fixture
def rig() -> Rig:
    return Rig().ready()


@pytest.fixture
def panel(qtbot: QtBot, rig: Rig) -> SimulatorPanel:
    panel = SimulatorPanel()
    qtbot.addWidget(panel)
    panel.show()
    panel.show_document(None, Document())
    panel.attach(rig.controller)
    panel.refresh(rig.controller.last())
    panel.making.finish()
    panel.signals = []  # type: ignore[attr-defined]
    panel.stimulus.connect(lambda signal, value: panel.signals.append((signal, value)))  # type: ignore[attr-defined]
    panel.stimulus.connect(rig.simulation.stimulus)
    return panel


def said(panel: SimulatorPanel) -> list[tuple[str, float]]:
    return panel.signals  # type: ignore[attr-defined,no-any-return]


def read(rig: Rig, operand: str) -> float:
    """What the controller says of it."""
    return rig.result(rig.controller.read(operand))[0]


def test_inputs_start_high_as_with_nothing_connected(panel: SimulatorPanel) -> None:
    # spec/cli.md: all digital inputs start high
    assert len(panel.inputs) == 8
    assert all(box.isChecked() for box in panel.inputs.values())


def test_flipping_an_input(panel: SimulatorPanel, rig: Rig) -> None:
    panel.inputs[1].click()
    assert read(rig, "_TI") == 0b11111110
    panel.inputs[1].click()
    assert read(rig, "_TI") == 0b11111111
    assert said(panel) == [("in1", 0.0), ("in1", 1.0)]


def test_a_pressed_switch_reads_low(panel: SimulatorPanel, rig: Rig) -> None:
    # spec/cli.md, plant file: a switch that acts reads 0
    panel.switches["fls_x"].click()
    panel.switches["home_y"].click()
    panel.switches["abort"].click()
    assert said(panel) == [("fls_x", 0.0), ("home_y", 0.0), ("abort", 0.0)]
    assert [read(rig, operand) for operand in ("_LFX", "_LFY", "_HMX", "_HMY")] == [0, 1, 1, 0]


def test_volts_by_number_and_by_slider(panel: SimulatorPanel, rig: Rig) -> None:
    panel.volts[3].setValue(2.5)
    assert said(panel) == [("an3", 2.5)]
    # a step of the converter is 20 V / 4096 = 4.9 mV
    assert read(rig, "@AN[3]") == pytest.approx(2.5, abs=0.005)


def test_pushing_the_load(panel: SimulatorPanel, rig: Rig) -> None:
    rig.type("MO")
    panel.pushes["Y"].setValue(250)
    button = next(each for each in panel.findChildren(type(panel.buttons["Y"])) if each.text() == "Push Y")
    button.click()
    assert said(panel) == [("position_y", 250.0)]
    assert read(rig, "_TPY") == 250


def test_every_signal_is_one_of_the_command_line(panel: SimulatorPanel) -> None:
    for box in (*panel.inputs.values(), *panel.switches.values()):
        box.click()
    for spin in panel.volts.values():
        spin.setValue(1.0)
    for button in (*panel.buttons.values(), panel.reset):
        button.click()
    assert all(SIGNAL.fullmatch(signal) for signal, _ in said(panel))
    assert len({signal for signal, _ in said(panel)}) == 8 + 6 + 1 + 7 + 2 + 1


def test_with_a_machine_there_is_nothing_to_flip(panel: SimulatorPanel) -> None:
    panel.attach(Rig(Kind.MACHINE).ready().controller)
    assert not panel.empty.isHidden()
    assert "simulator is not running" in panel.empty.text()
