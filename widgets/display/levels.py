"""Inputs and outputs as lamps with their names."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QGridLayout, QWidget

from widgets.display.readings import bit
from widgets.parts.lamp import Lamp

COLUMNS = 2


class Levels(QWidget):
    """A byte of inputs or outputs, one lamp a bit."""

    wanted = Signal(int, bool)  # number, level the person asks for

    def __init__(self, height: int | None = None, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._height = height
        self.lamps: list[Lamp] = []
        self._names: list[str] = []
        self._grid = QGridLayout(self)
        self._grid.setContentsMargins(0, 0, 0, 0)
        self._grid.setHorizontalSpacing(8)
        self._grid.setVerticalSpacing(0)

    def show_names(self, names: Sequence[str]) -> None:
        """One lamp for each name (empty names included)."""
        if list(names) == self._names:
            return
        self._names = list(names)
        while len(self.lamps) > len(names):
            lamp = self.lamps.pop()
            self._grid.removeWidget(lamp)
            lamp.deleteLater()
        while len(self.lamps) < len(names):
            self._add(len(self.lamps) + 1)
        for row, lamp in enumerate(self.lamps):
            rows = (len(names) + COLUMNS - 1) // COLUMNS
            self._grid.addWidget(lamp, row % rows, row // rows)
        for lamp, name in zip(self.lamps, names, strict=True):
            lamp.show_name(name)

    def show_byte(self, value: float, stale: bool) -> None:
        """The byte as TI or OP have it."""
        for lamp in self.lamps:
            lamp.show_level(bit(value, lamp.number), stale)

    def show_switchable(self, switchable: bool, why_not: str = "") -> None:
        """Whether clicks switch."""
        for lamp in self.lamps:
            lamp.show_switchable(switchable, why_not)

    def _add(self, number: int) -> None:
        lamp = Lamp(number, height=self._height)
        lamp.wanted.connect(lambda on: self.wanted.emit(number, on))
        self.lamps.append(lamp)
