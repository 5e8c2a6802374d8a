"""The machine behind the motor command: amplifier, motor, friction, coupling, load (dmc-1412-1414.txt l.4338-4445).

The coefficients are worked out in `device.simulator.mechanics`, so that nothing here needs a transcendental function.
"""

from __future__ import annotations

from math import floor

from device.simulator.kernel.commutation import commutated
from device.simulator.kernel.layout import (
    BACK_V,
    COAST_DECAY,
    COAST_V,
    COAST_X,
    COMMAND,
    COUPLING_A,
    COUPLING_DAMPING_A,
    CURRENT,
    CURRENT_A,
    DECAY,
    DELAY,
    DELAY_INDEX,
    DELAY_RING,
    DISTURBANCE,
    DRIVE,
    DRIVE_STEPPER,
    DRIVE_VOLTAGE,
    ENABLING,
    FRICTION_A,
    GAIN_A,
    GAIN_V,
    GAIN_X,
    GENERAL,
    GRAVITY,
    HALF_BACKLASH,
    LOAD_GAIN_A,
    LOAD_V,
    LOAD_X,
    MATRICES,
    MATRIX_LENGTH,
    MOTOR_ON,
    MOTOR_V,
    MOTOR_X,
    OUTPUT_SIGN,
    OUTSIDE_V,
    OUTSIDE_X,
    PEAK_CURRENT,
    PEAK_VOLTS,
    PERIOD_T,
    PHASE_MODE,
    REGIME_APART,
    REGIME_OFF,
    REGIME_STUCK,
    RIPPLE,
    RIPPLE_SCALE,
    SINE,
    SINE_LENGTH,
    STEPPER,
    STEPS,
    STEPS_SHIFT,
    SUBSTEPS,
    WIRING,
    State,
)
from device.simulator.kernel.servo import clamp


def delayed(A: State, volts: float) -> float:
    """The command of `delay_samples` ago."""
    length = int(A[DELAY])
    if length == 0:
        return volts
    place = int(A[DELAY_INDEX])
    old = A[DELAY_RING + place]
    A[DELAY_RING + place] = volts
    place += 1
    A[DELAY_INDEX] = 0.0 if place == length else float(place)
    return old


def rippled(S: State, A: State, volts: float) -> float:
    """The command scaled by the torque ripple at this angle."""
    place = A[MOTOR_X] * A[RIPPLE_SCALE]
    turns = floor(place / SINE_LENGTH)
    place -= turns * float(SINE_LENGTH)
    entry = int(place)
    part = place - entry
    sine = S[SINE + entry] + part * (S[SINE + entry + 1] - S[SINE + entry])
    return volts * (1.0 + A[RIPPLE] * sine)


def amplifier(S: State, A: State) -> float:
    """Volts of command that reach the current loop: delayed, limited to the peak current, with ripple."""
    volts = delayed(A, A[COMMAND]) * A[WIRING]
    if A[PHASE_MODE] != 0.0:
        volts = commutated(A, volts)
    if A[DRIVE] != DRIVE_VOLTAGE:
        back = A[BACK_V] * A[MOTOR_V]
        volts = clamp(volts - back, A[PEAK_VOLTS]) + back
    if A[RIPPLE] != 0.0:
        volts = rippled(S, A, volts)
    return volts


def has_power(A: State) -> bool:
    """The amplifier drives the motor."""
    return A[ENABLING] == 2.0 or (A[ENABLING] == 1.0 and A[MOTOR_ON] != 0.0)


def rub(S: State, A: State, a: float, decay: float, gain_v: float, gain_x: float) -> None:
    """One sample of a single mass under the constant acceleration `a` and Coulomb friction."""
    v = A[MOTOR_V]
    friction = A[FRICTION_A]
    if v == 0.0:
        if abs(a) <= friction:
            return
        pushed = a - friction if a > 0.0 else a + friction
        A[MOTOR_X] += gain_x * pushed
        A[MOTOR_V] = gain_v * pushed
        return
    pushed = a - friction if v > 0.0 else a + friction
    after = decay * v + gain_v * pushed
    if after * v >= 0.0:
        A[MOTOR_X] += gain_v * v + gain_x * pushed
        A[MOTOR_V] = after
        return
    period = S[PERIOD_T]
    until = period * v / (v - after)
    x = 0.5 * v * until
    rest = period - until
    v = 0.0
    if abs(a) > friction:
        pushed = a - friction if a > 0.0 else a + friction
        v = pushed * rest
        x += 0.5 * pushed * rest * rest
    A[MOTOR_X] += x
    A[MOTOR_V] = v


def simple(S: State, A: State, volts: float) -> None:
    """A rigid machine: position and velocity, exact for a command held through the sample."""
    volts_outside = A[DISTURBANCE] - A[GRAVITY]
    if has_power(A):
        a = A[GAIN_A] * (volts + volts_outside)
        decay = A[DECAY]
        gain_v = A[GAIN_V]
        gain_x = A[GAIN_X]
    else:
        a = A[GAIN_A] * volts_outside
        decay = A[COAST_DECAY]
        gain_v = A[COAST_V]
        gain_x = A[COAST_X]
    if A[FRICTION_A] > 0.0:
        rub(S, A, a, decay, gain_v, gain_x)
    else:
        v = A[MOTOR_V]
        A[MOTOR_X] += gain_v * v + gain_x * a
        A[MOTOR_V] = decay * v + gain_v * a
    drag_load(A)


def drag_load(A: State) -> None:
    """A load without inertia of its own: moves with the motor once the play is used up."""
    half = A[HALF_BACKLASH]
    x = A[MOTOR_X]
    A[LOAD_V] = A[MOTOR_V]
    if half > 0.0:
        twist = x - A[LOAD_X]
        if twist > half:
            x -= half
        elif twist < -half:
            x += half
        else:
            x = A[LOAD_X]
            A[LOAD_V] = 0.0
    A[LOAD_X] = x


def row(A: State, m: int, w: float, i: float, l: float, t: float, u: float, am: float, al: float) -> float:  # noqa: E741
    """One row of a regime's matrix times (motor v, current, load v, twist, volts, two accelerations)."""
    return A[m] * w + A[m + 1] * i + A[m + 2] * l + A[m + 3] * t + A[m + 4] * u + A[m + 5] * am + A[m + 6] * al


def general_substep(A: State, volts: float, powered: bool, outside: float) -> None:
    """One exact step of the linear regime that holds at its start."""
    half = A[HALF_BACKLASH]
    twist = A[MOTOR_X] - A[LOAD_X]
    regime = 0 if powered else REGIME_OFF
    if A[LOAD_GAIN_A] == 0.0:
        twist = 0.0
    elif abs(twist) <= half and half > 0.0:
        regime |= REGIME_APART
        twist = 0.0
    elif twist > 0.0:
        twist -= half
    else:
        twist += half
    w = A[MOTOR_V]
    i = A[CURRENT]
    l = A[LOAD_V]  # noqa: E741
    friction = A[FRICTION_A]
    motor_a = 0.0
    if A[LOAD_GAIN_A] == 0.0:
        motor_a = A[GAIN_A] * outside
    load_a = A[LOAD_GAIN_A] * outside
    if friction > 0.0:
        if w == 0.0:
            pull = motor_a + A[CURRENT_A] * i
            if powered and A[DRIVE] != DRIVE_VOLTAGE:
                pull += A[GAIN_A] * volts
            if regime & REGIME_APART == 0:
                pull += A[COUPLING_DAMPING_A] * l - A[COUPLING_A] * twist
            if abs(pull) <= friction:
                regime |= REGIME_STUCK
            else:
                motor_a += -friction if pull > 0.0 else friction
        else:
            motor_a += -friction if w > 0.0 else friction
    m = MATRICES + MATRIX_LENGTH * regime
    after = row(A, m, w, i, l, twist, volts, motor_a, load_a)
    A[CURRENT] = clamp(row(A, m + 7, w, i, l, twist, volts, motor_a, load_a), A[PEAK_CURRENT])
    A[LOAD_V] = row(A, m + 14, w, i, l, twist, volts, motor_a, load_a)
    A[MOTOR_X] += row(A, m + 21, w, i, l, twist, volts, motor_a, load_a)
    A[LOAD_X] += row(A, m + 28, w, i, l, twist, volts, motor_a, load_a)
    A[MOTOR_V] = 0.0 if friction > 0.0 and after * w < 0.0 else after


def general(A: State, volts: float) -> None:
    """A machine with an electrical time constant or with its load behind a coupling."""
    outside = A[DISTURBANCE] - A[GRAVITY]
    powered = has_power(A)
    for _ in range(int(A[SUBSTEPS])):
        general_substep(A, volts, powered, outside)
    if A[LOAD_GAIN_A] == 0.0:
        drag_load(A)


def advance_plant(S: State, A: State) -> None:
    """Moves the machine through the time to the next sample."""
    if A[DRIVE] == DRIVE_STEPPER:
        if A[STEPPER] != 0.0:
            x = (A[STEPS] - A[STEPS_SHIFT]) * A[OUTPUT_SIGN]
            A[MOTOR_V] = (x - A[MOTOR_X]) / S[PERIOD_T]
            A[MOTOR_X] = x
            A[LOAD_X] = x
            A[LOAD_V] = A[MOTOR_V]
    elif A[GENERAL] != 0.0:
        general(A, amplifier(S, A))
    else:
        simple(S, A, amplifier(S, A))
    if A[OUTSIDE_V] != 0.0:
        A[OUTSIDE_X] += A[OUTSIDE_V] * S[PERIOD_T]
