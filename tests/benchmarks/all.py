"""Every measurement, in the order of the table."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from tests.benchmarks.curves import drawing_rates
from tests.benchmarks.editing import many_edits, rename, rescale
from tests.benchmarks.figure import Figure
from tests.benchmarks.line import download_shares
from tests.benchmarks.simulator import (
    arcs_with_gearing,
    four_axes_of_moves,
    moves_beside_busy_threads,
    served_idle,
    served_with_axes_and_threads,
    setting_loops,
    tight_loop,
    waiting_loops,
)
from tests.benchmarks.start import start_figures

SINGLE: tuple[Callable[[], Figure], ...] = (
    four_axes_of_moves,
    arcs_with_gearing,
    waiting_loops,
    setting_loops,
    moves_beside_busy_threads,
    tight_loop,
    served_idle,
    served_with_axes_and_threads,
    many_edits,
    rename,
    rescale,
)

SEVERAL: tuple[Callable[[], list[Figure]], ...] = (download_shares, start_figures, drawing_rates)


def measured() -> Iterator[Figure]:
    """Measures one after the other."""
    for measure in SINGLE:
        yield measure()
    for several in SEVERAL:
        yield from several()
