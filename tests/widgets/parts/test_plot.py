"""What stands at the sides of a diagram."""

from __future__ import annotations

import pytest
from PySide6.QtWidgets import QApplication, QWidget

from app.theme import Choice, Theme
from widgets.parts.plot import Plot


@pytest.mark.parametrize("high", [0.0005, 0.5, 1.0, 9.9982, 5e4, 2e9])
def test_numbers_at_the_sides_are_those_of_the_curve(qapp: QApplication, high: float) -> None:
    """Half a volt stays half a volt, whatever was drawn when the side was named, and whatever comes then."""
    Theme(qapp, Choice.LIGHT)
    window = QWidget()
    window.resize(500, 300)
    plot = Plot("Motor command", parent=window)
    plot.resize(500, 300)
    window.show()
    plot.name_sides("Time, ms", "Volts")
    for named_at, drawn in ((high, 9.0), (9.0, high)):
        plot.setRange(xRange=(0, named_at), yRange=(0, named_at), padding=0)
        qapp.processEvents()
        plot.name_sides("Time, ms", "Volts")
        plot.setRange(xRange=(0, drawn), yRange=(0, drawn), padding=0)
        qapp.processEvents()
        for side in ("left", "bottom"):
            axis = plot.getAxis(side)
            ((apart, ticks), *_) = axis.tickValues(0, drawn, 300)
            words = axis.tickStrings(ticks, axis.autoSIPrefixScale * axis.scale, apart)
            assert [float(each) for each in words] == pytest.approx(list(ticks), abs=apart / 100)
    window.close()
