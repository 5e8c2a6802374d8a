"""A long run says how far it is, and goes on where it was interrupted (`./studio test --long --resume`)."""

from __future__ import annotations

import hashlib
import os
import shutil
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / ".pytest_cache" / "long"
SOURCES = ("app", "codegen", "device", "resources", "tests", "widgets")
TOLD_S = 10.0  # a test as long as that gets a line of its own
SILENT_S = 60.0


def fingerprint() -> str:
    """Of everything that can change what a test says."""
    found = hashlib.sha256()
    for folder in SOURCES:
        for path in sorted((ROOT / folder).rglob("*")):
            if path.is_file() and "__pycache__" not in path.parts and path.name != "results.json":
                found.update(f"{path.relative_to(ROOT)}\n".encode())
                found.update(path.read_bytes())
    return found.hexdigest()


@contextmanager
def kept(resume: bool) -> Iterator[Path]:
    """The folder of a long run: its figures, and what has passed; a change of the sources begins it anew."""
    now, mark = fingerprint(), FOLDER / "sources"
    known = mark.read_text(encoding="utf-8") if mark.exists() else ""
    if resume and known and known != now:
        print("-- the sources have changed since the interruption: everything is run again")
    if not resume or known != now:
        shutil.rmtree(FOLDER, ignore_errors=True)
    (FOLDER / "figures").mkdir(parents=True, exist_ok=True)
    mark.write_text(now, encoding="utf-8")
    yield FOLDER


def lines(path: Path) -> set[str]:
    """The lines of a file that may not be there yet."""
    return set(path.read_text(encoding="utf-8").splitlines()) if path.exists() else set()


def begin_part(folder: Path) -> None:
    """What has passed up to here is left out; every process of the part reads the same list."""
    (folder / "before").write_text("\n".join(sorted(lines(folder / "passed"))), encoding="utf-8")


class Progress:
    """Lines of progress, and the list of what has passed; lives in the process that hears of every test."""

    def __init__(self, config: pytest.Config, folder: Path) -> None:
        self._config, self._folder = config, folder
        self._total = self._done = 0
        self._began = self._told = time.monotonic()

    def pytest_collection_finish(self, session: pytest.Session) -> None:
        self._total = self._total or len(session.items)

    @pytest.hookimpl(optionalhook=True)
    def pytest_xdist_node_collection_finished(self, node: object, ids: list[str]) -> None:
        self._total = len(ids)

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.when != "call" and not (report.when == "setup" and report.outcome != "passed"):
            return
        self._done += 1
        if report.outcome != "failed":
            with (self._folder / "passed").open("a", encoding="utf-8") as file:
                file.write(report.nodeid + "\n")
        now = time.monotonic()
        if report.duration >= TOLD_S or now - self._told >= SILENT_S:
            self._told = now
            self._tell(report, now - self._began)

    def _tell(self, report: pytest.TestReport, seconds: float) -> None:
        reporter = self._config.pluginmanager.get_plugin("terminalreporter")
        if reporter is not None:
            reporter.ensure_newline()
            reporter.write_line(
                f"{self._done} of {self._total} after {seconds / 60:.1f} min: "
                f"{report.nodeid} {report.outcome} in {report.duration:.0f} s"
            )


def pytest_configure(config: pytest.Config) -> None:
    folder = os.environ.get("TWOLETTER_LONG_RUN")
    if folder and not hasattr(config, "workerinput"):
        config.pluginmanager.register(Progress(config, Path(folder)))


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leaves out what passed before the interruption."""
    folder = os.environ.get("TWOLETTER_LONG_RUN")
    before = lines(Path(folder) / "before") if folder else set()
    left = [item for item in items if item.nodeid not in before]
    if len(left) < len(items):
        config.hook.pytest_deselected(items=[item for item in items if item.nodeid in before])
        items[:] = left
