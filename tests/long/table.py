"""The README's table of figures, written from the file of results: `python -m tests.long.table`."""

from __future__ import annotations

import json
import sys
from pathlib import Path

from tests.long import RESULTS

MANY = 4  # figures of one kind from which on they share a line
README = Path(__file__).resolve().parents[2] / "README.md"
BEGIN, END = "<!-- figures: begin -->", "<!-- figures: end -->"


def rows_of(results: Path = RESULTS) -> list[dict[str, object]]:
    """The measured figures; none where nothing was measured yet."""
    return json.loads(results.read_text(encoding="utf-8")) if results.exists() else []  # type: ignore[no-any-return]


def table(rows: list[dict[str, object]]) -> str:
    """The figures as a table; what was measured of many machines stands in one line, from the least to the most."""
    lines = ["| what | measured | on | with |", "|---|---|---|---|"]
    families: dict[tuple[str, str], list[dict[str, object]]] = {}
    for row in rows:
        families.setdefault(_family(str(row["name"])), []).append(row)
    for (head, what), members in families.items():
        many = [members] if len(members) >= MANY else [[row] for row in members]
        for some in many:
            name = some[0]["name"] if len(some) == 1 else f"{head}, {len(some)} of them" + what
            figures = [float(str(row["figure"])) for row in some]
            measured = " to ".join(f"{figure:.4g}" for figure in sorted({min(figures), max(figures)}))
            last = some[-1]
            lines.append(f"| {name} | {measured} {last['unit']} | {last['date']} | `{last['command']}` |")
    return "\n".join(lines)


def _family(name: str) -> tuple[str, str]:
    """What is the same in "tuning, this machine: settling" and "tuning, that machine: settling"."""
    head, _, rest = name.partition(", ")
    _, colon, what = rest.rpartition(": ")
    return head, colon + what if colon else ""


def with_table(text: str, rows: list[dict[str, object]]) -> str:
    """The README with its table between the two marks."""
    before, _, rest = text.partition(BEGIN)
    _, _, after = rest.partition(END)
    return f"{before}{BEGIN}\n{table(rows)}\n{END}{after}"


def main() -> int:
    """Writes the table."""
    README.write_text(with_table(README.read_text(encoding="utf-8"), rows_of()), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
