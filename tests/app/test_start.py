"""From start to a connection: the search asks before writing, nothing falls back to the simulator by itself."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QPushButton

from app import connection
from app.search import Candidate
from app.studio import begin
from app.which_model import known_models
from device import find
from device.api import Kind, State
from device.find import Found
from device.transport import LineSettings, OpenFailed
from tests.app.hands import Hands, Keys, Mouse
from tests.rig import Rig
from tests.stage import ASKS, Stage
from widgets.connect.serial_setup import SerialChoice

KNOWN = Candidate("/dev/ttyS0", "COM port", True)
NEW = Candidate("/dev/ttyUSB0", "USB serial adapter", False)


def use(stage: Stage, *ports: Candidate) -> None:
    """The ports of this computer; those used before are in the settings."""
    stage.ports[:] = ports
    stage.studio.settings.set("ports_used", [port.device for port in ports if port.used_before])


def press(button: QPushButton) -> None:
    QTest.mouseClick(button, Qt.MouseButton.LeftButton)


def test_without_a_known_port_the_studio_opens_on_the_simulator_with_the_sample(stage: Stage) -> None:
    use(stage, NEW)
    begin(stage.studio, None, "ask")
    stage.go(1)
    assert stage.controllers[-1].kind is Kind.SIMULATOR
    assert [controller.kind for controller in stage.controllers] == [Kind.SIMULATOR]
    assert stage.studio.session.document.program.name == "CUTTER"
    assert stage.studio.session.path is None
    assert not stage.studio.session.dirty


def test_a_known_port_is_tried_first_and_taken_when_it_answers(stage: Stage) -> None:
    use(stage, KNOWN)
    begin(stage.studio, None, "ask")
    stage.go(1)
    assert [controller.kind for controller in stage.controllers] == [Kind.MACHINE]
    stage.until(lambda: stage.controller is stage.controllers[0])
    assert stage.controller.state is State.READY
    assert not stage.controller.control
    assert stage.studio.start.welcome is not None
    assert not stage.studio.start.welcome.isVisible()


def test_a_silent_port_ends_in_the_welcome_window_never_in_the_simulator(stage: Stage) -> None:
    use(stage, KNOWN)
    stage.silent.add(KNOWN.device)
    begin(stage.studio, None, "ask")
    stage.go(1)
    stage.go()
    assert stage.studio.search.busy
    stage.until(lambda: not stage.studio.search.busy, 7.0)
    welcome = stage.studio.start.welcome_window()
    assert welcome.isVisible()
    assert "No controller" in welcome.heading.text()
    assert "/dev/ttyS0" in welcome.sentence.text()
    assert stage.studio.connection.controller.kind is Kind.OFFLINE
    assert stage.rigs[0].closed
    assert len(stage.rigs) == 1


def test_a_new_port_is_not_opened_before_the_person_allows_it(stage: Stage) -> None:
    use(stage, NEW)
    stage.studio.start.look()
    welcome = stage.studio.start.welcome_window()
    assert stage.controllers == []
    assert "/dev/ttyUSB0" in welcome.question.text()
    press(welcome.allow)
    assert len(stage.controllers) == 1
    stage.until(lambda: stage.controller is stage.controllers[0])
    assert "/dev/ttyUSB0" in stage.studio.settings.get("ports_used")


def test_a_port_left_alone_is_never_opened(stage: Stage) -> None:
    use(stage, NEW)
    stage.studio.start.look()
    press(stage.studio.start.welcome_window().skip)
    stage.go()
    assert stage.controllers == []
    assert "left alone" in stage.studio.start.welcome_window().sentence.text()


def test_without_any_port_it_says_so(stage: Stage) -> None:
    use(stage)
    stage.studio.start.look()
    assert "no serial port" in stage.studio.start.welcome_window().sentence.text()


HANDS = pytest.mark.parametrize("hands", [Mouse, Keys], ids=["mouse", "keyboard"])


@HANDS
@pytest.mark.parametrize("way", ["simulator", "serial", "setup", "offline"])
def test_the_welcome_window_offers_what_the_manual_offers(stage: Stage, way: str, hands: type[Hands]) -> None:
    # ssc-tol-o-motion.txt, chapter 5: serial communication setup, offline setup, offline programming; and a simulator
    use(stage)
    stage.studio.start.look()
    hands(stage.studio).press(stage.studio.start.welcome_window().ways[way])
    stage.go()
    shown = {
        "simulator": lambda: stage.controller.kind is Kind.SIMULATOR,
        "serial": lambda: stage.studio.start.serial is not None and stage.studio.start.serial.isVisible(),
        "setup": lambda: stage.studio.setup.window is not None and stage.studio.setup.window.isVisible(),
        "offline": lambda: stage.studio.start.welcome is not None and not stage.studio.start.welcome.isVisible(),
    }
    assert shown[way]()


@HANDS
def test_the_way_from_the_search_to_a_line_that_was_set_up(stage: Stage, hands: type[Hands]) -> None:
    use(stage, KNOWN, NEW)
    stage.silent.add(KNOWN.device)
    hand = hands(stage.studio)
    hand.act("connect")
    welcome = stage.studio.start.welcome_window()
    stage.until(lambda: welcome.question.isVisible())  # the known one was silent; the new one is asked about
    hand.press(welcome.skip)
    assert "left alone" in welcome.sentence.text()
    hand.press(welcome.ways["serial"])
    serial = stage.studio.start.serial
    assert serial is not None and serial.isVisible()
    # ssc-tol-o-motion.txt l.1505-1511: first port, 9600, 8, 1, none, off, both
    assert serial.choice == SerialChoice(KNOWN.device, 9600, 8, 1, "none", False, "both")
    hand.fill(serial.port.lineEdit(), NEW.device)
    hand.choose(serial.baud, "38 400")
    hand.choose(serial.bits, "7")
    hand.choose(serial.stop_bits, "2")
    hand.choose(serial.parity, "Even")
    hand.choose(serial.handshake, "RTS/CTS")
    hand.press(serial.echo)
    assert "for 38400 baud: 1200 OFF, 9600 ON, 19.2K ON, HSHK ON" in serial.switches.accessibleName()  # l.1525
    hand.press(serial.connect_button)
    stage.until(lambda: stage.controller.state is State.READY)
    assert stage.studio.connection.address == NEW.device
    assert stage.controller.line == LineSettings(38400, 7, "even", 2, "rts")
    get = stage.studio.settings.get
    assert (get("port"), get("baud"), get("echo")) == (NEW.device, 38400, True)
    assert not welcome.isVisible()


@pytest.mark.parametrize("on", [True, False])
def test_the_echo_box_sets_the_controller_once_control_is_taken(stage: Stage, on: bool) -> None:
    """EO 1 sends back what is received (dmc-1412-1414.txt l.1348); Watch sends nothing that sets."""
    use(stage, KNOWN)
    stage.studio.start.show_serial()
    serial = stage.studio.start.serial
    assert serial is not None
    serial.port.setCurrentText(KNOWN.device)
    serial.echo.setChecked(on)
    serial.connect_button.click()
    stage.until(lambda: stage.controller.state is State.READY)
    settings = stage.rig.simulation.unit.state.settings
    if not on:
        settings["EO"] = 65536  # burned so
        stage.until(lambda: stage.controller.link.echo.on)
        stage.studio.start.echo.choose(KNOWN.device, on)
    stage.go(10)
    assert (settings["EO"] != 0) is not on
    stage.controller.take_control()
    stage.until(lambda: (settings["EO"] != 0) is on)
    stage.until(lambda: stage.controller.link.echo.on is on)
    told = stage.studio.messages.texts()
    assert any("when you take Control" in text for text in told)
    assert any(f"Echo switched {'on' if on else 'off'}" in text for text in told)


@HANDS
def test_exit_leaves_from_the_welcome_window(stage: Stage, hands: type[Hands]) -> None:
    use(stage)
    stage.studio.start.look()
    hands(stage.studio).press(stage.studio.start.welcome_window().exit)
    assert not stage.studio.window.isVisible()


def test_at_start_the_search_can_be_left_out(stage: Stage) -> None:
    use(stage, KNOWN)
    stage.studio.settings.set("look_at_start", False)
    begin(stage.studio, None, "ask")
    stage.go(1)
    assert [controller.kind for controller in stage.controllers] == [Kind.SIMULATOR]


def test_the_simulator_hangs_on_a_line_as_fast_as_is_set(stage: Stage) -> None:
    begin(stage.studio, None, "simulator:ssc3")
    stage.go(1)
    stage.until(lambda: stage.controller.state is State.READY)
    stage.go()
    assert stage.controller.line.baud == 19200
    assert stage.controller.model is not None and stage.controller.model.name == "ssc3"
    assert "19 200 baud" in stage.studio.window.status.link.text()


def test_try_again_looks_once_more(stage: Stage) -> None:
    use(stage)
    stage.studio.start.look()
    use(stage, KNOWN)
    press(stage.studio.start.welcome_window().again)
    assert len(stage.controllers) == 1


def test_the_serial_setup_connects_with_what_was_set_and_remembers_it(stage: Stage) -> None:
    use(stage, KNOWN)
    stage.studio.start.show_serial()
    serial = stage.studio.start.serial
    assert serial is not None
    assert serial.choice.port == "/dev/ttyS0"
    serial.baud.setCurrentIndex(serial.baud.findData(19200))
    press(serial.connect_button)
    stage.until(lambda: stage.controller.state is State.READY)
    assert stage.controller.kind is Kind.MACHINE
    assert stage.controller.line.baud == 19200
    assert stage.studio.settings.get("baud") == 19200
    assert stage.studio.connection.address == "/dev/ttyS0"


def test_a_lost_machine_stays_a_lost_machine(stage: Stage) -> None:
    rig = stage.connect("machine")
    rig.cut()
    stage.until(lambda: rig.controller.state is State.LOST)
    stage.go(100)
    assert stage.controller is rig.controller
    assert stage.controller.kind is Kind.MACHINE
    assert "connection lost" in stage.studio.actions["upload"].statusTip()


def test_a_machine_that_answers_again_is_there_again_in_watch(stage: Stage) -> None:
    rig = stage.connect("machine")
    rig.controller.take_control()
    rig.cut()
    stage.until(lambda: rig.controller.state is State.LOST)
    rig.loopback.unplugged = False
    stage.until(lambda: rig.controller.state is State.READY)
    stage.go()
    assert not rig.controller.control
    assert stage.studio.window.header.switch.watch.isChecked()


def test_another_connection_closes_the_one_before(stage: Stage) -> None:
    first = stage.connect("machine")
    stage.connect("simulator")
    assert first.closed
    sent = len(first.loopback.written)
    stage.go(30)
    assert len(first.loopback.written) == sent


@pytest.mark.parametrize(
    ("text", "kind"), [("simulator", "simulator"), ("simulator:ssc2", "simulator"), ("port:/dev/ttyS9", "machine")]
)
def test_what_the_command_line_asks_for(stage: Stage, text: str, kind: str) -> None:
    begin(stage.studio, None, text)
    stage.go(1)
    assert stage.controllers[-1].kind == kind


def test_offline_connects_nothing(stage: Stage) -> None:
    begin(stage.studio, None, "offline")
    assert stage.controllers == []


def test_a_file_that_can_not_be_opened_is_one_sentence(stage: Stage, tmp_path: Path) -> None:
    bad = tmp_path / "bad.tlp"
    bad.write_text("nonsense")
    begin(stage.studio, bad, "offline")
    question = stage.studio.desk.question
    assert question is not None
    assert "bad.tlp" in question.words
    assert "\n" not in question.words


def test_watch_and_control_are_one_switch(stage: Stage) -> None:
    stage.connect("machine")
    stage.go()
    switch = stage.studio.window.header.switch
    assert switch.watch.isChecked()
    QTest.mouseClick(switch.control, Qt.MouseButton.LeftButton)
    stage.go()
    assert stage.controller.control
    assert stage.studio.actions["take_control"].isChecked()
    QTest.mouseClick(switch.watch, Qt.MouseButton.LeftButton)
    stage.go()
    assert not stage.controller.control


def test_offline_the_switch_says_why_it_is_grey(stage: Stage) -> None:
    switch = stage.studio.window.header.switch
    assert not switch.control.isEnabled()
    assert "Nothing is connected" in switch.control.toolTip()


def test_the_question_of_a_program_is_answered_in_its_box(stage: Stage) -> None:
    rig = stage.question()
    stage.go()
    box = stage.studio.window.prompt
    assert box.isVisible()
    assert "Length?" in box.text.text()
    assert str(ASKS) in box.text.text()
    QTest.keyClicks(box.line, "10.5")
    QTest.keyClick(box.line, Qt.Key.Key_Return)
    stage.until(lambda: not rig.running)
    assert rig.simulation.state()["variables"]["LEN"] == 10.5
    stage.until(lambda: not box.isVisible())


def test_while_a_question_is_pending_nothing_can_be_typed_in_the_terminal(stage: Stage) -> None:
    stage.connect("simulator")
    stage.studio.desk.bring("Terminal")
    stage.go()
    assert stage.studio.terminal.line.isEnabled()
    stage.question("simulator")
    stage.go()
    assert not stage.studio.terminal.line.isEnabled()
    assert "answer" in stage.studio.terminal.why.text()


def test_unsaved_work_is_asked_about_before_leaving(stage: Stage) -> None:
    stage.studio.session.set_program(name="OTHER")
    stage.studio.window.close()
    assert stage.studio.window.isVisible()
    question = stage.studio.desk.question
    assert question is not None
    assert list(question.buttons) == ["Do not save", "Save"] or set(question.buttons) == {"Save", "Do not save"}


def test_the_arrangement_is_remembered(stage: Stage) -> None:
    stage.studio.window.docks["Terminal"].hide()
    stage.studio.desk.leave()
    kept = stage.studio.settings.get("window")
    stage.studio.desk.arrange("Program")
    assert stage.studio.window.restore(kept)
    assert not stage.studio.window.docks["Terminal"].isVisible()


STRANGE = "UNIT 7 V3"  # a version text that names no type


def test_a_controller_that_does_not_name_itself_is_asked_about_once(stage: Stage) -> None:
    stage.connect("machine", "ssc3", revision=STRANGE)
    assert stage.controller.model is None
    stage.go()
    question = stage.studio.desk.question
    assert question is not None
    assert "SSC3" in question.buttons
    QTest.mouseClick(question.buttons["SSC3"], Qt.MouseButton.LeftButton)
    stage.until(lambda: stage.controller.last().value("position.z") == 0)
    assert set(stage.studio.display.axes) == {"X", "Y", "Z"}
    serial = stage.rig.simulation.unit.profile.serial_number
    assert known_models(stage.studio.settings) == {serial: "ssc3"}


def test_a_type_told_once_is_known_the_next_time(stage: Stage) -> None:
    serial = Rig().simulation.unit.profile.serial_number
    stage.connect("machine", "ssc3", revision=STRANGE, known_models={serial: "ssc3"})
    stage.go()
    assert stage.studio.desk.question is None
    assert stage.controller.axes == "XYZ"


def test_whoever_does_not_know_the_type_is_left_in_peace(stage: Stage) -> None:
    stage.connect("machine", revision=STRANGE)
    stage.go()
    assert stage.studio.desk.question is not None
    stage.studio.desk.question = None
    stage.go()
    assert stage.studio.desk.question is None


def test_the_search_asks_who_is_there_before_anything_else(monkeypatch: pytest.MonkeyPatch) -> None:
    order: list[str] = []

    def probe(address: str, line: LineSettings, **_: object) -> Found | str:
        order.append("probe")
        return "Nobody there." if address == "COM9" else Found(address, "SSC", None)

    monkeypatch.setattr(find, "probe", probe)
    monkeypatch.setattr(connection, "open_transport", lambda address, line: order.append(f"open {address}"))
    port = connection.Probed("COM1", LineSettings())
    port.open()
    port.open()
    assert order == ["probe", "open COM1", "open COM1"]
    with pytest.raises(OpenFailed, match="Nobody there"):
        connection.Probed("COM9", LineSettings()).open()
