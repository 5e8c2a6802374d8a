"""The picture of a path: its form, its end, its corners, and what it says where it cannot draw."""

from __future__ import annotations

import dataclasses as dc

import pytest
from PySide6.QtGui import QImage
from pytestqt.qtbot import QtBot

from codegen.instructions import ALL, CircularPath, LinearPath
from codegen.instructions.path_parts import Piece, Shape, Stretch
from tests.widgets.form.clipping import machine_offers, open_dialog, settle
from widgets.form.path_picture import PathPicture
from widgets.parts.look import look


@pytest.fixture
def picture(qtbot: QtBot) -> PathPicture:
    """Of the machine with two axes in inches."""
    made = PathPicture(machine_offers("ssc4"))
    qtbot.addWidget(made)
    made.resize(320, 200)
    made.show()
    return made


def line(x: str, y: str) -> Piece:
    return Piece(to=(x, y, "", ""))


def drawn(image: QImage) -> tuple[int, int, int, int]:
    """Left, top, right, bottom of what is painted in the colour of the path."""
    wanted = look().colour("accent").rgb()
    points = [
        (x, y) for x in range(image.width()) for y in range(image.height()) if image.pixelColor(x, y).rgb() == wanted
    ]
    return (
        min(x for x, _ in points), min(y for _, y in points), max(x for x, _ in points), max(y for _, y in points)
    )  # fmt: skip


def test_a_half_circle_is_as_wide_as_the_line_and_its_radius(picture: PathPicture) -> None:
    """3 in, half a circle of 1 in to the right, back: 4 in wide, 2 in high; it ends above its start."""
    picture.show_instruction(CircularPath.example())
    left, top, right, bottom = drawn(picture.grab().toImage())
    assert (right - left) / (bottom - top) == pytest.approx(2, rel=0.1)
    assert picture.words == "ends at X 0 in, Y 2 in from its start"


def test_a_corner_is_told_with_its_angle(picture: PathPicture) -> None:
    picture.show_instruction(CircularPath(segments=(line("3", "0"), line("3", "2"))))
    assert picture.words.endswith("corners at the start of segment 2: 90°")
    arc = Piece(shape=Shape.ARC, radius="1", start="-90", sweep="90")  # begins along the line
    picture.show_instruction(CircularPath(segments=(line("3", "0"), arc)))
    assert "corner" not in picture.words


def test_what_only_the_running_program_knows_is_not_drawn(picture: PathPicture) -> None:
    picture.show_instruction(CircularPath(segments=(line("3", "0"), line("LEN", "2"))))
    assert picture.words.startswith("segments 1 to 1: ends at X 3 in, Y 0 in")
    picture.show_instruction(LinearPath(axes="XYZ", segments=(Stretch(to=("1", "1", "1", "")),)))
    assert picture.words == "Two axes and plain numbers are drawn here"
    picture.grab()


def test_a_mirrored_axis_points_the_other_way(picture: PathPicture, qtbot: QtBot) -> None:
    offers = machine_offers("ssc4")
    axis = dc.replace(offers.setup.axis("X"), mirrored=True)
    other = PathPicture(dc.replace(offers, setup=offers.setup.with_axis("X", axis)))
    qtbot.addWidget(other)
    other.resize(320, 200)
    path = CircularPath(segments=(line("3", "0"), line("3", "2")))
    for each in (picture, other):
        each.show_instruction(path)
    plain, turned = picture.grab().toImage(), other.grab().toImage()
    accent = look().colour("accent").rgb()

    def middle_height(image: QImage, x: int) -> int:
        return sum(image.pixelColor(x, y).rgb() == accent for y in range(image.height()))

    left, _, right, _ = drawn(plain)
    assert middle_height(plain, right - 4) > middle_height(plain, left + 8)  # the upright segment stands on the right
    left, _, right, _ = drawn(turned)
    assert middle_height(turned, left + 4) > middle_height(turned, right - 8)


def test_the_picture_follows_what_is_typed_and_another_machine(qtbot: QtBot) -> None:
    kind = next(each for each in ALL if each is CircularPath)
    dialog = open_dialog(kind, "ssc4", "example")
    qtbot.addWidget(dialog)
    dialog.form.show_instruction(CircularPath(segments=(line("5", "1"),)))
    settle()
    assert isinstance(dialog.form.picture, PathPicture)
    assert dialog.form.picture.words.startswith("ends at X 5 in, Y 1 in")
    dialog.form.show_offers(machine_offers("ssc2"))
    settle()
    assert isinstance(dialog.form.picture, PathPicture)
    assert dialog.form.picture.words.startswith("ends at X 5 in, Y 1 in")
