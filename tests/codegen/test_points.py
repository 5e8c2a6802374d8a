"""Saved points as text: what is kept comes back, in the unit it was saved in, or not at all."""

from __future__ import annotations

import dataclasses as dc
import json

import pytest

from codegen.points import PointsUnreadable, counts_of, dumps, loads, name_problem, point_at
from codegen.setup import Setup, Unit

MM = dc.replace(Setup().axes[0], unit=Unit.MM, counts_per_unit="1000")
TABLE = Setup(model="ssc2", axes=(MM, dc.replace(MM, counts_per_unit="637"), MM, MM))


def test_a_point_comes_back_to_the_count() -> None:
    point = point_at(" Load ", {"Y": -1234, "X": 12_345}, TABLE)
    assert point.name == "Load" and point.places[0].number == "12.345" and point.places[0].unit == "mm"
    (read,) = loads(dumps([point]))
    assert read == point
    assert counts_of(read, TABLE, "XY") == {"X": 12_345, "Y": -1234}


def test_a_number_is_never_read_in_another_unit() -> None:
    point = point_at("Load", {"X": 25_400}, TABLE)
    inches = dc.replace(TABLE, axes=(dc.replace(MM, unit=Unit.INCH),) * 4)
    problem = counts_of(point, inches, "XY")
    assert isinstance(problem, str) and "saved in “mm”" in problem and "“in” now" in problem
    finer = dc.replace(TABLE, axes=(dc.replace(MM, counts_per_unit="2000"),) * 4)
    assert counts_of(point, finer, "XY") == {"X": 50_800}  # the same 25.4 mm
    missing = counts_of(point_at("Y", {"Y": 1}, TABLE), TABLE, "X")
    assert isinstance(missing, str) and "axis Y" in missing


@pytest.mark.parametrize("damage", ["{", "[]", '{"kind": "twoletter recipe", "version": 1, "points": []}', "null"])
def test_a_damaged_file_is_a_sentence(damage: str) -> None:
    with pytest.raises(PointsUnreadable):
        loads(damage)


@pytest.mark.parametrize(("key", "value"), [("axis", "XY"), ("axis", 5), ("number", 5), ("unit", None)])
def test_what_is_no_place_is_not_taken_for_one(key: str, value: object) -> None:
    found = json.loads(dumps([point_at("A", {"X": 1}, TABLE)]))
    found["points"][0]["places"][0][key] = value
    with pytest.raises(PointsUnreadable):
        loads(json.dumps(found))


def test_a_newer_file_is_left_alone() -> None:
    found = json.loads(dumps([]))
    with pytest.raises(PointsUnreadable, match="newer"):
        loads(json.dumps({**found, "version": 2}))


def test_names() -> None:
    assert name_problem("  ", []) and name_problem("a" * 41, []) and name_problem("a\nb", [])
    assert "already" in name_problem("load ", ["Load"])
    assert name_problem("Load 2", ["Load"]) == ""
