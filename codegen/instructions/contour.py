"""The group Motion: curves by time, as tables of small steps."""

# ruff: noqa: RUF009  (value() declares a field as dataclasses.field does)

from __future__ import annotations

import dataclasses as dc
from enum import StrEnum
from fractions import Fraction
from itertools import accumulate

from codegen.courses import Course, in_time, too_much
from codegen.fields import AxisSet, Choice, Flag, Table, value
from codegen.instructions.instruction import Group, Instruction
from codegen.numbers import plain
from codegen.setup import Setup
from codegen.sheets import INTERVAL, Column, Sheet, columns_of
from codegen.tables import LONGEST, Grid, read_table
from codegen.twoletter.commands import COMMANDS

INTERVALS = {2**n: n for n in range(1, 9)}  # ms: DT


class Every(StrEnum):
    MS2 = "2"
    MS4 = "4"
    MS8 = "8"
    MS16 = "16"
    MS32 = "32"
    MS64 = "64"
    MS128 = "128"
    MS256 = "256"


@dc.dataclass(frozen=True, kw_only=True)
class ContourMode(Instruction):
    """Any curve of positions, as a table of small steps."""

    title = "Contour Mode"
    group = Group.MOTION
    sentence = "Contour of {axes}: {table}[ of {interval}| {timed}][, then {wait}]"
    help = (
        "Each row of the table says how far the axes go in one interval; between the rows the speed stays even. One "
        "column for each axis, in user units; the first column can be the interval of the row in ms (2, 4, 8 … 256; "
        "empty: as the row before). Rows are added up before they are rounded, so that the end is where the table says."
    )

    axes: str = value(AxisSet(label="Axes", help="The axes that follow the table."), "X")
    timed: bool = value(
        Flag(
            label="First column is the interval",
            phrase="with intervals of their own",
            help="The first column of the table says how long each row takes, in ms.",
        ),
        False,
    )
    interval: Every = value(
        Choice(
            label="Interval",
            kind=Every,
            words={each: f"{each.value} ms" for each in Every},
            when={"timed": False},
            help="How long every row takes; a power of two of samples.",
        ),
        Every.MS16,
    )
    table: str = value(
        Table(label="Table", help="How far each axis goes in each interval; paste it from a spreadsheet."), ""
    )
    wait: bool = value(
        Flag(
            label="Wait until finished",
            phrase="wait until the profile has ended",
            help="Hold the program until the curve has ended.",
        ),
        True,
    )

    @property
    def column_axes(self) -> tuple[str, ...]:
        """Whose values stand in the columns; "" for the interval."""
        return (*(("",) if self.timed else ()), *self.axes)

    def sheet(self, setup: Setup) -> Sheet:
        """How the table is shown: behind each row the time at its end."""
        ends = tuple(plain(Fraction(round(each, 3))) for each in accumulate(self.lasting(setup)))
        columns = columns_of(self.axes, setup)
        if self.timed:
            columns = (Column("ms", INTERVAL), *columns)
        return Sheet(columns, "until ms", ends, LONGEST, steps=True)

    def lasting(self, setup: Setup) -> tuple[Fraction, ...]:
        """How long each row takes, in true ms."""
        return tuple(2**exponent * setup.sample / 1024 for exponent, _ in self.records())

    def courses(self, setup: Setup) -> tuple[Course, ...]:
        """How each axis goes along a correct table."""
        records = self.records() if self.own_problem() is None else ()
        if not records:
            return ()
        lasting = self.lasting(setup)
        return tuple(
            in_time(letter, [steps[place] for _, steps in records], lasting) for place, letter in enumerate(self.axes)
        )

    def records(self) -> tuple[tuple[int, tuple[Fraction, ...]], ...]:
        """The exponent of the interval and the step of each axis, row by row (of a correct table)."""
        grid = read_table(self.table)
        if not isinstance(grid, Grid):
            return ()
        exponent = INTERVALS[int(self.interval)]
        found = []
        for row in grid.rows:
            if self.timed and row[0] is not None:
                exponent = INTERVALS.get(int(row[0]), exponent)
            found.append((exponent, tuple(each or Fraction(0) for each in row[self.timed :])))
        return tuple(found)

    def own_problem(self) -> tuple[str, str] | None:
        grid = read_table(self.table)
        if not isinstance(grid, Grid):
            return None
        wanted = len(self.axes) + self.timed
        if grid.columns != wanted:
            first = ", the first for the interval" if self.timed else ""
            return "table", f"Table: it has {grid.columns} columns and needs {wanted}{first}"
        if self.timed and grid.rows[0][0] is None:
            return "table", "Table: row 1 has no interval"
        for number, every in enumerate(grid.column(0) if self.timed else ()):
            if every is not None and every not in INTERVALS:
                return "table", f"Table: row {number + 1} has the interval {plain(every)} ms; it must be 2, 4, 8 … 256"
        return None

    def setup_problem(self, setup: Setup) -> tuple[str, str] | None:
        furthest = int(COMMANDS["CD"].high or 0)
        for number, (_, steps) in enumerate(self.records()):
            for letter, step in zip(self.axes, steps, strict=True):
                if abs(step) * setup.axis(letter).scale > furthest - 1:  # rounding may add one
                    return "table", f"Table: row {number + 1} moves {letter} by more than {furthest} counts"
        return None

    def own_warning(self, setup: Setup) -> tuple[str, str] | None:
        """A speed or an acceleration the axis is not allowed."""
        told = next(filter(None, (too_much(course, setup, steps=True) for course in self.courses(setup))), None)
        return ("table", told) if told else None

    @classmethod
    def example(cls) -> ContourMode:
        return cls(interval=Every.MS4, table="0.012\n0.036\n0.06\n0.036\n0.012")
