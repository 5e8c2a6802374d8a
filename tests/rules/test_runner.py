"""The one command that runs everything adds up what its parts report."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.__main__ import Totals, summary
from tests.long import collect, count, record
from tests.long.table import BEGIN, END, with_table

REPORT = (
    """<testsuites><testsuite name="pytest" tests="7" failures="2" errors="1" skipped="1" time="1"/></testsuites>"""
)


def test_reports_are_added_up(tmp_path: Path) -> None:
    report = tmp_path / "report.xml"
    report.write_text(REPORT)
    totals = Totals()
    totals.add(report)
    totals.add(report)
    assert (totals.passed, totals.failed, totals.errors, totals.skipped) == (6, 4, 2, 2)
    assert "4 failed, 6 passed, 2 skipped, 2 errors in 3.00s" in summary(totals, 3)


def test_a_broken_check_is_named() -> None:
    totals = Totals(passed=3, broken=["ruff check"])
    assert "3 passed, ruff check FAILED in 1.50s" in summary(totals, 1.5)


def test_figures_are_collected_and_the_newest_stays(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TWOLETTER_FIGURES", str(tmp_path))
    results = tmp_path / "results.json"
    results.write_text(json.dumps([{"name": "old", "figure": 1}, {"name": "loop", "figure": 1}]))
    record("loop", "python -m tests.benchmarks", 7, 250.123456, "×")
    rows = collect(tmp_path, results)
    assert [row["name"] for row in rows] == ["loop", "old"]
    assert rows[0]["figure"] == 250.1235 and rows[0]["seed"] == 7 and json.loads(results.read_text()) == rows


def test_figures_of_many_tests_are_added_up(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TWOLETTER_FIGURES", str(tmp_path))
    results = tmp_path / "results.json"
    results.write_text(json.dumps([{"name": "seeds", "figure": 900}]))
    for steps in (100, 20, 3):
        record("seeds", "pytest", None, steps, "steps", add=True)
    (row,) = collect(tmp_path, results)
    assert row["figure"] == 123 and "add" not in row


def test_counts_are_short_unless_the_run_is_long(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("TWOLETTER_LONG", raising=False)
    assert count(10, 1000) == 10
    monkeypatch.setenv("TWOLETTER_LONG", "1")
    assert count(10, 1000) == 1000


def test_the_table_replaces_what_stood_between_the_marks() -> None:
    row = {"name": "loop", "figure": 250.1, "unit": "×", "date": "2026-01-01", "command": "x"}
    text = with_table(f"a\n{BEGIN}\nold\n{END}\nb\n", [row])
    assert "old" not in text and "| loop | 250.1 × |" in text and text.startswith("a\n") and text.endswith("\nb\n")
