"""A small excitation: the commanded position jumps within a stated travel while error and torque are captured."""

from __future__ import annotations

import math
import random
from dataclasses import dataclass

from device.tuning.loop import VOLTS, Gains

EXPONENT = 1  # RC 1: every second sample; the samples between follow from the filter (see `recording`)
STANDING = 0.02  # s of rest before the first jump
LAST = 0.15  # s left for the answer to the last one
SMALLEST = 4  # counts; smaller jumps drown in the counting
LEAST_KD = 1.0  # below, the torque does not tell the error between two elements
HELD_PART = 0.5  # of the torque limit: what KP makes of the largest jump until the axis moves
KICK_PART = 0.8  # of it: the one sample in which the largest jump appears; the rest is for weight and motion
CHANNELS = ("TE", "TT", "TP")


@dataclass(frozen=True)
class Step:
    """One jump of the commanded position."""

    at: float  # s after RC
    counts: int


@dataclass(frozen=True)
class Excitation:
    """What to send (IP in a jog at speed 0) and what to capture."""

    steps: tuple[Step, ...]
    exponent: int  # of RC
    elements: int  # of each array
    channels: tuple[str, ...]
    travel: int  # counts that the commanded position leaves its place, at most
    peak_volts: float  # in the sample in which the largest jump appears
    seconds: float


@dataclass(frozen=True)
class NotIdentified:
    """Why there is no estimate, in a sentence."""

    reason: str


def refused(gains: Gains, dual: bool) -> str:
    """Why an axis cannot be excited to be identified, or nothing."""
    if dual:
        return (
            "An axis that works with a dual loop (DV 1) cannot be identified: its damping comes from the other "
            "encoder. Tune it automatically or by hand."
        )
    if gains.kd < LEAST_KD:
        return f"KD is {gains.kd:g}: to identify the axis it has to be {LEAST_KD:g} or more. Raise KD first."
    return ""


def kick(gains: Gains) -> float:
    """Volts that one count of error makes in the sample in which it appears."""
    return VOLTS * (4.0 * gains.kp + 4.0 * gains.kd)


def held(gains: Gains) -> float:
    """Volts that one count of error makes while it lasts."""
    return max(1e-9, VOLTS * 4.0 * gains.kp)


def carried(gains: Gains, error: float, volts: float) -> float:
    """Volts that hold a resting axis: what KP makes of its error (counts); with an integrator what is commanded."""
    return held(gains) * abs(error) if gains.kp and not gains.ki else abs(volts - gains.offset)


def sag(gains: Gains, volts: float) -> float:
    """Counts that an axis hangs below its place while KP alone carries so many volts; 0 without KP."""
    return volts / held(gains) if gains.kp else 0.0


def excitation(
    gains: Gains,
    travel: int,
    elements: int,
    channels: int,
    period: float,
    seed: int = 0,
    spacing: float = 0.03,
) -> Excitation | NotIdentified:
    """Jumps between three places, at times that repeat in no rhythm; the torque stays well below its limit."""
    if wrong := refused(gains, False):
        return NotIdentified(wrong)
    largest = min(KICK_PART * gains.torque_limit / kick(gains), HELD_PART * gains.torque_limit / held(gains))
    size = min(travel // 2, math.floor(largest / 2.0))
    if size < SMALLEST:
        cause = f"The travel of {travel} counts" if travel // 2 < SMALLEST else f"KP {gains.kp:g} and KD {gains.kd:g}"
        return NotIdentified(f"{cause} would leave jumps of {max(0, size)} counts; {SMALLEST} are the least.")
    seconds = elements * 2**EXPONENT * period
    chance = random.Random(seed)
    steps: list[Step] = []
    at, place = STANDING, 0
    while at < seconds - LAST:
        place, before = chance.choice([other for other in (-1, 0, 1) if other != place]), place
        steps.append(Step(round(at, 4), (place - before) * size))
        at += spacing * chance.choice((1.0, 1.6, 2.3, 4.0))
    return Excitation(
        tuple(steps),
        EXPONENT,
        elements,
        CHANNELS[:channels],
        size,
        2.0 * size * kick(gains),
        seconds,
    )
