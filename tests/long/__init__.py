"""Counts and figures of the short and the long run of the tests."""

from __future__ import annotations

import datetime
import json
import os
from pathlib import Path

RESULTS = Path(__file__).with_name("results.json")


def is_long() -> bool:
    """True in `./studio test --long`."""
    return os.environ.get("TWOLETTER_LONG") == "1"


def count(short: int, long: int) -> int:
    """How many rounds a test does: short in the everyday run, long in the full one."""
    return long if is_long() else short


def record(name: str, command: str, seed: int | None, figure: float, unit: str, *, add: bool = False) -> None:
    """Notes one measured figure for the table of results; does nothing outside a run that collects them.

    Figures that are to `add` come from several tests of a run and are summed.
    """
    folder = os.environ.get("TWOLETTER_FIGURES")
    if not folder:
        return
    row = {
        "name": name,
        "command": command,
        "seed": seed,
        "figure": round(float(figure), 4),
        "unit": unit,
        "date": datetime.date.today().isoformat(),
        **({"add": True} if add else {}),
    }
    with (Path(folder) / f"{os.getpid()}.jsonl").open("a", encoding="utf-8") as file:
        file.write(json.dumps(row) + "\n")


def collect(folder: Path, results: Path = RESULTS) -> list[dict[str, object]]:
    """Joins the figures noted in a folder into the file of results; a name measured again replaces the older row."""
    known: dict[str, dict[str, object]] = {}
    if results.exists():
        known = {row["name"]: row for row in json.loads(results.read_text(encoding="utf-8"))}
    sums: dict[str, float] = {}
    for part in sorted(folder.glob("*.jsonl")):
        for line in part.read_text(encoding="utf-8").splitlines():
            row = json.loads(line)
            if row.pop("add", False):
                row["figure"] = sums[row["name"]] = sums.get(row["name"], 0) + row["figure"]
            known[row["name"]] = row
    rows = [known[name] for name in sorted(known)]
    results.write_text(json.dumps(rows, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    return rows
