"""The settings window: what is chosen with mouse or keys holds at once and is remembered."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QCheckBox, QComboBox, QDoubleSpinBox, QTextBrowser

from app.options import KEPT, SHOWN
from app.settings import ROWS, Settings
from app.theme import Choice
from device.api import State
from tests.app.hands import Hands, Keys, Mouse
from tests.stage import Stage
from widgets.options.page import OptionsPage

# set where they belong: in the serial setup, by the search, by moving panels
ELSEWHERE = {
    "port",
    "baud",
    "bits",
    "stop_bits",
    "parity",
    "echo",
    "handshake",
    "layout",
    "window",
    "folded",
    "jog_speeds",
    "variable_names",
    "scope",
    "teach",
    "tuner",
}  # where a program was folded, with its file; speeds beside the axis in Jog; what the tuner shows in the tuner
WAYS = pytest.mark.parametrize("way", [Mouse, Keys], ids=["mouse", "keyboard"])


def page_of(stage: Stage, way: type[Hands]) -> tuple[OptionsPage, Hands]:
    hands = way(stage.studio)
    hands.act("options")
    page = stage.studio.options.page
    assert page is not None and page.isVisible()
    QTest.qWaitForWindowActive(page, 2000)
    return page, hands


def reread(stage: Stage) -> Settings:
    return Settings(stage.studio.settings.path)


def test_every_setting_can_be_reached_somewhere() -> None:
    assert {row.key for row in ROWS} == {*SHOWN, *KEPT, *ELSEWHERE}


@WAYS
def test_the_simulator_gets_the_rate_that_is_chosen(stage: Stage, way: type[Hands]) -> None:
    page, hands = page_of(stage, way)
    box = page.editors["simulator_baud"]
    assert isinstance(box, QComboBox) and box.currentText() == "19 200 baud"
    hands.choose(box, "9 600 baud")
    assert reread(stage).get("simulator_baud") == 9600
    stage.studio.actions["simulator"].trigger()
    stage.until(lambda: stage.controller.state is State.READY)
    assert stage.controller.line.baud == 9600


@WAYS
def test_colours_change_at_once(stage: Stage, way: type[Hands]) -> None:
    page, hands = page_of(stage, way)
    box = page.editors["theme"]
    assert isinstance(box, QComboBox)
    hands.choose(box, "Dark")
    assert stage.studio.theme.choice is Choice.DARK
    assert stage.studio.actions["theme_dark"].isChecked()
    assert reread(stage).get("theme") == "dark"


@WAYS
def test_looking_at_start_can_be_switched_off(stage: Stage, way: type[Hands]) -> None:
    page, hands = page_of(stage, way)
    tick = page.editors["look_at_start"]
    assert isinstance(tick, QCheckBox) and tick.isChecked()
    hands.press(tick)
    assert reread(stage).get("look_at_start") is False


@WAYS
def test_minutes_are_numbers_within_their_range(stage: Stage, way: type[Hands]) -> None:
    page, hands = page_of(stage, way)
    number = page.editors["idle_minutes"]
    assert isinstance(number, QDoubleSpinBox)
    for typed, kept in (("2.5", 2.5), ("0.1", 2.5)):
        hands.fill(number.lineEdit(), typed)
        QTest.keyClick(number, Qt.Key.Key_Tab)
        assert reread(stage).get("idle_minutes") == kept


@WAYS
@pytest.mark.parametrize(("key", "value"), [("ports_used", ["COM1"]), ("known_models", {"5": "ssc2"})])
def test_what_is_remembered_can_be_forgotten(stage: Stage, way: type[Hands], key: str, value: object) -> None:
    stage.studio.settings.set(key, value)
    page, hands = page_of(stage, way)
    button = page.forget[key]
    assert button.text() == "Forget 1"
    hands.press(button)
    assert not button.isEnabled()
    assert reread(stage).get(key) == type(value)()


def test_each_setting_says_what_it_does(stage: Stage) -> None:
    page, _ = page_of(stage, Mouse)
    for key, widget in {**page.editors, **page.forget}.items():
        row = stage.studio.settings.rows[key]
        assert widget.accessibleName() == row.label
        assert widget.accessibleDescription() == row.help


def test_f1_opens_the_page_about_settings(stage: Stage) -> None:
    page, _ = page_of(stage, Keys)
    page.editors["theme"].setFocus()
    QApplication.processEvents()
    QTest.keyClick(page.editors["theme"], Qt.Key.Key_F1)
    stage.go()
    assert stage.studio.desk.help is not None and stage.studio.desk.help.isVisible()
    browser = stage.studio.desk.help.findChildren(QTextBrowser)[0]
    assert browser.toPlainText().startswith("Settings")
