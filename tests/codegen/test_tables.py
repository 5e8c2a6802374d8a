"""Tables as people paste them: no number is ever misread."""

from __future__ import annotations

from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from codegen.tables import BadTable, Grid, read_table, write_table


def cells(text: str) -> list[list[float | None]]:
    """The numbers of a table that can be read."""
    grid = read_table(text)
    assert isinstance(grid, Grid), grid
    return [[None if cell is None else float(cell) for cell in row] for row in grid.rows]


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("1\t2\n3\t4", [[1, 2], [3, 4]]),  # a spreadsheet
        ("1;2,5\r\n3;4", [[1, 2.5], [3, 4]]),  # a German CSV
        ("1,2\n3,4\n", [[1, 2], [3, 4]]),  # a CSV: the comma parts the cells
        ("1.5\n-2\n\n\n", [[1.5], [-2]]),  # one column, empty lines behind
        ("1\t\n\t2", [[1, None], [None, 2]]),
        ("0,5\t1,25", [[0.5, 1.25]]),
        (" 1 ;  2 ", [[1, 2]]),
    ],
)
def test_tables_that_are_read(text: str, wanted: list[list[float | None]]) -> None:
    assert cells(text) == wanted


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("1,234\t5", "row 1, cell 1: '1,234' can be read in two ways; write 1.234 or 1234"),
        ("1\t1,234,567", "row 1, cell 2: '1,234,567' can be read in two ways; write 1234567"),
        ("1\t2\n3", "row 2 has 1 cells, row 1 has 2"),
        ("1\t1.234,5", "row 1, cell 2: '1.234,5' is not a number"),
        ("1\tabc", "row 1, cell 2: 'abc' is not a number"),
        ("1e3", "row 1, cell 1: write 1000 without an exponent"),
        ("1 000", "row 1, cell 1: write 1000 without blanks"),
        ("−5", "row 1, cell 1: write -5 with a plain minus"),
    ],
)
def test_tables_that_are_refused_with_their_place(text: str, message: str) -> None:
    found = read_table(text)
    assert isinstance(found, BadTable) and found.message == message


@given(st.lists(st.lists(st.integers(-(10**7), 10**7), min_size=2, max_size=2), min_size=1, max_size=20))
def test_what_is_written_is_read_again(rows: list[list[int]]) -> None:
    texts = [[f"{cell / 1000:.3f}" for cell in row] for row in rows]
    grid = read_table(write_table(texts))
    assert isinstance(grid, Grid)
    assert grid.rows == tuple(tuple(Fraction(text) for text in row) for row in texts)


@given(st.text(st.sampled_from("0123456789.,;\t\n -+eE'"), max_size=40))
def test_anything_is_read_or_refused_in_one_sentence(text: str) -> None:
    found = read_table(text)
    assert isinstance(found, Grid) or (found.message and "\n" not in found.message)
