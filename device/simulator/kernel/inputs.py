"""What the controller reads at the start of a sample: encoders, switches, the abort input, limits in the way."""

from __future__ import annotations

from math import floor

from device.simulator.kernel.layout import (
    ABORT_LEVEL,
    ABORT_SEEN,
    ACTUAL,
    ANALOG_1,
    ANALOG_FEEDBACK,
    AUXILIARY,
    AUXILIARY_COUNTS,
    AUXILIARY_RATIO,
    AUXILIARY_SHIFT,
    AUXILIARY_SIGN,
    AUXILIARY_SOURCE,
    CAM_ENGAGED,
    COUNTS,
    COUNTS_BEFORE,
    COUNTS_SHIFT,
    DEAD_CHANNEL,
    DIRECTION,
    ENCODER_SIGN,
    EVENT,
    EVENT_ABORT,
    EVENT_FORWARD_LIMIT,
    EVENT_REVERSE_LIMIT,
    EVENTS,
    FORWARD_FORCED,
    FORWARD_LEVEL,
    FORWARD_SOFT,
    FORWARD_SWITCH,
    GEAR_RATIO,
    HISTORY,
    HOME_FORCED,
    HOME_FROM,
    HOME_LEVEL,
    HOME_STUCK,
    HOME_TO,
    IN_CONTOUR,
    JOG_V,
    LIMIT_ACTIVE_LEVEL,
    LIMIT_NOW,
    LIMITS_SWAPPED,
    LOAD_X,
    MAIN_ON_LOAD,
    MODE,
    MODE_CONTOUR,
    MODE_IDLE,
    MODE_JOG,
    MODE_PATH,
    MODE_POSITION,
    MODE_STOPPING,
    MOTOR_ON,
    MOTOR_X,
    MOVED,
    MOVING,
    NOISE,
    OFF_ON_ERROR,
    OUTSIDE_X,
    PATH_STOP_CODE,
    RANDOM,
    RAW,
    RAW_LAST,
    REFERENCE,
    REVERSE_FORCED,
    REVERSE_LEVEL,
    REVERSE_SOFT,
    REVERSE_SWITCH,
    SLEW_V,
    STAGE,
    STAGE_NONE,
    STOP_CODE,
    VELOCITY_V,
    State,
    part,
)
from device.simulator.kernel.profile import freeze

ROOT_OF_THREE = 1.7320508075688772
MODULUS = 2147483647.0


def uniform(S: State) -> float:
    """The next number in 0..1 of the seeded generator (48271 x mod 2**31 - 1)."""
    product = S[RANDOM] * 48271.0
    S[RANDOM] = product - MODULUS * floor(product / MODULUS)
    return S[RANDOM] / MODULUS


def toggled(raw: float, dead: float) -> float:
    """With one channel low the other counts one forward and the same one back (dmc-1412-1414.txt l.606)."""
    quarter = raw - 4.0 * floor(raw / 4.0)  # A is high in quarters 1 and 2, B in 2 and 3
    return 1.0 if quarter == 2.0 or quarter == (3.0 if dead == 1.0 else 1.0) else 0.0


def read_encoders(S: State, A: State, axis: int, moment: int) -> None:
    """Latches main and auxiliary encoder."""
    x = A[LOAD_X] if A[MAIN_ON_LOAD] != 0.0 else A[MOTOR_X]
    noise = A[NOISE]
    if noise > 0.0:
        x += (uniform(S) + uniform(S) + uniform(S) + uniform(S) - 2.0) * ROOT_OF_THREE * noise
    A[RAW_LAST] = A[RAW]
    raw = float(floor(x + 0.5))
    if A[DEAD_CHANNEL] != 0.0:
        raw = toggled(raw, A[DEAD_CHANNEL])
    A[RAW] = raw
    counts = raw * A[ENCODER_SIGN]
    if A[ANALOG_FEEDBACK] != 0.0:
        counts = min(float(floor(S[ANALOG_1 + axis] * 204.8 + 0.5)), 2047.0)  # twelve bits (SSC manual l.1797)
    A[COUNTS] = counts
    A[ACTUAL] = counts + A[COUNTS_SHIFT]
    A[COUNTS_BEFORE] = A[HISTORY + moment]
    A[MOVED] = counts - A[COUNTS_BEFORE]
    A[HISTORY + moment] = counts
    source = A[AUXILIARY_SOURCE]
    if source == 0.0:
        other = A[MOTOR_X]
    elif source == 1.0:
        other = A[LOAD_X]
    else:
        other = A[OUTSIDE_X]
    if source != 2.0:
        other *= A[AUXILIARY_RATIO]
    A[AUXILIARY_COUNTS] = A[AUXILIARY_SIGN] * floor(other + 0.5)
    A[AUXILIARY] = A[AUXILIARY_COUNTS] + A[AUXILIARY_SHIFT]


def read_switches(A: State) -> None:
    """Levels of home and limit inputs: low where the machine or the outside pulls them low."""
    x = A[LOAD_X]
    A[HOME_LEVEL] = 0.0 if A[HOME_FROM] <= x <= A[HOME_TO] else A[HOME_FORCED]
    A[FORWARD_LEVEL] = 0.0 if x > A[FORWARD_SWITCH] else A[FORWARD_FORCED]
    A[REVERSE_LEVEL] = 0.0 if x < A[REVERSE_SWITCH] else A[REVERSE_FORCED]
    if A[LIMITS_SWAPPED] != 0.0:
        level = A[FORWARD_LEVEL]
        A[FORWARD_LEVEL] = A[REVERSE_LEVEL]
        A[REVERSE_LEVEL] = level
    if A[HOME_STUCK] != 0.0:
        A[HOME_LEVEL] = 1.0


def raise_event(S: State, A: State, bit: int) -> None:
    """Adds an event bit to the axis' word; the loop returns after this sample."""
    word = int(A[EVENT])
    if word & bit == 0:
        A[EVENT] = word | bit
    S[EVENTS] += 1.0


def forward_blocked(A: State) -> bool:
    """The forward switch is active or FL is passed."""
    return A[FORWARD_LEVEL] == A[LIMIT_ACTIVE_LEVEL] or A[REFERENCE] > A[FORWARD_SOFT]


def reverse_blocked(A: State) -> bool:
    """The reverse switch is active or BL is passed."""
    return A[REVERSE_LEVEL] == A[LIMIT_ACTIVE_LEVEL] or A[REFERENCE] < A[REVERSE_SOFT]


def heading(A: State) -> float:
    """The sign of where the axis is being driven: its commanded speed, or its intent while that is 0."""
    v = A[VELOCITY_V]
    if v == 0.0:
        mode = A[MODE]
        if mode == MODE_POSITION:
            v = A[DIRECTION]
        elif mode == MODE_JOG:
            v = A[JOG_V] if A[STAGE] == STAGE_NONE else A[SLEW_V]
    return v


def check_limits(S: State, A: State) -> None:
    """Stops an axis that is driven into an active limit; the event is raised when that begins."""
    now = 0.0
    if A[MODE] != MODE_IDLE:
        way = heading(A)
        if way > 0.0 and forward_blocked(A):
            now = 1.0
        elif way < 0.0 and reverse_blocked(A):
            now = 2.0
    if now != 0.0 and now != A[LIMIT_NOW]:
        raise_event(S, A, EVENT_FORWARD_LIMIT if now == 1.0 else EVENT_REVERSE_LIMIT)
        A[STOP_CODE] = now + 1.0
        A[GEAR_RATIO] = 0.0
        A[CAM_ENGAGED] = 0.0
        A[STAGE] = STAGE_NONE
        mode = A[MODE]
        if mode in (MODE_POSITION, MODE_JOG, MODE_CONTOUR):
            A[MODE] = MODE_STOPPING
            A[IN_CONTOUR] = 0.0
        elif mode == MODE_PATH and S[PATH_STOP_CODE] == 0.0:
            S[PATH_STOP_CODE] = now + 1.0
    A[LIMIT_NOW] = now


def check_gear_limits(S: State, A: State, before: float) -> None:
    """Gearing ends when it drives the axis into an active limit."""
    if (A[GEAR_RATIO] == 0.0 and A[CAM_ENGAGED] == 0.0) or A[LIMIT_NOW] != 0.0:
        return
    change = A[REFERENCE] - before
    if change > 0.0 and forward_blocked(A):
        A[GEAR_RATIO] = 0.0
        A[CAM_ENGAGED] = 0.0
        A[STOP_CODE] = 2.0
        raise_event(S, A, EVENT_FORWARD_LIMIT)
    elif change < 0.0 and reverse_blocked(A):
        A[GEAR_RATIO] = 0.0
        A[CAM_ENGAGED] = 0.0
        A[STOP_CODE] = 3.0
        raise_event(S, A, EVENT_REVERSE_LIMIT)


def check_abort(S: State, axes: int) -> None:
    """The abort input going low freezes every axis in this sample; with OE 1 it also switches the axis off."""
    if S[ABORT_LEVEL] == 0.0 and S[ABORT_SEEN] == 0.0:
        for axis in range(axes):
            A = part(S, axis)
            if A[MOVING] != 0.0:
                A[STOP_CODE] = 6.0
            freeze(A)
            if A[OFF_ON_ERROR] != 0.0:
                A[MOTOR_ON] = 0.0
            raise_event(S, A, EVENT_ABORT)
    S[ABORT_SEEN] = 1.0 - S[ABORT_LEVEL]
