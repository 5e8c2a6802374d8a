"""Sine commutation: what two phase signals make of the command; hall sensors (dmc-1412-1414.txt l.680-804)."""

from __future__ import annotations

from math import floor

from device.simulator.kernel.angle import sine
from device.simulator.kernel.layout import (
    COUNTS,
    HALL_ANGLE,
    HALL_FIRST,
    HALL_ORDER,
    HALL_SECTOR,
    INPUT_1,
    INPUTS,
    MAGNETIC_CYCLE,
    MAGNETIC_ZERO,
    MOTOR_V,
    MOTOR_X,
    PHASE_CALIBRATE,
    PHASE_CYCLE,
    PHASE_DAMPING,
    PHASE_HALL_OFFSET,
    PHASE_HALLS,
    PHASE_HELD,
    PHASE_MODE,
    PHASE_OFFSET,
    PHASE_ZERO,
    WIRES_SWAPPED,
    State,
)


def true_angle(A: State) -> float:
    """Electrical angle of the motor, degrees."""
    return 360.0 * A[MOTOR_X] / A[MAGNETIC_CYCLE] + A[MAGNETIC_ZERO]


def believed_angle(A: State) -> float:
    """The phase the controller goes by, degrees."""
    return 360.0 * (A[COUNTS] - A[PHASE_ZERO]) / A[PHASE_CYCLE]


def commutated(A: State, volts: float) -> float:
    """The part of the command that turns the motor: the field's strength times the sine of its lead on the rotor."""
    held = A[PHASE_MODE] == 2.0
    field = A[PHASE_HELD] if held else believed_angle(A) + 90.0
    second = 90.0  # where the second signal's winding is
    if A[WIRES_SWAPPED] != 0.0:
        field = 90.0 - field
        second = 0.0
    turning = volts * sine(field - true_angle(A))
    if A[PHASE_OFFSET] != 0.0:
        turning += A[PHASE_OFFSET] * sine(second - true_angle(A))
    if held:
        turning -= A[PHASE_DAMPING] * A[MOTOR_V]
    return turning


def sector_of(a: float, b: float, c: float) -> float:
    """Which sixth of the cycle the three sensors show; -1 for a pattern that no sensors give."""
    if a == b and b == c:
        return -1.0
    if a != 0.0:
        if b != 0.0:
            return 2.0
        return 0.0 if c != 0.0 else 1.0
    if b != 0.0:
        return 4.0 if c != 0.0 else 3.0
    return 5.0


def sensor(angle: float, number: float) -> float:
    """Level of hall sensor 1, 2 or 3: high for half a cycle, each 120° behind the last."""
    return 1.0 if sine(angle - 120.0 * (number - 1.0)) >= 0.0 else 0.0


def write_hall_inputs(S: State, A: State) -> None:
    """Puts the sensors' levels on the inputs they are wired to."""
    first = int(A[HALL_FIRST])
    angle = true_angle(A) - A[HALL_ANGLE]
    byte = int(S[INPUTS])
    for wire in range(3):
        level = sensor(angle, A[HALL_ORDER + wire])
        place = first - 1 + wire
        S[INPUT_1 + place] = level
        byte &= 255 ^ (1 << place)
        if level != 0.0:
            byte |= 1 << place
    S[INPUTS] = float(byte)


def read_halls(S: State, A: State) -> None:
    """The controller's view of the sensors; with BC the phase is set where they change."""
    if A[HALL_FIRST] > 0.0:
        write_hall_inputs(S, A)
    first = int(A[PHASE_HALLS])
    if first == 0:
        return
    place = INPUT_1 + first - 1
    sector = sector_of(S[place], S[place + 1], S[place + 2])
    last = A[HALL_SECTOR]
    A[HALL_SECTOR] = sector
    if A[PHASE_CALIBRATE] == 0.0 or sector == last or sector < 0.0 or last < 0.0:
        return
    step = sector - last
    forward = step == 1.0 or step == -5.0
    edge = 60.0 * (sector if forward else last) + A[PHASE_HALL_OFFSET]
    turns = floor(edge / 360.0)
    A[PHASE_ZERO] = A[COUNTS] - (edge - 360.0 * turns) * A[PHASE_CYCLE] / 360.0
    A[PHASE_CALIBRATE] = 0.0
