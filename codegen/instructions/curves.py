"""The group Motion: curves given as tables by the position of a master."""

# ruff: noqa: RUF009  (value() declares a field as dataclasses.field does)

from __future__ import annotations

import dataclasses as dc
from enum import StrEnum
from fractions import Fraction
from itertools import pairwise

from codegen.courses import Course, along_master, too_much
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
from codegen.numbers import decimal, parse_number, shown
from codegen.setup import Setup
from codegen.sheets import Sheet, columns_of
from codegen.tables import Grid, read_table

LONGEST_CYCLE = 8_388_607  # counts of the master (EM)
WIDEST_INTERVAL = 32767  # counts of the master between two points (EP)
MOST_POINTS = 257


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
    fastest: str = value(
        Quantity(
            label="Top master speed",
            dimension=Dimension.SPEED,
            axis="master",
            positive=True,
            literal=True,
            required=False,
            when=_DEFINE,
            help="How fast the master ever goes, to check the slaves with; empty: its top speed in the setup.",
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
            most_rows=MOST_POINTS,
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

    def sheet(self, setup: Setup) -> Sheet:
        """How the table is shown: before each row the place of the master."""
        grid, cycle = read_table(self.table), value_of(self.cycle) if self.cycle else None
        leads: tuple[str, ...] = ()
        if isinstance(grid, Grid) and isinstance(cycle, Fraction) and len(grid.rows) > 1:
            first, apart = self._first(), cycle / (len(grid.rows) - 1)
            leads = tuple(shown(first + apart * number) for number in range(len(grid.rows)))
        lead = f"{self.master} {setup.axis(self.master).symbol}"
        return Sheet(columns_of(self.slaves, setup), lead, leads, MOST_POINTS)

    def _first(self) -> Fraction:
        first = value_of(self.offset) if self.offset.strip() else Fraction(0)
        return first if isinstance(first, Fraction) else Fraction(0)

    def master_speed(self, setup: Setup) -> Fraction | None:
        """How fast the master goes at most, in its unit: as said here, else as its top speed in the setup says."""
        given = value_of(self.fastest) if self.fastest.strip() else parse_number(setup.axis(self.master).maximum_speed)
        return given if isinstance(given, Fraction) and given > 0 else None

    def courses(self, setup: Setup) -> tuple[Course, ...]:
        """How each slave goes along a correct table while the master goes at its top speed (or 1 unit/s)."""
        grid, cycle = read_table(self.table), value_of(self.cycle) if self.cycle else None
        whole = isinstance(grid, Grid) and grid.columns == len(self.slaves) and len(grid.rows) > 1
        if not isinstance(grid, Grid) or not whole or not isinstance(cycle, Fraction) or cycle <= 0:
            return ()
        speed = self.master_speed(setup) or Fraction(1)
        return tuple(
            along_master(letter, [cell or Fraction(0) for cell in grid.column(place)], self._first(), cycle, speed)
            for place, letter in enumerate(self.slaves)
        )

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
            parts = f"its {counts} counts do not divide into {apart} equal parts"
            return "cycle", f"Master cycle: {parts}, so the curve ends early: {self._remedy(setup, counts, apart)}"
        return self._seam(setup, grid) or self._too_fast(setup)

    def _remedy(self, setup: Setup, counts: int, apart: int) -> str:
        """A cycle near this one that divides, and a number of rows near this one that does."""
        near = max(round(Fraction(counts, apart)), 1) * apart
        places = len(str(int(setup.axis(self.master).scale))) + 1
        exact = setup.from_counts(Dimension.DISTANCE, self.master, near)
        advice = f"write {decimal(exact, places)} {setup.axis(self.master).symbol} ({near} counts)"
        others = (apart + sign * off for off in range(1, apart) for sign in (1, -1))
        rows = next((each for each in others if each < MOST_POINTS and counts % each == 0 and each > 1), None)
        return f"{advice}, or use {rows + 1} rows" if rows else advice

    def _too_fast(self, setup: Setup) -> tuple[str, str] | None:
        """A slave that would have to go faster, or speed up harder, than it may."""
        speed = self.master_speed(setup)
        if speed is None:
            return None
        because = f" with {self.master} at {shown(speed)} {setup.unit_text(Dimension.SPEED, self.master)}"
        told = next(filter(None, (too_much(each, setup, because) for each in self.courses(setup))), None)
        return ("table", told) if told else None

    def _seam(self, setup: Setup, grid: Grid) -> tuple[str, str] | None:
        """Where the slave jumps, or changes its speed at once, when the cycle begins again."""
        for place, letter in enumerate(self.slaves):
            cells, symbol = [cell or Fraction(0) for cell in grid.column(place)], setup.axis(letter).symbol
            text = self.change[AXES.index(letter)]
            given = value_of(text) if text else None
            off = abs(cells[-1] - cells[0]) - abs(given) if isinstance(given, Fraction) else Fraction(0)
            if abs(off) * setup.axis(letter).scale >= 1:
                return "table", f"{letter} jumps by {float(abs(off)):.6g} {symbol} where the cycle begins again"
            steps = [after - before for before, after in pairwise(cells)]
            bends = [abs(after - before) for before, after in pairwise(steps)]
            jump = abs(steps[0] - steps[-1])
            if bends and jump > 2 * max(bends) and jump * setup.axis(letter).scale > 1:
                return "table", f"{letter} changes its speed at once where the cycle begins again"
        return None

    @classmethod
    def example(cls) -> ElectronicCam:
        return cls(cycle="4", table="0\n0.25\n1\n1.75\n2\n1.75\n1\n0.25\n0", slaves="Y")
