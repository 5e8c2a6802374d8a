"""Axes that the connected controller has and the setup has not: they are named, with the way to them."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QHBoxLayout, QLabel, QPushButton, QWidget

from codegen.setup import Setup
from widgets.panel import set_text, show_role


class MoreAxes(QWidget):
    """Hidden while the setup has them all."""

    setup_wanted = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.words, self.open = QLabel(), QPushButton("Open the setup…")
        self.words.setWordWrap(True)
        show_role(self.words, "warning")
        self.open.setToolTip("Choose the type that is connected there; then its axes have a unit and a scale")
        self.open.clicked.connect(self.setup_wanted)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.addWidget(self.words, 1)
        row.addWidget(self.open)
        self.hide()

    def show_axes(self, setup: Setup, letters: str) -> None:
        """`letters`: those of the controller."""
        missing = [letter for letter in letters if letter not in setup.letters]
        listed = " and ".join(filter(None, (", ".join(missing[:-1]), *missing[-1:])))
        isnt = "is" if len(missing) == 1 else "are"
        set_text(
            self.words,
            f"! {listed} of this controller {isnt} not in the setup ({setup.limits.title}), so nothing is known of "
            f"{'its' if len(missing) == 1 else 'their'} unit and limits: only {setup.letters} can be moved here.",
        )
        self.setVisible(bool(missing))
