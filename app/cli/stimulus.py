"""Reads a stimulus: what happens to the machine from outside, and when."""

from __future__ import annotations

import csv
import io
import re
from dataclasses import dataclass

from app.cli.failure import Failure

HEADER = ["ms", "signal", "value"]
ESCAPES = {"\\r": "\r", "\\n": "\n", "\\t": "\t", "\\\\": "\\"}
SIGNALS = re.compile(
    r"in[1-8]|an[1-8]|(fls|rls|home|aux|aux_speed|position|load)_[xyzw]|abort|reset|type|type2",
)


@dataclass(frozen=True)
class Happening:
    """One change from outside, at a time in true milliseconds since the start."""

    ms: float
    signal: str
    value: float | str


def unescaped(text: str) -> str:
    """Typed text with its escapes resolved."""
    return re.sub(r"\\[rnt\\]", lambda match: ESCAPES[match.group()], text)


def read_row(name: str, number: int, row: list[str]) -> Happening:
    """One row of the file."""
    if len(row) < 3:
        raise Failure(f"{name} line {number}: needs ms,signal,value")
    signal = row[1].strip().lower()
    if not SIGNALS.fullmatch(signal):
        raise Failure(f"{name} line {number}: no signal {row[1].strip()}")
    try:
        ms = float(row[0])
        if signal.startswith("type"):
            return Happening(ms, signal, unescaped(",".join(row[2:])))
        return Happening(ms, signal, float(row[2]))
    except ValueError:
        raise Failure(f"{name} line {number}: {','.join(row)} is not a time and a value") from None


def read_stimulus(text: str, name: str) -> list[Happening]:
    """All happenings of a stimulus file, in time order."""
    rows = [(number, row) for number, row in enumerate(csv.reader(io.StringIO(text)), 1) if any(map(str.strip, row))]
    if not rows or [word.strip().lower() for word in rows[0][1]] != HEADER:
        raise Failure(f"{name}: the first line must be {','.join(HEADER)}")
    found: list[Happening] = []
    for number, row in rows[1:]:
        happening = read_row(name, number, row)
        if found and happening.ms < found[-1].ms:
            raise Failure(f"{name} line {number}: not in time order")
        found.append(happening)
    return found
