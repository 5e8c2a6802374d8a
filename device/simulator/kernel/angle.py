"""Sine without a library: the same bits compiled or not, on every machine."""

from __future__ import annotations

from math import floor

RADIANS = 0.017453292519943295


def sine(degrees: float) -> float:
    """Sine by its series on ±45°: the same bits compiled or not, on every machine."""
    quarter = floor(degrees / 90.0 + 0.5)
    x = (degrees - 90.0 * quarter) * RADIANS
    q = x * x
    turn = quarter & 3
    if turn in (0, 2):
        value = 1.0 - q / 210.0 * (1.0 - q / 272.0)
        value = 1.0 - q / 110.0 * (1.0 - q / 156.0 * value)
        value = 1.0 - q / 42.0 * (1.0 - q / 72.0 * value)
        value = x * (1.0 - q / 6.0 * (1.0 - q / 20.0 * value))
    else:
        value = 1.0 - q / 182.0 * (1.0 - q / 240.0)
        value = 1.0 - q / 90.0 * (1.0 - q / 132.0 * value)
        value = 1.0 - q / 30.0 * (1.0 - q / 56.0 * value)
        value = 1.0 - q / 2.0 * (1.0 - q / 12.0 * value)
    return -value if turn >= 2 else value
