"""What can be wrong with a serial connection, for the simulated port: broken cable, foreign device, wrong speed."""

from __future__ import annotations

from collections.abc import Iterator
from enum import StrEnum
from typing import Final

FOREIGN_PROMPT: Final = b"\r\nmachine login: "
BITS: Final = 8


class Fault(StrEnum):
    """What is wrong."""

    NONE = "none"
    SILENT = "silent"  # no power, or transmit and receive crossed: nothing arrives, nothing comes
    ECHO = "echo"  # what is sent comes back, and nothing else
    FOREIGN = "foreign"  # something else is there, with a prompt of its own
    HELD = "held"  # CTS says "not ready" for ever
    SPEED = "speed"  # none, but a host that is set to another speed is not understood (pseudo-terminals)


def spoilt(fault: Fault, data: bytes) -> tuple[bytes, bytes]:
    """What the controller gets of what the host sent, and what comes back to the host at once."""
    if fault in (Fault.NONE, Fault.HELD, Fault.SPEED):
        return data, b""
    if fault is Fault.ECHO:
        return b"", data
    return b"", FOREIGN_PROMPT * data.count(b"\r") if fault is Fault.FOREIGN else b""


def mistimed(data: bytes, sent_baud: int, heard_baud: int) -> bytes:
    """What a receiver at another speed makes of characters that follow each other: one start bit, eight, one stop bit.

    Bits are looked at in their middle; a stop bit that reads 0 is a framing error, whose character is delivered as is.
    """
    levels = [level for byte in data for level in _levels(byte)]
    found = bytearray()
    place = 0.0  # in bits of the sender
    step = sent_baud / heard_baud
    while True:
        start = next((n for n in range(int(place), len(levels)) if not levels[n] and n >= place - 1), None)
        if start is None:
            return bytes(found)
        begin = max(float(start), place)
        looks = [_at(levels, begin + step * (bit + 1.5)) for bit in range(BITS)]
        found.append(sum(level << bit for bit, level in enumerate(looks)))
        place = begin + step * (BITS + 1.5)
        while place < len(levels) and not _at(levels, place):  # a line that stays 0 is no new character
            place += 1.0


def _levels(byte: int) -> Iterator[int]:
    yield 0
    yield from ((byte >> bit) & 1 for bit in range(BITS))
    yield 1


def _at(levels: list[int], place: float) -> int:
    """The level of the line; at rest it is 1."""
    return levels[int(place)] if place < len(levels) else 1
