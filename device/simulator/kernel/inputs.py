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
    AXIS,
    COUNTS,
    COUNTS_BEFORE,
    COUNTS_SHIFT,
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
    HOME_TO,
    JOG_V,
    LIMIT_ACTIVE_LEVEL,
    LIMIT_NOW,
    LOAD_X,
    MAIN_ON_LOAD,
    MODE,
    MODE_CONTOUR,
    MODE_IDLE,
    MODE_JOG,
    MODE_POSITION,
    MODE_STOPPING,
    MOTOR_ON,
    MOTOR_X,
    MOVING,
    NOISE,
    OFF_ON_ERROR,
    OUTSIDE_X,
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
    STRIDE,
    VELOCITY_V,
    State,
)
from device.simulator.kernel.profile import freeze

ROOT_OF_THREE = 1.7320508075688772
MODULUS = 2147483647.0


def uniform(S: State) -> float:
    """The next number in 0..1 of the seeded generator (48271 x mod 2**31 - 1)."""
    product = S[RANDOM] * 48271.0
    S[RANDOM] = product - MODULUS * floor(product / MODULUS)
    return S[RANDOM] / MODULUS


def read_encoders(S: State, b: int, axis: int, moment: int) -> None:
    """Latches main and auxiliary encoder."""
    x = S[b + LOAD_X] if S[b + MAIN_ON_LOAD] != 0.0 else S[b + MOTOR_X]
    noise = S[b + NOISE]
    if noise > 0.0:
        x += (uniform(S) + uniform(S) + uniform(S) + uniform(S) - 2.0) * ROOT_OF_THREE * noise
    S[b + RAW_LAST] = S[b + RAW]
    raw = float(floor(x + 0.5))
    S[b + RAW] = raw
    counts = raw * S[b + ENCODER_SIGN]
    if S[b + ANALOG_FEEDBACK] != 0.0:
        counts = float(floor(S[ANALOG_1 + axis] * 204.8 + 0.5))
    S[b + COUNTS] = counts
    S[b + ACTUAL] = counts + S[b + COUNTS_SHIFT]
    S[b + COUNTS_BEFORE] = S[b + HISTORY + moment]
    S[b + HISTORY + moment] = counts
    source = S[b + AUXILIARY_SOURCE]
    if source == 0.0:
        other = S[b + MOTOR_X]
    elif source == 1.0:
        other = S[b + LOAD_X]
    else:
        other = S[b + OUTSIDE_X]
    if source != 2.0:
        other *= S[b + AUXILIARY_RATIO]
    S[b + AUXILIARY_COUNTS] = S[b + AUXILIARY_SIGN] * floor(other + 0.5)
    S[b + AUXILIARY] = S[b + AUXILIARY_COUNTS] + S[b + AUXILIARY_SHIFT]


def read_switches(S: State, b: int) -> None:
    """Levels of home and limit inputs: low where the machine or the outside pulls them low."""
    x = S[b + LOAD_X]
    S[b + HOME_LEVEL] = 0.0 if S[b + HOME_FROM] <= x <= S[b + HOME_TO] else S[b + HOME_FORCED]
    S[b + FORWARD_LEVEL] = 0.0 if x > S[b + FORWARD_SWITCH] else S[b + FORWARD_FORCED]
    S[b + REVERSE_LEVEL] = 0.0 if x < S[b + REVERSE_SWITCH] else S[b + REVERSE_FORCED]


def raise_event(S: State, b: int, bit: int) -> None:
    """Adds an event bit to the axis' word; the loop returns after this sample."""
    word = int(S[b + EVENT])
    if word & bit == 0:
        S[b + EVENT] = word | bit
    S[EVENTS] += 1.0


def forward_blocked(S: State, b: int) -> bool:
    """The forward switch is active or FL is passed."""
    return S[b + FORWARD_LEVEL] == S[b + LIMIT_ACTIVE_LEVEL] or S[b + REFERENCE] > S[b + FORWARD_SOFT]


def reverse_blocked(S: State, b: int) -> bool:
    """The reverse switch is active or BL is passed."""
    return S[b + REVERSE_LEVEL] == S[b + LIMIT_ACTIVE_LEVEL] or S[b + REFERENCE] < S[b + REVERSE_SOFT]


def heading(S: State, b: int) -> float:
    """The sign of where the axis is being driven: its commanded speed, or its intent while that is 0."""
    v = S[b + VELOCITY_V]
    if v == 0.0:
        mode = S[b + MODE]
        if mode == MODE_POSITION:
            v = S[b + DIRECTION]
        elif mode == MODE_JOG:
            v = S[b + JOG_V] if S[b + STAGE] == STAGE_NONE else S[b + SLEW_V]
    return v


def check_limits(S: State, b: int) -> None:
    """Stops an axis that is driven into an active limit; the event is raised when that begins."""
    now = 0.0
    if S[b + MODE] != MODE_IDLE:
        way = heading(S, b)
        if way > 0.0 and forward_blocked(S, b):
            now = 1.0
        elif way < 0.0 and reverse_blocked(S, b):
            now = 2.0
    if now != 0.0 and now != S[b + LIMIT_NOW]:
        raise_event(S, b, EVENT_FORWARD_LIMIT if now == 1.0 else EVENT_REVERSE_LIMIT)
        S[b + STOP_CODE] = now + 1.0
        S[b + GEAR_RATIO] = 0.0
        S[b + STAGE] = STAGE_NONE
        mode = S[b + MODE]
        if mode in (MODE_POSITION, MODE_JOG, MODE_CONTOUR):
            S[b + MODE] = MODE_STOPPING
    S[b + LIMIT_NOW] = now


def check_gear_limits(S: State, b: int, before: float) -> None:
    """Gearing ends when it drives the axis into an active limit."""
    if S[b + GEAR_RATIO] == 0.0 or S[b + LIMIT_NOW] != 0.0:
        return
    change = S[b + REFERENCE] - before
    if change > 0.0 and forward_blocked(S, b):
        S[b + GEAR_RATIO] = 0.0
        S[b + STOP_CODE] = 2.0
        raise_event(S, b, EVENT_FORWARD_LIMIT)
    elif change < 0.0 and reverse_blocked(S, b):
        S[b + GEAR_RATIO] = 0.0
        S[b + STOP_CODE] = 3.0
        raise_event(S, b, EVENT_REVERSE_LIMIT)


def check_abort(S: State, axes: int) -> None:
    """The abort input going low freezes every axis in this sample; with OE 1 it also switches the axis off."""
    if S[ABORT_LEVEL] == 0.0 and S[ABORT_SEEN] == 0.0:
        b = AXIS
        for _ in range(axes):
            if S[b + MOVING] != 0.0:
                S[b + STOP_CODE] = 6.0
            freeze(S, b)
            if S[b + OFF_ON_ERROR] != 0.0:
                S[b + MOTOR_ON] = 0.0
            raise_event(S, b, EVENT_ABORT)
            b += STRIDE
    S[ABORT_SEEN] = 1.0 - S[ABORT_LEVEL]
