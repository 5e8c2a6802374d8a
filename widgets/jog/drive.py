"""The page of the stick: one axis or two, as fast as it is pushed, by the stick on the screen or a gamepad."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QComboBox, QHBoxLayout, QLabel, QVBoxLayout, QWidget

from codegen.setup import Setup
from widgets.jog import plans
from widgets.jog.speed import PaceChoice
from widgets.panel import set_text, show_role
from widgets.parts.stick import Stick

NONE = "–"
ALONE = "This line is slow: the axis that the stick is pushed to more moves alone. At 19 200 baud both move."
PAD_HELP = "Gamepad: hold a shoulder button down and push the left stick. Letting go of the button stops."


class Drive(NamedTuple):
    """Speeds of axes with their sign, and their ramps, as SP, AC and DC take them."""

    speeds: Mapping[str, int]
    ramps: Mapping[str, int]


class DrivePage(QWidget):
    """`leaned` tells how the stick on the screen stands; `drive_at` turns a place of any stick into speeds."""

    leaned = Signal(float, float)
    let_go = Signal()
    axes_changed = Signal()

    def __init__(self, setup: Setup, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._setup, self._letters = setup, setup.letters
        self._speeds: Mapping[str, Mapping[str, str]] = {}
        self.stick, self.pace = Stick(), PaceChoice("Fully pushed")
        self.across, self.upward = QComboBox(), QComboBox()
        self.problem, self.pad = QLabel(), QLabel(PAD_HELP)
        self._lay_out()
        self.stick.moved.connect(self.leaned)
        self.pace.changed.connect(self._changed)
        for box in (self.across, self.upward):
            box.currentIndexChanged.connect(self._changed)
        self.show_setup(setup, setup.letters)

    def show_setup(self, setup: Setup, letters: str) -> None:
        """Another machine."""
        self._setup, self._letters = setup, letters or setup.letters
        for box, place in ((self.across, 0), (self.upward, 1)):
            box.blockSignals(True)
            box.clear()
            box.addItems([*self._letters, NONE])
            box.setCurrentIndex(min(place, len(self._letters)))
            box.blockSignals(False)
        self._changed()

    def show_speeds(self, speeds: Mapping[str, Mapping[str, str]]) -> None:
        """Slow, medium and fast of every axis."""
        if speeds != self._speeds:
            self._speeds = speeds
            self._changed()

    def show_usable(self, reason: str, alone: bool) -> None:
        """Why nothing may be moved now, or nothing; whether the line is too slow for two axes at once."""
        wrong = reason or self._wrong()
        if self.stick.isEnabled() == bool(wrong):
            self.stick.setEnabled(not wrong)
        set_text(self.problem, "" if reason else wrong or (ALONE if alone and all(self.axes) else ""))
        show_role(self.problem, "problem" if wrong else "quiet")

    def show_pad(self, words: str) -> None:
        """What is to be said of the gamepad."""
        set_text(self.pad, words or PAD_HELP)

    @property
    def axes(self) -> tuple[str, str]:
        """The letters across and upward; nothing where none is chosen."""
        first, second = self.across.currentText(), self.upward.currentText()
        return first if first != NONE else "", second if second not in (NONE, first) else ""

    def drive_at(self, across: float, upward: float) -> Drive:
        """Speeds for a stick that stands here; an axis that is not pushed stands still."""
        speeds, ramps = {}, {}
        for axis, share in zip(self.axes, (across, upward), strict=True):
            pace = plans.pace_at(axis, self._kept(axis), self._setup) if axis else ""
            if isinstance(pace, plans.Pace):
                speeds[axis], ramps[axis] = round(share * pace.speed), pace.acceleration
        return Drive(speeds, ramps)

    def _kept(self, axis: str) -> str:
        return self._speeds.get(axis, {}).get(self.pace.pace, "")

    def _wrong(self) -> str:
        if self.axes == ("", ""):
            return "Choose an axis."
        paces = [plans.pace_at(axis, self._kept(axis), self._setup) for axis in self.axes if axis]
        return next((pace for pace in paces if isinstance(pace, str)), "")

    def _changed(self) -> None:
        self.stick.let_go()
        self.let_go.emit()
        self.stick.show_axes(*self.axes)
        self.axes_changed.emit()

    def _lay_out(self) -> None:
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(8)
        row = QHBoxLayout()
        for box, words in ((self.across, "Across"), (self.upward, "Upward")):
            label = QLabel(words)
            label.setBuddy(box)
            box.setAccessibleName(f"Axis that is moved {words.lower()}")
            row.addWidget(label)
            row.addWidget(box)
        row.addStretch(1)
        column.addLayout(row)
        column.addWidget(self.pace)
        column.addWidget(self.stick, 1, Qt.AlignmentFlag.AlignHCenter)
        for label, role in ((self.problem, "problem"), (self.pad, "quiet")):
            label.setWordWrap(True)
            label.setProperty("role", role)
            column.addWidget(label)
