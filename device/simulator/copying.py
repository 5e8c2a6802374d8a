"""Copies of simulated state: plain values and slotted dataclasses only, many times faster than `copy.deepcopy`."""

from __future__ import annotations

from collections import deque
from enum import Enum
from typing import Any, Final, TypeVar

Kind = TypeVar("Kind")
FIXED: Final = frozenset({int, float, bool, str, bytes, type(None), tuple})  # never changed in place


def clone(value: Kind) -> Kind:
    """A copy that shares nothing that can change. What is in one list or dict is all of one kind."""
    copied: Kind = _clone(value)
    return copied


def _clone(value: Any) -> Any:
    kind = type(value)
    if kind in FIXED or isinstance(value, Enum):
        return value
    if kind is list or kind is deque:
        fixed = not value or type(value[0]) in FIXED
        return value.copy() if fixed else kind(_clone(item) for item in value)
    if kind is dict:
        fixed = not value or type(next(iter(value.values()))) in FIXED
        return value.copy() if fixed else {name: _clone(item) for name, item in value.items()}
    if kind is set or kind is bytearray:
        return value.copy()
    copied: Any = object.__new__(kind)
    for name in kind.__slots__:
        item = getattr(value, name)
        setattr(copied, name, item if type(item) in FIXED else _clone(item))
    return copied
