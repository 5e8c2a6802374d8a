"""What the person has set in the tuner, as one value."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from device.tuning.loop import Gains

TORQUE, VELOCITY, UNSURE = "torque", "velocity", "unsure"
DRIVES = {UNSURE: "Not sure: find out", TORQUE: "Torque (current)", VELOCITY: "Velocity"}


@dataclass(frozen=True)
class Asked:
    """A step in counts with these gains, at most so many volts, recorded for so long."""

    axis: str
    step: int
    gains: Gains
    torque: float
    seconds: float
    drive: str = UNSURE


@dataclass(frozen=True)
class Judged:
    """What would happen, as a sentence, or why it cannot."""

    words: str
    problem: str = ""
