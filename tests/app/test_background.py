"""Sums beside the window: however they overlap, afterwards threads take turns as before."""

from __future__ import annotations

import sys
import threading

from app.background import SWITCH_S, in_background


def test_overlapping_sums_leave_the_turns_as_they_were() -> None:
    before = sys.getswitchinterval()
    first, second = threading.Event(), threading.Event()
    one = in_background(lambda: first.wait(10) and sys.getswitchinterval())
    two = in_background(lambda: second.wait(10) and sys.getswitchinterval())
    first.set()
    assert one.result(10) == SWITCH_S
    second.set()
    assert two.result(10)
    for thread in threading.enumerate():
        if thread.name.startswith("background"):
            thread.join(10)
    assert sys.getswitchinterval() == before
