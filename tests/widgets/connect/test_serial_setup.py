"""Serial set-up: the manual's defaults and its table of switches (ssc-tol-o-motion.txt, chapter 5)."""

from __future__ import annotations

import pytest
from pytestqt.qtbot import QtBot

from app.theme import Choice, Theme
from widgets.connect.dip_switches import DipSwitches
from widgets.connect.serial_setup import PortShown, SerialChoice, SerialSetup

PORTS = (PortShown("COM1", "COM1 – serial port"), PortShown("COM3", "COM3 – USB adapter"))
# l.1519-1525: 1200(2) 9600(3) 19.2K(4)
TABLE = {
    300: "ON ON OFF", 1200: "ON OFF OFF", 4800: "ON OFF ON", 9600: "OFF ON OFF", 19200: "OFF OFF ON",
    38400: "OFF ON ON",
}  # fmt: skip


@pytest.fixture(scope="module", autouse=True)
def _theme(qapp: object) -> object:
    return Theme(qapp, Choice.LIGHT)  # type: ignore[arg-type]


@pytest.fixture
def setup(qtbot: QtBot) -> SerialSetup:
    setup = SerialSetup(SerialChoice(port="COM1"), PORTS)
    qtbot.addWidget(setup)
    return setup


@pytest.mark.parametrize(("rate", "words"), TABLE.items())
def test_the_switches_of_every_rate(qtbot: QtBot, rate: int, words: str) -> None:
    picture = DipSwitches()
    qtbot.addWidget(picture)
    picture.show_setting(rate, True)
    assert " ".join("ON" if on else "OFF" for on in picture.positions()[1:4]) == words
    assert str(rate) in picture.accessibleName()


def test_master_reset_is_never_shown_on(qtbot: QtBot) -> None:
    picture = DipSwitches()
    qtbot.addWidget(picture)
    for rate in TABLE:
        picture.show_setting(rate, False)
        assert not picture.positions()[0]


def test_the_defaults_are_those_of_the_manual(setup: SerialSetup) -> None:
    # l.1505-1511: 9600, 8, 1, none, echo off, both, first port
    assert setup.choice == SerialChoice("COM1", 9600, 8, 1, "none", False, "both")


def test_all_rates_of_the_controller_are_offered(setup: SerialSetup) -> None:
    assert [setup.baud.itemData(row) for row in range(setup.baud.count())] == sorted(TABLE)


def test_every_choice_comes_out_as_it_was_put_in(setup: SerialSetup) -> None:
    choice = SerialChoice("COM3", 19200, 7, 2, "even", True, "rts")
    setup.show_choice(choice)
    assert setup.choice == choice


def test_a_typed_address_is_taken_as_it_is(setup: SerialSetup) -> None:
    setup.port.setCurrentText("socket://10.0.0.5:4000")
    assert setup.choice.port == "socket://10.0.0.5:4000"


def test_the_picture_follows_rate_and_handshake(setup: SerialSetup) -> None:
    setup.baud.setCurrentIndex(setup.baud.findData(19200))
    setup.handshake.setCurrentIndex(setup.handshake.findData("xon"))
    assert setup.switches.positions() == (False, False, False, True, False)
    assert "OFF" in setup.words.text()


def test_connect_is_grey_without_a_port_and_says_why(qtbot: QtBot) -> None:
    setup = SerialSetup(SerialChoice(), ())
    qtbot.addWidget(setup)
    assert not setup.connect_button.isEnabled()
    assert "port" in setup.connect_button.toolTip()


def test_connect_hands_the_choice_up(setup: SerialSetup, qtbot: QtBot) -> None:
    with qtbot.waitSignal(setup.chosen) as signal:
        setup.connect_button.click()
    assert signal.args == [SerialChoice("COM1")]
