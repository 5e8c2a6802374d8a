"""The teach panel on a simulated table, its joystick moved by the test."""

from __future__ import annotations

import dataclasses as dc
from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QLineEdit, QPushButton

from codegen.setup import Unit
from tests.rig import LINE
from tests.stage import make_studio
from widgets.parts.question import Question
from widgets.teach.numbers import Numbers
from widgets.teach.panel import TeachPanel
from widgets.teach.parts import Parts

LEFT = Qt.MouseButton.LeftButton
ALONE = LINE.baud is not None and LINE.baud < 19_200  # so slow that the axis that is pushed further goes alone
PRESS = 15 if ALONE else 5  # ticks a button is held
MIDDLE, REACH = 2.5, 2.5  # volts of a joystick between 0 and 5 V (SSC manual, figure 2.5)


class Bench:
    """Offline first; `connect` goes on."""

    def __init__(self, folder: Path, example: str = "wire-cutter.tlp") -> None:
        self.stage = stage = make_studio(folder, example=example)
        document = stage.studio.session.document
        axis = dc.replace(
            document.setup.axes[0], unit=Unit.MM, counts_per_unit="1000", reverse_limit="-50", forward_limit="200"
        )
        setup = dc.replace(document.setup, model="ssc2", axes=(axis,) * 4)
        stage.studio.session.set_document(dc.replace(document, setup=setup), "Table")
        stage.studio.window.resize(1400, 900)
        stage.studio.window.show()
        stage.go()
        stage.studio.desk.bring("Teach")
        stage.go()

    @property
    def panel(self) -> TeachPanel:
        return self.stage.studio.at_machine.table

    @property
    def parts(self) -> Parts:
        assert self.panel.parts is not None
        return self.panel.parts

    @property
    def rows(self) -> tuple[dict[str, str], ...]:
        """What the table holds, without what does not apply."""
        rows = self.stage.studio.at_machine.teach.table.rows
        return tuple({name: text for name, text in dc.asdict(row).items() if text} for row in rows)

    def connect(self, kind: str = "simulator") -> Bench:
        self.stage.connect(kind, "ssc2")
        self.push(0, 0)
        self.stage.go(10)
        return self

    def push(self, x: float, y: float) -> None:
        """The joystick at the controller, -1 to 1."""
        for number, share in ((1, x), (2, y)):
            self.stage.rig.simulation.stimulus(f"an{number}", MIDDLE + share * REACH)

    def press(self, number: int) -> None:
        """One of the joystick's buttons, and back."""
        for level in (0, 1):
            self.stage.rig.simulation.stimulus(f"in{number}", level)
            self.stage.go(PRESS)

    def click(self, button: QPushButton) -> None:
        assert button.isEnabled(), (button.text(), button.toolTip())
        QTest.mouseClick(button, LEFT)
        self.stage.go(2)

    def enable(self) -> Bench:
        self.parts.enable.setFocus()
        self.click(self.parts.enable)
        self.stage.go(10)
        assert self.panel.enabled, self.panel.words()
        return self

    def fill(self, numbers: Numbers, name: str, text: str) -> None:
        """A number by keys."""
        numbers.fields[name].setFocus()
        numbers.fields[name].selectAll()
        QTest.keyClick(numbers.fields[name], Qt.Key.Key_Delete)
        QTest.keyClicks(numbers.fields[name], text)

    def typed(self, row: int, column: int, text: str) -> None:
        """A cell by keys."""
        self.parts.view.setFocus()
        self.parts.view.go_to(row, column)
        QTest.keyClick(self.parts.view, Qt.Key.Key_Return)
        editor = next(each for each in self.parts.view.findChildren(QLineEdit) if each.isVisible())
        editor.selectAll()
        QTest.keyClicks(editor, text)
        QTest.keyClick(editor, Qt.Key.Key_Return)
        self.stage.go(1)

    def answer(self, title: str, button: str) -> None:
        """The question that stands there."""
        asked = [each for each in self.stage.studio.window.findChildren(Question) if each.windowTitle() == title]
        assert asked, [each.windowTitle() for each in self.stage.studio.window.findChildren(Question)]
        self.question = asked[-1].words
        asked[-1].buttons[button].click()
        self.stage.go(2)

    @property
    def places(self) -> tuple[int, int]:
        """Where the axes are commanded to be, told by the simulation itself."""
        axes = self.stage.rig.simulation.state()["axes"]
        return axes["X"]["commanded"], axes["Y"]["commanded"]

    @property
    def moving(self) -> bool:
        return bool(self.stage.rig.moving)

    @property
    def outputs(self) -> int:
        return int(self.stage.rig.simulation.unit.state.outputs)

    def still(self) -> None:
        self.stage.until(lambda: not self.moving and not self.stage.controller.motion.ghost)
        self.stage.go(4)
