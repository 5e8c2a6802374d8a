"""The teach table: what may stand in it, its file, what it becomes; and ways driven by hand as lines and arcs."""

from __future__ import annotations

import dataclasses as dc
import math
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from codegen.bows import through_ends
from codegen.disk import FileUnreadable
from codegen.generate import generate
from codegen.models import model
from codegen.setup import Setup, Unit
from codegen.teach import Row, Table, deleted, inserted, problems, with_cell, with_values
from codegen.teach_file import table_of, text_of
from codegen.teach_path import Leg, Seen, Way, distance, fitting, rows_of, thinned
from codegen.teach_steps import drawn, module
from device.simulator.simulation import Simulation

AXIS = dc.replace(Setup().axes[0], unit=Unit.MM, counts_per_unit="1000", reverse_limit="-50", forward_limit="200")
TABLE = Setup(model="ssc2", axes=(AXIS,) * 4)
PACE = Row(speed="100", acceleration="5120", deceleration="5120")  # 1024 counts/s² divide it


def place(x: str, y: str, **more: str) -> Row:
    return dc.replace(PACE, x=x, y=y, **more)


def table(*rows: Row) -> Table:
    return Table(("mm", "mm"), rows)


# The rows of the manual's figure (ssc-tol-o-motion.txt l.2777-2786), in inches.
MANUAL = Table(
    ("in", "in"),
    (
        Row(),
        *(
            Row(x=x, y=y, speed="10", acceleration="10", deceleration="10")
            for x, y in (("10.41675", "-0.307625"), ("9.5435", "1.017125"), ("9.39475", "1.017125"))
        ),
        Row(wait="-3"),
        Row(output="0x0F"),
    ),
)
INCHES = dc.replace(AXIS, unit=Unit.INCH, counts_per_unit="8000", reverse_limit="", forward_limit="")


@pytest.mark.parametrize(
    ("row", "column", "text", "sentence"),
    [
        (1, "x", "12,5", "Row 2: Pos X: write 12.5."),
        (1, "x", "", "Row 2: write both positions, or x for both."),
        (1, "x", "2+3", "Row 2: Pos X: '2+3' is not a number."),
        (1, "y", "201", "Row 2: Pos Y must lie between -50 and 200 mm."),
        (1, "speed", "x", "Row 2: Speed is missing."),
        (0, "speed", "5", "Row 1: Speed belongs to a move; write both positions, or x here."),
        (0, "wait", "9", "Row 1: Wait input: write 1 to 8, or -1 to -8."),
        (0, "wait", "1.5", "Row 1: Wait input: write 1 to 8, or -1 to -8."),
        (0, "output", "0x1FF", "Row 1: Output: write 1 to 8, or -1 to -8, or all outputs at once: 0x00 to 0xFF."),
        (0, "output", "0", "Row 1: Output: write 1 to 8, or -1 to -8, or all outputs at once: 0x00 to 0xFF."),
        (1, "sweep", "90", "Row 2: the first place is approached on a straight way; write x for Arc."),
        (2, "sweep", "351", "Row 3: Arc must lie between -350 and 350 °."),
        (3, "sweep", "-300", "Row 4: its arc leaves the travel of X, -50 to 200."),
        (2, "through", "on", "Row 3: it cannot go on without a stop and wait or switch an output here."),
        (3, "through", "on", "Row 4: it can only go on into a row with a place; write x to stop."),
    ],
)
def test_what_can_not_be_played_says_where_and_what_to_do(row: int, column: str, text: str, sentence: str) -> None:
    made = table(Row(output="3"), place("10", "20"), place("20", "20", wait="-3"), place("190", "190"))
    assert problems(made, TABLE) == ()
    assert [each.sentence for each in problems(with_cell(made, row, column, text), TABLE)] == [sentence]


@pytest.mark.parametrize(
    ("sweep", "says"), [("180", ""), ("-180", "Row 2: its arc leaves the travel of X, -8 to 200.")]
)
def test_an_arc_is_round_in_units_whatever_the_axes_count(sweep: str, says: str) -> None:
    """Half a circle of radius 10 mm over (0, 0) to (0, 20) comes to X 10 or -10; Y has half the counts of X."""
    axes = (dc.replace(AXIS, reverse_limit="-8"), dc.replace(AXIS, counts_per_unit="500"), AXIS, AXIS)
    made = table(place("0", "0"), place("0", "20", sweep=sweep), place("5", "5"))
    assert [each.sentence for each in problems(made, dc.replace(TABLE, axes=axes))] == ([says] if says else [])


def test_numbers_of_another_unit_are_never_taken_over() -> None:
    assert problems(MANUAL, dc.replace(TABLE, axes=(INCHES,) * 4)) == ()
    assert "taught in in, the axes of the setup are in mm" in problems(MANUAL, TABLE)[0].sentence
    assert "two axes" in problems(table(place("1", "1")), dc.replace(TABLE, model="dmc1412"))[0].sentence


def test_rows_are_edited_inserted_and_deleted() -> None:
    made = inserted(table(place("1", "1"), place("3", "3")), 1, (place("2", "2"), Row(wait="1")))
    assert [row.x for row in made.rows] == ["1", "2", "", "3"]
    faster = with_values(made, range(1, 4), {"speed": "20"})
    assert [row.speed for row in faster.rows] == ["100", "20", "", "20"]
    assert deleted(faster, (0, 2)).rows == (faster.rows[1], faster.rows[3])


# ------------------------------------------------------------------------ its file


NUMBERS = st.decimals(-9999, 9999, places=4, allow_nan=False).map(lambda number: f"{number:f}")
ROWS = st.builds(
    Row,
    x=NUMBERS, y=NUMBERS, speed=NUMBERS, acceleration=st.just(""), deceleration=NUMBERS,
    wait=st.sampled_from(["", "1", "-8"]), output=st.sampled_from(["", "-1", "8", "0x00", "0xfF"]),
    pause=st.sampled_from(["", "250"]), sweep=st.sampled_from(["", "-90.5"]), through=st.sampled_from(["", "on"]),
)  # fmt: skip


@given(st.lists(ROWS, max_size=12), st.booleans())
def test_a_file_gives_back_the_same_table(rows: list[Row], windows: bool) -> None:
    made = Table(("mm", "in"), tuple(rows))
    text = text_of(made)
    assert table_of(text.replace("\n", "\r\n") if windows else text) == made


def test_the_file_reads_like_the_figure_of_the_manual() -> None:
    lines = text_of(MANUAL).split("\n")
    assert lines[1].split("\t")[:8] == [
        "Data", "Pos X", "Pos Y", "Speed", "Accel", "Decel", "Wait input", "Output",
    ]  # fmt: skip
    assert lines[2].split("\t")[:7] == ["Unit", "in", "in", "in/s", "in/s²", "in/s²", "-"]
    assert lines[3].split("\t")[:7] == ["1", *"xxxxxx"]
    assert lines[4].split("\t")[:7] == ["2", "10.41675", "-0.307625", "10", "10", "10", "x"]


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ("Twoletter", "Twolettre", "it is no teach data: its first line says something else"),
        ("data 1", "data 2", "it is of version “2”; this program reads version 1"),
        ("Pos X", "Pos Z", "line 2 does not name the columns of a teach table"),
        ("Unit", "Units", "line 3 does not name the unit of every column"),
        ("9.5435", "9,5435", "line 6, Pos X: write 9.5435"),
        ("9.5435", "9.54E5", "line 6, Pos X: write 954000 without an exponent"),
        ("9.5435", "", "line 6, Pos X: an empty value is written x"),
        ("9.5435\t", "", "line 6 has 9 values; a row has 10"),
        ("-3", "in3", "line 8, Wait input: 'in3' is no number of an input or output"),
        ("\n3\t", "\n4\t", "line 6 should be row 3, but says “4”"),
        ("End\t6", "End\t7", "it ends with “End\t7” but has 6 rows: some are missing or were added"),
        ("End\t6\n", "", "its end is missing: it was not written or copied as a whole"),
    ],
)
def test_a_damaged_file_says_what_is_wrong_and_where(old: str, new: str, sentence: str) -> None:
    text = text_of(MANUAL)
    assert old in text
    with pytest.raises(FileUnreadable) as told:
        table_of(text.replace(old, new, 1))
    assert str(told.value) == sentence


@given(st.integers(0, 400))
def test_a_file_that_was_cut_off_is_refused(length: int) -> None:
    text = text_of(MANUAL).rstrip("\n")
    with pytest.raises(FileUnreadable):
        table_of(text[: min(length, len(text) - 1)])


# ------------------------------------------------------------------- what it becomes


def run(made: Table, setup: Setup = TABLE) -> Simulation:
    """The module on a simulated controller, to its end, inputs high."""
    listing = generate(module(made, setup, "TAUGHT"))
    assert listing.is_complete, listing.problems
    simulation = Simulation(model(setup.model), compiled=False)
    simulation.load_program(listing.text)
    simulation.execute(0)
    for _ in range(400):
        simulation.advance(1_024_000 // 10)
        if not any(thread["running"] for thread in simulation.state()["threads"]):
            return simulation
    raise AssertionError("the module does not end")


def at(simulation: Simulation) -> tuple[int, int]:
    axes = simulation.state()["axes"]
    return axes["X"]["commanded"], axes["Y"]["commanded"]


def test_the_module_is_made_of_coordinated_moves_waits_and_outputs() -> None:
    """Waits and outputs as the manual means them (ssc-tol-o-motion.txt l.2791): high and on, low and off, a byte."""
    rows = (Row(output="0x0F"), place("10", "20"), place("11", "20", wait="2"), Row(wait="-3", output="-2"))
    text = generate(module(table(*rows, place("15", "25", pause="250")), TABLE, "TAUGHT")).text
    moves = [line for line in text.split("\n") if line[:2] in ("OP", "PA", "VP", "AI", "CB", "WT", "BG", "AM")]
    assert moves == [
        "OP 15", "PA 10000", "BG X", "PA ,20000", "BG Y", "AM XY",
        "VP 1000,0", "BG S", "AM S", "AI 2", "AI -3", "CB 2",
        "VP 4000,5000", "BG S", "AM S", "WT 256",
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("across", "upward", "fine"), [("8000/3", "8000/3", 1), ("1000", "2500", 5), ("2000", "300", 20)]
)
def test_forty_places_end_on_their_count_and_nothing_adds_up(across: str, upward: str, fine: int) -> None:
    """Half of what is whole in both at most is missing, however many places came before: 1 : 1, 2 : 5, 20 : 3."""
    axes = tuple(dc.replace(AXIS, counts_per_unit=each) for each in (across, upward, "1000", "1000"))
    setup = dc.replace(TABLE, axes=axes)
    rows = [place(f"{3 + n % 7 * 1.1117:.4f}", f"{2 + n % 5 * 0.7313:.4f}") for n in range(40)]
    scales = [float(axis.scale) for axis in axes[:2]]
    ends = at(run(table(*rows), setup))
    for count, text, scale in zip(ends, (rows[-1].x, rows[-1].y), scales, strict=True):
        assert abs(count - round(float(text) * scale)) <= fine / 2 * scale / max(scales)


def test_arcs_go_round_their_centre_and_a_line_behind_ends_on_its_count() -> None:
    """A half circle of 10 mm about (20, 10), counter-clockwise, from below to above; then a line."""
    rows = (place("20", "0"), place("20", "20", sweep="180", through="on"), place("12.345", "20"))
    assert at(run(table(*rows))) == (12345, 20000)
    points = drawn(table(*rows), TABLE)
    assert all(abs(math.dist(point, (20, 10)) - 10) < 1e-9 for point in points[:-1])
    assert max(x for x, _ in points) == pytest.approx(30, abs=10 / 500)


# -------------------------------------------------------------- ways driven by hand


@st.composite
def driven(draw: st.DrawFn) -> list[Seen]:
    """Readings while somebody drives: straight, round, shaking, standing; in counts, as they were read."""
    x, y, heading, seconds = 0.0, 0.0, 0.0, 0.0
    found = [Seen(0.0, 0, 0)]
    for _ in range(draw(st.integers(1, 5))):
        kind = draw(st.sampled_from(["straight", "round", "shaking", "standing"]))
        turning = draw(st.floats(-0.3, 0.3)) if kind == "round" else 0.0
        for _ in range(draw(st.integers(2, 30))):
            seconds += 0.05
            if kind == "shaking":
                heading += draw(st.floats(-2.0, 2.0))
            if kind != "standing":
                heading += turning
                x, y = x + 40 * math.cos(heading), y + 40 * math.sin(heading)
            found.append(Seen(seconds, round(x), round(y)))
    return found


@given(driven(), st.sampled_from([1.0, 5.0, 30.0]))
def test_every_place_seen_lies_within_the_tolerance(seen: list[Seen], tolerance: float) -> None:
    """In its own stretch: the way may not leave it out and come by later."""
    way = thinned(seen, tolerance)
    assert way.start == seen[0][1:]
    ends = [way.start, *(leg.end for leg in way.legs)]
    assert ends[-1] == seen[-1][1:]
    places = [each[1:] for each in seen]
    here = 0
    for (start, end), leg in zip(pairwise(ends), way.legs, strict=True):
        last = places.index(end, here + 1 if end == places[here] else here)
        part = Way(start, (leg,))
        assert all(distance(part, place) <= tolerance + 1e-6 for place in places[here : last + 1])
        here = last


@given(driven())
def test_pauses_are_kept(seen: list[Seen]) -> None:
    stood, since = 0.0, seen[0]
    for before, after in pairwise([*seen, Seen(math.inf, math.nan, math.nan)]):
        if after[1:] != before[1:]:
            stood += before.seconds - since.seconds if before.seconds - since.seconds >= 0.3 else 0.0
            since = after
    way = thinned(seen, 5.0)
    assert way.pause_s + sum(leg.pause_s for leg in way.legs) == pytest.approx(stood)


def test_a_line_a_pause_and_a_half_circle_become_just_that() -> None:
    seen = [Seen(n * 0.05, n * 20, 0) for n in range(51)]
    seen += [Seen(2.5 + n * 0.05, 1000, 0) for n in range(1, 21)]
    for n in range(1, 101):
        angle = -math.pi / 2 + n * math.pi / 100
        seen.append(Seen(3.5 + n * 0.05, round(1000 + 500 * math.cos(angle)), round(500 + 500 * math.sin(angle))))
    way = thinned(seen, 3.0)
    straight, arc, *rest = way.legs
    assert (straight.end, straight.sweep, straight.pause_s) == ((1000, 0), 0.0, pytest.approx(1.0))
    assert arc.sweep == pytest.approx(180, abs=6) and len(rest) <= 1
    bow = through_ends(straight.end, arc.end, arc.sweep)
    assert math.dist(bow.centre, (1000, 500)) < 8
    rows = rows_of(way, TABLE, PACE)
    assert [row.pause for row in rows] == ["", "1000", *[""] * (len(rows) - 2)]
    assert problems(table(*rows), TABLE) == ()
    assert at(run(table(*rows))) == (seen[-1].x, seen[-1].y)


def test_a_long_shaking_way_is_made_coarser_until_a_table_holds_it() -> None:
    """3000 places on a zigzag of 20 counts: within 5 counts each is a corner; within a double of it, few lines."""
    seen = [Seen(n * 0.05, n * 10, 20 * (n % 2)) for n in range(3000)]
    assert len(rows_of(thinned(seen, 5.0), TABLE, PACE)) > 900
    rows, tolerance = fitting(seen, 5.0, TABLE, PACE, 900)
    assert len(rows) <= 900 and tolerance in (10.0, 20.0, 40.0)
    assert len(rows_of(thinned(seen, tolerance / 2), TABLE, PACE)) > 900  # the first that does
    assert (float(rows[-1].x), float(rows[-1].y)) == (29.99, 0.02)
    assert fitting(seen[:3], 5.0, TABLE, PACE, 900)[1] == 5.0


def test_a_path_without_a_stop_is_no_longer_than_a_controller_holds() -> None:
    """511 segments (commands.md, coordinated motion); a wide circle in 1200 short lines never turns by 20 degrees."""
    way = Way(
        (0, 0),
        tuple(Leg((round(9e4 * math.sin(n / 200)), round(9e4 * (1 - math.cos(n / 200))))) for n in range(1, 1201)),
    )
    rows = rows_of(way, dc.replace(TABLE, axes=(dc.replace(AXIS, reverse_limit="", forward_limit=""),) * 4), PACE)
    stops = [number for number, row in enumerate(rows) if not row.through]
    assert stops[0] == 0 and len(stops) == 4
    assert max(after - before for before, after in pairwise(stops)) <= 511
