"""Numbers as a profile has them: an expression is rewritten where that controller works something out differently."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Final

from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.evaluate import EvaluationError
from codegen.twoletter.expression import LETTERS
from codegen.twoletter.fixed import ONE
from codegen.twoletter.functions import square_root
from codegen.twoletter.nodes import Assign, Binary, Command, Function, Statement, Variable
from codegen.twoletter.rows import Takes

if TYPE_CHECKING:
    from device.simulator.twoletter.profile import Profile

OTHER: Final = "~"  # behind a function or operator: not the default one
DOWN: Final = "_"  # behind * and /: cut downwards
BY_ZERO: Final = {"error 6": "", "error 9": "9", "largest number": "^"}  # behind /


def others(profile: Profile) -> Mapping[str, str]:
    """The functions and operators that this controller works out in another way, and their marks here."""
    found = dict.fromkeys(("INT", "FRAC"), OTHER) if profile.int_of_negative == "down" else {}
    found |= {"RND": OTHER} if profile.round_half == "away from 0" else {}
    found |= {"SQR": OTHER} if profile.root_of_negative == "error 6" else {}
    stops = OTHER if profile.overflow == "stops at the limit" else ""
    cut = DOWN if profile.cut == "down" else ""
    marks = {"+": stops, "-": stops, "*": stops + cut, "/": BY_ZERO[profile.division_by_zero] + cut}
    return found | {operator: mark for operator, mark in marks.items() if mark}


def rewritten(statement: Statement, names: Mapping[str, str], *, axis_assignments: bool = False) -> Statement:
    """The statement with those functions and operators marked; with `axis_assignments` PRA=5 is PR of X."""
    if axis_assignments and isinstance(statement, Assign) and isinstance(statement.target, Variable):
        statement = _as_command(statement, statement.target.name)
    found: Statement = _rewritten(statement, names) if names else statement
    return found


def _as_command(statement: Assign, name: str) -> Statement:
    row, axis = COMMANDS.get(name[:2]), LETTERS.get(name[2:])
    if len(name) != 3 or axis is None or row is None or row.takes is not Takes.AXIS_NUMBERS:
        return statement
    return Command(row.name, (statement.value,), axis=axis, span=statement.span)


def _rewritten(node: Any, names: Mapping[str, str]) -> Any:
    if isinstance(node, tuple):
        return tuple(_rewritten(item, names) for item in node)
    if not dataclasses.is_dataclass(node) or isinstance(node, type):
        return node
    inner = {each.name: _rewritten(getattr(node, each.name), names) for each in dataclasses.fields(node)}
    if isinstance(node, Function) and node.name in names:
        inner["name"] += names[node.name]
    if isinstance(node, Binary) and node.operator in names:
        inner["operator"] += names[node.operator]
    return dataclasses.replace(node, **inner)


def _down(value: int) -> int:
    return value >> 16 << 16


def _away(value: int) -> int:
    magnitude = (abs(value) + ONE // 2) >> 16 << 16
    return -magnitude if value < 0 else magnitude


def _root(value: int) -> int:
    if value < 0:
        raise EvaluationError(6)
    return square_root(value)


FUNCTIONS: Final[dict[str, Callable[[int], int]]] = {
    "INT" + OTHER: _down,
    "FRAC" + OTHER: lambda value: value - _down(value),
    "RND" + OTHER: _away,
    "SQR" + OTHER: _root,
}
