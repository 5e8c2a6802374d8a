"""FE, FI and HM: the stages between the home switch and the index pulse (dmc-1412-1414.txt l.2312-2346)."""

from __future__ import annotations

from math import floor

from device.simulator.kernel.inputs import raise_event
from device.simulator.kernel.layout import (
    COUNTS_SHIFT,
    DIRECTION,
    ENCODER_SIGN,
    EVENT_HOMED,
    HOME_LEVEL,
    HOME_RAMPED,
    HOME_V,
    INDEX_AT,
    MODE,
    MODE_IDLE,
    MODE_JOG,
    MODE_STOPPING,
    MOVING,
    POSITION,
    RAW,
    RAW_LAST,
    REVOLUTION,
    SLEW_V,
    SMOOTHED,
    SPEED_V,
    STAGE,
    STAGE_EDGE,
    STAGE_HOME_BACK,
    STAGE_HOME_INDEX,
    STAGE_HOME_SEARCH,
    STAGE_HOME_STOP,
    STAGE_INDEX,
    STAGE_LEVEL,
    STAGE_NONE,
    STEPPER,
    STOP_CODE,
    VELOCITY_V,
    State,
)
from device.simulator.kernel.profile import freeze, shift

CREEP_V = 256.0
NOWHERE = 9.0e15


def index_passed(A: State) -> float:
    """Where (machine counts) the encoder met the index pulse in the last sample; NOWHERE if it did not."""
    revolution = A[REVOLUTION]
    now = A[RAW] - A[INDEX_AT]
    last = A[RAW_LAST] - A[INDEX_AT]
    if now > last:
        turn = floor(now / revolution)
        if turn > floor(last / revolution):
            return turn * revolution + A[INDEX_AT]
    elif now < last:
        turn = -floor(-now / revolution)
        if turn < -floor(-last / revolution):
            return turn * revolution + A[INDEX_AT]
    return NOWHERE


def zero_at(A: State, raw: float) -> None:
    """Makes the machine position `raw` the axis' position 0."""
    shift(A, -(raw * A[ENCODER_SIGN] + A[COUNTS_SHIFT]))


def homed(S: State, A: State, raw: float) -> None:
    """The machine position `raw` is 0, and the axis is commanded there at once."""
    zero_at(A, raw)
    freeze(A)
    A[POSITION] = 0.0
    A[SMOOTHED] = 0.0
    A[STOP_CODE] = 10.0
    raise_event(S, A, EVENT_HOMED)


def creep(A: State, stage: int, direction: float) -> None:
    """Starts a stage at 256 counts/s."""
    A[STAGE] = stage
    A[STAGE_LEVEL] = A[HOME_LEVEL]
    A[SLEW_V] = CREEP_V * direction
    A[VELOCITY_V] = 0.0
    A[MODE] = MODE_JOG
    A[MOVING] = 1.0


def search(S: State, A: State, stage: int) -> None:
    """FE (at SP) and the first stage of HM: on until the home input changes, then a stop at DC."""
    speed = A[SPEED_V] if stage == STAGE_EDGE or A[HOME_V] == 0.0 else A[HOME_V]
    A[SLEW_V] = speed * A[DIRECTION]
    if A[HOME_LEVEL] != A[STAGE_LEVEL]:
        A[MODE] = MODE_STOPPING
        A[STOP_CODE] = 9.0 if stage == STAGE_EDGE else 10.0
        if stage == STAGE_EDGE:
            A[STAGE] = STAGE_NONE
            raise_event(S, A, EVENT_HOMED)
        else:
            A[STAGE] = STAGE_HOME_STOP


def find_index(S: State, A: State) -> None:
    """FI: the place of the pulse becomes 0 while the axis goes on to stop at DC."""
    place = index_passed(A)
    if place != NOWHERE:
        zero_at(A, place)
        A[MODE] = MODE_STOPPING
        A[STAGE] = STAGE_NONE
        A[STOP_CODE] = 10.0
        raise_event(S, A, EVENT_HOMED)


def leave_switch(S: State, A: State) -> None:
    """HM stage 2: back to the edge; forward it runs on into stage 3, in reverse it stops at once."""
    if A[HOME_LEVEL] == A[STAGE_LEVEL]:
        return
    if A[STEPPER] != 0.0:
        homed(S, A, A[RAW])
    elif A[SLEW_V] > 0.0:
        A[STAGE] = STAGE_HOME_INDEX
    else:
        creep(A, STAGE_HOME_INDEX, 1.0)


def arrive(S: State, A: State) -> None:
    """HM stage 3: the index pulse is position 0, and the axis is commanded there at once (or stops at DC)."""
    if A[HOME_RAMPED] != 0.0:
        find_index(S, A)
        return
    place = index_passed(A)
    if place != NOWHERE:
        homed(S, A, place)


def advance_stage(S: State, A: State) -> None:
    """Looks whether a homing stage has reached what it looks for; before the profile of the same sample."""
    stage = int(A[STAGE])
    if stage in (STAGE_EDGE, STAGE_HOME_SEARCH):
        search(S, A, stage)
    elif stage == STAGE_INDEX:
        find_index(S, A)
    elif stage == STAGE_HOME_STOP:
        if A[MODE] == MODE_IDLE:
            creep(A, STAGE_HOME_BACK, -A[DIRECTION])
    elif stage == STAGE_HOME_BACK:
        leave_switch(S, A)
    elif stage == STAGE_HOME_INDEX:
        arrive(S, A)
