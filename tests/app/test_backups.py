"""Back-ups: made by themselves before anything is replaced, looked into, compared and put back by mouse and keys."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from device.backup import load
from device.backup_kept import KEPT, keep, kept
from tests.app.test_run import answer, asked, code, idle, same_model, trigger
from tests.rig import Rig
from tests.stage import Stage
from widgets.backup.window import BackupWindow

WHOLE = True  # the panels at the machine are there from the beginning
OLD = "#A\nLEN=7\nEN"


def window_of(stage: Stage) -> BackupWindow:
    """The window, opened by its key."""
    QTest.keyClick(stage.studio.window, Qt.Key.Key_B, Qt.KeyboardModifier.ControlModifier)
    stage.go()
    window = stage.studio.proof.backups.window
    assert window is not None and window.isVisible()
    return window


def press(stage: Stage, window: BackupWindow, text: str) -> None:
    button = window.buttons[text]
    assert button.isEnabled(), button.toolTip()
    QTest.mouseClick(button, Qt.MouseButton.LeftButton)
    stage.go()


def folder(stage: Stage) -> Path:
    found = stage.studio.proof.keeping.folder()
    assert found is not None
    return found


def listed(window: BackupWindow) -> list[str]:
    items = [window.list.topLevelItem(row) for row in range(window.list.topLevelItemCount())]
    return [f"{item.text(1)}|{item.text(2)}" for item in items if item is not None]


def with_old_program(stage: Stage, kind: str = "machine") -> Rig:
    """A controller that runs another program since long."""
    rig = same_model(stage, kind, program=OLD)
    rig.type("KP 9", "LEN=7")
    return rig


def test_before_a_download_the_old_program_and_its_variables_are_kept(stage: Stage) -> None:
    rig = with_old_program(stage)
    stage.download()
    (one,) = kept(folder(stage))
    assert one.reason == "before a download"
    found = load(one.path)
    assert found.program == OLD and found.variables == {"LEN": 7 * 65536}
    assert found.serial == 1 and found.port == "machine"
    assert rig.program == code(stage)


@pytest.mark.long
def test_what_a_quick_back_up_leaves_out_is_named(stage: Stage) -> None:
    """An array is never read before a download, which does not touch it."""
    rig = same_model(stage, "machine", program="#A\nDM P[100]\nEN")
    rig.type("DM P[100]")
    stage.download()
    found = load(kept(folder(stage))[0].path)
    assert "P[]" in found.left_out and not found.arrays
    window = window_of(stage)
    assert "Left out to keep the download quick" in window.inside.toPlainText()


@pytest.mark.parametrize("known", [True, pytest.param(False, marks=pytest.mark.long)])
def test_a_download_takes_at_most_a_moment_longer(stage: Stage, known: bool) -> None:
    """At 19 200 baud, a small machine with twenty variables; the parameters of one axis fit into the moment."""
    lines = ["#A", *(f"V{number}={number}" for number in range(20)), "EN"]
    rig = same_model(stage, "machine", program="\n".join(lines))
    rig.type(*lines[1:-1])
    if known:
        trigger(stage, "upload")
        idle(stage)
    begun = rig.clock()
    stage.studio.run.before("before a download", lambda old: None)
    stage.until(lambda: stage.studio.run.doing, 1.0)
    idle(stage)
    assert rig.clock() - begun < 1.4  # reading the program included, which the download then leaves out
    assert len(load(kept(folder(stage))[0].path).variables) == 20


@pytest.mark.long
def test_an_empty_controller_and_the_same_once_more_keep_nothing(stage: Stage) -> None:
    same_model(stage, "machine")
    stage.download()
    assert kept(folder(stage)) == []
    stage.download()
    stage.download()
    assert len(kept(folder(stage))) == 1


@pytest.mark.long
def test_before_a_burn_everything_is_kept(stage: Stage) -> None:
    with_old_program(stage)
    stage.download()
    trigger(stage, "burn")
    answer(stage, "Burn")
    stage.until(lambda: any("is burned" in text for text in stage.studio.messages.texts()))
    newest = kept(folder(stage))[0]
    assert newest.reason == "before a burn"
    found = load(newest.path)
    assert found.parameters["KP"] == (9 * 65536,) and not found.left_out


def test_where_nothing_can_be_kept_the_download_asks(stage: Stage, tmp_path: Path) -> None:
    rig = with_old_program(stage)
    folder(stage).parent.parent.mkdir(parents=True, exist_ok=True)
    (tmp_path / "backups").write_text("a file where the folder should be")
    stage.studio.run.download()
    stage.until(lambda: stage.studio.desk.question is not None)
    words, answers = asked(stage)
    assert "The back-up cannot be written" in words and answers == ["Go on with the download"]
    assert rig.program == OLD.split("\n")
    answer(stage, "Go on with the download")
    idle(stage)
    assert rig.program == code(stage)


@pytest.mark.long
def test_cancelling_the_back_up_cancels_the_download(stage: Stage) -> None:
    rig = with_old_program(stage)
    stage.studio.run.download()
    progress = stage.studio.window.status.progress
    stage.until(lambda: "Backing up" in progress.words.text())
    QTest.mouseClick(progress.cancel, Qt.MouseButton.LeftButton)
    idle(stage)
    stage.go(30)
    assert rig.program == OLD.split("\n")
    assert "nothing was changed in the controller" in " ".join(stage.studio.messages.texts())


@pytest.mark.long
def test_fifty_are_kept_of_each_controller(stage: Stage) -> None:
    rig = with_old_program(stage)
    stage.download()
    found = load(kept(folder(stage))[0].path)
    for _ in range(KEPT + 3):
        keep(folder(stage), found, stage.studio.proof.keeping._now())
    assert len(kept(folder(stage))) == KEPT == 50
    assert rig.controller.control


def test_a_back_up_by_hand_is_looked_into_in_words(stage: Stage) -> None:
    with_old_program(stage)
    window = window_of(stage)
    QTest.mouseClick(window.note, Qt.MouseButton.LeftButton)
    QTest.keyClicks(window.note, "before the new gearbox")
    press(stage, window, "Back up now")
    stage.until(lambda: window.bar.isVisible())
    idle(stage)
    stage.go()
    assert listed(window) == ["by hand|before the new gearbox"]
    assert window.note.text() == ""
    text = window.inside.toPlainText()
    for words in ("Proportional (KP): X 9", "LEN = 7", "serial number 1", "LEN=7", "note: before the new gearbox"):
        assert words in text
    assert "The controller does not tell it" in text


def test_compare_says_item_by_item_what_is_otherwise(stage: Stage) -> None:
    rig = with_old_program(stage)
    window = window_of(stage)
    press(stage, window, "Back up now")
    stage.until(lambda: listed(window) and not stage.studio.run.doing)
    press(stage, window, "Compare")
    stage.until(lambda: "holds everything as it is in the back-up" in window.compared.toPlainText())
    rig.type("KP 12", "LEN=8")
    press(stage, window, "Compare")
    stage.until(lambda: "differs from the back-up in 2 items" in window.compared.toPlainText())
    assert "Proportional of X (KP) is 12, the back-up has 9" in window.compared.toPlainText()
    assert "variable LEN is 8, the back-up has 7" in window.compared.toPlainText()


def test_restore_asks_keeps_what_is_there_and_compares(stage: Stage) -> None:
    rig = with_old_program(stage)
    window = window_of(stage)
    press(stage, window, "Back up now")
    stage.until(lambda: listed(window) and not stage.studio.run.doing)
    rig.type("KP 12", "LEN=8", "SH")
    press(stage, window, "Restore…")
    words, answers = asked(stage)
    assert "The motors go off" in words and "Nothing is burned" in words and answers == ["Restore"]
    assert rig.simulation.unit.state.program  # nothing has happened yet
    answer(stage, "Restore")
    stage.until(lambda: "are as in the back-up" in window.compared.toPlainText(), 60)
    state = rig.simulation.state()
    assert state["variables"]["LEN"] == 7 and not state["axes"]["X"]["motor_on"]
    assert "Only what is burned is there after the next power-up" in window.compared.toPlainText()
    assert listed(window)[0] == "before a restore|"
    assert rig.result(rig.controller.read("_KPX")) == (9.0,)


def test_another_model_is_refused_with_what_does_not_fit(stage: Stage, tmp_path: Path) -> None:
    with_old_program(stage)
    window = window_of(stage)
    press(stage, window, "Back up now")
    stage.until(lambda: listed(window) and not stage.studio.run.doing)
    path = kept(folder(stage))[0].path
    rig = stage.connect("machine", "ssc3")
    rig.controller.take_control()
    stage.go()
    assert listed(window) == []  # those of another controller
    stage.studio.proof.backups.open_file(path)
    stage.go()
    assert not window.buttons["Restore…"].isEnabled()
    assert "it is of a ssc1, this is a ssc3; it has the axes X, this has X Y Z" in window.fit.text()
    assert "does not fit" in window.buttons["Restore…"].toolTip()


@pytest.mark.long
def test_in_watch_a_back_up_can_be_taken_but_not_put_back(stage: Stage) -> None:
    rig = with_old_program(stage)
    rig.controller.release_control()
    window = window_of(stage)
    press(stage, window, "Back up now")
    stage.until(lambda: listed(window) and not stage.studio.run.doing)
    assert not window.buttons["Restore…"].isEnabled()
    assert "switch to Control" in window.buttons["Restore…"].toolTip()


def test_a_file_that_is_none_is_one_sentence(stage: Stage, tmp_path: Path) -> None:
    same_model(stage)
    window = window_of(stage)
    path = tmp_path / "notes.tlb"
    path.write_text("hello")
    stage.studio.proof.backups.open_file(path)
    words, _ = asked(stage)
    assert words.startswith("notes.tlb is not a back-up of a controller: ") and "\n" not in words
    assert listed(window) == []


def test_the_steps_to_replace_a_controller_are_guided(stage: Stage) -> None:
    with_old_program(stage)
    window = window_of(stage)
    press(stage, window, "Replace controller…")
    guide = stage.studio.proof.backups.replacing
    assert guide is not None and guide.isVisible()
    QTest.mouseClick(guide.buttons["Back up now"], Qt.MouseButton.LeftButton)
    stage.until(lambda: listed(window) and not stage.studio.run.doing)
    new = stage.connect("machine", stage.studio.model())
    new.controller.take_control()
    stage.go()
    assert "serial number 1" in guide.state.text()
    QTest.mouseClick(guide.buttons["Restore…"], Qt.MouseButton.LeftButton)
    answer(stage, "Restore")
    stage.until(lambda: new.program == OLD.split("\n"), 60)
    idle(stage)
    QTest.mouseClick(guide.buttons["Compare…"], Qt.MouseButton.LeftButton)
    stage.go()
    assert stage.studio.proof.comparing.window is not None
    assert stage.studio.proof.comparing.window.isVisible()


@pytest.mark.long
def test_offline_the_window_says_so_and_is_reachable_by_keys(stage: Stage) -> None:
    window = window_of(stage)
    assert window.who.text() == "Nothing is connected"
    assert not window.buttons["Back up now"].isEnabled()
    assert "Connect a controller" in window.buttons["Back up now"].toolTip()
    QTest.keyClick(window, Qt.Key.Key_Escape)
    assert not window.isVisible()
