"""The curves of a cam and of a contour: what is drawn is the mathematics of the table."""

from __future__ import annotations

import pytest
from pytestqt.qtbot import QtBot

from codegen.instructions import ContourMode, ElectronicCam
from tests.widgets.form.clipping import machine_offers, open_dialog, settle
from widgets.form.curve_picture import CurvePicture, curves


def test_a_parabola_has_a_straight_speed_and_a_constant_acceleration() -> None:
    position, speed, acceleration = curves([float(n * n) for n in range(6)], steps=False)
    assert position == (0, 1, 4, 9, 16, 25)
    assert speed == (1, 3, 5, 7, 9)
    assert acceleration == (2, 2, 2, 2)


def test_the_rows_of_a_contour_are_steps_that_add_up() -> None:
    assert curves([1.0, 2.0, 1.0], steps=True)[0] == (0, 1, 3, 4)
    assert curves([1.0, 2.0, 1.0], steps=True)[1] == (1, 2, 1)


@pytest.mark.parametrize(("kind", "last"), [(ElectronicCam, None), (ContourMode, 0.156)])
def test_the_dialog_draws_the_example(
    qtbot: QtBot, kind: type[ElectronicCam | ContourMode], last: float | None
) -> None:
    """The contour's steps of 0.012, 0.036, 0.06, 0.036, 0.012 in add up to 0.156 in."""
    dialog = open_dialog(kind, "ssc4", "example")
    qtbot.addWidget(dialog)
    settle()
    picture = dialog.form.picture
    assert isinstance(picture, CurvePicture)
    assert picture.isVisible()
    ((letter, lanes),) = picture.found.items()
    assert letter in "XYZW"
    if last is not None:
        assert lanes[0][-1] == pytest.approx(last)
    picture.grab()


def test_what_is_no_table_is_said(qtbot: QtBot) -> None:
    picture = CurvePicture(machine_offers("ssc4"))
    qtbot.addWidget(picture)
    for text in ("", "1", "1\n1,234;5", "a\nb"):
        picture.show_instruction(ElectronicCam(table=text))
        assert picture.words.endswith("once the table has two rows of numbers")
        picture.grab()
