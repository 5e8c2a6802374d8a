"""What a diagram is made around: pyqtgraph's own, without the controls of a menu that nobody can open here.

Import it late: pyqtgraph takes longer to load than the first window may take to open.
"""

from __future__ import annotations

import weakref
from types import SimpleNamespace
from typing import Any

import pyqtgraph
from PySide6.QtWidgets import QGraphicsGridLayout, QSizePolicy

LOG_BOXES = {"x": "logXCheck", "y": "logYCheck"}
PLACES = {"bottom": (1, 1), "left": (0, 0)}  # in the grid around the view


class Box:
    """What a box of that menu would say."""

    def __init__(self) -> None:
        self.on = False

    def isChecked(self) -> bool:
        return self.on


class Inside(pyqtgraph.PlotItem):  # type: ignore[misc]
    """A view with an axis below and one at its left; made in a fifth of the time that all of those controls take."""

    def __init__(self) -> None:
        pyqtgraph.GraphicsWidget.__init__(self)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.autoBtn, self.buttonsHidden, self.mouseHovering = None, True, False
        self.vb = pyqtgraph.ViewBox(parent=self, enableMenu=False)
        self.setMenuEnabled(False, None)
        self.vb.sigRangeChanged.connect(self.sigRangeChanged)
        self.vb.sigXRangeChanged.connect(self.sigXRangeChanged)
        self.vb.sigYRangeChanged.connect(self.sigYRangeChanged)
        self.vb.sigRangeChangedManually.connect(self.sigRangeChangedManually)
        self.alpha, self.autoAlpha, self.spectrumMode, self.legend = 1.0, True, False, None
        self.items: list[Any] = []
        self.curves: list[Any] = []
        self.dataItems: list[Any] = []
        self.itemMeta: weakref.WeakKeyDictionary[Any, Any] = weakref.WeakKeyDictionary()
        self.paramList: dict[str, bool] = {}
        self.avgCurves: dict[str, Any] = {}
        boxes = (*LOG_BOXES.values(), "subtractMeanCheck", "fftCheck", "averageGroup")
        self.ctrl = SimpleNamespace(**{name: Box() for name in boxes})
        self.ctrlMenu = None
        self._lay_out()

    def _lay_out(self) -> None:
        grid = self.layout = QGraphicsGridLayout()
        grid.setContentsMargins(1, 1, 1, 1)
        self.setLayout(grid)
        grid.setHorizontalSpacing(0)
        grid.setVerticalSpacing(0)
        grid.addItem(self.vb, 0, 1)
        self.axes: dict[str, dict[str, Any]] = {}
        for side, place in PLACES.items():
            axis = pyqtgraph.AxisItem(orientation=side, parent=self)
            axis.linkToView(self.vb)
            self.axes[side] = {"item": axis, "pos": place}
            grid.addItem(axis, *place)
            axis.setZValue(0.5)  # above pictures
            axis.setFlag(axis.GraphicsItemFlag.ItemNegativeZStacksBehindParent)
        grid.setRowStretchFactor(0, 100)
        grid.setColumnStretchFactor(1, 100)

    # ---- what pyqtgraph asks its menu

    def setLogMode(self, x: bool | None = None, y: bool | None = None) -> None:
        for side, on in (("x", x), ("y", y)):
            box = getattr(self.ctrl, LOG_BOXES[side])
            if on is not None and on != box.on:
                box.on = on
                self.updateLogMode()

    def updateLogMode(self) -> None:
        modes = [getattr(self.ctrl, name).on for name in LOG_BOXES.values()]
        for each in (*self.items, *(axis["item"] for axis in self.axes.values())):
            if hasattr(each, "setLogMode"):
                each.setLogMode(*modes)
        self.enableAutoRange()

    def alphaState(self) -> tuple[float, bool]:
        return 1.0, False

    def downsampleMode(self) -> tuple[int, bool, str]:
        return 1, False, "peak"

    def clipToViewMode(self) -> bool:
        return False

    def updateDecimation(self) -> None:
        """All curves are kept."""

    def updateParamList(self) -> None:
        """No curve is one of several that are averaged."""

    def updateButtons(self) -> None:
        """There are none."""
