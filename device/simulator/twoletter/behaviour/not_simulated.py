"""Commands that this simulator does not carry out yet: each is refused (error 1), with its reason as a notice."""

from __future__ import annotations

from typing import Final

_COORDINATED = "coordinated motion is not part of this version"
_CONTOUR = "contour mode is not part of this version"
_CAM = "electronic cam is not part of this version"
_GEAR = "gearing is not part of this version"
_RECORD = "automatic capture is not part of this version"
_LATCH = "the position latch is not part of this version"
_COMMUTATION = "sine commutation is not part of this version"

REASONS: Final[dict[str, str]] = {
    **dict.fromkeys(
        ["LM", "LI", "LE", "VM", "VP", "CR", "VE", "VS", "VA", "VD", "VR", "VT", "ES", "TN", "CS", "AV"], _COORDINATED
    ),
    **dict.fromkeys(["CM", "CD", "DT", "WC"], _CONTOUR),
    **dict.fromkeys(["EA", "EM", "EP", "ET", "EB", "EG", "EQ"], _CAM),
    **dict.fromkeys(["GA", "GR"], _GEAR),
    **dict.fromkeys(["RA", "RD", "RC"], _RECORD),
    **dict.fromkeys(["AL", "RL"], _LATCH),
    **dict.fromkeys(["BA", "BB", "BC", "BD", "BI", "BM", "BO", "BS", "BZ"], _COMMUTATION),
}
