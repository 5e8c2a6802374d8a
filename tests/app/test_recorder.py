"""The recorder in the studio: what was recorded is played by mouse and keys, in the windows, and nothing is sent."""

from __future__ import annotations

import os
import time
import zipfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QAbstractButton, QApplication, QFileDialog, QLineEdit, QMenu, QPushButton

from app.deeds import LISTEN_TICKS
from device.api import Kind, State, StopState
from device.capture import Channel, Plan
from device.recorder_format import What
from device.recorder_play import DID
from device.recorder_read import Recording, joined
from tests.app.test_tuner import tuner
from tests.device.tuning.test_logbook import RUN
from tests.long import is_long
from tests.stage import Stage, make_studio
from widgets.recorder.panel import EMPTY, RecorderPanel

WHOLE = True  # the panels at the machine are there from the beginning
LEFT = Qt.MouseButton.LeftButton


def panel_of(stage: Stage) -> RecorderPanel:
    return stage.studio.at_machine.tape


def wait(stage: Stage, true: Callable[[], object], seconds: float = 15.0) -> None:
    """A replay has a thread of its own: real time passes, and as much on the stage."""
    end = time.monotonic() + seconds
    while not true():
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.005)
        stage.go(1)


def recorded(stage: Stage) -> None:
    """Some seconds of work: connected, a switch flipped, an axis moved, a text, a stop."""
    stage.connect("simulator", "ssc2")
    stage.go(10)
    stage.type("SH X", "PR 5000", "SP 1000", "BG X")
    stage.rig.start('#A\nMG "PART 7"\nEN')
    stage.go(60)
    stage.controller.stop()
    stage.until(lambda: stage.controller.stop_state is StopState.STOPPED)
    stage.go(10)


def replay(stage: Stage) -> None:
    """By the button of the panel."""
    stage.studio.desk.bring("Recorder")
    stage.go()
    QTest.mouseClick(panel_of(stage).replay, LEFT)
    wait(stage, lambda: stage.controller.kind is Kind.REPLAY and stage.controller.state is State.READY)


def press_everything(stage: Stage, title: str) -> None:
    """Every button of a panel that can be pressed, except those that ask for a file or end the replay."""
    stage.studio.desk.bring(title)
    stage.go(3)
    for button in stage.studio.window.docks[title].content.findChildren(QAbstractButton):
        name = button.text() or button.accessibleName()
        others = ("…", "Connect", "Replay", "Open", "Save", "End replay", "simulator")
        if button.isEnabled() and button.isVisible() and not any(each in name for each in others):
            QTest.mouseClick(button, LEFT)
            stage.go(1)
            assert stage.controller.kind is Kind.REPLAY, (title, name)


def done(stage: Stage) -> list[str]:
    stage.studio.recorder.flush()
    notes = Recording(joined(stage.studio.recorder.files())).notes
    return [str(note.payload) for note in notes if note.kind == DID]


def test_what_was_recorded_is_played_and_shown(stage: Stage) -> None:
    assert EMPTY in panel_of(stage).words()
    recorded(stage)
    studio, panel = stage.studio, panel_of(stage)
    replay(stage)
    assert "REPLAY" in studio.window.windowTitle()
    assert studio.window.header.stop.words == ("STOP", "REPLAY · nothing to stop")
    assert studio.window.docks["Display"].frame.text == "REPLAY"
    wait(stage, lambda: stage.controller.last().value("position.x") > 1500)
    wait(stage, lambda: sum("PART 7" in text for text in studio.messages.texts()) == 2)  # then, and again
    words = panel.words()
    assert (
        "You | Terminal: PR 5000" in words and "Machine | Connected to" in words and "Machine | STOP: stopped" in words
    )
    wait(stage, lambda: panel.play.text() != "Pause", 60)  # it has come to its end
    QTest.mouseClick(panel.leave, LEFT)
    stage.go()
    assert stage.controller.kind is Kind.OFFLINE and not panel.table.isVisible()


def test_nothing_is_sent_and_there_is_nothing_to_stop(stage: Stage) -> None:
    recorded(stage)
    rig = stage.rig
    replay(stage)
    closed = len(rig.loopback.written)
    studio = stage.studio
    actions = studio.actions.actions
    wait(stage, lambda: "recording" in actions["download"].statusTip())
    for name in ("download", "execute", "halt", "burn", "upload", "take_control"):
        assert not actions[name].isEnabled(), name
        assert "recording" in actions[name].statusTip(), name
    studio.desk.bring("Terminal")
    stage.go()
    studio.terminal.line.setText("PR 100")
    QTest.mouseClick(studio.terminal.send, LEFT)
    wait(stage, lambda: "recording" in studio.terminal.log.toPlainText())
    for title in studio.window.docks if is_long() else ("Display", "Jog", "Variables"):
        press_everything(stage, title)
    for title in ("Jog", "Tuner", "Operator terminal"):  # Control cannot be taken: nobody is told to
        reason = studio.window.docks[title].content.reason
        assert reason == "This is a recording: it can only be watched, nothing is sent."
    QTest.keyClick(studio.window, Qt.Key.Key_F12)
    wait(stage, lambda: any("There is nothing to stop" in text for text in studio.messages.texts()))
    assert len(rig.loopback.written) == closed and stage.controller.stop_state is StopState.NO_LINK


def test_the_slider_the_list_and_the_speed_by_keys(stage: Stage, qtlog: Any) -> None:
    recorded(stage)
    replay(stage)
    panel = panel_of(stage)
    player = stage.studio.at_machine.recorded.player
    assert player is not None
    QTest.mouseClick(panel.play, LEFT)
    stage.go()
    assert not player.playing and panel.play.text() == "Play"
    panel.slider.setFocus()
    QTest.keyClick(panel.slider, Qt.Key.Key_Home)
    QTest.keyClick(panel.slider, Qt.Key.Key_Right)
    QTest.keyClick(panel.slider, Qt.Key.Key_Right)
    stage.go()
    assert stage.studio.at_machine.recorded.player is not None
    assert stage.studio.at_machine.recorded.player.place == pytest.approx(2.0, abs=0.01)  # a second each
    assert "0:00:02 of" in panel.where.text()
    row = next(n for n, each in enumerate(panel.rows) if "BG X" in each.text)
    panel.search.setText("bg x")
    assert [each.text for each in panel.rows] == ["Terminal: BG X"]
    panel.search.clear()
    panel.table.setFocus()
    panel.table.setCurrentCell(row, 0)
    QTest.keyClick(panel.table, Qt.Key.Key_Return)
    stage.go()
    place = stage.studio.at_machine.recorded.player.place
    assert place == pytest.approx(panel.rows[row].place, abs=0.01)
    wait(stage, lambda: stage.controller.last().value("position.x") == 0)  # the move begins there
    panel.speed.setFocus()
    QTest.keyClick(panel.speed, Qt.Key.Key_Down)
    assert stage.studio.at_machine.recorded.player.speed == 2.0
    wait(stage, lambda: stage.controller.last().has("position.x"))
    stage.studio.desk.bring("Display")
    stage.go()
    shown = stage.studio.display.words()
    stage.later(60)  # it stands still, so nothing gets old
    stage.go()
    assert stage.studio.display.words() == shown and "ago" not in shown
    assert not [each.message for each in qtlog.records if "QTableWidget" in each.message]


def test_what_is_done_is_noted_in_words(stage: Stage) -> None:
    stage.connect("simulator", "ssc2")
    studio = stage.studio
    stage.type("TP")
    studio.actions["layout_run"].trigger()
    studio.window.activateWindow()
    QTest.qWaitForWindowActive(studio.window, 3000)
    studio.desk.bring("Events")
    stage.go()
    studio.at_machine.event_list.search.setFocus()
    QTest.keyClicks(studio.at_machine.event_list.search, "limit")
    QTest.keyClick(studio.at_machine.event_list.search, Qt.Key.Key_Return)
    studio.desk.ask("Which one?", "Two are there.", [("The first", lambda: None)])
    stage.go()
    assert studio.desk.question is not None
    button = next(each for each in studio.desk.question.findChildren(QPushButton) if each.text() == "The first")
    studio.desk.question.activateWindow()
    QTest.qWaitForWindowActive(studio.desk.question, 3000)
    button.setFocus()
    stage.go(2 * LISTEN_TICKS)
    QTest.mouseClick(button, LEFT)
    from codegen.instructions import Wait

    studio.session.insert([Wait(time="20")])
    stage.go()
    found = done(stage)
    assert "Terminal: TP" in found and "Layout: Run" in found and "Events: Search events = limit" in found
    assert any(each.startswith("Program: ") for each in found)
    assert any(each.endswith("The first") for each in found), found


def test_fields_cells_menus_pages_and_hands_are_noted_too(stage: Stage) -> None:
    studio = stage.studio
    stage.connect("simulator", "ssc2")
    stage.type("SH")
    studio.desk.bring("Scope")
    stage.go(3)
    body = studio.at_machine.curves.body
    assert body is not None
    studio.window.docks["Scope"].activateWindow()
    QTest.qWaitForWindowActive(studio.window.docks["Scope"].window(), 3000)
    body.choices.count.setFocus()
    QTest.keyClick(body.choices.count, Qt.Key.Key_A, Qt.KeyboardModifier.ControlModifier)
    QTest.keyClicks(body.choices.count, "140\t")
    QTest.mouseClick(body.side.tabBar(), LEFT, pos=body.side.tabBar().tabRect(1).center())
    QTest.mouseClick(body.choices.slots[0].pen, LEFT)
    menu = next(each for each in body.findChildren(QMenu) if each.isVisible())
    stage.go(LISTEN_TICKS)
    QTest.keyClick(menu, Qt.Key.Key_Down)
    QTest.keyClick(menu, Qt.Key.Key_Down)
    QTest.keyClick(menu, Qt.Key.Key_Return)
    table = studio.at_machine.table
    studio.desk.bring("Teach")
    stage.go(3)
    assert table.parts is not None
    table.rows_wanted.emit("insert", [], [])
    studio.window.activateWindow()
    QTest.qWaitForWindowActive(studio.window, 3000)
    table.parts.view.setFocus()
    table.parts.view.go_to(0, 5)
    QTest.keyClick(table.parts.view, Qt.Key.Key_Return)
    editor = next(each for each in table.parts.view.findChildren(QLineEdit) if each.isVisible())
    editor.selectAll()
    QTest.keyClicks(editor, "-3")
    QTest.keyClick(editor, Qt.Key.Key_Return)
    motion = stage.controller.motion
    motion.hold("X", 500, 10_000, 10_000, owner="test")
    stage.go(2)
    motion.release("test")
    stage.until(lambda: not motion.busy)
    stage.go(2)
    found = done(stage)
    for wanted in ("Scope: Values a channel = 140", "Menu: Blue", "Teach: Teach table, row 1, Wait input - = -3"):
        assert wanted in found, found
    assert any(each.endswith(" = Captures") for each in found), found
    assert "By hand: axis X" in found and found.index("By hand: let go") > found.index("By hand: axis X")


def test_of_a_file_only_the_name_is_noted(stage: Stage, tmp_path: Path) -> None:
    """Where files lie on a computer, and whose it is, does not leave with a recording."""
    stage.studio.files.save_as()
    stage.go(2 * LISTEN_TICKS)
    dialog = next(each for each in QApplication.topLevelWidgets() if isinstance(each, QFileDialog) and each.isVisible())
    name = next(each for each in dialog.findChildren(QLineEdit) if each.isVisible())
    name.selectAll()
    QTest.keyClicks(name, str(tmp_path / "press.tlp"))
    QTest.keyClick(name, Qt.Key.Key_Return)
    stage.go()
    assert stage.studio.session.path == tmp_path / "press.tlp"
    words = done(stage)
    assert any("press.tlp" in text for text in words) and not any(str(tmp_path) in text for text in words)


def test_a_tuning_run_stands_in_the_recording(stage: Stage) -> None:
    tuner(stage)
    stage.studio.at_machine.tuning.book.add(RUN)
    stage.studio.recorder.flush()
    notes = Recording(joined(stage.studio.recorder.files())).notes
    (run,) = [note.payload for note in notes if note.kind == "tuning run"]
    assert isinstance(run, dict) and run["gains"]["kp"] == 7.5 and run["actual"] == [0, 60, 99]


def test_a_capture_of_the_recording_is_shown_in_the_scope(stage: Stage) -> None:
    """The very values, in another studio too: they are in the recording themselves."""
    stage.connect("simulator", "ssc2")
    stage.type("SH X")
    scope, panel = stage.studio.at_machine.scope, panel_of(stage)
    stage.studio.desk.bring("Scope")
    stage.go()
    scope.capture(Plan((Channel("position", "X"), Channel("inputs")), 1, 60, go="PR 500;BG X"))
    stage.until(lambda: scope.job is None)
    body = stage.studio.at_machine.curves.body
    assert body is not None and body.kept.current is not None
    captured = body.kept.current
    replay(stage)
    words = "Scope | Captured Position X, Inputs: 60 values a channel, at once."
    assert words in panel.words()
    row = next(n for n, each in enumerate(panel.rows) if each.capture)
    panel.table.setCurrentCell(row, 0)
    panel.table.setFocus()
    QTest.keyClick(panel.table, Qt.Key.Key_Return)
    wait(stage, lambda: body.kept.list.count() == 2)
    shown = body.kept.current
    assert (
        shown is not None
        and shown is not captured
        and shown.channels == captured.channels
        and shown.when == captured.when
        and np.ptp(shown.values[0]) > 50
    )
    np.testing.assert_array_equal(shown.values, captured.values)
    assert stage.controller.kind is Kind.REPLAY


def test_a_recorder_that_can_not_write_is_said_wherever_one_looks(stage: Stage) -> None:
    said: list[str] = []
    recorded_by = stage.studio.at_machine.recorded
    recorded_by.said.connect(said.append)
    recorder = stage.studio.recorder
    recorder.flush()
    recorder.problem = "Nothing is recorded: no space left on device (here)."
    stage.go(3)
    assert said == [recorder.problem]
    recorder.note(DID, "a line")
    recorder.flush()
    stage.go(3)
    assert said[1:] == ["The recorder records again."]


@pytest.mark.skipif(os.name != "posix", reason="a limit of the system takes the place of a full disk")
def test_a_recording_that_finds_no_room_leaves_the_file_before_it(stage: Stage, tmp_path: Path) -> None:
    import resource

    recorded, said = stage.studio.at_machine.recorded, list[str]()
    recorded.said.connect(said.append)
    stage.studio.recorder.add(What.RECEIVED, 1, os.urandom(200_000))
    stage.studio.recorder.flush()
    path = tmp_path / "monday.tape"
    path.write_bytes(b"before")
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, hard))
    try:
        recorded.save(path)
        wait(stage, lambda: said)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert said[0].startswith("The recording was not saved: ") and path.read_bytes() == b"before"
    assert [each.name for each in tmp_path.glob("*monday*")] == ["monday.tape"]


@pytest.fixture
def other(tmp_path: Path, qapp: QApplication) -> Iterator[Stage]:
    """Another studio, of somebody who helps."""
    folder = tmp_path / "elsewhere"
    folder.mkdir()
    made = make_studio(folder, example="")
    made.studio.window.show()
    made.go()
    yield made
    made.clear_away()


def test_a_bundle_from_one_studio_opens_in_another(stage: Stage, other: Stage, tmp_path: Path) -> None:
    recorded(stage)
    path = tmp_path / "service.zip"
    happened = stage.studio.at_machine.happened
    happened.save_bundle(path)
    stage.until(lambda: not stage.studio.tick.writing)
    with zipfile.ZipFile(path) as bundle:
        assert "recording.tape" in bundle.namelist()
    other.studio.actions["open_recording"].trigger()  # asks for a file; the panel is in front
    other.go()
    assert panel_of(other).isVisible()
    other.studio.at_machine.recorded.open_path(path)
    wait(other, lambda: other.controller.kind is Kind.REPLAY and other.controller.state is State.READY)
    assert other.controller.identity == stage.controller.identity and "service.zip" in panel_of(other).state.text()
    wait(other, lambda: other.controller.last().value("position.x") > 500)
    question = other.studio.desk.question
    assert question is not None
    button = next(each for each in question.findChildren(QPushButton) if each.text() == "Open the program")
    QTest.mouseClick(button, LEFT)
    other.go()
    assert other.studio.session.document == stage.studio.session.document and other.studio.session.path is None


def test_what_can_not_be_opened_is_said(stage: Stage, tmp_path: Path) -> None:
    studio = stage.studio
    studio.desk.bring("Recorder")
    letter = tmp_path / "letter.txt"
    letter.write_text("Dear Sir")
    said: list[str] = []
    studio.at_machine.recorded.said.connect(said.append)
    studio.at_machine.recorded.open_path(letter)
    wait(stage, lambda: said)
    assert said == [
        "letter.txt is no recording and no service bundle; choose a file ending in .tape or a service bundle (.zip)."
    ]
    recorded(stage)
    studio.recorder.flush()
    stage.type("TP")
    saved = tmp_path / "day.tape"
    studio.at_machine.recorded.save(saved)
    wait(stage, saved.is_file)
    wait(stage, lambda: not studio.at_machine.recorded._working)
    data = bytearray(saved.read_bytes())
    data[-40] ^= 1
    saved.write_bytes(data)
    studio.at_machine.recorded.open_path(saved)
    wait(stage, lambda: stage.controller.kind is Kind.REPLAY)
    assert panel_of(stage).problem.text() == "A piece of day.tape cannot be read; what is whole is played."
