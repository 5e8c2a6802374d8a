"""A program built as a technician builds it: every step from its dialog, every field by mouse or keys.

What is typed comes from a finished program; only what differs from an empty dialog is entered.
"""

from __future__ import annotations

from typing import Any

from PySide6.QtCore import Qt
from PySide6.QtGui import QGuiApplication
from PySide6.QtTest import QTest
from PySide6.QtWidgets import (
    QAbstractScrollArea,
    QApplication,
    QCheckBox,
    QComboBox,
    QLineEdit,
    QPlainTextEdit,
    QPushButton,
    QWidget,
)

from codegen import read
from codegen.fields import AXES, AxisSet, Choice, Field, Flag, ListOf, PerAxis, Table, fields_of
from codegen.instructions import Instruction
from codegen.instructions.flow import Repeat
from codegen.program import Program, Step
from codegen.setup import Setup
from tests.app.hands import Hands, Keys, shown, until, visible
from widgets.form.dialog import InstructionDialog
from widgets.setup.window import SetupWindow

Cells = dict[tuple[str, str], Any]


def same(one: Program, other: Program) -> bool:
    """Whether two programs have the same steps; ids are given out as they come."""

    def plain(steps: tuple[Step, ...]) -> list[Any]:
        return [(step.instruction, plain(step.body)) for step in steps]

    return all(
        plain(first) == plain(second)
        for first, second in zip(
            (one.configuration, one.main, one.routines), (other.configuration, other.main, other.routines), strict=True
        )
    )


def set_up(hands: Hands, setup: Setup) -> None:
    """Model, units, scales and names of inputs and outputs, in the setup's window."""
    hands.act("setup")
    window = shown(SetupWindow)
    assert isinstance(window, SetupWindow)
    hands.choose(window.controller.model, setup.limits.title)
    hands.turn_to(window.list, window.axes.title)
    for letter in setup.letters:
        row, axis = window.axes.rows[letter], setup.axis(letter)
        if axis.is_set_up:
            words = row.unit.itemText(row.unit.findData(axis.unit))
            if row.unit.currentText() != words:
                hands.choose(row.unit, words)
            hands.fill(row.scale, axis.counts_per_unit)
    hands.turn_to(window.list, window.names.title)
    for grid, names in ((window.names.inputs, setup.input_names), (window.names.outputs, setup.output_names)):
        for line, name in zip(grid.lines, names, strict=True):
            if name:
                hands.fill(line, name)
    hands.press(window.done_button)
    until(lambda: not visible(window), "the setup to close")


def build(hands: Hands, program: Program) -> None:
    """Name, configuration, main program, subroutines."""
    hands.fill(hands.studio.program.header.name, program.name)
    for step in program.configuration:
        add(hands, step.instruction, "configuration")
    for step in program.main:
        _step(hands, step)
    for routine in program.routines:
        add(hands, routine.instruction)
        for step in routine.body:
            _step(hands, step)


def _step(hands: Hands, step: Step) -> None:
    """A step, and what stands inside it; a repeat is left as one leaves it."""
    add(hands, step.instruction)
    for inner in step.body:
        _step(hands, inner)
    if isinstance(step.instruction, Repeat):
        hands.act("end_of_repeat")


def add(hands: Hands, instruction: Instruction, section: str = "main") -> None:
    """One instruction from its dialog."""
    dialog = hands.pick(instruction.title)
    if instruction.section == "C/M" and dialog.section.chosen() != [section]:
        words = {"main": "Main", "configuration": "Configuration"}[section]
        hands.take(next(each for each in dialog.section.findChildren(QPushButton) if each.text() == words))
    fill_in(hands, dialog, instruction)
    button = dialog.buttons["Add"]
    assert button.isEnabled(), f"{instruction.title}: {button.toolTip()}"
    assert dialog.form.instruction == instruction, f"{dialog.form.instruction}\n{instruction}"
    hands.press(button)
    until(lambda: not visible(dialog), f"the dialog {instruction.title} to close")


def fill_in(hands: Hands, dialog: InstructionDialog, wanted: Instruction) -> None:
    """Every field that is shown and not yet right."""
    for name, field in fields_of(wanted).items():
        if read.shown(wanted, name) and getattr(dialog.form.instruction, name) != getattr(wanted, name):
            _field(hands, dialog.form.fields.cells, name, field, getattr(wanted, name))


def _field(hands: Hands, cells: Cells, name: str, field: Field, value: Any) -> None:
    """One field, whatever its editor is."""
    match field:
        case PerAxis():
            for letter, text in zip(AXES, value, strict=True):
                if text:
                    _type(hands, cells[name, letter], field.of, text)
        case ListOf():
            _rows(hands, cells[name, ""].editor, field, value)
        case Table():
            _paste(hands, cells[name, ""].editor, value)
        case _:
            _type(hands, cells[name, ""], field, value)


def _type(hands: Hands, cell: QWidget, field: Field, value: Any) -> None:
    assert cell.isVisible()
    if isinstance(field, Flag) and (boxes := cell.findChildren(QCheckBox)):
        if boxes[0].isChecked() != (value is True or value == "on"):
            hands.press(boxes[0])
        return
    text = field.words.get(value, value.value) if isinstance(field, Choice) else str(value)
    if isinstance(field, AxisSet):
        for button in _buttons(cell):
            if button.isChecked() != (button.text() in value):
                hands.press(button)
        return
    boxes = [box for box in cell.findChildren(QComboBox) if box.isVisible() and not box.isEditable()]
    if boxes:
        hands.choose(boxes[0], text[:1].upper() + text[1:] if boxes[0].findText(text) < 0 else text)
        return
    areas = [area for area in cell.findChildren(QPlainTextEdit) if area.isVisible()]
    lines = [line for line in cell.findChildren(QLineEdit) if line.isVisible()]
    if areas:
        _focus(hands, areas[0])
        QTest.keyClicks(areas[0], text)
    elif lines:
        hands.fill(lines[0], text)
    else:
        button = next(each for each in _buttons(cell) if each.text().lower() == text.lower())
        if not button.isChecked():
            hands.take(button)


def _focus(hands: Hands, widget: QAbstractScrollArea) -> None:
    if isinstance(hands, Keys):
        hands.go_to(widget)
    else:
        QTest.mouseClick(widget.viewport(), Qt.MouseButton.LeftButton)


def _buttons(cell: QWidget) -> list[QPushButton]:
    return [each for each in cell.findChildren(QPushButton) if each.isCheckable() and each.isVisible()]


def _rows(hands: Hands, editor: Any, field: ListOf, rows: tuple[Any, ...]) -> None:
    """The entries of a list, one after the other."""
    for number, row in enumerate(rows):
        if len(editor.rows) <= number:
            hands.press(editor.buttons["add"])
        for name, inner in fields_of(field.row).items():
            if read.shown(row, name) and getattr(editor.rows[number], name) != getattr(row, name):
                _field(hands, editor.form.cells, name, inner, getattr(row, name))
        assert editor.rows[number] == row, f"{editor.rows[number]}\n{row}"


def _paste(hands: Hands, editor: Any, table: str) -> None:
    """A table as it comes out of a spreadsheet."""
    clipboard = QGuiApplication.clipboard()
    clipboard.setText(table)
    _focus(hands, editor.view)
    QTest.keySequence(editor.view, "Ctrl+V")
    QApplication.processEvents()
