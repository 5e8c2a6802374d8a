"""What protects the machine: travel, following error, force, top speed and acceleration."""

from __future__ import annotations

from collections.abc import Iterator

from PySide6.QtWidgets import QWidget

from codegen.setup_cautions import unprotected
from widgets.setup.pages.grid import AxisGrid
from widgets.setup.pages.page import Page, Shown, say


class LimitsPage(Page):
    """Limits of every axis, and amber words where there are none."""

    title = "Limits"
    help_page = "Setup: Limits"

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.grid = AxisGrid(
            (
                "forward_limit",
                "reverse_limit",
                "maximum_speed",
                "maximum_acceleration",
                "error_limit",
                "off_on_error",
                "torque_limit",
            )
        )
        self.grid.edited.connect(self.change)
        self.column.addWidget(self.grid)
        self.amber = self.words("warning")
        self.remark = self.words()
        self.remark.setText(
            "Programs are checked against these limits and tried out with them. Limits of the travel are rounded "
            "inwards; off switches one off. What is not set stays as the controller has it."
        )
        self.column.addStretch(1)

    def filling(self, shown: Shown) -> Iterator[None]:
        return self.grid.showing(shown, shown.setup.letters)

    def refresh(self, shown: Shown) -> None:
        setup = shown.setup
        self.grid.show_axes(shown, setup.letters)
        found = [f"△ {letter}: {words}" for letter in setup.letters for words in unprotected(setup, letter)]
        say(self.amber, "\n".join(found))
