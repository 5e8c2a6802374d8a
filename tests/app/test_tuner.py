"""The tuner by mouse and keys, over a line of 19 200 baud: steps, automatic, model, logbook, what a crash left."""

from __future__ import annotations

import dataclasses as dc
import time
from datetime import datetime
from pathlib import Path
from typing import Any

from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QFileDialog, QLineEdit, QWidget
from shiboken6 import isValid

from app.settings import Settings
from codegen.twoletter.fixed import ONE
from device.capture import Channel
from device.capture_file import load
from device.former import Former, keep, left_behind
from device.tuning.entry import gains_words
from device.tuning.logbook import Logbook
from tests.app.pdf_text import pdf_text
from tests.app.spot import press
from tests.app.test_controls import controls, describe, name_of, reachable
from tests.device.tuning.test_dual import MACHINES
from tests.long import is_long
from tests.rig import Rig
from tests.stage import Stage, make_studio
from widgets.help.topic import topic_of
from widgets.parts.question import Question
from widgets.tuner.panel import AUTOMATIC, LOGBOOK, MANUAL, MODEL, TunerPanel

GAINS = {"KP": 6.0, "KI": 0.0, "KD": 64.0}


def tuner(stage: Stage, kind: str = "simulator", model: str = "ssc1", **more: Any) -> TunerPanel:
    """Connected, in Control, the motor on, the tuner in front, the axis' place known."""
    rig = stage.connect(kind, model, **more)
    rig.controller.take_control()
    rig.type("SH")
    stage.studio.actions["tune"].trigger()
    panel = stage.studio.at_machine.tuning.panel
    stage.go()
    stage.until(lambda: panel.box.words.text().startswith("X moves by"))
    panel.box.seconds.setCurrentIndex(0)
    return panel


def click(widget: QWidget) -> None:
    """Where it stands in the window."""
    QApplication.processEvents()
    press(widget)


def typed(field: QWidget, text: str) -> None:
    field.setFocus()
    QTest.keyClick(field, Qt.Key.Key_A, Qt.KeyboardModifier.ControlModifier)
    QTest.keyClicks(field, text)


def run(stage: Stage, panel: TunerPanel, button: QWidget | None = None) -> None:
    """The person looks, ticks, starts, and waits for the end (the mathematics takes real time)."""
    stage.until(lambda: not panel.box.problem and panel.box.words.text().startswith("X moves by"))
    if not panel.box.free.isChecked():
        click(panel.box.free)
    stage.go()
    button = button or panel.box.begin
    assert button.isEnabled(), button.toolTip()
    click(button)
    worked(stage, lambda: not panel.running)


def worked(stage: Stage, true: object) -> None:
    """Until it is true, where a thread of its own works as well."""
    assert callable(true)
    end = time.monotonic() + 60
    while not true():
        assert time.monotonic() < end
        stage.go(1)
        time.sleep(0.001)


def held(rig: Rig) -> dict[str, float]:
    registers = rig.simulation.unit.state.registers
    return {name: registers[name][0] / ONE for name in GAINS}


def test_steps_by_mouse_and_keys_kept_in_the_logbook(stage: Stage, tmp_path: Path) -> None:
    panel = tuner(stage)
    assert panel.page == MANUAL and not panel.box.begin.isEnabled()  # nobody has looked yet
    assert not panel.results.save.isEnabled()
    kp = panel.manual.gains.fields["KP"]
    typed(kp, "10")
    QTest.keyClick(kp, Qt.Key.Key_Up)
    assert kp.text() == "11"  # a tenth more
    click(panel.manual.gains.less["KP"])
    assert kp.text() == "10"
    typed(panel.manual.gains.fields["KD"], "120")
    typed(panel.box.step, "0.5")
    assert panel.box.unit.text() == "in = 319 counts"  # 637 counts an inch; a half goes away from 0
    run(stage, panel)
    assert panel.result.text().startswith("Settled within")
    assert "Rise" in panel.results.metrics.text() and "overshoot" in panel.results.metrics.text()
    assert panel.step_plot is not None and panel.step_plot.names == ("KP 10, KI 0, KD 120",)
    assert held(stage.rig) == GAINS and not stage.rig.moving
    typed(kp, "12")
    run(stage, panel)
    _saved(stage, panel, tmp_path)
    _logbook(stage, panel, tmp_path)
    _kept_and_burned(stage, panel)


def _saved(stage: Stage, panel: TunerPanel, folder: Path) -> None:
    click(panel.results.save)
    save_as(stage.studio.window, folder / "step.csv")
    capture = load(folder / "step.csv")
    assert capture.of(Channel("error", "X")).max() > 0.95 * 319  # at the first element it has moved a little


def save_as(parent: QWidget, path: Path) -> None:
    """The name typed into the file window, and Enter."""
    dialog = [each for each in parent.children() if isinstance(each, QFileDialog)][-1]
    name = dialog.findChild(QLineEdit, "fileNameEdit")
    assert dialog.isVisible() and name is not None
    typed(name, str(path))
    QTest.keyClick(name, Qt.Key.Key_Return)
    QApplication.processEvents()
    assert path.exists()


def _logbook(stage: Stage, panel: TunerPanel, folder: Path) -> None:
    click(panel.buttons[LOGBOOK])
    page, book = panel.logbook, stage.studio.at_machine.tuning.book
    assert page.runs.count() == 2 and panel.page == LOGBOOK
    assert book.book.entries[0].step == 319 and book.book.file.name.startswith("serial 1")
    page.runs.setCurrentRow(1)
    typed(page.note, "Belt loose")
    QTest.keyClick(page.note, Qt.Key.Key_Return)
    page.runs.item(0).setCheckState(Qt.CheckState.Checked)
    assert panel.step_plot is not None
    assert panel.step_plot.names == ("2: KP 12, KI 0, KD 120", "1: KP 10, KI 0, KD 120")
    page.runs.item(0).setCheckState(Qt.CheckState.Unchecked)
    click(page.report)
    assert book.preview is not None
    text = book.preview.pages.toPlainText()
    assert "Belt loose" in text and "Run 2, axis X: Manual" in text
    click(book.preview.buttons["Save as PDF…"])
    save_as(book.preview, folder / "report.pdf")
    assert b"Commissioning report" in (folder / "report.pdf").read_bytes().replace(b"\0", b"")  # its title, UTF-16
    paper = pdf_text(folder / "report.pdf")
    for entry, note in zip(book.book.entries, ("Belt loose", ""), strict=True):
        metrics = entry.metrics
        assert metrics is not None and metrics.settling_time is not None
        for told in (
            f"Run {entry.number}, axis X: Manual",
            f"Step of 0.5008 in (319 counts) with {gains_words(entry.gains)}; torque limit 9.998 V.",  # 319 / 637
            f"overshoot {100 * metrics.overshoot:.0f} %, settled in {metrics.settling_time * 1000:.0f} ms",
            f"steady error {metrics.steady_error:.1f} counts",
            note,
        ):
            assert told in paper, told
    click(book.preview.buttons["Close"])
    worked(stage, lambda: [each.note for each in Logbook(book.book.file).entries] == ["Belt loose", ""])
    assert Logbook(book.book.file).skipped == 0
    click(page.back)
    assert panel.page == MANUAL and panel.manual.gains.fields["KP"].text() == "10"


def _kept_and_burned(stage: Stage, panel: TunerPanel) -> None:
    click(panel.use)
    stage.until(lambda: held(stage.rig)["KP"] == 10 and "nothing was burned" in panel.result.text())
    assert not stage.rig.sent("BN")
    typed(panel.manual.gains.fields["KP"], "9")
    click(panel.burn)
    stage.until(lambda: stage.studio.desk.question is not None)
    question = stage.studio.desk.question
    assert question is not None
    assert "Axis X gets KP 9, KI 0, KD 120" in question.words and "next power-up" in question.words
    assert not stage.rig.sent("BN")
    click(question.buttons["Write to EEPROM"])
    stage.until(lambda: "in the EEPROM" in panel.result.text())
    assert held(stage.rig)["KP"] == 9 and stage.rig.sent("BN")


def test_nothing_starts_that_is_wrong_unseen_or_not_allowed(stage: Stage) -> None:
    panel = tuner(stage, "machine")
    click(panel.box.free)
    stage.go()
    assert panel.box.begin.isEnabled()
    typed(panel.box.step, "0.9")  # something else would happen now
    stage.go()
    assert not panel.box.free.isChecked() and not panel.box.begin.isEnabled()
    for text, says in (("12,5", "Write a point, not a comma"), ("2000", "KP must lie between 0 and 1023.875.")):
        typed(panel.manual.gains.fields["KP"], text)
        stage.go()
        assert says in panel.box.words.text() and not panel.box.begin.isEnabled()
    click(panel.manual.defaults)
    assert [panel.manual.gains.fields[name].text() for name in GAINS] == ["6", "0", "64"]  # l.2938
    typed(panel.box.step, "1000")
    stage.go()
    assert "an error limit (ER) can guard" in panel.box.words.text()
    setup = stage.studio.session.document.setup
    for limits in ({"forward_limit": "0.3", "reverse_limit": ""}, {"forward_limit": "", "reverse_limit": "-0.1"}):
        stage.studio.session.set_setup(setup.with_axis("X", dc.replace(setup.axis("X"), **limits)))  # one of them alone
        stage.go()
        typed(panel.box.step, "0.5")
        stage.go()
        assert panel.box.words.text().startswith("That passes a limit of the setup"), limits
    stage.studio.session.set_setup(setup)
    stage.go()
    typed(panel.box.step, "0.5")
    click(panel.buttons[AUTOMATIC])
    panel.box.drive.setCurrentIndex(2)
    run(stage, panel)
    assert "do not perform an auto tune; instead proceed to manual tuning" in panel.result.text()
    stage.controller.release_control()
    stage.go()
    for button in (panel.box.begin, panel.use, panel.burn):
        assert not button.isEnabled() and "Watch" in button.toolTip()
        click(button)
    assert panel.box.end.toolTip() == "Nothing is under way."
    stage.go(10)
    assert not [text for text in stage.rig.sent("") if not text.startswith(("MG", "SH"))]
    _named(stage, panel)


def _named(stage: Stage, panel: TunerPanel) -> None:
    """Every control has a name and is reached by keyboard; F1 opens the tuner's page."""
    for index in (MANUAL, AUTOMATIC, MODEL, LOGBOOK):
        click(panel.buttons[index])
        stage.go()
        assert [describe(each) for each in controls(panel) if not name_of(each)] == []
        assert [describe(each) for each in controls(panel) if each.isEnabled() and not reachable(each)] == []
    assert topic_of(panel.box.begin) == "Tuner"
    stage.studio.actions["program"].trigger()
    assert stage.studio.program.isVisible()


def test_stop_and_cancel_end_a_run_and_trials_are_drawn_as_they_come(stage: Stage) -> None:
    panel = tuner(stage)
    click(panel.box.free)
    stage.go()
    click(panel.box.begin)
    stage.until(lambda: abs(stage.rig.simulation.state()["axes"]["X"]["actual"]) > 50)
    assert panel.box.end.isEnabled() and stage.studio.run.doing
    QTest.keyClick(panel, Qt.Key.Key_F12)
    stage.until(lambda: not panel.running)
    assert "former values of axis X are back" in panel.result.text()
    assert held(stage.rig) == GAINS and not stage.rig.moving and not stage.studio.run.doing
    click(panel.buttons[AUTOMATIC])
    panel.box.drive.setCurrentIndex(1)
    stage.until(lambda: panel.box.words.text().startswith("X moves by"))
    click(panel.box.free)
    stage.go()
    click(panel.box.begin)
    stage.until(lambda: panel.automatic.trials.count() >= 2, 60)
    assert panel.running and panel.step_plot is not None and "Before" in panel.step_plot.names
    assert "KD up to 102.375" in panel.automatic.trials.item(1).text()  # 64 times 1.6, in steps of 1/8
    click(panel.box.end)
    stage.until(lambda: not panel.running)
    assert panel.result.text().startswith("Cancelled.") and held(stage.rig) == GAINS


def test_what_was_chosen_is_there_at_the_next_start_and_gains_are_not(stage: Stage, tmp_path: Path) -> None:
    panel = tuner(stage, model="ssc2")
    panel.axes.setCurrentText("Y")
    click(panel.buttons[AUTOMATIC])
    stage.until(lambda: panel.box.words.text().startswith("Choose") or "moves by" in panel.box.words.text())
    typed(panel.box.step, "300")
    QTest.keyClick(panel.box.step, Qt.Key.Key_Return)
    panel.box.seconds.setCurrentIndex(2)
    click(panel.results.error)
    typed(panel.manual.gains.fields["KP"], "99")
    kept = Settings(stage.studio.settings.path).get("tuner")
    assert kept["steps"] == {"Y counts": "300"} and kept["page"] == "Automatic" and "99" not in str(kept)
    again = make_studio(tmp_path)
    try:
        again.studio.window.show()
        again.connect("simulator", "ssc2")
        again.studio.actions["tune"].trigger()
        there = again.studio.at_machine.tuning.panel
        again.until(lambda: there.axes.count() == 2)
        again.go()
        assert there.axis == "Y" and there.page == AUTOMATIC and there.buttons[AUTOMATIC].isChecked()
        assert there.box.step.text() == "300" and there.box.record_s == 1.0 and there.results.error.isChecked()
        assert there.manual.gains.fields["KP"].text() == "6"  # what the controller holds
        assert not there.box.free.isChecked() and there.box.drive.currentText().startswith("Not sure")
        there.axes.setCurrentText("X")
        assert there.box.step.text() != "300"
    finally:
        again.clear_away()


def test_a_dual_loop_is_tuned_from_the_panel_and_not_identified(stage: Stage) -> None:
    panel = tuner(stage, plants={"X": MACHINES["play, dry"]})
    stage.rig.type("DVX=1")
    click(panel.buttons[MODEL])
    stage.until(lambda: "dual loop (DV 1) cannot be identified" in panel.box.words.text())
    stage.go()
    assert not panel.box.begin.isEnabled() and not panel.box.free.isEnabled()
    click(panel.buttons[AUTOMATIC])
    stage.until(lambda: panel.box.words.text().startswith("Choose the drive mode"))
    assert "first KD is raised as far as it goes while KP and KI are 0" in panel.automatic.about.text()
    panel.box.drive.setCurrentIndex(1)
    stage.until(lambda: panel.box.words.text().startswith("X moves by"))
    click(panel.box.free)
    stage.go()
    click(panel.box.begin)
    stage.until(lambda: panel.automatic.trials.count() >= 2 or not panel.running, 60)
    assert panel.automatic.trials.item(1).text().startswith("KP 0, KI 0, KD 102.375\nDual loop: KD up")  # 64 times 1.6
    if is_long():
        stage.until(lambda: not panel.running, 400)
        assert panel.box.words.text() and "It settles within" in panel.automatic.result.text()
        assert float(panel.manual.gains.fields["KP"].text()) > 6 and "Recommended gains" in panel.result.text()
    else:
        click(panel.box.end)
        stage.until(lambda: not panel.running)
    assert held(stage.rig) == GAINS and not stage.rig.moving
    typed(panel.manual.gains.fields["KD"], "0.5")
    stage.rig.type("DVX=0")
    click(panel.buttons[MODEL])
    stage.until(lambda: "Raise KD first" in panel.box.words.text())  # of the fields, which it would excite with


def test_what_a_crash_left_is_offered_first(stage: Stage) -> None:
    folder = stage.studio.at_machine.tuning.tuner.folder
    stage.studio.session.new(stage.studio.setup.default)  # another program is open
    values = {"KP": int(7.5 * ONE), "KD": 70 * ONE, "KI": 0, "OE": 0, "ER": 9000 * ONE}
    for accepted in (True, False):
        for second in (0, 5):  # two crashes: the older one holds what was before both
            when = datetime(2026, 11, 22, 12, 0, second).isoformat()
            values["KP"] = (99 if second else int(7.5)) * ONE
            file = folder / f"{second}.before-tuning"
            keep(Former("X", "ssc1", 1, "machine", "the press", when, 0, dict(values), file))
        rig = stage.connect("machine", "ssc1")
        stage.until(lambda: asked(stage) is not None)
        question = asked(stage)
        assert question is not None and "Before it: KP 7" in question.words and not rig.controller.control
        if accepted:
            click(question.buttons["Take Control and put them back"])
            stage.until(lambda: not left_behind(folder))
            assert held(rig) == {"KP": 7, "KI": 0, "KD": 70}
        else:
            click(question.buttons["Keep what the controller holds"])
            stage.go(10)
            assert held(rig) == GAINS and left_behind(folder) == ()
        stage.studio.connection.go_offline()
        stage.go()


def test_watch_in_the_middle_of_a_step_offers_the_former_values_at_once(stage: Stage) -> None:
    """Nothing may be sent any more then: the axis is left at rest, guarded, with the gains of the step."""
    panel = tuner(stage, "machine")
    click(panel.box.free)
    stage.go()
    click(panel.box.begin)
    stage.until(lambda: abs(stage.rig.simulation.state()["axes"]["X"]["actual"]) > 50)
    stage.controller.release_control()
    stage.until(lambda: asked(stage) is not None)
    question = asked(stage)
    assert question is not None and not panel.running
    click(question.buttons["Take Control and put them back"])
    folder = stage.studio.at_machine.tuning.tuner.folder
    stage.until(lambda: not left_behind(folder))
    registers = stage.rig.simulation.unit.state.registers
    assert held(stage.rig) == GAINS and not stage.rig.moving and registers["ER"][0] == 16384 * ONE  # the factory's


def asked(stage: Stage) -> Question | None:
    """The question that stands there."""
    question = stage.studio.desk.question
    return question if question is not None and isValid(question) and question.isVisible() else None
