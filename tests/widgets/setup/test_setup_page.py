"""The first setup page: model, units, counts per unit; asks what to keep when the scale changes."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot

from app.theme import Choice, Theme
from codegen.models import MODELS
from codegen.setup import Axis, Setup, Unit
from widgets.setup.page import SetupPage, scale_words

SETUP = Setup(model="ssc2").with_axis("X", Axis(unit=Unit.INCH, counts_per_unit="637"))


@pytest.fixture(scope="module", autouse=True)
def _theme(qapp: object) -> object:
    return Theme(qapp, Choice.LIGHT)  # type: ignore[arg-type]


def page_of(qtbot: QtBot, has_content: bool) -> tuple[SetupPage, list[tuple[Setup, str]]]:
    page = SetupPage(SETUP, has_content)
    qtbot.addWidget(page)
    taken: list[tuple[Setup, str]] = []
    page.accepted_setup.connect(lambda setup, keep: taken.append((setup, keep)))
    page.show()
    return page, taken


def test_what_is_shown_unchanged_is_the_same_setup(qtbot: QtBot) -> None:
    page, taken = page_of(qtbot, True)
    assert page.setup == SETUP
    page.done_button.click()
    assert taken == []


def test_every_model_is_offered_and_shows_its_axes(qtbot: QtBot) -> None:
    page, _ = page_of(qtbot, False)
    for name, model in MODELS.items():
        page.model.setCurrentIndex(page.model.findData(name))
        assert "".join(letter for letter, row in page.rows.items() if row.isVisible()) == model.axes


def test_a_new_scale_in_an_empty_program_is_taken_at_once(qtbot: QtBot) -> None:
    page, taken = page_of(qtbot, False)
    page.rows["X"].scale.setText("1000")
    page.done_button.click()
    assert [(setup.axis("X").counts_per_unit, keep) for setup, keep in taken] == [("1000", "units")]


@pytest.mark.parametrize("keep", ["units", "counts"])
def test_a_new_scale_under_a_program_asks_what_to_keep(qtbot: QtBot, keep: str) -> None:
    page, taken = page_of(qtbot, True)
    page.rows["X"].scale.setText("1000")
    page.done_button.click()
    assert taken == []
    assert page.question.isVisible()
    (page.keep_units if keep == "units" else page.keep_counts).click()
    assert [each for _, each in taken] == [keep]


def test_a_renamed_input_asks_nothing(qtbot: QtBot) -> None:
    page, taken = page_of(qtbot, True)
    page.inputs.lines[0].setText("Start")
    page.done_button.click()
    assert taken[0][0].input_names[0] == "Start"


@pytest.mark.parametrize("text", ["12,5", "abc", "0", "-3"])
def test_nonsense_in_the_scale_is_said_and_not_taken(qtbot: QtBot, text: str) -> None:
    page, _ = page_of(qtbot, True)
    page.rows["X"].scale.setText(text)
    assert not page.done_button.isEnabled()
    assert page.problem.isVisible()
    assert page.problem.text()


def test_the_scale_in_words() -> None:
    assert scale_words(Axis(unit=Unit.MM, counts_per_unit="100")) == "1 mm = 100 counts"
    assert "not set up" in scale_words(Axis())
    assert "encoder counts" in scale_words(Axis(unit=Unit.COUNT))


def test_the_serial_number_of_the_connected_controller_is_taken_with_one_click(qtbot: QtBot) -> None:
    page, taken = page_of(qtbot, True)
    assert not page.take_serial.isEnabled()
    page.show_connected(4711)
    QTest.mouseClick(page.take_serial, Qt.MouseButton.LeftButton)
    QTest.mouseClick(page.done_button, Qt.MouseButton.LeftButton)
    assert [setup.serial_number for setup, _ in taken] == ["4711"]


@pytest.mark.parametrize("serial", [None, 0])
def test_a_controller_without_a_serial_number_offers_none(qtbot: QtBot, serial: int | None) -> None:
    page, _ = page_of(qtbot, True)
    page.show_connected(serial)
    assert not page.take_serial.isEnabled()
    assert "No controller" in page.take_serial.toolTip()


@pytest.mark.parametrize("text", ["47a", "-5", "4.7", "٤٧"])
def test_a_serial_number_that_is_no_number_is_a_problem(qtbot: QtBot, text: str) -> None:
    page, _ = page_of(qtbot, True)
    page.serial.setText(text)
    assert "digits only" in page.problem.text()
    assert not page.done_button.isEnabled()
    page.serial.setText("")
    assert page.done_button.isEnabled()
