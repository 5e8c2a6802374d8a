"""Draws a run as an SVG picture: curves and on/off lines over one time axis. Needs no display."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from xml.sax.saxutils import escape

import numpy as np
from numpy.typing import NDArray

Values = NDArray[np.float64]
WIDTH, LEFT, RIGHT, TOP = 960, 110, 30, 60
CURVE, SIGNAL, GAP = 150, 34, 26
MOST_POINTS = 1600
COLOURS = ("#0b6e99", "#b5541c", "#3f7d20", "#7a4fa3", "#946200", "#a03050")
STYLE = (
    "text{font-family:system-ui,sans-serif;font-size:13px;fill:#1f2933}"
    ".title{font-size:19px;font-weight:600}.quiet{fill:#5b6770;font-size:12px}"
    ".grid{stroke:#dfe3e8;stroke-width:1}.frame{fill:none;stroke:#b8c0c8;stroke-width:1}"
)


@dataclass(frozen=True)
class Panel:
    """One row of the picture: a curve, or a signal that is on or off."""

    label: str
    values: Values
    unit: str = ""
    is_signal: bool = False

    @property
    def height(self) -> int:
        """Height in the picture's units."""
        return SIGNAL if self.is_signal else CURVE


def nice_step(span: float, most: int = 8) -> float:
    """A round distance of grid lines: 1, 2 or 5 times a power of ten."""
    rough = max(span, 1e-9) / most
    power = 10.0 ** np.floor(np.log10(rough))
    for factor in (1.0, 2.0, 5.0, 10.0):
        if rough <= factor * power:
            return float(factor * power)
    return float(10 * power)


def thinned(times: Values, values: Values) -> tuple[Values, Values]:
    """At most so many points, keeping the first and last and every step of an on/off line."""
    if len(times) <= MOST_POINTS:
        return times, values
    keep = np.zeros(len(times), dtype=bool)
    keep[:: int(np.ceil(len(times) / MOST_POINTS))] = True
    keep[-1] = True
    if len(np.unique(values)) <= 2:
        steps = np.flatnonzero(np.diff(values))
        keep[steps] = keep[steps + 1] = True
    return times[keep], values[keep]


def number(value: float) -> str:
    """A short number for a scale."""
    return f"{value:,.0f}" if abs(value) >= 10 else f"{value:.2g}"


def polyline(xs: Values, ys: Values, colour: str) -> str:
    """One line through the points."""
    points = " ".join(f"{x:.1f},{y:.1f}" for x, y in zip(xs.tolist(), ys.tolist(), strict=True))
    return f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="1.8" stroke-linejoin="round"/>'


def panel_svg(panel: Panel, times: Values, y: float, colour: str) -> list[str]:
    """One row with its frame, scale and line."""
    low, high = (0.0, 1.0) if panel.is_signal else (float(panel.values.min()), float(panel.values.max()))
    if high - low < 1e-9:
        low, high = low - 1, high + 1
    span, width = max(float(times[-1]), 1e-9), WIDTH - LEFT - RIGHT
    shown_times, shown = thinned(times, panel.values)
    xs = LEFT + shown_times / span * width
    ys = y + panel.height - 6 - (shown - low) / (high - low) * (panel.height - 12)
    parts = [f'<rect class="frame" x="{LEFT}" y="{y}" width="{width}" height="{panel.height}"/>']
    parts.append(f'<text x="{LEFT - 10}" y="{y + panel.height / 2 + 4}" text-anchor="end">{escape(panel.label)}</text>')
    if not panel.is_signal:
        for value, where in ((high, y + 14), (low, y + panel.height - 4)):
            text = escape(f"{number(value)} {panel.unit}".strip())
            parts.append(f'<text class="quiet" x="{LEFT - 10}" y="{where}" text-anchor="end">{text}</text>')
    return [*parts, polyline(xs, ys, colour)]


def time_axis(seconds: float, top: float, bottom: float) -> list[str]:
    """Grid lines and their times in seconds."""
    step = nice_step(seconds)
    parts = []
    for index in range(int(seconds / step + 1e-9) + 1):
        x = LEFT + index * step / max(seconds, 1e-9) * (WIDTH - LEFT - RIGHT)
        parts.append(f'<line class="grid" x1="{x:.1f}" y1="{top}" x2="{x:.1f}" y2="{bottom}"/>')
        parts.append(f'<text class="quiet" x="{x:.1f}" y="{bottom + 18}" text-anchor="middle">{index * step:g}</text>')
    parts.append(f'<text class="quiet" x="{WIDTH - RIGHT}" y="{bottom + 36}" text-anchor="end">time, s</text>')
    return parts


def draw(title: str, seconds: Values, panels: Sequence[Panel]) -> str:
    """The whole picture; `seconds` are the times of every panel's values."""
    height = TOP + sum(panel.height + GAP for panel in panels) + 30
    head = f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{height}" viewBox="0 0 {WIDTH} {height}">'
    parts = [head, f"<title>{escape(title)}</title><style>{STYLE}</style>"]
    parts.append(f'<rect width="{WIDTH}" height="{height}" fill="#ffffff"/>')
    parts.append(f'<text class="title" x="{LEFT}" y="34">{escape(title)}</text>')
    bottom = height - 30 - GAP
    parts += time_axis(float(seconds[-1]), TOP, bottom)
    y = float(TOP)
    for index, panel in enumerate(panels):
        parts += panel_svg(panel, seconds, y, COLOURS[index % len(COLOURS)])
        y += panel.height + GAP
    return "\n".join([*parts, "</svg>"]) + "\n"
