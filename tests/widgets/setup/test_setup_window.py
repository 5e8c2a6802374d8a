"""The setup window by mouse and keys: every page edits the setup, says what is wrong, asks what to keep."""

from __future__ import annotations

import dataclasses as dc
from typing import Any

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QComboBox, QLineEdit
from pytestqt.qtbot import QtBot

from app.theme import Choice as Colours
from app.theme import Theme
from codegen.models import MODELS
from codegen.setup import Axis, EncoderType, MotorType, Setup, Unit
from codegen.setup_registers import REGISTERS, factory
from codegen.twoletter.fixed import ONE, scaled
from widgets.setup.comparing import Comparing
from widgets.setup.pages.axes import scale_words
from widgets.setup.pages.compare import Choice
from widgets.setup.window import Online, SetupWindow

SETUP = Setup(model="ssc2").with_axis("X", Axis(unit=Unit.INCH, counts_per_unit="637"))
SOME = Setup(model="ssc2", axes=(Axis(unit=Unit.MM, counts_per_unit="100"), Axis(unit=Unit.COUNT), Axis(), Axis()))
AFTER_RESET = {(each.command, letter): factory(each.command) for each in REGISTERS for letter in "XY"}


@pytest.fixture(scope="module", autouse=True)
def _theme(qapp: object) -> object:
    return Theme(qapp, Colours.LIGHT)  # type: ignore[arg-type]


def window_of(qtbot: QtBot, has_content: bool = False, setup: Setup = SETUP) -> tuple[SetupWindow, list[Any]]:
    window = SetupWindow(setup, has_content)
    qtbot.addWidget(window)
    taken: list[Any] = []
    window.finished_setup.connect(lambda *finished: taken.append(finished))
    window.show()
    return window, taken


def fill(line: QLineEdit, text: str) -> None:
    """As a person types it."""
    assert line.isVisible() and line.isEnabled(), line.accessibleName()
    QTest.mouseClick(line, Qt.MouseButton.LeftButton)
    line.selectAll()
    QTest.keyClick(line, Qt.Key.Key_Delete)
    QTest.keyClicks(line, text)


def choose(box: QComboBox, data: object) -> None:
    """With the arrow keys."""
    assert box.isVisible(), box.accessibleName()
    wanted = box.findData(data) if box.findData(data) >= 0 else box.keys.index(data)  # type: ignore[attr-defined]
    QTest.keyClick(box, Qt.Key.Key_Home)
    for _ in range(wanted):
        QTest.keyClick(box, Qt.Key.Key_Down)
    held = box.currentData() if box.currentData() is not None else box.value()  # type: ignore[attr-defined]
    assert held == data


def click(button: Any) -> None:
    assert button.isVisible() and button.isEnabled(), button.toolTip()
    QTest.mouseClick(button, Qt.MouseButton.LeftButton)


# ------------------------------------------------------------------------ pages


def test_what_is_shown_unchanged_is_the_same_setup(qtbot: QtBot) -> None:
    window, taken = window_of(qtbot, True)
    for page in window.pages:
        window.open_page(page)
    assert window.setup == SETUP
    click(window.done_button)
    assert taken == [(SETUP, "units", frozenset())]


def test_the_keys_walk_through_all_pages(qtbot: QtBot) -> None:
    window, _ = window_of(qtbot)
    for page in window.pages:
        assert window.stack.currentWidget() is page
        QTest.keyClick(window.list, Qt.Key.Key_Down)


def test_every_model_is_offered_and_shows_its_axes(qtbot: QtBot) -> None:
    window, _ = window_of(qtbot)
    for name, model in MODELS.items():
        window.open_page(window.controller)
        choose(window.controller.model, name)
        assert window.setup.model == name
        window.open_page(window.axes)
        assert "".join(letter for letter, row in window.axes.rows.items() if row.isVisible()) == model.axes
        assert window.axes.motors.letters == model.axes


def test_the_type_plate_is_explained_and_used(qtbot: QtBot) -> None:
    """ssc-tol-o-motion.txt l.760: SSC47 with 3600-0247 is servo, servo, servo, stepper."""
    window, _ = window_of(qtbot)
    fill(window.controller.plate, "3600-0247")
    assert "SSC47" in window.controller.plate_words.text() and "W a stepper" in window.controller.plate_words.text()
    click(window.controller.use_plate)
    assert window.setup.model == "ssc4"
    assert [window.setup.axis(letter).is_stepper for letter in "XYZW"] == [False, False, False, True]
    assert not window.controller.use_plate.isEnabled()
    fill(window.controller.plate, "SSC99")
    assert "SSC10 to SSC48" in window.problem.text() and not window.done_button.isEnabled()


def test_unit_scale_and_own_unit(qtbot: QtBot) -> None:
    window, _ = window_of(qtbot)
    window.open_page(window.axes)
    row = window.axes.rows["Y"]
    assert "not set up" in row.words.text() and not row.own.isVisible()
    choose(row.unit, Unit.OWN)
    fill(row.own, "turns")
    fill(row.scale, "4000/3")
    assert window.setup.axis("Y") == Axis(unit=Unit.OWN, unit_name="turns", counts_per_unit="4000/3")
    assert row.words.text() == "1 turns = 4000/3 counts = 1333.33333… (exact as a quotient)"
    choose(row.unit, Unit.COUNT)
    assert not row.scale.isEnabled() and row.words.text() == "positions are encoder counts"
    assert scale_words(Axis(counts_per_unit="637")) == "1 in = 637 counts"


@pytest.mark.parametrize("text", ["12,5", "abc", "0", "-3", "5/0"])
def test_nonsense_in_the_scale_is_said_and_not_taken(qtbot: QtBot, text: str) -> None:
    window, _ = window_of(qtbot, True)
    window.open_page(window.axes)
    fill(window.axes.rows["X"].scale, text)
    assert window.axes.rows["X"].words.text().startswith("! ")
    assert "Counts per unit" in window.problem.text()
    assert not window.done_button.isEnabled()
    fill(window.axes.rows["X"].scale, "12.5")
    assert window.done_button.isEnabled() and not window.problem.isVisible()


def test_the_calculator_writes_the_scale(qtbot: QtBot) -> None:
    """A screw of 5 mm with 1000 lines behind a gear of 3:1: 4000 × 3 / 5 = 2400 counts a millimetre."""
    window, _ = window_of(qtbot, setup=SOME)
    window.open_page(window.axes)
    click(window.axes.rows["X"].work_out)
    calculator = window.axes.calculator
    assert calculator is not None and calculator.isVisible() and not calculator.take.isEnabled()
    cells = calculator.form.cells
    fill(cells["pitch", ""].editor, "5")
    fill(cells["motor_turns", ""].editor, "3")
    assert calculator.answer.text() == "1 mm = 2400 counts" and "Exact." in calculator.words.text()
    fill(cells["pitch", ""].editor, "7")
    assert calculator.answer.text() == "1 mm = 12000/7 = 1714.28571… counts"
    assert "rounded" in calculator.words.text()
    click(calculator.take)
    assert window.setup.axis("X").counts_per_unit == "12000/7"
    assert window.axes.rows["X"].scale.text() == "12000/7"


def test_servo_and_stepper_pages_show_their_axes(qtbot: QtBot) -> None:
    window, _ = window_of(qtbot, setup=SOME)
    window.open_page(window.stepper)
    assert "No axis has a stepper" in window.stepper.none.text() and not window.stepper.grid.isVisible()
    window.open_page(window.servo)
    fill(window.servo.grid.cells["smoothing", "Y"].editor, "200")
    window.open_page(window.axes)
    choose(window.axes.motors.cells["motor", "Y"].editor, MotorType.STEPPER_LOW)
    assert window.setup.axis("Y").smoothing == ""  # 200 means nothing to a stepper
    window.open_page(window.stepper)
    assert window.stepper.grid.letters == "Y"
    fill(window.stepper.grid.cells["smoothing", "Y"].editor, "9")
    assert "between 0.5 and 8" in window.problem.text()  # dmc-1412-1414.txt l.810
    fill(window.stepper.grid.cells["smoothing", "Y"].editor, "2")
    assert window.done_button.isEnabled() and window.setup.axis("Y").smoothing == "2"


def test_gains_and_encoders_with_what_is_really_sent(qtbot: QtBot) -> None:
    window, _ = window_of(qtbot, setup=SOME)
    window.open_page(window.servo)
    cells = window.servo.grid.cells
    fill(cells["kp", "X"].editor, "12.3")
    assert cells["kp", "X"].counts.text() == "12.25"  # steps of 0.125
    choose(cells["main_encoder", "X"].editor, EncoderType.PULSE)
    assert (window.setup.axis("X").kp, window.setup.axis("X").main_encoder) == ("12.3", EncoderType.PULSE)
    fill(cells["kp", "X"].editor, "1024")
    assert "1023.875" in cells["kp", "X"].problem.text() and not window.done_button.isEnabled()


def test_limits_show_units_counts_and_amber_words(qtbot: QtBot) -> None:
    window, _ = window_of(qtbot, setup=SOME)
    window.open_page(window.limits)
    page, cells = window.limits, window.limits.grid.cells
    assert "X: no travel limits" in page.amber.text()
    assert "X: following error at its default: 16384 counts = 163.84 mm" in page.amber.text()
    fill(cells["forward_limit", "X"].editor, "10.019")
    assert (cells["forward_limit", "X"].unit.text(), cells["forward_limit", "X"].counts.text()) == ("mm", "1001 counts")
    assert "X: no reverse travel limit (BL)" in page.amber.text()
    fill(cells["reverse_limit", "X"].editor, "-1")
    fill(cells["error_limit", "X"].editor, "2")
    assert "X:" not in page.amber.text()
    QTest.mouseClick(
        cells["off_on_error", "X"].editor,
        Qt.MouseButton.LeftButton,
        pos=cells["off_on_error", "X"].editor.rect().center() / 4,
    )
    if window.setup.axis("X").off_on_error:  # where the style puts the box
        QTest.keyClick(cells["off_on_error", "X"].editor, Qt.Key.Key_Space)
    assert "X: OE 0" in page.amber.text()
    fill(cells["reverse_limit", "X"].editor, "11")
    assert "must lie below the forward limit" in window.problem.text()


def test_a_speed_that_the_controller_can_not_do_is_refused_with_the_reason(qtbot: QtBot) -> None:
    """An encoder of 100 counts/mm and at most 8,000,000 counts/s make 80 000 mm/s (models.json)."""
    window, _ = window_of(qtbot, setup=SOME)
    window.open_page(window.limits)
    cell = window.limits.grid.cells["maximum_speed", "X"]
    fill(cell.editor, "80001")
    assert "between 0 and 80000 mm/s" in cell.problem.text().replace("\N{WORD JOINER}", "")
    fill(cell.editor, "80000")
    assert not cell.problem.isVisible()


def test_names_and_notes(qtbot: QtBot) -> None:
    window, taken = window_of(qtbot, True)
    window.open_page(window.names)
    fill(window.names.inputs.lines[0], "Start")
    fill(window.names.outputs.lines[7], "Lamp")
    fill(window.names.inputs.lines[1], "Start")
    assert "used twice" in window.problem.text() and not window.done_button.isEnabled()
    fill(window.names.inputs.lines[1], "Door")
    window.open_page(window.notes)
    QTest.keyClicks(window.notes.text, "new belt in May")
    click(window.done_button)
    ((setup, _, _),) = taken
    assert setup.input_names[:2] == ("Start", "Door") and setup.output_names[7] == "Lamp"
    assert setup.notes == "new belt in May"


def test_a_controller_with_fewer_outputs_shows_fewer(qtbot: QtBot) -> None:
    window, _ = window_of(qtbot, setup=Setup(model="dmc1412", output_names=("",) * 7 + ("Kept",)))
    window.open_page(window.names)
    assert [line.isVisible() for line in window.names.outputs.lines].count(True) == 3
    assert [line.isVisible() for line in window.names.inputs.lines].count(True) == 7
    assert window.setup.output_names[7] == "Kept"


# --------------------------------------------------------------- scale and serial


def test_a_new_scale_in_an_empty_program_is_taken_at_once(qtbot: QtBot) -> None:
    window, taken = window_of(qtbot)
    window.open_page(window.axes)
    fill(window.axes.rows["X"].scale, "1000")
    click(window.done_button)
    assert [(setup.axis("X").counts_per_unit, keep) for setup, keep, _ in taken] == [("1000", "units")]


def test_another_unit_of_length_keeps_the_mechanics_and_asks_about_limits_too(qtbot: QtBot) -> None:
    """637 counts an inch are 637/25.4 = 3185/127 counts a millimetre; a limit of 20 in is not 20 mm in silence."""
    setup = SETUP.with_axis("X", dc.replace(SETUP.axis("X"), forward_limit="20"))
    window, taken = window_of(qtbot, setup=setup)
    window.open_page(window.axes)
    choose(window.axes.rows["X"].unit, Unit.MM)
    assert window.setup.axis("X").counts_per_unit == "3185/127"
    click(window.done_button)
    assert taken == [] and "the limits already hold positions" in window.asks.text()
    assert "10 in becomes 10 mm" in window.asks.text()
    choose(window.axes.rows["X"].unit, Unit.INCH)
    assert window.setup == setup and not window.question.isVisible()  # there and back


@pytest.mark.parametrize("keep", ["units", "counts"])
def test_a_new_scale_under_a_program_asks_what_to_keep(qtbot: QtBot, keep: str) -> None:
    window, taken = window_of(qtbot, True)
    window.open_page(window.axes)
    fill(window.axes.rows["X"].scale, "1000")
    click(window.done_button)
    assert taken == [] and window.question.isVisible()
    click(window.keep_units if keep == "units" else window.keep_counts)
    assert [each for _, each, _ in taken] == [keep]


def test_the_serial_number_of_what_is_connected_is_taken_over(qtbot: QtBot) -> None:
    window, taken = window_of(qtbot)
    assert not window.controller.take_serial.isEnabled()
    assert "No controller" in window.controller.take_serial.toolTip()
    window.show_online(Online("", "", 4711))
    click(window.controller.take_serial)
    click(window.done_button)
    assert taken[0][0].serial_number == "4711"


@pytest.mark.parametrize("text", ["47a", "-5", "4.7", "٤٧"])
def test_a_serial_number_that_is_no_number_is_a_problem(qtbot: QtBot, text: str) -> None:
    window, _ = window_of(qtbot)
    window.controller.serial.setFocus()
    window.controller.serial.insert(text)
    window.controller.serial.textEdited.emit(text)
    assert "digits only" in window.problem.text()
    assert not window.done_button.isEnabled()


# ------------------------------------------------------------------- comparing


def readings(**values: float) -> dict[tuple[str, str], int]:
    """What a reset leaves, with some values of X changed."""
    return {**AFTER_RESET, **{(name, "X"): scaled(value) for name, value in values.items()}}


def test_what_differs_is_listed_and_marked(qtbot: QtBot) -> None:
    window, _ = window_of(qtbot, setup=SOME)
    window.show_readings(readings(KP=12.5, FL=2500), "Read from a test.")
    assert window.stack.currentWidget() is window.compare
    rows = {(row.command, row.axis): row for row in window.comparing.rows(window.setup)}
    assert set(rows) == {("OE", "X"), ("OE", "Y"), ("KP", "X"), ("FL", "X")}
    table = window.compare.table
    told = [[table.item(row, column).text() for column in range(4)] for row in range(table.rowCount())]
    assert ["X", "Forward software limit (FL)", "not set", "25 mm (FL 2500)"] in told
    window.open_page(window.limits)
    assert window.limits.grid.cells["forward_limit", "X"].problem.text() == "△ controller: 25 mm"
    assert "(4)" in window.list.item(7).text()


def test_one_value_is_taken_another_is_sent_and_both_can_be_given_back(qtbot: QtBot) -> None:
    window, taken = window_of(qtbot, setup=SOME)
    window.show_readings(readings(KP=12.5), "")
    choose(window.compare.boxes["KP", "X"], Choice.TAKE)
    choose(window.compare.boxes["OE", "X"], Choice.SEND)
    assert window.setup.axis("X").kp == "12.5"
    assert window.comparing.to_send(window.setup) == {("OE", "X")}
    choose(window.compare.boxes["KP", "X"], Choice.LEAVE)
    assert window.setup.axis("X").kp == ""
    click(window.done_button)
    assert taken == [(SOME, "units", frozenset({("OE", "X")}))]


def test_all_of_one_side(qtbot: QtBot) -> None:
    window, _ = window_of(qtbot, setup=SOME)
    window.show_readings(readings(KP=12.5, MT=-1), "")
    click(window.compare.take_all)
    axis = window.setup.axis("X")
    assert (axis.kp, axis.motor, axis.off_on_error) == ("12.5", MotorType.SERVO_REVERSED, False)
    assert window.comparing.to_send(window.setup) == frozenset()
    click(window.compare.send_all)
    assert window.setup.axis("X").motor is MotorType.SERVO
    assert window.comparing.to_send(window.setup) == {("MT", "X"), ("OE", "X"), ("OE", "Y")}  # KP states nothing
    click(window.compare.leave_all)
    assert window.setup == SOME and window.comparing.to_send(window.setup) == frozenset()


def test_what_is_typed_beside_a_controller_that_was_read_is_to_be_sent(qtbot: QtBot) -> None:
    window, _ = window_of(qtbot, setup=SOME)
    window.show_readings(readings(), "")
    window.open_page(window.servo)
    fill(window.servo.grid.cells["kd", "X"].editor, "80")
    assert window.comparing.to_send(window.setup) == {("KD", "X")}
    assert "sends 1 value" in window.done_button.toolTip()
    fill(window.servo.grid.cells["kd", "X"].editor, "64")  # as it is there (64 after a reset)
    assert window.comparing.to_send(window.setup) == frozenset()


def test_another_controller_forgets_what_was_read(qtbot: QtBot) -> None:
    window, _ = window_of(qtbot, setup=SOME)
    window.show_readings(readings(KP=12.5), "")
    window.forget_readings()
    assert "Nothing was read" in window.compare.said.text() and not window.compare.table.isVisible()
    assert window.list.item(7).text() == "Controller values"


def test_gn_is_shown_and_not_edited(qtbot: QtBot) -> None:
    """ssc-tol-o-motion.txt l.1585: not used for current version of controller."""
    window, _ = window_of(qtbot, setup=SOME)
    window.show_readings({**readings(KP=7), ("GN", "X"): 70 * ONE}, "")
    window.open_page(window.servo)
    assert "not used by the present version" in window.servo.gain.text() and "X 70" in window.servo.gain.text()
    assert not [name for name, _ in window.servo.grid.cells if name == "gn"]


def test_taking_the_motor_first_makes_the_rest_fit() -> None:
    """A controller with a stepper on X: its smoothing is taken as that of a stepper."""
    held = readings(MT=2, KS=4)
    comparing = Comparing.of(SOME, held)
    comparing, setup = comparing.choose_all(SOME, Choice.TAKE)
    assert setup.axis("X").motor is MotorType.STEPPER_LOW
    comparing = comparing.edited(SOME, dc.replace(setup))
    assert ("KS", "X") in comparing.keys
