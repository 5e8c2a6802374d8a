"""Sentences with places: `{field}`, `[either|or]` (the first whose values are there), `<one text for each axis>`."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, TypeAlias


@dataclass(frozen=True, slots=True)
class Place:
    name: str


@dataclass(frozen=True, slots=True)
class Either:
    alternatives: tuple[Parts, ...]


@dataclass(frozen=True, slots=True)
class Each:
    parts: Parts


Parts: TypeAlias = tuple["str | Place | Either | Each", ...]
_MARK = re.compile(r"\{(\w+)\}|([\[\]|<>])")


@lru_cache(maxsize=256)
def template(sentence: str) -> Parts:
    """A sentence as its parts."""
    marks = [(match.start(), match.end(), match[1], match[2]) for match in _MARK.finditer(sentence)]
    parts, _, _ = _read_parts(sentence, marks, 0, 0)
    return parts


def _read_parts(sentence: str, marks: list[Any], number: int, start: int) -> tuple[Parts, int, int]:
    """Parts up to the closing mark of this level; answers where that mark is."""
    parts: list[str | Place | Either | Each] = []
    while number < len(marks):
        begin, end, name, mark = marks[number]
        if begin > start:
            parts.append(sentence[start:begin])
        if name:
            parts.append(Place(name))
            start = end
        elif mark == "[":
            alternatives: list[Parts] = []
            while mark != "]":
                inner, number, end = _read_parts(sentence, marks, number + 1, end)
                alternatives.append(inner)
                mark = marks[number][3]
            parts.append(Either(tuple(alternatives)))
            start = end
        elif mark == "<":
            inner, number, start = _read_parts(sentence, marks, number + 1, end)
            parts.append(Each(inner))
        else:
            return tuple(parts), number, end
        number += 1
    if start < len(sentence):
        parts.append(sentence[start:])
    return tuple(parts), number, len(sentence)


class Absent(Exception):
    """A value of this part is empty or hidden, so that the part vanishes."""


def filled(parts: Parts, words: Callable[[str], str], each: Callable[[Parts], str]) -> str:
    written: list[str] = []
    for part in parts:
        match part:
            case str():
                written.append(part)
            case Place(name=name):
                written.append(words(name))
            case Each(parts=inner):
                written.append(each(inner))
            case Either(alternatives=alternatives):
                written.append(_first(alternatives, words, each))
    return "".join(written)


def _first(alternatives: tuple[Parts, ...], words: Callable[[str], str], each: Callable[[Parts], str]) -> str:
    for parts in alternatives:
        try:
            return filled(parts, words, each)
        except Absent:
            continue
    return ""
