"""How long a coordinated move lasts, worked out of its commands, so that its end is looked for when it comes. Pure."""

from __future__ import annotations

import math
from collections.abc import Sequence

Stretch = tuple[float, float]  # length in counts, speed in counts/s


def seconds_of(commands: Sequence[str], ratio: float = 1.0) -> float:
    """Seconds of 1024 samples from BG S to the end, at VR `ratio`; 0 where the commands do not tell."""
    values = {"VS": 0.0, "VA": 0.0, "VD": 0.0}
    stretches: list[Stretch] = []
    here = (0.0, 0.0)
    for command in commands:
        name, _, rest = command.partition(" ")
        if name in values:
            values[name] = float(rest)
        elif name in ("LI", "VP", "CR"):
            text, _, own = rest.partition("<")
            numbers = [float(each) if each.strip() else 0.0 for each in text.split(",")]
            length, here = _length(name, numbers, here)
            values["VS"] = float(own) if own.strip() else values["VS"]  # it holds for those behind it too
            stretches.append((length, values["VS"] * ratio))
    return _lasting(stretches, values["VA"], values["VD"])


def _length(name: str, numbers: Sequence[float], here: tuple[float, float]) -> tuple[float, tuple[float, float]]:
    """Of one segment, and where the next begins: LI counts from here, VP from the start, CR is radius, start, sweep."""
    if name == "LI":
        return math.hypot(*numbers), here
    if name == "VP":
        there = (numbers[0], numbers[1])
        return math.dist(here, there), there
    radius, start, sweep = numbers
    first, last = math.radians(start), math.radians(start + sweep)
    x = here[0] + radius * (math.cos(last) - math.cos(first))
    y = here[1] + radius * (math.sin(last) - math.sin(first))
    return radius * abs(math.radians(sweep)), (x, y)


def _lasting(stretches: Sequence[Stretch], acceleration: float, deceleration: float) -> float:
    """Speed up, the stretches at their speeds, slow down; or up and at once down where the way is too short."""
    if not stretches or min(acceleration, deceleration, *(speed for _, speed in stretches)) <= 0:
        return 0.0
    whole, first, last = sum(length for length, _ in stretches), stretches[0][1], stretches[-1][1]
    if whole < first**2 / (2 * acceleration) + last**2 / (2 * deceleration):
        top = math.sqrt(2 * whole * acceleration * deceleration / (acceleration + deceleration))
        return top / acceleration + top / deceleration
    ramps = first / (2 * acceleration) + last / (2 * deceleration)
    return sum(length / speed for length, speed in stretches) + ramps
