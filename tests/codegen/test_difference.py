"""Differences of file, controller and EEPROM: nothing lost, nothing invented, nothing said where all agree."""

from __future__ import annotations

import dataclasses as dc
from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st

from codegen.difference import Line, differences, matches, rows
from codegen.difference_values import ValueDifference, value_differences, wanted
from codegen.setup import Setup, Unit

ONE = 65536
TEXT = st.lists(st.sampled_from(["#A", "PR 10", "PR 12", "BG X", "AM X", "WT 5", "EN", "SB 1", "JP #A"]), max_size=9)
MAYBE = st.none() | TEXT


def lines(texts: list[str] | None) -> tuple[Line, ...] | None:
    return None if texts is None else tuple(Line(text) for text in texts)


@given(TEXT, TEXT)
def test_matches_are_equal_lines_and_rise_on_both_sides(ours: list[str], theirs: list[str]) -> None:
    found = matches(ours, theirs)
    assert all(ours[a] == theirs[b] for a, b in found)
    assert all(a < c and b < d for (a, b), (c, d) in pairwise(found))


@given(TEXT, TEXT, TEXT)
def test_rows_hold_every_line_of_all_three_in_its_order(file: list[str], ram: list[str], rom: list[str]) -> None:
    found = rows(file, ram, rom)
    for place, texts in enumerate((file, ram, rom)):
        assert [row[place] for row in found if row[place] is not None] == list(range(len(texts)))
    for f, c, e in found:  # what stands in one row is one and the same line
        assert len({*(file[n] for n in (f,) if n is not None), *(ram[n] for n in (c,) if n is not None),
                    *(rom[n] for n in (e,) if n is not None)}) == 1  # fmt: skip


@given(MAYBE, MAYBE, MAYBE)
def test_there_are_differences_exactly_where_the_known_ones_differ(
    file: list[str] | None, ram: list[str] | None, rom: list[str] | None
) -> None:
    there = [texts for texts in (file, ram, rom) if texts is not None]
    found = differences(lines(file), lines(ram), lines(rom))
    assert bool(found) == any(texts != there[0] for texts in there[1:])
    for place, texts in enumerate((file, ram, rom)):
        cells = [each.cells[place] for each in found]
        assert all((cell is None) == (texts is None) for cell in cells)
        for cell in cells:
            if cell is not None and texts is not None and cell.lines:
                assert tuple(texts[cell.first : cell.first + len(cell.lines)]) == cell.lines


@given(TEXT, TEXT)
def test_each_line_that_is_not_common_is_told_once(file: list[str], ram: list[str]) -> None:
    common = matches(file, ram)
    told = differences(lines(file), lines(ram), None)
    assert sum(len(each.cells[0].lines) for each in told if each.cells[0]) == len(file) - len(common)
    assert sum(len(each.cells[1].lines) for each in told if each.cells[1]) == len(ram) - len(common)


MOVE = "Move X by 10 mm at 5 mm/s"
FILE = (
    Line("#CUTTER"), Line("PR 10000", MOVE, "s1"), Line("BG X", MOVE, "s1"), Line("WT 20", "Wait 20 ms", "s2"),
    Line("EN"),
)  # fmt: skip


def changed(number: int, text: str, words: str = "") -> tuple[Line, ...]:
    new = Line(text, words, FILE[number].step if words else "")
    return (*FILE[:number], new, *FILE[number + 1 :])


def test_a_changed_step_is_said_in_the_words_of_both() -> None:
    (found,) = differences(FILE, changed(1, "PR 12000", "Move X by 12 mm at 5 mm/s"), None)
    assert found.words(1) == f"Changed: {MOVE} – in the controller: Move X by 12 mm at 5 mm/s"
    assert found.words(2) == ""


def test_a_line_nobody_knows_is_said_as_it_stands() -> None:
    (found,) = differences(FILE, changed(1, "PR 12000"), None)
    assert found.words(1) == f"Changed: {MOVE} – in the controller: PR 12000"


def test_added_and_removed_steps() -> None:
    more = (*FILE[:4], Line("SB 1"), FILE[4])
    assert [each.words(1) for each in differences(FILE, more, None)] == ["Only in the controller: SB 1"]
    less = (*FILE[:3], FILE[4])
    assert [each.words(1) for each in differences(FILE, less, None)] == ["Missing in the controller: Wait 20 ms"]


def test_what_was_burned_before_the_last_download_differs_in_the_eeprom_only() -> None:
    (found,) = differences(FILE, FILE, changed(3, "WT 50", "Wait 50 ms"))
    assert found.same(0, 1) is True and found.same(1, 2) is False
    assert found.words(1) == "" and found.words(2) == "Changed: Wait 20 ms – in the EEPROM: Wait 50 ms"


def test_two_steps_that_changed_side_by_side_are_two_differences() -> None:
    ram = (FILE[0], Line("PR 5", "Move X by 5 mm", "s1"), FILE[2], Line("WT 9", "Wait 9 ms", "s2"), FILE[4])
    assert len(differences(FILE, ram, None)) == 2
    both = (Line("PR 1", "one", "s1"), Line("WT 1", "two", "s2"))
    others = (Line("PR 2", "one there", "s1"), Line("WT 2", "two there", "s2"))
    assert [each.words(1) for each in differences(both, others, None)] == [
        "Changed: one – in the controller: one there",
        "Changed: two – in the controller: two there",
    ]


# ------------------------------------------------------------------------- values


def machine() -> Setup:
    setup = Setup(model="ssc2")
    axis = dc.replace(setup.axis("X"), unit=Unit.MM, counts_per_unit="1000", kp="12.25", forward_limit="200")
    return setup.with_axis("X", axis)


def said(**values: int) -> list[ValueDifference]:
    """The differences to a controller that holds what the setup wants, but for these."""
    setup = machine()
    there = {**wanted(setup), **{(name, "X"): value for name, value in values.items()}}
    return list(value_differences(wanted(setup), there, None, setup))


def test_a_setup_wants_its_values_in_the_registers() -> None:
    values = wanted(machine())
    assert values["KP", "X"] == 12 * ONE + ONE // 4  # 12.25
    assert values["FL", "X"] == 200 * 1000 * ONE  # 200 mm of 1000 counts
    assert ("KP", "Y") not in values  # never set up: nothing is wanted there


def test_a_value_that_differs_is_said_in_units() -> None:
    assert said() == []
    (found,) = said(FL=150 * 1000 * ONE)
    assert found.words(1) == (
        "Forward software limit of X (FL) is 150 mm (150000 counts) in the controller, "
        "200 mm (200000 counts) in the file"
    )


def test_what_the_controller_rounds_away_is_no_difference() -> None:
    """KP has steps of 1/8 (commands.json, KP)."""
    assert said(KP=12 * ONE + ONE // 4 + ONE // 8 - 1) == []
    assert [each.key for each in said(KP=12 * ONE + ONE // 4 + ONE // 8)] == [("KP", "X")]


def test_variables_are_compared_to_the_last_bit() -> None:
    setup = machine()
    found = list(value_differences(None, {("LEN", ""): ONE}, {("LEN", ""): ONE + 1}, setup))
    assert [each.title for each in found] == ["LEN"]
    assert list(value_differences(None, {("LEN", ""): ONE}, None, setup)) == []
