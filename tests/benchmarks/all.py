"""Every measurement, in the order of the table."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from tests.benchmarks.editing import many_edits, rename, rescale
from tests.benchmarks.figure import Figure
from tests.benchmarks.line import download_shares
from tests.benchmarks.simulator import four_axes_of_moves, served_idle, tight_loop
from tests.benchmarks.start import start_figures

SINGLE: tuple[Callable[[], Figure], ...] = (
    four_axes_of_moves,
    tight_loop,
    served_idle,
    many_edits,
    rename,
    rescale,
)

SEVERAL: tuple[Callable[[], list[Figure]], ...] = (download_shares, start_figures)


def measured() -> Iterator[Figure]:
    """Measures one after the other."""
    for measure in SINGLE:
        yield measure()
    for several in SEVERAL:
        yield from several()
