"""Electronic cam: slaves follow a table of positions over one cycle of the master (dmc-1412-1414.txt l.1800-1926)."""

from __future__ import annotations

from math import floor

from device.simulator.kernel.events import test_watch
from device.simulator.kernel.layout import (
    ACTUAL,
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
    CROSSING,
    NOT_LESS,
    NOT_MORE,
    POSITION,
    W_KIND,
    W_OPERATOR,
    W_SLOT,
    W_STATE,
    W_VALUE,
    WATCH,
    WATCH_STRIDE,
    WATCHES,
    State,
    axis_base,
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


def rename(S: State, axis: int, counts: float, come_from: float) -> None:
    """Renames an axis' position; AP, tested up to here, goes on from the place where the new names begin."""
    slot = axis_base(axis) + ACTUAL
    place = WATCH
    for _ in range(int(S[WATCHES])):
        if S[place + W_STATE] == 1.0 and S[place + W_KIND] == CROSSING and S[place + W_SLOT] == slot:
            test_watch(S, place)
            S[place + W_OPERATOR] = NOT_LESS if S[place + W_VALUE] >= come_from else NOT_MORE
        place += WATCH_STRIDE
    shift(part(S, axis), counts)


def engage(S: State, axis: int) -> None:
    """The slave's position is brought into its cycle; from then on it is the table's."""
    A = part(S, axis)
    A[CAM_ENGAGED] = 1.0
    net = abs(A[CAM_NET])
    if net > 0.0:
        counts = -net * floor(A[POSITION] / net)
        rename(S, axis, counts, A[ACTUAL] + counts)


def change_over(S: State, axis: int, last: float, now: float, cycles: float, cycle: float) -> None:
    """Engages or leaves where the master passes the place asked for, going forward."""
    A = part(S, axis)
    if A[CAM_WAITS] == 0.0:
        return
    place = A[CAM_AT]
    reached = now + cycles * cycle
    if last < place <= reached or (cycles > 0.0 and last < place + cycle <= reached):
        A[CAM_WAITS] = 0.0
        if A[CAM_NEXT] != 0.0:
            engage(S, axis)
        else:
            A[CAM_ENGAGED] = 0.0


def wrap_master(S: State, cycles: float, cycle: float) -> None:
    """Keeps the master's own position within its cycle."""
    axis = int(S[CAM_AXIS])
    A = part(S, axis)
    if S[CAM_AUXILIARY] != 0.0:
        A[AUXILIARY_SHIFT] -= cycles * cycle
        A[AUXILIARY] -= cycles * cycle
    else:
        rename(S, axis, -cycles * cycle, 0.0 if cycles > 0.0 else cycle)


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
            counts = -cycles * A[CAM_NET]
            rename(S, axis, counts, A[ACTUAL] + counts)
        change_over(S, axis, S[CAM_LAST], master, cycles, cycle)
        if A[CAM_ENGAGED] != 0.0:
            step_by(A, cam_value(S, axis, master) - A[POSITION])
    S[CAM_LAST] = master
