"""The cells of a table: every change is whole or refused, and what was copied comes back as it was."""

from __future__ import annotations

import math
from fractions import Fraction
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from codegen.courses import along_master, in_time
from codegen.fields import Dimension
from codegen.instructions import ContourMode, ElectronicCam
from codegen.laws import Law, rise, way
from codegen.numbers import parse_number
from codegen.setup import Axis, Setup
from codegen.sheets import (
    Cells,
    Column,
    Sheet,
    cells_of,
    csv_of,
    pasted,
    positions,
    text_of,
    with_columns,
    with_position,
    with_row,
    without_rows,
)
from codegen.tables import BadTable, Grid, read_pasted, read_table

TWO = Sheet((Column("Y in", "Y", 4), Column("Z in", "Z", 4)), "X in", (), 257)
ONE = Sheet((Column("Y in", "Y", 4),), "X in", (), 257)
STEPS = Sheet((Column("X in", "X", 4),), "ms", (), 20000, steps=True)
NUMBERS = st.integers(-(10**9), 10**9).map(lambda n: f"{n // 1000}.{n % 1000:03d}" if n >= 0 else str(n))
SHEETS = st.lists(st.lists(NUMBERS, min_size=2, max_size=2).map(tuple), min_size=1, max_size=30).map(tuple)


def numbers(cells: Cells) -> list[list[Fraction | None]]:
    return [[parse_number(cell) for cell in row] for row in cells]


@given(SHEETS)
def test_what_is_copied_or_saved_comes_back(cells: Cells) -> None:
    """Through the field, the clipboard, and a file; into an empty sheet."""
    assert cells_of(text_of(cells), 2) == cells
    for text in (text_of(cells), csv_of(TWO, cells), csv_of(TWO, cells).replace("\n", "\r\n")):
        again = pasted(TWO, (), 0, 0, text)
        assert not isinstance(again, BadTable)
        assert numbers(again) == numbers(cells)


@given(SHEETS, st.sampled_from("\t;"))
def test_a_decimal_comma_means_the_same_number_between_tabs_and_semicolons(cells: Cells, mark: str) -> None:
    """As a German spreadsheet writes it; what could be a thousand is refused, never guessed."""
    text = "\n".join(mark.join(cell.replace(".", ",") for cell in row) for row in cells)
    again = pasted(TWO, (), 0, 0, text)
    if isinstance(again, BadTable):
        assert "can be read in two ways" in again.message
    else:
        assert numbers(again) == numbers(cells)


@given(SHEETS, st.text(st.sampled_from("0123456789.,;\t\n -+eEab'"), max_size=40), st.integers(0, 1))
def test_nothing_is_half_pasted(cells: Cells, text: str, column: int) -> None:
    made = pasted(TWO, cells, 0, column, text)
    if isinstance(made, BadTable):
        assert made.message and "\n" not in made.message
        return
    assert all(len(row) == 2 for row in made)
    if column == 1:
        assert [row[0] for row in made[: len(cells)]] == [row[0] for row in cells]
    read = read_pasted(text)
    assert isinstance(read, Grid)
    assert [
        tuple(parse_number(cell) for cell in row[column : column + read.columns]) for row in made[: len(read.rows)]
    ] == [tuple(row) for row in read.rows]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("0,5\n1,5", "row 1: '0,5' can be one number or two; write 0.5, or part the cells with tabs or ;"),
        ("Y\n0,5\n1,5", "row 2: '0,5' can be one number or two; write 0.5, or part the cells with tabs or ;"),
        ("1\t2\t3", "it has 3 columns; from “Y in” on there are 2"),
        ("1\t2\n\t3", "row 2, cell 1: a number is missing"),
        ("1\t2\n1,234\t3", "row 2, cell 1: '1,234' can be read in two ways; write 1.234 or 1234"),
        ("Y in\tZ in\n1\tabc", "row 2, cell 2: 'abc' is not a number"),
        ("1\n" * 258, "with its 258 rows the table would have more than 257"),
        ("", "there are no numbers in it"),
    ],
)
def test_what_can_not_be_read_is_told_in_one_sentence(text: str, message: str) -> None:
    found = pasted(TWO, (("1", "2"),), 0, 0, text)
    assert isinstance(found, BadTable) and found.message == message


def test_a_comma_between_two_whole_columns_is_a_separator_where_no_number_could_be_meant() -> None:
    assert pasted(TWO, (), 0, 0, "1.5,2\n3.5,-4") == (("1.5", "2"), ("3.5", "-4"))


def test_a_new_row_lies_half_way_and_steps_stand_still() -> None:
    assert with_row(ONE, (("0",), ("1",)), 1) == (("0",), ("0.5",), ("1",))
    assert with_row(ONE, (("0",), ("1",)), 2) == (("0",), ("1",), ("1",))
    assert with_row(STEPS, (("0.5",),), 1) == (("0.5",), ("0",))
    full = with_row(ONE, (("0",),) * 257, 3)
    assert isinstance(full, BadTable) and full.message == "The table is full: 257 rows"
    assert without_rows((("0",), ("1",), ("2",)), [0, 2]) == (("1",),)


@given(st.lists(NUMBERS, min_size=1, max_size=12), st.data())
def test_dragging_a_place_moves_no_other_place(texts: list[str], data: st.DataObject) -> None:
    cells = tuple((text,) for text in texts)
    row = data.draw(st.integers(0, len(cells) - 1))
    before = positions(cells, 0)
    after = positions(with_position(cells, row, 0, Fraction(7, 2)), 0)
    assert after[row] == "3.5"
    assert [each for n, each in enumerate(after) if n != row] == [each for n, each in enumerate(before) if n != row]


def test_columns_follow_their_axes() -> None:
    cells: Cells = (("1", "2"), ("3", "4"))
    assert with_columns(cells, "YZ", "ZW", {}) == (("2", ""), ("4", ""))
    assert with_columns((("2",), ("4",)), "Z", "YZ", {"Y": ("1", "3")}) == cells


@pytest.mark.parametrize(
    ("law", "speed", "acceleration"),
    [(Law.CYCLOIDAL, 2.0, 2 * math.pi), (Law.MODIFIED_SINE, 1.7596, 5.528), (Law.POLYNOMIAL, 1.875, 5.7735)],
)
def test_laws_have_the_constants_of_the_textbooks(law: Law, speed: float, acceleration: float) -> None:
    """Norton, Cam Design: cycloidal 2 and 6.283, modified sine 1.76 and 5.528, 3-4-5 polynomial 1.875 and 5.777."""
    n = 4000
    places = [way(law, k / n) for k in range(n + 1)]
    speeds = [(b - a) * n for a, b in pairwise(places)]
    changes = [(b - a) * n for a, b in pairwise(speeds)]
    assert (places[0], places[-1]) == (pytest.approx(0, abs=1e-12), pytest.approx(1))
    assert max(speeds) == pytest.approx(speed, rel=1e-3)
    assert max(changes) == pytest.approx(acceleration, rel=1e-3)
    assert speeds[0] == pytest.approx(0, abs=1e-3) == speeds[-1]


def test_a_rise_is_exact_at_its_ends_and_its_middle() -> None:
    cells = rise(Law.CYCLOIDAL, 5, Fraction(1, 4), Fraction(5, 4), 4)
    assert cells[0] == "0.25" and cells[2] == "0.75" and cells[-1] == "1.25"
    assert rise(Law.STRAIGHT, 3, Fraction(2), Fraction(2), 4) == ("2", "2", "2")


def test_a_contour_is_at_rest_before_and_behind_its_table() -> None:
    """1 unit in 4 ms, then 1 in 8 ms: 250 and 125 units/s."""
    course = in_time("X", [Fraction(1), Fraction(1)], [Fraction(4), Fraction(8)])
    assert course.at == (0, 4, 12) and course.position == (0, 1, 2)
    assert course.speed == (250, 125)
    assert course.acceleration == (250 / Fraction(4, 1000), -125 / Fraction(6, 1000), -125 / Fraction(8, 1000))


def test_a_cam_is_as_fast_as_its_slope_times_the_master() -> None:
    """4 units of the master in 4 stretches at 2 units/s: 0.5 s each."""
    course = along_master("Y", [Fraction(n) for n in (0, 1, 2, 1, 0)], Fraction(10), Fraction(4), Fraction(2))
    assert course.at == (10, 11, 12, 13, 14)
    assert course.speed == (2, 2, -2, -2)
    assert course.acceleration == (8, 0, -8, 0, 8)  # at both ends the seam: from -2 to 2 in 0.5 s


def machine(**slave: str) -> Setup:
    """640 and 1000 counts an inch: 4 in divide into 8 whole stretches."""
    setup = Setup(model="ssc2").with_axis("X", Axis(counts_per_unit="640"))
    return setup.with_axis("Y", Axis(counts_per_unit="1000", **slave))


def test_a_cam_that_asks_too_much_of_its_slave_is_told() -> None:
    """Cycle 4 in in 8 stretches of 0.5 in; the steepest is 0.75 in: at 2 in/s it takes 0.25 s, so 3 in/s."""
    cam = ElectronicCam(cycle="4", slaves="Y", table="0\n0.25\n1\n1.75\n2\n1.75\n1\n0.25\n0", fastest="2")
    assert cam.own_warning(machine()) is None
    told = cam.own_warning(machine(maximum_speed="2.5"))
    assert told == ("table", "From row 2 to 3 Y goes at 3 in/s with X at 2 in/s, top is 2.5 in/s")
    # at the seam the speed goes from -1 to 1 in/s in 0.25 s
    told = cam.own_warning(machine(maximum_acceleration="7"))
    assert told == ("table", "At row 1 Y accelerates by 8 in/s² with X at 2 in/s, top is 7 in/s²")


def test_the_top_speed_of_the_setup_counts_where_the_cam_says_none() -> None:
    cam = ElectronicCam(cycle="4", slaves="Y", table="0\n0.25\n1\n1.75\n2\n1.75\n1\n0.25\n0")
    slow = machine(maximum_speed="2.5")
    assert cam.own_warning(slow) is None  # nobody knows how fast the master goes
    known = slow.with_axis("X", Axis(counts_per_unit="640", maximum_speed="2"))
    assert cam.own_warning(known) == ("table", "From row 2 to 3 Y goes at 3 in/s with X at 2 in/s, top is 2.5 in/s")


def test_a_contour_above_the_acceleration_of_the_setup_is_told() -> None:
    """0.1 in in 16 samples of 1/1024 s is 6.4 in/s, reached within one of them."""
    setup = Setup(model="ssc1").with_axis("X", Axis(counts_per_unit="1000", maximum_acceleration="400"))
    told = ContourMode(table="0.1").own_warning(setup)
    assert told == ("table", "At row 1 X accelerates by 409.6 in/s², top is 400 in/s²")


def test_the_place_of_the_master_stands_before_each_row() -> None:
    cam = ElectronicCam(cycle="4", offset="1", table="0\n1\n0", slaves="Y")
    assert cam.sheet(machine()).leads == ("1", "3", "5")
    contour = ContourMode(timed=True, table="4\t1\n8\t1")
    sheet = contour.sheet(machine())
    assert [column.heading for column in sheet.columns] == ["ms", "X in"]
    assert sheet.leads == ("3.906", "11.719")  # 4 and 12 samples of 1/1.024 ms


def test_a_table_that_can_not_be_read_is_shown_as_it_is() -> None:
    assert cells_of("1,234\t5", 2) == (("1,234", "5"),)
    assert cells_of("1,5\t2", 2) == (("1.5", "2"),)
    assert isinstance(read_table("1,234\t5"), BadTable)


def test_a_cycle_that_does_not_divide_names_what_would() -> None:
    """2548 = 4 x 637 counts in 8 parts: 318 x 8 = 2544 counts are 3.9937 in; 2548 = 7 x 364, so 8 rows."""
    setup = machine().with_axis("X", Axis(counts_per_unit="637"))
    cam = ElectronicCam(cycle="4", slaves="Y", table="0\n0.25\n1\n1.75\n2\n1.75\n1\n0.25\n0")
    assert cam.own_warning(setup) == (
        "cycle",
        "Master cycle: its 2548 counts do not divide into 8 equal parts, so the curve ends early: "
        "write 3.9937 in (2544 counts), or use 8 rows",
    )
    assert setup.counts(Dimension.DISTANCE, "X", Fraction("3.9937")) == 2544
