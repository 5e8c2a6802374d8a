"""Loops of the servo axes, and pulses of the stepper axes."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from PySide6.QtWidgets import QWidget

from codegen.numbers import shown as number_shown
from codegen.setup import Setup
from codegen.setup_registers import GAIN
from codegen.twoletter.fixed import ONE
from widgets.setup.pages.grid import AxisGrid
from widgets.setup.pages.page import Page, Shown, say


class ServoPage(Page):
    """Encoders, gains and smoothing of the servo axes."""

    title = "Servo"
    help_page = "Setup: Servo"

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.none = self.words()
        self.grid = AxisGrid(
            ("main_encoder", "aux_encoder", "kp", "ki", "kd", "fv", "fa", "smoothing", "offset", "integrator_limit")
        )
        self.grid.edited.connect(self.change)
        self.column.addWidget(self.grid)
        self.gain = self.words()
        self.column.addStretch(1)

    def filling(self, shown: Shown) -> Iterator[None]:
        return self.grid.showing(shown, _servos(shown.setup))

    def refresh(self, shown: Shown) -> None:
        letters = _servos(shown.setup)
        say(self.none, "" if letters else "No axis has a servo: choose the motor on the page Axes.")
        self.grid.setVisible(bool(letters))
        self.grid.show_axes(shown, letters)
        held = [
            f"{letter} {number_shown(Fraction(value, ONE))}"
            for letter in letters
            if (value := shown.readings.get((GAIN, letter))) is not None
        ]
        told = f" The controller holds {', '.join(held)}." if held else ""
        say(
            self.gain,
            f"Compensation gain (GN): not used by the present version of the controller.{told}" if letters else "",
        )


class StepperPage(Page):
    """Smoothing of the step pulses."""

    title = "Stepper"
    help_page = "Setup: Stepper"

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.none = self.words()
        self.grid = AxisGrid(("smoothing", "main_encoder"), "2")
        self.grid.edited.connect(self.change)
        self.column.addWidget(self.grid)
        self.remark = self.words()
        self.column.addStretch(1)

    def refresh(self, shown: Shown) -> None:
        letters = "".join(each for each in shown.setup.letters if shown.setup.axis(each).is_stepper)
        say(self.none, "" if letters else "No axis has a stepper: choose the motor on the page Axes.")
        self.grid.setVisible(bool(letters))
        self.grid.show_axes(shown, letters)
        say(
            self.remark,
            "Smoothing 0.5 to 8 evens out the step pulses; larger is smoother and makes each move longer. "
            "Left empty, the controller's own value stays: 2 after a reset."
            if letters
            else "",
        )


def _servos(setup: Setup) -> str:
    return "".join(each for each in setup.letters if not setup.axis(each).is_stepper)
