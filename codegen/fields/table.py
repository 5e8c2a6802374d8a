"""A table of numbers, kept as the text that was typed or pasted."""

from __future__ import annotations

import dataclasses as dc

from codegen.fields.field import Context
from codegen.fields.texts import Text
from codegen.tables import BadTable, Grid, read_table


@dc.dataclass(frozen=True, kw_only=True)
class Table(Text):
    """Rows of plain numbers; cells stand apart by tabs, semicolons or commas."""

    lines: bool = True
    fewest_rows: int = 1
    most_rows: int = 20000

    def wrong(self, value: str, context: Context) -> str | None:
        grid = read_table(value)
        if isinstance(grid, BadTable):
            return f"{self.label}: {grid.message}"
        if not self.fewest_rows <= len(grid.rows) <= self.most_rows:
            return f"{self.label} must have {self.fewest_rows} to {self.most_rows} rows, not {len(grid.rows)}"
        return None

    def empty(self, value: str) -> bool:
        return not value.strip()

    def text(self, value: str, context: Context) -> str:
        grid = read_table(value)
        count = len(grid.rows) if isinstance(grid, Grid) else 0
        return f"{count} row" if count == 1 else f"{count} rows"
