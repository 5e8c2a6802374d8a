"""The profiler: where each axis is commanded to be, one sample at a time."""

from __future__ import annotations

from math import floor, sqrt

from device.simulator.kernel.layout import (
    AC_STEP,
    ACTUAL,
    AT_SPEED,
    CAM_ENGAGED,
    CAM_WAITS,
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
    IN_CONTOUR,
    JOG_V,
    MARK,
    MODE,
    MODE_CONTOUR,
    MODE_IDLE,
    MODE_JOG,
    MODE_PATH,
    MODE_POSITION,
    MODE_SETTLING,
    MODE_STOPPING,
    MOVING,
    PATH_ORIGIN,
    POSITION,
    POSITION_SHIFT,
    REFERENCE,
    REFERENCE_BIAS,
    SETTLES_AT_ONCE,
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
    VELOCITY_V,
    WRAP,
    State,
)

SAMPLES = 1024.0
SNAP = 1e-3  # remaining way, in 1/1024 count, that counts as none (rounding of the square root)


def shift(A: State, counts: float) -> None:
    """Renames the axis' position: everything measured in its coordinates moves by `counts`."""
    A[POSITION] += counts
    A[POSITION_SHIFT] += counts
    A[SMOOTHED] += counts
    A[SMOOTHED_LAST] += counts
    A[TARGET] += counts
    A[PATH_ORIGIN] += counts
    A[START] += counts
    A[MARK] += counts
    A[REFERENCE] += counts
    if A[STEPPER] != 0.0:
        A[STEPS_SHIFT] += counts
        A[STEPS] += counts
        A[STEPS_SMOOTH] += counts
    A[COUNTS_SHIFT] += counts
    A[ACTUAL] += counts


def step_by(A: State, counts: float) -> None:
    """Moves the commanded position, and what the running move aims at, by `counts` at once."""
    A[POSITION] += counts
    A[SMOOTHED] += counts
    A[TARGET] += counts
    A[PATH_ORIGIN] += counts


def finish(A: State) -> None:
    """The profile is complete."""
    A[SMOOTHED] = A[POSITION]
    A[VELOCITY_V] = 0.0
    A[MODE] = MODE_IDLE
    if A[STAGE] == 0.0:  # between two stages of HM the move goes on
        A[MOVING] = 0.0
    A[AT_SPEED] = 0.0
    A[SETTLING] = -1.0  # 0 at the end of this sample


def end_of_ramp(A: State) -> None:
    """The unsmoothed profile has ended; the IT filter may still owe some way."""
    A[VELOCITY_V] = 0.0
    A[AT_SPEED] = 0.0
    if A[SMOOTHING] < 1.0:
        A[MODE] = MODE_SETTLING
    else:
        finish(A)


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


def advance_position(A: State) -> None:
    """One sample of a PA or PR move: up to SP at AC, and down at DC so that the target is met exactly."""
    direction = A[DIRECTION]
    v = A[VELOCITY_V] * direction
    speed = A[SPEED_V]
    step = A[DC_STEP]
    way = (A[TARGET] - A[POSITION]) * direction * SAMPLES
    if v < speed:
        w = v + A[AC_STEP]
        if w > speed:
            w = speed
    else:
        w = v - step
        if w < speed:
            w = speed
    A[AT_SPEED] = 1.0 if w == speed else 0.0
    if way <= w * w * A[DC_HALF_INVERSE] + w + step:
        limit = speed_to_stop_in(way, step)
        if w >= limit:
            w = limit
            A[STOP_CODE] = 1.0
            A[AT_SPEED] = 1.0 if w == speed else 0.0
        if way - w <= SNAP:
            A[STOP_CODE] = 1.0
            A[POSITION] = A[TARGET]
            end_of_ramp(A)
            return
    A[VELOCITY_V] = w * direction
    A[POSITION] += w * direction / SAMPLES


def advance_jog(A: State) -> None:
    """One sample of a jog: towards the jog speed at AC, away from a higher or opposite speed at DC."""
    wanted = A[JOG_V] if A[STAGE] == 0.0 else A[SLEW_V]
    v = A[VELOCITY_V]
    if v * wanted < 0.0:
        w = abs(v) - A[DC_STEP]
        v = 0.0 if w <= 0.0 else (w if v > 0.0 else -w)
    elif abs(v) < abs(wanted):
        w = abs(v) + A[AC_STEP]
        if w > abs(wanted):
            w = abs(wanted)
        v = w if wanted > 0.0 else -w
    elif abs(v) > abs(wanted):
        w = abs(v) - A[DC_STEP]
        if w < abs(wanted):
            w = abs(wanted)
        v = w if v > 0.0 else -w
    A[VELOCITY_V] = v
    A[POSITION] += v / SAMPLES
    A[AT_SPEED] = 1.0 if v == wanted else 0.0
    if v != 0.0:
        A[DIRECTION] = 1.0 if v > 0.0 else -1.0


def advance_stop(A: State) -> None:
    """One sample of a stop: down at DC; RP then rests on a whole count."""
    v = A[VELOCITY_V]
    w = abs(v) - A[DC_STEP]
    if w > 0.0:
        v = w if v > 0.0 else -w
        A[VELOCITY_V] = v
        A[POSITION] += v / SAMPLES
        A[AT_SPEED] = 0.0
    else:
        A[POSITION] = float(floor(A[POSITION] + 0.5))
        end_of_ramp(A)


def follow_gear(S: State, A: State) -> None:
    """Adds the gear's share of the master's change in this sample."""
    master = int(A[GEAR_MASTER])
    if master >= 0:
        now = S[master]
        change = now - A[GEAR_LAST]
        A[GEAR_LAST] = now
        if A[GEAR_RATIO] != 0.0 and change != 0.0:
            step_by(A, change * A[GEAR_RATIO])


def advance_profile(A: State) -> None:
    """One sample of whatever the axis is doing; leaves POSITION behind (before gearing and smoothing)."""
    mode = A[MODE]
    if mode == MODE_POSITION:
        advance_position(A)
    elif mode == MODE_JOG:
        advance_jog(A)
    elif mode == MODE_STOPPING:
        advance_stop(A)
    elif mode == MODE_SETTLING:
        if abs(A[POSITION] - A[SMOOTHED]) < 0.5:
            finish(A)
    elif mode == MODE_CONTOUR:
        A[POSITION] += A[CONTOUR_STEP]
        A[VELOCITY_V] = A[CONTOUR_STEP] * SAMPLES


def smooth(A: State) -> None:
    """The IT filter, RP, and the renaming of positions that leave 32 bits."""
    mode = A[MODE]
    smoothing = 1.0 if mode in (MODE_CONTOUR, MODE_PATH) else A[SMOOTHING]
    if smoothing >= 1.0:
        A[SMOOTHED] = A[POSITION]
    else:
        lag = A[POSITION] - A[SMOOTHED]
        A[SMOOTHED] += smoothing * lag
    if A[SETTLES_AT_ONCE] != 0.0 and mode == MODE_SETTLING and abs(A[POSITION] - A[SMOOTHED]) < 0.5:
        finish(A)
    reference = float(floor(A[SMOOTHED] + A[REFERENCE_BIAS]))
    A[REFERENCE] = reference
    A[COMMANDED_LAST_V] = A[COMMANDED_V]
    A[COMMANDED_V] = (A[SMOOTHED] - A[SMOOTHED_LAST]) * SAMPLES
    A[SMOOTHED_LAST] = A[SMOOTHED]
    if reference >= HALF_WRAP:
        shift(A, -WRAP)
    elif reference < -HALF_WRAP:
        shift(A, WRAP)


def freeze(A: State) -> None:
    """RP stops where it is, in this sample: abort, switch-off, immediate stops of homing."""
    A[POSITION] = A[REFERENCE]
    A[TARGET] = A[REFERENCE]
    A[STAGE] = 0.0
    A[GEAR_RATIO] = 0.0
    A[CONTOUR_STEP] = 0.0
    A[IN_CONTOUR] = 0.0
    A[CAM_ENGAGED] = 0.0
    A[CAM_WAITS] = 0.0
    A[SMOOTHED] = A[POSITION]
    finish(A)
