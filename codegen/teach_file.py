"""Teach data files (`.tlt`): the table as text with tabs, which people and spreadsheets can read.

The first line names the format, the last one counts the rows, so that half a file is not taken for a whole one.
"""

from __future__ import annotations

from pathlib import Path

from codegen.disk import FileUnreadable, save_text
from codegen.fields import Number, Quantity, fields_of
from codegen.numbers import number_problem
from codegen.teach import BYTE, COLUMNS, MOST_ROWS, ON, Row, Table, label_of, shown_text, typed_text, unit_row

FORMAT, VERSION, LAST = "Twoletter teach data", 1, "End"
LARGEST = 1_000_000  # bytes; a full table has a tenth of that


def text_of(table: Table) -> str:
    """The table as it is written; `table_of` gives the same one back."""
    lines = [f"{FORMAT} {VERSION}", "\t".join(_headings()), "\t".join(("Unit", *unit_row(table)))]
    for number, row in enumerate(table.rows, 1):
        lines.append("\t".join((str(number), *(shown_text(getattr(row, column)) for column in COLUMNS))))
    return "\n".join((*lines, f"{LAST}\t{len(table)}", ""))


def table_of(text: str) -> Table:
    """The table of a text; raises FileUnreadable with what is wrong and in which line."""
    lines = text.replace("\r\n", "\n").rstrip("\n").split("\n")
    _first(lines[0])
    if len(lines) < 4 or lines[1].split("\t") != _headings():
        raise FileUnreadable("line 2 does not name the columns of a teach table")
    name, *units = lines[2].split("\t")
    first, second = (*units, "", "")[:2]
    table = Table((first, second))
    if name != "Unit" or len(units) != len(COLUMNS) or not all(table.units) or tuple(units) != unit_row(table):
        raise FileUnreadable("line 3 does not name the unit of every column")
    last = lines[-1].split("\t")
    if last[0] != LAST:
        raise FileUnreadable("its end is missing: it was not written or copied as a whole")
    rows = tuple(_row(line, number) for number, line in enumerate(lines[3:-1], 1))
    if last[1:] != [str(len(rows))]:
        raise FileUnreadable(f"it ends with “{lines[-1]}” but has {len(rows)} rows: some are missing or were added")
    if len(rows) > MOST_ROWS:
        raise FileUnreadable(f"it has {len(rows)} rows; a table takes {MOST_ROWS}")
    return Table(table.units, rows)


def _first(line: str) -> None:
    if not line.startswith(f"{FORMAT} "):
        raise FileUnreadable("it is no teach data: its first line says something else")
    version = line.removeprefix(f"{FORMAT} ")
    if version != str(VERSION):
        raise FileUnreadable(f"it is of version “{version}”; this program reads version {VERSION}")


def _headings() -> list[str]:
    return ["Data", *(label_of(column) for column in COLUMNS)]


def _row(line: str, number: int) -> Row:
    where = f"line {number + 3}"
    name, *cells = line.split("\t")
    if name != str(number):
        raise FileUnreadable(f"{where} should be row {number}, but says “{name[:20]}”")
    if len(cells) != len(COLUMNS):
        raise FileUnreadable(f"{where} has {len(cells)} values; a row has {len(COLUMNS)}")
    for column, cell in zip(COLUMNS, cells, strict=True):
        if problem := _damaged(column, cell):
            raise FileUnreadable(f"{where}, {label_of(column)}: {problem}")
    return Row(**{column: typed_text(cell) for column, cell in zip(COLUMNS, cells, strict=True)})


def _damaged(column: str, cell: str) -> str | None:
    """Why a cell is nothing that a table can hold on any machine."""
    text = typed_text(cell)
    if not cell or (text != cell and text):
        return "an empty value is written x" if not cell else "blanks around a value"
    if not text:
        return None
    if column == "through":
        return None if text == ON else f"'{text}' is neither {ON} nor x"
    if column == "output" and BYTE.match(text):
        return None
    field = fields_of(Row)[column]
    problem = number_problem(text)
    if isinstance(field, Quantity | Number) or problem is None:
        return problem
    return f"'{text}' is no number of an input or output"


def save(path: Path, table: Table) -> None:
    """Writes the file; a crash leaves the old one whole."""
    save_text(path, text_of(table))


def load(path: Path) -> Table:
    """Opens a file; raises FileUnreadable with its name and what is wrong."""
    with path.open("rb") as file:
        data = file.read(LARGEST + 1)
    try:
        if len(data) > LARGEST:
            raise FileUnreadable("it is too large for teach data")
        return table_of(data.decode("utf-8-sig"))
    except UnicodeDecodeError as error:
        raise FileUnreadable(f"{path.name}: it is no text in UTF-8") from error
    except FileUnreadable as error:
        raise FileUnreadable(f"{path.name}: {error}") from error
