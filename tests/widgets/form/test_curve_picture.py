"""The curves of a cam and of a contour: what is drawn is the mathematics of the table; points are dragged."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot

from codegen.instructions import ContourMode, ElectronicCam
from codegen.numbers import parse_number
from tests.widgets.form.clipping import machine_offers, open_dialog, settle
from widgets.form.curve_picture import CurvePicture
from widgets.form.dialog import InstructionDialog


def opened(qtbot: QtBot, instruction: ContourMode | ElectronicCam) -> tuple[InstructionDialog, CurvePicture]:
    dialog = open_dialog(type(instruction), "ssc4", "empty")
    qtbot.addWidget(dialog)
    dialog.form.show_instruction(instruction)
    settle()
    assert isinstance(dialog.form.picture, CurvePicture)
    return dialog, dialog.form.picture


def drag(picture: CurvePicture, number: int, up: int) -> None:
    """Pulls a point of the first curve so many pixels up."""
    start = picture.point(0, number).toPoint()
    QTest.mousePress(picture, Qt.MouseButton.LeftButton, pos=start)
    for step in (up // 2, up):
        QTest.mouseMove(picture, start - QPoint(0, step))
        settle()
    QTest.mouseRelease(picture, Qt.MouseButton.LeftButton, pos=start - QPoint(0, up))
    settle()


def test_a_parabola_has_a_straight_speed_and_a_constant_acceleration(qtbot: QtBot) -> None:
    """y = x² at x = 0 … 5 in, at 1 in/s: speeds 1, 3, 5 … in/s, 2 in/s² between; at the seam it falls back."""
    table = "\n".join(str(n * n) for n in range(6))
    _, picture = opened(qtbot, ElectronicCam(cycle="5", table=table, slaves="Y"))
    ((at, position, speed, acceleration),) = picture.numbers
    assert at == [0, 1, 2, 3, 4, 5] and position == [0, 1, 4, 9, 16, 25]
    assert speed == [1, 3, 5, 7, 9]
    assert acceleration[1:-1] == [2, 2, 2, 2]
    picture.grab()


def test_the_rows_of_a_contour_are_steps_that_add_up(qtbot: QtBot) -> None:
    """The contour's steps of 0.012, 0.036, 0.06, 0.036, 0.012 in add up to 0.156 in."""
    _, picture = opened(qtbot, ContourMode.example())
    assert picture.numbers[0][1][-1] == pytest.approx(0.156)
    assert picture.numbers[0][0][-1] == pytest.approx(5 * 4 / 1.024)
    assert picture.words == "X 0 to 0.156 in, up to 15.36 in/s and 1573 in/s²"  # 0.06 in in 4 samples; less: in one row
    picture.grab()


def test_what_is_no_table_is_said(qtbot: QtBot) -> None:
    picture = CurvePicture(machine_offers("ssc4"))
    qtbot.addWidget(picture)
    for text in ("", "1", "1\n1,234;5", "a\nb"):
        picture.show_instruction(ElectronicCam(cycle="4", table=text))
        assert picture.words.endswith("once the table has rows of numbers.")
        picture.grab()


def test_a_dragged_point_is_the_new_position_and_no_other_moves(qtbot: QtBot) -> None:
    dialog, picture = opened(qtbot, ElectronicCam(cycle="4", table="0\n1\n2\n1\n0", slaves="Y"))
    high = picture.point(0, 0).y() - picture.point(0, 2).y()  # of 2 in, px
    drag(picture, 1, 30)
    texts = dialog.form.instruction.table.split("\n")  # type: ignore[attr-defined]
    assert [texts[0], *texts[2:]] == ["0", "2", "1", "0"]
    assert float(parse_number(texts[1]) or 0) == pytest.approx(1 + 30 / high * 2, abs=3 / high)
    editor = dialog.form.fields.cells["table", ""].editor
    assert editor.view.currentIndex().row() == 1
    QTest.keyClick(editor.view, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    assert dialog.form.instruction.table == "0\n1\n2\n1\n0"  # type: ignore[attr-defined]


def test_a_dragged_point_of_a_contour_keeps_the_others(qtbot: QtBot) -> None:
    dialog, picture = opened(qtbot, ContourMode(table="1\n1\n1"))
    drag(picture, 2, 20)
    steps = [float(parse_number(text) or 0) for text in dialog.form.instruction.table.split("\n")]  # type: ignore[attr-defined]
    assert steps[0] == 1 and sum(steps) == pytest.approx(3) and steps[1] > 1


def test_arrows_go_from_point_to_point_and_move_them(qtbot: QtBot) -> None:
    dialog, picture = opened(qtbot, ElectronicCam(cycle="4", table="0\n1\n2\n1\n0", slaves="Y"))
    picture.setFocus()
    picture.mark_row(-1)
    for key in (Qt.Key.Key_Right, Qt.Key.Key_Right, Qt.Key.Key_Up, Qt.Key.Key_Up):
        QTest.keyClick(picture, key)
    assert dialog.form.instruction.table == "0\n1.02\n2\n1\n0"  # type: ignore[attr-defined]
    assert picture.caption().startswith("Row 2, at X 1 in: Y 1.02 in.")


def test_the_wheel_zooms_and_a_double_click_fits(qtbot: QtBot) -> None:
    _, picture = opened(qtbot, ElectronicCam.example())
    before = picture.point(0, 3)
    picture.zoom_at(before, 2.0)
    assert picture.point(0, 3).x() == pytest.approx(before.x())
    assert picture.point(0, 4).x() > before.x() + 1
    away = QPointF(picture.width() - 4.0, picture.height() - 4.0).toPoint()
    QTest.mouseDClick(picture, Qt.MouseButton.LeftButton, pos=away)
    assert picture.zoom == 1.0
