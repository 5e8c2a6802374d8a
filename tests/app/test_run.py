"""Download, Execute, Halt, Burn, Upload: what is asked before, what is sent, what is said afterwards."""

from __future__ import annotations

import dataclasses as dc

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from codegen.instructions import Label
from device.api import Badge, Downloaded, DownloadFailed, NotAllowed, NoticeKind
from tests.fakes import failed
from tests.stage import Stage

DONE = Downloaded(True, "Downloaded and verified: 14 lines.", None, 0.4)


def asked(stage: Stage) -> tuple[str, list[str]]:
    question = stage.studio.desk.question
    assert question is not None
    return question.words, list(question.buttons)


def answer(stage: Stage, label: str) -> None:
    question = stage.studio.desk.question
    assert question is not None
    QTest.mouseClick(question.buttons[label], Qt.MouseButton.LeftButton)
    stage.go()


def calls(stage: Stage, name: str) -> list[object]:
    return [each for each in stage.controller.calls if each == name or (isinstance(each, tuple) and each[0] == name)]


def same_model(stage: Stage, kind: str = "simulator") -> None:
    stage.connect(kind, stage.studio.model())
    stage.go()


def test_download_sends_the_listing_shows_progress_and_says_it_was_verified(stage: Stage) -> None:
    same_model(stage)
    stage.studio.actions["download"].trigger()
    assert calls(stage, "download") == [("download", stage.studio.session.listing.text)]
    stage.controller.job.phase, stage.controller.job.done = "sending", 40
    stage.go()
    progress = stage.studio.window.status.progress
    assert progress.isVisible()
    assert "sending" in progress.words.text()
    assert progress.bar.value() == 400
    assert "Downloading" in stage.studio.actions["download"].statusTip()
    stage.controller.job.future.set_result(DONE)
    stage.go()
    assert not progress.isVisible()
    assert DONE.sentence in stage.studio.messages.texts()


def test_cancel_gives_the_download_up(stage: Stage) -> None:
    same_model(stage)
    stage.studio.actions["download"].trigger()
    stage.go()
    QTest.mouseClick(stage.studio.window.status.progress.cancel, Qt.MouseButton.LeftButton)
    assert stage.controller.job.cancelled


def test_a_failed_download_is_one_sentence(stage: Stage) -> None:
    same_model(stage)
    stage.studio.actions["download"].trigger()
    stage.controller.job.future.set_exception(DownloadFailed("The controller refused line 3."))
    stage.go()
    assert stage.studio.messages.texts()[-1] == "The controller refused line 3."
    assert stage.studio.run.doing == ""


def test_another_model_than_the_setups_is_asked_about(stage: Stage) -> None:
    assert stage.studio.model() != "ssc2"
    stage.connect("simulator", "ssc2")
    stage.go()
    stage.studio.actions["download"].trigger()
    words, answers = asked(stage)
    assert "SSC2" in words
    assert answers == ["Download anyway"]
    assert not calls(stage, "download")
    answer(stage, "Download anyway")
    assert len(calls(stage, "download")) == 1


def test_a_program_with_a_problem_is_not_downloaded_and_the_problem_is_shown(stage: Stage) -> None:
    same_model(stage)
    session = stage.studio.session
    session.insert([Label(name="")])
    stage.studio.actions["download"].trigger()
    assert not calls(stage, "download")
    answer(stage, "Show it")
    assert stage.studio.program.current_step() == session.listing.problems[0].step


def test_execute_runs_the_verified_program_at_its_label(stage: Stage) -> None:
    same_model(stage)
    stage.controller.program_badge = Badge.SAME
    stage.studio.actions["execute"].trigger()
    assert calls(stage, "execute") == [("execute", "CUTTER", False)]


@pytest.mark.parametrize("badge", [Badge.CHANGED, Badge.UNKNOWN])
def test_execute_asks_which_program_is_meant(stage: Stage, badge: Badge) -> None:
    same_model(stage)
    stage.controller.program_badge = badge
    stage.studio.actions["execute"].trigger()
    assert not calls(stage, "execute")
    _, answers = asked(stage)
    assert set(answers) == {
        "Download and execute", "Run what is in the controller", "Show what is in the controller",
    }  # fmt: skip
    answer(stage, "Run what is in the controller")
    assert calls(stage, "execute") == [("execute", None, True)]


def test_download_and_execute_executes_only_after_the_proof(stage: Stage) -> None:
    same_model(stage)
    stage.controller.program_badge = Badge.CHANGED
    stage.studio.actions["execute"].trigger()
    answer(stage, "Download and execute")
    assert len(calls(stage, "download")) == 1
    assert not calls(stage, "execute")
    stage.controller.program_badge = Badge.SAME
    stage.controller.job.future.set_result(DONE)
    stage.go()
    assert calls(stage, "execute") == [("execute", "CUTTER", False)]


def test_a_download_that_was_not_verified_executes_nothing(stage: Stage) -> None:
    same_model(stage)
    stage.controller.program_badge = Badge.CHANGED
    stage.studio.actions["execute"].trigger()
    answer(stage, "Download and execute")
    stage.controller.job.future.set_result(dc.replace(DONE, verified=False, sentence="Not verified."))
    stage.go()
    assert not calls(stage, "execute")


def test_halt_says_that_it_halted(stage: Stage) -> None:
    same_model(stage)
    stage.studio.actions["halt"].trigger()
    stage.go()
    assert calls(stage, "halt") == ["halt"]
    assert "Halted" in stage.studio.messages.texts()[-1]


def test_burn_says_what_the_next_power_up_will_do_and_waits_for_the_answer(stage: Stage) -> None:
    same_model(stage)
    stage.studio.actions["burn"].trigger()
    words, _ = asked(stage)
    assert words == stage.controller.memory.burn_words()
    assert not calls(stage, "burn")
    answer(stage, "Burn")
    assert calls(stage, "burn") == ["burn"]


def test_upload_shows_the_code_and_where_it_differs(stage: Stage) -> None:
    same_model(stage)
    stage.studio.actions["upload"].trigger()
    stage.controller.job.future.set_result("#A\nPR 100\nEN\n")
    stage.go()
    window = stage.studio.desk.upload
    assert window is not None
    assert "differ" in window.words.text()
    assert "PR 100" in window.code.toPlainText()
    assert "only in the controller" in window.differences.toPlainText()


def test_a_call_that_is_not_allowed_is_said(stage: Stage) -> None:
    same_model(stage)
    stage.controller.halt = lambda: failed(NotAllowed("Not sent: watching only."))  # type: ignore[method-assign]
    stage.studio.actions["halt"].trigger()
    stage.go()
    assert stage.studio.messages.texts()[-1] == "Not sent: watching only."


def test_the_badge_says_whether_the_controller_holds_this_program(stage: Stage) -> None:
    same_model(stage)
    bar = stage.studio.window.run_bar
    for badge, words in ((Badge.SAME, "In the controller"), (Badge.CHANGED, "Changed"), (Badge.UNKNOWN, "Not known")):
        stage.controller.program_badge = badge
        stage.go()
        assert words in bar.badge.text()


def test_a_changed_document_is_told_to_the_controller(stage: Stage) -> None:
    same_model(stage)
    stage.studio.session.insert([Label(name="EXTRA")])
    assert stage.controller.calls[-1] == ("listing", stage.studio.session.listing.text)


def test_a_program_error_opens_on_its_instruction(stage: Stage) -> None:
    same_model(stage)
    listing = stage.studio.session.listing
    line = next(number for number, each in enumerate(listing.lines) if each.text.startswith("PR"))
    stage.controller.say(NoticeKind.FAULT, f"?{line:03} PR6370")
    stage.go()
    assert stage.studio.program.current_step() == listing.step_of(line)
    # code 7 comes from the fake; its text is the controller's (spec/tables.json)
    assert "Command not valid while running" in stage.studio.messages.texts()[-1]


def test_the_executing_line_is_shown_in_the_program(stage: Stage) -> None:
    same_model(stage)
    stage.go()
    listing = stage.studio.session.listing
    assert stage.studio.program.delegate.executing == {listing.step_of(4): (0,)}
