"""Contour mode: records of a position increment in 2**n samples, one waiting behind the one that runs."""

from __future__ import annotations

from math import floor

from device.simulator.kernel.layout import (
    CONTOUR_ACTIVE,
    CONTOUR_BUFFERED,
    CONTOUR_LEFT,
    CONTOUR_LENGTH,
    CONTOUR_NEXT,
    CONTOUR_STEP,
    IN_CONTOUR,
    MODE,
    MODE_CONTOUR,
    MOVING,
    POSITION,
    STOP_CODE,
    State,
    part,
)
from device.simulator.kernel.profile import end_of_ramp


def take_record(S: State, A: State) -> None:
    """The waiting record becomes the running one; an empty one ends the mode."""
    if S[CONTOUR_LENGTH] > 0.0:
        A[CONTOUR_STEP] = A[CONTOUR_NEXT] / S[CONTOUR_LENGTH]
        A[MODE] = MODE_CONTOUR
        A[STOP_CODE] = 50.0
    else:
        A[CONTOUR_STEP] = 0.0
        A[IN_CONTOUR] = 0.0
        A[POSITION] = float(floor(A[POSITION] + 0.5))
        end_of_ramp(A)
        A[STOP_CODE] = 51.0


def advance_contour(S: State, axes: int) -> None:
    """One sample of contour mode; without a record the axes wait where they are."""
    members = 0
    for axis in range(axes):
        A = part(S, axis)
        if A[IN_CONTOUR] != 0.0:
            members += 1
    fresh = S[CONTOUR_LEFT] == 0.0
    for axis in range(axes):
        A = part(S, axis)
        if fresh and A[IN_CONTOUR] != 0.0:
            if S[CONTOUR_BUFFERED] != 0.0:
                take_record(S, A)
            else:
                A[CONTOUR_STEP] = 0.0
    if fresh and S[CONTOUR_BUFFERED] != 0.0:
        S[CONTOUR_BUFFERED] = 0.0
        S[CONTOUR_LEFT] = S[CONTOUR_LENGTH]
        if S[CONTOUR_LENGTH] == 0.0:
            members = 0
    if S[CONTOUR_LEFT] > 0.0:
        S[CONTOUR_LEFT] -= 1.0
    if members == 0:
        S[CONTOUR_ACTIVE] = 0.0
        S[CONTOUR_BUFFERED] = 0.0
        S[CONTOUR_LEFT] = 0.0


def leave_contour(A: State) -> None:
    """Takes the axis out of contour mode: stop, limit, abort."""
    A[IN_CONTOUR] = 0.0
    A[CONTOUR_STEP] = 0.0


def waits_for_contour(A: State) -> bool:
    """In the mode and started, whether or not a record runs."""
    return A[IN_CONTOUR] != 0.0 and A[MOVING] != 0.0
