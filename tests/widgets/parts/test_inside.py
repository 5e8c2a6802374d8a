"""What a diagram is made around draws what pyqtgraph's own would draw."""

from __future__ import annotations

import numpy as np
import pyqtgraph
import pytest
from PySide6.QtGui import QImage
from PySide6.QtWidgets import QApplication, QWidget

from app.theme import Choice, Theme
from widgets.parts.inside import Inside
from widgets.parts.plot import Plot


def _drawn(qapp: QApplication, item: pyqtgraph.PlotItem, log: bool, name: str) -> QImage:
    window = QWidget()
    window.resize(500, 300)
    plot = Plot("Motor command", parent=window, item=item)
    item.hideButtons()
    plot.resize(500, 300)
    window.show()
    plot.setLogMode(x=log)
    plot.addLegend(offset=(-8, -8))
    x = np.linspace(1, 90, 200)
    plot.plot(x, np.sin(x), pen="r", name="Axis")
    gone = plot.plot(x, 5 * x, pen="g", name="Gone")
    plot.plot(x, np.cos(x), pen=None, symbol="s", name=name)
    plot.addItem(pyqtgraph.InfiniteLine(0.4))
    plot.removeItem(gone)
    plot.name_sides("Time, ms", "Volts")
    qapp.processEvents()
    picture = plot.grab().toImage()
    window.close()
    return picture


@pytest.mark.parametrize("log", [False, True])
def test_a_diagram_is_drawn_as_pyqtgraph_draws_it(qapp: QApplication, log: bool) -> None:
    """Curves, points, lines, names, numbers at the sides: every pixel."""
    Theme(qapp, Choice.LIGHT)
    own = _drawn(qapp, Inside(), log, "Loop")
    assert own == _drawn(qapp, pyqtgraph.PlotItem(enableMenu=False), log, "Loop")
    assert own != _drawn(qapp, Inside(), log, "Pool")


def test_curves_get_what_the_menu_of_pyqtgraph_would_give_them(qapp: QApplication) -> None:
    """Until somebody changes something there, which here nobody can."""
    own, other = Inside(), pyqtgraph.PlotItem(enableMenu=False)
    assert own.alphaState() == other.alphaState()
    assert own.downsampleMode() == other.downsampleMode()
    assert own.clipToViewMode() == other.clipToViewMode()
    for name, box in vars(own.ctrl).items():
        assert box.isChecked() == getattr(other.ctrl, name).isChecked(), name
