"""Long sums beside the window: a thread that lives as long as the sum; the tick fetches what it came to."""

from __future__ import annotations

import sys
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import TypeVar

T = TypeVar("T")
SWITCH_S = 0.001  # between two turns of the interpreter meanwhile: the window waits no longer for its own
USUAL_S = 0.005  # Python's own; what stood there before may be the short one of another sum, which ends sooner


def in_background(call: Callable[[], T]) -> Future[T]:
    """Begins at once; whoever asked is told by the tick."""
    pool = ThreadPoolExecutor(max_workers=1, thread_name_prefix="background")
    future = pool.submit(beside, call)
    pool.shutdown(wait=False)
    return future


def beside(call: Callable[[], T]) -> T:
    """Calls it, and lets the window's thread go on in small turns."""
    sys.setswitchinterval(SWITCH_S)
    try:
        return call()
    finally:
        sys.setswitchinterval(USUAL_S)
