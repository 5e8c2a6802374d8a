"""Leaving while a machine works asks first; marks of the running program belong to what was downloaded."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Callable

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QPushButton, QToolButton

from app.search import Candidate
from codegen.instructions import Wait
from codegen.program import replace
from device.api import Badge, Kind, State, StopState
from tests.stage import Stage
from widgets.parts.question import Question

JOG = "#A\nJG 5000\nBGX\n#B\nJP #B\n"


def answer(stage: Stage, words: str) -> None:
    buttons = asked(stage).findChildren(QPushButton)
    QTest.mouseClick(next(each for each in buttons if each.text() == words), Qt.MouseButton.LeftButton)


def close(stage: Stage) -> bool:
    """Presses Exit; whether the window has closed, after as much time as the machine needs for its answers."""
    window, desk = stage.studio.window, stage.studio.desk
    window.show()
    desk.question = None
    button = next(each for each in window.header.findChildren(QToolButton) if each.text() == "Exit")
    QTest.mouseClick(button, Qt.MouseButton.LeftButton)
    stage.until(lambda: not window.isVisible() or desk.question is not None, 5.0)
    return not window.isVisible()


def asked(stage: Stage) -> Question:
    """The question, once the machine has told what it does."""
    stage.until(lambda: stage.studio.desk.question is not None, 5.0)
    question = stage.studio.desk.question
    assert question is not None and question.isVisible()
    return question


def running_machine(stage: Stage) -> None:
    rig = stage.connect("machine", "ssc1", program=JOG)
    rig.controller.take_control()
    rig.controller.execute(anyway=True)
    stage.until(lambda: rig.controller.last().value("moving.x") == 1)


def test_closing_in_mid_move_asks_and_nothing_is_closed(stage: Stage) -> None:
    running_machine(stage)
    assert not close(stage)
    assert asked(stage).words == "A program runs, X moves. Without this window there is no STOP and no F12."


def test_stop_and_leave_leaves_only_after_the_confirmed_stop(stage: Stage) -> None:
    running_machine(stage)
    assert not close(stage)
    answer(stage, "Stop and leave")
    assert stage.studio.window.isVisible()
    stage.until(lambda: not stage.studio.window.isVisible())
    state = stage.rig.simulation.state()
    assert not state["axes"]["X"]["moving"]
    assert not any(thread["running"] for thread in state["threads"])


def test_leave_it_running_leaves_the_axis_moving(stage: Stage) -> None:
    running_machine(stage)
    assert not close(stage)
    answer(stage, "Leave it running")
    assert not stage.studio.window.isVisible()
    assert stage.rig.simulation.state()["axes"]["X"]["moving"]


def connect_by_serial_setup(stage: Stage) -> None:
    stage.studio.start.show_serial()
    serial = stage.studio.start.serial
    assert serial is not None
    QTest.mouseClick(serial.connect_button, Qt.MouseButton.LeftButton)


def choose(way: str) -> Callable[[Stage], None]:
    """A way of the welcome window, which was open before the machine began to work."""

    def click(stage: Stage) -> None:
        QTest.mouseClick(stage.studio.start.welcome_window().ways[way], Qt.MouseButton.LeftButton)

    return click


def try_again(stage: Stage) -> None:
    QTest.mouseClick(stage.studio.start.welcome_window().again, Qt.MouseButton.LeftButton)


def act(name: str) -> Callable[[Stage], None]:
    return lambda stage: stage.studio.actions[name].trigger()


WAYS_OUT: dict[str, Callable[[Stage], None]] = {
    "Disconnect": act("disconnect"),
    "Use the simulator": act("simulator"),
    "Use the simulator (welcome)": choose("simulator"),
    "Offline programming": choose("offline"),
    "Offline controller setup": choose("setup"),
    "Serial setup, Connect": connect_by_serial_setup,
}
LOOKING = {"Connect…": act("connect"), "Try again": try_again}


def prepare(stage: Stage) -> None:
    """The welcome window is open, as it is when somebody looks around while the machine rests."""
    stage.studio.start.welcome_window().show_nothing("Nothing found.")


@pytest.mark.parametrize("way", [*WAYS_OUT, *LOOKING])
def test_turning_away_in_mid_move_asks_and_keeps_the_connection(stage: Stage, way: str) -> None:
    running_machine(stage)
    prepare(stage)
    machine, opened = stage.controller, len(stage.controllers)
    {**WAYS_OUT, **LOOKING}[way](stage)
    assert asked(stage).words == "A program runs, X moves. Afterwards STOP and F12 no longer reach it."
    assert stage.controller is machine
    assert len(stage.controllers) == opened
    answer(stage, "Cancel")
    stage.go()
    assert stage.controller is machine and machine.state is State.READY
    assert len(stage.controllers) == opened


@pytest.mark.parametrize("way", WAYS_OUT)
def test_leaving_it_running_turns_away_at_once(stage: Stage, way: str) -> None:
    running_machine(stage)
    prepare(stage)
    rig = stage.rig
    WAYS_OUT[way](stage)
    answer(stage, "Leave it running")
    assert stage.controller is not rig.controller
    assert rig.closed and rig.moving == ["X"]


@pytest.mark.parametrize("way", WAYS_OUT)
def test_stopping_it_first_turns_away_only_after_the_confirmed_stop(stage: Stage, way: str) -> None:
    running_machine(stage)
    prepare(stage)
    rig = stage.rig
    WAYS_OUT[way](stage)
    answer(stage, "Stop it first")
    assert stage.controller is rig.controller
    stage.until(lambda: stage.controller is not rig.controller)
    assert rig.stops == ["ST"]
    assert rig.moving == [] and rig.running == []


@pytest.mark.parametrize("way", [*WAYS_OUT, *LOOKING])
def test_a_stop_that_is_not_confirmed_turns_away_from_nothing(stage: Stage, way: str) -> None:
    running_machine(stage)
    prepare(stage)
    rig = stage.rig
    {**WAYS_OUT, **LOOKING}[way](stage)
    asked(stage)
    rig.cut()
    answer(stage, "Stop it first")
    stage.later(0.6)  # 0.5 s without an answer
    stage.go()
    assert stage.controller is rig.controller
    assert stage.controller.stop_state is StopState.NOT_CONFIRMED
    assert "Not left: the stop is not confirmed." in stage.studio.messages.texts()


@pytest.mark.parametrize("way", WAYS_OUT)
def test_a_machine_at_rest_is_turned_away_from_without_a_question(stage: Stage, way: str) -> None:
    stage.connect("machine", "ssc1")
    stage.until(lambda: stage.controller.last().value("moving.x") == 0)
    prepare(stage)
    machine = stage.controller
    WAYS_OUT[way](stage)
    stage.until(lambda: stage.controller is not machine, 5.0)
    assert stage.studio.desk.question is None


def at_port(stage: Stage, device: str, *others: str) -> None:
    """What is connected hangs on this port; the others are there too and were used before."""
    stage.studio.connection.address = device
    stage.ports[:] = [Candidate(each, "COM port", True) for each in (device, *others)]
    stage.studio.settings.set("ports_used", [device, *others])


def test_looking_again_leaves_the_port_of_the_connected_machine_alone(stage: Stage) -> None:
    stage.connect("machine", "ssc1")
    stage.until(lambda: stage.controller.last().value("moving.x") == 0)
    at_port(stage, "/dev/ttyS0", "/dev/ttyS1")
    stage.silent.add("/dev/ttyS1")
    machine = stage.controller
    stage.studio.actions["connect"].trigger()
    stage.until(lambda: stage.studio.search.busy)
    assert stage.studio.desk.question is None
    assert stage.controllers[:-1] == [machine]  # one more was opened, for the other port
    stage.until(lambda: not stage.studio.search.busy)
    welcome = stage.studio.start.welcome_window()
    assert welcome.heading.text() == "No other controller"
    assert "/dev/ttyS0 stays connected" in welcome.sentence.text() and "/dev/ttyS1" in welcome.sentence.text()
    assert stage.controller is machine and machine.state is State.READY


def test_without_another_port_looking_again_says_so(stage: Stage) -> None:
    stage.connect("machine", "ssc1")
    stage.until(lambda: stage.controller.last().value("moving.x") == 0)
    at_port(stage, "/dev/ttyS0")
    stage.studio.actions["connect"].trigger()
    stage.until(lambda: stage.studio.start.welcome is not None)
    assert "no other serial port" in stage.studio.start.welcome_window().sentence.text()
    assert stage.controller.state is State.READY


def test_a_program_that_starts_during_the_search_is_not_left_by_what_is_found(stage: Stage) -> None:
    rig = stage.connect("machine", "ssc1", program=JOG)
    stage.until(lambda: stage.controller.last().value("moving.x") == 0)
    at_port(stage, "/dev/ttyS0", "/dev/ttyS1")
    stage.studio.actions["connect"].trigger()
    stage.until(lambda: stage.studio.search.busy)
    other = stage.rigs[-1]
    other.loopback.unplugged = True  # answers late
    rig.simulation.execute(0)
    stage.until(lambda: rig.controller.last().value("moving.x") == 1)
    other.loopback.unplugged = False
    stage.until(lambda: other.closed)
    assert stage.controller is rig.controller
    words = stage.studio.start.welcome_window().sentence.text()
    assert "/dev/ttyS1" in words and "A program runs, X moves." in words


def test_who_agreed_to_leave_it_running_gets_what_the_search_finds(stage: Stage) -> None:
    running_machine(stage)
    at_port(stage, "/dev/ttyS0", "/dev/ttyS1")
    rig = stage.rig
    stage.studio.actions["connect"].trigger()
    answer(stage, "Leave it running")
    stage.until(lambda: stage.controller is not rig.controller)
    assert stage.studio.connection.address == "/dev/ttyS1"
    assert rig.moving == ["X"]


def test_a_machine_that_does_not_answer_is_given_up_before_its_port_is_tried(stage: Stage) -> None:
    running_machine(stage)
    at_port(stage, "/dev/ttyS0")
    rig = stage.rig
    rig.cut()
    stage.until(lambda: stage.controller.state is State.LOST)
    stage.studio.actions["connect"].trigger()
    assert "whether something moves is not known" in asked(stage).words
    answer(stage, "Leave it running")
    assert rig.closed  # a port can be open only once
    stage.until(lambda: stage.controller.state is State.READY)
    assert stage.studio.connection.address == "/dev/ttyS0"


def test_where_nobody_ever_answered_nothing_is_asked(stage: Stage) -> None:
    stage.connect("machine", answers=False, silent=True)
    stage.until(lambda: stage.controller.state is State.LOST)
    assert close(stage)


def test_a_machine_at_rest_is_left_without_a_question(stage: Stage) -> None:
    stage.connect("machine", "ssc1")
    stage.until(lambda: stage.controller.last().value("moving.x") == 0)
    assert close(stage)


def test_an_edit_during_the_download_does_not_shift_the_marks(stage: Stage) -> None:
    stage.connect("machine", "ssc1")
    stage.controller.take_control()
    sent = stage.studio.session.listing
    stage.studio.run.download()
    stage.go(1)
    assert stage.studio.run.doing
    first = stage.studio.session.document.program.configuration[0]
    stage.studio.session.remove([first.id])
    stage.until(lambda: not stage.studio.run.doing)
    assert stage.controller.program_badge is Badge.CHANGED
    assert stage.studio.program.running is sent
    assert stage.studio.session.listing.text != sent.text


def test_another_document_carries_no_marks_of_the_program_that_runs(stage: Stage) -> None:
    stage.connect("machine", "ssc1")
    stage.download().type("OE 1")  # as in the setup: nothing is asked
    stage.rig.simulation.stimulus("in1", 0)
    stage.studio.run.execute()
    stage.until(lambda: bool(stage.studio.program.delegate.executing))
    document = stage.studio.session.document
    waits = [step for step in document.program.main if isinstance(step.instruction, Wait)]
    other = replace(document.program, dc.replace(waits[0], instruction=Wait(time="500")))
    stage.studio.session.new()
    stage.studio.session.set_document(dc.replace(document, program=other), "Paste")
    stage.go(5)
    assert stage.studio.program.running is None
    assert stage.studio.program.delegate.executing == {}


def test_what_was_just_begun_is_seen_though_no_reading_shows_it_yet(stage: Stage) -> None:
    controller = stage.connect("machine", "ssc1").controller
    controller.take_control()
    stage.until(lambda: controller.last().value("moving.x") == 0)
    for command in ("JG 5000", "BG X"):
        controller.ask(command)
    assert controller.last().value("moving.x") == 0
    assert not close(stage)
    assert asked(stage).words.startswith("X moves.")


def test_a_coordinated_motion_is_a_motion(stage: Stage) -> None:
    rig = stage.connect("machine", "ssc2")
    rig.controller.take_control()
    for command in ("VS 1000", "VA 256000", "VD 256000", "LM XY", "LI 4000,3000", "LE", "BG S"):
        rig.controller.ask(command)
    stage.until(lambda: rig.simulation.state()["axes"]["X"]["commanded"] > 100)
    assert not close(stage)
    assert asked(stage).words.startswith("X Y move on a common path.")
    answer(stage, "Cancel")
    stage.until(lambda: rig.simulation.state()["axes"]["X"]["commanded"] == 4000)
    stage.go(30)
    assert close(stage)


def test_a_machine_that_does_not_tell_in_time_is_not_taken_for_resting(stage: Stage) -> None:
    rig = stage.connect("machine", "ssc1")
    stage.until(lambda: rig.controller.last().value("moving.x") == 0)
    rig.cut()
    assert rig.controller.state is State.READY
    assert not close(stage)
    assert "not known" in asked(stage).words


def test_the_newest_wish_counts(stage: Stage) -> None:
    rig = stage.connect("machine", "ssc1")
    stage.until(lambda: rig.controller.last().value("moving.x") == 0)
    stage.studio.actions["disconnect"].trigger()
    stage.studio.actions["simulator"].trigger()  # before the machine has answered
    stage.until(lambda: stage.controller is not rig.controller, 5.0)
    assert stage.controller.kind is Kind.SIMULATOR
