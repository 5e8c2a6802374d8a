"""Another scale under a program: with the counts kept, the machine does exactly what it did."""

from __future__ import annotations

import dataclasses as dc
from fractions import Fraction

from hypothesis import assume, given
from hypothesis import strategies as st

from codegen.document import Document
from codegen.generate import generate
from codegen.history import History
from codegen.instructions import (
    AccelDecel,
    FollowingError,
    IncrementalPosition,
    MotionParameters,
    PositionLimits,
    SingleAxisMove,
    UserSetup,
)
from codegen.instructions.motion import MoveMode
from codegen.program import Program, Step
from codegen.rescale import with_setup
from codegen.setup import Axis, Setup, Unit

SCALES = st.sampled_from(["1000", "637", "4000/3", "39.37", "25400", "16000/7", "0.9", "100"])
LENGTHS = st.decimals("-30", "30", places=4).map(str)
RATES = st.decimals("0.5", "90", places=3).map(str)


def axes(x: Axis) -> Setup:
    return Setup(model="ssc2", axes=(x, x, Axis(), Axis()))


@st.composite
def documents(draw: st.DrawFn) -> Document:
    """A program of plain numbers on an axis with limits."""
    reach, axis = draw(st.decimals("31", "60", places=4)), draw(SCALES)
    held = Axis(
        unit=Unit.MM, counts_per_unit=axis, forward_limit=f"{reach}", reverse_limit=f"-{reach}",
        error_limit=draw(RATES), maximum_speed="100", maximum_acceleration="9000",
    )  # fmt: skip
    instructions = [
        UserSetup(),
        AccelDecel(acceleration=(draw(RATES), draw(RATES), "", "")),
        PositionLimits(forward=(draw(LENGTHS), "", "", ""), reverse=("", draw(LENGTHS), "", "")),
        FollowingError(error=(draw(RATES), "", "", "")),
        MotionParameters(speed=(draw(RATES), "", "", "")),
        IncrementalPosition(distance=(draw(LENGTHS), draw(LENGTHS), "", "")),
        SingleAxisMove(distance=draw(LENGTHS), speed=draw(RATES), acceleration=draw(RATES)),
        SingleAxisMove(axis="Y", mode=MoveMode.TO, position=draw(LENGTHS), speed=draw(RATES)),
        SingleAxisMove(mode=MoveMode.AT, jog_speed=draw(LENGTHS)),
    ]
    return Document(Program("P", main=tuple(Step(f"s{n}", each) for n, each in enumerate(instructions))), axes(held))


@given(documents(), SCALES)
def test_with_the_counts_kept_the_code_stays_the_same_to_the_last_count(document: Document, scale: str) -> None:
    """Also where the numbers never end in the new unit: 3184 counts at 3 counts a unit are 1061.333…"""
    before = generate(document)
    assume(before.is_complete)
    axis = dc.replace(document.setup.axis("X"), counts_per_unit=scale, unit=Unit.INCH)
    moved = with_setup(document, axes(axis), "counts")
    after = generate(moved)
    assert after.text == before.text
    assert not [each for each in after.problems if each.severity == "error"]


@given(documents(), SCALES)
def test_there_and_back_says_the_same_code(document: Document, scale: str) -> None:
    assume(generate(document).is_complete)
    there = axes(dc.replace(document.setup.axis("X"), counts_per_unit=scale))
    moved = with_setup(document, there, "counts")
    home = axes(dc.replace(moved.setup.axis("X"), counts_per_unit=document.setup.axis("X").counts_per_unit))
    assert generate(with_setup(moved, home, "counts")).text == generate(document).text


def test_a_speed_that_would_be_cut_two_counts_short_is_not() -> None:
    """3184/3 = 1061.333…: written with the last digit downwards it would be sent as 3182 (speeds are even)."""
    old = Document(
        Program("P", main=(Step("s", SingleAxisMove(distance="1", speed="5")),)), axes(Axis(counts_per_unit="636.8"))
    )
    assert "SP 3184" in generate(old).text.splitlines()
    new = with_setup(old, axes(Axis(counts_per_unit="3")), "counts")
    assert "SP 3184" in generate(new).text.splitlines()
    speed = new.program.main[0].instruction
    assert isinstance(speed, SingleAxisMove) and Fraction(speed.speed) >= Fraction(3184, 3)


def test_with_the_units_kept_nothing_typed_changes_and_one_step_takes_it_back() -> None:
    old = Document(Program("P", main=(Step("s", SingleAxisMove(distance="1")),)), axes(Axis(counts_per_unit="1000")))
    new = with_setup(old, axes(Axis(counts_per_unit="500")), "units")
    assert new.program is old.program
    assert "PR 500" in generate(new).text.splitlines()
    history = History(old).push(with_setup(old, axes(Axis(counts_per_unit="300")), "counts"), "Change setup", now=0.0)
    assert history.undo().present is old
