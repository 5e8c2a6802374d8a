"""Scenes of small parts, for pictures."""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Iterator

from PySide6.QtWidgets import QVBoxLayout, QWidget

from widgets.parts.axis_bar import AxisBar, Marks


def bar_scenes() -> Iterator[tuple[str, QWidget]]:
    """Bars of axes: between limits, without, beyond them, with one."""
    bars, column = QWidget(), QVBoxLayout()
    bars.setLayout(column)
    table = Marks(low=-50, high=200, actual=75, commanded=76.5, ghost=120, latch=30, homed=True, unit="mm", decimals=3)
    free = dc.replace(table, low=math.nan, high=math.nan, homed=False, ghost=math.nan)
    beyond, one = dc.replace(table, actual=-52, commanded=-51, ghost=215), dc.replace(table, low=math.nan, ghost=-3)
    for letter, marks in zip("XYZW", (table, free, beyond, one), strict=True):
        bar = AxisBar(letter)
        bar.show_marks(marks)
        column.addWidget(bar)
    bars.resize(420, 190)
    bars.show()
    yield "axis-bars", bars
    bars.close()
