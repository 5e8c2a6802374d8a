"""The README's table of figures, written from the file of results: `python -m tests.long.table`."""

from __future__ import annotations

import json
import sys
from pathlib import Path

from tests.long import RESULTS

README = Path(__file__).resolve().parents[2] / "README.md"
BEGIN, END = "<!-- figures: begin -->", "<!-- figures: end -->"


def rows_of(results: Path = RESULTS) -> list[dict[str, object]]:
    """The measured figures; none where nothing was measured yet."""
    return json.loads(results.read_text(encoding="utf-8")) if results.exists() else []  # type: ignore[no-any-return]


def table(rows: list[dict[str, object]]) -> str:
    """The figures as a table."""
    lines = ["| what | measured | on | with |", "|---|---|---|---|"]
    for row in rows:
        lines.append(f"| {row['name']} | {row['figure']:.4g} {row['unit']} | {row['date']} | `{row['command']}` |")
    return "\n".join(lines)


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
