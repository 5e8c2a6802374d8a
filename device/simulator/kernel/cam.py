"""Electronic cam: slaves follow a table of positions over one cycle of the master (dmc-1412-1414.txt l.1800-1926)."""

from __future__ import annotations

from math import floor

from device.simulator.kernel.layout import (
    AUXILIARY,
    AUXILIARY_SHIFT,
    CAM,
    CAM_AT,
    CAM_AUXILIARY,
    CAM_AXIS,
    CAM_CYCLE,
    CAM_ENGAGED,
    CAM_INTERVAL,
    CAM_LAST,
    CAM_LENGTH,
    CAM_MASTER,
    CAM_NET,
    CAM_NEXT,
    CAM_START,
    CAM_WAITS,
    POSITION,
    State,
    part,
)
from device.simulator.kernel.profile import shift, step_by


def cam_value(S: State, axis: int, master: float) -> float:
    """The slave's position in the table, straight between the entries."""
    place = (master - S[CAM_START]) / S[CAM_INTERVAL]
    entry = floor(place)
    if entry < 0:
        entry = 0
        place = 0.0
    if entry > CAM_LENGTH - 2:
        entry = CAM_LENGTH - 2
        place = float(CAM_LENGTH - 1)
    first = S[CAM + CAM_LENGTH * axis + entry]
    return first + (place - entry) * (S[CAM + CAM_LENGTH * axis + entry + 1] - first)


def engage(A: State) -> None:
    """The slave's position is brought into its cycle; from then on it is the table's."""
    A[CAM_ENGAGED] = 1.0
    net = abs(A[CAM_NET])
    if net > 0.0:
        shift(A, -net * floor(A[POSITION] / net))


def change_over(A: State, last: float, now: float, cycles: float, cycle: float) -> None:
    """Engages or leaves where the master passes the place asked for, going forward."""
    if A[CAM_WAITS] == 0.0:
        return
    place = A[CAM_AT]
    reached = now + cycles * cycle
    if last < place <= reached or (cycles > 0.0 and last < place + cycle <= reached):
        A[CAM_WAITS] = 0.0
        if A[CAM_NEXT] != 0.0:
            engage(A)
        else:
            A[CAM_ENGAGED] = 0.0


def wrap_master(S: State, cycles: float, cycle: float) -> None:
    """Keeps the master's own position within its cycle."""
    A = part(S, int(S[CAM_AXIS]))
    if S[CAM_AUXILIARY] != 0.0:
        A[AUXILIARY_SHIFT] -= cycles * cycle
        A[AUXILIARY] -= cycles * cycle
    else:
        shift(A, -cycles * cycle)


def advance_cam(S: State, axes: int) -> None:
    """One sample: where the master is, and each engaged slave at its place in the table."""
    cycle = S[CAM_CYCLE]
    master = S[int(S[CAM_MASTER])]
    cycles = float(floor(master / cycle))
    if cycles != 0.0:
        wrap_master(S, cycles, cycle)
        master -= cycles * cycle
    for axis in range(axes):
        A = part(S, axis)
        if cycles != 0.0 and A[CAM_ENGAGED] != 0.0:
            # up to the end of the cycle first, then renamed by the net change: no movement is lost
            step_by(A, cam_value(S, axis, master) + cycles * A[CAM_NET] - A[POSITION])
            shift(A, -cycles * A[CAM_NET])
        change_over(A, S[CAM_LAST], master, cycles, cycle)
        if A[CAM_ENGAGED] != 0.0:
            step_by(A, cam_value(S, axis, master) - A[POSITION])
    S[CAM_LAST] = master
