"""The simulator panel speaks the signals of the command line's --stimulus (spec/cli.md)."""

from __future__ import annotations

import re

import pytest
from pytestqt.qtbot import QtBot

from app.theme import Choice, Theme
from codegen.document import Document
from device.api import Kind
from tests.fakes import FakeController
from widgets.simulator.panel import SimulatorPanel

SIGNAL = re.compile(r"in[1-8]|an[1-7]|(fls|rls|home|position)_[xyzw]|abort|reset")


@pytest.fixture(scope="module", autouse=True)
def _theme(qapp: object) -> object:
    return Theme(qapp, Choice.LIGHT)  # type: ignore[arg-type]


@pytest.fixture
def panel(qtbot: QtBot) -> SimulatorPanel:
    panel = SimulatorPanel()
    qtbot.addWidget(panel)
    panel.show_document(None, Document())
    panel.attach(FakeController(Kind.SIMULATOR))  # type: ignore[arg-type]
    panel.signals = []  # type: ignore[attr-defined]
    panel.stimulus.connect(lambda signal, value: panel.signals.append((signal, value)))  # type: ignore[attr-defined]
    return panel


def said(panel: SimulatorPanel) -> list[tuple[str, float]]:
    return panel.signals  # type: ignore[attr-defined,no-any-return]


def test_inputs_start_high_as_with_nothing_connected(panel: SimulatorPanel) -> None:
    # spec/cli.md: all digital inputs start high
    assert len(panel.inputs) == 8
    assert all(box.isChecked() for box in panel.inputs.values())


def test_flipping_an_input(panel: SimulatorPanel) -> None:
    panel.inputs[1].click()
    panel.inputs[1].click()
    assert said(panel) == [("in1", 0.0), ("in1", 1.0)]


def test_a_pressed_switch_reads_low(panel: SimulatorPanel) -> None:
    # spec/cli.md, plant file: a switch that acts reads 0
    panel.switches["fls_x"].click()
    panel.switches["home_y"].click()
    panel.switches["abort"].click()
    assert said(panel) == [("fls_x", 0.0), ("home_y", 0.0), ("abort", 0.0)]


def test_volts_by_number_and_by_slider(panel: SimulatorPanel) -> None:
    panel.volts[3].setValue(2.5)
    assert said(panel) == [("an3", 2.5)]


def test_pushing_the_load(panel: SimulatorPanel) -> None:
    panel.pushes["Y"].setValue(250)
    button = next(each for each in panel.findChildren(type(panel.buttons["Y"])) if each.text() == "Push Y")
    button.click()
    assert said(panel) == [("position_y", 250.0)]


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
    panel.attach(FakeController(Kind.MACHINE))  # type: ignore[arg-type]
    assert not panel.empty.isHidden()
    assert "simulator is not running" in panel.empty.text()
