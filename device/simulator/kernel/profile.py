"""The profiler: where each axis is commanded to be, one sample at a time."""

from __future__ import annotations

from math import floor, sqrt

from device.simulator.kernel.layout import (
    AC_STEP,
    ACTUAL,
    AT_SPEED,
    COMMANDED_LAST_V,
    COMMANDED_V,
    CONTOUR_STEP,
    COUNTS_SHIFT,
    DC_HALF_INVERSE,
    DC_STEP,
    DIRECTION,
    GEAR_LAST,
    GEAR_MASTER,
    GEAR_RATIO,
    HALF_WRAP,
    JOG_V,
    MARK,
    MODE,
    MODE_CONTOUR,
    MODE_IDLE,
    MODE_JOG,
    MODE_POSITION,
    MODE_SETTLING,
    MODE_STOPPING,
    MOVING,
    POSITION,
    POSITION_SHIFT,
    REFERENCE,
    SETTLING,
    SLEW_V,
    SMOOTHED,
    SMOOTHED_LAST,
    SMOOTHING,
    SPEED_V,
    STAGE,
    START,
    STEPPER,
    STEPS,
    STEPS_SHIFT,
    STEPS_SMOOTH,
    STOP_CODE,
    TARGET,
    TRAVEL,
    VELOCITY_V,
    WRAP,
    State,
)

SAMPLES = 1024.0
SNAP = 1e-3  # remaining way, in 1/1024 count, that counts as none (rounding of the square root)


def shift(S: State, b: int, counts: float) -> None:
    """Renames the axis' position: everything measured in its coordinates moves by `counts`."""
    S[b + POSITION] += counts
    S[b + POSITION_SHIFT] += counts
    S[b + SMOOTHED] += counts
    S[b + SMOOTHED_LAST] += counts
    S[b + TARGET] += counts
    S[b + START] += counts
    S[b + MARK] += counts
    S[b + REFERENCE] += counts
    if S[b + STEPPER] != 0.0:
        S[b + STEPS_SHIFT] += counts
        S[b + STEPS] += counts
        S[b + STEPS_SMOOTH] += counts
    S[b + COUNTS_SHIFT] += counts
    S[b + ACTUAL] += counts


def step_by(S: State, b: int, counts: float) -> None:
    """Moves the commanded position, and what the running move aims at, by `counts` at once."""
    S[b + POSITION] += counts
    S[b + SMOOTHED] += counts
    S[b + TARGET] += counts


def finish(S: State, b: int) -> None:
    """The profile is complete."""
    S[b + SMOOTHED] = S[b + POSITION]
    S[b + VELOCITY_V] = 0.0
    S[b + MODE] = MODE_IDLE
    if S[b + STAGE] == 0.0:  # between two stages of HM the move goes on
        S[b + MOVING] = 0.0
    S[b + AT_SPEED] = 0.0
    S[b + SETTLING] = 0.0


def end_of_ramp(S: State, b: int) -> None:
    """The unsmoothed profile has ended; the IT filter may still owe some way."""
    S[b + VELOCITY_V] = 0.0
    S[b + AT_SPEED] = 0.0
    if S[b + SMOOTHING] < 1.0:
        S[b + MODE] = MODE_SETTLING
    else:
        finish(S, b)


def speed_to_stop_in(way: float, step: float) -> float:
    """The highest speed from which steps of `step` a sample still stop within `way` (in 1/1024 count).

    With n = floor(v / step) the way from v is (n + 1) v - step n (n + 1) / 2, this sample included.
    """
    n = floor((sqrt(1.0 + 8.0 * way / step) - 1.0) * 0.5)
    while 0.5 * step * n * (n + 1) > way:
        n -= 1
    while 0.5 * step * (n + 1) * (n + 2) <= way:
        n += 1
    return way / (n + 1) + 0.5 * step * n


def advance_position(S: State, b: int) -> None:
    """One sample of a PA or PR move: up to SP at AC, and down at DC so that the target is met exactly."""
    direction = S[b + DIRECTION]
    v = S[b + VELOCITY_V] * direction
    speed = S[b + SPEED_V]
    step = S[b + DC_STEP]
    way = (S[b + TARGET] - S[b + POSITION]) * direction * SAMPLES
    if v < speed:
        w = v + S[b + AC_STEP]
        if w > speed:
            w = speed
    else:
        w = v - step
        if w < speed:
            w = speed
    S[b + AT_SPEED] = 1.0 if w == speed else 0.0
    if way <= w * w * S[b + DC_HALF_INVERSE] + w + step:
        limit = speed_to_stop_in(way, step)
        if w >= limit:
            w = limit
            S[b + STOP_CODE] = 1.0
            S[b + AT_SPEED] = 1.0 if w == speed else 0.0
        if way - w <= SNAP:
            S[b + STOP_CODE] = 1.0
            S[b + POSITION] = S[b + TARGET]
            end_of_ramp(S, b)
            return
    S[b + VELOCITY_V] = w * direction
    S[b + POSITION] += w * direction / SAMPLES


def advance_jog(S: State, b: int) -> None:
    """One sample of a jog: towards the jog speed at AC, away from a higher or opposite speed at DC."""
    wanted = S[b + JOG_V] if S[b + STAGE] == 0.0 else S[b + SLEW_V]
    v = S[b + VELOCITY_V]
    if v * wanted < 0.0:
        w = abs(v) - S[b + DC_STEP]
        v = 0.0 if w <= 0.0 else (w if v > 0.0 else -w)
    elif abs(v) < abs(wanted):
        w = abs(v) + S[b + AC_STEP]
        if w > abs(wanted):
            w = abs(wanted)
        v = w if wanted > 0.0 else -w
    elif abs(v) > abs(wanted):
        w = abs(v) - S[b + DC_STEP]
        if w < abs(wanted):
            w = abs(wanted)
        v = w if v > 0.0 else -w
    S[b + VELOCITY_V] = v
    S[b + POSITION] += v / SAMPLES
    S[b + AT_SPEED] = 1.0 if v == wanted else 0.0
    if v != 0.0:
        S[b + DIRECTION] = 1.0 if v > 0.0 else -1.0


def advance_stop(S: State, b: int) -> None:
    """One sample of a stop: down at DC; RP then rests on a whole count."""
    v = S[b + VELOCITY_V]
    w = abs(v) - S[b + DC_STEP]
    if w > 0.0:
        v = w if v > 0.0 else -w
        S[b + VELOCITY_V] = v
        S[b + POSITION] += v / SAMPLES
        S[b + AT_SPEED] = 0.0
    else:
        S[b + POSITION] = float(floor(S[b + POSITION] + 0.5))
        end_of_ramp(S, b)


def follow_gear(S: State, b: int) -> None:
    """Adds the gear's share of the master's change in this sample."""
    master = int(S[b + GEAR_MASTER])
    if master >= 0:
        now = S[master]
        change = now - S[b + GEAR_LAST]
        S[b + GEAR_LAST] = now
        if S[b + GEAR_RATIO] != 0.0 and change != 0.0:
            step_by(S, b, change * S[b + GEAR_RATIO])


def advance_profile(S: State, b: int) -> None:
    """One sample of whatever the axis is doing; leaves POSITION behind (before gearing and smoothing)."""
    mode = S[b + MODE]
    if mode == MODE_POSITION:
        advance_position(S, b)
    elif mode == MODE_JOG:
        advance_jog(S, b)
    elif mode == MODE_STOPPING:
        advance_stop(S, b)
    elif mode == MODE_CONTOUR:
        S[b + POSITION] += S[b + CONTOUR_STEP]
        S[b + VELOCITY_V] = S[b + CONTOUR_STEP] * SAMPLES
    S[b + TRAVEL] = S[b + POSITION] - S[b + POSITION_SHIFT]


def smooth(S: State, b: int) -> None:
    """The IT filter, RP, and the renaming of positions that leave 32 bits."""
    smoothing = S[b + SMOOTHING]
    if smoothing >= 1.0:
        S[b + SMOOTHED] = S[b + POSITION]
        if S[b + MODE] == MODE_SETTLING:
            finish(S, b)
    else:
        lag = S[b + POSITION] - S[b + SMOOTHED]
        S[b + SMOOTHED] += smoothing * lag
        if S[b + MODE] == MODE_SETTLING and abs(S[b + POSITION] - S[b + SMOOTHED]) < 0.5:
            finish(S, b)
    reference = float(floor(S[b + SMOOTHED] + 0.5))
    S[b + REFERENCE] = reference
    S[b + COMMANDED_LAST_V] = S[b + COMMANDED_V]
    S[b + COMMANDED_V] = (S[b + SMOOTHED] - S[b + SMOOTHED_LAST]) * SAMPLES
    S[b + SMOOTHED_LAST] = S[b + SMOOTHED]
    if reference >= HALF_WRAP:
        shift(S, b, -WRAP)
    elif reference < -HALF_WRAP:
        shift(S, b, WRAP)


def freeze(S: State, b: int) -> None:
    """RP stops where it is, in this sample: abort, switch-off, immediate stops of homing."""
    S[b + POSITION] = S[b + REFERENCE]
    S[b + TARGET] = S[b + REFERENCE]
    S[b + STAGE] = 0.0
    S[b + GEAR_RATIO] = 0.0
    S[b + CONTOUR_STEP] = 0.0
    S[b + SMOOTHED] = S[b + POSITION]
    finish(S, b)
