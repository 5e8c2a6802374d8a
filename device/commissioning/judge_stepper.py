"""Judges a stepper: whether it is one to the controller, and what the person saw of its test move."""

from __future__ import annotations

from codegen.twoletter.problems import STOP_TEXTS
from device.commissioning.judge import AT_TARGET, FAILED, OPEN, PASSED, Moved
from device.commissioning.record import Finding

JUMPER = (
    "Switch the power off and set the SM jumper of this axis (SSC: SMX, SMY, SMZ, SMW at JP40; DMC-141x: SM).",
    "Is it a servo? Then choose that in the setup.",
)
OTHER_WAY = (
    "Choose the reversed kind under “Step and direction” (MT 2.5 or -2.5), and set it again.",
    "Or exchange the two wires of one phase of the motor, with the power off: that survives a master reset.",
)
NOTHING_TURNED = (
    "Is the drive powered and enabled? Look at its lamp while the motor is on.",
    "Check the wires of step and direction (SSC: J4, ICM-1460: PWM and SIGN), and their common.",
    "The drive may want the other active level: choose it under “Step and direction”.",
    "It hums or shakes without turning: check the wires of the phases, the current that the drive is set to, and what "
    "blocks the axis.",
)


def refused(failure: str) -> Finding:
    """What the controller did not take, with the way out where the jumper is missing (error 96)."""
    if "error 96" not in failure:
        return Finding(OPEN, failure)
    words = "The controller does not drive this axis as a stepper: its SM jumper is not set (error 96)."
    return Finding(FAILED, words, JUMPER)


def judge_pulses(moved: Moved) -> Finding:
    """Whether the pulses went out; what the motor made of them only the person can say."""
    if moved.tripped or moved.bounded or moved.code != AT_TARGET or moved.way != abs(moved.asked):
        why = STOP_TEXTS.get(moved.code, f"stop code {moved.code}")
        words = f"Only {moved.way} of {abs(moved.asked)} pulses were sent ({why})."
        advice = ("Is a limit switch tripped? Move the axis away from its end by hand.",)
        return Finding(FAILED, words, advice, pulse_facts(moved))
    return Finding(OPEN, f"{abs(moved.asked)} pulses were sent.", (), pulse_facts(moved))


def judge_turned(moved: Moved, saw: bool | None) -> Finding:
    """`saw`: whether it went the way that is called forward for a move above 0; None: nothing turned."""
    facts = pulse_facts(moved)
    if saw is None:
        return Finding(FAILED, "The motor did not turn, although pulses were sent.", NOTHING_TURNED, facts)
    if saw != (moved.asked > 0):
        words = "The motor turns, but the other way than the one called forward."
        return Finding(FAILED, words, OTHER_WAY, facts)
    return Finding(PASSED, "The motor turns, and forward is forward, as you have seen.", (), facts)


def pulse_facts(moved: Moved) -> tuple[tuple[str, str], ...]:
    return (
        ("Commanded", f"{moved.asked} pulses"),
        ("Sent", f"{moved.end - moved.start} pulses"),
        ("Encoder", f"{moved.encoder} counts" if moved.encoder else "did not change"),
        ("Stop code", f"{moved.code}, {STOP_TEXTS.get(moved.code, 'unknown')}"),
    )
