"""Terminal and answer box."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot

from app.theme import Choice, Theme
from device.api import Kind, Notice, NoticeKind, Prompt, Reply
from tests.fakes import FakeController, row_of
from widgets.terminal.code_window import CodeWindow
from widgets.terminal.prompt import PromptBox
from widgets.terminal.terminal import TerminalPanel


@pytest.fixture(scope="module", autouse=True)
def _theme(qapp: object) -> object:
    return Theme(qapp, Choice.LIGHT)  # type: ignore[arg-type]


@pytest.fixture
def terminal(qtbot: QtBot) -> TerminalPanel:
    terminal = TerminalPanel()
    qtbot.addWidget(terminal)
    terminal.attach(FakeController(Kind.SIMULATOR))  # type: ignore[arg-type]
    terminal.show()
    terminal.refresh(row_of({}))
    return terminal


def enter(terminal: TerminalPanel, text: str) -> None:
    QTest.keyClicks(terminal.line, text)
    QTest.keyClick(terminal.line, Qt.Key.Key_Return)


def test_a_typed_command_goes_up_and_is_shown(terminal: TerminalPanel) -> None:
    sent: list[str] = []
    terminal.command.connect(sent.append)
    enter(terminal, "MG _TPX")
    assert sent == ["MG _TPX"]
    assert "› MG _TPX" in terminal.log.toPlainText()
    assert terminal.line.text() == ""


def test_an_empty_line_sends_nothing(terminal: TerminalPanel) -> None:
    sent: list[str] = []
    terminal.command.connect(sent.append)
    enter(terminal, "  ")
    assert sent == []


def test_replies_and_the_reason_behind_a_question_mark(terminal: TerminalPanel) -> None:
    terminal.show_reply("TPX", Reply("6370", True))
    terminal.show_reply("PR 1,,,9", Reply("", False, True, 4, "refused, error 4, Operand error."))
    text = terminal.log.toPlainText()
    assert "6370" in text
    assert "? PR 1,,,9" in text
    assert "Operand error" in text


def test_an_uncertain_reply_says_so(terminal: TerminalPanel) -> None:
    terminal.show_reply("TPX", Reply("12", True, certain=False))
    assert "uncertain" in terminal.log.toPlainText()


def test_what_the_program_says_has_another_colour(terminal: TerminalPanel) -> None:
    terminal.show_reply("TPX", Reply("6370", True))
    terminal.notice(Notice(NoticeKind.MESSAGE, "LENGTH 10", 0.0))
    blocks = [terminal.log.document().findBlockByNumber(n) for n in range(terminal.log.blockCount())]
    colours = {block.text(): block.begin().fragment().charFormat().foreground().color().name() for block in blocks}
    assert colours["« LENGTH 10"] != colours["  6370"]


def test_earlier_lines_come_back_with_the_arrows(terminal: TerminalPanel) -> None:
    enter(terminal, "PR 1")
    enter(terminal, "PR 2")
    QTest.keyClick(terminal.line, Qt.Key.Key_Up)
    QTest.keyClick(terminal.line, Qt.Key.Key_Up)
    assert terminal.line.text() == "PR 1"
    QTest.keyClick(terminal.line, Qt.Key.Key_Down)
    QTest.keyClick(terminal.line, Qt.Key.Key_Down)
    assert terminal.line.text() == ""


@pytest.mark.parametrize(
    ("kind", "control", "words"), [("offline", False, "Connect"), ("machine", False, "switch to Control")]
)
def test_when_nothing_can_be_typed_it_says_why(terminal: TerminalPanel, kind: str, control: bool, words: str) -> None:
    fake = FakeController(Kind(kind))
    fake.control = control
    terminal.attach(fake)  # type: ignore[arg-type]
    terminal.refresh(row_of({}))
    assert not terminal.line.isEnabled()
    assert words in terminal.why.text()


def test_the_answer_box_shows_only_while_something_is_asked(qtbot: QtBot) -> None:
    box = PromptBox()
    qtbot.addWidget(box)
    assert box.isHidden()
    box.show_prompt(Prompt("Pieces?", (7,)))
    assert "Pieces?" in box.text.text()
    answers: list[str] = []
    box.answered.connect(answers.append)
    QTest.keyClicks(box.line, "50")
    box.send.click()
    assert answers == ["50"]
    box.show_prompt(None)
    assert box.isHidden()


def test_the_same_question_does_not_wipe_what_was_typed(qtbot: QtBot) -> None:
    box = PromptBox()
    qtbot.addWidget(box)
    box.show_prompt(Prompt("Pieces?", (7,)))
    box.line.setText("12")
    box.show_prompt(Prompt("Pieces?", (7,)))
    assert box.line.text() == "12"


def test_uploaded_code_that_is_the_same_says_so(qtbot: QtBot) -> None:
    window = CodeWindow("Upload", "#A\r\nEN\r\n", "#A\nEN\n")
    qtbot.addWidget(window)
    assert "are the code of the open program" in window.words.text()


def test_an_empty_controller_says_so(qtbot: QtBot) -> None:
    window = CodeWindow("Upload", "", "#A\nEN\n")
    qtbot.addWidget(window)
    assert "no program" in window.words.text()
    assert not window.save.isEnabled()
