"""The logbook as it is found on disk: whole runs come back, whatever stands between them is skipped and counted."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from device.former import SUFFIX, left_behind
from device.tuning.entry import Entry, to_data
from device.tuning.logbook import Logbook
from device.tuning.loop import Gains
from device.tuning.metrics import Metrics, Response

RESPONSE = Response(0.002, np.array([0.0, 100.0, 100.0]), np.array([0.0, 60.0, 99.0]), np.array([0.0, 9.5, 0.25]))
RUN = Entry(
    0, "2026-11-23T03:00:00", "Y", "manual", Gains(kp=7.5), 100, RESPONSE, Metrics(100, None, 0, None, 1, 40, 0)
)
ODD: tuple[Any, ...] = (None, True, "7", [], {}, [1], {"a": 1}, -1, 10**400, float("nan"), float("inf"), 0)


@pytest.fixture
def book(tmp_path: Path) -> Logbook:
    made = Logbook(tmp_path / "serial 1.tuning.jsonl")
    made.add(RUN)
    return made


def drawn(entry: Entry) -> bool:
    """What panel and report need of a run, so that they never stumble over one."""
    response, numbers = entry.response, [*vars(entry.gains).values()]
    same = 2 <= len(response.commanded) == len(response.actual) == len(response.volts)
    return entry.axis in "XYZW" and same and response.period > 0 and all(isinstance(each, float) for each in numbers)


def test_runs_and_notes_come_back(book: Logbook) -> None:
    book.add(RUN)
    book.note(2, "Belt loose")
    again = Logbook(book.file)
    assert [(each.number, each.note) for each in again.entries] == [(1, ""), (2, "Belt loose")] and not again.skipped
    assert again.entries[0].gains == RUN.gains and again.entries[0].metrics == RUN.metrics
    np.testing.assert_array_equal(again.entries[1].response.actual, RESPONSE.actual)


@pytest.mark.parametrize(
    "line",
    [b"[1]", b"5", b"null", b'"run"', b'{"run": []}', b'{"note": 1}', b'{"note": 1e400, "text": "a"}', b"\xff\xfe",
     b"[" * 100_000, b'{"run"'],
)  # fmt: skip
def test_a_line_that_is_none_is_skipped(book: Logbook, line: bytes) -> None:
    whole = book.file.read_bytes()
    book.file.write_bytes(whole + line + b"\n" + whole)
    found = Logbook(book.file)
    assert len(found.entries) == 2 and found.skipped == 1
    assert found.add(RUN).number == 2 and Logbook(book.file).skipped == 1  # what stood there stays


@pytest.mark.parametrize("name", [*to_data(RUN), "gains.kp", "metrics.step", "metrics.rise_time"])
def test_a_run_is_whole_or_none(book: Logbook, name: str) -> None:
    for odd in ODD:
        data = json.loads(json.dumps(to_data(RUN)))
        place, _, inner = name.partition(".")
        data.update({place: {**data[place], inner: odd}} if inner else {place: odd})
        book.file.write_text(json.dumps({"run": data}) + "\n", encoding="utf-8")
        assert all(drawn(each) for each in Logbook(book.file).entries), odd


def test_a_logbook_that_can_not_be_read_is_an_empty_one(tmp_path: Path) -> None:
    (tmp_path / "serial 1.tuning.jsonl").mkdir()
    found = Logbook(tmp_path / "serial 1.tuning.jsonl")
    assert found.entries == () and found.skipped == 1


@pytest.mark.parametrize("text", ["", "[]", "5", "[" * 100_000, '{"values": {"KP": 1e400}}', '{"values": 3}'])
def test_former_values_that_are_damaged_are_not_offered(tmp_path: Path, text: str) -> None:
    (tmp_path / f"x{SUFFIX}").write_text(text, encoding="utf-8")
    assert left_behind(tmp_path) == ()
