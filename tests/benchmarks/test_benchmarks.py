"""The figures of speed keep their bounds (each runs without company)."""

from __future__ import annotations

import sys
from collections.abc import Callable

import pytest

from tests.benchmarks.all import SINGLE
from tests.benchmarks.editing import SEED
from tests.benchmarks.figure import Figure
from tests.benchmarks.start import start_figures
from tests.long import record

COMMAND = "python -m tests.benchmarks"
NEEDS_LINUX = ("served_idle", "download_share")


def note(figure: Figure, seed: int | None = None) -> None:
    """Writes a figure down and prints it."""
    print(figure)
    record(figure.name, COMMAND, seed, figure.value, figure.unit)


@pytest.mark.alone
@pytest.mark.parametrize("measure", SINGLE, ids=lambda each: each.__name__)
def test_speed(measure: Callable[[], Figure]) -> None:
    if measure.__name__ in NEEDS_LINUX and not sys.platform.startswith("linux"):
        pytest.skip("measured on Linux")
    figure = measure()
    if not figure.reached:  # once more: another process may have been in the way
        figure = measure()
    note(figure, SEED if measure.__name__ == "many_edits" else None)
    assert figure.reached, str(figure)


@pytest.mark.alone
def test_start() -> None:
    figures = start_figures()
    if not all(figure.reached for figure in figures):
        figures = start_figures()
    for figure in figures:
        note(figure)
    assert all(figure.reached for figure in figures), "; ".join(map(str, figures))
