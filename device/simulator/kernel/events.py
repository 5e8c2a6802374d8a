"""The end of a sample: distances, in position, and the watches and guards that wait for something."""

from __future__ import annotations

from device.simulator.kernel.layout import (
    ACTUAL,
    DIRECTION,
    DISTANCE,
    EQUAL,
    GUARD,
    GUARD_BROKEN,
    GUARD_STRIDE,
    GUARDS,
    IN_POSITION,
    MARK,
    MARK_DISTANCE,
    MOVING,
    NOT_LESS,
    NOT_MORE,
    POSITION,
    REFERENCE,
    SETTLING,
    START,
    STEPPER,
    STEPS,
    TRIPS,
    W_FIRST,
    W_LEFT,
    W_OPERATOR,
    W_OPERATOR_2,
    W_SLOT,
    W_SLOT_2,
    W_STATE,
    W_VALUE,
    W_VALUE_2,
    WATCH,
    WATCH_STRIDE,
    WATCHES,
    State,
)


def measure(A: State) -> None:
    """What trippoints look at: way from the start and from the last mark, and whether the machine has arrived."""
    position = A[POSITION]
    A[DISTANCE] = abs(position - A[START])
    A[MARK_DISTANCE] = abs(position - A[MARK])
    if A[MOVING] != 0.0:
        A[IN_POSITION] = 0.0
        return
    A[SETTLING] += 1.0
    if A[IN_POSITION] == 0.0:
        if A[STEPPER] != 0.0:
            arrived = A[STEPS] == A[REFERENCE]
        else:
            arrived = (A[ACTUAL] - A[REFERENCE]) * A[DIRECTION] >= 0.0
        if arrived:
            A[IN_POSITION] = 1.0


def holds(value: float, operator: float, wanted: float) -> bool:
    """One condition of a watch."""
    if operator == NOT_LESS:
        return value >= wanted
    if operator == NOT_MORE:
        return value <= wanted
    if operator == EQUAL:
        return value == wanted
    return False


def test_watch(S: State, place: int) -> None:
    """Marks an armed watch one of whose conditions holds; it trips with the last of its group."""
    if holds(S[int(S[place + W_SLOT])], S[place + W_OPERATOR], S[place + W_VALUE]) or holds(
        S[int(S[place + W_SLOT_2])], S[place + W_OPERATOR_2], S[place + W_VALUE_2]
    ):
        S[place + W_STATE] = 2.0
        first = int(S[place + W_FIRST])
        S[first + W_LEFT] -= 1.0
        if S[first + W_LEFT] == 0.0:
            S[TRIPS] += 1.0


def test_watches(S: State) -> None:
    """Tests every armed watch."""
    place = WATCH
    for _ in range(int(S[WATCHES])):
        if S[place + W_STATE] == 1.0:
            test_watch(S, place)
        place += WATCH_STRIDE


def test_guards(S: State) -> None:
    """Says so when a guarded slot has left its range."""
    place = GUARD
    for _ in range(int(S[GUARDS])):
        value = S[int(S[place])]
        if value < S[place + 1] or value > S[place + 2]:
            S[GUARD_BROKEN] = 1.0
        place += GUARD_STRIDE
