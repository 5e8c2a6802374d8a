"""Reads a stimulus: what happens to the machine from outside, and when."""

from __future__ import annotations

import csv
import io
import re
from dataclasses import dataclass

from app.cli.failure import Failure
from codegen.models import Model

HEADER = ["ms", "signal", "value"]
ESCAPES = {"\\r": "\r", "\\n": "\n", "\\t": "\t", "\\\\": "\\"}
SIGNALS = re.compile(r"(in|an)([1-9])|(fls|rls|home|aux|aux_speed|position|load)_([xyzw])|abort|reset|type|type2")
LEVELS = ("in", "fls", "rls", "home", "abort", "reset")
MOST_VOLTS = 10.0
LONGEST_MS = 1e9
LARGEST = 2147483647.0


@dataclass(frozen=True)
class Happening:
    """One change from outside, at a time in true milliseconds since the start."""

    ms: float
    signal: str
    value: float | str


def unescaped(text: str) -> str:
    """Typed text with its escapes resolved."""
    return re.sub(r"\\[rnt\\]", lambda match: ESCAPES[match.group()], text)


def known(signal: str, model: Model) -> str:
    """The kind of a signal of this controller; nothing where it has none of that name."""
    match = SIGNALS.fullmatch(signal)
    if not match:
        return ""
    if match[1]:
        most = model.inputs if match[1] == "in" else model.analog_inputs
        return match[1] if int(match[2]) <= most else ""
    if match[3]:
        return match[3] if match[4].upper() in model.axes else ""
    return signal


def checked_value(kind: str, text: str) -> float:
    """A value as that kind of signal can have it; ValueError says why not."""
    value = float(text)
    if kind in LEVELS and value not in (0, 1):
        raise ValueError("a level is 0 or 1")
    if kind == "an" and not abs(value) <= MOST_VOLTS:
        raise ValueError("volts are between -10 and 10")
    if not abs(value) <= LARGEST:
        raise ValueError("that is no number")
    return value


def read_row(place: str, row: list[str], model: Model) -> Happening:
    """One row of the file."""
    if len(row) < 3:
        raise Failure(f"{place}: needs ms,signal,value")
    signal = row[1].strip().lower()
    kind = known(signal, model)
    if not kind:
        raise Failure(f"{place}: no signal {row[1].strip()} on {model.name}")
    typed = kind.startswith("type")
    if len(row) > 3 and not typed:
        raise Failure(f"{place}: more than ms,signal,value")
    try:
        ms = float(row[0])
        if not 0 <= ms <= LONGEST_MS:
            raise ValueError("that is no time in milliseconds")
        return Happening(ms, signal, unescaped(",".join(row[2:])) if typed else checked_value(kind, row[2]))
    except ValueError as problem:
        reason = "that is no number" if "convert" in str(problem) else str(problem)
        raise Failure(f"{place}: {','.join(row)}: {reason}") from None


def read_stimulus(text: str, name: str, model: Model) -> list[Happening]:
    """All happenings of a stimulus file, in time order."""
    try:
        numbered = list(enumerate(csv.reader(io.StringIO(text)), 1))
    except csv.Error as problem:
        raise Failure(f"{name}: {problem}") from problem
    rows = [(number, row) for number, row in numbered if any(map(str.strip, row))]
    if not rows or [word.strip().lower() for word in rows[0][1]] != HEADER:
        raise Failure(f"{name}: the first line must be {','.join(HEADER)}")
    found: list[Happening] = []
    for number, row in rows[1:]:
        happening = read_row(f"{name} line {number}", row, model)
        if found and happening.ms < found[-1].ms:
            raise Failure(f"{name} line {number}: not in time order")
        found.append(happening)
    return found
