"""Contour mode and the electronic cam."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from codegen.fields import AXES, Dimension, value_of
from codegen.instructions.contour import ContourMode
from codegen.instructions.curves import CamStep, ElectronicCam
from codegen.tables import Grid, read_table
from codegen.twoletter.calls import Statement, Value, by_axis, entry, for_axes, numbers, simple
from codegen.twoletter.emit.build import Build

AT_ONCE = -2147483647  # counts; outside every cycle


def contour_mode(contour: ContourMode, build: Build) -> Iterator[Statement]:
    """Records as differences of rounded places, so that they add up to the last place."""
    exact = dict.fromkeys(contour.axes, Fraction(0))
    sent = dict.fromkeys(contour.axes, 0)
    present = 0
    yield for_axes("CM", contour.axes)
    for exponent, steps in contour.records():
        if exponent != present:
            present = exponent
            yield numbers("DT", exponent)
        values: dict[str, Value] = {}
        for letter, step in zip(contour.axes, steps, strict=True):
            exact[letter] += step
            place = build.setup.counts(Dimension.DISTANCE, letter, exact[letter])
            values[letter] = place - sent[letter]
            sent[letter] = place
        yield by_axis("CD", values)
        yield simple("WC")
    yield numbers("DT", 0)
    yield by_axis("CD", dict.fromkeys(contour.axes, 0))
    if contour.wait:
        yield for_axes("AM", contour.axes)


def electronic_cam(cam: ElectronicCam, build: Build) -> Iterator[Statement]:
    match cam.step:
        case CamStep.DEFINE:
            yield from _definition(cam, build)
        case CamStep.ENGAGE | CamStep.DISENGAGE:
            places: dict[str, Value] = {
                row.slave: build.value(row.at, Dimension.POSITION, cam.master) if row.at.strip() else AT_ONCE
                for row in cam.places
            }
            yield by_axis("EG" if cam.step is CamStep.ENGAGE else "EQ", places)
        case CamStep.EXIT:
            yield numbers("EB", 0)


def _definition(cam: ElectronicCam, build: Build) -> Iterator[Statement]:
    """Master, cycles, interval, table, on; the interval is rounded up so that the table covers the cycle."""
    setup, grid, cycle = build.setup, read_table(cam.table), value_of(cam.cycle)
    assert isinstance(grid, Grid) and isinstance(cycle, Fraction), "only correct instructions are emitted"
    counts = setup.counts(Dimension.DISTANCE, cam.master, cycle)
    tables = {letter: _positions(grid, place, letter, build) for place, letter in enumerate(cam.slaves)}
    changes: dict[str, Value] = {cam.master: counts}
    for letter, positions in tables.items():
        given = value_of(cam.change[AXES.index(letter)]) if cam.change[AXES.index(letter)].strip() else None
        exact = setup.counts(Dimension.DISTANCE, letter, given) if isinstance(given, Fraction) else None
        changes[letter] = abs(positions[-1] - positions[0] if exact is None else exact)
    offset = build.value(cam.offset, Dimension.POSITION, cam.master) if cam.offset.strip() else 0
    yield for_axes("EA", cam.master)
    yield by_axis("EM", changes)
    yield numbers("EP", -(-counts // (len(grid.rows) - 1)), offset)
    for index in range(len(grid.rows)):
        yield entry("ET", index, {letter: positions[index] for letter, positions in tables.items()})
    if cam.enable:
        yield numbers("EB", 1)


def _positions(grid: Grid, column: int, letter: str, build: Build) -> list[int]:
    return [build.setup.counts(Dimension.POSITION, letter, cell or Fraction(0)) for cell in grid.column(column)]
