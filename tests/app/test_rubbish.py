"""What refers to itself is freed in the window's thread, whoever happens to make something at that moment."""

from __future__ import annotations

import gc
import itertools
import threading
import weakref
from collections.abc import Callable

import pytest

from app.background import in_background
from app.rubbish import RESTS, Rubbish
from tests.stage import Stage


class Ring:
    """Refers to itself, as a widget with a slot of its own does."""

    def __init__(self) -> None:
        self.itself = self


def left_behind() -> list[int]:
    """A ring that nobody holds; the thread that frees it writes itself down."""
    freed_by: list[int] = []
    weakref.finalize(Ring(), lambda: freed_by.append(threading.get_ident()))
    return freed_by


def make_much() -> int:
    """So much that Python would have looked for garbage hundreds of times, in the very thread that makes it."""
    return len([[number] for number in range(gc.get_threshold()[0] * 500)])


def test_no_other_thread_frees_what_the_window_left(stage: Stage) -> None:
    freed_by = left_behind()
    assert in_background(make_much).result(timeout=60) > 0
    assert freed_by == []
    held = [make_young() for _ in range(3)]
    stage.go(1)
    assert freed_by == [threading.get_ident()] and held


def make_young() -> list[list[int]]:
    return [[number] for number in range(gc.get_threshold()[0])]


def test_python_alone_would_free_it_anywhere() -> None:
    """The reason for all this; as soon as it fails, it can go."""
    freed_by = left_behind()
    gc.enable()
    try:
        in_background(make_much).result(timeout=60)
    finally:
        gc.disable()
    assert freed_by and freed_by != [threading.get_ident()]


def whole_searches(clock: Callable[[], float]) -> list[int]:
    """After which looks everything was looked through, of 600 looks with much that stays made before each."""
    found, held, rubbish = [], [], Rubbish(clock)
    for number in range(600):
        held.append(make_young() + make_young()[:1])
        before = gc.get_stats()[2]["collections"]
        rubbish.look()
        if gc.get_stats()[2]["collections"] != before:
            found.append(number)
    rubbish.end()
    assert len(held) == 600 and not gc.isenabled()  # as it was before
    return found


def test_everything_is_looked_through_now_and_then_only() -> None:
    """Where a search through everything takes 10 ms, and a tick no longer, 200 ticks lie between two of them."""
    often, seldom = whole_searches(lambda: 0.0), whole_searches(itertools.count(0.0, 0.010).__next__)
    _, older, old = gc.get_threshold()
    assert len(often) > 3 and min(pair[1] - pair[0] for pair in itertools.pairwise(often)) >= older * old
    assert len(seldom) > 1 and min(pair[1] - pair[0] for pair in itertools.pairwise(seldom)) >= RESTS
    assert min(pair[1] - pair[0] for pair in itertools.pairwise(often)) < RESTS


@pytest.mark.parametrize("by_itself", [True, False])
def test_what_is_there_when_the_start_is_over_is_looked_at_no_more(by_itself: bool) -> None:
    """In the program, where Python looked by itself before; in these tests nothing is kept."""
    kept, held = gc.get_freeze_count(), [[number] for number in range(1000)]
    if by_itself:
        gc.enable()
    rubbish = Rubbish()
    try:
        rubbish.keep()
        assert (gc.get_freeze_count() >= kept + len(held)) == by_itself
    finally:
        rubbish.end()
        gc.disable()
