"""The figures of speed keep their bounds (each runs without company).

The long run holds every figure to its bound and writes it down. The everyday run measures the same, but on whatever
computer it runs, beside whatever else goes on there; it fails where a figure is more than twice as bad as its bound.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from typing import Any

import pytest

from tests.benchmarks.all import SEVERAL, SINGLE
from tests.benchmarks.editing import SEED
from tests.benchmarks.figure import Figure
from tests.long import is_long, record

COMMAND = "python -m tests.benchmarks"
NEEDS_LINUX = ("served_idle", "served_with_axes_and_threads", "download_shares")
PACED = () if is_long() else NEEDS_LINUX  # they sleep, or wait for the line; the figures to keep are taken alone
SLACK = 2.0


def kept(figure: Figure) -> bool:
    """Whether the figure is good enough for this run."""
    return figure.reached if is_long() else figure.within(SLACK)


def note(figure: Figure, seed: int | None = None) -> None:
    """Writes a figure down and prints it."""
    print(figure)
    record(figure.name, COMMAND, seed, figure.value, figure.unit)


def skip_elsewhere(name: str) -> None:
    """Pseudo-terminals and the time of processes are Linux's."""
    if name in NEEDS_LINUX and not sys.platform.startswith("linux"):
        pytest.skip("measured on Linux")


def marked(measures: Sequence[Callable[[], Any]]) -> list[Any]:
    """Each with its mark and its name."""
    names = [(each, each.__name__) for each in measures]
    return [
        pytest.param(each, id=name, marks=pytest.mark.paced if name in PACED else pytest.mark.alone)
        for each, name in names
    ]


@pytest.mark.parametrize("measure", marked(SINGLE))
def test_speed(measure: Callable[[], Figure]) -> None:
    skip_elsewhere(measure.__name__)
    figure = measure()
    if not kept(figure):  # once more: another process may have been in the way
        figure = measure()
    note(figure, SEED if measure.__name__ == "many_edits" else None)
    assert kept(figure), str(figure)


@pytest.mark.parametrize("measure", marked(SEVERAL))
def test_speeds(measure: Callable[[], list[Figure]]) -> None:
    skip_elsewhere(measure.__name__)
    figures = measure()
    if not all(map(kept, figures)):
        figures = measure()
    for figure in figures:
        note(figure)
    assert all(map(kept, figures)), "; ".join(map(str, figures))
