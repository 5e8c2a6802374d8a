"""The past of two positions in a bounded memory. Pure numpy, no window."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:  # numpy loads with the first point, not with the first window
    import numpy as np
    from numpy.typing import NDArray


class Trail:
    """Points in the order they were seen; when it is full every second one of the older half is dropped."""

    def __init__(self, most: int = 20_000) -> None:
        self._most = most
        self._kept: NDArray[np.float64] | None = None
        self.count = 0

    @property
    def _points(self) -> NDArray[np.float64]:
        import numpy as np

        if self._kept is None:
            self._kept = np.empty((self._most, 2))
        return self._kept

    def add(self, x: float, y: float) -> bool:
        """One more point; False when it is no number or the axes stand where they stood."""
        if not (math.isfinite(x) and math.isfinite(y)):
            return False
        if self.count and self._points[self.count - 1, 0] == x and self._points[self.count - 1, 1] == y:
            return False
        if self.count == len(self._points):
            self._thin()
        self._points[self.count] = x, y
        self.count += 1
        return True

    def clear(self) -> None:
        """Forgets the past."""
        self.count = 0

    @property
    def points(self) -> NDArray[np.float64]:
        """Shape (count, 2), oldest first; a view, not a copy."""
        return self._points[: self.count]

    def _thin(self) -> None:
        import numpy as np

        half = self.count // 2
        kept = np.concatenate((self._points[:half:2], self._points[half : self.count]))
        self._points[: len(kept)] = kept
        self.count = len(kept)
