"""A program window on the wire cutter's machine, in the light theme."""

from __future__ import annotations

import dataclasses as dc

import pytest
from PySide6.QtWidgets import QApplication, QHBoxLayout, QWidget
from pytestqt.qtbot import QtBot

from app.session import Session
from app.theme import Choice, Theme
from codegen.document import Document
from codegen.program import Program, Step
from tests.widgets.form.samples import machine
from widgets.program.view import ProgramView


@pytest.fixture(autouse=True, scope="session")
def light(qapp: QApplication) -> Theme:
    """The theme the widgets paint with; one for all tests, as in the program."""
    return Theme(qapp, Choice.LIGHT)


@dc.dataclass
class Window:
    """The program window as a person has it: palette, program, inspector side by side."""

    session: Session
    view: ProgramView
    frame: QWidget

    def main(self) -> list[Step]:
        """The steps of Main."""
        return list(self.session.document.program.main)

    def code(self) -> list[str]:
        """The generated code."""
        return [line.text for line in self.session.listing.lines]


@pytest.fixture
def window(qtbot: QtBot) -> Window:
    """An empty program called CUTTER."""
    session = Session(Document(Program(name="CUTTER"), machine()))
    view = ProgramView(session)
    frame = QWidget()
    row = QHBoxLayout(frame)
    for widget in (view.instructions, view, view.inspector):
        row.addWidget(widget)
    qtbot.addWidget(frame)
    frame.resize(1280, 800)
    frame.show()
    return Window(session, view, frame)
