"""What the host may set on an axis, with its power-up value and how it reaches the sample loop."""

from __future__ import annotations

from collections.abc import Callable
from enum import IntEnum

from device.simulator.kernel import layout
from device.simulator.kernel.layout import State


class Register(IntEnum):
    """Registers of an axis; the value is the slot it is read back from."""

    SPEED = layout.SPEED_V
    ACCELERATION = layout.AC_A
    DECELERATION = layout.DC_A
    JOG_SPEED = layout.JOG_V
    SMOOTHING = layout.SMOOTHING
    STEP_SMOOTHING = layout.STEP_SMOOTHING
    KP = layout.KP
    KI = layout.KI
    KD = layout.KD
    INTEGRATOR_LIMIT = layout.INTEGRATOR_LIMIT
    TORQUE_LIMIT = layout.TORQUE_LIMIT
    OFFSET = layout.OFFSET
    VELOCITY_FEED = layout.VELOCITY_FEED
    ACCELERATION_FEED = layout.ACCELERATION_FEED
    ERROR_LIMIT = layout.ERROR_LIMIT
    OFF_ON_ERROR = layout.OFF_ON_ERROR
    FORWARD_LIMIT = layout.FORWARD_SOFT
    REVERSE_LIMIT = layout.REVERSE_SOFT
    MOTOR_TYPE = layout.MOTOR_TYPE
    ENCODER = layout.ENCODER
    DUAL_LOOP = layout.DUAL_LOOP
    ANALOG_FEEDBACK = layout.ANALOG_FEEDBACK
    GEAR_RATIO = layout.GEAR_RATIO
    HOME_SPEED = layout.HOME_V
    HOME_RAMPED = layout.HOME_RAMPED
    REFERENCE_BIAS = layout.REFERENCE_BIAS
    SETTLES_AT_ONCE = layout.SETTLES_AT_ONCE
    READ_LATE = layout.READ_LATE


DEFAULTS: dict[Register, float] = {
    Register.SPEED: 25000.0,
    Register.ACCELERATION: 256000.0,
    Register.DECELERATION: 256000.0,
    Register.JOG_SPEED: 25000.0,
    Register.SMOOTHING: 1.0,
    Register.STEP_SMOOTHING: 2.0,
    Register.KP: 6.0,
    Register.KI: 0.0,
    Register.KD: 64.0,
    Register.INTEGRATOR_LIMIT: 9.9982,
    Register.TORQUE_LIMIT: 9.9982,
    Register.OFFSET: 0.0,
    Register.VELOCITY_FEED: 0.0,
    Register.ACCELERATION_FEED: 0.0,
    Register.ERROR_LIMIT: 16384.0,
    Register.OFF_ON_ERROR: 0.0,
    Register.FORWARD_LIMIT: 2147483647.0,
    Register.REVERSE_LIMIT: -2147483648.0,
    Register.MOTOR_TYPE: 1.0,
    Register.ENCODER: 0.0,
    Register.DUAL_LOOP: 0.0,
    Register.ANALOG_FEEDBACK: 0.0,
    Register.GEAR_RATIO: 0.0,
    Register.HOME_SPEED: 0.0,
    Register.HOME_RAMPED: 0.0,
    Register.REFERENCE_BIAS: 0.5,
    Register.SETTLES_AT_ONCE: 0.0,
    Register.READ_LATE: 0.0,
}


def set_acceleration(state: State, b: int, value: float) -> None:
    """AC in counts/s²; a sample adds AC/1024 counts/s."""
    state[b + layout.AC_STEP] = value / layout.SAMPLES_PER_SECOND


def set_deceleration(state: State, b: int, value: float) -> None:
    """DC in counts/s²."""
    step = value / layout.SAMPLES_PER_SECOND
    state[b + layout.DC_STEP] = step
    state[b + layout.DC_HALF_INVERSE] = 0.5 / step


def set_step_smoothing(state: State, b: int, value: float) -> None:
    """KS: a single pole of about 3 KS samples behind the profile (commands.md 1)."""
    state[b + layout.STEP_FILTER] = 1.0 / max(1.0, 3.0 * value)


def set_motor_type(state: State, b: int, value: float) -> None:
    """MT: servo ±1, stepper ±2 (pulse level) and ±2.5 (direction reversed)."""
    stepper = abs(value) >= 2.0
    reverse = abs(value) == 2.5 if stepper else value < 0.0
    sign = -1.0 if reverse else 1.0
    state[b + layout.OUTPUT_SIGN] = sign
    state[b + layout.STEPPER] = 1.0 if stepper else 0.0
    if stepper:
        reference = state[b + layout.REFERENCE]
        state[b + layout.STEPS] = state[b + layout.STEPS_SMOOTH] = reference
        state[b + layout.STEPS_SHIFT] = reference - state[b + layout.MOTOR_X] * sign
        state[b + layout.INTEGRAL] = state[b + layout.ERROR] = state[b + layout.ERROR_HIGH] = 0.0


def set_encoder(state: State, b: int, value: float) -> None:
    """CE: 2 and 3 reverse the main encoder, 8 and 12 the auxiliary one; the positions stay what they are."""
    code = int(value)
    main, auxiliary = (-1.0 if code & 2 else 1.0), (-1.0 if code & 8 else 1.0)
    if main != state[b + layout.ENCODER_SIGN]:
        counts = state[b + layout.COUNTS]
        for slot in range(layout.HISTORY, layout.HISTORY + layout.HISTORY_LENGTH):
            state[b + slot] = -state[b + slot]
        state[b + layout.COUNTS], state[b + layout.COUNTS_BEFORE] = -counts, -state[b + layout.COUNTS_BEFORE]
        state[b + layout.MOVED] = -state[b + layout.MOVED]
        state[b + layout.COUNTS_SHIFT] += 2.0 * counts
        state[b + layout.ENCODER_SIGN] = main
    if auxiliary != state[b + layout.AUXILIARY_SIGN]:
        counts = state[b + layout.AUXILIARY_COUNTS]
        state[b + layout.AUXILIARY_COUNTS] = -counts
        state[b + layout.AUXILIARY_SHIFT] += 2.0 * counts
        state[b + layout.AUXILIARY_SIGN] = auxiliary


def set_analog_feedback(state: State, b: int, value: float) -> None:
    """AF: the position is the converter's own count (±2048 for ±10 V)."""
    if value:
        state[b + layout.COUNTS_SHIFT] = 0.0


def set_gear_ratio(state: State, b: int, value: float) -> None:
    """GR: the slave follows from the master's place of now."""
    master = int(state[b + layout.GEAR_MASTER])
    if master >= 0:
        state[b + layout.GEAR_LAST] = state[master]


EFFECTS: dict[Register, Callable[[State, int, float], None]] = {
    Register.ACCELERATION: set_acceleration,
    Register.DECELERATION: set_deceleration,
    Register.STEP_SMOOTHING: set_step_smoothing,
    Register.MOTOR_TYPE: set_motor_type,
    Register.ENCODER: set_encoder,
    Register.ANALOG_FEEDBACK: set_analog_feedback,
    Register.GEAR_RATIO: set_gear_ratio,
}


def write_register(state: State, b: int, register: Register, value: float) -> None:
    """Sets a register of the axis at `b` and whatever is derived from it."""
    state[b + register] = value
    effect = EFFECTS.get(register)
    if effect is not None:
        effect(state, b, value)


def write_defaults(state: State, b: int) -> None:
    """An axis as at power-up with factory parameters, motor on, standing at 0."""
    for slot in (layout.ENCODER_SIGN, layout.AUXILIARY_SIGN, layout.OUTPUT_SIGN, layout.MOTOR_ON, layout.IN_POSITION):
        state[b + slot] = 1.0
    for slot in (layout.FORWARD_FORCED, layout.REVERSE_FORCED, layout.HOME_FORCED):
        state[b + slot] = 1.0
    state[b + layout.GEAR_MASTER] = -1.0
    state[b + layout.STOP_CODE] = 1.0
    state[b + layout.DIRECTION] = 1.0
    for register, value in DEFAULTS.items():
        write_register(state, b, register, value)
