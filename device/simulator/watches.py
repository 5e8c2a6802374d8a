"""What a trippoint waits for, as conditions on slots of the motion state (commands.md 6, truth table)."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from enum import IntEnum, auto

from device.simulator.kernel import events, layout
from device.simulator.kernel.layout import EQUAL, NEVER, NOT_LESS, NOT_MORE, State, axis_base

Condition = tuple[int, int, float]  # slot, operator, value
NOTHING: Condition = (layout.AXES, NEVER, 0.0)


class Watch(IntEnum):
    """Kinds of watch, with the command that waits so."""

    AFTER_MOVE = auto()  # AM
    IN_POSITION = auto()  # MC; value: TW in samples, negative for none
    AFTER_DISTANCE = auto()  # AD
    AFTER_RELATIVE = auto()  # AR
    AFTER_POSITION = layout.CROSSING  # AP
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
    AFTER_DISTANCE_ONLY = auto()  # AD, AR that the end of the move does not end
    AFTER_RELATIVE_ONLY = auto()


Pair = tuple[Condition, Condition]
PATH_STILL: Condition = (layout.PATH_MOVING, EQUAL, 0.0)


def still(b: int) -> Condition:
    """The profile of the axis at `b` is done."""
    return b + layout.MOVING, EQUAL, 0.0


def crossing(state: State, b: int, value: float) -> Pair:
    """AP: from below when the axis is below now, else from above."""
    operator = NOT_LESS if value >= state[b + layout.ACTUAL] else NOT_MORE
    return (b + layout.ACTUAL, operator, value), still(b)


def settled(state: State, b: int, value: float) -> Pair:
    """MC, or its time-out."""
    late: Condition = (b + layout.SETTLING, NOT_LESS, value) if value >= 0 else NOTHING
    return (b + layout.IN_POSITION, EQUAL, 1.0), late


# The two conditions of which either ends the wait.
CONDITIONS: dict[Watch, Callable[[State, int, float], Pair]] = {
    Watch.AFTER_MOVE: lambda state, b, value: (still(b), NOTHING),
    Watch.IN_POSITION: settled,
    Watch.AFTER_DISTANCE: lambda state, b, value: ((b + layout.DISTANCE, NOT_LESS, abs(value)), still(b)),
    Watch.AFTER_RELATIVE: lambda state, b, value: ((b + layout.MARK_DISTANCE, NOT_LESS, abs(value)), still(b)),
    Watch.AFTER_DISTANCE_ONLY: lambda state, b, value: ((b + layout.DISTANCE, NOT_LESS, abs(value)), NOTHING),
    Watch.AFTER_RELATIVE_ONLY: lambda state, b, value: ((b + layout.MARK_DISTANCE, NOT_LESS, abs(value)), NOTHING),
    Watch.AFTER_POSITION: crossing,
    Watch.FORWARD_PAST: lambda state, b, value: ((b + layout.ACTUAL, NOT_LESS, value), NOTHING),
    Watch.REVERSE_PAST: lambda state, b, value: ((b + layout.ACTUAL, NOT_MORE, value), NOTHING),
    Watch.AT_SPEED: lambda state, b, value: ((b + layout.AT_SPEED, EQUAL, 1.0), still(b)),
    Watch.TIME: lambda state, b, value: ((layout.SAMPLE, NOT_LESS, value), NOTHING),
    Watch.INPUT_HIGH: lambda state, b, value: ((layout.INPUT_1 + int(value) - 1, EQUAL, 1.0), NOTHING),
    Watch.INPUT_LOW: lambda state, b, value: ((layout.INPUT_1 + int(value) - 1, EQUAL, 0.0), NOTHING),
    Watch.CONTOUR_FREE: lambda state, b, value: ((layout.CONTOUR_BUFFERED, EQUAL, 0.0), NOTHING),
    Watch.PATH_DONE: lambda state, b, value: (PATH_STILL, NOTHING),
    Watch.PATH_SPEED: lambda state, b, value: ((layout.PATH_AT_SPEED, EQUAL, 1.0), PATH_STILL),
    Watch.PATH_DISTANCE: lambda state, b, value: (
        (layout.PATH_TRAVELLED, NOT_LESS, state[layout.PATH_MARK] + value),
        PATH_STILL,
    ),
}


Wanted = tuple[Watch, int, float]  # kind, axis, value


def arm(state: State, wanted: Sequence[Wanted]) -> list[int]:
    """Puts watches in free places of the table; they trip when the last of them does. Answers their numbers."""
    numbers = free_places(state, len(wanted))
    first = layout.WATCH + layout.WATCH_STRIDE * numbers[0]
    for number, (kind, axis, value) in zip(numbers, wanted, strict=True):
        place = layout.WATCH + layout.WATCH_STRIDE * number
        one, other = CONDITIONS[kind](state, axis_base(axis), value)
        state[place + layout.W_STATE] = 1.0
        state[place + layout.W_SLOT], state[place + layout.W_OPERATOR], state[place + layout.W_VALUE] = one
        state[place + layout.W_SLOT_2], state[place + layout.W_OPERATOR_2], state[place + layout.W_VALUE_2] = other
        state[place + layout.W_KIND], state[place + layout.W_AXIS], state[place + layout.W_NUMBER] = kind, axis, value
        state[place + layout.W_FIRST], state[place + layout.W_LEFT] = first, 0.0
    state[first + layout.W_LEFT] = len(numbers)
    state[layout.WATCHES] = max(state[layout.WATCHES], numbers[-1] + 1.0)
    for number in numbers:
        events.test_watch(state, layout.WATCH + layout.WATCH_STRIDE * number)
    return numbers


def free_places(state: State, count: int) -> list[int]:
    """Numbers of the first free places."""
    found = []
    for number in range(layout.MAXIMUM_WATCHES):
        if state[layout.WATCH + layout.WATCH_STRIDE * number + layout.W_STATE] == 0.0:
            found.append(number)
            if len(found) == count:
                return found
    raise RuntimeError("all watches are in use")


def mark_place(state: State, place: int) -> None:
    """After AD or AR the next AR counts from where this one tripped; AV likewise along the path."""
    kind, wanted = state[place + layout.W_KIND], state[place + layout.W_NUMBER]
    from_start = kind in (Watch.AFTER_DISTANCE, Watch.AFTER_DISTANCE_ONLY)
    if from_start or kind in (Watch.AFTER_RELATIVE, Watch.AFTER_RELATIVE_ONLY):
        b = axis_base(int(state[place + layout.W_AXIS]))
        origin = layout.START if from_start else layout.MARK
        way = state[b + layout.POSITION] - state[b + origin]
        reached = math.copysign(min(abs(wanted), abs(way)), way)
        state[b + layout.MARK] = state[b + origin] + reached
        state[b + layout.MARK_DISTANCE] = abs(state[b + layout.POSITION] - state[b + layout.MARK])
    elif kind == Watch.PATH_DISTANCE:
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
