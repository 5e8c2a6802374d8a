"""A few numbers of one frozen value, side by side, with their units; what is wrong is said below."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Sequence
from functools import partial

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QGridLayout, QLabel, QLineEdit, QWidget

from codegen.fields import fields_of
from codegen.setup import Setup
from codegen.teach_drive import Driving, context_of, field_problem
from widgets.panel import set_text, show_role

WIDTH = 68  # px, of a number


class Numbers(QWidget):
    """`edited` brings the value with a number that is right; a wrong one stays in its field, marked."""

    edited = Signal(object)

    def __init__(self, names: Sequence[str], across: int = 1, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.driving, self._setup = Driving(), Setup()
        self.names = tuple(names)
        self.fields = {name: QLineEdit() for name in names}
        self.units = {name: QLabel() for name in names}
        self.message = QLabel()
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(6)
        self.labels: dict[str, QLabel] = {}
        grid.setVerticalSpacing(4)
        for number, (name, line) in enumerate(self.fields.items()):
            field = fields_of(Driving)[name]
            label = self.labels[name] = QLabel(field.label)
            label.setBuddy(line)
            line.setAccessibleName(field.label)
            line.setToolTip(field.help)
            line.setFixedWidth(WIDTH)
            line.textEdited.connect(partial(self._typed, name))
            self.units[name].setProperty("role", "quiet")
            for place, widget in enumerate((label, line, self.units[name])):
                grid.addWidget(widget, number // across, number % across * 3 + place)
        for column in range(across):
            grid.setColumnStretch(column * 3 + 2, 1)
        self.message.setWordWrap(True)
        self.message.setProperty("role", "problem")
        self.message.hide()
        grid.addWidget(self.message, len(self.names), 0, 1, 3 * across)

    def show_driving(self, driving: Driving, setup: Setup) -> None:
        """Another value; a field keeps what is being typed when it means the same."""
        self.driving, self._setup = driving, setup
        for name, line in self.fields.items():
            if line.text().strip() != getattr(driving, name):
                line.setText(getattr(driving, name))
            field = fields_of(Driving)[name]
            set_text(self.units[name], field.unit(context_of(field, setup)))
        self._judge()

    def show_only(self, names: Sequence[str]) -> None:
        """Fields that matter now; the others are hidden."""
        for name, line in self.fields.items():
            for widget in (self.labels[name], line, self.units[name]):
                widget.setVisible(name in names)

    @property
    def problem(self) -> str:
        """What is wrong with what stands in the fields, or nothing."""
        found = (field_problem(name, line.text(), self._setup) for name, line in self.fields.items())
        return next((problem for problem in found if problem), "")

    def _typed(self, name: str, text: str) -> None:
        if not field_problem(name, text, self._setup):
            self.driving = dc.replace(self.driving, **{name: text.strip()})
            self.edited.emit(self.driving)
        self._judge()

    def _judge(self) -> None:
        for name, line in self.fields.items():
            show_role(line, "problem" if field_problem(name, line.text(), self._setup) else "")
        set_text(self.message, f"{self.problem}." if self.problem else "")
        self.message.setVisible(bool(self.problem))
