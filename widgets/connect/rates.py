"""Baud rates a controller can be set to (the table is the language's)."""

from __future__ import annotations

from codegen.rates import RATES as RATES
