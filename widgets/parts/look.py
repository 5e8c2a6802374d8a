"""Colours, spacing and fonts as they are now, for everything that paints itself."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any

from PySide6.QtGui import QColor, QFont, QFontDatabase
from PySide6.QtWidgets import QApplication

PROPERTY = "twoletter_look"

GROUP_TOKENS = {
    "configuration": "group_configuration",
    "i/o": "group_io",
    "io": "group_io",
    "motion": "group_motion",
    "program flow": "group_flow",
    "flow": "group_flow",
    "servo settings": "group_servo",
    "servo": "group_servo",
    "system limits": "group_limits",
    "limits": "group_limits",
    "mathematical equation": "group_math",
    "math": "group_math",
    "2-letter code": "group_raw",
    "raw": "group_raw",
}


@dataclass(frozen=True)
class Look:
    """One theme: `colours` by token, `space` in pixels, `fonts` in points and family names."""

    dark: bool
    colours: Mapping[str, str]
    space: Mapping[str, int]
    fonts: Mapping[str, Any] = field(default_factory=dict)

    def colour(self, token: str) -> QColor:
        """The colour of a token of `theme.toml`."""
        return QColor(self.colours[token])

    def group(self, group: str) -> QColor:
        """The colour of an instruction group, by its title."""
        return self.colour(GROUP_TOKENS.get(group.lower(), "group_raw"))

    def axis(self, letter: str) -> QColor:
        """The colour of an axis, the same in every picture."""
        return self.colour(f"axis_{letter.lower()}")

    @property
    def grid(self) -> int:
        return self.space["grid"]

    @property
    def control(self) -> int:
        return self.space["control"]

    @property
    def body_points(self) -> float:
        return float(self.fonts["body_points"])

    def body_font(self) -> QFont:
        """The font of ordinary text."""
        return _font(self.fonts["body"], self.body_points)

    def small_font(self) -> QFont:
        """For units and remarks beside large digits."""
        return _font(self.fonts["body"], float(self.fonts["small_points"]))

    def code_font(self, points: float | None = None) -> QFont:
        """Monospaced, for two-letter code."""
        font = _font(self.fonts["code"], points or self.body_points)
        font.setStyleHint(QFont.StyleHint.Monospace)
        font.setFixedPitch(True)
        return font

    def digits_font(self, points: float | None = None) -> QFont:
        """Digits of one width, so that a running number does not jitter."""
        font = _font(self.fonts["body"], points or float(self.fonts["digits_points"]))
        font.setFeature(QFont.Tag("tnum"), 1)
        return font


def look() -> Look:
    """The theme that is on now; ask when painting, do not keep it."""
    application = QApplication.instance()
    found = application.property(PROPERTY) if application is not None else None
    if not isinstance(found, Look):
        raise LookupError("no theme is set: app.theme.apply comes first")
    return found


def _font(families: list[str], points: float) -> QFont:
    font = QFont(list(_installed(tuple(families))))
    font.setPointSizeF(points)
    return font


@lru_cache(maxsize=16)
def _installed(families: tuple[str, ...]) -> tuple[str, ...]:
    """Those of the families that this computer has: asking for all of its fonts takes a while."""
    known = set(QFontDatabase.families())
    return tuple(name for name in families if name in known) or families[-1:]
