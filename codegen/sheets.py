"""A table as a sheet of cells: what its columns are, and every change a person can make to them.

Cells are texts that `read_table` reads; a change answers the new cells, or in one sentence why it cannot be made, and
then nothing has changed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, TypeAlias

from codegen.numbers import decimal, number_problem, parse_number, plain
from codegen.tables import BadTable, Grid, read_pasted, read_table, separator, write_table

if TYPE_CHECKING:
    from codegen.setup import Setup

Cells: TypeAlias = tuple[tuple[str, ...], ...]
INTERVAL = ""  # the letter of a column that is no axis


@dataclass(frozen=True, slots=True)
class Column:
    """What stands above a column, whose values it holds, and the decimals in which a tenth of a count shows."""

    heading: str
    letter: str
    places: int = 0


@dataclass(frozen=True, slots=True)
class Sheet:
    """The columns of a table; `lead` is what stands above the column in front, which tells where each row is."""

    columns: tuple[Column, ...]
    lead: str
    leads: tuple[str, ...]  # where each row is, as far as that is known
    most_rows: int
    steps: bool = False  # rows are steps that add up, and an interval may be left empty

    def column_of(self, letter: str) -> int:
        """Where the values of an axis stand."""
        return next(number for number, column in enumerate(self.columns) if column.letter == letter)


def columns_of(letters: str, setup: Setup) -> tuple[Column, ...]:
    """`Y in`: one column for each axis."""
    return tuple(
        Column(f"{letter} {setup.axis(letter).symbol}", letter, len(str(int(setup.axis(letter).scale))) + 1)
        for letter in letters
    )


# ------------------------------------------------------------------ text and cells


def cells_of(text: str, columns: int) -> Cells:
    """The cells of a text, no fewer than `columns` in a row; numbers in the one way that is always read alike."""
    lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    while lines and not lines[-1].strip():
        lines.pop()
    mark = separator(lines)
    rows = [[cell.strip() for cell in line.split(mark)] for line in lines]
    grid = read_table(text)
    if isinstance(grid, Grid):
        rows = [
            [
                old if parse_number(old) is not None or new is None else plain(new)
                for old, new in zip(*pair, strict=True)
            ]
            for pair in zip(rows, grid.rows, strict=True)
        ]
    wide = max([columns, *map(len, rows)])
    return tuple((*row, *[""] * (wide - len(row))) for row in rows)


def _clear(text: str, number: Fraction | None) -> str:
    """What was typed, unless a decimal comma stands in it."""
    return text if number is None or parse_number(text) is not None else plain(number)


def text_of(cells: Cells) -> str:
    """As a field keeps them and a spreadsheet takes them."""
    return write_table(cells)


def csv_of(sheet: Sheet, cells: Cells) -> str:
    """As a file: headings, semicolons, decimal points."""
    lines = [";".join(column.heading for column in sheet.columns), *(";".join(row) for row in cells)]
    return "".join(f"{line}\n" for line in lines)


# ------------------------------------------------------------------------ changes


def cell_problem(sheet: Sheet, column: int, text: str) -> str | None:
    """Why a text cannot stand in a cell."""
    if not text.strip():
        may_be_empty = sheet.steps and column < len(sheet.columns) and sheet.columns[column].letter == INTERVAL
        return None if may_be_empty else "a number is missing"
    return number_problem(text)


def with_cell(cells: Cells, row: int, column: int, text: str) -> Cells:
    """One cell replaced."""
    line = cells[row]
    return (*cells[:row], (*line[:column], text.strip(), *line[column + 1 :]), *cells[row + 1 :])


def with_row(sheet: Sheet, cells: Cells, at: int) -> Cells | BadTable:
    """A row before that place: of positions half-way between its neighbours, of steps one that stands still."""
    if len(cells) >= sheet.most_rows:
        return BadTable(f"The table is full: {sheet.most_rows} rows")
    new = tuple(_between(sheet, cells, at, place) for place in range(len(sheet.columns)))
    return (*cells[:at], new, *cells[at:])


def _between(sheet: Sheet, cells: Cells, at: int, place: int) -> str:
    column = sheet.columns[place]
    if column.letter == INTERVAL:
        return cells[max(at - 1, 0)][place] if cells else "16"
    if sheet.steps:
        return "0"
    around = [parse_number(cells[row][place]) for row in (at - 1, at) if 0 <= row < len(cells)]
    known = [each for each in around if each is not None]
    if not known:
        return "0"
    middle = sum(known, Fraction(0)) / len(known)
    return plain(middle) if len(known) == 1 else decimal(middle, column.places)


def without_rows(cells: Cells, rows: Sequence[int]) -> Cells:
    """Some rows taken out."""
    return tuple(row for number, row in enumerate(cells) if number not in rows)


def pasted(sheet: Sheet, cells: Cells, row: int, column: int, text: str) -> Cells | BadTable:
    """A block of numbers over the cells from there on, with new rows where it is longer; all of it or nothing."""
    grid = read_pasted(text)
    if isinstance(grid, BadTable):
        return grid
    if not grid.rows:
        return BadTable("there are no numbers in it")
    room = len(sheet.columns) - column
    if grid.columns > room:
        first = sheet.columns[column].heading
        return BadTable(f"it has {grid.columns} columns; from “{first}” on there {_are(room)}")
    if row + len(grid.rows) > sheet.most_rows:
        return BadTable(f"with its {len(grid.rows)} rows the table would have more than {sheet.most_rows}")
    made = [list(line) for line in cells]
    blank = [""] * max([len(sheet.columns), *map(len, cells)])
    for down, numbers in enumerate(grid.rows):
        if row + down == len(made):
            made.append(list(blank))
        for aside, number in enumerate(numbers):
            cell = "" if number is None else plain(number)
            if problem := cell_problem(sheet, column + aside, cell):
                return BadTable(f"row {down + 1}, cell {aside + 1}: {problem}", down, aside)
            made[row + down][column + aside] = cell
    return tuple(map(tuple, made))


def _are(count: int) -> str:
    return "is 1" if count == 1 else f"are {count}"


def filled(sheet: Sheet, cells: Cells, row: int, column: int, texts: Sequence[str]) -> Cells | BadTable:
    """One column from a row on, with new rows where it is longer."""
    return pasted(sheet, cells, row, column, "\n".join(texts))


def with_columns(cells: Cells, before: Sequence[str], after: Sequence[str], kept: dict[str, tuple[str, ...]]) -> Cells:
    """The columns of other axes: those that stay move along, new ones take what `kept` remembers of them."""
    known = {**kept, **{letter: tuple(row[place] for row in cells) for place, letter in enumerate(before)}}
    blank = ("",) * len(cells)
    chosen = [known.get(letter, blank) for letter in after]
    return tuple(zip(*(each if len(each) == len(cells) else blank for each in chosen), strict=True))


# ---------------------------------------------------------------- steps as positions


def positions(cells: Cells, column: int) -> tuple[str, ...]:
    """Where an axis is after each row of steps."""
    total, found = Fraction(0), []
    for row in cells:
        total += parse_number(row[column]) or Fraction(0)
        found.append(plain(total))
    return tuple(found)


def with_position(cells: Cells, row: int, column: int, place: Fraction) -> Cells:
    """Steps that lead elsewhere in one row, and nowhere else."""
    here = parse_number(positions(cells, column)[row]) or Fraction(0)
    moved = place - here
    step = parse_number(cells[row][column]) or Fraction(0)
    cells = with_cell(cells, row, column, plain(step + moved))
    if row + 1 < len(cells):
        following = parse_number(cells[row + 1][column]) or Fraction(0)
        cells = with_cell(cells, row + 1, column, plain(following - moved))
    return cells


def as_steps(texts: Sequence[str], before: Fraction) -> tuple[str, ...]:
    """Positions as the steps between them, the first from where the axis is before."""
    found = []
    for text in texts:
        place = parse_number(text) or Fraction(0)
        found.append(plain(place - before))
        before = place
    return tuple(found)
