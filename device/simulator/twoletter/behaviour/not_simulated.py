"""Commands that this simulator does not carry out yet: each is refused (error 1), with its reason as a notice."""

from __future__ import annotations

from typing import Final

_COMMUTATION = "sine commutation is not part of this version"

REASONS: Final[dict[str, str]] = dict.fromkeys(["BA", "BB", "BC", "BD", "BI", "BM", "BO", "BS", "BZ"], _COMMUTATION)
