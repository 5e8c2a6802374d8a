"""Where an axis is between its limits, and where it will stop."""

from __future__ import annotations

import math

from PySide6.QtCore import QRectF, QSize, Qt
from PySide6.QtGui import QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QSizePolicy, QWidget

from widgets.parts.look import look

DOT, EDGE = 12, 12  # px


class TravelBar(QWidget):
    """A line from the reverse to the forward limit; a dot where the axis is, a ring where it will stop."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._letter = "X"
        self._shown = (math.nan, math.nan, math.nan, math.nan)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setAccessibleName("Travel of the axis")

    def sizeHint(self) -> QSize:
        return QSize(160, 28)

    def show_axis(self, letter: str, low: float, high: float, place: float, ghost: float) -> None:
        """All in user units; NaN where unknown. Without limits the line ends in arrows around where the axis is."""
        now = (low, high, place, ghost)
        if letter != self._letter or not _same(now, self._shown):
            self._letter, self._shown = letter, now
            self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        low, high, place, ghost = self._shown
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        left, right, middle = EDGE, self.width() - EDGE, self.height() / 2
        painter.setPen(QPen(look().colour("border"), 1.5))
        painter.drawLine(left, round(middle), right, round(middle))
        bounded = math.isfinite(low) and math.isfinite(high) and high > low
        for x, way in ((left, 1), (right, -1)):
            if bounded:
                painter.drawLine(x, round(middle) - 8, x, round(middle) + 8)
            else:
                painter.drawLine(x, round(middle), x + 6 * way, round(middle) - 5)
                painter.drawLine(x, round(middle), x + 6 * way, round(middle) + 5)
        if not math.isfinite(place):
            return
        if not bounded:  # the distance to the ring fills a third of the line at the most
            reach = max(abs(ghost - place) * 3, 1e-9) if math.isfinite(ghost) else 1.0
            low, high = place - reach, place + reach
        for value, ring in ((ghost, True), (place, False)):
            if math.isfinite(value):
                self._mark(painter, (value - low) / (high - low), ring)

    def _mark(self, painter: QPainter, fraction: float, ring: bool) -> None:
        outside = not 0 <= fraction <= 1
        colour = look().colour("warning") if outside else look().axis(self._letter)
        x = EDGE + (self.width() - 2 * EDGE) * min(1.0, max(0.0, fraction))
        painter.setPen(QPen(colour, 2))
        painter.setBrush(Qt.BrushStyle.NoBrush if ring else colour)
        size = DOT + 4 if ring else DOT - 2
        painter.drawEllipse(QRectF(x - size / 2, self.height() / 2 - size / 2, size, size))


def _same(first: tuple[float, ...], second: tuple[float, ...]) -> bool:
    return all(a == b or (math.isnan(a) and math.isnan(b)) for a, b in zip(first, second, strict=True))
