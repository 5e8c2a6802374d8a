"""The sample loop: all axes, one sample after another, until something happens.

Within a sample the order is fixed: inputs → profile → servo → plant → trippoints. One sample of all axes is one stage
after the other, so that an axis that follows another one sees this sample's master.
"""

from __future__ import annotations

from device.simulator.kernel.cam import advance_cam
from device.simulator.kernel.commutation import read_halls
from device.simulator.kernel.contour import advance_contour
from device.simulator.kernel.events import measure, test_guards, test_watches
from device.simulator.kernel.homing import advance_stage
from device.simulator.kernel.inputs import (
    check_abort,
    check_gear_limits,
    check_limits,
    read_encoders,
    read_switches,
)
from device.simulator.kernel.layout import (
    ACTUAL,
    AXES,
    CAM_ON,
    COMMAND,
    CONTOUR_ACTIVE,
    ENCODER_SIGN,
    EVENTS,
    GEAR_MASTER,
    GUARD_BROKEN,
    GUARDS,
    HALL_FIRST,
    INPUTS,
    LOAD_V,
    MAIN_ON_LOAD,
    MOTOR_V,
    OUTPUTS,
    PATH_MOVING,
    PHASE_HALLS,
    POSITION,
    POSITION_SHIFT,
    REFERENCE,
    SAMPLE,
    STAGE,
    TRACE_CAPACITY,
    TRACE_COUNTDOWN,
    TRACE_EVERY,
    TRACE_ROWS,
    TRAVEL,
    TRIPS,
    State,
    part,
    slots,
)
from device.simulator.kernel.path import advance_path
from device.simulator.kernel.plant import advance_plant
from device.simulator.kernel.profile import advance_profile, follow_gear, smooth
from device.simulator.kernel.servo import servo


def write_trace(S: State, trace: State, axes: int) -> None:
    """Adds a row: sample, then commanded, actual, velocity and volts of each axis, then inputs and outputs."""
    place = int(S[TRACE_ROWS]) * (3 + 4 * axes)
    trace[place] = S[SAMPLE]
    place += 1
    for axis in range(axes):
        A = part(S, axis)
        trace[place] = A[REFERENCE]
        trace[place + 1] = A[ACTUAL]
        trace[place + 2] = (A[LOAD_V] if A[MAIN_ON_LOAD] != 0.0 else A[MOTOR_V]) * A[ENCODER_SIGN]
        trace[place + 3] = A[COMMAND]
        place += 4
    trace[place] = S[INPUTS]
    trace[place + 1] = S[OUTPUTS]
    S[TRACE_ROWS] += 1.0


def profiles(S: State, axes: int) -> None:
    """The profile stage of all axes."""
    if S[CONTOUR_ACTIVE] != 0.0:
        advance_contour(S, axes)
    for axis in range(axes):
        A = part(S, axis)
        check_limits(S, A)
        if A[STAGE] != 0.0:
            advance_stage(S, A)
        advance_profile(A)
    if S[PATH_MOVING] != 0.0:
        advance_path(S, axes)
    if S[CAM_ON] != 0.0:
        advance_cam(S, axes)
    for axis in range(axes):
        A = part(S, axis)
        A[TRAVEL] = A[POSITION] - A[POSITION_SHIFT]
    for axis in range(axes):
        A = part(S, axis)
        before = A[REFERENCE]
        if A[GEAR_MASTER] >= 0.0:
            follow_gear(S, A)
        smooth(A)
        check_gear_limits(S, A, before)


def sample(S: State, axes: int, moment: int) -> None:
    """One sample of everything but the trippoints."""
    for axis in range(axes):
        A = part(S, axis)
        read_encoders(S, A, axis, moment)
        read_switches(A)
        if A[HALL_FIRST] > 0.0 or A[PHASE_HALLS] > 0.0:
            read_halls(S, A)
    check_abort(S, axes)
    profiles(S, axes)
    for axis in range(axes):
        A = part(S, axis)
        servo(S, A)
        advance_plant(S, A)


def run(S: State, trace: State, n: int) -> int:
    """`advance` over the whole of both arrays."""
    return advance(slots(S, 0, len(S)), slots(trace, 0, len(trace)), n)


def advance(S: State, trace: State, n: int) -> int:
    """Runs up to `n` samples; ends after one that trips a watch, breaks a guard, raises an event, fills the trace."""
    axes = int(S[AXES])
    count = int(S[SAMPLE])
    S[TRIPS] = 0.0
    done = 0
    events = S[EVENTS]
    while done < n:
        sample(S, axes, count & 255)
        count += 1
        done += 1
        S[SAMPLE] = float(count)
        for axis in range(axes):
            A = part(S, axis)
            measure(A)
        test_watches(S)
        if S[GUARDS] > 0.0:
            test_guards(S)
        if S[TRACE_ROWS] < S[TRACE_CAPACITY]:  # a full trace takes no more until it is cleared
            S[TRACE_COUNTDOWN] -= 1.0
            if S[TRACE_COUNTDOWN] <= 0.0:
                S[TRACE_COUNTDOWN] = S[TRACE_EVERY]
                write_trace(S, trace, axes)
                if S[TRACE_ROWS] >= S[TRACE_CAPACITY]:
                    break
        if S[TRIPS] > 0.0 or S[EVENTS] != events or S[GUARD_BROKEN] != 0.0:
            break
    return done
