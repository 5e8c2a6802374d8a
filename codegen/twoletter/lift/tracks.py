"""Paths of several axes: mode, speeds, segments, end, begin, wait."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from codegen.fields import AXES, Dimension, base_letter
from codegen.instructions import CircularPath, Instruction, LinearPath, TangentPath
from codegen.instructions.path_parts import Ending, Measured, Piece, Shape, Stretch, Turn
from codegen.numbers import plain
from codegen.setup import Setup
from codegen.twoletter.lift.same import makes
from codegen.twoletter.lift.settings import Found
from codegen.twoletter.lift.values import in_places, letters_of, number_of, text_of
from codegen.twoletter.nodes import Argument, Command, SegmentSpeed, Statement

SEGMENTS = ("VP", "CR", "LI")
TAIL = 5  # PA BG AM of the tangent axis, BG S, AM S
MOST_SEGMENTS = 511


@dataclasses.dataclass
class Track:
    """What is read of a path so far."""

    mode: str
    axes: str  # of the plane, or all
    tangent: str = ""
    continues: bool = False
    fields: dict[str, Any] = dataclasses.field(default_factory=dict)
    rows: list[Piece | Stretch] = dataclasses.field(default_factory=list)
    present: str = ""  # speed of the segments

    @property
    def arcs(self) -> bool:
        return any(isinstance(row, Piece) and row.shape is Shape.ARC for row in self.rows)

    def made(self, **more: Any) -> Instruction:
        """The instruction of what has been read."""
        common = {"axes": self.axes, "continues": self.continues, **self.fields, **more}
        if self.mode == "LM":
            return LinearPath(measured=Measured.STEPS, segments=tuple(self.rows), **common)  # type: ignore[arg-type]
        if self.tangent:
            return TangentPath(tangent=self.tangent, segments=tuple(self.rows), **common)  # type: ignore[arg-type]
        if self.arcs:
            return CircularPath(segments=tuple(self.rows), **common)  # type: ignore[arg-type]
        lines = tuple(Stretch(to=row.to, speed=row.speed) for row in self.rows)
        return LinearPath(measured=Measured.POINTS, segments=lines, **common)


def path(statements: Sequence[Statement], setup: Setup, before: str) -> Found | None:
    """The path that begins here, or goes on; `before` are the axes of the last one."""
    first = statements[0]
    if not isinstance(first, Command):
        return None
    if first.name in ("VM", "LM"):
        letters = letters_of(first, setup)
        if not letters or any(letter not in AXES for letter in letters):
            return None
        three = first.name == "VM" and len(letters) == 3
        track = Track(first.name, letters[:2] if three else letters, letters[2:] if three else "")
        count = 1 + _parameters(track, statements[1:], setup)
    elif first.name in SEGMENTS and before:
        track, count = Track("LM" if first.name == "LI" else "VM", before, continues=True), 0
    else:
        return None
    used = _segments(track, statements[count:], setup)
    return _ended(track, statements, count + used, setup) if used else None


def _parameters(track: Track, statements: Sequence[Statement], setup: Setup) -> int:
    """ES, TN, VS, VA, VD, VT: how many of them there are."""
    base = base_letter(setup, track.axes)
    for count, each in enumerate(statements):
        if not isinstance(each, Command):
            return count
        values = each.arguments
        match each.name:
            case "ES":  # comes from the counts per unit
                pass
            case "TN" if len(values) == 2 and (degree := number_of(values[0])) is not None:
                track.fields["turn_counts"] = plain(degree * 360)
                track.fields["zero"] = text_of(values[1], setup, Dimension.POSITION, track.tangent)
            case "VS" if len(values) == 1:
                track.fields["speed"] = track.present = text_of(values[0], setup, Dimension.SPEED, base)
            case "VA" | "VD" if len(values) == 1:
                name = "acceleration" if each.name == "VA" else "deceleration"
                track.fields[name] = text_of(values[0], setup, Dimension.ACCELERATION, base)
            case "VT" if len(values) == 1 and (ratio := number_of(values[0])) is not None:
                track.fields["smoothing"] = plain(Fraction(round(256 - ratio * 256)))
            case _:
                return count
    return len(statements)


def _segments(track: Track, statements: Sequence[Statement], setup: Setup) -> int:
    """Takes the segments into the track: how many there are."""
    for count, each in enumerate(statements[:MOST_SEGMENTS]):
        wanted = ("LI",) if track.mode == "LM" else ("VP", "CR")
        row = _row(track, each, setup) if isinstance(each, Command) and each.name in wanted else None
        if row is None or not _at_speed(track, row, each, setup):
            return count
    return min(len(statements), MOST_SEGMENTS)


def _row(track: Track, command: Command, setup: Setup) -> Piece | Stretch | None:
    values = [each for each in command.arguments if not isinstance(each, SegmentSpeed)]
    base = base_letter(setup, track.axes)
    if command.name == "LI":
        given = {letter: each for letter, each in zip(AXES, values, strict=False) if letter in track.axes}
        texts = {letter: text_of(each, setup, Dimension.DISTANCE, letter) for letter, each in given.items()}
        return Stretch(to=in_places(texts))
    if command.name == "CR":
        return _arc(values, base, setup)
    if len(values) != 2:
        return None
    places = [text_of(each, setup, Dimension.DISTANCE, base) for each in values]
    return Piece(to=in_places(dict(zip(track.axes, places, strict=True)))) if all(places) else None


def _arc(values: Sequence[Argument], base: str, setup: Setup) -> Piece | None:
    if len(values) != 3:
        return None
    radius = text_of(values[0], setup, Dimension.DISTANCE, base)
    start, sweep = text_of(values[1], setup), text_of(values[2], setup)
    turn = Turn.CW if sweep.startswith("-") else Turn.CCW
    if not radius or not start or not sweep:
        return None
    return Piece(shape=Shape.ARC, radius=radius, start=start, sweep=sweep.removeprefix("-"), turn=turn)


def _at_speed(track: Track, row: Piece | Stretch, statement: Statement, setup: Setup) -> bool:
    """Adds a row with the speed it has; False where only another instruction can say it."""
    assert isinstance(statement, Command)
    own = next((each.value for each in statement.arguments if isinstance(each, SegmentSpeed)), None)
    if own is not None:
        track.present = text_of(own, setup, Dimension.SPEED, base_letter(setup, track.axes))
        if track.continues and not track.rows:
            track.fields["speed"] = track.present
        if not track.present or not track.fields.get("speed"):
            return False
    speed = track.present if track.present != track.fields.get("speed", "") else ""
    track.rows.append(dataclasses.replace(row, speed=speed))
    return True


def _ended(track: Track, statements: Sequence[Statement], count: int, setup: Setup) -> Found | None:
    """The longest form: to be continued, ended, begun, waited for; with the tangent axis turned first or not."""
    closing = "LE" if track.mode == "LM" else "VE"
    closed = count < len(statements) and statements[count] == Command(closing)
    longest = count + (1 + TAIL if closed else TAIL - 2)
    turned = (True, False) if track.tangent and not track.continues else (False,)
    for used in range(min(longest, len(statements)), count - 1, -1):
        for turn in turned:
            more: dict[str, Any] = {"turn_first": turn} if track.tangent else {}
            for ending, begin, wait in _endings(closed):
                made = track.made(ending=ending, begin=begin, wait=wait, **more)
                if makes((made,), statements[:used], setup):
                    return (made,), used
    return None


def _endings(closed: bool) -> list[tuple[Ending, bool, bool]]:
    if not closed:
        return [(Ending.CONTINUE, True, True)]
    return [(Ending.STOP, True, True), (Ending.STOP, True, False), (Ending.STOP, False, True)]
