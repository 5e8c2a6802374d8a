"""What is seen by hand, judged: dead channels, directions, scales, switches; the record is taken up again."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import pytest

from codegen.setup import Axis, Unit
from device.commissioning.judge import (
    Moved,
    joined,
    judge_direction,
    judge_encoder,
    judge_polarity,
    judge_safety,
    judge_scale,
    judge_set,
    judge_switches,
    toggling,
)
from device.commissioning.judge_sine import judge_halls, judge_phases
from device.commissioning.record import Finding, Record, Verdict, keep, resumed
from device.commissioning.seen import NOT_FITTED, NOTHING, Switches, Turned
from device.commissioning.steps import MOST, STEPS, steps_for

MM = Axis(unit=Unit.MM, counts_per_unit="1000")
LOW = {"forward": 0, "reverse": 0, "home": 0}  # CN -1,-1: a tripped switch reads 0 (dmc-1412-1414.txt l.4111)
REST = {"forward": 1, "reverse": 1, "home": 1}


def turned(*counts: int) -> Turned:
    seen = Turned()
    for each in counts:
        seen = seen.with_reading(each)
    return seen


@pytest.mark.parametrize(
    ("counts", "distance", "verdict", "words"),
    [
        ((0, 0, 0), "5", Verdict.FAILED, "did not change"),
        ((7, 8, 7, 8, 7, 8), "5", Verdict.FAILED, "toggles by one count"),
        ((0, -2000, -5000), "5", Verdict.FAILED, "counted the other way"),
        ((0, 2000, 5000), "-5", Verdict.FAILED, "counted the other way"),
        ((0, 2000, 5000), "5", Verdict.PASSED, "right direction: 1000 counts in 1 mm"),
        ((0, -4900), "-5", Verdict.PASSED, "right direction: 980 counts in 1 mm"),
        (
            (0, 500, 1250),
            "5",
            Verdict.FAILED,
            "250 counts in 1 mm were measured, 0.25 times the 1000",
        ),
        ((0, 5), "5", Verdict.OPEN, "move it further"),
        ((0, 5000), "", Verdict.OPEN, "a number is missing"),
        ((0, 5000), "0", Verdict.OPEN, "cannot be 0"),
        ((0, 5000), "2,5", Verdict.OPEN, "write 2.5"),
        ((), "5", Verdict.OPEN, "Begin"),
    ],
)
def test_an_encoder_by_hand(counts: tuple[int, ...], distance: str, verdict: Verdict, words: str) -> None:
    finding = judge_encoder(turned(*counts), distance, MM)
    assert finding.verdict is verdict
    assert words in finding.sentence
    assert bool(finding.advice) == (verdict is Verdict.FAILED)


def test_a_scale_that_is_four_times_too_small_says_why() -> None:
    """Quadrature counts four for each line (dmc-1412-1414.txt, CE)."""
    finding = judge_encoder(turned(0, 20000), "5", MM)
    assert "four edges" in finding.advice[0]
    assert judge_encoder(turned(0, 20000), "5", Axis()).verdict is Verdict.PASSED  # no scale yet: it is offered


def tripped(seen: Switches, *names: str) -> Switches:
    """The inputs of these go low and come back."""
    seen = seen.with_levels(REST)
    return seen.with_levels({**REST, **dict.fromkeys(names, 0)}).with_levels(REST)


def test_switches_in_order() -> None:
    seen = Switches()
    for name in ("forward", "reverse", "home"):
        assert seen.asked == name
        seen = tripped(seen, name)
    finding = judge_switches(seen, LOW)
    assert finding.verdict is Verdict.PASSED
    assert "forward limit, reverse limit, home" in finding.sentence
    assert ("Home", "seen changing, reads 1 at rest; HM begins in reverse from here") in finding.facts  # l.2323


def test_swapped_limits() -> None:
    seen = tripped(tripped(tripped(Switches(), "reverse"), "forward"), "home")
    assert "swapped" in judge_switches(seen, LOW).sentence


def test_a_stuck_home_switch_and_one_that_is_not_fitted() -> None:
    seen = tripped(Switches(), "forward").answered(NOT_FITTED).answered(NOTHING)
    finding = judge_switches(seen, LOW)
    assert "home input did not change" in finding.sentence
    assert finding.advice
    fitted = tripped(Switches(), "forward").answered(NOT_FITTED).answered(NOT_FITTED)
    assert judge_switches(fitted, LOW).verdict is Verdict.PASSED


def test_a_switch_on_the_wrong_input() -> None:
    seen = tripped(tripped(tripped(Switches(), "home"), "reverse"), "home")
    assert "forward limit switch acts on the home input" in judge_switches(seen, LOW).sentence


def test_the_wrong_polarity_is_explained_by_cn() -> None:
    seen = Switches()
    for name in ("forward", "reverse", "home"):
        seen = tripped(seen, name)
    finding = judge_switches(seen, {**LOW, "forward": 1, "reverse": 1})
    assert "active while nothing is tripped" in finding.sentence
    assert "CN -1" in finding.advice[0]


def test_half_a_list_of_switches_stays_open() -> None:
    assert judge_switches(tripped(Switches(), "forward"), LOW).verdict is Verdict.OPEN


GOOD = Moved(300, 0, 298, 300, 0, 301, 1, False)


@pytest.mark.parametrize(
    ("moved", "words"),
    [
        (GOOD, "right polarity"),
        (Moved(-300, 50, -250, -250, -252, 50, 1, False), "right polarity"),
        (Moved(300, 0, -180, 30, -180, 0, 8, True), "Wrong polarity"),
        (Moved(300, 0, 400, 40, 0, 400, 8, True), "Wrong polarity"),
        (Moved(300, 0, 700, 300, 0, 700, 1, False, bounded=True), "Wrong polarity"),
        (Moved(300, 0, 1, 61, 0, 1, 8, True, changes=3, dead=True), "toggled by one count"),
        (Moved(300, 0, 1, 61, 0, 1, 8, True, changes=1), "did not move"),
        (Moved(300, 0, 0, 61, 0, 0, 8, True), "did not move"),
        (Moved(300, 0, 40, 101, 0, 40, 8, True), "stopped short"),
        (Moved(300, 0, 40, 101, 0, 41, 8, True, lost=True), "followed for 40 counts, then its reading stood still"),
        (Moved(300, 0, 100, 100, 0, 100, 2, False), "forward limit stopped"),
    ],
)
def test_a_move(moved: Moved, words: str) -> None:
    finding = judge_polarity(moved)
    assert words in finding.sentence
    assert (finding.verdict is Verdict.PASSED) == (words == "right polarity")


def test_wrong_polarity_says_every_way_out() -> None:
    advice = " ".join(judge_polarity(Moved(300, 0, -180, 30, -180, 0, 8, True)).advice)
    assert all(word in advice for word in ("leads", "CHA and CHB", "MT -1", "CE 2", "master reset"))  # l.679-683
    assert "phases" in judge_polarity(Moved(300, 0, -180, 30, -180, 0, 8, True), sine=True).advice[0]


def test_a_channel_that_dies_toggles_in_one_try_or_over_several() -> None:
    """Monotone single counts are a movement; the same count to and fro is a dead channel (l.606)."""

    def tried(*places: int) -> Moved:
        changes = sum(here != there for here, there in pairwise(places))
        return Moved(300, places[0], places[-1], 10, min(places), max(places), 8, True, changes=changes)

    assert toggling([tried(0, 1, 0)])
    assert toggling([tried(0, 5, 9), tried(9, 9), tried(9, 10), tried(10, 10), tried(10, 9)])
    assert not toggling([tried(0, 1), tried(1, 2), tried(2, 3)])
    assert not toggling([tried(0, 1), tried(1, 1), tried(1, 1)])
    assert not toggling([tried(0, 1, 0), tried(0, 4, 9)])
    whole = joined([tried(0, 4), tried(4, 3, 12)], 300)
    assert (whole.start, whole.end, whole.low, whole.high, whole.changes) == (0, 12, 0, 12, 3)


def test_the_direction_is_the_persons_word() -> None:
    finding = judge_direction(judge_polarity(GOOD), False)
    assert finding.verdict is Verdict.FAILED
    assert "motor leads AND the encoder" in finding.advice[0]  # l.685
    assert judge_direction(judge_polarity(GOOD), True).verdict is Verdict.PASSED


@pytest.mark.parametrize(
    ("measured", "verdict"),
    [
        ("0.3", Verdict.PASSED),
        ("0.302", Verdict.PASSED),
        ("1.2", Verdict.FAILED),
        ("-0.3", Verdict.FAILED),
        ("", Verdict.OPEN),
    ],
)
def test_the_scale_of_a_move(measured: str, verdict: Verdict) -> None:
    assert judge_scale(GOOD, "0.3", measured, MM).verdict is verdict


def test_what_else_is_judged() -> None:
    assert judge_safety(True, True, True).verdict is Verdict.PASSED
    assert judge_safety(True, True, False).verdict is Verdict.OPEN
    assert "stays enabled" in judge_safety(True, False, True).sentence
    assert judge_safety(False, True, True).verdict is Verdict.FAILED
    assert judge_set({"ER": "2000"}, {"ER": "2000"}).verdict is Verdict.PASSED
    assert "ER" in judge_set({"ER": "2000"}, {"ER": "16384"}).sentence
    assert (
        judge_phases("something else", "1000").verdict is Verdict.PASSED
    )  # no manual prints the words: shown as they are
    assert judge_phases("", "1000").verdict is Verdict.FAILED


def test_the_phase_by_the_halls() -> None:
    assert judge_halls(GOOD, 1, 3).verdict is Verdict.PASSED
    for moved, before, after, words in (
        (GOOD, 3, 3, "did not change"),
        (GOOD, 0, 3, "no sensors give"),
        (Moved(300, 0, -180, 30, -180, 0, 8, True), 1, 3, "did not follow"),
    ):
        finding = judge_halls(moved, before, after)
        assert finding.verdict is Verdict.FAILED and words in finding.sentence


def test_the_record_is_taken_up_again(tmp_path: Path) -> None:
    finding = Finding(Verdict.PASSED, "Good.", ("Go on.",), (("Counts", "5"),), "2026-11-22 12:00")
    record = Record("X", "ssc2", 4711, True).found("safety", finding).with_text("encoder", "distance", "2.5")
    assert keep(record, tmp_path) == ""
    again = resumed(tmp_path, "X", "ssc2", 4711)
    assert again == record
    assert resumed(tmp_path, "Y", "ssc2", 4711) == Record("Y", "ssc2", 4711)
    (tmp_path / record.name).write_text("{half", encoding="utf-8")
    assert resumed(tmp_path, "X", "ssc2", 4711) == Record("X", "ssc2", 4711)
    assert "cannot be kept" in keep(record, tmp_path / record.name)


def test_a_failed_step_opens_what_was_built_on_it() -> None:
    passed = Finding(Verdict.PASSED, "Good.")
    record = Record("X", "ssc2")
    for step in STEPS:
        record = record.found(step.key, passed)
    again = record.found("encoder", Finding(Verdict.FAILED, "Dead."))
    assert again.of("polarity").verdict is Verdict.OPEN
    assert again.of("safety").verdict is Verdict.PASSED
    polarity = next(step for step in STEPS if step.key == "polarity")
    assert "Encoder by hand" in again.missing(polarity, STEPS)


def test_every_axis_has_its_own_steps() -> None:
    servo, sine, stepper = (
        tuple(step.key for step in steps_for(*kind)) for kind in ((False, False), (False, True), (True, False))
    )
    assert set(sine) - set(servo) == {"phases", "zero", "halls"}
    assert set(servo) - set(stepper) == {"guards", "polarity"} and set(stepper) - set(servo) == {"stepper", "direction"}
    assert next(step for step in steps_for(True, False) if step.key == "encoder").optional  # l.601
    assert sine.index("zero") < sine.index("polarity")
    assert MOST == 2000
    assert all(step.source and step.manual and step.read and step.judged for step in STEPS)
