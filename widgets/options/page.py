"""The settings of the studio: every row with what it does; what is chosen holds at once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from PySide6.QtCore import QLocale, Signal
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QDialog,
    QDoubleSpinBox,
    QGridLayout,
    QLabel,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from widgets.parts.foot import foot
from widgets.parts.spin import indented


@dataclass(frozen=True)
class Option:
    """One setting as it is shown: a list of choices with their words, yes or no, or a number with its unit."""

    key: str
    label: str
    help: str
    value: Any
    choices: tuple[tuple[Any, str], ...] = ()
    low: float = 0.0
    high: float = 0.0
    unit: str = ""


@dataclass(frozen=True)
class Kept:
    """Something that is remembered and can be forgotten: how many entries of it there are."""

    key: str
    label: str
    help: str
    count: int


class OptionsPage(QDialog):
    """Not modal. `changed` carries key and value, `forgotten` a key."""

    changed = Signal(str, object)
    forgotten = Signal(str)

    def __init__(self, options: Sequence[Option], kept: Sequence[Kept], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle("Settings")
        self.setProperty("helpPage", "Settings")
        self.setModal(False)
        self.editors = {option.key: self._editor(option) for option in options}
        self.forget = {each.key: self._forget_button(each) for each in kept}
        self.close_button = QPushButton("Close")
        self.close_button.setDefault(True)
        self.close_button.clicked.connect(self.accept)
        grid = QGridLayout()
        grid.setHorizontalSpacing(24)
        grid.setVerticalSpacing(4)
        for option in options:
            self._add(grid, option.label, option.help, self.editors[option.key])
        for each in kept:
            self._add(grid, each.label, each.help, self.forget[each.key])
        column = QVBoxLayout(self)
        column.setContentsMargins(24, 24, 24, 16)
        column.setSpacing(24)
        column.addLayout(grid)
        column.addWidget(foot(away=self.close_button))
        self.setMinimumWidth(640)

    @staticmethod
    def _add(grid: QGridLayout, label: str, words: str, editor: QWidget) -> None:
        row = grid.rowCount()
        quiet = QLabel(words)
        quiet.setProperty("role", "quiet")
        quiet.setWordWrap(True)
        grid.addWidget(QLabel(label), row, 0)
        grid.addWidget(editor, row, 1)
        grid.addWidget(quiet, row + 1, 0, 1, 2)
        grid.setRowMinimumHeight(row + 2, 12)
        editor.setAccessibleName(label)
        editor.setAccessibleDescription(words)
        editor.setToolTip(words)

    def _editor(self, option: Option) -> QWidget:
        if option.choices:
            box = QComboBox()
            for value, words in option.choices:
                box.addItem(words, value)
            box.setCurrentIndex(max(0, box.findData(option.value)))
            box.currentIndexChanged.connect(lambda _: self.changed.emit(option.key, box.currentData()))
            return box
        if isinstance(option.value, bool):
            tick = QCheckBox("Yes")
            tick.setChecked(option.value)
            tick.toggled.connect(lambda on: self.changed.emit(option.key, on))
            return tick
        number = indented(QDoubleSpinBox())
        number.setLocale(QLocale.c())  # a point, whatever the system writes
        number.setRange(option.low, option.high)
        number.setDecimals(1)
        number.setSuffix(f" {option.unit}")
        number.setValue(float(option.value))
        number.setKeyboardTracking(False)
        number.valueChanged.connect(lambda value: self.changed.emit(option.key, value))
        return number

    def _forget_button(self, kept: Kept) -> QPushButton:
        button = QPushButton(f"Forget {kept.count}" if kept.count else "None yet")
        button.setEnabled(bool(kept.count))

        def forget() -> None:
            button.setText("None yet")
            button.setEnabled(False)
            self.forgotten.emit(kept.key)

        button.clicked.connect(forget)
        return button
