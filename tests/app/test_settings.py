"""Settings: every row, the file, renamed keys, and files that were tampered with."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from app.settings import ROWS, Row, Settings


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row.key)
def test_every_row_is_complete(row: Row) -> None:
    assert row.problem(row.default) is None
    assert row.label[0].isupper()
    assert row.help.endswith(".")


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row.key)
def test_every_row_survives_the_file(row: Row, tmp_path: Path) -> None:
    other = {str: "x", int: 7, float: 12.5, bool: not row.default, list: ["a"], dict: {"a": "b"}}[row.type]
    value = next((choice for choice in row.choices if choice != row.default), other)
    Settings(tmp_path / "s.json").set(row.key, value)
    assert Settings(tmp_path / "s.json").get(row.key) == value


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row.key)
def test_every_row_refuses_another_type(row: Row, tmp_path: Path) -> None:
    settings = Settings(tmp_path / "s.json")
    with pytest.raises(ValueError, match=row.label):
        settings.set(row.key, None)
    assert settings.get(row.key) == row.default


def test_keys_are_unique_renames_included() -> None:
    names = [name for row in ROWS for name in (row.key, *row.was)]
    assert len(names) == len(set(names))


def test_the_serial_defaults_are_those_of_the_manual_except_the_port(tmp_path: Path) -> None:
    # ssc-tol-o-motion.txt l.1505-1511
    get = Settings(tmp_path / "s.json").get
    assert (get("baud"), get("bits"), get("stop_bits"), get("parity"), get("echo"), get("handshake")) == (
        9600, 8, 1, "none", False, "both",
    )  # fmt: skip


def test_an_earlier_key_is_still_read(tmp_path: Path) -> None:
    path = tmp_path / "s.json"
    path.write_text('{"baud_rate": 19200}')
    assert Settings(path).get("baud") == 19200


def test_what_does_not_fit_is_left_at_its_default_and_said(tmp_path: Path) -> None:
    path = tmp_path / "s.json"
    path.write_text('{"baud": 1234, "theme": "dark"}')
    settings = Settings(path)
    assert settings.get("baud") == 9600
    assert settings.get("theme") == "dark"
    assert "Baud rate" in settings.complaints[0]


def test_a_broken_file_is_said_and_everything_is_at_its_default(tmp_path: Path) -> None:
    path = tmp_path / "s.json"
    path.write_text("{broken")
    settings = Settings(path)
    assert settings.get("theme") == "system"
    assert len(settings.complaints) == 1


def test_keys_of_a_newer_version_are_kept(tmp_path: Path) -> None:
    path = tmp_path / "s.json"
    path.write_text('{"of_tomorrow": 1}')
    Settings(path).set("theme", "dark")
    assert json.loads(path.read_text()) == {"of_tomorrow": 1, "theme": "dark"}


def test_a_folder_that_can_not_be_written_is_a_complaint(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    settings = Settings(tmp_path / "file" / "s.json")
    settings.complaints.clear()
    settings.set("theme", "dark")
    assert settings.get("theme") == "dark"
    assert "could not be saved" in settings.complaints[0]


def test_a_list_that_was_handed_out_is_a_copy(tmp_path: Path) -> None:
    settings = Settings(tmp_path / "s.json")
    settings.get("ports_used").append("COM1")
    assert settings.get("ports_used") == []
