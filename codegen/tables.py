"""Tables of numbers as people paste them: from a spreadsheet (tabs), a CSV file (commas or semicolons), or typed.

A comma is a decimal sign only where tabs or semicolons part the cells, and only where it cannot be a separator
of thousands; everything else that could be read in two ways is refused with its row and column.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache

from codegen.numbers import looks_like_number, number_problem, parse_number

LONGEST = 20000  # rows; more than any controller holds
_THOUSANDS = re.compile(r"[+-]?\d{1,3}(,\d{3})+\Z", re.ASCII)
_GROUPED = re.compile(r"[+-]?[1-9]\d{0,2}((,\d{3})+(\.\d*)?|(\.\d{3})+,\d+)\Z", re.ASCII)  # 1,234.5 or 1.234,5
_DECIMAL_COMMA = re.compile(r"[+-]?\d*,\d+\Z", re.ASCII)


@dataclass(frozen=True, slots=True)
class Grid:
    """Rows of numbers; None is an empty cell. All rows have the same number of cells."""

    rows: tuple[tuple[Fraction | None, ...], ...]

    @property
    def columns(self) -> int:
        return len(self.rows[0]) if self.rows else 0

    def column(self, number: int) -> tuple[Fraction | None, ...]:
        """One column from top to bottom."""
        return tuple(row[number] for row in self.rows)


@dataclass(frozen=True, slots=True)
class BadTable:
    """What is wrong, in one sentence, and where (from 0)."""

    message: str
    row: int = 0
    column: int = 0


class _Wrong(Exception):
    def __init__(self, problem: BadTable) -> None:
        super().__init__(problem.message)
        self.problem = problem


@lru_cache(maxsize=256)
def read_table(text: str) -> Grid | BadTable:
    """The numbers in a table, or what is wrong with it; rows that are empty at the end do not count."""
    return _read(text, 0)


def read_pasted(text: str) -> Grid | BadTable:
    """As `read_table`, but a first line of words is taken as headings, and `0,5` alone is refused: one cell or two?"""
    lines = _lines(text)
    mark = separator(lines)
    first = [cell.strip() for cell in lines[0].split(mark)] if len(lines) > 1 else []
    headings = 1 if any(first) and all(map(_is_heading, filter(None, first))) else 0
    commas = [line.strip() for line in lines[headings:] if "," in line] if mark == "," else []
    if commas and all(_DECIMAL_COMMA.match(line) or _GROUPED.match(line) for line in commas):
        row = next(number for number, line in enumerate(lines) if line.strip() == commas[0])
        point = _with_point(commas[0])
        return BadTable(
            f"row {row + 1}: '{commas[0]}' can be one number or two; write {point}, or part the cells with tabs or ;",
            row,
        )
    return _read(text, headings)


def _with_point(text: str) -> str:
    """The one number that was probably meant."""
    if text.rfind(".") > text.rfind(",") or text.count(",") > 1:
        return text.replace(",", "")
    return text.replace(".", "").replace(",", ".")


def _is_heading(cell: str) -> bool:
    return any(letter.isalpha() for letter in cell) and not looks_like_number(cell)


def _lines(text: str) -> list[str]:
    lines = text.removeprefix("\N{BYTE ORDER MARK}").replace("\r\n", "\n").replace("\r", "\n").split("\n")
    while lines and not lines[-1].strip():
        lines.pop()
    return lines


def _read(text: str, headings: int) -> Grid | BadTable:
    """The numbers below the headings; rows are told as they stand in the text."""
    lines = _lines(text)
    if len(lines) - headings > LONGEST:
        return BadTable(f"the table has {len(lines)} rows; at most {LONGEST} are read")
    mark = separator(lines)
    rows = [line.split(mark) for line in lines[headings:]]
    try:
        cells = tuple(
            tuple(_cell(cell, number, place, mark) for place, cell in enumerate(row))
            for number, row in enumerate(rows, headings)
        )
    except _Wrong as wrong:
        return wrong.problem
    if mark != "," and (mixed := _both_signs(rows, headings)):
        return mixed
    uneven = next((number for number, row in enumerate(cells) if len(row) != len(cells[0])), None)
    if uneven is not None:
        row, first = uneven + headings, headings + 1
        return BadTable(
            f"row {row + 1} has {len(cells[uneven])} cells, row {first} has {len(cells[0])}", row, len(cells[uneven])
        )
    return Grid(cells)


def _both_signs(rows: Sequence[Sequence[str]], headings: int) -> BadTable | None:
    """Where commas are decimal signs a point parts thousands: `1.234` beside `2,5` may be 1234."""
    if not any(_DECIMAL_COMMA.match(cell.strip()) for row in rows for cell in row):
        return None
    for number, row in enumerate(rows, headings):
        for place, cell in enumerate(row):
            if "." in cell:
                words = f"'{cell.strip()}' has a point, other cells have a comma; write all of them with a point"
                return BadTable(f"row {number + 1}, cell {place + 1}: {words}", number, place)
    return None


def separator(lines: Sequence[str]) -> str:
    """What parts the cells: a tab, else a semicolon, else a comma."""
    return next((mark for mark in "\t;" if any(mark in line for line in lines)), ",")


def _cell(text: str, row: int, column: int, mark: str) -> Fraction | None:
    text = text.strip()
    if not text:
        return None
    if mark != "," and _THOUSANDS.match(text):
        whole, point = text.replace(",", ""), text.replace(",", ".", 1)
        either = f"{point} or {whole}" if text.count(",") == 1 else whole
        raise _Wrong(
            BadTable(f"row {row + 1}, cell {column + 1}: '{text}' can be read in two ways; write {either}", row, column)
        )
    if mark != "," and _DECIMAL_COMMA.match(text):
        text = text.replace(",", ".")
    number = parse_number(text)
    if number is None:
        raise _Wrong(BadTable(f"row {row + 1}, cell {column + 1}: {number_problem(text)}", row, column))
    return number


def write_table(rows: Sequence[Sequence[str]]) -> str:
    """Cells as text for a field, the clipboard or a file: tabs between cells, a line for each row."""
    return "\n".join("\t".join(cell.strip() for cell in row) for row in rows)
