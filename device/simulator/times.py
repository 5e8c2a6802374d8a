"""The simulator's integer time: ticks, and how many of them samples, commands and characters take."""

from __future__ import annotations

from typing import Final

TICKS: Final = 1_024_000
"""Ticks in a true second; a sample takes TM of them (TM 1000: 1/1024 s, dmc-1412-1414.txt l.3284)."""

COMMAND: Final = 512
"""Ticks the interpreter needs for one command: 0.5 ms (dmc-1412-1414.txt l.1351)."""

CHARACTER_BITS: Final = 10
"""Start bit, eight data bits, stop bit (dmc-1412-1414.txt l.1268)."""

TICKS_PER_MS: Final = 1024


def milliseconds(ticks: int) -> float:
    """True milliseconds of a time in ticks."""
    return ticks / TICKS_PER_MS
