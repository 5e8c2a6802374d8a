"""A teach table as what play-back does: its stages, with the lines that its instructions become."""

from __future__ import annotations

from codegen.generate import code
from codegen.instructions import WaitForCondition
from codegen.instructions.flow import InputLevel
from codegen.numbers import parse_number
from codegen.setup import Setup
from codegen.teach import Table, arcs_of, exact
from codegen.teach_steps import Kind, Stage, stages
from device.teach import AXES, Action, Await, Move, Send, Stand

WAITS = "AM "  # lines that hold the port; play-back looks instead


def actions_of(table: Table, setup: Setup, first: Move) -> tuple[Action, ...]:
    """All of a correct table; the way to its first place is `first`."""
    return tuple(Action(stage.first, _action(stage, table, setup, first)) for stage in stages(table, setup))


def ends_of(table: Table, setup: Setup) -> list[tuple[int, tuple[int, int]]]:
    """Where the moves of a correct table end, and how far its arcs swing: row (from 0) and counts of X and Y."""
    found = [(stage.last, stage.end) for stage in stages(table, setup) if stage.end is not None]
    scales = [float(setup.axis(letter).scale) for letter in AXES]
    for row, arc in arcs_of(table):
        for x, y in zip(*arc.extent, strict=True):
            found.append((row, (round(x * scales[0]), round(y * scales[1]))))
    return sorted(found, key=lambda each: each[0])


def _action(stage: Stage, table: Table, setup: Setup, first: Move) -> Move | Await | Send | Stand:
    lines = tuple(line for each in stage.instructions for line in code(each, setup) if not line.startswith(WAITS))
    match stage.kind:
        case Kind.APPROACH:
            return first
        case Kind.PATH:
            assert stage.end is not None
            return Move(lines, stage.end, stage.slack)
        case Kind.WAIT:
            wait = stage.instructions[0]
            assert isinstance(wait, WaitForCondition)
            return Await(int(parse_number(wait.input) or 0), wait.level is InputLevel.HIGH)
        case Kind.OUTPUT:
            return Send(lines)
        case Kind.PAUSE:
            return Stand(float(exact(table.rows[stage.first].pause)) / 1000)
