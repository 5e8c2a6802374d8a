"""Download, Execute, Halt, Burn, Upload: what is asked before, what is sent, what is said afterwards."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from codegen.instructions import Label, TwoLetterCode
from device.api import Badge, State
from tests.rig import Rig
from tests.stage import Stage

OTHER = "#A\nPR 100\nEN"


def asked(stage: Stage) -> tuple[str, list[str]]:
    question = stage.studio.desk.question
    assert question is not None
    return question.words, list(question.buttons)


def answer(stage: Stage, label: str) -> None:
    question = stage.studio.desk.question
    assert question is not None
    QTest.mouseClick(question.buttons[label], Qt.MouseButton.LeftButton)
    stage.go()


def same_model(stage: Stage, kind: str = "simulator", **more: str) -> Rig:
    """A controller of the type that the open program is for, with Control."""
    rig = stage.connect(kind, stage.studio.model(), **more)
    rig.controller.take_control()
    stage.go()
    return rig


def code(stage: Stage) -> list[str]:
    return stage.studio.session.listing.text.rstrip("\n").split("\n")


def idle(stage: Stage) -> None:
    """Waits until nothing is under way with the controller's memory."""
    stage.until(lambda: not stage.studio.run.doing)


def trigger(stage: Stage, name: str) -> None:
    action = stage.studio.actions[name]
    assert action.isEnabled(), action.statusTip()
    action.trigger()


def test_download_sends_the_listing_shows_progress_and_says_it_was_verified(stage: Stage) -> None:
    rig = same_model(stage)
    trigger(stage, "download")
    progress = stage.studio.window.status.progress
    stage.until(lambda: "sending" in progress.words.text() and progress.bar.value() > 0)
    job = stage.studio.run.job
    assert job is not None
    assert progress.isVisible()
    assert progress.bar.value() == round(1000 * job.done / job.total) < 1000
    assert "Downloading" in stage.studio.actions["download"].statusTip()
    idle(stage)
    assert not progress.isVisible()
    assert rig.program == code(stage)
    assert f"{len(code(stage))} lines downloaded and verified." in stage.studio.messages.texts()


def test_cancel_gives_the_download_up(stage: Stage) -> None:
    rig = same_model(stage)
    trigger(stage, "download")
    progress = stage.studio.window.status.progress
    stage.until(lambda: "sending" in progress.words.text())
    QTest.mouseClick(progress.cancel, Qt.MouseButton.LeftButton)
    idle(stage)
    assert "cancelled at line" in stage.studio.messages.texts()[-1]
    assert len(rig.program) < len(code(stage))
    assert rig.controller.program_badge is Badge.UNKNOWN


def test_a_failed_download_is_one_sentence(stage: Stage) -> None:
    rig = same_model(stage)
    trigger(stage, "download")
    stage.until(lambda: "sending" in stage.studio.window.status.progress.words.text())
    rig.cut()
    idle(stage)
    said = stage.studio.messages.texts()[-1]
    assert said.startswith("Download ended ")
    assert "the connection was lost" in said
    assert "\n" not in said


def test_another_model_than_the_setups_is_asked_about(stage: Stage) -> None:
    assert stage.studio.model() != "ssc2"
    rig = stage.connect("simulator", "ssc2")
    stage.go()
    trigger(stage, "download")
    words, answers = asked(stage)
    assert "SSC, two axes" in words
    assert answers == ["Download anyway"]
    stage.go(30)
    assert rig.program == []
    answer(stage, "Download anyway")
    idle(stage)
    assert rig.program == code(stage)


def test_a_program_with_a_problem_is_not_downloaded_and_the_problem_is_shown(stage: Stage) -> None:
    rig = same_model(stage)
    session = stage.studio.session
    session.insert([Label(name="")])
    trigger(stage, "download")
    answer(stage, "Show it")
    stage.go(30)
    assert rig.program == []
    assert "DL" not in rig.lines
    assert stage.studio.program.current_step() == session.listing.problems[0].step


def test_execute_runs_the_verified_program_at_its_label(stage: Stage) -> None:
    rig = same_model(stage)
    rig.simulation.stimulus("in1", 0)
    stage.download()
    trigger(stage, "execute")
    stage.until(lambda: rig.running == [code(stage).index("AI 1")])
    assert rig.sent("XQ") == ["XQ #CUTTER,0"]
    stage.until(lambda: "The program was started." in stage.studio.messages.texts(), 1.0)


def changed(stage: Stage) -> Rig:
    rig = same_model(stage)
    stage.download()
    stage.studio.session.insert([Label(name="EXTRA")])
    assert rig.controller.program_badge is Badge.CHANGED
    return rig


def unknown(stage: Stage) -> Rig:
    rig = same_model(stage, program=OTHER)
    assert rig.controller.program_badge is Badge.UNKNOWN
    return rig


@pytest.mark.parametrize("situation", [changed, unknown])
def test_execute_asks_which_program_is_meant(stage: Stage, situation: Callable[[Stage], Rig]) -> None:
    rig = situation(stage)
    trigger(stage, "execute")
    stage.go(30)
    assert rig.sent("XQ") == []
    assert rig.running == []
    words, answers = asked(stage)
    assert "Execute belongs to the program that was downloaded and verified." in words
    assert rig.program[1] in words  # what would run is shown
    assert set(answers) == {
        "Download and execute", "Run what is in the controller", "Show what is in the controller",
    }  # fmt: skip
    held = rig.program
    answer(stage, "Run what is in the controller")
    stage.until(lambda: stage.studio.messages.texts()[-1] == "The program was started.")
    assert rig.sent("XQ") == ["XQ"]
    assert rig.program == held


def test_download_and_execute_executes_only_after_the_proof(stage: Stage) -> None:
    rig = changed(stage)
    rig.simulation.stimulus("in1", 0)
    trigger(stage, "execute")
    answer(stage, "Download and execute")
    stage.until(lambda: stage.studio.run.job is not None and stage.studio.run.job.phase == "verifying")
    assert rig.sent("XQ") == []
    stage.until(lambda: rig.running)
    assert rig.sent("XQ") == ["XQ #CUTTER,0"]
    assert rig.program == code(stage)
    assert "#EXTRA" in rig.program


def test_a_download_that_was_not_verified_executes_nothing(stage: Stage) -> None:
    rig = changed(stage)
    rig.wear_out("6370", "6371")
    trigger(stage, "execute")
    answer(stage, "Download and execute")
    idle(stage)
    stage.go(30)
    assert "PR 6371" in rig.program
    assert rig.sent("XQ") == []
    assert rig.running == []
    assert "does not hold the program" in stage.studio.messages.texts()[-1]


def test_halt_says_that_it_halted(stage: Stage) -> None:
    rig = same_model(stage)
    stage.download()
    trigger(stage, "execute")
    stage.until(lambda: rig.moving)
    trigger(stage, "halt")
    stage.until(lambda: not rig.moving and not rig.running)
    stage.go()
    assert rig.sent("HX") == ["HX;ST"]
    assert "Halted" in stage.studio.messages.texts()[-1]


def test_burn_says_what_the_next_power_up_will_do_and_waits_for_the_answer(stage: Stage) -> None:
    rig = same_model(stage)
    stage.download()
    trigger(stage, "burn")
    words, _ = asked(stage)
    assert "What is burned is the open program “CUTTER”" in words
    assert "At the next power-up it is in the controller but does not start: it has no #AUTO." in words
    stage.go(30)
    assert rig.sent("BP") == []
    answer(stage, "Burn")
    stage.until(lambda: "Burning" in stage.studio.window.status.progress.words.text())
    idle(stage)
    assert rig.sent("BP") == ["BP"]
    rig.simulation.stimulus("reset", 0)
    stage.later(3.0)
    assert rig.program == code(stage)


def other(stage: Stage, program: str = OTHER) -> Rig:
    """A controller with another program than the open one, which was looked at."""
    rig = same_model(stage, program=program)
    trigger(stage, "upload")
    stage.until(lambda: rig.controller.listing is not None)
    stage.go()
    return rig


AUTO = "#AUTO\nPR 100\nBGX\nAMX\nEN"


@pytest.mark.parametrize(
    ("program", "starts"),
    [(OTHER, "does not start: it has no #AUTO"), (AUTO, "starts by itself at #AUTO: the machine may move")],
)
@pytest.mark.parametrize("looked", [True, False])
def test_burn_of_another_program_says_which_and_whether_it_starts(
    stage: Stage, program: str, starts: str, looked: bool
) -> None:
    rig = other(stage, program) if looked else same_model(stage, program=program)
    trigger(stage, "burn")
    stage.until(lambda: stage.studio.desk.question is not None)
    words, answers = asked(stage)
    count = program.count("\n") + 1
    assert f"What is burned is what the controller holds: another program than the open one ({count} " in words
    assert starts in words
    assert program.split("\n")[1] in words  # its code is shown
    assert set(answers) == {"Download first", "Burn"}
    assert rig.sent("BP") == []
    answer(stage, "Burn")
    idle(stage)
    rig.simulation.stimulus("reset", 0)
    stage.later(3.0)
    assert rig.program == program.split("\n")


def test_burn_of_an_earlier_download_says_so_and_offers_the_download_first(stage: Stage) -> None:
    rig = changed(stage)
    trigger(stage, "burn")
    words, _ = asked(stage)
    assert "What is burned is “CUTTER” as it was downloaded at " in words
    assert "without the changes since then" in words
    answer(stage, "Download first")
    stage.until(lambda: rig.controller.program_badge is Badge.SAME and not stage.studio.run.doing)
    words, _ = asked(stage)
    assert "the open program “CUTTER”" in words
    assert rig.sent("BP") == []


def test_burn_of_an_empty_memory_says_so(stage: Stage) -> None:
    same_model(stage)
    trigger(stage, "burn")
    stage.until(lambda: stage.studio.desk.question is not None)
    words, _ = asked(stage)
    assert "There is no program in the controller" in words


def test_what_has_changed_since_it_was_asked_about_is_not_burned(stage: Stage) -> None:
    rig = other(stage)
    stage.later(5.0)
    stage.go()
    trigger(stage, "burn")
    rig.simulation.stimulus("reset", 0)
    stage.later(1.0)
    stage.until(lambda: "restarted" in " ".join(stage.studio.messages.texts()))
    answer(stage, "Burn")
    stage.go(30)
    assert rig.sent("BP") == []
    assert "Not burned: what the controller holds is not what was asked about" in stage.studio.messages.texts()[-1]


def test_a_refused_burn_is_not_called_burned(stage: Stage) -> None:
    rig = same_model(stage)
    rig.simulation.stimulus("in1", 0)
    stage.download()
    trigger(stage, "execute")
    stage.until(lambda: rig.running == [code(stage).index("AI 1")])
    trigger(stage, "burn")
    answer(stage, "Burn")
    idle(stage)
    assert rig.sent("BP") == ["BP"]
    said = stage.studio.messages.texts()[-1]
    assert "not burned" in said
    assert "The program is burned" not in said


def test_a_burn_without_an_answer_is_not_known(stage: Stage) -> None:
    rig = same_model(stage)
    stage.download()
    trigger(stage, "burn")
    answer(stage, "Burn")
    stage.until(lambda: "Burning" in stage.studio.window.status.progress.words.text())
    rig.cut()
    idle(stage)
    assert "It is not known whether the program was burned" in " ".join(stage.studio.messages.texts())


def test_what_was_not_burned_is_gone_after_a_power_failure(stage: Stage) -> None:
    rig = same_model(stage)
    stage.download()
    rig.simulation.stimulus("reset", 0)
    stage.later(3.0)
    assert rig.program == []


def test_upload_shows_the_code_and_where_it_differs(stage: Stage) -> None:
    same_model(stage, program=OTHER)
    trigger(stage, "upload")
    stage.until(lambda: stage.studio.desk.upload is not None)
    window = stage.studio.desk.upload
    assert window is not None
    assert "differ" in window.words.text()
    assert "PR 100" in window.code.toPlainText()
    window.tabs.setCurrentWidget(window.differences)
    assert "only in the controller" in window.differences.toPlainText()


def test_a_call_that_is_not_allowed_is_said(stage: Stage) -> None:
    rig = same_model(stage, "machine")
    rig.controller.release_control()
    stage.studio.run.halt()
    stage.until(lambda: "this is Watch" in stage.studio.messages.texts()[-1])
    assert rig.sent("HX") == []


def test_the_badge_says_whether_the_controller_holds_this_program(stage: Stage) -> None:
    same_model(stage)
    badge = stage.studio.window.run_bar.badge
    assert "Not known" in badge.accessibleName()
    stage.download()
    stage.go()
    assert "In the controller" in badge.accessibleName()
    stage.studio.session.insert([Label(name="EXTRA")])
    stage.go()
    assert "Changed" in badge.accessibleName()
    stage.studio.session.undo()
    stage.go()
    assert "In the controller" in badge.accessibleName()


def test_the_badge_and_execute_say_when_the_program_is_another_one(stage: Stage) -> None:
    rig = other(stage)
    badge = stage.studio.window.run_bar.badge
    assert "Another program" in badge.accessibleName()
    assert "another program than the open one (3 lines, first label #A)" in badge.toolTip()
    trigger(stage, "execute")
    words, _ = asked(stage)
    assert "another program than the open one" in words
    assert "changed since" not in words.lower()
    assert rig.sent("XQ") == []


def test_what_was_downloaded_is_another_program_once_another_one_is_open(stage: Stage) -> None:
    same_model(stage)
    stage.download()
    stage.studio.session.new()
    stage.go()
    badge = stage.studio.window.run_bar.badge
    assert "Another program" in badge.accessibleName()
    assert "“CUTTER” as it was downloaded at " in badge.toolTip()


def test_execute_without_any_program_in_the_controller_offers_only_the_download(stage: Stage) -> None:
    rig = same_model(stage)
    trigger(stage, "execute")
    stage.until(lambda: stage.studio.desk.question is not None)
    words, answers = asked(stage)
    assert words.startswith("There is no program in the controller.")
    assert answers == ["Download and execute"]
    assert "No program" in stage.studio.window.run_bar.badge.accessibleName()
    assert rig.sent("XQ") == []


def test_a_controller_connected_later_is_told_the_document_too(stage: Stage) -> None:
    same_model(stage, program="\n".join(code(stage)))
    trigger(stage, "upload")
    stage.until(lambda: stage.controller.program_badge is Badge.SAME)


def test_a_program_error_opens_on_its_instruction(stage: Stage) -> None:
    rig = same_model(stage)
    stage.download()
    rig.simulation.stimulus("fls_x", 0)
    trigger(stage, "execute")
    line = code(stage).index("BG X")
    stage.until(lambda: "stopped at line" in stage.studio.messages.texts()[-1])
    assert stage.studio.program.current_step() == stage.studio.session.listing.step_of(line)
    # error 22 (dmc-1412-1414.txt, TC): begin not possible due to limit switch
    assert f"line {line}: Begin not possible due to limit switch" in stage.studio.messages.texts()[-1]
    assert rig.running == []


def test_the_executing_line_is_shown_in_the_program(stage: Stage) -> None:
    rig = same_model(stage)
    rig.simulation.stimulus("in1", 0)
    stage.download()
    trigger(stage, "execute")
    line = code(stage).index("AI 1")
    step = stage.studio.session.listing.step_of(line)
    stage.until(lambda: stage.studio.program.delegate.executing == {step: (0,)})
    assert rig.running == [line]
    assert rig.controller.state is State.READY


def test_the_display_names_the_instruction_only_while_the_program_is_the_open_one(stage: Stage) -> None:
    rig = same_model(stage)
    rig.simulation.stimulus("in1", 0)
    stage.download()
    trigger(stage, "execute")
    line = code(stage).index("AI 1")
    stage.until(lambda: rig.running == [line])
    stage.until(lambda: f"Thread 0: line {line}, Wait until input 1 is high (AI 1)" in stage.studio.display.words())
    stage.studio.session.insert([Label(name="EXTRA")])
    stage.go()
    assert f"Thread 0: line {line}, waiting: after input (AI 1)" in stage.studio.display.words()
    stage.studio.session.undo()
    stage.go()
    assert f"Thread 0: line {line}, Wait until input 1 is high (AI 1)" in stage.studio.display.words()


def test_a_program_that_is_not_known_shows_the_bare_line_and_marks_no_row(stage: Stage) -> None:
    rig = same_model(stage)
    rig.start("#B\nN=1\nAI 1\nEN")
    rig.simulation.stimulus("in1", 0)
    stage.until(lambda: "Thread 0: line 2" in stage.studio.display.words())
    assert "Thread 0: line 2\n" in stage.studio.display.words() + "\n"
    assert stage.studio.program.delegate.executing == {}


def test_the_lines_of_another_program_mark_no_row_of_the_one_that_was_downloaded_before(stage: Stage) -> None:
    rig = same_model(stage)
    stage.download()
    rig.simulation.stimulus("in1", 0)
    rig.start("#B\nN=1\nAI 1\nEN")  # as another computer may have put there
    trigger(stage, "upload")
    idle(stage)
    stage.until(lambda: "Thread 0: line 2, waiting: after input (AI 1)" in stage.studio.display.words())
    assert stage.studio.program.delegate.executing == {}


def test_remarks_are_not_sent_and_do_not_shift_the_line_that_is_shown(stage: Stage) -> None:
    rig = same_model(stage)
    session = stage.studio.session
    session.new(session.document.setup)
    session.insert([TwoLetterCode(text="REM one\nREM two\nN=1")])
    (wait,) = session.insert([TwoLetterCode(text="AI 1")])
    (last,) = session.insert([TwoLetterCode(text="PR 1000;BGX\nPR 500;BGX")])  # the second begin comes while X moves
    rig.simulation.stimulus("in1", 0)
    stage.download()
    assert "REM" in session.listing.text
    assert not [line for line in rig.program if "REM" in line]
    trigger(stage, "execute")
    stage.until(lambda: stage.studio.program.delegate.executing == {wait: (0,)})
    assert rig.running == [rig.program.index("AI 1")]
    rig.simulation.stimulus("in1", 1)
    stage.until(lambda: "stopped at line" in stage.studio.messages.texts()[-1])
    assert stage.studio.program.current_step() == last
