"""What sentences promise, in the words of the shop floor: distances in units, seconds, volts."""

from __future__ import annotations

import math
from collections.abc import Callable

from codegen.setup import Setup
from tests.codegen.modes.bench import SAMPLES, Oracle, Seen

COMMAND = 20  # samples; what the statements in between may take


def scale(setup: Setup, letter: str) -> float:
    """Counts in one unit."""
    return float(setup.axis(letter).scale)


def close(value: float, wanted: float, within: float = 1.0) -> bool:
    """The same but for rounding."""
    return abs(value - wanted) <= within


def both(*parts: Oracle) -> Oracle:
    """All of them hold."""
    return lambda before, after, setup: all(part(before, after, setup) for part in parts)


def became(expression: str, value: float, within: float = 0.001) -> Oracle:
    """A value of the controller is this afterwards, and was something else before."""
    return lambda before, after, setup: (
        close(after[expression], value, within) and not close(before[expression], value, within)
    )


def stays(expression: str) -> Oracle:
    """A value of the controller is what it was."""
    return lambda before, after, setup: after[expression] == before[expression]


def went(letter: str, units: float, within: float = 1.0) -> Oracle:
    """The commanded position had gone this far when the program went on."""
    return lambda before, after, setup: close(
        after.at(letter) - before.at(letter), units * scale(setup, letter), within
    )


def goes(letter: str, units: float, within: float = 1.0) -> Oracle:
    """The commanded position goes this far in the end."""
    return lambda before, after, setup: close(
        after[f"_RP{letter}"] - before[f"_RP{letter}"], units * scale(setup, letter), within
    )


def is_at(letter: str, units: float, within: float = 1.0) -> Oracle:
    """The commanded position is this in the end."""
    return lambda before, after, setup: close(after[f"_RP{letter}"], units * scale(setup, letter), within)


def took(seconds: float, within: float = COMMAND) -> Oracle:
    """The program was held for so long (a second has 1024 samples)."""
    return lambda before, after, setup: close(after.waited, seconds * SAMPLES, within)


def at_once() -> Oracle:
    """The program goes on without waiting."""
    return took(0)


def profile(distance: float, speed: float, acceleration: float, deceleration: float) -> float:
    """Seconds of a trapezoidal (or triangular) profile."""
    distance = abs(distance)
    ramps = speed * speed / 2 / acceleration + speed * speed / 2 / deceleration
    if ramps > distance:
        speed = math.sqrt(2 * distance * acceleration * deceleration / (acceleration + deceleration))
        return speed / acceleration + speed / deceleration
    return speed / acceleration + speed / deceleration + (distance - ramps) / speed


def top_speed(letter: str, units: float, share: float = 0.02) -> Oracle:
    """The fastest the axis is commanded, in units/s."""

    def holds(before: Seen, after: Seen, setup: Setup) -> bool:
        fastest = max(map(abs, after.speeds(letter)))
        wanted = units * scale(setup, letter)
        return abs(fastest - wanted) <= share * wanted

    return holds


def stands(letters: str) -> Oracle:
    """Nothing of it moves in the end."""
    return lambda before, after, setup: all(after[f"_BG{letter}"] == 0 for letter in letters)


def runs(letters: str) -> Oracle:
    """All of it moves in the end."""
    return lambda before, after, setup: all(after[f"_BG{letter}"] == 1 for letter in letters)


def output(number: int, on: bool) -> Oracle:
    """An output is on or off, the others are what they were."""

    def holds(before: Seen, after: Seen, setup: Setup) -> bool:
        bit = 1 << number - 1
        was, now = int(before["_OP"]), int(after["_OP"])
        return bool(now & bit) == on and was & ~bit == now & ~bit and bool(was & bit) != on

    return holds


def prints(text: str, port: int = 1) -> Oracle:
    """The text comes out of a port, and did not before."""
    return lambda before, after, setup: text in after.sent[port] and text not in before.sent[port]


def silent(port: int) -> Oracle:
    """Nothing comes out of a port."""
    return lambda before, after, setup: after.sent[port] == ""


def sees(check: Callable[[Seen, Seen], bool]) -> Oracle:
    """Anything else, of both runs."""
    return lambda before, after, setup: check(before, after)
