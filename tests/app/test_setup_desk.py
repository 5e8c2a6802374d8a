"""The setup from menu to controller: document and Undo, files, reading, sending, burning; all by mouse and keys."""

from __future__ import annotations

import dataclasses as dc
from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QAbstractButton, QComboBox, QFileDialog, QLineEdit
from shiboken6 import isValid

import resources
from app.help_pages import Pages
from app.setup_file import DEFAULT
from codegen.files import load, load_setup, save_setup
from codegen.generate import generate
from codegen.setup import Axis, Setup, Unit
from codegen.twoletter.fixed import ONE
from tests.rig import Rig
from tests.stage import Stage, make_studio
from widgets.help.topic import topic_of
from widgets.parts.question import Question
from widgets.setup.pages.compare import Choice
from widgets.setup.window import SetupWindow


def opened(stage: Stage) -> SetupWindow:
    """Setup… in the menu."""
    stage.studio.actions["setup"].trigger()
    stage.go()
    window = stage.studio.setup.window
    assert window is not None and window.isVisible()
    return window


def click(stage: Stage, button: QAbstractButton, ticks: int = 3) -> None:
    assert button.isVisible() and button.isEnabled(), f"{button.text()}: {button.toolTip()}"
    QTest.mouseClick(button, Qt.MouseButton.LeftButton)
    stage.go(ticks)


def fill(line: QLineEdit, text: str) -> None:
    assert line.isVisible() and line.isEnabled(), line.accessibleName()
    line.setFocus()
    line.selectAll()
    QTest.keyClick(line, Qt.Key.Key_Delete)
    QTest.keyClicks(line, text)


def choose(box: QComboBox, choice: Choice) -> None:
    QTest.keyClick(box, Qt.Key.Key_Home)
    for _ in range(box.findData(choice)):
        QTest.keyClick(box, Qt.Key.Key_Down)
    assert box.currentData() == choice


def asked(stage: Stage, title: str) -> Question:
    """The question that stands there."""

    def there() -> bool:
        question = stage.studio.desk.question
        return question is not None and isValid(question) and question.windowTitle() == title

    stage.until(there)
    question = stage.studio.desk.question
    assert question is not None and question.isVisible()
    return question


def machine(stage: Stage, control: bool = True, **more: str) -> Rig:
    """The controller of the open program's setup: a wire cutter of two axes."""
    session = stage.studio.session
    session.set_setup(dc.replace(session.document.setup, model="ssc2"))
    rig = stage.connect("machine", "ssc2", **more)
    if control:
        rig.controller.take_control()
    stage.go()
    return rig


def compared(stage: Stage) -> SetupWindow:
    """The window with what the controller holds beside the setup: it is read when the window opens."""
    window = opened(stage)
    stage.until(lambda: bool(window.comparing.readings))
    assert window.stack.currentWidget() is window.controller
    assert f"({len(window.comparing.keys)})" in window.list.item(7).text()
    QTest.mouseClick(window.list.viewport(), Qt.MouseButton.LeftButton, pos=_place(window, 7))
    stage.go()
    assert window.compare.isVisible()
    return window


def _place(window: SetupWindow, row: int) -> QPoint:
    return window.list.visualItemRect(window.list.item(row)).center()


def register(rig: Rig, name: str, place: int = 0) -> float:
    return rig.simulation.unit.state.registers[name][place] / ONE


def kept(stage: Stage) -> Setup:
    return stage.studio.session.document.setup


# ------------------------------------------------------------------- offline


def test_done_changes_the_document_in_one_step_that_undo_takes_back(stage: Stage) -> None:
    before = stage.studio.session.document
    window = opened(stage)
    window.open_page(window.axes)
    fill(window.axes.rows["X"].scale, "1274")  # twice the wire cutter's 637
    window.open_page(window.limits)
    fill(window.limits.grid.cells["forward_limit", "X"].editor, "20")
    click(stage, window.done_button)
    click(stage, window.keep_counts)
    assert not window.isVisible()
    now = stage.studio.session.document
    assert now.setup.axis("X").counts_per_unit == "1274" and now.program != before.program
    assert generate(now).text == generate(before).text  # the machine moves as before
    stage.studio.session.undo()
    assert stage.studio.session.document == before


def test_offline_cancel_changes_nothing_and_the_controllers_buttons_say_why_they_are_grey(
    stage: Stage, tmp_path: Path
) -> None:
    before = stage.studio.session.document
    window = opened(stage)
    assert not window.stop.isVisible()
    for button in (window.read, window.burn):
        assert not button.isEnabled() and "Connect a controller" in button.toolTip()
    fill(window.controller.name, "Other")
    click(stage, window.cancel)
    assert stage.studio.session.document is before and not (tmp_path / DEFAULT).exists()


def test_the_setup_finished_last_is_the_default_of_a_new_program(stage: Stage, tmp_path: Path) -> None:
    window = opened(stage)
    fill(window.controller.name, "My machine")
    click(stage, window.done_button)
    stage.studio.session.open_copy(resources.path("examples/wire-cutter.tlp"))  # another machine's setup
    assert kept(stage).name != "My machine"
    stage.studio.actions["new"].trigger()
    assert kept(stage).name == "My machine"
    again = make_studio(tmp_path, example="")
    assert again.studio.session.document.setup.name == "My machine"
    again.clear_away()


@pytest.mark.long
def test_a_damaged_default_is_no_obstacle(tmp_path: Path, qtbot: object) -> None:
    (tmp_path / DEFAULT).write_text("{", encoding="utf-8")
    again = make_studio(tmp_path, example="")
    assert again.studio.session.document.setup == Setup()
    again.clear_away()


# --------------------------------------------------------------------- files


def name_file(stage: Stage, path: Path) -> None:
    """Types the name into the file window."""
    window = stage.studio.setup.window
    assert window is not None
    dialog = window.findChildren(QFileDialog)[-1]
    line = dialog.findChild(QLineEdit)
    assert line is not None
    line.setText(str(path))
    QTest.keyClick(line, Qt.Key.Key_Return)
    stage.until(lambda: not isValid(dialog) or not dialog.isVisible())
    stage.go()


def test_saved_named_in_the_title_and_never_over_what_somebody_else_saved(stage: Stage, tmp_path: Path) -> None:
    window = opened(stage)
    assert "not saved in a file" in window.windowTitle()
    fill(window.controller.name, "Press 7")
    click(stage, window.file_buttons["Save"][0])
    name_file(stage, tmp_path / "press.tls")
    assert load_setup(tmp_path / "press.tls").name == "Press 7"
    assert window.windowTitle() == "Setup – press.tls"
    fill(window.controller.name, "Press 8")
    assert window.windowTitle() == "Setup – press.tls*"
    click(stage, window.file_buttons["Save"][0])
    assert load_setup(tmp_path / "press.tls").name == "Press 8" and window.windowTitle() == "Setup – press.tls"
    path = tmp_path / "press.tls"
    save_setup(path, Setup(name="Somebody else"))
    fill(window.controller.name, "Mine")
    click(stage, window.file_buttons["Save"][0])
    question = asked(stage, "Somebody else changed this file")
    assert load_setup(path).name == "Somebody else"
    click(stage, question.buttons["Overwrite it"])
    assert load_setup(path).name == "Mine"


@pytest.mark.long
def test_a_file_is_opened_into_the_window_and_reaches_the_program_with_done(stage: Stage, tmp_path: Path) -> None:
    setup = Setup(name="Table", model="ssc2").with_axis("Y", Axis(unit=Unit.MM, counts_per_unit="4000/3", kp="9"))
    save_setup(tmp_path / "table.tls", setup)
    window = opened(stage)
    click(stage, window.file_buttons["Open"][0])
    name_file(stage, tmp_path / "table.tls")
    assert window.setup == setup and window.windowTitle() == "Setup – table.tls"
    click(stage, window.done_button)
    click(stage, window.keep_units)
    assert kept(stage) == setup
    path = tmp_path / "with-setup.tlp"
    stage.studio.session.save_as(path)
    assert load(path).setup == setup  # the same data is in the program's own file


def test_a_file_that_is_none_changes_nothing_and_new_asks_before_it_throws_away(stage: Stage, tmp_path: Path) -> None:
    window = opened(stage)
    before = window.setup
    for text in (b"{", b'{"format": "twoletter setup", "version": 99}', b"\x00\xff"):
        (tmp_path / "bad.tls").write_bytes(text)
        stage.studio.setup.file.open_path(tmp_path / "bad.tls")
        question = asked(stage, "The setup cannot be opened")
        assert "\n" not in question.words and question.words.endswith(".") and window.setup == before
        click(stage, question.findChildren(QAbstractButton)[0])
    fill(window.controller.name, "Half done")
    click(stage, window.file_buttons["New"][0])
    question = asked(stage, "Leave this setup?")
    assert window.setup.name == "Half done"
    click(stage, question.buttons["Leave it"])
    assert window.setup == Setup()


# -------------------------------------------------------------------- online


def test_in_watch_the_controller_is_read_and_its_values_are_taken_and_nothing_else_leaves(stage: Stage) -> None:
    rig = machine(stage, control=False)
    rig.simulation.unit.state.registers["KP"][0] = int(12.5 * ONE)
    before = len(rig.lines)
    window = compared(stage)
    assert "SSC, two axes" in window.compare.said.text()
    rig.simulation.unit.state.registers["KD"][0] = 80 * ONE
    click(stage, window.read)
    stage.until(lambda: ("KD", "X") in window.comparing.keys)  # read once more
    assert not window.burn.isEnabled() and "This is Watch" in window.burn.toolTip()
    choose(window.compare.boxes["KP", "X"], Choice.TAKE)
    click(stage, window.done_button)
    assert kept(stage).axis("X").kp == "12.5" and not window.isVisible()
    assert not [line for line in rig.lines[before:] if line and not line.startswith("MG")]


def test_what_was_chosen_is_sent_after_its_risks_were_told(stage: Stage) -> None:
    rig = machine(stage)
    window = compared(stage)
    window.open_page(window.servo)
    fill(window.servo.grid.cells["kp", "X"].editor, "20")
    window.open_page(window.compare)
    choose(window.compare.boxes["OE", "X"], Choice.SEND)
    click(stage, window.done_button)
    question = asked(stage, "Send the setup to the controller?")
    assert "Proportional of X: 20" in question.words and "oscillate" in question.words
    assert "Nothing is burned" in question.words
    assert register(rig, "KP") == 6  # nothing has left yet
    click(stage, question.buttons["Send and finish"])
    stage.until(lambda: register(rig, "KP") == 20 and register(rig, "OE") == 1)
    assert register(rig, "OE", 1) == 0  # not chosen
    assert kept(stage).axis("X").kp == "20" and not window.isVisible()
    stage.until(lambda: stage.studio.messages.texts()[-1] == "2 values sent and read back; nothing is burned.")
    assert "BN" not in " ".join(rig.lines).replace("_BN", "")


def test_in_watch_what_was_chosen_is_kept_not_sent_and_a_lost_connection_forgets_what_was_read(stage: Stage) -> None:
    rig = machine(stage, control=False)
    window = compared(stage)
    click(stage, window.compare.send_all)
    click(stage, window.done_button)
    question = asked(stage, "Not sent to the controller")
    assert "This is Watch" in question.words and set(question.buttons) == {"Keep it without sending"}
    click(stage, question.buttons["Keep it without sending"])
    assert register(rig, "OE") == 0 and not window.isVisible()
    again = compared(stage)
    stage.studio.connection.go_offline()
    stage.go()
    assert not again.comparing.readings and not again.read.isEnabled()  # another one, or none


def test_a_motor_type_goes_with_the_motor_off_and_nothing_while_an_axis_moves(stage: Stage) -> None:
    rig = machine(stage)
    rig.type("MT ,-1")
    window = compared(stage)
    choose(window.compare.boxes["MT", "Y"], Choice.SEND)
    click(stage, window.done_button)
    question = asked(stage, "Send the setup to the controller?")
    assert "The motor of Y is switched off first and stays off; a vertical axis may fall." in question.words
    rig.type("JG 2000", "BG X")
    click(stage, question.buttons["Send and finish"])
    assert "an axis is moving" in asked(stage, "The setup was not sent").words
    assert register(rig, "MT", 1) == -1 and not rig.sent("MO")
    again = opened(stage)
    assert again.stop.isVisible() and again.stop.words[1].startswith("MACHINE")
    QTest.mousePress(again.stop, Qt.MouseButton.LeftButton)
    stage.until(lambda: rig.moving == [])
    QTest.mouseRelease(again.stop, Qt.MouseButton.LeftButton)


@pytest.mark.long
def test_another_serial_number_is_asked_about_before_anything_is_sent(stage: Stage) -> None:
    rig = machine(stage)
    window = compared(stage)
    window.open_page(window.controller)
    fill(window.controller.serial, "4712")
    window.open_page(window.compare)
    click(stage, window.compare.send_all)
    click(stage, window.done_button)
    click(stage, asked(stage, "Send the setup to the controller?").buttons["Send and finish"])
    question = asked(stage, "Is this the right machine?")
    assert "4712" in question.words and register(rig, "OE") == 0


@pytest.mark.long
def test_another_model_is_offered_as_the_setups(stage: Stage) -> None:
    stage.connect("machine", "ssc3").controller.take_control()
    stage.go()
    window = opened(stage)
    click(stage, window.read)
    question = asked(stage, "Another controller")
    assert "SSC, three axes" in question.words and not window.comparing.readings
    click(stage, question.buttons["Make it a setup for SSC, three axes"])
    assert window.setup.model == "ssc3" and window.comparing.readings


def test_write_to_eeprom_says_what_the_next_power_up_does_and_burns_then(stage: Stage) -> None:
    rig = machine(stage)
    rig.type("KP 33", "MO Y")
    window = opened(stage)
    click(stage, window.burn)
    question = asked(stage, "Write to EEPROM?")
    assert "the motor of X is switched on by itself" in question.words
    assert "the motor of Y stays off" in question.words and "not in the controller" in question.words
    assert rig.simulation.unit.eeprom.part("parameters") is None
    click(stage, question.buttons["Write to EEPROM"])
    stage.until(lambda: rig.simulation.unit.eeprom.part("parameters") is not None)
    assert rig.simulation.unit.eeprom.part("parameters")["registers"]["KP"][0] == 33 * ONE
    stage.until(lambda: "after the next power-up" in stage.studio.messages.texts()[-1])
    assert window.isVisible()


# ---------------------------------------------------------------------- help


def test_every_page_has_its_own_help(stage: Stage) -> None:
    window = opened(stage)
    pages = Pages()
    for page in window.pages:
        window.open_page(page)
        assert topic_of(page.inside) == page.help_page and page.help_page in pages, page.title
        assert len(pages[page.help_page]) > 200
    window.open_page(window.limits)
    window.limits.grid.cells["forward_limit", "X"].editor.setFocus()
    stage.studio.actions["help"].trigger()
    stage.go()
    assert stage.studio.desk.help is not None and stage.studio.desk.help.isVisible()
