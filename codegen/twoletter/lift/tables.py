"""Tables of positions: electronic cams and contours."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from codegen.fields import AXES, NONE, Dimension
from codegen.instructions import ContourMode, ElectronicCam
from codegen.instructions.contour import INTERVALS, Every
from codegen.instructions.curves import CamPlace, CamStep
from codegen.setup import Setup
from codegen.tables import write_table
from codegen.twoletter.emit.curves import AT_ONCE
from codegen.twoletter.lift.same import makes
from codegen.twoletter.lift.settings import Found
from codegen.twoletter.lift.values import arguments_by_axis, in_places, letters_of, number_of, text_of, whole_numbers
from codegen.twoletter.nodes import Command, Empty, Number, Statement

FEWEST_ROWS = 2


def cam(statements: Sequence[Statement], setup: Setup, master: str) -> Found | None:
    """A cam defined, slaves engaged or let go, or the end of it; `master` is that of the last one defined."""
    first = statements[0]
    if not isinstance(first, Command):
        return None
    match first.name:
        case "EA":
            return _defined(first, statements, setup)
        case "EG" | "EQ":
            made = _engaged(first, setup, master)
        case "EB" if whole_numbers(first.arguments) == [0]:
            made = ElectronicCam(step=CamStep.EXIT)
        case _:
            return None
    return ((made,), 1) if made is not None and makes((made,), statements[:1], setup) else None


def _engaged(command: Command, setup: Setup, master: str) -> ElectronicCam | None:
    rows = []
    for letter, value in arguments_by_axis(command).items():
        at = "" if number_of(value) == AT_ONCE else text_of(value, setup, Dimension.POSITION, master)
        if not at and number_of(value) != AT_ONCE:
            return None
        rows.append(CamPlace(slave=letter, at=at))
    step = CamStep.ENGAGE if command.name == "EG" else CamStep.DISENGAGE
    leads = (
        master
        if master not in [row.slave for row in rows]
        else next((letter for letter in setup.letters if letter not in [row.slave for row in rows]), master)
    )
    return ElectronicCam(step=step, master=leads, places=tuple(rows)) if rows else None


def _defined(first: Command, statements: Sequence[Statement], setup: Setup) -> Found | None:
    master = letters_of(first, setup)
    names = [each.name if isinstance(each, Command) else "" for each in statements[:3]]
    if names != ["EA", "EM", "EP"] or len(master) != 1:
        return None
    changes, spacing = statements[1], statements[2]
    assert isinstance(changes, Command) and isinstance(spacing, Command)
    entries: list[Command] = []
    for each in statements[3:]:
        if not isinstance(each, Command) or each.name != "ET" or not isinstance(each.index, Number):
            break
        if each.index.scaled != len(entries) << 16:
            break
        entries.append(each)
    numbers = whole_numbers(spacing.arguments)
    given = {letter: text_of(each, setup, Dimension.DISTANCE, letter)
             for letter, each in arguments_by_axis(changes).items()}  # fmt: skip
    cycle = given.pop(master, "")
    slaves = "".join(given)
    if len(entries) < FEWEST_ROWS or not numbers or numbers[0] is None or not slaves:
        return None
    rows = [[_cell(each, letter, setup) for letter in slaves] for each in entries]
    if not all(cell for row in rows for cell in row):
        return None
    fields: dict[str, Any] = {
        "master": master,
        "slaves": slaves,
        "cycle": cycle,
        "offset": _offset(numbers[1] if len(numbers) > 1 else None, setup, master),
        "table": write_table(rows),
    }
    used = 3 + len(entries)
    for count, enable in ((used + 1, True), (used, False)):
        for change in (NONE, in_places(given)):
            made = ElectronicCam(step=CamStep.DEFINE, enable=enable, change=change, **fields)
            if count <= len(statements) and makes((made,), statements[:count], setup):
                return (made,), count
    return None


def _cell(entry: Command, letter: str, setup: Setup) -> str:
    """What one entry says of a slave."""
    value = dict(zip(AXES, entry.arguments, strict=False)).get(letter)
    return text_of(value, setup, Dimension.POSITION, letter) if isinstance(value, Number) else ""


def _offset(counts: int | None, setup: Setup, master: str) -> str:
    return text_of(Number(counts << 16, str(counts)), setup, Dimension.POSITION, master) if counts else ""


def contour(statements: Sequence[Statement], setup: Setup) -> Found | None:
    """CM, then DT, CD and WC again and again, up to DT 0 and CD 0."""
    first = statements[0]
    if not isinstance(first, Command) or first.name != "CM" or not (axes := letters_of(first, setup)):
        return None
    rows: list[tuple[int, list[str]]] = []
    interval = 0
    count = 1
    for each in statements[1:]:
        if not isinstance(each, Command) or each.name not in ("DT", "CD", "WC"):
            break
        count += 1
        if each.name == "DT":
            interval = (whole_numbers(each.arguments) or [0])[0] or 0
        elif each.name == "CD" and interval:
            given = dict(zip(AXES, each.arguments, strict=False))
            values = {letter: given.get(letter, Empty()) for letter in axes}
            if not all(isinstance(value, Number) for value in values.values()):
                return None
            rows.append((interval, [text_of(values[axis], setup, Dimension.DISTANCE, axis) for axis in axes]))
    made = _curve(axes, rows)
    for used, wait in ((count + 1, True), (count, False)):
        whole = None if made is None else ContourMode(**made, wait=wait)
        if whole is not None and used <= len(statements) and makes((whole,), statements[:used], setup):
            return (whole,), used
    return None


def _curve(axes: str, rows: list[tuple[int, list[str]]]) -> dict[str, Any] | None:
    lengths = {exponent: str(length) for length, exponent in INTERVALS.items()}
    if not rows or any(exponent not in lengths for exponent, _ in rows):
        return None
    if len({exponent for exponent, _ in rows}) == 1:
        table = write_table([row for _, row in rows])
        return {"axes": axes, "interval": Every(lengths[rows[0][0]]), "table": table}
    table = write_table([[lengths[exponent], *row] for exponent, row in rows])
    return {"axes": axes, "timed": True, "table": table}
