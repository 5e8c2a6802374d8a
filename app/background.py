"""Long sums beside the window: a thread that lives as long as the sum; the tick fetches what it came to."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import TypeVar

T = TypeVar("T")


def in_background(call: Callable[[], T]) -> Future[T]:
    """Begins at once; whoever asked is told by the tick."""
    pool = ThreadPoolExecutor(max_workers=1, thread_name_prefix="background")
    future = pool.submit(call)
    pool.shutdown(wait=False)
    return future
