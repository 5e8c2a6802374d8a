"""The sample loop: all axes, one sample after another, until something happens.

Within a sample the order is fixed: inputs → profile → servo → plant → trippoints. One sample of all axes is one stage
after the other, so that an axis that follows another one sees this sample's master.
"""

from __future__ import annotations

from device.simulator.kernel.events import measure, test_watches
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
    AXIS,
    COMMAND,
    ENCODER_SIGN,
    EVENTS,
    GEAR_MASTER,
    INPUTS,
    LOAD_V,
    MAIN_ON_LOAD,
    MOTOR_V,
    OUTPUTS,
    REFERENCE,
    SAMPLE,
    STAGE,
    STRIDE,
    TRACE_CAPACITY,
    TRACE_COUNTDOWN,
    TRACE_EVERY,
    TRACE_ROWS,
    TRIPS,
    State,
)
from device.simulator.kernel.plant import advance_plant
from device.simulator.kernel.profile import advance_profile, follow_gear, smooth
from device.simulator.kernel.servo import servo


def write_trace(S: State, trace: State, axes: int) -> None:
    """Adds a row: sample, then commanded, actual, velocity and volts of each axis, then inputs and outputs."""
    place = int(S[TRACE_ROWS]) * (3 + 4 * axes)
    trace[place] = S[SAMPLE]
    place += 1
    b = AXIS
    for _ in range(axes):
        trace[place] = S[b + REFERENCE]
        trace[place + 1] = S[b + ACTUAL]
        trace[place + 2] = (S[b + LOAD_V] if S[b + MAIN_ON_LOAD] != 0.0 else S[b + MOTOR_V]) * S[b + ENCODER_SIGN]
        trace[place + 3] = S[b + COMMAND]
        place += 4
        b += STRIDE
    trace[place] = S[INPUTS]
    trace[place + 1] = S[OUTPUTS]
    S[TRACE_ROWS] += 1.0


def profiles(S: State, axes: int) -> None:
    """The profile stage of all axes."""
    b = AXIS
    for _ in range(axes):
        check_limits(S, b)
        if S[b + STAGE] != 0.0:
            advance_stage(S, b)
        advance_profile(S, b)
        b += STRIDE
    b = AXIS
    for _ in range(axes):
        before = S[b + REFERENCE]
        if S[b + GEAR_MASTER] >= 0.0:
            follow_gear(S, b)
        smooth(S, b)
        check_gear_limits(S, b, before)
        b += STRIDE


def sample(S: State, axes: int, moment: int) -> None:
    """One sample of everything but the trippoints."""
    b = AXIS
    for axis in range(axes):
        read_encoders(S, b, axis, moment)
        read_switches(S, b)
        b += STRIDE
    check_abort(S, axes)
    profiles(S, axes)
    b = AXIS
    for _ in range(axes):
        servo(S, b)
        advance_plant(S, b)
        b += STRIDE


def run(S: State, trace: State, n: int) -> int:
    """Runs up to `n` samples and ends after the one in which a watch trips, an event is raised or the trace is full."""
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
        b = AXIS
        for _ in range(axes):
            measure(S, b)
            b += STRIDE
        test_watches(S)
        if S[TRACE_CAPACITY] > 0.0:
            S[TRACE_COUNTDOWN] -= 1.0
            if S[TRACE_COUNTDOWN] <= 0.0:
                S[TRACE_COUNTDOWN] = S[TRACE_EVERY]
                write_trace(S, trace, axes)
                if S[TRACE_ROWS] >= S[TRACE_CAPACITY]:
                    break
        if S[TRIPS] > 0.0 or S[EVENTS] != events:
            break
    return done
