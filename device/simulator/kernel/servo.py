"""The servo filter: position error to motor command (commands.md 8, dmc-1412-1414.txt l.4436-4485)."""

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

VOLTS = 20.0 / 65536.0  # of one count of the converter (l.4427)
VELOCITY_VOLTS = 1.22e-6
ACCELERATION_VOLTS = 1.5e-7


def clamp(value: float, limit: float) -> float:
    """`value` kept within ±`limit`."""
    if value > limit:
        return limit
    if value < -limit:
        return -limit
    return value


def watch_error(S: State, b: int) -> None:
    """|TE| above ER is an event; with OE 1 it switches the axis off."""
    high = 1.0 if abs(S[b + ERROR]) > S[b + ERROR_LIMIT] else 0.0
    if high != 0.0:
        if S[b + ERROR_HIGH] == 0.0:
            raise_event(S, b, EVENT_ERROR)
        if S[b + OFF_ON_ERROR] != 0.0 and S[b + MOTOR_ON] != 0.0:
            freeze(S, b)
            S[b + MOTOR_ON] = 0.0
            S[b + STOP_CODE] = 8.0
            raise_event(S, b, EVENT_OFF)
    S[b + ERROR_HIGH] = high


def filter_error(S: State, b: int, error: float, derivative_error: float) -> float:
    """Volts of the filter with offset and feed-forwards, before the torque limit."""
    limit = S[b + INTEGRATOR_LIMIT]
    integral = S[b + INTEGRAL]
    if limit >= 0.0 or S[b + MOVING] == 0.0:
        integral = clamp(integral + 0.5 * S[b + KI] * error * VOLTS, abs(limit))
        S[b + INTEGRAL] = integral
    volts = (4.0 * S[b + KP] * error + 4.0 * S[b + KD] * (derivative_error - S[b + LAST_ERROR])) * VOLTS + integral
    velocity = S[b + COMMANDED_V]
    volts += S[b + OFFSET] + VELOCITY_VOLTS * S[b + VELOCITY_FEED] * velocity
    acceleration = (velocity - S[b + COMMANDED_LAST_V]) * 1024.0
    return volts + ACCELERATION_VOLTS * S[b + ACCELERATION_FEED] * acceleration


def step_output(S: State, b: int) -> None:
    """The stepper's pulse output: RP behind the KS filter; pulses cost no volts."""
    lag = S[b + SMOOTHED] - S[b + STEPS_SMOOTH]
    S[b + STEPS_SMOOTH] += S[b + STEP_FILTER] * lag
    if abs(S[b + SMOOTHED] - S[b + STEPS_SMOOTH]) < 0.5 and S[b + MOVING] == 0.0:
        S[b + STEPS_SMOOTH] = S[b + SMOOTHED]
    S[b + STEPS] = float(floor(S[b + STEPS_SMOOTH] + 0.5))
    S[b + ERROR] = 0.0
    S[b + COMMAND] = 0.0


def servo(S: State, b: int) -> None:
    """One sample of the filter; its output acts in this sample."""
    if S[b + STEPPER] != 0.0:
        step_output(S, b)
        return
    error = S[b + REFERENCE] - S[b + ACTUAL]
    S[b + ERROR] = error
    watch_error(S, b)
    derivative_error = error
    if S[b + DUAL_LOOP] != 0.0:
        derivative_error = S[b + REFERENCE] - S[b + AUXILIARY]
    if S[b + MOTOR_ON] != 0.0:
        volts = filter_error(S, b, error, derivative_error)
    else:
        volts = S[b + OFFSET]
        S[b + INTEGRAL] = 0.0
    S[b + LAST_ERROR] = derivative_error
    S[b + COMMAND] = clamp(volts, S[b + TORQUE_LIMIT]) * S[b + OUTPUT_SIGN]
