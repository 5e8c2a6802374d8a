"""Where axes will stop: one answer for the jog panel, the bars of the display and the X-Y view."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

from widgets.display.display import DisplayPanel
from widgets.jog.panel import JogPanel
from widgets.plane.panel import PlanePanel

Ghost = Mapping[str, int]


class Ghosts:
    """`sources` are asked in order with every tick; the first that has something is shown. Counts."""

    def __init__(
        self, display: DisplayPanel, plane: PlanePanel, jog: JogPanel, homed: Callable[[], Iterable[str]]
    ) -> None:
        self._display, self._plane, self._jog, self._homed = display, plane, jog, homed
        self.sources: list[Callable[[], Ghost]] = []

    def look(self) -> None:
        """With every tick."""
        ghost: Ghost = next((found for source in self.sources if (found := source())), {})
        self._jog.show_ghost(ghost)
        self._display.show_ghost(ghost, self._homed())
        self._plane.show_ghost(ghost)
