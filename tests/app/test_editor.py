"""The code editor by mouse and keys: completion, problems, files, and the controller."""

from __future__ import annotations

import statistics
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from app import checking
from app.checking import Checked
from codegen.models import Model
from tests.app.pauses import queued_ms
from tests.long import is_long, record
from tests.slower import slower
from tests.stage import Stage, make_studio
from widgets.editor.window import EditorWindow

CODE = "#GO\nPR 500\nBG X\nAM X\nEN"


@pytest.fixture
def stage(qapp: QApplication, tmp_path: Path) -> Iterator[Stage]:
    made = make_studio(tmp_path)
    made.studio.window.show()
    made.go()
    made.studio.actions["editor"].trigger()
    made.go()
    yield made
    if made.studio.editor.window is not None:
        made.studio.editor.window.text.document().setModified(False)
    made.clear_away()


def window(stage: Stage) -> EditorWindow:
    assert stage.studio.editor.window is not None
    return stage.studio.editor.window


def press(stage: Stage, name: str) -> None:
    button = window(stage).buttons[name]
    assert button.isEnabled(), button.toolTip()
    QTest.mouseClick(button, Qt.MouseButton.LeftButton)
    stage.go(2)


def answer(stage: Stage, words: str) -> None:
    question = stage.studio.desk.question
    assert question is not None
    question.buttons[words].click()
    stage.go(2)


def checked(stage: Stage) -> None:
    """Until the text is checked as it is."""
    text = window(stage).text
    text.check_now()
    known = stage.studio.editor.checking.knows
    stage.until(lambda: known(text.toPlainText(), text.model) is not None, 2000)  # it takes time of this world


def test_it_completes_checks_and_goes_to_labels_and_problems(stage: Stage) -> None:
    text = window(stage).text
    text.setFocus()
    QTest.keyClicks(text, "#GO")
    QTest.keyClick(text, Qt.Key.Key_Return)
    QTest.keyClicks(text, "A")
    assert {"AC", "AM"} <= set(text.offer.texts)
    QTest.keyClicks(text, "C")
    QTest.keyClick(text, Qt.Key.Key_Escape)
    checked(stage)  # as after a pause: now the label is known
    QTest.keyClicks(text, " 5;JP #")
    assert "#GO" in text.offer.texts
    QTest.keyClick(text, Qt.Key.Key_Tab)
    assert text.toPlainText() == "#GO\nAC 5;JP #GO"
    QTest.keyClick(text, Qt.Key.Key_Return)
    QTest.keyClicks(text, "QQ 1")
    checked(stage)
    assert any(problem.line == 2 for problem in text.problems)
    shown = [window(stage).list.item(row).text() for row in range(window(stage).list.count())]
    row = next(index for index, words in enumerate(shown) if "line 2" in words)
    window(stage).list.setCurrentRow(row)
    window(stage).list.itemActivated.emit(window(stage).list.item(row))
    assert text.textCursor().blockNumber() == 2
    labels = window(stage).labels
    assert labels.itemText(1) == "#GO"
    labels.setCurrentIndex(1)
    labels.activated.emit(1)
    assert text.textCursor().blockNumber() == 0


def test_files_are_opened_saved_and_never_lost(stage: Stage, tmp_path: Path) -> None:
    path = tmp_path / "go.dmc"
    path.write_bytes(CODE.replace("\n", "\r\n").encode())
    stage.studio.editor.open(path)
    assert window(stage).text.toPlainText() == CODE and not window(stage).dirty
    QTest.keyClicks(window(stage).text, "NO ")
    assert window(stage).windowTitle().endswith("*")
    window(stage).close()
    assert window(stage).isVisible()  # asked about first
    answer(stage, "Save first")
    assert path.read_text(encoding="utf-8").startswith("NO #GO")
    window(stage).close()
    assert not window(stage).isVisible()
    broken = tmp_path / "broken.dmc"
    broken.write_bytes(b"\xff\xfe\x00")
    stage.studio.editor.open(broken)
    assert "broken.dmc was not opened" in window(stage).words.text()
    assert window(stage).text.toPlainText().startswith("NO #GO")


def test_offline_and_watch_say_why_buttons_are_grey(stage: Stage) -> None:
    assert not window(stage).buttons["Download"].isEnabled()
    assert window(stage).buttons["Download"].toolTip() == "Nothing is connected."
    stage.connect("machine", "ssc1")
    stage.go(5)
    assert window(stage).buttons["Upload"].isEnabled()
    assert "Watch" in window(stage).buttons["Download"].toolTip()


def test_code_goes_to_the_controller_runs_and_comes_back(stage: Stage) -> None:
    rig = stage.connect("simulator", "ssc1")
    window(stage).show_text(CODE, None)
    stage.go(5)
    press(stage, "Download")
    stage.until(lambda: list(rig.program) == CODE.split("\n") and not stage.studio.run.doing, 2000)
    press(stage, "Execute")
    answer(stage, "Run what is in the controller")
    stage.until(lambda: rig.simulation.state()["axes"]["X"]["commanded"] == 500)
    window(stage).show_text("", None)
    press(stage, "Upload")
    stage.until(lambda: window(stage).text.toPlainText() == CODE)


def test_code_with_errors_is_asked_about(stage: Stage) -> None:
    rig = stage.connect("simulator", "ssc1", program="#OLD\nEN")
    window(stage).show_text("#A\nPR 5O0\nEN", None)
    stage.go(5)
    press(stage, "Download")
    stage.until(lambda: stage.studio.desk.question is not None, 2000)
    question = stage.studio.desk.question
    assert question is not None and question.words.startswith("Line 1")
    question.close()
    assert list(rig.program) == ["#OLD", "EN"]


def test_code_becomes_steps_of_the_program(stage: Stage) -> None:
    before = len(stage.studio.session.listing.text.split("\n"))
    window(stage).show_text(CODE, None)
    stage.go(2)
    press(stage, "Insert into the program")
    stage.go(5)
    listing = stage.studio.session.listing.text
    assert "PR 500" in listing and len(listing.split("\n")) > before


def test_a_download_waits_for_the_check_of_exactly_this_text(stage: Stage, monkeypatch: pytest.MonkeyPatch) -> None:
    rig = stage.connect("simulator", "ssc1", program="#OLD\nEN")
    window(stage).show_text(CODE, None)
    stage.go(5)
    may_end = threading.Event()

    def slowly(text: str, model: Model) -> Checked:
        may_end.wait(10)
        return examined(text, model)

    examined = checking.checked
    monkeypatch.setattr(checking, "checked", slowly)
    window(stage).text.appendPlainText("NO 1")
    press(stage, "Download")
    stage.go(20)
    assert list(rig.program) == ["#OLD", "EN"]  # it is not known yet whether it is right
    window(stage).text.appendPlainText("NO 2")
    may_end.set()
    stage.until(lambda: "press Download again" in window(stage).words.text(), 2000)
    assert list(rig.program) == ["#OLD", "EN"]
    stage.until(lambda: window(stage).buttons["Download"].isEnabled())
    press(stage, "Download")
    stage.until(lambda: list(rig.program) == [*CODE.split("\n"), "NO 1", "NO 2"], 2000)


def gaps(stage: Stage, until: Callable[[], bool]) -> float:
    """The longest time in ms in which nothing else had its turn, without what other programs took."""
    longest, last = 0.0, 1000 * time.perf_counter() - queued_ms()
    while not until():
        stage.go()
        now = 1000 * time.perf_counter() - queued_ms()
        longest, last = max(longest, now - last), now
    return longest


@pytest.mark.alone
def test_a_thousand_lines_are_checked_beside_the_window(stage: Stage) -> None:
    """No gap of more than 50 ms, beyond what the same window shows at that time while nothing is checked."""
    code = "\n".join(
        f'PR {number};BG X;AM X;MG "AT",_TPX{{N}}' if number % 9 else f"#L{number}" for number in range(1000)
    )
    editor, text = stage.studio.editor, window(stage).text

    def is_checked() -> bool:
        return editor.checking.knows(text.toPlainText(), text.model) is not None

    def one() -> tuple[float, float]:
        end = time.perf_counter() + 0.3
        calm = gaps(stage, lambda: time.perf_counter() > end)
        QTest.keyClicks(text, "N")
        text.check_now()
        return calm, gaps(stage, is_checked)

    window(stage).show_text(code, None)
    gaps(stage, is_checked)
    tries = [one() for _ in range(5)]
    assert len(text.problems) > 0 and window(stage).list.count() == len(text.problems)
    usual = statistics.median(beside - calm for calm, beside in tries)
    record("code check of 1000 lines: gap", "python -m pytest tests/app/test_editor.py --long", None, usual, "ms")
    assert usual < 50 * (1.0 if is_long() else slower()), tries
