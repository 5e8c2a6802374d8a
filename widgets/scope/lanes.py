"""Tracks of inputs, outputs and switches one above the other in a strip, as a logic analyser draws them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import Qt
from PySide6.QtGui import QFontMetrics

from widgets.parts.look import look

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from widgets.parts.plot import Plot

LOW, HIGH = 0.18, 0.82  # of a lane: where off and on are drawn
LEAST, MOST = 15, 30  # px of a lane
AXIS = 34  # px below the lanes, for the times
BESIDE = 14  # px between a name and its lane
NO_LIMIT = (1 << 24) - 1  # px, as Qt has it


class Lanes:
    """Which tracks a strip has, the first on top; none: it is drawn as any other."""

    def __init__(self, plot: Plot) -> None:
        self._plot, self._axis = plot, plot.getAxis("left")
        self.labels: tuple[str, ...] = ()
        self._named: tuple[object, ...] = ()

    def show(self, labels: Sequence[str]) -> None:
        """Other tracks, or none."""
        if tuple(labels) == self.labels:
            return
        self.labels = tuple(labels)
        count, box = len(labels), self._plot.getViewBox()
        high: float | None = float(count) if count else None
        box.setLimits(yMin=0.0 if count else None, yMax=high, minYRange=high, maxYRange=high)
        box.setMouseEnabled(x=True, y=not count)
        self._plot.grid.upward = [float(place) for place in range(count + 1)] if count else None
        self._named = ()
        if not count:
            self._axis.setTicks(None)

    def raised(self, label: str, y: NDArray[Any]) -> NDArray[Any]:
        """0 and 1 in the place of a track."""
        lane = len(self.labels) - 1 - self.labels.index(label)
        return lane + LOW + (HIGH - LOW) * y

    @property
    def least(self) -> int:
        """The height in px that it needs."""
        return len(self.labels) * LEAST + AXIS

    @property
    def most(self) -> int:
        """The height in px beyond which other strips have more of it."""
        return len(self.labels) * MOST + AXIS if self.labels else NO_LIMIT

    @property
    def widest(self) -> int:
        """The width in px that its names need."""
        metrics = QFontMetrics(look().small_font())
        return max((metrics.horizontalAdvance(label) for label in self.labels), default=0) + BESIDE

    def name(self, width: int) -> None:
        """The names beside the lanes, as far as there is room for them."""
        if not self.labels or (width, self.labels) == self._named:
            return
        self._named = width, self.labels
        metrics, middle = QFontMetrics(look().small_font()), Qt.TextElideMode.ElideRight
        places = range(len(self.labels) - 1, -1, -1)
        self._axis.setTicks([
            [(place + 0.5, metrics.elidedText(label, middle, width - BESIDE))
             for place, label in zip(places, self.labels, strict=True)]
        ])  # fmt: skip
