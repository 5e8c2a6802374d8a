"""Counts of an axis as numbers in its user unit."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from codegen.setup import Axis

NOTHING = "–"


def scale_of(axis: Axis) -> float:
    """Counts per user unit."""
    return float(axis.scale)


def decimals_of(axis: Axis) -> int:
    """Fixed decimals that still show one count."""
    scale = scale_of(axis)
    return max(0, min(4, math.ceil(math.log10(scale) - 1e-9))) if scale > 0 else 0


def shown(counts: float, axis: Axis, decimals: int | None = None) -> str:
    """A position or distance in user units; a dash when unknown."""
    if not math.isfinite(counts):
        return NOTHING
    places = decimals_of(axis) if decimals is None else decimals
    text = f"{counts / scale_of(axis):.{places}f}"
    return text[1:] if text.startswith("-") and float(text) == 0 else text
