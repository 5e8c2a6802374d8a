"""The machine behind the motor command: amplifier, motor, friction, coupling, load (dmc-1412-1414.txt l.4336-4430).

The coefficients are worked out in `device.simulator.mechanics`, so that nothing here needs a transcendental function.
"""

from __future__ import annotations

from math import floor

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
    State,
)
from device.simulator.kernel.servo import clamp


def delayed(S: State, b: int, volts: float) -> float:
    """The command of `delay_samples` ago."""
    length = int(S[b + DELAY])
    if length == 0:
        return volts
    place = int(S[b + DELAY_INDEX])
    old = S[b + DELAY_RING + place]
    S[b + DELAY_RING + place] = volts
    place += 1
    S[b + DELAY_INDEX] = 0.0 if place == length else float(place)
    return old


def rippled(S: State, b: int, volts: float) -> float:
    """The command scaled by the torque ripple at this angle."""
    place = S[b + MOTOR_X] * S[b + RIPPLE_SCALE]
    turns = floor(place / SINE_LENGTH)
    place -= turns * float(SINE_LENGTH)
    entry = int(place)
    part = place - entry
    sine = S[SINE + entry] + part * (S[SINE + entry + 1] - S[SINE + entry])
    return volts * (1.0 + S[b + RIPPLE] * sine)


def amplifier(S: State, b: int) -> float:
    """Volts of command that reach the current loop: delayed, limited to the peak current, with ripple."""
    volts = delayed(S, b, S[b + COMMAND])
    if S[b + DRIVE] != DRIVE_VOLTAGE:
        back = S[b + BACK_V] * S[b + MOTOR_V]
        volts = clamp(volts - back, S[b + PEAK_VOLTS]) + back
    if S[b + RIPPLE] != 0.0:
        volts = rippled(S, b, volts)
    return volts


def rub(S: State, b: int, a: float, decay: float, gain_v: float, gain_x: float) -> None:
    """One sample of a single mass under the constant acceleration `a` and Coulomb friction."""
    v = S[b + MOTOR_V]
    friction = S[b + FRICTION_A]
    if v == 0.0:
        if abs(a) <= friction:
            return
        pushed = a - friction if a > 0.0 else a + friction
        S[b + MOTOR_X] += gain_x * pushed
        S[b + MOTOR_V] = gain_v * pushed
        return
    pushed = a - friction if v > 0.0 else a + friction
    after = decay * v + gain_v * pushed
    if after * v >= 0.0:
        S[b + MOTOR_X] += gain_v * v + gain_x * pushed
        S[b + MOTOR_V] = after
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
    S[b + MOTOR_X] += x
    S[b + MOTOR_V] = v


def simple(S: State, b: int, volts: float) -> None:
    """A rigid machine: position and velocity, exact for a command held through the sample."""
    volts_outside = S[b + DISTURBANCE] - S[b + GRAVITY]
    if S[b + MOTOR_ON] != 0.0:
        a = S[b + GAIN_A] * (volts + volts_outside)
        decay = S[b + DECAY]
        gain_v = S[b + GAIN_V]
        gain_x = S[b + GAIN_X]
    else:
        a = S[b + GAIN_A] * volts_outside
        decay = S[b + COAST_DECAY]
        gain_v = S[b + COAST_V]
        gain_x = S[b + COAST_X]
    if S[b + FRICTION_A] > 0.0:
        rub(S, b, a, decay, gain_v, gain_x)
    else:
        v = S[b + MOTOR_V]
        S[b + MOTOR_X] += gain_v * v + gain_x * a
        S[b + MOTOR_V] = decay * v + gain_v * a
    drag_load(S, b)


def drag_load(S: State, b: int) -> None:
    """A load without inertia of its own: moves with the motor once the play is used up."""
    half = S[b + HALF_BACKLASH]
    x = S[b + MOTOR_X]
    S[b + LOAD_V] = S[b + MOTOR_V]
    if half > 0.0:
        twist = x - S[b + LOAD_X]
        if twist > half:
            x -= half
        elif twist < -half:
            x += half
        else:
            x = S[b + LOAD_X]
            S[b + LOAD_V] = 0.0
    S[b + LOAD_X] = x


def row(S: State, m: int, w: float, i: float, l: float, t: float, u: float, am: float, al: float) -> float:  # noqa: E741
    """One row of a regime's matrix times (motor v, current, load v, twist, volts, two accelerations)."""
    return S[m] * w + S[m + 1] * i + S[m + 2] * l + S[m + 3] * t + S[m + 4] * u + S[m + 5] * am + S[m + 6] * al


def general_substep(S: State, b: int, volts: float, powered: bool, outside: float) -> None:
    """One exact step of the linear regime that holds at its start."""
    half = S[b + HALF_BACKLASH]
    twist = S[b + MOTOR_X] - S[b + LOAD_X]
    regime = 0 if powered else REGIME_OFF
    if S[b + LOAD_GAIN_A] == 0.0:
        twist = 0.0
    elif abs(twist) <= half and half > 0.0:
        regime |= REGIME_APART
        twist = 0.0
    elif twist > 0.0:
        twist -= half
    else:
        twist += half
    w = S[b + MOTOR_V]
    i = S[b + CURRENT]
    l = S[b + LOAD_V]  # noqa: E741
    friction = S[b + FRICTION_A]
    motor_a = 0.0
    if S[b + LOAD_GAIN_A] == 0.0:
        motor_a = S[b + GAIN_A] * outside
    load_a = S[b + LOAD_GAIN_A] * outside
    if friction > 0.0:
        if w == 0.0:
            pull = motor_a + S[b + CURRENT_A] * i
            if powered and S[b + DRIVE] != DRIVE_VOLTAGE:
                pull += S[b + GAIN_A] * volts
            if regime & REGIME_APART == 0:
                pull += S[b + COUPLING_DAMPING_A] * l - S[b + COUPLING_A] * twist
            if abs(pull) <= friction:
                regime |= REGIME_STUCK
            else:
                motor_a += -friction if pull > 0.0 else friction
        else:
            motor_a += -friction if w > 0.0 else friction
    m = b + MATRICES + MATRIX_LENGTH * regime
    after = row(S, m, w, i, l, twist, volts, motor_a, load_a)
    S[b + CURRENT] = clamp(row(S, m + 7, w, i, l, twist, volts, motor_a, load_a), S[b + PEAK_CURRENT])
    S[b + LOAD_V] = row(S, m + 14, w, i, l, twist, volts, motor_a, load_a)
    S[b + MOTOR_X] += row(S, m + 21, w, i, l, twist, volts, motor_a, load_a)
    S[b + LOAD_X] += row(S, m + 28, w, i, l, twist, volts, motor_a, load_a)
    S[b + MOTOR_V] = 0.0 if friction > 0.0 and after * w < 0.0 else after


def general(S: State, b: int, volts: float) -> None:
    """A machine with an electrical time constant or with its load behind a coupling."""
    outside = S[b + DISTURBANCE] - S[b + GRAVITY]
    powered = S[b + MOTOR_ON] != 0.0
    for _ in range(int(S[b + SUBSTEPS])):
        general_substep(S, b, volts, powered, outside)
    if S[b + LOAD_GAIN_A] == 0.0:
        drag_load(S, b)


def advance_plant(S: State, b: int) -> None:
    """Moves the machine through the time to the next sample."""
    if S[b + DRIVE] == DRIVE_STEPPER:
        if S[b + STEPPER] != 0.0:
            x = (S[b + STEPS] - S[b + STEPS_SHIFT]) * S[b + OUTPUT_SIGN]
            S[b + MOTOR_V] = (x - S[b + MOTOR_X]) / S[PERIOD_T]
            S[b + MOTOR_X] = x
            S[b + LOAD_X] = x
            S[b + LOAD_V] = S[b + MOTOR_V]
    elif S[b + GENERAL] != 0.0:
        general(S, b, amplifier(S, b))
    else:
        simple(S, b, amplifier(S, b))
    if S[b + OUTSIDE_V] != 0.0:
        S[b + OUTSIDE_X] += S[b + OUTSIDE_V] * S[PERIOD_T]
