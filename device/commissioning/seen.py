"""What was seen while the person moved something by hand: readings are added one by one, nothing is sent."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Mapping

SWITCHES = {"forward": "forward limit", "reverse": "reverse limit", "home": "home"}
NOTHING, NOT_FITTED, RIGHT = "nothing", "not fitted", "right"


@dc.dataclass(frozen=True, slots=True)
class Turned:
    """The position while an axis is moved by hand, counts."""

    first: int | None = None
    last: int = 0
    low: int = 0
    high: int = 0
    changes: int = 0

    def with_reading(self, counts: int) -> Turned:
        """One reading more."""
        if self.first is None:
            return Turned(counts, counts, counts, counts)
        if counts == self.last:
            return self
        return Turned(self.first, counts, min(self.low, counts), max(self.high, counts), self.changes + 1)

    @property
    def moved(self) -> int:
        return 0 if self.first is None else self.last - self.first

    @property
    def range(self) -> int:
        return self.high - self.low


@dc.dataclass(frozen=True, slots=True)
class Switches:
    """The three inputs while switches are tripped one after the other; levels as _LF, _LR and _HM tell them.

    `outcome` of a switch: right, nothing, not fitted, or the name of the input that changed in its place.
    """

    rest: Mapping[str, int] = dc.field(default_factory=dict)
    levels: Mapping[str, int] = dc.field(default_factory=dict)
    outcome: Mapping[str, str] = dc.field(default_factory=dict)
    tripped: str = ""  # the input that changed and has not come back yet

    @property
    def asked(self) -> str:
        """Which switch is to be tripped now; nothing when all were."""
        return next((name for name in SWITCHES if name not in self.outcome), "")

    def with_levels(self, levels: Mapping[str, int]) -> Switches:
        """One reading more: a switch counts once its input has changed and come back."""
        if not self.rest:
            return dc.replace(self, rest=dict(levels), levels=dict(levels))
        changed = [name for name in SWITCHES if levels[name] != self.rest[name]]
        if self.tripped and not changed:
            came = RIGHT if self.tripped == self.asked else self.tripped
            return dc.replace(self, levels=dict(levels), tripped="").answered(came)
        if not self.asked or (self.tripped and self.tripped in changed):
            return self if levels == self.levels else dc.replace(self, levels=dict(levels))
        first = self.asked if self.asked in changed else (changed[0] if changed else "")
        return dc.replace(self, levels=dict(levels), tripped=first)

    def answered(self, outcome: str) -> Switches:
        """What came of the one that is asked for."""
        asked = self.asked
        if not asked:
            return self
        return dc.replace(self, outcome={**self.outcome, asked: outcome}, tripped="")
