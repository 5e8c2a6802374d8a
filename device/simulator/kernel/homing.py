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


def index_passed(S: State, b: int) -> float:
    """Where (machine counts) the encoder met the index pulse in the last sample; NOWHERE if it did not."""
    revolution = S[b + REVOLUTION]
    now = S[b + RAW] - S[b + INDEX_AT]
    last = S[b + RAW_LAST] - S[b + INDEX_AT]
    if now > last:
        turn = floor(now / revolution)
        if turn > floor(last / revolution):
            return turn * revolution + S[b + INDEX_AT]
    elif now < last:
        turn = -floor(-now / revolution)
        if turn < -floor(-last / revolution):
            return turn * revolution + S[b + INDEX_AT]
    return NOWHERE


def zero_at(S: State, b: int, raw: float) -> None:
    """Makes the machine position `raw` the axis' position 0."""
    shift(S, b, -(raw * S[b + ENCODER_SIGN] + S[b + COUNTS_SHIFT]))


def homed(S: State, b: int, raw: float) -> None:
    """The machine position `raw` is 0, and the axis is commanded there at once."""
    zero_at(S, b, raw)
    freeze(S, b)
    S[b + POSITION] = 0.0
    S[b + SMOOTHED] = 0.0
    S[b + STOP_CODE] = 10.0
    raise_event(S, b, EVENT_HOMED)


def creep(S: State, b: int, stage: int, direction: float) -> None:
    """Starts a stage at 256 counts/s."""
    S[b + STAGE] = stage
    S[b + STAGE_LEVEL] = S[b + HOME_LEVEL]
    S[b + SLEW_V] = CREEP_V * direction
    S[b + VELOCITY_V] = 0.0
    S[b + MODE] = MODE_JOG
    S[b + MOVING] = 1.0


def search(S: State, b: int, stage: int) -> None:
    """FE and the first stage of HM: on at SP until the home input changes, then a stop at DC."""
    S[b + SLEW_V] = S[b + SPEED_V] * S[b + DIRECTION]
    if S[b + HOME_LEVEL] != S[b + STAGE_LEVEL]:
        S[b + MODE] = MODE_STOPPING
        S[b + STOP_CODE] = 9.0 if stage == STAGE_EDGE else 10.0
        if stage == STAGE_EDGE:
            S[b + STAGE] = STAGE_NONE
            raise_event(S, b, EVENT_HOMED)
        else:
            S[b + STAGE] = STAGE_HOME_STOP


def find_index(S: State, b: int) -> None:
    """FI: the place of the pulse becomes 0 while the axis goes on to stop at DC."""
    place = index_passed(S, b)
    if place != NOWHERE:
        zero_at(S, b, place)
        S[b + MODE] = MODE_STOPPING
        S[b + STAGE] = STAGE_NONE
        S[b + STOP_CODE] = 10.0
        raise_event(S, b, EVENT_HOMED)


def leave_switch(S: State, b: int) -> None:
    """HM stage 2: back to the edge; forward it runs on into stage 3, in reverse it stops at once."""
    if S[b + HOME_LEVEL] == S[b + STAGE_LEVEL]:
        return
    if S[b + STEPPER] != 0.0:
        homed(S, b, S[b + RAW])
    elif S[b + SLEW_V] > 0.0:
        S[b + STAGE] = STAGE_HOME_INDEX
    else:
        creep(S, b, STAGE_HOME_INDEX, 1.0)


def arrive(S: State, b: int) -> None:
    """HM stage 3: the index pulse is position 0, and the axis is commanded there at once."""
    place = index_passed(S, b)
    if place != NOWHERE:
        homed(S, b, place)


def advance_stage(S: State, b: int) -> None:
    """Looks whether a homing stage has reached what it looks for; before the profile of the same sample."""
    stage = int(S[b + STAGE])
    if stage in (STAGE_EDGE, STAGE_HOME_SEARCH):
        search(S, b, stage)
    elif stage == STAGE_INDEX:
        find_index(S, b)
    elif stage == STAGE_HOME_STOP:
        if S[b + MODE] == MODE_IDLE:
            creep(S, b, STAGE_HOME_BACK, -S[b + DIRECTION])
    elif stage == STAGE_HOME_BACK:
        leave_switch(S, b)
    elif stage == STAGE_HOME_INDEX:
        arrive(S, b)
