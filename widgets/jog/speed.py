"""How fast: a slider, and three speeds of each axis that a person keeps."""

from __future__ import annotations

import math
from collections.abc import Mapping
from fractions import Fraction
from functools import partial

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QHBoxLayout, QLabel, QMenu, QPushButton, QSlider, QVBoxLayout, QWidget

from codegen.fields import Dimension
from codegen.numbers import number_problem, parse_number, plain
from codegen.setup import Setup
from widgets.display.readings import unit_of

STEPS = 100  # of the slider; each is the same factor
SPAN = 100_000.0  # between its slowest and its fastest speed
USUAL = {"slow": (2_000, 50), "medium": (10_000, 10), "fast": (50_000, 2)}  # counts/s; at most 1/n of the top speed


def round_number(number: Fraction) -> Fraction:
    """The next 1, 2 or 5 times a power of ten below."""
    power = Fraction(10) ** math.floor(math.log10(number))
    return max(power * step for step in (1, 2, 5) if power * step <= number)


def usual(top: Fraction, scale: Fraction) -> dict[str, str]:
    """The three speeds of an axis for which none were kept, user units a second: slow on any machine."""
    if top <= 0:
        return {}
    found = {name: min(counts / scale, top / part) for name, (counts, part) in USUAL.items()}
    return {name: plain(round_number(speed)) for name, speed in found.items()}


def key_of(letter: str, setup: Setup) -> str:
    """Speeds are kept for an axis in its unit: never read in another one."""
    return f"{letter} {unit_of(setup.axis(letter))}"


def speeds_of(letter: str, setup: Setup, kept: Mapping[str, Mapping[str, str]]) -> dict[str, str]:
    """Slow, medium and fast of an axis: those that were kept, else the usual ones."""
    made = usual(setup.bounds(Dimension.SPEED, letter)[1], setup.axis(letter).scale)
    return {**made, **kept.get(key_of(letter, setup), {})}


class SpeedRow(QWidget):
    """`chosen` is a speed as text in user units; `kept` asks to keep the present one under a name."""

    chosen = Signal(str)
    kept = Signal(str, str)  # slow, medium or fast; the speed

    def __init__(self, parent: QWidget | None = None, *, presets: bool = True) -> None:
        super().__init__(parent)
        self._top, self._speed, self._unit = 0.0, "", ""
        self._speeds: Mapping[str, str] = {}
        self.slider = QSlider(Qt.Orientation.Horizontal)
        self.buttons = {name: QPushButton(name.capitalize()) for name in USUAL} if presets else {}
        self.keep = QPushButton()
        self._lay_out(presets)

    def show_speed(self, text: str, top: float, unit: str) -> None:
        """The speed of the page and the top speed of its axis."""
        self._top, self._unit = top, unit
        number = parse_number(text)
        if number is not None and number > 0 and not number_problem(text):
            self._speed = text.strip()
            self.slider.blockSignals(True)
            self.slider.setValue(self._notch(float(number)))
            self.slider.blockSignals(False)
        self._mark()

    def show_presets(self, kept: Mapping[str, str]) -> None:
        """Slow, medium and fast of this axis."""
        self._speeds = {name: text for name, text in kept.items() if name in USUAL}
        self._mark()

    def _mark(self) -> None:
        for name, button in self.buttons.items():
            text = self._speeds.get(name, "")
            button.setEnabled(bool(text))
            button.setToolTip(f"{text} {self._unit}/s" if text else "The top speed of the axis is not set up.")
            button.setAccessibleName(f"{name.capitalize()}, {text} {self._unit}/s")
            button.setChecked(bool(text) and parse_number(text) == parse_number(self._speed))
        self.keep.setEnabled(bool(self._speed))

    def _notch(self, speed: float) -> int:
        if self._top <= 0:
            return 0
        return round(STEPS * (1 + math.log(max(speed, 1e-12) / self._top) / math.log(SPAN)))

    def _slid(self, notch: int) -> None:
        """The same factor for every notch; two figures are enough for a hand."""
        if self._top > 0:
            self.chosen.emit(plain(Fraction(f"{self._top * SPAN ** (notch / STEPS - 1):.2g}")))

    def _pick(self, name: str) -> None:
        self.chosen.emit(self._speeds[name])

    def _fill_menu(self) -> None:
        menu = self.keep.menu()
        menu.clear()
        for name in USUAL:
            action = menu.addAction(f"{name.capitalize()} is {self._speed} {self._unit}/s from now on")
            action.triggered.connect(partial(self.kept.emit, name, self._speed))

    def _lay_out(self, presets: bool) -> None:
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(4)
        row = QHBoxLayout()
        row.addWidget(QLabel("Speed"))
        row.addWidget(self.slider, 1)
        column.addLayout(row)
        self.slider.setRange(0, STEPS)
        self.slider.setAccessibleName("Speed")
        self.slider.setToolTip("Speed, up to the top speed of the axis")
        self.slider.valueChanged.connect(self._slid)
        if not presets:
            return
        line = QHBoxLayout()
        for name, button in self.buttons.items():
            button.setCheckable(True)
            button.setProperty("role", "segment")
            button.clicked.connect(partial(self._pick, name))
            line.addWidget(button)
        self.keep.setText("Keep…")
        self.keep.setAccessibleName("Keep this speed")
        self.keep.setToolTip("Keeps the present speed of this axis as slow, medium or fast.")
        self.keep.setProperty("role", "segment")
        self.keep.setMenu(QMenu(self.keep))
        self.keep.menu().aboutToShow.connect(self._fill_menu)
        line.addWidget(self.keep)
        line.addStretch(1)
        column.addLayout(line)


class PaceChoice(QWidget):
    """One of the three speeds, for moves of several axes: each takes its own."""

    changed = Signal()

    def __init__(self, label: str, parent: QWidget | None = None, first: str = "slow") -> None:
        super().__init__(parent)
        self.pace = first
        self.buttons = {name: QPushButton(name.capitalize()) for name in USUAL}
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.addWidget(QLabel(label))
        for name, button in self.buttons.items():
            button.setCheckable(True)
            button.setChecked(name == first)
            button.setProperty("role", "segment")
            button.setAccessibleName(f"{label}: {name}")
            button.clicked.connect(partial(self._pick, name))
            row.addWidget(button)
        row.addStretch(1)

    def _pick(self, name: str) -> None:
        self.pace = name
        for each, button in self.buttons.items():
            button.setChecked(each == name)
        self.changed.emit()
