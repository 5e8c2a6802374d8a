"""The small windows of Wait and Output: which input, which outputs (SSC manual, figures 5.94 and 5.95)."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QComboBox,
    QDialog,
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QRadioButton,
    QSpinBox,
    QVBoxLayout,
    QWidget,
)

from codegen.setup import Setup
from widgets.parts.foot import foot
from widgets.parts.spin import indented


class Entry(QDialog):
    """Not modal: STOP and everything else go on. `done` brings the text of the cell."""

    accepted_text = Signal(str)

    def __init__(self, title: str, accept: str, parent: QWidget) -> None:
        super().__init__(parent)
        self.setWindowTitle(title)
        self.setModal(False)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setProperty("helpPage", "Teach")
        self.form = QFormLayout()
        self.add, self.cancel = QPushButton(accept), QPushButton("Cancel")
        self.add.setDefault(True)
        self.add.setProperty("role", "primary")
        self.add.clicked.connect(self._done)
        self.cancel.clicked.connect(self.reject)
        column = QVBoxLayout(self)
        column.addLayout(self.form)
        column.addWidget(foot(self.add, away=self.cancel))

    def text(self) -> str:
        """What the cell gets."""
        raise NotImplementedError

    def _done(self) -> None:
        text = self.text()
        self.accept()
        self.accepted_text.emit(text)


class WaitEntry(Entry):
    """An input that has to be high or low."""

    def __init__(self, setup: Setup, parent: QWidget) -> None:
        super().__init__("Wait for an input", "Add the wait", parent)
        self.input, self.level = _channels(setup.input_names, setup.inputs, "Input"), QComboBox()
        self.level.setAccessibleName("Level")
        self.level.addItems(["High", "Low"])
        self.form.addRow("Input", self.input)
        self.form.addRow("Until it is", self.level)

    def text(self) -> str:
        return f"{'-' if self.level.currentIndex() else ''}{self.input.currentIndex() + 1}"


class OutputEntry(Entry):
    """One output, or all of them as a byte."""

    def __init__(self, setup: Setup, switches: str, parent: QWidget) -> None:
        super().__init__("Output", "Add the output", parent)
        self.single, self.multiple = QRadioButton("Single"), QRadioButton("Multiple")
        self.output, self.level = _channels(setup.output_names, setup.outputs, "Output"), QComboBox()
        self.level.setAccessibleName("State")
        self.level.addItems(["On", "Off"])
        self.byte = indented(QSpinBox())
        self.byte.setAccessibleName("Byte of all outputs")
        self.byte.setRange(0, (1 << min(setup.outputs, 8)) - 1)
        self.bits = QLabel()
        which = QHBoxLayout()
        which.addWidget(self.single)
        which.addWidget(self.multiple)
        which.addStretch(1)
        words = QLabel(switches)
        words.setWordWrap(True)
        words.setProperty("role", "quiet")
        self.form.addRow("Channels", which)
        self.form.addRow("Output", self.output)
        self.form.addRow("State", self.level)
        self.form.addRow(f"Byte, 0 to {self.byte.maximum()}", self.byte)
        self.form.addRow("", self.bits)
        self.form.addRow(words)
        self.single.setChecked(True)
        self.single.toggled.connect(self._show)
        self.byte.valueChanged.connect(self._show)
        self._show()

    def text(self) -> str:
        if self.multiple.isChecked():
            return f"0x{self.byte.value():02X}"
        return f"{'-' if self.level.currentIndex() else ''}{self.output.currentIndex() + 1}"

    def _show(self) -> None:
        one = self.single.isChecked()
        self.output.setEnabled(one)
        self.level.setEnabled(one)
        self.byte.setEnabled(not one)
        on = [str(bit + 1) for bit in range(8) if self.byte.value() >> bit & 1]
        self.bits.setText("" if one else f"0x{self.byte.value():02X}: {', '.join(on) or 'none'} on, the others off")


def _channels(names: tuple[str, ...], count: int, word: str) -> QComboBox:
    """Numbers with the names that the setup gives them."""
    box = QComboBox()
    box.setAccessibleName(word)
    for number in range(count):
        name = names[number] if number < len(names) else ""
        box.addItem(f"{number + 1}  {name}".rstrip())
    return box
