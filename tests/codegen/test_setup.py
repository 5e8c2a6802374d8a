"""Units, rounding and limits of a machine."""

from __future__ import annotations

import dataclasses as dc
import pickle
from fractions import Fraction
from math import floor

import pytest
from hypothesis import given
from hypothesis import strategies as st

from codegen import read
from codegen.by_hand import Arc, OneAxis
from codegen.document import Document
from codegen.fields import Dimension
from codegen.generate import generate
from codegen.instructions import AccelDecel, SingleAxisMove, Wait
from codegen.program import Program, Step
from codegen.setup import Axis, Setup, Unit, setup_problems
from codegen.teach import Row

SCALES = st.sampled_from(["1", "637", "4000", "39.37", "0.125", "1000000"])
NUMBERS = st.fractions(min_value=-5000, max_value=5000, max_denominator=1000)


def one(scale: str, **more: str) -> Setup:
    return Setup(model="ssc1").with_axis("X", Axis(counts_per_unit=scale, **more))  # type: ignore[arg-type]


@given(SCALES, NUMBERS)
def test_distances_are_rounded_to_the_nearest_count(scale: str, number: Fraction) -> None:
    sent = one(scale).counts(Dimension.DISTANCE, "X", number)
    assert abs(sent - number * Fraction(scale)) <= Fraction(1, 2)


@given(SCALES, NUMBERS.map(abs), st.sampled_from(["1000", "500", "375", "2000"]))
def test_speeds_are_even_and_never_above(scale: str, number: Fraction, period: str) -> None:
    """A register of speed v moves v/1024 counts a sample, and a sample is TM/1 024 000 s."""
    setup = Setup(model="ssc1", sample_us=period).with_axis("X", Axis(counts_per_unit=scale))
    sent = setup.counts(Dimension.SPEED, "X", number)
    true_counts_s = Fraction(sent, 1024) / (Fraction(period) / 1024000)
    wanted = number * Fraction(scale)
    step = Fraction(2) * 1000 / Fraction(period)
    assert sent % 2 == 0
    assert wanted - step < true_counts_s <= wanted


@given(SCALES, NUMBERS.map(abs), st.sampled_from(["1000", "500", "2000"]))
def test_accelerations_are_the_nearest_multiple(scale: str, number: Fraction, period: str) -> None:
    """AC n adds n/1024 to the speed register each sample: in counts/s² n·(1000/TM)²."""
    setup = Setup(model="ssc1", sample_us=period).with_axis("X", Axis(counts_per_unit=scale))
    sent = setup.counts(Dimension.ACCELERATION, "X", number)
    exact = number * Fraction(scale) * (Fraction(period) / 1000) ** 2
    assert sent % 1024 == 0 and sent >= 1024
    if 1024 <= exact <= 67107840:
        assert abs(sent - exact) <= 512


def test_the_wire_cutter() -> None:
    """spec/instructions.md, the example: 400 in/s² and 5 in/s at 637 counts/inch."""
    setup = one("637")
    assert setup.counts(Dimension.ACCELERATION, "X", Fraction(400)) == 254976
    assert setup.counts(Dimension.SPEED, "X", Fraction(5)) == 3184
    assert setup.counts(Dimension.DISTANCE, "X", Fraction(10)) == 6370


@given(st.fractions(min_value=1, max_value=2000, max_denominator=64))
def test_acceleration_never_exceeds_the_axis(number: Fraction) -> None:
    setup = one("637", maximum_acceleration="400")
    if number <= 400:
        assert setup.counts(Dimension.ACCELERATION, "X", number) <= max(floor(400 * 637 / 1024) * 1024, 1024)


@given(st.fractions(min_value=-10, max_value=10, max_denominator=5000))
def test_positions_never_leave_the_limits(number: Fraction) -> None:
    setup = one("39.37", forward_limit="10", reverse_limit="-10")
    assert abs(setup.counts(Dimension.POSITION, "X", number)) <= Fraction("393.7")


def test_bounds_follow_axis_and_controller() -> None:
    setup = one("4000", forward_limit="200", reverse_limit="-50", maximum_speed="30")
    assert setup.bounds(Dimension.POSITION, "X") == (-50, 200)
    assert setup.bounds(Dimension.DISTANCE, "X") == (-250, 250)
    assert setup.bounds(Dimension.SPEED, "X") == (0, 30)
    assert one("4000").bounds(Dimension.SPEED, "X") == (0, 2000)  # 8,000,000 counts/s


def test_a_scale_never_set_up_is_flagged() -> None:
    texts = [finding.message for finding in setup_problems(Setup(model="ssc1"))]
    assert texts == ["Axis X: the scale was never set up (1 count is taken as 1 in)"]
    assert setup_problems(Setup(model="ssc1").with_axis("X", Axis(unit=Unit.COUNT))) == ()
    assert setup_problems(one("637")) == ()


@pytest.mark.parametrize(
    ("scale", "message"),
    [
        ("12,5", "Axis X: Counts per unit: write 12.5"),
        ("abc", "Axis X: Counts per unit must be a plain number"),
        ("0", "Axis X: Counts per unit must lie between 0.000001 and 2147483647"),
        ("-3", "Axis X: Counts per unit must lie between 0.000001 and 2147483647"),
    ],
)
def test_a_wrong_scale_stops_every_program(scale: str, message: str) -> None:
    """It is never taken as 1 in silence."""
    assert [finding.message for finding in setup_problems(one(scale))] == [message]
    listing = generate(Document(Program("P", main=(Step("s1", Wait(time="5")),)), one(scale)))
    assert not listing.is_complete and [finding.message for finding in listing.problems] == [message]


@pytest.mark.parametrize("text", ["(100)", "$64", "-$64", "50+50"])
def test_a_limit_that_only_an_expression_could_mean_is_refused(text: str) -> None:
    """Brackets and hexadecimal digits are code: whoever takes the limit as a number would have none."""
    setup = one("4000", forward_limit=text)
    assert [finding.message for finding in setup_problems(setup)] == ["Axis X: Forward limit must be a plain number"]
    for item, name in ((OneAxis(distance=text), "distance"), (Row(x=text), "x"), (Arc(sweep=text), "sweep")):
        assert str(read.problem_of(item, name, one("4000"))).endswith("must be a plain number")


def test_a_program_tells_once_of_a_scale_never_set_up() -> None:
    moves = tuple(Step(f"s{place}", SingleAxisMove(distance="100", speed="50")) for place in range(3))
    (finding,) = generate(Document(Program("P", main=moves), Setup(model="ssc1"))).problems
    assert (finding.step, finding.severity) == ("s0", "warning") and "never set up" in finding.message


def test_a_field_of_an_axis_the_controller_lacks_says_so_and_counts_nothing() -> None:
    move, small = SingleAxisMove(axis="Y", distance="10", speed="5"), one("637")
    for name in ("distance", "speed"):
        assert str(read.problem_of(move, name, small)).endswith("this controller has no axis Y")
        assert read.counts_text(move, name, small) == ""
        assert read.unit_text(move, name, small).startswith("units")
    assert "10 units at 5 units/s" in read.sentence(move, small)
    assert [finding.message for finding in read.problems(move, small)] == ["Axis: this controller has no axis Y"]


def test_a_field_of_an_axis_without_a_scale_says_what_it_is_taken_for() -> None:
    move, setup = (
        SingleAxisMove(axis="Y", distance="10", speed="8"),
        Setup(model="ssc4").with_axis("X", one("637").axis("X")),
    )
    told = "Axis Y: the scale was never set up (1 count is taken as 1 in)"
    assert [read.warning_of(move, name, setup) for name in ("distance", "speed")] == [told, told]
    assert read.warning_of(AccelDecel(acceleration=("1024", "2048", "", "")), "acceleration", setup, "Y") == told
    assert read.warning_of(dc.replace(move, axis="X", distance="10"), "distance", setup) is None


def test_names_are_no_numbers() -> None:
    setup = Setup(input_names=("3", *[""] * 7)).with_axis("X", Axis(unit=Unit.COUNT))
    assert "The name '3' is a number" in [finding.message for finding in setup_problems(setup)]


def test_limits_the_wrong_way_round() -> None:
    found = setup_problems(one("637", forward_limit="-1", reverse_limit="1"))
    assert [each.field for each in found] == ["forward_limit"]


@pytest.mark.parametrize(
    ("unit", "symbol"),
    [
        (Unit.INCH, "in"),
        (Unit.FOOT, "ft"),
        (Unit.MM, "mm"),
        (Unit.CM, "cm"),
        (Unit.METRE, "m"),
        (Unit.DEGREE, "deg"),
        (Unit.COUNT, "counts"),
    ],
)
def test_units(unit: Unit, symbol: str) -> None:
    setup = Setup().with_axis("X", Axis(unit=unit))
    assert setup.unit_text(Dimension.DISTANCE, "X") == symbol
    assert setup.unit_text(Dimension.SPEED, "X") == f"{symbol}/s"
    assert setup.unit_text(Dimension.ACCELERATION, "X") == f"{symbol}/s²"


def test_own_unit_and_names() -> None:
    setup = Setup(input_names=("", "Door", *[""] * 6)).with_axis("X", Axis(unit=Unit.OWN, unit_name="turns"))
    assert setup.unit_text(Dimension.POSITION, "X") == "turns"
    assert setup.input_number("Door") == 2 and setup.input_number("3") == 3 and setup.input_number("Gate") is None


def test_equal_setups_have_equal_hashes_also_after_pickling() -> None:
    setup = one("637")
    hash(setup)
    copy = pickle.loads(pickle.dumps(setup))
    assert copy == setup and hash(copy) == hash(setup) and "_known_hash" not in setup.__getstate__()
