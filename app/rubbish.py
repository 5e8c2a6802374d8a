"""Garbage is looked for in the window's thread only.

Python itself looks in whatever thread makes something at that moment; one that frees a Qt object while the window uses
its relatives crashes the program.
"""

from __future__ import annotations

import gc
import time
from collections.abc import Callable

RESTS = 200  # times as long as a search through everything took, before the next one


class Rubbish:
    """From here to its `end` Python does not look for garbage by itself; `look` does, with each tick."""

    def __init__(self, clock: Callable[[], float] = time.perf_counter) -> None:
        self._clock, self._rest_until = clock, clock()
        self._by_itself = gc.isenabled()
        gc.disable()

    def look(self) -> None:
        """As far as Python itself would look by now: what is young, what is older, everything."""
        young, older, old = (made > limit for made, limit in zip(gc.get_count(), gc.get_threshold(), strict=True))
        if not young:
            return
        began = self._clock()
        if older and old and began >= self._rest_until:
            gc.collect()
            now = self._clock()
            self._rest_until = now + RESTS * (now - began)
        else:
            gc.collect(1 if older else 0)

    def keep(self) -> None:
        """What is there now stays to the end: it need not be looked at again and again.

        Not where somebody else has taken over from Python, as tests do: what is there then is no one's to keep.
        """
        if self._by_itself:
            gc.freeze()

    def end(self) -> None:
        """Python looks by itself again, if it did."""
        if self._by_itself:
            gc.enable()
