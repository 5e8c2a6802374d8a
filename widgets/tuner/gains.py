"""The five gains: a slider, arrows and a field each; ranges and resolutions come from the command table."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction
from functools import partial

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QGridLayout, QLabel, QLineEdit, QSlider, QToolButton, QWidget

from codegen.numbers import decimal, looks_like_number, parse_number, plain
from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.fixed import ONE, scaled
from device.tuning.loop import FACTORY, Gains
from widgets.panel import set_text, show_role

NAMES = ("KP", "KI", "KD", "FV", "FA")
WORDS = {
    "KP": "Proportional",
    "KI": "Integral",
    "KD": "Derivative",
    "FV": "Velocity feed-forward",
    "FA": "Acceleration feed-forward",
}
NOTCHES = 1000
CURVE = 4.0  # decades of the slider: small gains have as much room as large ones
FACTOR = 1.1  # of one arrow, at least one step of the register
PLACES = 7
BUTTON = 44  # px


def notch(name: str, value: float) -> int:
    """Where the slider stands for a value."""
    high = float(COMMANDS[name].high or 1)
    return round(NOTCHES * math.log1p((10**CURVE - 1) * min(max(value, 0.0), high) / high) / (CURVE * math.log(10)))


def at_notch(name: str, place: int) -> float:
    """The value of a place of the slider, at the register's resolution."""
    high = float(COMMANDS[name].high or 1)
    return stored(name, high * (10 ** (CURVE * place / NOTCHES) - 1) / (10**CURVE - 1))


def stored(name: str, value: float) -> float:
    """What the register keeps of a value."""
    return COMMANDS[name].stored(scaled(Fraction(value))) / ONE


def shown(value: float) -> str:
    """As it stands in a field."""
    return decimal(Fraction(value), PLACES)


def problem_of(name: str, text: str) -> str:
    """What is wrong with a typed gain, or nothing."""
    row = COMMANDS[name]
    number = parse_number(text)
    if number is None:
        hint = " Write a point, not a comma." if "," in text and looks_like_number(text) else ""
        return f"{name}: “{text.strip()}” is not a number.{hint}" if text.strip() else f"{name} is missing."
    low, high = Fraction(row.low or 0), Fraction(row.high or 0)
    if not low <= number <= high:
        return f"{name} must lie between {plain(low)} and {plain(high)}."
    return ""


class GainsBox(QWidget):
    """Rows of name, slider, arrows, field, and beside them what the controller holds."""

    edited = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.fields = {name: QLineEdit(shown(getattr(FACTORY, name.lower()))) for name in NAMES}
        self.sliders = {name: QSlider(Qt.Orientation.Horizontal) for name in NAMES}
        self.less = {name: QToolButton() for name in NAMES}
        self.more = {name: QToolButton() for name in NAMES}
        self.there = {name: QLabel("–") for name in NAMES}
        self._base = FACTORY
        self._lay_out()
        self.show_gains(FACTORY)

    # ---- what it shows

    @property
    def problem(self) -> str:
        """The first thing wrong with the fields, or nothing."""
        return next((wrong for name in NAMES if (wrong := problem_of(name, self.fields[name].text()))), "")

    @property
    def texts(self) -> tuple[str, ...]:
        """As typed."""
        return tuple(field.text() for field in self.fields.values())

    @property
    def gains(self) -> Gains:
        """As typed, at the controller's resolution; the last good ones while a field is wrong."""
        if self.problem:
            return self._base
        values = {name.lower(): stored(name, float(parse_number(self.fields[name].text()) or 0)) for name in NAMES}
        return Gains(**values)

    def show_gains(self, gains: Gains) -> None:
        """Puts gains into the fields."""
        self._base = gains
        for name in NAMES:
            self.fields[name].setText(shown(getattr(gains, name.lower())))
        self._changed()

    def show_filter(self, gains: Gains) -> None:
        """Puts KP, KI and KD into the fields; the feed-forwards there stay."""
        self.show_gains(replace(gains, fv=self.gains.fv, fa=self.gains.fa))

    def show_there(self, gains: Gains | None) -> None:
        """What the controller holds."""
        for name in NAMES:
            set_text(self.there[name], "–" if gains is None else shown(getattr(gains, name.lower())))

    # ---- inside

    def _changed(self) -> None:
        for name in NAMES:
            wrong = problem_of(name, self.fields[name].text())
            show_role(self.fields[name], "problem" if wrong else "")
            self.fields[name].setToolTip(wrong or f"{COMMANDS[name].help} {self._range(name)}")
            if not wrong:
                slider = self.sliders[name]
                slider.blockSignals(True)
                slider.setValue(notch(name, float(parse_number(self.fields[name].text()) or 0)))
                slider.blockSignals(False)
        if not self.problem:
            self._base = self.gains
        self.edited.emit()

    def _range(self, name: str) -> str:
        row = COMMANDS[name]
        low, high, step = (plain(Fraction(each or 0)) for each in (row.low, row.high, row.step))
        return f"{low} to {high}, in steps of {step}."

    def _slid(self, name: str, place: int) -> None:
        self.fields[name].setText(shown(at_notch(name, place)))
        self._changed()

    def _stepped(self, name: str, up: bool) -> None:
        """A tenth more or less, one step of the register at least."""
        number = parse_number(self.fields[name].text())
        if number is None:
            return
        row = COMMANDS[name]
        value, step = float(number), float(row.step or 1)
        wanted = max(value * FACTOR, value + step) if up else min(value / FACTOR, value - step)
        self.fields[name].setText(shown(stored(name, min(max(wanted, float(row.low or 0)), float(row.high or 0)))))
        self._changed()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Up and down in a field do what its arrows do."""
        name = next((each for each in NAMES if self.fields[each].hasFocus()), "")
        if name and event.key() in (Qt.Key.Key_Up, Qt.Key.Key_Down):
            self._stepped(name, event.key() == Qt.Key.Key_Up)
            return
        super().keyPressEvent(event)

    def _lay_out(self) -> None:
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(6)
        grid.setVerticalSpacing(4)
        heading = QLabel("in the controller")
        heading.setProperty("role", "quiet")
        grid.addWidget(heading, 0, 5, Qt.AlignmentFlag.AlignRight)
        for row, name in enumerate(NAMES, 1):
            label = QLabel(name)
            label.setToolTip(WORDS[name])
            field, slider = self.fields[name], self.sliders[name]
            field.setAccessibleName(f"{name}, {WORDS[name].lower()} gain")
            field.setFixedWidth(84)
            field.setAlignment(Qt.AlignmentFlag.AlignRight)
            field.textEdited.connect(lambda _text: self._changed())
            slider.setAccessibleName(f"{name} slider")
            slider.setRange(0, NOTCHES)
            slider.setPageStep(50)
            slider.setMinimumWidth(70)
            slider.valueChanged.connect(partial(self._slid, name))
            grid.addWidget(label, row, 0)
            grid.addWidget(slider, row, 1)
            for column, (button, up, sign) in enumerate(((self.less[name], False, "−"), (self.more[name], True, "+"))):
                button.setText(sign)
                button.setProperty("role", "control")
                button.setFixedWidth(BUTTON)
                button.setAutoRepeat(True)
                button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
                button.setAccessibleName(f"{'More' if up else 'Less'} {name}")
                button.clicked.connect(partial(self._arrow, name, up))
                grid.addWidget(button, row, 2 + 2 * column)
            grid.addWidget(field, row, 3)
            there = self.there[name]
            there.setProperty("role", "quiet")
            there.setAccessibleName(f"{name} in the controller")
            there.setMinimumWidth(56)
            grid.addWidget(there, row, 5, Qt.AlignmentFlag.AlignRight)
        grid.setColumnStretch(1, 1)

    def _arrow(self, name: str, up: bool, _checked: bool = False) -> None:
        self._stepped(name, up)
