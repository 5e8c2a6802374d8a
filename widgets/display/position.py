"""Where one axis is: large digits in its unit, what was commanded, and whether it moves."""

from __future__ import annotations

import dataclasses as dc
import math
from dataclasses import dataclass
from functools import partial

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QGridLayout, QHBoxLayout, QLabel, QToolButton, QToolTip, QWidget

from widgets.panel import set_text
from widgets.parts.axis_bar import AxisBar, Marks
from widgets.parts.look import look

UNKNOWN = Marks()


@dataclass(frozen=True)
class AxisShown:
    """Ready texts of one axis, and the places on its bar."""

    position: str = "–"
    unit: str = ""
    commanded: str = "–"
    error: str = "–"
    speed: str = "–"
    moving: bool | None = None
    motor_on: bool | None = None
    fault: str = ""
    age: str = ""
    marks: Marks = UNKNOWN


class AxisReadout(QWidget):
    """One axis; `show_axis` and `show_homed` are its setters."""

    homed_told = Signal(bool)

    def __init__(self, letter: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.letter = letter
        self._shown: AxisShown | None = None
        self._homed = ("", "")
        self.name = QLabel(letter)
        self.position, self.unit, self.state = QLabel(), QLabel(), QLabel()
        self.commanded, self.error, self.age = QLabel(), QLabel(), QLabel()
        self.travel = AxisBar(letter)
        self._ghost, self._is_homed = math.nan, False
        self.homed = QToolButton()
        self.homed.setAutoRaise(True)
        self.homed.setObjectName("homed")
        self.homed.hide()
        self.homed.setContextMenuPolicy(Qt.ContextMenuPolicy.ActionsContextMenu)
        for words, homed in ((f"I know that {letter} is homed", True), (f"{letter} is not homed", False)):
            action = self.homed.addAction(words)
            action.triggered.connect(partial(self.homed_told.emit, homed))
        self.homed.clicked.connect(self._say_why)
        for label in (self.unit, self.commanded, self.error, self.age):
            label.setProperty("role", "quiet")
        self.unit.setContentsMargins(0, 0, 0, 5)  # on the base line of the digits
        self.name.setContentsMargins(0, 0, 0, 2)
        self._lay_out()
        self._dress()
        self.show_axis(AxisShown())

    def show_axis(self, shown: AxisShown) -> None:
        """Puts the texts up; nothing is touched that has not changed."""
        if shown == self._shown:
            return
        before, self._shown = self._shown, shown
        set_text(self.position, shown.position)
        set_text(self.unit, shown.unit)
        set_text(self.state, _state_words(shown))
        set_text(self.commanded, f"commanded {shown.commanded}")
        set_text(self.error, f"error {shown.error}")
        set_text(self.age, shown.age)
        self._show_marks()
        if before is None or _mood(before) != _mood(shown):
            self._colour(shown)
        self.setAccessibleName(f"{self.letter} axis: {shown.position} {shown.unit}, {_state_words(shown)}")

    def show_homed(self, words: str, why: str) -> None:
        """Whether the axis is known to be homed; hidden when there is nothing to say."""
        if (words, why) != self._homed:
            self._homed = words, why
            self.homed.setText(words)
            self.homed.setToolTip(why)
            self.homed.setAccessibleName(f"{self.letter} axis: {words[2:]}")
            self.homed.setVisible(bool(words))

    def show_mark(self, ghost: float, homed: bool) -> None:
        """Where it will stop, in its unit (NaN: nothing to show); whether zero is where home is."""
        if homed != self._is_homed or not (ghost == self._ghost or (ghost != ghost and self._ghost != self._ghost)):
            self._ghost, self._is_homed = ghost, homed
            self._show_marks()

    def _show_marks(self) -> None:
        marks = self._shown.marks if self._shown is not None else UNKNOWN
        self.travel.show_marks(dc.replace(marks, ghost=self._ghost, homed=self._is_homed))

    def _say_why(self) -> None:
        """A click tells what the mark rests on; the menu of the right button takes the person's word."""
        QToolTip.showText(self.homed.mapToGlobal(self.homed.rect().bottomLeft()), self.homed.toolTip(), self.homed)

    def changeEvent(self, event: object) -> None:
        super().changeEvent(event)  # type: ignore[arg-type]
        if self._shown is not None and event.type().name in ("PaletteChange", "StyleChange"):  # type: ignore[attr-defined]
            self._dress()
            self._colour(self._shown)

    def _lay_out(self) -> None:
        grid = QGridLayout(self)
        grid.setContentsMargins(8, 4, 8, 4)
        grid.setHorizontalSpacing(8)
        grid.setVerticalSpacing(0)
        right = Qt.AlignmentFlag.AlignRight
        grid.addWidget(self.name, 0, 0, Qt.AlignmentFlag.AlignBottom)
        grid.addWidget(self.position, 0, 1, right | Qt.AlignmentFlag.AlignBottom)
        grid.addWidget(self.unit, 0, 2, Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignBottom)
        second, third = QHBoxLayout(), QHBoxLayout()
        second.addWidget(self.state)
        second.addStretch(1)
        second.addWidget(self.commanded)
        third.setSpacing(12)
        third.addWidget(self.homed)
        third.addWidget(self.age)
        third.addStretch(1)
        third.addWidget(self.error)
        grid.addLayout(second, 1, 0, 1, 3)
        grid.addLayout(third, 2, 0, 1, 3)
        grid.addWidget(self.travel, 3, 0, 1, 3)
        grid.setColumnStretch(1, 1)

    def _dress(self) -> None:
        """Fonts and the axis colour."""
        self.position.setFont(look().digits_font())
        self.name.setFont(look().digits_font(16))
        for label in (self.commanded, self.error, self.state, self.unit):
            label.setFont(look().digits_font(look().body_points))
        self.homed.setFont(look().digits_font(look().body_points))
        quiet, focus = look().colour("quiet").name(), look().colour("focus").name()
        self.homed.setStyleSheet(
            f"QToolButton#homed {{ color: {quiet}; border: none; padding: 0; margin-left: -5px; }}"
            f"QToolButton#homed:focus {{ border: 2px solid {focus}; }}"
            "QToolButton#homed::menu-indicator { image: none; width: 0; }"
        )
        self.name.setStyleSheet(f"color: {look().axis(self.letter).name()}; font-weight: 700;")

    def _colour(self, shown: AxisShown) -> None:
        mood = _mood(shown)
        number = "stale" if mood == "stale" else "text"
        state = {"stale": "stale", "fault": "fault", "moving": "accent"}.get(mood, "text")
        self.position.setStyleSheet(f"color: {look().colour(number).name()};")
        weight = "600" if mood in ("moving", "fault") else "400"
        self.state.setStyleSheet(f"color: {look().colour(state).name()}; font-weight: {weight};")


def _mood(shown: AxisShown) -> str:
    if shown.age:
        return "stale"
    if shown.fault:
        return "fault"
    return "moving" if shown.moving else "still"


def _state_words(shown: AxisShown) -> str:
    """▲ moving, ■ stopped, ! fault: a shape and a word."""
    if shown.fault:
        return f"! {shown.fault}"
    if shown.moving is None:
        return "? unknown"
    if shown.moving:
        return f"▲ {shown.speed}"
    return "■ motor off" if shown.motor_on is False else "■ stopped"
