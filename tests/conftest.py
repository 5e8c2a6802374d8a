"""What every test gets: an off-screen display, hypothesis without deadlines, the options of the run."""

from __future__ import annotations

import gc
import os
from pathlib import Path

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

import pytest
from hypothesis import HealthCheck, settings

from app.rubbish import Rubbish
from tests.long import is_long

ROOT = Path(__file__).parent
WINDOWS = ("app", "widgets", "benchmarks")  # the folders whose tests make windows

# The everyday run draws the same examples every time, so that it says the same of the same code; the long run searches.
settings.register_profile(
    "short", deadline=None, max_examples=50, derandomize=True, suppress_health_check=[HealthCheck.too_slow]
)
settings.register_profile("long", deadline=None, max_examples=1000, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("long" if is_long() else "short")


def pytest_addoption(parser: pytest.Parser) -> None:
    """Options of this project's tests."""
    parser.addoption("--approve", action="store_true", help="rewrite the golden files with what comes out now")
    parser.addoption("--port", default=None, help="a real controller's port, for tests ending in _with_device")


@pytest.fixture
def approve(request: pytest.FixtureRequest) -> bool:
    """True when golden files are to be rewritten."""
    return bool(request.config.getoption("--approve"))


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """A run of one mark (`-m "alone and …"`) opens only the files that speak of it: reading them all takes long."""
    mark = str(config.option.markexpr).partition(" ")[0]
    if mark in ("alone", "paced") and collection_path.name.startswith("test_"):
        return f"mark.{mark}" not in collection_path.read_text(encoding="utf-8") or None
    return None


def pytest_collection_finish() -> None:
    """What was collected stays to the end: the garbage collector need not look at it again and again."""
    gc.collect()
    gc.freeze()


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    """Garbage of the window is looked for in its own thread, as in the program; elsewhere Python does as it likes.

    A window that a test left open stays to the end: a thread of a later test that freed it would crash the run.
    """
    if item.path.relative_to(ROOT).parts[0] in WINDOWS:
        gc.disable()
        Rubbish().look()
    elif not gc.isenabled():
        gc.collect()
        gc.freeze()
        gc.enable()


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Skips what needs a device that is not there, or the long run."""
    for item in items:
        if item.name.split("[")[0].endswith("_with_device") and not config.getoption("--port"):
            item.add_marker(pytest.mark.skip(reason="needs a controller (--port)"))
        if item.get_closest_marker("long") and not is_long():
            item.add_marker(pytest.mark.skip(reason="only in the long run"))
