"""Coordinated motion: one profile along a path of lines and arcs, and the axes' places on it (LM and VM)."""

from __future__ import annotations

from math import floor

from device.simulator.kernel.angle import sine
from device.simulator.kernel.layout import (
    G_ARC,
    G_DIRECTION,
    G_END,
    G_LENGTH,
    G_SPEED_V,
    G_START,
    G_TANGENT,
    G_TANGENT_SLOPE,
    MAXIMUM_SEGMENTS,
    MODE,
    MODE_PATH,
    PATH_AC_STEP,
    PATH_ACTIVE,
    PATH_AT_SPEED,
    PATH_DC_STEP,
    PATH_END,
    PATH_ENDED,
    PATH_FINISHED,
    PATH_FIRST,
    PATH_HEAD,
    PATH_MEMBER,
    PATH_MOVING,
    PATH_ORIGIN,
    PATH_OUT_HEAD,
    PATH_POINT,
    PATH_RATIO,
    PATH_SECOND,
    PATH_SMOOTHED,
    PATH_SMOOTHING,
    PATH_SPEED_V,
    PATH_STOP_CODE,
    PATH_TAIL,
    PATH_TOTAL,
    PATH_TRAVELLED,
    PATH_V,
    POSITION,
    SEGMENT_STRIDE,
    SEGMENTS,
    STOP_CODE,
    VELOCITY_V,
    State,
    part,
)
from device.simulator.kernel.profile import SAMPLES, SNAP, finish, speed_to_stop_in


def segment(number: float) -> int:
    """Where the segment with this number is kept."""
    return SEGMENTS + SEGMENT_STRIDE * (int(number) & (MAXIMUM_SEGMENTS - 1))


def enter_segments(S: State) -> None:
    """Steps on to the segment the profile is on; a speed given with it becomes VS."""
    while S[PATH_HEAD] < S[PATH_TAIL] - 1.0 and S[PATH_TRAVELLED] >= S[segment(S[PATH_HEAD]) + G_END]:
        S[PATH_HEAD] += 1.0
        speed = S[segment(S[PATH_HEAD]) + G_SPEED_V]
        if speed >= 0.0:
            S[PATH_SPEED_V] = speed


def path_speed(S: State) -> float:
    """Speed of this sample without regard to the end: towards VS times VR, or down with VD."""
    v = S[PATH_V]
    if S[PATH_STOP_CODE] != 0.0:
        return max(v - S[PATH_DC_STEP], 0.0)
    wanted = S[PATH_SPEED_V] * S[PATH_RATIO]
    if v < wanted:
        return min(v + S[PATH_AC_STEP], wanted)
    return max(v - S[PATH_DC_STEP], wanted)


def advance_along(S: State) -> None:
    """One sample of the profile along the path."""
    v = path_speed(S)
    way = (S[PATH_TOTAL] - S[PATH_TRAVELLED]) * SAMPLES
    over = S[PATH_STOP_CODE] != 0.0 and v == 0.0
    if S[PATH_ENDED] != 0.0 and way > SNAP:
        v = min(v, speed_to_stop_in(way, S[PATH_DC_STEP]))
    if way - v <= SNAP:
        over = True  # without LE or VE the sequence ends here at whatever speed it has
        S[PATH_TRAVELLED] = S[PATH_TOTAL]
    else:
        S[PATH_TRAVELLED] += v / SAMPLES
    S[PATH_AT_SPEED] = 1.0 if v == S[PATH_SPEED_V] * S[PATH_RATIO] else 0.0
    S[PATH_V] = v
    if over:
        S[PATH_ACTIVE] = 0.0
        S[PATH_V] = 0.0
        S[PATH_AT_SPEED] = 0.0


def coordinate(S: State, g: int, axis: int, way: float) -> float:
    """Where an axis of the path is, `way` counts behind the start of the segment at `g`."""
    start = S[g + G_START + axis]
    if S[g + G_ARC] == 0.0:
        return start + S[g + G_DIRECTION + axis] * way
    angle = S[g + G_DIRECTION + 2] + S[g + G_DIRECTION + 3] * way
    if axis == S[PATH_FIRST]:
        return start + S[g + G_DIRECTION] * sine(angle + 90.0)
    if axis == S[PATH_SECOND]:
        return start + S[g + G_DIRECTION + 1] * sine(angle)
    return start


def remember_point(S: State, axes: int, g: int) -> None:
    """The segment at `g` is finished: its end is what VP reads."""
    for axis in range(axes):
        A = part(S, axis)
        if A[PATH_MEMBER] == 1.0:
            A[PATH_POINT] = coordinate(S, g, axis, S[g + G_LENGTH])


def put_out(S: State, axes: int) -> None:
    """Commands every axis of the path to the smoothed point."""
    way = S[PATH_SMOOTHED]
    g = segment(S[PATH_OUT_HEAD])
    while S[PATH_OUT_HEAD] < S[PATH_TAIL] - 1.0 and way >= S[g + G_END]:
        remember_point(S, axes, g)
        S[PATH_OUT_HEAD] += 1.0
        g = segment(S[PATH_OUT_HEAD])
    way -= S[g + G_END] - S[g + G_LENGTH]
    for axis in range(axes):
        A = part(S, axis)
        before = A[POSITION]
        if A[PATH_MEMBER] == 1.0:
            A[POSITION] = A[PATH_ORIGIN] + coordinate(S, g, axis, way)
        elif A[PATH_MEMBER] == 2.0:
            A[POSITION] = S[g + G_TANGENT] + S[g + G_TANGENT_SLOPE] * way
        else:
            continue
        A[VELOCITY_V] = (A[POSITION] - before) * SAMPLES


def end_path(S: State) -> None:
    """The sequence is over; its segments are done with."""
    S[PATH_ACTIVE] = 0.0
    S[PATH_MOVING] = 0.0
    S[PATH_FINISHED] = 1.0


def complete(S: State, axes: int) -> None:
    """The sequence has ended; at its very end the axes stand exactly on the last point."""
    arrived = S[PATH_SMOOTHED] == S[PATH_TOTAL]
    if arrived:
        remember_point(S, axes, segment(S[PATH_OUT_HEAD]))
    for axis in range(axes):
        A = part(S, axis)
        if A[PATH_MEMBER] == 0.0:
            continue
        if arrived and A[PATH_MEMBER] == 1.0:
            A[POSITION] = A[PATH_ORIGIN] + A[PATH_END]
        A[POSITION] = float(floor(A[POSITION] + 0.5))
        finish(A)
        A[STOP_CODE] = S[PATH_STOP_CODE] if S[PATH_STOP_CODE] != 0.0 else 101.0
        A[PATH_MEMBER] = 0.0
    end_path(S)


def check_members(S: State, axes: int) -> None:
    """An axis that was frozen, or hit a limit, takes the whole path to a stop; without any axis it is over."""
    left = 0
    for axis in range(axes):
        A = part(S, axis)
        if A[PATH_MEMBER] != 0.0 and A[MODE] != MODE_PATH:
            A[PATH_MEMBER] = 0.0
            if S[PATH_STOP_CODE] == 0.0:
                S[PATH_STOP_CODE] = A[STOP_CODE]
        if A[PATH_MEMBER] == 1.0:
            left += 1
    if left == 0:
        end_path(S)


def advance_path(S: State, axes: int) -> None:
    """One sample of the sequence."""
    check_members(S, axes)
    if S[PATH_MOVING] == 0.0:
        return
    if S[PATH_ACTIVE] != 0.0:
        enter_segments(S)
        advance_along(S)
    lag = S[PATH_TRAVELLED] - S[PATH_SMOOTHED]
    S[PATH_SMOOTHED] += S[PATH_SMOOTHING] * lag
    ending = S[PATH_ACTIVE] == 0.0
    if S[PATH_SMOOTHING] >= 1.0 or (ending and S[PATH_TRAVELLED] - S[PATH_SMOOTHED] < 0.5):
        S[PATH_SMOOTHED] = S[PATH_TRAVELLED]
    put_out(S, axes)
    if ending and S[PATH_SMOOTHED] == S[PATH_TRAVELLED]:
        complete(S, axes)
