"""One measured figure and what is wanted of it."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Figure:
    """A figure with its bound: at least (`least`) or at most (`most`)."""

    name: str
    value: float
    unit: str
    least: float | None = None
    most: float | None = None
    note: str = ""

    @property
    def reached(self) -> bool:
        """Whether the bound is kept."""
        return (self.least is None or self.value >= self.least) and (self.most is None or self.value <= self.most)

    def within(self, slack: float) -> bool:
        """Whether it is no more than `slack` times worse than its bound."""
        high_enough = self.least is None or self.value * slack >= self.least
        return high_enough and (self.most is None or self.value <= self.most * slack)

    @property
    def bound(self) -> str:
        """The bound in words."""
        return f"≥ {self.least:g}" if self.least is not None else f"≤ {self.most:g}"

    def __str__(self) -> str:
        return f"{self.name}: {self.value:.4g} {self.unit} (wanted {self.bound}) {self.note}".rstrip()
