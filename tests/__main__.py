"""Runs every check of the project: `python -m tests [--long]`."""

from __future__ import annotations

import argparse
import importlib.util
import os
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree as ElementTree
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeAlias

from tests.long import collect
from tests.long.progress import begin_part, kept
from tests.long.table import main as write_table

ROOT = Path(__file__).resolve().parent.parent
CHECKS = (
    ("ruff check", ("-m", "ruff", "check", ".")),
    ("ruff format", ("-m", "ruff", "format", "--check", "--quiet", ".")),
    ("mypy --strict", ("-m", "mypy", "--strict", "codegen", "device")),
)
# title, marks, processes; what waits for a line leaves the processors free, so that several of them fit side by side
PARTS = (
    ("tests", "not alone and not paced", max(2, min(os.cpu_count() or 2, 8))),
    ("tests that wait for a line or a clock", "paced and not alone", 5),
    ("tests that measure time", "alone", 0),
)
NOTHING_COLLECTED = 5
Checked: TypeAlias = list[tuple[str, subprocess.CompletedProcess[str]]]  # name and outcome of each static check


@dataclass
class Totals:
    """What all parts of the run came to."""

    passed: int = 0
    failed: int = 0
    errors: int = 0
    skipped: int = 0
    broken: list[str] = field(default_factory=list)

    def add(self, report: Path) -> None:
        """Adds the counts of one pytest report."""
        for suite in ElementTree.parse(report).getroot().iter("testsuite"):
            tests, failed, errors, skipped = (
                int(suite.get(key, "0")) for key in ("tests", "failures", "errors", "skipped")
            )
            self.passed += tests - failed - errors - skipped
            self.failed += failed
            self.errors += errors
            self.skipped += skipped


def run_checks() -> Checked:
    """Runs the static checks one after the other."""
    return [
        (name, subprocess.run([sys.executable, *arguments], cwd=ROOT, capture_output=True, text=True))
        for name, arguments in CHECKS
    ]


def tell_checks(checks: Future[Checked], totals: Totals) -> None:
    """Waits for the static checks and shows what they said only where they failed."""
    for name, done in checks.result():
        print(f"{name}: {'ok' if done.returncode == 0 else 'FAILED'}", flush=True)
        if done.returncode:
            print(done.stdout + done.stderr, flush=True)
            totals.broken.append(name)


def run_tests(title: str, arguments: list[str], environment: dict[str, str], totals: Totals) -> None:
    """Runs pytest once and adds up what it reports."""
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.xml"
        command = [sys.executable, "-m", "pytest", f"--junitxml={report}", *arguments]
        print(f"-- {title}", flush=True)
        code = subprocess.run(command, cwd=ROOT, env=environment).returncode
        if report.exists():
            totals.add(report)
        if code not in (0, 1, NOTHING_COLLECTED) or (code == 1 and not totals.failed + totals.errors):
            totals.broken.append(f"{title} (pytest ended with {code})")


def summary(totals: Totals, seconds: float) -> str:
    """The closing line, in pytest's own form."""
    counts = (
        (totals.failed, "failed"),
        (totals.passed, "passed"),
        (totals.skipped, "skipped"),
        (totals.errors, "errors"),
    )
    words = [f"{number} {word}" for number, word in counts if number]
    words += [f"{name} FAILED" for name in totals.broken]
    return f" {', '.join(words) or 'nothing ran'} in {seconds:.2f}s ".center(100, "=")


def workers(number: int) -> list[str]:
    """So many test processes where the plug-in is there; each takes its next test when it has ended one."""
    return ["-n", str(number), "--dist", "worksteal"] if number and importlib.util.find_spec("xdist") else []


def run_everyday(chosen: list[str], totals: Totals, checks: Future[Checked]) -> None:
    """All parts with the short counts, one after the other: what keeps a pace needs the processors when it wakes.

    The static checks need one processor for a while: they run beside the first part, which measures no time.
    """
    environment = dict(os.environ, QT_QPA_PLATFORM="offscreen")
    environment.pop("TWOLETTER_LONG", None)
    for place, (title, marks, number) in enumerate(PARTS):
        compiled = {} if marks == "alone" else {"TEST_COMPILED": "1"}  # tests/rig.py
        run_tests(title, [*workers(number), "-m", marks, *chosen], environment | compiled, totals)
        if place == 0:
            tell_checks(checks, totals)


def run_long(chosen: list[str], totals: Totals, *, resume: bool) -> None:
    """All parts with the full counts; the figures of whatever was run are written, also after an interruption."""
    with kept(resume) as folder:
        figures = folder / "figures"
        environment = dict(
            os.environ,
            QT_QPA_PLATFORM="offscreen",
            TWOLETTER_LONG="1",
            TWOLETTER_FIGURES=str(figures),
            TWOLETTER_LONG_RUN=str(folder),
        )
        try:
            for title, marks, number in PARTS:
                begin_part(folder)
                more = ["-p", "tests.long.progress", "--timeout=7200", "-m", marks]
                run_tests(title, [*workers(number), *more, *chosen], environment, totals)
        finally:
            print(f"{len(collect(figures))} figures in tests/long/results.json")
            write_table()


def main(argv: list[str] | None = None) -> int:
    """Runs everything and returns 0 only when all of it is right."""
    parser = argparse.ArgumentParser(prog="./studio test", description="Runs every check of the project.")
    parser.add_argument("--long", action="store_true", help="full counts; writes tests/long/results.json")
    parser.add_argument("--resume", action="store_true", help="with --long: leaves out what passed before it was ended")
    parser.add_argument("rest", nargs="*", help="only these tests (files or folders)")
    options, extra = parser.parse_known_args(argv)
    started = time.monotonic()
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)  # hundreds of processes would compile everything again
    totals = Totals()
    chosen = [*options.rest, *extra]
    with ThreadPoolExecutor(1) as beside:
        checks = beside.submit(run_checks)
        if options.long:
            tell_checks(checks, totals)
            run_long(chosen, totals, resume=options.resume)
        else:
            run_everyday(chosen, totals, checks)
    print(summary(totals, time.monotonic() - started))
    return 1 if totals.failed or totals.errors or totals.broken or not totals.passed else 0


if __name__ == "__main__":
    sys.exit(main())
