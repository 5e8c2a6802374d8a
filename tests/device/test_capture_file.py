"""A capture comes back from its file exactly; what is damaged is one sentence."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from codegen.disk import FileUnreadable
from codegen.files import setup_dumps
from codegen.setup import Setup
from codegen.setup_axis import Axis
from device.capture import Capture, Channel
from device.capture_file import dumps, load, loads, save

SETUP = Setup(model="ssc2", name="Sägewerk").with_axis("X", Axis(unit="mm", counts_per_unit="500.5"))
CHANNELS = (Channel("position", "X"), Channel("torque", "Y"), Channel("inputs"))


def taken(values: np.ndarray, **more: object) -> Capture:
    about: dict[str, Any] = {
        "trigger": 2, "early": 1, "trigger_text": "when X begins to move", "model": "ssc2", "setup": SETUP,
        "controller": "DMC1520 “a”, b", "when": "2026-11-22 10:00:00", "complete": False, "note": "a, b\n# c",
    }  # fmt: skip
    return Capture(CHANNELS, values, 3, 250.0, **{**about, **more})  # type: ignore[arg-type]


def same(one: Capture, other: Capture) -> bool:
    names = [name for name in one.__dataclass_fields__ if name not in ("values", "setup")]
    assert all(getattr(one, name) == getattr(other, name) for name in names)
    assert (one.setup is None) == (other.setup is None)
    assert one.setup is None or other.setup is None or setup_dumps(one.setup) == setup_dumps(other.setup)
    return bool(np.array_equal(one.values, other.values, equal_nan=True))


EXAMPLE = taken(np.array([[-2147483648.0, 0.1, 3.0], [9.9998, -0.0001, np.nan], [255.0, 0.0, np.nan]]))


@pytest.mark.parametrize("name", ["one.csv", "one.npz"])
def test_what_is_saved_comes_back(name: str, tmp_path: Path) -> None:
    save(tmp_path / name, EXAMPLE)
    assert same(EXAMPLE, load(tmp_path / name))
    assert [path.name for path in tmp_path.iterdir()] == [name]
    plain = taken(np.zeros((3, 0)), setup=None, trigger=0)
    save(tmp_path / name, plain)
    assert same(plain, load(tmp_path / name))


@given(arrays(np.float64, (3, 4), elements=st.floats(-3e9, 3e9)))
def test_every_number_comes_back_to_the_last_bit(values: np.ndarray) -> None:
    assert same(taken(values), loads(dumps(taken(values))))


def test_a_spreadsheet_finds_times_counts_and_units() -> None:
    lines = dumps(EXAMPLE).splitlines()
    bits = ",".join(f"Input {number}" for number in range(1, 9))
    assert lines[1] == f"time s,Position X counts,Motor command Y V,Inputs,Position X mm,{bits}"
    first = lines[2].split(",")  # two intervals of 8 samples of 250/1 024 000 s before the trigger
    assert float(first[0]) == pytest.approx(-2 * 8 * 250 / 1_024_000)
    assert first[1] == "-2147483648" and float(first[4]) == pytest.approx(-2147483648 / 500.5)
    assert first[5:] == ["1"] * 8 and lines[3].split(",")[5:] == ["0"] * 8 and lines[4].split(",")[5:] == [""] * 8


def as_in_germany(text: str) -> str:
    """Opened by a spreadsheet and saved: semicolons between the cells, decimal commas, quotes doubled."""
    first, *rest = text.splitlines()
    whole = '"' + first.replace('"', '""') + '"'
    return "\n".join([whole, *(line.replace(",", ";").replace(".", ",") for line in rest)]) + "\n"


def told_otherwise(text: str, **more: object) -> str:
    """Something else in the line that says what it is."""
    first, rest = text.split("\n", 1)
    return "# " + json.dumps(json.loads(first.removeprefix("# ")) | more) + "\n" + rest


def without_column(text: str, column: int) -> str:
    """Somebody took one out."""
    first, *rest = text.splitlines()
    cells = [line.split(",") for line in rest]
    return "\n".join([first, *(",".join(line[:column] + line[column + 1 :]) for line in cells)]) + "\n"


@pytest.mark.parametrize(
    ("harm", "words"),
    [
        (lambda text: "", "does not begin"),
        (lambda text: text.replace("twoletter capture", "shopping list"), "does not say"),
        (lambda text: text.replace('"version": 1', '"version": 9'), "newer program"),
        (lambda text: text.rsplit("\n", 2)[0], "were saved"),
        (lambda text: text.replace("9.9998", "9;9998"), "line 3: “9;9998” is not a number"),
        (lambda text: text.replace("9.9998", "inf"), "is not a number"),
        (lambda text: text.replace('["position", "X"]', '["smell", "X"]'), "there is not"),
        (lambda text: text.replace('"exponent": 3', '"exponent": 300'), "exponent is not a number from 1 to 8"),
        (lambda text: text.replace('"tm": 250.0', '"tm": "x"'), "sample time"),
        (lambda text: text.replace('"tm": 250.0', f'"tm": {10**400}'), "sample time"),
        (lambda text: text.replace('"tm": 250.0', '"tm": NaN'), "sample time"),
        (lambda text: text.replace('["position", "X"]', '[[], "X"]'), "there is not"),
        (lambda text: text.replace('["position", "X"]', '["position", "XY"]'), "there is not"),
        (lambda text: text.replace('"model": "ssc2"', '"model": []'), "about itself"),
        (lambda text: text.replace("9.9998", "9,9998"), "line 3 has 14 numbers, 13 belong there"),
        (lambda text: text.replace("9.9998", "9_9998"), "line 3: “9_9998” is not a number"),
        (lambda text: text.replace("9.9998", "٩"), "is not a number"),
        (lambda text: text[:200], "cannot be read"),
        (lambda text: told_otherwise(text, setup=[1]), "setup cannot be read"),
        (
            lambda text: text.replace('["position", "X"]', '["position", "Z"]'),
            "Position Z, which a .* type .ssc2. does not",
        ),
        (
            lambda text: text.replace("Position X counts,Motor command Y V", "Motor command Y V,Position X counts"),
            "line 2, the names of its columns, is missing or was changed, as a spreadsheet",
        ),
        (lambda text: without_column(text, 1), "line 2, the names of its columns"),
        (
            lambda text: "\n".join([*text.splitlines()[:2], *sorted(text.splitlines()[2:], key=lambda line: line[1:])]),
            "its times do not follow each other as they were captured",
        ),
        (lambda text: text.replace('"tm": 250.0', '"tm": 500.0'), "its times do not follow"),
        (lambda text: as_in_germany(text), "its first line was changed, as a spreadsheet does when it saves"),
        (lambda text: "\n".join([text.splitlines()[0], *as_in_germany(text).splitlines()[1:]]), "line 2, the names of"),
    ],
)
def test_a_damaged_text_is_one_sentence(harm, words: str, tmp_path: Path) -> None:  # type: ignore[no-untyped-def]
    path = tmp_path / "x.csv"
    path.write_text(harm(dumps(EXAMPLE)), encoding="utf-8")
    with pytest.raises(FileUnreadable, match=words) as told:
        load(path)
    assert str(told.value).startswith("x.csv is not a capture: ") and "\n" not in str(told.value)


def test_a_damaged_numpy_file_is_one_sentence(tmp_path: Path) -> None:
    path = tmp_path / "x.npz"
    save(path, EXAMPLE)
    whole = path.read_bytes()
    for data in (whole[:300], whole[:50] + b"\0" * 40 + whole[90:], b"PK\3\4", b"\xff\xfe\xff"):
        path.write_bytes(data)
        with pytest.raises(FileUnreadable, match=r"x\.npz is not a capture"):
            load(path)
    with pytest.raises(FileUnreadable, match="cannot be opened"):
        load(tmp_path / "none.csv")


def test_numbers_of_a_numpy_file_that_do_not_belong_together_are_refused(tmp_path: Path) -> None:
    """Somebody has worked on them: other times, fewer channels, whole numbers, more than any memory holds."""
    path = tmp_path / "x.npz"
    save(path, EXAMPLE)
    with np.load(path) as file:
        there = {name: file[name] for name in file.files}
    for more, words in (
        ({"times": there["times"][::-1]}, "its times do not follow each other as they were captured"),
        ({"times": there["times"][:2]}, "its times do not follow"),
        ({"values": there["values"][:2]}, "do not fit its channels"),
        ({"values": np.nan_to_num(there["values"]).astype(np.int64)}, "do not fit its channels"),
        ({"values": there["values"][:, :2]}, "2 values of each channel are there, 3 were saved"),
        ({"about": np.array([1.5])}, "it does not say that it is one"),
    ):
        np.savez(path, **(there | more))
        with pytest.raises(FileUnreadable, match=words) as told:
            load(path)
        assert str(told.value).startswith("x.npz is not a capture: ") and "\n" not in str(told.value)
