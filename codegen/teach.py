"""The teach table: places that two axes were driven to, with speeds, waits and outputs (SSC manual l.2759-2802).

A row is a coordinated move of both axes, a wait for an input, an output, a pause, or several of these in this order.
What is not applicable is empty here, and `x` where people see it.
"""

from __future__ import annotations

import dataclasses as dc
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

from codegen.bows import Bow, Point, through_ends
from codegen.fields import Context, Dimension, Field, Number, PathQuantity, Quantity, fields_of, value
from codegen.numbers import number_problem, parse_number, plain
from codegen.setup import Setup

NOT_APPLICABLE = "x"
MOST_ROWS = 900  # a controller's memory holds a thousand lines (SSC manual l.1530)
LONGEST_CHAIN = 500  # rows without a stop; the controller's buffer holds 511 segments (commands.md, coordinated motion)
WIDEST_ARC = 350  # degrees; a nearly whole circle is not known well from its ends
COARSEST = 25  # counts of the coarser axis between places that are whole in both
BYTE = re.compile(r"0[xX][0-9A-Fa-f]{2}\Z", re.ASCII)


@dc.dataclass(frozen=True, kw_only=True)
class Signed(Field):
    """An input or output by number, low or off where it is negative."""

    def wrong(self, value: str, context: Context) -> str | None:
        return _channel_problem(self.label, value, self.channels(context.setup))

    def channels(self, setup: Setup) -> int:
        """How many there are."""
        return setup.inputs


@dc.dataclass(frozen=True, kw_only=True)
class OutputOrByte(Signed):
    """One output, or all of them at once as `0x00` … `0xFF` (SSC manual l.2792)."""

    def wrong(self, value: str, context: Context) -> str | None:
        if not BYTE.match(value):
            found = super().wrong(value, context)
            return found and f"{found}, or all outputs at once: 0x00 to 0x{self._most(context.setup):02X}"
        most = self._most(context.setup)
        if int(value, 16) > most:
            return f"{self.label}: this controller has {self.channels(context.setup)} outputs: 0x00 to 0x{most:02X}"
        return None

    def channels(self, setup: Setup) -> int:
        return setup.outputs

    def _most(self, setup: Setup) -> int:
        return (1 << min(self.channels(setup), 8)) - 1


@dc.dataclass(frozen=True, kw_only=True)
class GoesOn(Field):
    """`on` where the path goes on without a stop."""

    def wrong(self, value: str, context: Context) -> str | None:
        return None if value == ON else f"{self.label}: write on, or x to stop there"


def _channel_problem(label: str, text: str, most: int) -> str | None:
    number = parse_number(text)
    if number is None or number.denominator != 1 or not 1 <= abs(number) <= most:
        return f"{label}: write 1 to {most}, or -1 to -{most}"
    return None


ON = "on"
_PLACE = "Where the row's move ends, measured from home."


@dc.dataclass(frozen=True, kw_only=True)
class Row:
    """One row; every value is kept as it was typed, empty where it does not apply."""

    x: str = value(Quantity(label="Pos X", dimension=Dimension.POSITION, literal=True, required=False, help=_PLACE))
    y: str = value(Quantity(label="Pos Y", dimension=Dimension.POSITION, literal=True, required=False, help=_PLACE))
    speed: str = value(
        PathQuantity(
            label="Speed", dimension=Dimension.SPEED, positive=True, literal=True, required=False, least_counts=2,
            help="Along the line from place to place.",
        )
    )  # fmt: skip
    acceleration: str = value(
        PathQuantity(
            label="Accel", dimension=Dimension.ACCELERATION, positive=True, literal=True, required=False,
            help="How quickly the move gets fast.",
        )
    )  # fmt: skip
    deceleration: str = value(
        PathQuantity(
            label="Decel", dimension=Dimension.ACCELERATION, positive=True, literal=True, required=False,
            help="How quickly it gets slow.",
        )
    )  # fmt: skip
    wait: str = value(
        Signed(label="Wait input", required=False, help="Waits until an input is high; negative: until it is low.")
    )
    output: str = value(
        OutputOrByte(
            label="Output", required=False, help="1 to 8 on, -1 to -8 off, or all outputs at once: 0x00 to 0xFF."
        )
    )
    pause: str = value(
        Quantity(
            label="Pause", dimension=Dimension.TIME, axis="", positive=True, literal=True, required=False,
            help="Stands still so long.",
        )
    )  # fmt: skip
    sweep: str = value(
        Number(
            label="Arc", low=-WIDEST_ARC, high=WIDEST_ARC, suffix="°", literal=True, required=False,
            help="The move is an arc of so many degrees; positive is counter-clockwise. x: a straight line.",
        )
    )  # fmt: skip
    through: str = value(
        GoesOn(label="Go on", required=False, help="on: the path goes on into the next row without a stop.")
    )

    @property
    def moves(self) -> bool:
        """Whether the row has a place."""
        return bool(self.x and self.y)

    @property
    def is_empty(self) -> bool:
        return self == Row()


COLUMNS: tuple[str, ...] = tuple(fields_of(Row))
OF_A_MOVE = ("speed", "acceleration", "deceleration", "sweep", "through")
USUAL = COLUMNS[:7]  # those of the manual; the others come with recorded paths


@dc.dataclass(frozen=True)
class Table:
    """Rows, and the units in which their numbers were taught (of X and of Y)."""

    units: tuple[str, str] = ("in", "in")
    rows: tuple[Row, ...] = ()

    def __len__(self) -> int:
        return len(self.rows)


class Wrong(NamedTuple):
    """What is wrong in the table: row (from 0), column, and one sentence."""

    row: int
    column: str
    sentence: str


def label_of(column: str) -> str:
    """The heading of a column."""
    return fields_of(Row)[column].label


def shown_text(text: str) -> str:
    """A cell as people see it."""
    return text or NOT_APPLICABLE


def typed_text(text: str) -> str:
    """What a person typed into a cell, as it is kept."""
    text = text.strip()
    return "" if text.lower() == NOT_APPLICABLE else text


def unit_row(table: Table) -> tuple[str, ...]:
    """The second row of the table: the unit of each column."""
    first = table.units[0]
    units = {"x": first, "y": table.units[1], "speed": f"{first}/s", "pause": "ms", "sweep": "°"}
    units |= dict.fromkeys(("acceleration", "deceleration"), f"{first}/s²")
    return tuple(units.get(column, "-") for column in COLUMNS)


def units_of(setup: Setup) -> tuple[str, str]:
    """The units that a table for this machine has."""
    return setup.axis("X").symbol, setup.axis("Y").symbol


# --------------------------------------------------------------------- edits


def with_cell(table: Table, row: int, column: str, text: str) -> Table:
    """The table with one cell changed."""
    rows = list(table.rows)
    rows[row] = dc.replace(rows[row], **{column: typed_text(text)})
    return dc.replace(table, rows=tuple(rows))


def with_values(table: Table, rows: Iterable[int], values: Mapping[str, str]) -> Table:
    """Speed and ramps of several rows at once; rows without a place keep none."""
    chosen = set(rows)
    made = (dc.replace(row, **values) if n in chosen and row.moves else row for n, row in enumerate(table.rows))
    return dc.replace(table, rows=tuple(made))


def inserted(table: Table, at: int, rows: Sequence[Row]) -> Table:
    """The table with more rows."""
    return dc.replace(table, rows=(*table.rows[:at], *rows, *table.rows[at:]))


def deleted(table: Table, rows: Iterable[int]) -> Table:
    """The table without some rows."""
    gone = set(rows)
    return dc.replace(table, rows=tuple(row for n, row in enumerate(table.rows) if n not in gone))


def place_text(setup: Setup, letter: str, counts: int) -> str:
    """A place as the table keeps it: so exact that it leads back to the same count."""
    return plain(setup.from_counts(Dimension.POSITION, letter, counts))


def counts_of(row: Row, setup: Setup) -> tuple[int, int]:
    """Where a move of the table ends; only correct rows are asked."""
    x, y = (setup.counts(Dimension.POSITION, letter, exact(text)) for letter, text in (("X", row.x), ("Y", row.y)))
    return x, y


# ------------------------------------------------------------------ what is wrong


def cell_problem(column: str, text: str, setup: Setup) -> str:
    """Why a text cannot stand in a column on this machine, as one sentence, or nothing."""
    return _cells(setup)(column, typed_text(text))


@lru_cache(maxsize=4)
def _cells(setup: Setup) -> Callable[[str, str], str]:
    """What is wrong with each text on one machine, remembered: after an edit all other cells are what they were."""

    @lru_cache(maxsize=20_000)
    def judged(column: str, text: str) -> str:
        if not text:
            return ""
        field = fields_of(Row)[column]
        if isinstance(field, Quantity | Number) and (problem := number_problem(text)):
            return f"{field.label}: {problem}"
        axis = {"x": "X", "y": "Y", "pause": ""}.get(column, "XY")
        return field.problem(text, Context(setup, axis)) or ""

    return judged


@lru_cache(maxsize=16)
def problems(table: Table, setup: Setup) -> tuple[Wrong, ...]:
    """Everything that stands in the way of playing the table back, in its order."""
    if reason := unfit(table, setup):
        return (Wrong(0, "x", reason),)
    found: list[Wrong] = []
    judged = _cells(setup)
    for number, row in enumerate(table.rows):
        for column in COLUMNS:
            if problem := judged(column, typed_text(getattr(row, column))):
                found.append(_wrong(number, column, problem))
        found += [_wrong(number, column, text) for column, text in _row_problems(row)]
    if found:
        return tuple(found)
    found += _way_problems(table, setup)
    found += _chain_problems(table)
    if not any(row.moves for row in table.rows):
        found.append(Wrong(0, "x", "The table has no place to go to: record one first."))
    if len(table.rows) > MOST_ROWS:
        found.append(Wrong(MOST_ROWS, "x", f"The table has more than {MOST_ROWS} rows; a controller holds no more."))
    return tuple(found)


def unfit(table: Table, setup: Setup) -> str:
    """Why numbers of this table would mean something else on this machine, or nothing."""
    if len(setup.letters) < 2:
        return "Teaching needs two axes; this controller has one."
    if table.units != units_of(setup):
        taught, here = " and ".join(dict.fromkeys(table.units)), " and ".join(dict.fromkeys(units_of(setup)))
        return f"The rows were taught in {taught}, the axes of the setup are in {here}: nothing is converted silently."
    for letter in "XY":
        if problem := setup.axis(letter).scale_problem:
            return f"Axis {letter}: {problem}"
    if table.units[0] != table.units[1]:
        return "X and Y need the same unit for a line."
    ratio = setup.axis("X").scale / setup.axis("Y").scale
    if min(ratio.numerator, ratio.denominator) > COARSEST:
        return (
            f"X and Y have counts per {table.units[0]} in the ratio {ratio}: lines cannot end on whole counts of both."
        )
    return ""


def _wrong(row: int, column: str, problem: str) -> Wrong:
    return Wrong(row, column, f"Row {row + 1}: {problem}.")


def _row_problems(row: Row) -> list[tuple[str, str]]:
    """What does not go together in one row."""
    if bool(row.x) != bool(row.y):
        return [("y" if row.x else "x", "write both positions, or x for both")]
    if not row.moves:
        given = [column for column in OF_A_MOVE if getattr(row, column)]
        return [(given[0], f"{label_of(given[0])} belongs to a move; write both positions, or x here")] if given else []
    missing = [column for column in OF_A_MOVE[:3] if not getattr(row, column)]
    return [(missing[0], f"{label_of(missing[0])} is missing")] if missing else []


def _way_problems(table: Table, setup: Setup) -> list[Wrong]:
    """Arcs that are none, or leave the travel on their way."""
    before: tuple[int, int] | None = None
    found: list[Wrong] = []
    for number, row in enumerate(table.rows):
        if not row.moves:
            continue
        here = counts_of(row, setup)
        if row.sweep and before is None:
            found.append(_wrong(number, "sweep", "the first place is approached on a straight way; write x for Arc"))
        elif row.sweep and exact(row.sweep) == 0:
            found.append(_wrong(number, "sweep", "an arc of 0° is none; write x for a straight line"))
        elif row.sweep and before == here:
            found.append(_wrong(number, "sweep", "an arc needs two different places"))
        elif row.through and before is None:
            found.append(_wrong(number, "through", "the first place is approached alone; write x to stop there"))
        before = here
    return found or [wrong for number, arc in arcs_of(table) for wrong in _beyond(number, arc, setup)]


def arcs_of(table: Table) -> Iterator[tuple[int, Bow]]:
    """Rows (from 0) that are arcs, in user units: only there they are round, whatever X and Y count."""
    before: Point | None = None
    for number, row in enumerate(table.rows):
        if not row.moves:
            continue
        here = float(exact(row.x)), float(exact(row.y))
        if row.sweep and before is not None:
            yield number, through_ends(before, here, float(exact(row.sweep)))
        before = here


def _beyond(number: int, arc: Bow, setup: Setup) -> list[Wrong]:
    """An arc swings out beyond its ends."""
    for letter, (low, high) in zip("XY", arc.extent, strict=True):
        least, most = setup.bounds(Dimension.POSITION, letter)
        count = 1 / setup.factor(Dimension.POSITION, letter)
        if low < least - count or high > most + count:
            text = f"its arc leaves the travel of {letter}, {plain(least, 6)} to {plain(most, 6)}"
            return [_wrong(number, "sweep", text)]
    return []


def _chain_problems(table: Table) -> list[Wrong]:
    """A path goes on only into a move with the same ramps, and nothing happens where it does not stop."""
    found: list[Wrong] = []
    length = 0
    for number, (row, after) in enumerate(pairwise((*table.rows, Row()))):
        length = length + 1 if row.through else 0
        if length == LONGEST_CHAIN:
            found.append(_wrong(number, "through", f"a path may go on through {LONGEST_CHAIN} rows at most; write x"))
        if not row.through:
            continue
        if row.wait or row.output or row.pause:
            found.append(_wrong(number, "through", "it cannot go on without a stop and wait or switch an output here"))
        elif not after.moves:
            found.append(_wrong(number, "through", "it can only go on into a row with a place; write x to stop"))
        elif (row.acceleration, row.deceleration) != (after.acceleration, after.deceleration):
            found.append(_wrong(number, "through", "it goes on into a row with other ramps; make them the same"))
    return found


def exact(text: str) -> Fraction:
    """The number in a cell of a correct table."""
    number = parse_number(text)
    assert number is not None, "only correct rows are converted"
    return number
