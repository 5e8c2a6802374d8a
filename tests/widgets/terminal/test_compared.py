"""Two programs side by side, line by line."""

from __future__ import annotations

import time

import pytest

from widgets.terminal.code_window import compared


def test_a_line_stands_behind_the_one_whose_place_it_took() -> None:
    mine = ["#A", "PR 100", "BG X", "AM X", "EN"]
    theirs = ["#A", "PR 200", "BG X", "WT 20", "WT 30", "EN", "#B"]
    assert list(compared(mine, theirs)) == [
        (" ", "#A"), ("-", "PR 100"), ("+", "PR 200"), (" ", "BG X"),
        ("-", "AM X"), ("+", "WT 20"), ("+", "WT 30"), (" ", "EN"), ("+", "#B"),
    ]  # fmt: skip
    assert list(compared([], ["EN"])) == [("+", "EN")]
    assert list(compared(mine, mine)) == [(" ", line) for line in mine]


@pytest.mark.alone
@pytest.mark.parametrize(
    "theirs", [[f"PR {number}" for number in range(1000, 2000)], ["EN"] * 1000, ["EN", "#A"] * 500]
)
def test_a_thousand_lines_take_no_time_to_speak_of(theirs: list[str]) -> None:
    """A click waits for it; four times what a DMC-141x holds (dmc-1412-1414.txt l.4835)."""
    mine = [f"PR {number}" for number in range(500)] + ["EN"] * 500
    before = time.thread_time()
    found = list(compared(mine, theirs))
    assert time.thread_time() - before < 0.05
    assert [line for sign, line in found if sign != "+"] == mine
    assert [line for sign, line in found if sign != "-"] == theirs
