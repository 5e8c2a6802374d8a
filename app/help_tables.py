"""Help pages of the tables typed from the manuals: connectors, wiring, troubleshooting."""

from __future__ import annotations

import tomllib
from functools import cache
from typing import Any

import resources

FOLDER = "tables"
PER_ROW = 2  # pins side by side


@cache
def table(name: str) -> dict[str, Any]:
    """A file of tables."""
    return tomllib.loads(resources.path(f"{FOLDER}/{name}.toml").read_text(encoding="utf-8"))


def pages() -> dict[str, str]:
    """All of these pages by title."""
    wiring = table("wiring")
    titles = dict.fromkeys(each["page"] for each in wiring["connector"])
    found = {title: _connectors(title, wiring) for title in titles}
    found["Troubleshooting"] = _troubleshooting()
    return found


def advice(kind: str, code: int) -> str:
    """What to do about an error or a stop code; nothing where there is nothing to do."""
    return str(table("troubleshooting")["advice"][kind].get(str(code), ""))


def pin(connector: str, number: int) -> str:
    """What is on a pin of a connector, by the connector's title."""
    found = next(each for each in table("wiring")["connector"] if each["title"] == connector)
    return str(found["pins"][number - 1])


def _connectors(title: str, wiring: dict[str, Any]) -> str:
    parts = [
        f"# {title}",
        "Switch the power off before you connect anything. The tables are typed from the manuals; "
        "where your controller's own manual says something else, believe that.",
    ]
    parts += [_connector(each) for each in wiring["connector"] if each["page"] == title]
    parts += [_wires(each) for each in wiring["wiring"] if each["page"] == title]
    return "\n\n".join(parts) + "\n"


def _connector(connector: dict[str, Any]) -> str:
    """Two pins in a row, as they lie on a ribbon cable."""
    cells = [(str(number), words) for number, words in enumerate(connector["pins"], 1)]
    rows = [cells[start : start + PER_ROW] for start in range(0, len(cells), PER_ROW)]
    head = _row(["pin", "signal"] * PER_ROW)
    lines = [head, _row(["---"] * 2 * PER_ROW)]
    for row in rows:
        filled = [*row, *[("", "")] * (PER_ROW - len(row))]
        lines.append(_row([text for cell in filled for text in cell]))
    return "\n\n".join([f"## {connector['title']}", "\n".join(lines), _source(connector)])


def _wires(wires: dict[str, Any]) -> str:
    lines = [_row(wires["columns"]), _row(["---"] * len(wires["columns"])), *map(_row, wires["rows"])]
    return "\n\n".join([f"## Connecting: {wires['title']}", "\n".join(lines), _source(wires)])


def _source(entry: dict[str, Any]) -> str:
    note = f"{entry['note']} " if entry.get("note") else ""
    return f"{note}*Source: {entry['lines']}.*"


def _row(cells: list[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _troubleshooting() -> str:
    troubles = table("troubleshooting")["trouble"]
    parts = [
        "# Troubleshooting",
        "Find what you see on the left. What the controller itself says stands under "
        "[Error and stop codes](page:Error%20and%20stop%20codes); what goes over the line "
        "under [Terminal](page:Terminal).",
    ]
    for group in dict.fromkeys(each["group"] for each in troubles):
        lines = [_row(["what you see", "what gives it away", "cause", "what to do"]), _row(["---"] * 4)]
        for each in troubles:
            if each["group"] == group:
                lines += [
                    _row([each["symptom"] if not number else "", each["sign"] if not number else "", *cause])
                    for number, cause in enumerate(each["causes"])
                ]
        parts.append(f"## {group}\n\n" + "\n".join(lines))
    parts.append("*Source: dmc-1412-1414.txt, chapter 9, l.4213-4259.*")
    return "\n\n".join(parts) + "\n"
