"""How quickly the scope draws, beside pyqtgraph with nothing around it, turn by turn in one run."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from tests.benchmarks.figure import Figure

if TYPE_CHECKING:
    from PySide6.QtWidgets import QWidget

Draw: TypeAlias = Callable[[list[np.ndarray]], None]
CHANNELS, POINTS, ROUNDS = 4, 8000, 25
SIZE = (1200, 700)


def drawing_rates() -> list[Figure]:
    """Four channels of 8000 values each: given, laid out and painted, as fast as each can."""
    os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
    import shiboken6
    from PySide6.QtWidgets import QApplication

    from app.theme import Theme

    application = QApplication.instance() or QApplication([])
    assert isinstance(application, QApplication)
    theme = Theme(application)
    curves = _signals()
    (plot, bare), (chart, scope) = _bare(), _scope()
    times: dict[Draw, list[float]] = {bare: [], scope: []}
    for draw in times:  # once, so that everything is laid out and on the screen
        draw(curves)
        for _ in range(5):
            application.processEvents()
    for turn in range(ROUNDS + 3):
        for draw, found in times.items():
            begin = time.process_time()
            draw([np.roll(each, turn * 40) for each in curves])
            found.append(time.process_time() - begin)
    for window in (plot, chart):  # freed here, not in whatever thread looks for garbage next
        shiboken6.delete(window)
    theme.release()
    plain, ours = (float(np.median(found[3:])) for found in times.values())
    note = f"{1 / ours:.0f} pictures/s of processor time, bare {1 / plain:.0f}"
    return [
        Figure("scope, 4 x 8000 points: share of bare pyqtgraph's rate", 100 * plain / ours, "%", least=85, note=note),
        Figure("scope, 4 x 8000 points: one picture blocks the window", 1000 * max(0.0, ours), "ms", most=50),
    ]


def _signals() -> list[np.ndarray]:
    t = np.arange(POINTS) / 512
    noise = np.random.default_rng(3).normal(0, 20, (CHANNELS, POINTS))
    return [1000 * (n + 1) * np.sin(2 * np.pi * (n + 1) * t / 4) + noise[n] for n in range(CHANNELS)]


def _bare() -> tuple[QWidget, Draw]:
    import pyqtgraph

    plot = pyqtgraph.PlotWidget()
    plot.resize(*SIZE)
    plot.show()
    items = [plot.plot(pen=colour) for colour in ("b", "r", "g", "m")]
    x = np.arange(POINTS) / 512

    def draw(curves: list[np.ndarray]) -> None:
        for item, y in zip(items, curves, strict=True):
            item.setData(x, y)
        plot.grab()

    return plot, draw


def _scope() -> tuple[QWidget, Draw]:
    """The scope's chart, without the columns beside it."""
    from device.capture import Capture, Channel
    from device.curves import curves as curves_of
    from widgets.parts.look import look
    from widgets.scope.chart import Chart, Line

    channels = tuple(Channel("position", axis) for axis in "XYZW")
    chart = Chart()
    chart.resize(*SIZE)
    chart.show()

    def draw(values: list[np.ndarray]) -> None:
        capture = Capture(channels, np.stack(values), 1, 1000.0)
        lines = [
            Line(each.label, each.unit, each.group, look().axis(each.axis), capture.times, each.values)
            for each in curves_of(capture)
        ]
        chart.show_lines(lines, "Time (s)", step=capture.interval_s)
        chart.grab()
        assert all(len(strip.items) == CHANNELS for strip in chart.strips.values())

    return chart, draw
