"""The servo filter: position error to motor command (commands.md 8, dmc-1412-1414.txt l.4454-4476)."""

from __future__ import annotations

from math import floor

from device.simulator.kernel.inputs import raise_event
from device.simulator.kernel.layout import (
    ACCELERATION_FEED,
    ACTUAL,
    AUXILIARY,
    COMMAND,
    COMMANDED_LAST_V,
    COMMANDED_V,
    DUAL_LOOP,
    ERROR,
    ERROR_HIGH,
    ERROR_LIMIT,
    EVENT_ERROR,
    EVENT_OFF,
    INTEGRAL,
    INTEGRATOR_LIMIT,
    KD,
    KI,
    KP,
    LAST_ERROR,
    MOTOR_ON,
    MOVING,
    OFF_ON_ERROR,
    OFFSET,
    OUTPUT_SIGN,
    PHASE_MODE,
    PHASE_VOLTS,
    REFERENCE,
    SMOOTHED,
    STEP_FILTER,
    STEPPER,
    STEPS,
    STEPS_SMOOTH,
    STOP_CODE,
    TORQUE_LIMIT,
    VELOCITY_FEED,
    State,
)
from device.simulator.kernel.profile import freeze

VOLTS = 20.0 / 65536.0  # of one count of the converter (l.4451)
VELOCITY_VOLTS = 1.22e-6
ACCELERATION_VOLTS = 1.5e-7


def clamp(value: float, limit: float) -> float:
    """`value` kept within ±`limit`."""
    if value > limit:
        return limit
    if value < -limit:
        return -limit
    return value


def watch_error(S: State, A: State) -> None:
    """|TE| above ER is an event; with OE 1 it switches the axis off."""
    high = 1.0 if abs(A[ERROR]) > A[ERROR_LIMIT] else 0.0
    if high != 0.0:
        if A[ERROR_HIGH] == 0.0:
            raise_event(S, A, EVENT_ERROR)
        if A[OFF_ON_ERROR] != 0.0 and A[MOTOR_ON] != 0.0:
            freeze(A)
            A[MOTOR_ON] = 0.0
            A[STOP_CODE] = 8.0
            raise_event(S, A, EVENT_OFF)
    A[ERROR_HIGH] = high


def filter_error(A: State, error: float, derivative_error: float) -> float:
    """Volts of the filter with offset and feed-forwards, before the torque limit."""
    limit = A[INTEGRATOR_LIMIT]
    integral = A[INTEGRAL]
    if limit >= 0.0 or A[MOVING] == 0.0:
        integral = clamp(integral + 0.5 * A[KI] * error * VOLTS, abs(limit))
        A[INTEGRAL] = integral
    volts = (4.0 * A[KP] * error + 4.0 * A[KD] * (derivative_error - A[LAST_ERROR])) * VOLTS + integral
    velocity = A[COMMANDED_V]
    volts += A[OFFSET] + VELOCITY_VOLTS * A[VELOCITY_FEED] * velocity
    acceleration = (velocity - A[COMMANDED_LAST_V]) * 1024.0
    return volts + ACCELERATION_VOLTS * A[ACCELERATION_FEED] * acceleration


def step_output(A: State) -> None:
    """The stepper's pulse output: RP behind the KS filter; pulses cost no volts."""
    lag = A[SMOOTHED] - A[STEPS_SMOOTH]
    A[STEPS_SMOOTH] += A[STEP_FILTER] * lag
    if abs(A[SMOOTHED] - A[STEPS_SMOOTH]) < 0.5 and A[MOVING] == 0.0:
        A[STEPS_SMOOTH] = A[SMOOTHED]
    A[STEPS] = float(floor(A[STEPS_SMOOTH] + 0.5))
    A[ERROR] = 0.0
    A[COMMAND] = 0.0


def servo(S: State, A: State) -> None:
    """One sample of the filter; its output acts in this sample."""
    if A[STEPPER] != 0.0:
        step_output(A)
        return
    error = A[REFERENCE] - A[ACTUAL]
    A[ERROR] = error
    if A[PHASE_MODE] == 2.0:
        A[COMMAND] = A[PHASE_VOLTS]
        return
    watch_error(S, A)
    derivative_error = error
    if A[DUAL_LOOP] != 0.0:
        derivative_error = A[REFERENCE] - A[AUXILIARY]
    if A[MOTOR_ON] != 0.0:
        volts = filter_error(A, error, derivative_error)
    else:
        volts = A[OFFSET]
        A[INTEGRAL] = 0.0
    A[LAST_ERROR] = derivative_error
    A[COMMAND] = clamp(volts, A[TORQUE_LIMIT]) * A[OUTPUT_SIGN]
