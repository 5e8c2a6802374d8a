"""The calculator of the scale, against worked examples and the arithmetic of fractions."""

from __future__ import annotations

import dataclasses as dc
import math
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from codegen.setup import Axis, Setup, Unit, ratio_of, setup_problems
from codegen.setup_scale import DRIVE_WORDS, Drive, Feedback, Length, Mechanics, Scale, drives_for, in_unit, scale_of


def axis_in(unit: Unit, name: str = "") -> Setup:
    return Setup(model="ssc1").with_axis("X", Axis(unit=unit, unit_name=name))


def scale(mechanics: Mechanics, unit: Unit = Unit.MM) -> Scale:
    found = scale_of(mechanics, axis_in(unit), "X")
    assert isinstance(found, Scale), found
    return found


def test_turns_per_inch_times_counts_of_a_turn() -> None:
    """ssc-tol-o-motion.txt l.1560: pitch of leadscrew (TPI) × encoder resolution = total counts per inch."""
    screw = Mechanics(drive=Drive.TURNS, length=Length.INCH, turns="5", lines="1000")
    found = scale(screw, Unit.INCH)
    assert (found.counts, found.exact, found.text) == (20000, True, "20000")  # 5 × 1000 × 4


def test_the_roller_of_the_wire_cutter() -> None:
    """dmc-1412-1414.txt l.4011: a roller of 2 inches in diameter, 1000 lines: 4000/2π = 637 counts an inch."""
    found = scale(Mechanics(drive=Drive.WHEEL, length=Length.INCH, diameter="2", lines="1000"), Unit.INCH)
    assert round(found.counts) == 637 and not found.exact
    assert math.isclose(float(found.counts), 4000 / (2 * math.pi), rel_tol=1e-15)
    kept = ratio_of(found.text)
    assert kept is not None and abs(kept / found.counts - 1) < Fraction(1, 10**11)
    assert "π" in found.remark and "Rounded" in found.remark


@pytest.mark.parametrize(
    ("mechanics", "unit", "counts"),
    [
        (Mechanics(pitch="5", lines="1000"), Unit.MM, Fraction(800)),
        (Mechanics(pitch="5", lines="1000"), Unit.CM, Fraction(8000)),
        (Mechanics(pitch="5", lines="1000"), Unit.METRE, Fraction(800000)),
        (Mechanics(pitch="5", lines="1000"), Unit.INCH, Fraction(20320)),  # 800 × 25.4
        (Mechanics(pitch="0.2", length=Length.INCH, lines="500"), Unit.MM, Fraction(2000 * 10, 2 * 254) * 10),
        (Mechanics(pitch="3", lines="1000"), Unit.MM, Fraction(4000, 3)),
        (Mechanics(drive=Drive.BELT, teeth="20", tooth="5", lines="1024"), Unit.MM, Fraction(4096, 100)),
        (Mechanics(drive=Drive.ROTARY, motor_turns="90", lines="2500"), Unit.DEGREE, Fraction(2500)),
        (Mechanics(drive=Drive.OWN, turn="2", feedback=Feedback.PULSES, pulses="500"), Unit.OWN, Fraction(250)),
        (Mechanics(pitch="10", motor_turns="3", load_turns="2", lines="1000"), Unit.MM, Fraction(600)),
        (Mechanics(pitch="5", feedback=Feedback.STEPS, microsteps="8"), Unit.MM, Fraction(320)),
    ],
)
def test_worked_examples(mechanics: Mechanics, unit: Unit, counts: Fraction) -> None:
    found = scale(mechanics, unit)
    assert found.counts == counts and found.exact
    assert ratio_of(found.text) == counts  # what the setup keeps is the same number


def test_a_scale_that_never_ends_is_kept_as_a_quotient_and_says_what_rounding_would_do() -> None:
    found = scale(Mechanics(pitch="3", lines="1000"))
    assert found.text == "4000/3"
    assert "Exact as a quotient" in found.remark and "rounded" in found.remark
    setup = axis_in(Unit.MM).with_axis("X", Axis(unit=Unit.MM, counts_per_unit=found.text))
    assert setup.axis("X").scale == Fraction(4000, 3) and setup_problems(setup) == ()


NUMBERS = st.decimals("0.001", "5000", places=3).map(str)
COUNTS = st.integers(1, 20000).map(str)


@given(NUMBERS, COUNTS, COUNTS, COUNTS, st.sampled_from([Unit.MM, Unit.INCH, Unit.CM, Unit.METRE, Unit.FOOT]))
def test_counts_of_the_travel_of_one_turn_are_the_counts_of_one_turn(
    pitch: str, lines: str, motor: str, load: str, unit: Unit
) -> None:
    """Whatever the unit: as far as the load moves in one turn of the motor, that many counts there are."""
    metres = {
        Unit.MM: Fraction(1, 1000), Unit.INCH: Fraction(254, 10000), Unit.CM: Fraction(1, 100), Unit.METRE: Fraction(1),
        Unit.FOOT: Fraction(3048, 10000),
    }  # fmt: skip
    found = scale(Mechanics(pitch=pitch, lines=lines, motor_turns=motor, load_turns=load), unit)
    travel_m = Fraction(pitch) / 1000 * Fraction(load) / Fraction(motor)  # of one turn of the motor
    assert found.counts * travel_m / metres[unit] == 4 * int(lines)
    assert ratio_of(found.text) == found.counts


def test_what_is_missing_or_no_number_is_said() -> None:
    for mechanics, words in (
        (Mechanics(), "Travel of one turn is missing."),
        (Mechanics(pitch="12,5"), "Travel of one turn: write 12.5."),
        (Mechanics(pitch="0"), "Travel of one turn must lie between"),
        (Mechanics(pitch="5", lines="10.5"), "Encoder lines must be a whole number."),
        (Mechanics(pitch="5", load_turns="0"), "Gear: turns of the load must lie between"),
    ):
        found = scale_of(mechanics, axis_in(Unit.MM), "X")
        assert isinstance(found, str) and found.startswith(words), found


def test_a_drive_that_does_not_give_the_unit_is_refused() -> None:
    assert isinstance(scale_of(Mechanics(pitch="5"), axis_in(Unit.DEGREE), "X"), str)
    assert isinstance(scale_of(Mechanics(drive=Drive.ROTARY), axis_in(Unit.MM), "X"), str)
    assert isinstance(scale_of(Mechanics(pitch="5"), axis_in(Unit.COUNT), "X"), str)
    assert {each for unit in Unit for each in drives_for(unit)} == set(DRIVE_WORDS)


@pytest.mark.parametrize("text", ["16000/0", "1/", "/3", "a/b", "1/2/3", "12,5/3", "1e3"])
def test_what_is_no_quotient_is_never_taken_for_a_scale(text: str) -> None:
    assert ratio_of(text) is None
    axis = Axis(counts_per_unit=text)
    assert axis.scale_problem is not None
    setup = Setup(model="ssc1").with_axis("X", axis)
    assert [each.field for each in setup_problems(setup)] == ["counts_per_unit"]


def test_an_axis_in_counts_has_no_scale_whatever_was_typed_before() -> None:
    assert Axis(unit=Unit.COUNT, counts_per_unit="4000").scale == 1
    assert dc.replace(Axis(unit=Unit.COUNT, counts_per_unit="4000"), unit=Unit.MM).scale == 4000


@given(COUNTS, COUNTS, st.sampled_from(list(Unit)), st.sampled_from(list(Unit)))
def test_another_unit_and_back_is_the_same_scale(above: str, below: str, one: Unit, other: Unit) -> None:
    text = f"{above}/{below}"
    assert ratio_of(in_unit(in_unit(text, one, other), other, one)) == Fraction(int(above), int(below))


def test_a_scale_follows_the_unit_of_length_only() -> None:
    assert in_unit("25.4", Unit.INCH, Unit.MM) == "1"
    assert in_unit("1000", Unit.METRE, Unit.CM) == "10"
    assert in_unit("637", Unit.INCH, Unit.DEGREE) == in_unit("637", Unit.COUNT, Unit.MM) == "637"
    assert in_unit("", Unit.INCH, Unit.MM) == "" and in_unit("12,5", Unit.INCH, Unit.MM) == "12,5"
