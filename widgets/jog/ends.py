"""Where planned moves end, before they are started: from live commanded positions, in the unit of each axis."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from device.jog import Places, Plan
from widgets.display.readings import unit_of
from widgets.parts.units import shown

if TYPE_CHECKING:
    from codegen.setup import Setup
    from device.api import Row

UNKNOWN = "Where it ends is not known: the place of {} is not read at the moment."
OPEN = "Ends where its switch or its pulse is; that is not known beforehand."


def places_of(row: Row, letters: Iterable[str], setup: Setup, now: float) -> Places:
    """Commanded places, as far as they are fresh, between the limits of the setup."""
    found = {}
    for letter in letters:
        key = f"commanded.{letter.lower()}"
        value = row.value(key)
        if math.isfinite(value) and not row.stale(key, now):
            found[letter] = round(value)
    return Places(found).narrowed(setup)


def ghost_of(plan: Plan | None, places: Places) -> dict[str, int]:
    """Where each axis of a plan ends, counts; nothing where that is not known."""
    if plan is None or plan.problem:
        return {}
    return plan.ghost(places)


def ends_words(plan: Plan, places: Places, setup: Setup) -> tuple[str, bool]:
    """Where a plan ends, as a sentence; and whether it passes a limit, which is said too."""
    if plan.problem:
        return plan.problem, True
    if plan.defines:
        return "", False
    if not plan.ends:
        return OPEN, False
    missing = [letter for letter in plan.axes if letter not in places.commanded]
    if missing and not plan.absolute:
        return UNKNOWN.format(missing[0]), False
    words = f"Ends at {places_words(plan.ghost(places), setup)}."
    passes = "" if missing else plan.passes(places, setup)
    return (f"{words} {passes}", True) if passes else (words, False)


def places_words(places: Mapping[str, int], setup: Setup) -> str:
    """ "X 12.500 mm, Y 3.000 mm"."""
    parts = []
    for letter, counts in places.items():
        axis = setup.axis(letter)
        parts.append(f"{letter} {shown(counts, axis)} {unit_of(axis)}")
    return ", ".join(parts)
