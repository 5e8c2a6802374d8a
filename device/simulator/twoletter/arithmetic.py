"""Numbers as a profile has them: an expression is rewritten where that controller works something out differently."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final

from codegen.twoletter.evaluate import EvaluationError
from codegen.twoletter.fixed import ONE
from codegen.twoletter.functions import square_root
from codegen.twoletter.nodes import Binary, Function, Statement

if TYPE_CHECKING:
    from device.simulator.twoletter.profile import Profile

OTHER: Final = "~"  # behind a function or operator: not the default one


def others(profile: Profile) -> frozenset[str]:
    """The functions and operators that this controller works out in another way."""
    found = {"INT", "FRAC"} if profile.int_of_negative == "down" else set()
    found |= {"RND"} if profile.round_half == "away from 0" else set()
    found |= {"SQR"} if profile.root_of_negative == "error 6" else set()
    found |= {"+", "-", "*"} if profile.overflow == "stops at the limit" else set()
    return frozenset(found)


def rewritten(statement: Statement, names: frozenset[str]) -> Statement:
    """The statement with those functions and operators marked."""
    found: Statement = _rewritten(statement, names)
    return found


def _rewritten(node: Any, names: frozenset[str]) -> Any:
    if isinstance(node, tuple):
        return tuple(_rewritten(item, names) for item in node)
    if not dataclasses.is_dataclass(node) or isinstance(node, type):
        return node
    inner = {each.name: _rewritten(getattr(node, each.name), names) for each in dataclasses.fields(node)}
    if isinstance(node, Function) and node.name in names:
        inner["name"] += OTHER
    if isinstance(node, Binary) and node.operator in names:
        inner["operator"] += OTHER
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
