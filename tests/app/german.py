"""The whole studio in a German environment, every place a number is entered: `python -m tests.app.german FOLDER`.

Run in a process of its own, with the environment of a German computer. Says what was walked, ends with an assertion
where a number came in as another one.
"""

from __future__ import annotations

import dataclasses as dc
import sys
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any

from PySide6.QtCore import QLocale, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QAbstractSpinBox, QApplication, QDoubleSpinBox, QLineEdit, QWidget

from codegen import fields
from codegen.instructions import ALL, Instruction, SingleAxisMove
from codegen.instructions.motion import MoveMode
from codegen.numbers import parse_number
from tests.long import is_long
from tests.stage import Stage, make_studio
from widgets.form.form import InstructionForm

# what a person in Germany may type or paste, and the only number it may ever be
MEANT: dict[str, Fraction | None] = {"1.234": Fraction(1234, 1000), "12,5": None, "1.234,5": None}
MORE: dict[str, Fraction | None] = {"1,234.5": None, "1 234": None, "1'234": None, "12.5": Fraction(25, 2)}
NUMERIC = (fields.Quantity, fields.Number, fields.ExpressionField)
walked: dict[str, int] = {}


def texts() -> dict[str, Fraction | None]:
    return {**MEANT, **MORE} if is_long() else MEANT


def typed(line: QLineEdit, text: str) -> None:
    """Pasted over what stands there, as an edit of the person."""
    QApplication.clipboard().setText(text)
    line.selectAll()
    line.paste()
    assert line.text() == text, f"{line.accessibleName()}: {text} became {line.text()}"


def variants(kind: type[Instruction]) -> Iterator[Instruction]:
    """The instruction with each of its choices, so that every field is to be seen once."""
    yield kind()
    for name, field in fields.fields_of(kind).items():
        if isinstance(field, fields.Choice):
            for each in field.kind:
                yield dc.replace(kind(), **{name: each})


def value_in(item: Any, name: str, axis: str) -> str:
    value = getattr(item, name)
    return str(value["XYZW".index(axis)] if axis else value)


def walk_form(form: InstructionForm, kind: type[Instruction]) -> None:
    """Every field that takes a number."""
    seen: set[tuple[str, str]] = set()
    for instruction in variants(kind):
        form.show_instruction(instruction)
        for (name, axis), cell in form.fields.cells.items():
            field = fields.fields_of(kind)[name]
            of = field.of if isinstance(field, fields.PerAxis) else field
            lines = [line for line in cell.findChildren(QLineEdit) if not line.isReadOnly()]
            if (name, axis) in seen or cell.isHidden() or not isinstance(of, NUMERIC) or not lines:
                continue
            seen.add((name, axis))
            for text, meant in texts().items():
                typed(lines[0], text)
                assert value_in(form.instruction, name, axis) == text
                assert parse_number(text) == meant
                if meant is None:
                    assert form.problem, f"{kind.title}, {name}: {text} is taken"
                walked["fields of dialogs"] = walked.get("fields of dialogs", 0) + 1


def walk_dialogs(stage: Stage) -> None:
    program = stage.studio.program
    for kind in ALL:
        program.dialogs.add(kind)
        dialog = program.dialogs.open[-1]
        form = dialog.findChild(InstructionForm)
        assert form is not None
        walk_form(form, kind)
        dialog.reject()
        stage.go(1)


def walk_code(stage: Stage) -> None:
    """What was typed is what is sent: 1.234 in at 637 counts/in is 786 counts, not 785 958."""
    session = stage.studio.session
    made = session.insert([SingleAxisMove(axis="X", mode=MoveMode.BY, distance="1.234", speed="5")])
    code = [session.listing.lines[line].text for line in session.listing.lines_of(made[0])]
    assert "PR 786" in code, code
    session.undo()


def walk_spin_boxes(windows: list[QWidget]) -> None:
    """A spin box writes and reads a point; none of them knows a separator of thousands."""
    for window in windows:
        for box in window.findChildren(QDoubleSpinBox):
            assert box.locale().decimalPoint() == ".", box.accessibleName()
            box.setValue(box.maximum() / 3)
            assert "," not in box.text(), box.text()
            low, high = box.minimum(), box.maximum()
            wanted = round(low + (high - low) * 0.75, 1)
            line = box.findChild(QLineEdit)
            assert line is not None
            line.selectAll()
            QTest.keyClicks(line, f"{wanted:.1f}")
            box.interpretText()
            assert abs(box.value() - wanted) < 0.051, f"{box.accessibleName()}: {wanted} became {box.value()}"
            walked["spin boxes"] = walked.get("spin boxes", 0) + 1
        for whole in window.findChildren(QAbstractSpinBox):
            assert not whole.isGroupSeparatorShown()


def walk_display(stage: Stage) -> None:
    """Positions are shown with a point, whatever the country."""
    rig = stage.connect("simulator", "ssc1")
    rig.controller.take_control()
    stage.type("DP 7863")
    stage.go(20)
    shown = [each.text() for each in stage.studio.window.findChildren(QWidget) if callable(getattr(each, "text", None))]
    assert any("12.34" in text for text in shown if isinstance(text, str)), "the position is shown"
    assert not any("12,34" in text for text in shown if isinstance(text, str))
    stage.type("MG 1.234")
    lines = stage.studio.terminal.log.toPlainText()
    assert "1.234" in lines and "1,234" not in lines
    walked["displays"] = 1


def walk_terminal(stage: Stage) -> None:
    """A line leaves as it was typed."""
    stage.type("V=12.5", "MG V")
    assert "V=12.5" in [line.partition(";")[0] for line in stage.rig.lines]
    assert stage.rig.simulation.state()["variables"]["V"] == 12.5
    walked["terminal lines"] = 2


def walk_answers(stage: Stage) -> None:
    """What a program asks for: 12,5 cannot be sent, 12.5 is 12.5."""
    rig = stage.question("simulator", "ssc1")
    stage.go(10)
    box = stage.studio.window.prompt
    typed(box.line, "12,5")
    assert not box.send.isEnabled(), "an answer of 12,5 would be 12"
    typed(box.line, "12.5")
    box.send.click()
    stage.until(lambda: rig.simulation.state()["variables"].get("LEN") == 12.5)
    walked["answers to the program"] = 2


def walk_setup(stage: Stage) -> None:
    """The set-up: every line that changes an axis or the loop rate; what is no number keeps Done grey."""
    stage.studio.actions["setup"].trigger()
    stage.go(2)
    window = stage.studio.setup.window
    assert window is not None
    pages = [page for page in window.pages if page not in (window.names, window.notes)]
    lines = [(page, line) for page in pages for line in page.findChildren(QLineEdit)]
    for line in [line for page, line in lines if line.isVisibleTo(page) and line.isEnabled()]:
        before, shown = window.setup, line.text()
        for text, meant in texts().items():
            typed(line, text)
            now = window.setup
            names = [axis.unit_name for axis in now.axes] != [axis.unit_name for axis in before.axes]
            if names or (now.axes, now.sample_us) == (before.axes, before.sample_us):
                break  # a name, a plate, a serial number
            assert any(text in dc.astuple(axis) for axis in now.axes) or now.sample_us == text  # kept as it was typed
            if meant is None:
                assert not window.done_button.isEnabled(), f"set-up, {line.accessibleName()}: {text} is taken"
            walked["lines of the set-up"] = walked.get("lines of the set-up", 0) + 1
        line.selectAll()
        QTest.keyClick(line, Qt.Key.Key_Backspace)
        QTest.keyClicks(line, shown)
    window.reject()


def main(folder: Path) -> None:
    application = QApplication([])
    QLocale.setDefault(QLocale(QLocale.Language.German, QLocale.Country.Germany))
    assert QLocale().decimalPoint() == ","
    stage = make_studio(folder)
    stage.studio.window.show()
    stage.go()
    walk_dialogs(stage)
    walk_code(stage)
    walk_setup(stage)
    walk_display(stage)
    walk_terminal(stage)
    walk_answers(stage)
    stage.studio.options.show()
    stage.go(2)
    walk_spin_boxes(application.topLevelWidgets())
    for what, number in walked.items():
        print(f"{number} {what}")
    stage.studio.close()


if __name__ == "__main__":
    main(Path(sys.argv[1]))
