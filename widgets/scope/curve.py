"""One curve of the scope; of many points it draws what a picture can show, and more of them when it is looked at."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyqtgraph
from numpy.typing import NDArray

Values = NDArray[np.float64]
LARGE = 10_000  # points that are drawn one by one; more would hold the window up
PIECES = 1000  # of a larger stretch; more than a picture shows apart


class DrawnCurve(pyqtgraph.PlotCurveItem):  # type: ignore[misc]
    """Least and most of every few points where there are many, so that no peak is lost."""

    def __init__(self) -> None:
        super().__init__()
        self._whole: tuple[Values, Values] | None = None  # where not all of it is drawn
        self._drawn = (0, 0)

    def give(self, x: Values, y: Values, smooth: bool) -> None:
        """Other points; those of a time are in its order, any others are of one thing over another."""
        self.opts["antialias"] = smooth
        self._whole, self._drawn = None, (0, 0)
        if len(x) <= LARGE:
            self._set(x, y)
        elif (np.diff(x) >= 0).all():
            self._whole = x, y
            self._look()
        else:
            thin = slice(None, None, -(-len(x) // LARGE))
            self._set(x[thin], y[thin])

    def viewRangeChanged(self) -> None:
        super().viewRangeChanged()
        if self._whole is not None:
            self._look()

    def dataBounds(self, ax: int, frac: float = 1.0, orthoRange: Any = None) -> Any:
        """Of all points, also of those that are not drawn now."""
        if self._whole is None:
            return super().dataBounds(ax, frac, orthoRange)
        x, y = self._whole
        if ax == 0:
            return float(x[0]), float(x[-1])
        if orthoRange is not None:
            y = y[np.searchsorted(x, orthoRange[0]) : np.searchsorted(x, orthoRange[1], side="right")]
        return (float(y.min()), float(y.max())) if len(y) else (None, None)

    def _look(self) -> None:
        """Draws what lies in the picture, and a point at either side."""
        assert self._whole is not None
        x, y = self._whole
        box = self.getViewBox()
        low, high = box.viewRange()[0] if box is not None else (x[0], x[-1])
        first = max(int(np.searchsorted(x, low)) - 1, 0)
        last = min(int(np.searchsorted(x, high, side="right")) + 1, len(x))
        if last - first < 2:  # all of it lies elsewhere; soon it will be shown
            first, last = 0, len(x)
        if (first, last) == self._drawn:
            return
        self._drawn = first, last
        self._set(*seen(x[first:last], y[first:last]))

    def _set(self, x: Values, y: Values) -> None:
        self.setData(x, y, antialias=self.opts["antialias"], skipFiniteCheck=True, connect="all")


def seen(x: Values, y: Values) -> tuple[Values, Values]:
    """Points in the order of `x` as a picture shows them: all, or least and most of each piece, and the two ends."""
    if len(x) <= LARGE:
        return x, y
    starts = np.arange(0, len(x), -(-len(x) // PIECES))
    across = np.concatenate([x[:1], np.repeat(x[starts], 2), x[-1:]])
    upward = np.empty(len(across))
    upward[0], upward[-1] = y[0], y[-1]
    upward[1:-1:2], upward[2:-1:2] = np.minimum.reduceat(y, starts), np.maximum.reduceat(y, starts)
    return across, upward
