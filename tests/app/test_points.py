"""The file of saved points: one for each machine, written whole, and never over what cannot be read."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.points import Points, file_name
from codegen.setup import Setup

ONE, OTHER = Setup(name="Table 1", serial_number="4711"), Setup(name="Table 2")


def test_points_belong_to_their_machine_and_stay(tmp_path: Path) -> None:
    points = Points(tmp_path / "points")
    assert points.open(ONE) == "" and points.points == ()
    assert points.save_here("Load", {"X": 100}, ONE) == ""
    assert points.save_here("Park", {"X": 200}, ONE) == ""
    assert "already" in points.save_here("load", {"X": 1}, ONE)
    assert points.rename("Park", "Home side") == ""
    assert "already" in points.rename("Home side", "LOAD")
    assert points.open(OTHER) == "" and points.points == ()
    again = Points(tmp_path / "points")
    assert again.open(ONE) == ""
    assert [each.name for each in again.points] == ["Load", "Home side"]
    assert again.delete("Load") == ""
    assert [each.name for each in again.points] == ["Home side"]
    assert [path.name for path in (tmp_path / "points").iterdir()] == ["table-1-4711.json"]


def test_a_damaged_file_is_said_and_not_written_over(tmp_path: Path) -> None:
    path = tmp_path / "table-2.json"
    path.write_text("{", encoding="utf-8")
    points = Points(tmp_path)
    assert str(path) in points.open(OTHER)
    assert "not" in points.save_here("A", {"X": 1}, OTHER).lower()
    assert path.read_text(encoding="utf-8") == "{"


def test_a_folder_that_can_not_be_written_to_loses_nothing(tmp_path: Path) -> None:
    (tmp_path / "points").write_text("a file, not a folder", encoding="utf-8")
    points = Points(tmp_path / "points")
    points.open(OTHER)
    assert "cannot be saved" in points.save_here("A", {"X": 1}, OTHER) or points.points == ()
    assert points.points == ()


@pytest.mark.parametrize(
    ("name", "number", "file"), [("Säge/3", "", "s-ge-3"), ("", "12", "ssc4-12"), ("..", "", "ssc4")]
)
def test_any_name_makes_a_file_name(name: str, number: str, file: str) -> None:
    assert file_name(Setup(name=name, serial_number=number)) == file
