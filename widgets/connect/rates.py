"""Baud rates a controller can be set to, and its switches for each (Tol-O-Motion manual, chapter 5, l.1518-1526)."""

from __future__ import annotations

# rate: (switch 2 "1200", switch 3 "9600", switch 4 "19.2K")
RATES: dict[int, tuple[bool, bool, bool]] = {
    300: (True, True, False),
    1200: (True, False, False),
    4800: (True, False, True),
    9600: (False, True, False),
    19200: (False, False, True),
    38400: (False, True, True),
}
