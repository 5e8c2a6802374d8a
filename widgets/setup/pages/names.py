"""Names of inputs and outputs, and notes."""

from __future__ import annotations

import dataclasses as dc

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QGridLayout, QLabel, QLineEdit, QPlainTextEdit, QWidget

from codegen.setup import setup_problems
from widgets.parts.look import look
from widgets.setup.pages.page import Page, Shown, say


class NameGrid(QWidget):
    """Names of inputs or outputs."""

    edited = Signal(object)  # the names

    def __init__(self, what: str, count: int) -> None:
        super().__init__()
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(12)
        self.labels = [QLabel(str(number + 1)) for number in range(count)]
        self.lines = [QLineEdit() for _ in range(count)]
        for index, line in enumerate(self.lines):
            line.setAccessibleName(f"Name of {what} {index + 1}")
            line.setPlaceholderText(f"{what} {index + 1}")
            line.setMinimumHeight(look().control)
            line.textEdited.connect(lambda _: self.edited.emit(self.names))
            grid.addWidget(self.labels[index], index % 4, 2 * (index // 4))
            grid.addWidget(line, index % 4, 2 * (index // 4) + 1)

    def show_names(self, names: tuple[str, ...], count: int) -> None:
        """As many lines as the controller has channels; a name beyond them is kept."""
        for index, (label, line, name) in enumerate(zip(self.labels, self.lines, names, strict=True)):
            there = index < count
            label.setVisible(there)
            line.setVisible(there)
            if line.text().strip() != name:
                line.setText(name)

    @property
    def names(self) -> tuple[str, ...]:
        """The names as typed."""
        return tuple(line.text().strip() for line in self.lines)


class NamesPage(Page):
    """What hangs on the channels."""

    title = "Inputs and outputs"
    help_page = "Setup: Inputs and outputs"

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.heading("Inputs: names that programs, display and sentences use")
        self.inputs = NameGrid("Input", 8)
        self.column.addWidget(self.inputs)
        self.column.addSpacing(16)
        self.heading("Outputs")
        self.outputs = NameGrid("Output", 8)
        self.column.addWidget(self.outputs)
        self.problem = self.words("warning")
        self.column.addStretch(1)
        self.inputs.edited.connect(lambda names: self._put(input_names=names))
        self.outputs.edited.connect(lambda names: self._put(output_names=names))

    def refresh(self, shown: Shown) -> None:
        setup = shown.setup
        self.inputs.show_names(setup.input_names, setup.inputs)
        self.outputs.show_names(setup.output_names, setup.outputs)
        found = [each.message for each in setup_problems(setup) if each.field in ("input_names", "output_names")]
        say(self.problem, "\n".join(f"! {words}" for words in found))

    def _put(self, **names: tuple[str, ...]) -> None:
        if self.shown is not None:
            self.change(dc.replace(self.shown.setup, **names))  # type: ignore[arg-type]


class NotesPage(Page):
    """Anything worth knowing about the machine."""

    title = "Notes"
    help_page = "Setup: Notes"

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.heading("Anything worth knowing about this machine; it is kept in the setup file and in every program")
        self.text = QPlainTextEdit()
        self.text.setAccessibleName("Notes about the machine")
        self.text.setTabChangesFocus(True)
        self.text.setMinimumHeight(240)
        self.column.addWidget(self.text, 1)
        self.text.textChanged.connect(self._typed)

    def refresh(self, shown: Shown) -> None:
        if self.text.toPlainText() != shown.setup.notes:
            self.text.blockSignals(True)
            self.text.setPlainText(shown.setup.notes)
            self.text.blockSignals(False)

    def _typed(self) -> None:
        if self.shown is not None:
            self.change(dc.replace(self.shown.setup, notes=self.text.toPlainText()))
