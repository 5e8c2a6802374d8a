"""The last line of a program whose speeds were scaled down for a first run; by it anybody knows it again."""

from __future__ import annotations

import re
from collections.abc import Sequence

FULL = 100
MARK = "NO SLOWED TO {} PERCENT"  # sent to the controller, unlike REM; behind the last EN nothing runs it
FOUND = re.compile("^" + MARK.format(r"(\d+)") + "$", re.MULTILINE)
BURNS = frozenset({"BN", "BP"})  # what would keep slowed speeds, or the slowed program


def percent_of(text: str) -> int:
    """How far the code of a program is slowed: 100 when it is not."""
    found = FOUND.search(text.replace("\r", "")) if "SLOWED" in text else None
    return int(found[1]) if found else FULL


def mark_of(lines: Sequence[str]) -> str:
    """ "slowed to 25 %" for the lines of a slowed program, else nothing; the mark is the last of them."""
    percent = percent_of(lines[-1].strip()) if lines else FULL
    return f"slowed to {percent} %" if percent < FULL else ""
