"""Terminal and answer box."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot

from app.theme import Choice, Theme
from device.api import Controller, Prompt, Reply, State
from tests.rig import Rig
from widgets.parts.look import look
from widgets.terminal.code_window import CodeWindow
from widgets.terminal.prompt import PromptBox
from widgets.terminal.terminal import TerminalPanel


@pytest.fixture(scope="module", autouse=True)
def _theme(qapp: object) -> object:
    return Theme(qapp, Choice.LIGHT)  # type: ignore[arg-type]


@pytest.fixture
def rig() -> Rig:
    return Rig().ready()


@pytest.fixture
def terminal(qtbot: QtBot, rig: Rig) -> TerminalPanel:
    terminal = TerminalPanel()
    qtbot.addWidget(terminal)
    terminal.attach(rig.controller)
    terminal.show()
    terminal.refresh(rig.controller.last())
    return terminal


def ask(terminal: TerminalPanel, rig: Rig, command: str) -> Reply:
    """What the machine answers, shown."""
    reply = rig.result(rig.controller.ask(command))
    terminal.show_reply(command, reply)
    return reply


def hear(terminal: TerminalPanel, rig: Rig) -> None:
    """Everything that has happened."""
    rig.run(0.5)
    for notice in rig.controller.notices():
        terminal.notice(notice)


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


def test_replies_and_the_reason_behind_a_question_mark(terminal: TerminalPanel, rig: Rig) -> None:
    ask(terminal, rig, "DP 6370")
    ask(terminal, rig, "TPX")
    reply = ask(terminal, rig, "KP 5000")  # KP goes to 1023.875 (dmc-1412-1414.txt, KP)
    lines = terminal.log.toPlainText().splitlines()
    assert reply.code == 6  # number out of range
    assert "   0000006370" in lines  # ten digits, LZ 0
    assert lines[-1] == "? KP 5000: refused, error 6, Number out of range."


def test_an_uncertain_reply_says_so(terminal: TerminalPanel) -> None:
    terminal.show_reply("TPX", Reply("12", True, certain=False))
    assert "uncertain" in terminal.log.toPlainText()


def test_what_the_program_says_has_another_colour(terminal: TerminalPanel, rig: Rig) -> None:
    ask(terminal, rig, "MG 6370")
    rig.start('MG "LENGTH 10"\nEN')
    hear(terminal, rig)
    blocks = [terminal.log.document().findBlockByNumber(n) for n in range(terminal.log.blockCount())]
    colours = {block.text(): block.begin().fragment().charFormat().foreground().color().name() for block in blocks}
    assert colours["« LENGTH 10"] != colours["   0000006370.0000"]


def test_where_a_program_stopped_is_shown_as_a_refusal(terminal: TerminalPanel, rig: Rig) -> None:
    rig.start("PR 1000;BGX\nPR 5000;BGX\nEN")  # the second begin comes while X moves
    hear(terminal, rig)
    assert any(line.startswith("? ") and "001 PR 5000;BGX" in line for line in terminal.log.toPlainText().splitlines())


def test_it_shows_the_newest_lines_but_stays_where_somebody_reads(terminal: TerminalPanel) -> None:
    terminal.resize(400, 160)
    for number in range(40):
        terminal.write("said", f"line {number}")
    bar = terminal.log.verticalScrollBar()
    assert 0 < bar.maximum() == bar.value()
    bar.setValue(3)
    terminal.write("said", "one more")
    assert bar.value() == 3
    terminal.hide()
    terminal.show()
    assert bar.value() == bar.maximum()


def test_it_says_what_is_connected_and_when_it_is_lost(terminal: TerminalPanel, rig: Rig) -> None:
    hear(terminal, rig)
    assert "— Connected to DMC1520 Rev 2.0h. —" in terminal.log.toPlainText()
    rig.cut()
    rig.until(lambda: rig.controller.state is State.LOST)
    hear(terminal, rig)
    assert "— The controller does not answer. —" in terminal.log.toPlainText()


def test_live_reads_are_shown_when_asked_for(terminal: TerminalPanel, rig: Rig) -> None:
    rig.values(("position.x",))
    terminal.refresh(rig.controller.last())
    assert "_TPX" not in terminal.log.toPlainText()
    terminal.traffic.click()
    terminal.refresh(rig.controller.last())
    assert "· > MG" in terminal.log.toPlainText()
    assert "_TPX" in terminal.log.toPlainText()


def test_earlier_lines_come_back_with_the_arrows(terminal: TerminalPanel) -> None:
    enter(terminal, "PR 1")
    enter(terminal, "PR 2")
    QTest.keyClick(terminal.line, Qt.Key.Key_Up)
    QTest.keyClick(terminal.line, Qt.Key.Key_Up)
    assert terminal.line.text() == "PR 1"
    QTest.keyClick(terminal.line, Qt.Key.Key_Down)
    QTest.keyClick(terminal.line, Qt.Key.Key_Down)
    assert terminal.line.text() == ""


def offline() -> Controller:
    return Controller.offline()


def asking() -> Controller:
    rig = Rig(program='IN "Pieces?",N\nEN').ready()
    rig.result(rig.controller.execute(anyway=True))
    rig.until(lambda: rig.controller.pending_prompt is not None)
    return rig.controller


@pytest.mark.parametrize(("situation", "words"), [(offline, "Connect"), (asking, "Use the answer box")])
def test_when_nothing_can_be_typed_it_says_why(
    terminal: TerminalPanel, situation: Callable[[], Controller], words: str
) -> None:
    controller = situation()
    terminal.attach(controller)
    terminal.refresh(controller.last())
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


def test_lines_take_the_colours_of_another_theme(_theme: Theme, terminal: TerminalPanel) -> None:
    terminal.write("refused", "a reason")
    terminal.write("reply", "1, 2")

    def colours() -> list[str]:
        document = terminal.log.document()
        blocks = [document.findBlockByNumber(document.blockCount() - back) for back in (2, 1)]
        return [block.begin().fragment().charFormat().foreground().color().name() for block in blocks]

    light = colours()
    _theme.choose(Choice.DARK)
    try:
        dark = [look().colour(name).name() for name in ("fault", "text")]
        assert colours() == dark != light
    finally:
        _theme.choose(Choice.LIGHT)
    assert colours() == light
