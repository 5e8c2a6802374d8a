"""The picture of a path: its form, its end, its corners, and what it says where it cannot draw."""

from __future__ import annotations

import dataclasses as dc
from fractions import Fraction

import pytest
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QColor, QImage
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot

from codegen.document import Document
from codegen.instructions import (
    ALL,
    CircularPath,
    DefinePosition,
    Instruction,
    Label,
    LinearPath,
    SingleAxisMove,
    Wait,
)
from codegen.instructions.motion import MoveMode
from codegen.instructions.path_parts import Ending, Piece, Shape, Stretch
from codegen.program import Place, Program, Section, fresh, insert
from codegen.standing import standing_at
from tests.widgets.form.clipping import machine_offers, open_dialog, settle
from widgets.form.offers import offers_of
from widgets.form.path_picture import PathPicture
from widgets.parts.look import look


@pytest.fixture
def picture(qtbot: QtBot) -> PathPicture:
    """Of the machine with two axes in inches."""
    made = PathPicture(machine_offers("ssc4"))
    qtbot.addWidget(made)
    made.setFocusPolicy(Qt.FocusPolicy.NoFocus)  # its ring has the colour of the path
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
    other.setFocusPolicy(Qt.FocusPolicy.NoFocus)
    other.resize(320, 200)
    path = CircularPath(segments=(line("3", "0"), line("3", "2")))
    for each in (picture, other):
        each.show_instruction(path)
    plain, turned = picture.grab().toImage(), other.grab().toImage()
    accent = look().colour("accent").rgb()

    def height_at(image: QImage, columns: range) -> int:
        """How much of the colour of the path stands in the fullest of these columns, soft edges included."""
        near = [(x, [image.pixelColor(x, y) for y in range(image.height())]) for x in columns]
        return max(sum(abs(each.red() - QColor(accent).red()) < 60 for each in column) for _, column in near)

    left, _, right, _ = drawn(plain)
    ends = range(left, left + 9), range(right - 8, right + 1)
    assert height_at(plain, ends[1]) > 3 * height_at(plain, ends[0])  # the upright segment stands on the right
    left, _, right, _ = drawn(turned)
    ends = range(left, left + 9), range(right - 8, right + 1)
    assert height_at(turned, ends[0]) > 3 * height_at(turned, ends[1])


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


def test_a_click_on_an_axis_asks_to_turn_it_and_so_does_its_key(picture: PathPicture) -> None:
    asked: list[str] = []
    picture.mirror_wanted.connect(asked.append)
    picture.show_instruction(CircularPath.example())
    picture.grab()
    for letter in "XY":
        QTest.mouseClick(picture, Qt.MouseButton.LeftButton, pos=picture.letters[letter].center().toPoint())
    QTest.keyClick(picture, Qt.Key.Key_Y)
    QTest.keyClick(picture, Qt.Key.Key_Z)  # no axis of this path
    assert asked == ["X", "Y", "Y"]
    QTest.mouseClick(picture, Qt.MouseButton.LeftButton, pos=QPointF(30, 60).toPoint())
    assert len(asked) == 3


def test_the_open_segment_is_bolder_and_an_arc_shows_its_angles(picture: PathPicture) -> None:
    picture.show_instruction(CircularPath.example())
    before = picture.grab().toImage()
    picture.mark_row(1)
    after = picture.grab().toImage()
    wanted = look().colour("accent").rgb()

    def painted(image: QImage) -> int:
        return sum(image.pixelColor(x, y).rgb() == wanted for x in range(image.width()) for y in range(image.height()))

    assert painted(after) > painted(before) + 50


def step(program: Program, instruction: Instruction) -> Program:
    return insert(program, [fresh(program, instruction)], Place(Section.MAIN, len(program.main)))


def test_a_path_that_goes_on_is_drawn_with_what_it_goes_on_with(qtbot: QtBot) -> None:
    """From (1, 2) 3 in along X, to be continued; then 2 in up: (3, 2) from the start is (4, 4) on the machine."""
    made = Program(name="P")
    for letter, place in (("X", "1"), ("Y", "2")):
        made = step(made, SingleAxisMove(mode=MoveMode.TO, axis=letter, position=place))
    made = step(made, CircularPath(speed="1", segments=(line("3", "0"),), ending=Ending.CONTINUE))
    setup = machine_offers("ssc4").setup
    offers = offers_of(Document(made, setup), place=Place(Section.MAIN, 3))
    picture = PathPicture(offers)
    qtbot.addWidget(picture)
    picture.show_instruction(CircularPath(continues=True, segments=(line("3", "2"),)))
    assert len(picture.earlier) == 1 and picture.path[0].start == (3, 0)
    assert picture.words == (
        "ends at X 3 in, Y 2 in from its start (position X 4 in, Y 4 in); corners at the start of segment 1: 90°"
    )
    picture.grab()
    alone = PathPicture(machine_offers("ssc4"))
    qtbot.addWidget(alone)
    alone.show_instruction(CircularPath(continues=True, segments=(line("3", "2"),)))
    assert alone.words == "The path it goes on with is not known here"


def test_where_the_axes_stand_is_known_until_something_else_may_have_moved_them() -> None:
    setup = machine_offers("ssc4").setup
    made = Program(name="P")
    for instruction in (
        DefinePosition(position=("5", "0", "", "")),
        SingleAxisMove(mode=MoveMode.BY, axis="X", distance="2"),
        CircularPath(speed="1", segments=(line("3", "1"),)),
        Wait(time="20"),
        Label(name="A"),
        SingleAxisMove(mode=MoveMode.TO, axis="Y", position="1.5"),
        SingleAxisMove(mode=MoveMode.BY, axis="Y", distance="LEN"),
    ):
        made = step(made, instruction)
    known = [standing_at(made, Place(Section.MAIN, at), setup).places[:2] for at in range(8)]
    assert known == [
        (None, None), (5, 0), (7, 0), (10, 1), (10, 1), (None, None), (None, Fraction(3, 2)), (None, None)
    ]  # fmt: skip
