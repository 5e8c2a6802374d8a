"""The travel of one axis as a picture: soft limits, zero, where it is and should be, where it will stop."""

from __future__ import annotations

import math
from dataclasses import astuple, dataclass

from PySide6.QtCore import QEvent, QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QHelpEvent, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QSizePolicy, QToolTip, QWidget

from widgets.parts.look import look

EDGE, BEYOND = 10, 12  # px: half of the largest mark; room behind a limit
LINE = 13  # px from the top to the line
HEIGHT = 40
KEY = "dot: where it is; line across: commanded; ring: where it stops; triangle: zero; diamond: latched"


@dataclass(frozen=True)
class Marks:
    """Places on one axis in its user unit; NaN: not known, or nothing to show."""

    low: float = math.nan  # soft limits
    high: float = math.nan
    actual: float = math.nan
    commanded: float = math.nan
    ghost: float = math.nan
    latch: float = math.nan
    homed: bool = False
    unit: str = ""
    decimals: int = 0


class AxisBar(QWidget):
    """`show_marks` is its setter. A side without a limit ends in an arrow and grows with what is seen."""

    def __init__(self, letter: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._letter = letter
        self._marks = Marks()
        self._seen = (0.0, 0.0)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setAccessibleName(f"Travel of axis {letter}")

    @property
    def marks(self) -> Marks:
        """What is shown."""
        return self._marks

    def show_axis(self, letter: str) -> None:
        """Another axis."""
        if letter != self._letter:
            self._letter, self._seen = letter, (0.0, 0.0)
            self.setAccessibleName(f"Travel of axis {letter}")
            self.update()

    def show_marks(self, marks: Marks) -> None:
        """Paints again only what has changed."""
        if not _same(marks, self._marks):
            if marks.unit != self._marks.unit:
                self._seen = (0.0, 0.0)
            self._marks = marks
            places = [each for each in self._places() if math.isfinite(each)]
            self._seen = min([self._seen[0], *places]), max([self._seen[1], *places])
            self.update()

    def words(self) -> str:
        """The picture as a sentence."""
        marks = self._marks
        ends = [f"{name} limit {self._text(end)}" for name, end in (("reverse", marks.low), ("forward", marks.high))
                if math.isfinite(end)]  # fmt: skip
        told = [f"{name} {self._text(place)}" for name, place in
                (("at", marks.actual), ("commanded", marks.commanded), ("stops at", marks.ghost),
                 ("latched at", marks.latch)) if math.isfinite(place)]  # fmt: skip
        return f"{self._letter}: {', '.join([*told, *(ends or ['no soft limits'])])}"

    def event(self, event: QEvent) -> bool:
        if event.type() is QEvent.Type.ToolTip and isinstance(event, QHelpEvent):
            QToolTip.showText(event.globalPos(), f"{self.words()}\n({KEY})", self)
            return True
        return super().event(event)

    def sizeHint(self) -> QSize:
        return QSize(160, HEIGHT)

    # ---- where things lie

    def _places(self) -> tuple[float, ...]:
        marks = self._marks
        return marks.actual, marks.commanded, marks.ghost

    def span(self) -> tuple[float, float]:
        """From where to where the line goes, user units: the limits, or round numbers around what was seen."""
        marks = self._marks
        low = marks.low if math.isfinite(marks.low) else -_round_up(-self._seen[0])
        high = marks.high if math.isfinite(marks.high) else _round_up(self._seen[1])
        return (low, high) if low < high else (low - 1, low + 1)

    def place_of(self, value: float) -> float:
        """Its x in pixels; behind a limit at the very edge."""
        low, high = self.span()
        left, right = EDGE + BEYOND, self.width() - EDGE - BEYOND
        share = (value - low) / (high - low)
        if share < 0:
            return float(EDGE)
        return float(self.width() - EDGE) if share > 1 else left + (right - left) * share

    def _outside(self, value: float) -> bool:
        low, high = self.span()
        return not low <= value <= high

    # ---- painting

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        usable = self.isEnabled()
        left, right = float(EDGE + BEYOND), float(self.width() - EDGE - BEYOND)
        low, high = self.span()
        painter.setPen(QPen(look().colour("border"), 2))
        painter.drawLine(QPointF(left, LINE), QPointF(right, LINE))
        self._end(painter, left, 1, math.isfinite(self._marks.low))
        self._end(painter, right, -1, math.isfinite(self._marks.high))
        self._numbers(painter, low, high)
        if low <= 0 <= high:
            self._zero(painter)
        colour = look().axis(self._letter) if usable else look().colour("disabled")
        for value, paint in (
            (self._marks.latch, self._diamond),
            (self._marks.commanded, self._tick),
            (self._marks.actual, self._dot),
            (self._marks.ghost, self._ring),
        ):
            if math.isfinite(value):
                warns = usable and self._outside(value)
                paint(painter, self.place_of(value), look().colour("warning") if warns else colour)

    def _end(self, painter: QPainter, x: float, way: int, limit: bool) -> None:
        """A post with hatching behind it, or an arrow where the way is open."""
        painter.setPen(QPen(look().colour("quiet" if limit else "border"), 2))
        if limit:
            painter.drawLine(QPointF(x, LINE - 9), QPointF(x, LINE + 9))
            painter.setPen(QPen(look().colour("border"), 1))
            for step in (-6, -1, 4):
                painter.drawLine(QPointF(x, LINE + step), QPointF(x - 5 * way, LINE + step + 5))
        else:
            painter.drawLine(QPointF(x, LINE), QPointF(x + 6 * way, LINE - 5))
            painter.drawLine(QPointF(x, LINE), QPointF(x + 6 * way, LINE + 5))

    def _numbers(self, painter: QPainter, low: float, high: float) -> None:
        """What the ends are; zero where there is room for it."""
        painter.setFont(look().small_font())
        painter.setPen(look().colour("quiet"))
        metrics = painter.fontMetrics()
        top, high_text, low_text = LINE + 11.0, self._short(high), self._short(low)
        height = float(metrics.height())
        last = self.width() - EDGE - metrics.horizontalAdvance(high_text)
        painter.drawText(QPointF(EDGE, top + metrics.ascent()), low_text)
        painter.drawText(QPointF(last, top + metrics.ascent()), high_text)
        middle, half = self.place_of(0.0), metrics.horizontalAdvance("0") / 2
        free = EDGE + metrics.horizontalAdvance(low_text) + 6 < middle - half and middle + half + 6 < last
        if low < 0 < high and free:
            painter.drawText(QRectF(middle - 20, top, 40, height), Qt.AlignmentFlag.AlignHCenter, "0")

    def _zero(self, painter: QPainter) -> None:
        """A triangle under the line; full when the axis is known to be homed."""
        x, top = self.place_of(0.0), LINE + 2.0
        painter.setPen(QPen(look().colour("quiet"), 1.5))
        painter.setBrush(look().colour("quiet") if self._marks.homed else Qt.BrushStyle.NoBrush)
        painter.drawPolygon(QPolygonF([QPointF(x, top), QPointF(x - 5, top + 8), QPointF(x + 5, top + 8)]))

    def _dot(self, painter: QPainter, x: float, colour: object) -> None:
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(colour)  # type: ignore[call-overload]
        painter.drawEllipse(QPointF(x, LINE), 5, 5)

    def _tick(self, painter: QPainter, x: float, colour: object) -> None:
        painter.setPen(QPen(colour, 2))  # type: ignore[call-overload]
        painter.drawLine(QPointF(x, LINE - 9), QPointF(x, LINE + 9))

    def _ring(self, painter: QPainter, x: float, colour: object) -> None:
        painter.setPen(QPen(colour, 2))  # type: ignore[call-overload]
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawEllipse(QPointF(x, LINE), 8.5, 8.5)

    def _diamond(self, painter: QPainter, x: float, colour: object) -> None:
        painter.setPen(QPen(look().colour("surface"), 1))
        painter.setBrush(look().colour("quiet"))
        painter.drawPolygon(QPolygonF([QPointF(x, 0), QPointF(x + 5, 5), QPointF(x, 10), QPointF(x - 5, 5)]))

    def _short(self, value: float) -> str:
        text = f"{value:.{self._marks.decimals}f}"
        return text.rstrip("0").rstrip(".") if "." in text else text

    def _text(self, value: float) -> str:
        return f"{value:.{self._marks.decimals}f} {self._marks.unit}".strip()


def _round_up(value: float) -> float:
    """The next 1, 2 or 5 times a power of ten above; 1 for nothing."""
    if value <= 0:
        return 1.0
    power = 10.0 ** math.floor(math.log10(value))
    return next(step * power for step in (1.0, 2.0, 5.0, 10.0) if step * power >= value * (1 - 1e-9))


def _same(first: Marks, second: Marks) -> bool:
    """NaN equals NaN here."""
    return all(a == b or (a != a and b != b) for a, b in zip(astuple(first), astuple(second), strict=True))
