"""What to do next, after a stop code of an axis and after an error code of the controller."""

from __future__ import annotations

from typing import Final

# stop codes (STOP_TEXTS) by what they tell
RUNNING: Final = frozenset({0, 50, 100})
ARRIVED: Final = frozenset({1, 51, 101})
FOUND: Final = frozenset({9, 10})  # an edge, the home switch or the index: where it was sent

STOP_STEPS: Final[dict[int, str]] = {
    2: "Move the axis back in reverse; if it is not at the switch, look at FL, CN and the wiring of the limit.",
    3: "Move the axis back forward; if it is not at the switch, look at BL, CN and the wiring of the limit.",
    4: "Start again when the reason of the stop is gone.",
    6: "Free the abort input, then switch the motors on (SH).",
    7: "Switch the motors on (SH) where off-on-error switched them off.",
    8: "Look for something that blocks the axis, at KP, TL and ER; then switch the motor on (SH).",
    99: "The axis did not come to rest in the time of TW: look at the gains, at friction, at TW.",
}
ERROR_STEPS: Final[dict[int, str]] = {
    1: "Look at the spelling of the line.",
    4: "Look at the numbers and names of the line.",
    6: "Look at the range of the number in the help of the command.",
    7: "Wait for the end of the motion (AM) before this line.",
    20: "Switch the motor on (SH) before the move begins.",
    21: "Wait for the end of the motion (AM) before the next one begins.",
    22: "Move away from the limit switch first.",
}
USUAL_STEP: Final = "Look at the line, and at the help of its command."


def error_step(code: int) -> str:
    """What to do after an error."""
    return ERROR_STEPS.get(code, USUAL_STEP)
