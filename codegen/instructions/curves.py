"""The group Motion: curves given as tables, by time or by the position of a master."""

# ruff: noqa: RUF009  (value() declares a field as dataclasses.field does)

from __future__ import annotations

import dataclasses as dc
from enum import StrEnum
from fractions import Fraction
from itertools import pairwise

from codegen.fields import (
    AXES,
    NONE,
    AxisName,
    AxisSet,
    Choice,
    Dimension,
    Flag,
    ListOf,
    PathQuantity,
    PerAxis,
    PerAxisText,
    Quantity,
    Table,
    value,
    value_of,
)
from codegen.instructions.instruction import Group, Instruction
from codegen.numbers import plain
from codegen.setup import Setup
from codegen.tables import Grid, read_table
from codegen.twoletter.commands import COMMANDS

LONGEST_CYCLE = 8_388_607  # counts of the master (EM)
WIDEST_INTERVAL = 32767  # counts of the master between two points (EP)
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


def headings(letters: str, setup: Setup) -> tuple[str, ...]:
    """`Y in`: what stands above the columns of axes."""
    return tuple(f"{letter} {setup.axis(letter).symbol}" for letter in letters)


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

    def columns(self, setup: Setup) -> tuple[str, ...]:
        """What stands above the columns of the table."""
        return (*(("ms",) if self.timed else ()), *headings(self.axes, setup))

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
        """A speed the axis has never been allowed."""
        for number, (exponent, steps) in enumerate(self.records()):
            for letter, step in zip(self.axes, steps, strict=True):
                fastest = setup.bounds(Dimension.SPEED, letter)[1]
                speed = abs(step) * 1_024_000 / (2**exponent * setup.sample)
                if speed > fastest:
                    unit = setup.unit_text(Dimension.SPEED, letter)
                    return "table", f"Row {number + 1} is faster than {letter} may go: {float(speed):.6g} {unit}"
        return None

    @classmethod
    def example(cls) -> ContourMode:
        return cls(interval=Every.MS4, table="0.012\n0.036\n0.06\n0.036\n0.012")


class CamStep(StrEnum):
    DEFINE = "define"
    ENGAGE = "engage"
    DISENGAGE = "disengage"
    EXIT = "exit"


_DEFINE = {"step": CamStep.DEFINE}
_CHANGE = {"step": (CamStep.ENGAGE, CamStep.DISENGAGE)}


@dc.dataclass(frozen=True, kw_only=True)
class CamPlace:
    """A slave, and where the master is when it begins or ends to follow."""

    sentence = "{slave}[ when the master is at {at}]"

    slave: str = value(AxisName(label="Slave", help="The axis that follows."), "Y")
    at: str = value(
        PathQuantity(
            label="Master at",
            dimension=Dimension.POSITION,
            required=False,
            axis="master",
            help="Position of the master; empty, or outside its cycle: at once.",
        ),
        "",
    )


@dc.dataclass(frozen=True, kw_only=True)
class ElectronicCam(Instruction):
    """Slaves follow a table over each cycle of a master."""

    title = "Electronic Cam"
    group = Group.MOTION
    sentence = (
        "[Cam of {slaves} over {cycle} of {master}[ from {offset}]: {table}[, {enable}]"
        "|{step} {places}|{step} of the cam]"
    )
    help = (
        "The table says where each slave is at evenly spaced positions of the master, over one cycle; between them "
        "it goes straight. Define and switch it on first, then engage slaves. An engaged slave is renamed so that "
        "its position fits into the cycle. Disengaged, it stops at once. A position outside the cycle means at once."
    )

    step: CamStep = value(
        Choice(
            label="What",
            kind=CamStep,
            words={
                CamStep.DEFINE: "Define and switch on",
                CamStep.ENGAGE: "Engage slaves",
                CamStep.DISENGAGE: "Disengage slaves",
                CamStep.EXIT: "Leave cam mode",
            },
            phrases={
                CamStep.DEFINE: "Cam",
                CamStep.ENGAGE: "Engage",
                CamStep.DISENGAGE: "Disengage",
                CamStep.EXIT: "End",
            },
            help="The parts of a cam: define it, let slaves follow, let them go, leave it.",
        ),
        CamStep.DEFINE,
    )
    master: str = value(
        AxisName(
            label="Master",
            when={"step": (CamStep.DEFINE, CamStep.ENGAGE, CamStep.DISENGAGE)},
            help="The axis whose encoder leads; it need not be driven.",
        ),
        "X",
    )
    slaves: str = value(AxisSet(label="Slaves", when=_DEFINE, help="The axes of the table."), "Y")
    cycle: str = value(
        Quantity(
            label="Master cycle",
            dimension=Dimension.DISTANCE,
            axis="master",
            positive=True,
            literal=True,
            most_counts=LONGEST_CYCLE,
            when=_DEFINE,
            help="How far the master goes in one cycle.",
        ),
        "",
    )
    offset: str = value(
        Quantity(
            label="Master offset",
            dimension=Dimension.POSITION,
            axis="master",
            literal=True,
            required=False,
            when=_DEFINE,
            help="Position of the master at the first row of the table; empty: 0.",
        ),
        "",
    )
    change: PerAxisText = value(
        PerAxis(
            label="Change in a cycle",
            of=Quantity(label="Change in a cycle", dimension=Dimension.DISTANCE, literal=True),
            required=False,
            when=_DEFINE,
            help="How far the slave is away from its start after a cycle; empty: as the table says.",
        ),
        NONE,
    )
    table: str = value(
        Table(
            label="Table",
            fewest_rows=2,
            most_rows=257,
            when=_DEFINE,
            help="Positions of the slaves, one column each, at evenly spaced positions of the master: 2 to 257 rows.",
        ),
        "",
    )
    enable: bool = value(
        Flag(
            label="Switch it on",
            off_phrase="not yet switched on",
            when=_DEFINE,
            help="Starts cam mode; slaves follow once they are engaged.",
        ),
        True,
    )
    places: tuple[CamPlace, ...] = value(
        ListOf(
            label="Slaves and places",
            row=CamPlace,
            most=3,
            joint=" and ",
            axes="master",
            when=_CHANGE,
            help="Which slaves, and where the master is then.",
        ),
        (CamPlace(),),
    )

    @property
    def column_axes(self) -> tuple[str, ...]:
        """Whose values stand in the columns."""
        return tuple(self.slaves)

    def columns(self, setup: Setup) -> tuple[str, ...]:
        """What stands above the columns of the table."""
        return headings(self.slaves, setup)

    def own_problem(self) -> tuple[str, str] | None:
        if self.step is CamStep.DEFINE:
            return self._table_problem()
        if self.step is CamStep.EXIT:
            return None
        slaves = [row.slave for row in self.places]
        if self.master in slaves:
            return "places", f"Slaves and places: {self.master} is the master"
        twice = next((each for each in slaves if slaves.count(each) > 1), None)
        return ("places", f"Slaves and places: {twice} is there twice") if twice else None

    def _table_problem(self) -> tuple[str, str] | None:
        if self.master in self.slaves:
            return "slaves", f"Slaves: {self.master} is the master"
        for letter, text in zip(AXES, self.change, strict=True):
            if text and letter not in self.slaves:
                return "change", f"Change in a cycle: {letter} is no slave"
        grid = read_table(self.table)
        if not isinstance(grid, Grid):
            return None
        if grid.columns != len(self.slaves):
            return "table", f"Table: it has {grid.columns} columns; {len(self.slaves)} slaves need {len(self.slaves)}"
        for number, row in enumerate(grid.rows):
            if None in row:
                return "table", f"Table: row {number + 1} has an empty cell"
        return None

    def setup_problem(self, setup: Setup) -> tuple[str, str] | None:
        if setup.limits.family == "dmc141x":
            text = (
                "On this controller the auxiliary encoder leads, whose scale the setup does not hold: use 2-Letter Code"
            )
            return "step", text
        if self.step is not CamStep.DEFINE:
            return None
        cycle, grid = value_of(self.cycle), read_table(self.table)
        if not isinstance(grid, Grid) or not isinstance(cycle, Fraction):
            return None
        counts = setup.counts(Dimension.DISTANCE, self.master, cycle)
        apart = len(grid.rows) - 1
        if counts < apart:
            return "cycle", f"Master cycle: its {counts} counts are fewer than the rows of the table"
        if -(-counts // apart) > WIDEST_INTERVAL:
            return "table", f"Table: more rows are needed, at most {WIDEST_INTERVAL} counts of the master apart"
        for number, row in enumerate(grid.rows):
            for letter, cell in zip(self.slaves, row, strict=True):
                low, high = setup.bounds(Dimension.POSITION, letter)
                if cell is not None and not low <= cell <= high:
                    return "table", f"Table: row {number + 1} is outside what {letter} may do"
        return None

    def own_warning(self, setup: Setup) -> tuple[str, str] | None:
        if self.step is not CamStep.DEFINE:
            return None
        cycle, grid = value_of(self.cycle), read_table(self.table)
        if not isinstance(grid, Grid) or not isinstance(cycle, Fraction):
            return None
        counts, apart = setup.counts(Dimension.DISTANCE, self.master, cycle), len(grid.rows) - 1
        if counts % apart:
            return (
                "cycle",
                f"Master cycle: its {counts} counts do not divide into {apart} equal parts; the curve ends early",
            )
        return self._seam(setup, grid)

    def _seam(self, setup: Setup, grid: Grid) -> tuple[str, str] | None:
        """Where the slave jumps when the cycle begins again."""
        for place, letter in enumerate(self.slaves):
            cells = [cell or Fraction(0) for cell in grid.column(place)]
            given = value_of(self.change[AXES.index(letter)]) if self.change[AXES.index(letter)] else None
            off = abs(cells[-1] - cells[0]) - abs(given) if isinstance(given, Fraction) else Fraction(0)
            if off * setup.axis(letter).scale >= 1 or off * setup.axis(letter).scale <= -1:
                return (
                    "table",
                    f"{letter} jumps by {float(abs(off)):.6g} {setup.axis(letter).symbol} where the cycle begins again",
                )
            steps = [after - before for before, after in pairwise(cells)]
            bends = [abs(after - before) for before, after in pairwise(steps)]
            if bends and abs(steps[0] - steps[-1]) > 2 * max(bends):
                return "table", f"{letter} changes its speed at once where the cycle begins again"
        return None

    @classmethod
    def example(cls) -> ElectronicCam:
        return cls(cycle="4", table="0\n0.25\n1\n1.75\n2\n1.75\n1\n0.25\n0", slaves="Y")
