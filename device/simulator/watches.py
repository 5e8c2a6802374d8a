"""What a trippoint waits for, as conditions on slots of the motion state (commands.md 6, truth table)."""

from __future__ import annotations

import math
from enum import Enum, auto

from device.simulator.kernel import layout
from device.simulator.kernel.layout import EQUAL, NEVER, NOT_LESS, NOT_MORE, State, axis_base

Condition = tuple[int, int, float]  # slot, operator, value
NOTHING: Condition = (layout.AXES, NEVER, 0.0)


class Watch(Enum):
    """Kinds of watch, with the command that waits so."""

    AFTER_MOVE = auto()  # AM
    IN_POSITION = auto()  # MC; value: TW in samples, negative for none
    AFTER_DISTANCE = auto()  # AD
    AFTER_RELATIVE = auto()  # AR
    AFTER_POSITION = auto()  # AP
    FORWARD_PAST = auto()  # MF
    REVERSE_PAST = auto()  # MR
    AT_SPEED = auto()  # AS
    TIME = auto()  # WT, AT; value: sample number
    INPUT_HIGH = auto()  # AI n; value: n
    INPUT_LOW = auto()  # AI -n
    CONTOUR_FREE = auto()  # WC
    PATH_DONE = auto()  # AMS
    PATH_SPEED = auto()  # ASS
    PATH_DISTANCE = auto()  # AV


def conditions(state: State, kind: Watch, axis: int, value: float) -> tuple[Condition, Condition]:
    """The two conditions of which either ends the wait."""
    b = axis_base(axis)
    still: Condition = (b + layout.MOVING, EQUAL, 0.0)
    path_still: Condition = (layout.PATH_MOVING, EQUAL, 0.0)
    if kind is Watch.AFTER_POSITION:
        up = value >= state[b + layout.ACTUAL]
        return (b + layout.ACTUAL, NOT_LESS if up else NOT_MORE, value), still
    if kind is Watch.IN_POSITION:
        late = (b + layout.SETTLING, NOT_LESS, value) if value >= 0 else NOTHING
        return (b + layout.IN_POSITION, EQUAL, 1.0), late
    if kind is Watch.PATH_DISTANCE:
        return (layout.PATH_TRAVELLED, NOT_LESS, state[layout.PATH_MARK] + value), path_still
    if kind in (Watch.INPUT_HIGH, Watch.INPUT_LOW):
        level = 1.0 if kind is Watch.INPUT_HIGH else 0.0
        return (layout.INPUT_1 + int(value) - 1, EQUAL, level), NOTHING
    table: dict[Watch, tuple[Condition, Condition]] = {
        Watch.AFTER_MOVE: (still, NOTHING),
        Watch.AFTER_DISTANCE: ((b + layout.DISTANCE, NOT_LESS, abs(value)), still),
        Watch.AFTER_RELATIVE: ((b + layout.MARK_DISTANCE, NOT_LESS, abs(value)), still),
        Watch.FORWARD_PAST: ((b + layout.ACTUAL, NOT_LESS, value), NOTHING),
        Watch.REVERSE_PAST: ((b + layout.ACTUAL, NOT_MORE, value), NOTHING),
        Watch.AT_SPEED: ((b + layout.AT_SPEED, EQUAL, 1.0), still),
        Watch.TIME: ((layout.SAMPLE, NOT_LESS, value), NOTHING),
        Watch.CONTOUR_FREE: ((layout.CONTOUR_BUFFERED, EQUAL, 0.0), NOTHING),
        Watch.PATH_DONE: (path_still, NOTHING),
        Watch.PATH_SPEED: ((layout.PATH_AT_SPEED, EQUAL, 1.0), path_still),
    }
    return table[kind]


def arm(state: State, kind: Watch, axis: int, wanted: float) -> int:
    """Puts the conditions in a free place of the table and returns its number."""
    pair = conditions(state, kind, axis, wanted)
    for number in range(layout.MAXIMUM_WATCHES):
        place = layout.WATCH + layout.WATCH_STRIDE * number
        if state[place + layout.W_STATE] == 0.0:
            for offset, value in enumerate((1.0, *pair[0], *pair[1], kind.value, axis, wanted)):
                state[place + offset] = value
            state[layout.WATCHES] = max(state[layout.WATCHES], number + 1.0)
            return number
    raise RuntimeError("all watches are in use")


def mark_place(state: State, place: int) -> None:
    """After AD or AR the next AR counts from where this one tripped; AV likewise along the path."""
    kind, b = Watch(int(state[place + layout.W_KIND])), axis_base(int(state[place + layout.W_AXIS]))
    wanted = state[place + layout.W_NUMBER]
    if kind in (Watch.AFTER_DISTANCE, Watch.AFTER_RELATIVE):
        origin = layout.START if kind is Watch.AFTER_DISTANCE else layout.MARK
        way = state[b + layout.POSITION] - state[b + origin]
        reached = math.copysign(min(abs(wanted), abs(way)), way)
        state[b + layout.MARK] = state[b + origin] + reached
        state[b + layout.MARK_DISTANCE] = abs(state[b + layout.POSITION] - state[b + layout.MARK])
    elif kind is Watch.PATH_DISTANCE:
        state[layout.PATH_MARK] = min(state[layout.PATH_TRAVELLED], state[layout.PATH_MARK] + wanted)


def release(state: State, number: int) -> None:
    """Frees a place of the table; what tripped marks its place."""
    place = layout.WATCH + layout.WATCH_STRIDE * number
    if state[place + layout.W_STATE] == 2.0:
        mark_place(state, place)
    state[place + layout.W_STATE] = 0.0
    used = int(state[layout.WATCHES])
    while used and state[layout.WATCH + layout.WATCH_STRIDE * (used - 1) + layout.W_STATE] == 0.0:
        used -= 1
    state[layout.WATCHES] = float(used)
