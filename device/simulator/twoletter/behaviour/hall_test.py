"""Hall sensors as BC and BS see them: their levels, and what a turn there and back tells about their wires.

No manual prints the answers of BS; their words are inferred, their facts are those of dmc-1412-1414.txt l.719-735.
"""

from __future__ import annotations

import cmath
import math
from itertools import pairwise
from typing import TYPE_CHECKING

from codegen.twoletter.fixed import ONE

if TYPE_CHECKING:
    from collections.abc import Sequence

    from device.simulator.twoletter.unit import Unit

Seen = tuple[int, int]  # position, levels of the three sensors


def bits(unit: Unit) -> int:
    """_BC: levels of the three hall inputs, the first in bit 0; 1 to 6, and 0 without BI."""
    first = unit.state.registers["BI"][0] // ONE
    return unit.inputs >> (first - 1) & 7 if first > 0 else 0


def findings(seen: Sequence[Seen], sweep: int, first: int) -> list[str]:
    """The answer of BS; `seen` begins with the field at 0, and turns once there and once back."""
    there, back = seen[: sweep + 2], seen[sweep + 1 :]
    begin, end = there[0][0], there[-1][0]
    cycle = (abs(end - begin) + abs(back[-1][0] - back[0][0])) / 2
    if cycle < 1:
        return ["No movement"]
    if end < begin:
        return ["Phase wiring is wrong, exchange phases A and B", f"BM is about {cycle:.0f}"]
    lines = ["Phase wiring is correct", f"BM is about {cycle:.0f}"]
    angles = [_rising(there, back, wire, begin, end) for wire in range(3)]
    if first == 0 or None in angles:
        return [*lines, "No hall sensors"]
    one, two, _ = (angle for angle in angles if angle is not None)
    right = (two - one) % 360 < 180
    wires = "correct" if right else f"wrong, exchange inputs {first + 1} and {first + 2}"
    return [*lines, f"Hall wiring is {wires}", f"BB is about {round(one) % 360}"]


def closed(turn: Sequence[Seen]) -> list[Seen]:
    """A whole turn ends where it began: what is seen there may differ by a hair."""
    return [*turn, (turn[-1][0], turn[0][1])]


def _rising(there: Sequence[Seen], back: Sequence[Seen], wire: int, begin: int, end: int) -> float | None:
    """The angle at which a sensor goes high, from both turns; None where it does not once in each."""
    mask = 1 << wire
    up = [(a[0] + b[0]) / 2 for a, b in pairwise(closed(there)) if b[1] & mask > a[1] & mask]
    down = [(a[0] + b[0]) / 2 for a, b in pairwise(closed(back)) if b[1] & mask < a[1] & mask]
    if not up or not down:
        return None
    turns = [2 * math.pi * (place - begin) / (end - begin) for place in (up[0], down[0])]
    return math.degrees(cmath.phase(sum(cmath.rect(1, angle) for angle in turns))) % 360
