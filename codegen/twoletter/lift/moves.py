"""Moves: of one axis from its target to the wait, of several that begin together, homing, stops that are waited for."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from codegen.fields import AXES, Dimension
from codegen.instructions import Home, Instruction, SingleAxisMove, StopMotion
from codegen.instructions.motion import Direction, Homing, MoveMode, WaitFor
from codegen.numbers import plain
from codegen.setup import Setup
from codegen.twoletter.lift.same import makes
from codegen.twoletter.lift.settings import Found
from codegen.twoletter.lift.singles import stop
from codegen.twoletter.lift.values import arguments_by_axis, letters_of, number_of, per_axis, text_of
from codegen.twoletter.nodes import Argument, Command, Statement

MOVES = {
    "PR": (MoveMode.BY, "distance", Dimension.DISTANCE),
    "PA": (MoveMode.TO, "position", Dimension.POSITION),
    "JG": (MoveMode.AT, "jog_speed", Dimension.SPEED),
}
RATES = {
    "SP": ("speed", Dimension.SPEED),
    "AC": ("acceleration", Dimension.ACCELERATION),
    "DC": ("deceleration", Dimension.ACCELERATION),
}
ROUTINES = {"HM": Homing.SWITCH, "FE": Homing.EDGE, "FI": Homing.INDEX}
LONGEST_HOME = 6  # SP AC DC HM BG AM
LONGEST_MOVE = 9  # PR SP AC DC IT BG TW MC and one more


def one_axis(command: Command) -> tuple[str, Argument] | None:
    """The axis and the value of a command that has only one."""
    given = list(arguments_by_axis(command).items())
    return given[0] if len(given) == 1 and command.axis is None and given[0][0] in AXES else None


def move(statements: Sequence[Statement], setup: Setup) -> Found | None:
    """The longest move at the beginning of these statements."""
    first = statements[0]
    if not isinstance(first, Command) or first.name not in MOVES:
        return None
    if (found := one_axis(first)) is None:
        return _together(first, setup)
    letter, value = found
    mode, name, dimension = MOVES[first.name]
    fields: dict[str, Any] = {name: text_of(value, setup, dimension, letter)}
    fields |= {"axis": letter, "mode": mode, "begin": False, "wait": WaitFor.NOTHING}
    if not fields[name]:
        return None
    best: Found | None = None
    for count, each in enumerate(statements[:LONGEST_MOVE], 1):
        if count > 1 and not (isinstance(each, Command) and _goes_on(fields, each, letter, setup)):
            break
        made = SingleAxisMove(**fields)
        if makes((made,), statements[:count], setup):
            best = (made,), count
    return best


def _goes_on(fields: dict[str, Any], command: Command, letter: str, setup: Setup) -> bool:
    """Takes a command into the fields of a move; False where it is none of it."""
    match command.name:
        case "SP" | "AC" | "DC":
            found, (name, dimension) = one_axis(command), RATES[command.name]
            fields[name] = text_of(found[1], setup, dimension, letter) if found and found[0] == letter else ""
            return bool(fields[name])
        case "IT" | "KS":
            found = one_axis(command)
            fields["smoothing"] = _smoothing(command.name, found[1]) if found and found[0] == letter else ""
            return bool(fields["smoothing"])
        case "BG":
            fields["begin"] = True
        case "AM":
            fields["wait"] = WaitFor.PROFILE
        case "TW":
            found = one_axis(command)
            fields["time_out"] = text_of(found[1], setup, Dimension.TIME) if found else ""
            fields["wait"] = WaitFor.POSITION
            return bool(fields["time_out"])
        case "MC":
            fields["wait"] = WaitFor.POSITION
        case _:
            return False
    return True


def _smoothing(name: str, value: Argument) -> str:
    """0 … 255 of the filter that IT sets; a stepper's as it is."""
    number = number_of(value)
    if number is None or name == "KS":
        return "" if number is None else plain(number)
    return plain(Fraction(round(256 - number * 256)))


def _together(command: Command, setup: Setup) -> Found | None:
    """`PR 100,200`: the target of each axis, to begin later."""
    mode, name, dimension = MOVES[command.name]
    made: list[Instruction] = []
    for letter, value in arguments_by_axis(command).items():
        fields: dict[str, Any] = {name: text_of(value, setup, dimension, letter)}
        made.append(SingleAxisMove(axis=letter, mode=mode, begin=False, wait=WaitFor.NOTHING, **fields))
    return (tuple(made), 1) if made and makes(made, (command,), setup) else None


def home(statements: Sequence[Statement], setup: Setup) -> Found | None:
    """Speeds, ramps, the routine, begin and wait of a search for home."""
    fields: dict[str, Any] = {}
    best: Found | None = None
    for count, each in enumerate(statements[:LONGEST_HOME], 1):
        if not isinstance(each, Command) or not _homes(fields, each, setup):
            break
        if "routine" in fields:
            made = Home(**{"begin": False, "wait": False, **fields})
            if makes((made,), statements[:count], setup):
                best = (made,), count
    return best


def _homes(fields: dict[str, Any], command: Command, setup: Setup) -> bool:
    match command.name:
        case "SP" | "AC" | "DC" if "routine" not in fields:
            name, dimension = RATES[command.name]
            fields[name] = per_axis(command, setup, dimension)
            return fields[name] is not None
        case "JG" if not fields:
            texts = per_axis(command, setup, Dimension.SPEED)
            if texts is None:
                return False
            reverse = any(text.startswith("-") for text in texts)
            x, y, z, w = (text.removeprefix("-") if reverse else text for text in texts)
            fields["speed"] = x, y, z, w
            fields["direction"] = Direction.REVERSE if reverse else Direction.FORWARD
            return True
        case "HM" | "FE" | "FI" if "routine" not in fields:
            fields["routine"], fields["axes"] = ROUTINES[command.name], letters_of(command, setup)
            return bool(fields["axes"])
        case "BG" if "routine" in fields:
            fields["begin"] = True
            return True
        case "AM" if "begin" in fields:
            fields["wait"] = True
            return True
    return False


def stop_and_wait(statements: Sequence[Statement], setup: Setup) -> Found | None:
    """ST and AM of the same axes."""
    first = statements[0]
    made = stop(first, setup) if isinstance(first, Command) and first.name == "ST" else None
    if not isinstance(made, StopMotion) or len(statements) < 2:
        return None
    made = dataclasses.replace(made, wait=True)
    return ((made,), 2) if makes((made,), statements[:2], setup) else None
