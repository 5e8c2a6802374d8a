"""After an edit only what looks new is painted: the screen must be as if all of it were painted."""

from __future__ import annotations

import random

import pytest
from PySide6.QtGui import QImage
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from app.session import Session
from codegen.document import Document
from codegen.instructions import Comment, Instruction, Label, Output, Repeat, SingleAxisMove, Wait
from codegen.program import Place, Program, Section, Step
from codegen.setup import Setup
from tests.long import count
from widgets.program.view import ProgramView

STEPS = 60  # more than fit
KINDS: tuple[Instruction, ...] = (
    Wait(time="7"),
    SingleAxisMove(distance="2", speed="5"),
    SingleAxisMove(),  # it has a problem
    Comment(text="Beside the door"),
    Repeat(count="3"),
    Label(name="AGAIN"),  # the second one is a problem
)


def screen(view: ProgramView) -> QImage:
    """What is on the screen, not what would be painted."""
    QApplication.processEvents()
    QApplication.processEvents()  # what the first painting asked for
    return QApplication.primaryScreen().grabWindow(view.winId()).toImage()


def one_edit(chance: random.Random, session: Session, view: ProgramView) -> str:
    """Something a person does, mostly in sight."""
    steps = [step.id for step in session.document.program.main]
    near = chance.choice(steps[: chance.choice((8, len(steps)))])
    kind = chance.randrange(9)
    if kind == 0 and len(steps) > STEPS // 2:
        session.remove([near])
    elif kind == 1:
        session.insert([chance.choice(KINDS)], near)
    elif kind == 2:
        session.move([near], Place(Section.MAIN, chance.randrange(len(steps))))
    elif kind == 3:
        session.comment_out([near])
    elif kind == 4:
        session.undo()
    elif kind == 5:
        view.tree.choose([near])
    elif kind == 6:
        view.show_executing({0: chance.randrange(20)})
    elif kind == 7:
        session.set_note(near, f"note {chance.randrange(9)}")
    else:
        session.replace(near, chance.choice(KINDS[:4]))
    return f"{kind} at {near}"


@pytest.mark.parametrize("mode", ["program", "both", "code"])
def test_the_screen_is_as_if_everything_were_painted(qtbot: QtBot, mode: str) -> None:
    main = tuple(Step(f"s{number}", Output(output=str(1 + number % 8))) for number in range(STEPS))
    session = Session(Document(Program("P", main=main), Setup(model="ssc4")))
    view = ProgramView(session)
    qtbot.addWidget(view)
    view.resize(900, 500)
    view.show()
    view.set_view(mode)
    qtbot.waitExposed(view)
    chance = random.Random(7)
    done: list[str] = []
    for _ in range(count(25, 1000)):
        done.append(one_edit(chance, session, view))
        shown = screen(view)
        assert shown.width() >= 900 and shown.pixelColor(450, 300) != shown.pixelColor(0, 0), shown.size()
        for area in (view.tree, view.code):
            area.viewport().update()
        view.code.margin.update()
        assert shown == screen(view), done[-3:]
