"""The pages of two axes together: a straight line, a part of a circle."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QHBoxLayout, QLabel, QPushButton, QVBoxLayout, QWidget

from codegen.setup import Setup
from device.jog import Plan
from widgets.form.fields_form import FieldsForm
from widgets.form.offers import Offers
from widgets.jog.one_axis import enable
from widgets.panel import set_text
from widgets.parts.look import look


class TogetherPage(QWidget):
    """Fields, where it will end, Go and Stop; `make` turns the fields into a plan or says why not."""

    plan_wanted = Signal(object)
    stop_wanted = Signal()

    def __init__(
        self, item: Any, make: Callable[[Any, Setup], Plan | str], setup: Setup, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.item = item
        self._make, self._setup = make, setup
        self.plan: Plan | None = None
        self.form = FieldsForm(Offers(setup))
        self.form.edited.connect(self._edited)
        self.words = QLabel()
        self.go, self.halt = QPushButton("Go"), QPushButton("Stop")
        self._reason = ""
        self._lay_out()
        self.go.clicked.connect(self._go)
        self.halt.clicked.connect(self.stop_wanted)
        self.form.show_item(item)
        self._edited(item)

    def show_setup(self, setup: Setup) -> None:
        """Another machine."""
        self._setup = setup
        self.form.show_offers(Offers(setup))
        self._edited(self.item)

    def show_usable(self, reason: str) -> None:
        """Why nothing may be moved now, or nothing."""
        self._reason = reason
        enable(self.go, reason or self.problem)
        enable(self.halt, reason)

    @property
    def problem(self) -> str:
        """Why there is no plan, or nothing."""
        return "" if self.plan is not None else self.words.text()

    def _edited(self, item: Any) -> None:
        self.item = self.form.item = item
        made = self._make(item, self._setup)
        wrong = made if isinstance(made, str) else made.problem
        self.plan = None if isinstance(made, str) or made.problem else made
        set_text(self.words, wrong or "; ".join(made.commands) if not isinstance(made, str) else made)
        self.words.setProperty("role", "problem" if self.plan is None else "quiet")
        self.words.style().unpolish(self.words)
        self.words.style().polish(self.words)
        self.show_usable(self._reason)

    def _go(self) -> None:
        if self.plan is not None and not self._reason:
            self.plan_wanted.emit(self.plan)

    def _lay_out(self) -> None:
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(8)
        column.addWidget(self.form)
        self.words.setWordWrap(True)
        column.addWidget(self.words)
        row = QHBoxLayout()
        for button in (self.go, self.halt):
            button.setMinimumHeight(look().space["touch"])
            row.addWidget(button, 1)
        column.addLayout(row)
        column.addStretch(1)
