"""The operator terminal at port 2 of a simulated controller: the manual's example by its keys."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from app.search import Candidate
from device.api import Kind
from device.second_port import LINE, SecondPort
from device.simulator.process import SimulatorProcess
from device.transport import open_transport
from tests.app.hands import PATIENCE_S, live
from tests.stage import Stage, make_studio
from widgets.operator.panel import NOWHERE, SIMULATED, WATCHED

# dmc-1412-1414.txt l.5350-5370, with the CI of these controllers (l.5374 says that its syntax there is another's)
EXAMPLE = "\n".join([
    "CC 9600,0,0,1;CI ,2",
    'MG{P2}{^27},"E"{N}', 'MG{P2} "press F1 to start X"', 'MG{P2} "Press F2 to start Y"',
    "#B;JP #B;EN",
    "#COMINT",
    "JS #XMOVE,P2CH=F1", "JS #YMOVE,P2CH=F2",
    "EN 1,1",
    "#XMOVE;PR 1000;BGX;EN", "#YMOVE;PR ,1000;BGY;EN",
])  # fmt: skip


@pytest.fixture
def stage(qapp: QApplication, tmp_path: Path) -> Stage:
    made = make_studio(tmp_path)
    made.studio.window.show()
    made.go()
    made.studio.desk.bring("Operator terminal")
    made.go()
    yield made
    made.clear_away()


def wait(stage: Stage, true: Callable[[], object]) -> None:
    """For a thread: true time passes, and some on the stage."""
    end = time.monotonic() + PATIENCE_S
    while not true():
        assert time.monotonic() < end, "waited in vain"
        stage.go(1)
        time.sleep(0.005)


def plug(stage: Stage) -> None:
    """The panel's own button; lines are listed, and one is opened, beside the window's thread."""
    wait(stage, stage.studio.at_machine.keys.connect_button.isEnabled)
    QTest.mouseClick(stage.studio.at_machine.keys.connect_button, Qt.MouseButton.LeftButton)
    wait(stage, lambda: stage.studio.at_machine.keys._open)


def position(stage: Stage, axis: str) -> float:
    return stage.rig.simulation.state()["axes"][axis]["commanded"]


def test_function_keys_start_the_axes_of_the_manuals_example(stage: Stage) -> None:
    rig, keys = stage.connect("simulator", "ssc2"), stage.studio.at_machine.keys
    plug(stage)
    rig.start(EXAMPLE)
    stage.until(lambda: "Y" in keys.words())
    # twenty characters in a row: what is longer goes on in the next one
    assert keys.words().split("\n") == ["press F1 to start X", "Press F2 to start Y"]
    QTest.mouseClick(keys.pads["Hand-held"].caps["F1"], Qt.MouseButton.LeftButton)
    stage.until(lambda: position(stage, "X") == 1000)
    assert position(stage, "Y") == 0
    keys.screen.setFocus()
    QTest.keyClick(keys.screen, Qt.Key.Key_F2, Qt.KeyboardModifier.ShiftModifier)
    stage.until(lambda: position(stage, "Y") == 1000)
    assert position(stage, "X") == 1000


def test_an_answer_is_typed_on_either_keypad_and_on_the_keyboard(stage: Stage) -> None:
    rig, keys = stage.connect("simulator", "ssc1"), stage.studio.at_machine.keys
    plug(stage)
    rig.start('CC 9600,0,0,1\nIN{P2} "Enter Value",NUM\nMG{P2} NUM{F5.1}\nEN')  # l.5341
    stage.until(lambda: "Enter Value" in keys.words())
    keys.form.setCurrentText("Panel")
    for name in ("4", "2", "."):
        QTest.mouseClick(keys.pads["Panel"].caps[name], Qt.MouseButton.LeftButton)
    keys.screen.setFocus()
    QTest.keyClick(keys.screen, Qt.Key.Key_5)
    QTest.keyClick(keys.screen, Qt.Key.Key_Return)
    stage.until(lambda: "42.5" in keys.words().split("\n")[-1])
    assert rig.simulation.state()["variables"]["NUM"] == 42.5


def test_shift_and_ctrl_hold_for_one_key(stage: Stage) -> None:
    rig, keys = stage.connect("simulator", "ssc1"), stage.studio.at_machine.keys
    plug(stage)
    rig.start("CC 9600,0,0,1;CI ,2\n#L;JP #L\nEN\n#COMINT\nC=P2CH;N=N+1;EN 1,1")
    sent: list[bytes] = []
    keys.keys.connect(sent.append)
    caps = keys.pads["Hand-held"].caps
    for name in ("SHIFT", "1", "1", "CTRL", "1", "SHIFT", "CTRL", "F1"):  # l.5204-5251: G, 1, code 2, configuration
        QTest.mouseClick(caps[name], Qt.MouseButton.LeftButton)
    assert b"".join(sent) == b"G1\x02"
    assert "CTRL-SHIFT-F1" in keys.note.text()


def test_the_function_keys_of_the_keyboard_are_the_terminals_alone(stage: Stage) -> None:
    """Shift+F5 halts the program everywhere else in the window."""
    rig, keys = stage.connect("simulator", "ssc1"), stage.studio.at_machine.keys
    plug(stage)
    rig.start("N=0;CC 9600,0,0,1;CI ,2\n#L;JP #L\nEN\n#COMINT\nC=P2CH;N=N+1;EN 1,1")
    stage.until(lambda: rig.running)
    sent: list[bytes] = []
    keys.keys.connect(sent.append)
    keys.screen.setFocus()
    for key in (Qt.Key.Key_F1, Qt.Key.Key_F2, Qt.Key.Key_F3, Qt.Key.Key_F4, Qt.Key.Key_F5):
        QTest.keyClick(keys.screen, key, Qt.KeyboardModifier.ShiftModifier)
    stage.go(30)
    assert b"".join(sent) == bytes(range(22, 27))  # l.5204
    assert rig.running and not rig.stops and not rig.sent("HX|ST")


def test_the_bells_can_be_told_apart(stage: Stage, monkeypatch: pytest.MonkeyPatch) -> None:
    rig, keys = stage.connect("simulator", "ssc1"), stage.studio.at_machine.keys
    plug(stage)
    beeps: list[None] = []
    monkeypatch.setattr(QApplication, "beep", lambda: beeps.append(None))
    for letter, name in (("T", "short bell"), ("L", "long bell"), ("O", "alert")):  # l.5260: ESC T, L, O
        rig.type(f'MG{{P2}}{{^27}},"{letter}"{{N}}')
        stage.until(lambda name=name: keys.heard.text() == f"♪ {name}")
    assert not beeps  # they are seen; heard only where that is wanted
    QTest.mouseClick(keys.sounds, Qt.MouseButton.LeftButton, pos=QPoint(8, keys.sounds.height() // 2))
    rig.type('MG{P2}{^27},"L"{N}')
    wait(stage, lambda: len(beeps) == 2)
    live(0.4)
    assert len(beeps) == 2


def test_without_control_or_controller_no_key_is_sent(stage: Stage) -> None:
    keys, sent = stage.studio.at_machine.keys, []
    keys.keys.connect(sent.append)
    stage.go()
    assert keys.reason == NOWHERE and not keys.connect_button.isEnabled()
    stage.connect("simulator", "ssc1")
    plug(stage)
    stage.controller.release_control()
    stage.go()
    assert keys.reason == WATCHED
    QTest.mouseClick(keys.pads["Hand-held"].caps["F1"], Qt.MouseButton.LeftButton)
    keys.screen.setFocus()
    QTest.keyClick(keys.screen, Qt.Key.Key_1)
    assert not sent
    stage.studio.connection.go_offline()  # the line to port 2 ends with the connection
    stage.go()
    assert stage.studio.at_machine.operator.port is None and stage.controller.kind is Kind.OFFLINE


def test_a_machine_offers_other_devices_than_its_own(stage: Stage) -> None:
    stage.connect("machine", "ssc1")
    line = stage.studio.at_machine.keys.line

    def offered() -> list[str]:
        return [line.itemText(index) for index in range(line.count())]

    wait(stage, lambda: "/dev/ttyUSB0" in offered())
    assert offered() == ["/dev/ttyUSB0"] and SIMULATED not in offered()


def test_a_port_that_does_not_open_is_a_sentence() -> None:
    port = SecondPort(partial(open_transport, "/dev/no-such-port", LINE))
    end = time.monotonic() + PATIENCE_S
    while not port.failed:
        assert time.monotonic() < end
        port.pump()
    assert port.text == "There is no port /dev/no-such-port; plug in the adapter or choose another port."
    assert not port.send(b"1")


def test_a_second_port_over_a_real_line() -> None:
    with SimulatorProcess("ssc1", port2="127.0.0.1:0") as process:
        first, second = (SecondPort(partial(open_transport, at, LINE)) for at in (process.address, process.address2))
        end, heard, asked = time.monotonic() + PATIENCE_S, b"", False
        while b"HELLO" not in heard:
            assert time.monotonic() < end
            first.pump()
            heard += second.pump()
            if first.open and second.open and not asked:
                asked = first.send(b'MG{P2} "HELLO"\r')
            time.sleep(0.01)
        first.close()
        second.close()
        assert not second.open and second.pump() == b""


def test_devices_are_listed_when_it_is_shown_and_never_with_the_simulator(stage: Stage) -> None:
    asked: list[str] = []
    operator = stage.studio.at_machine.operator
    listed = operator._ports
    wait(stage, lambda: operator._listing is None)  # as it was shown without any controller

    def ports() -> Sequence[Candidate]:
        asked.append(threading.current_thread().name)
        return [*listed(), Candidate("/dev/ttyUSB7", "second", False)]

    operator._ports = ports
    stage.connect("simulator")
    stage.studio.desk.bring("Operator terminal")
    stage.until(lambda: stage.studio.at_machine.keys.line.count())
    stage.go(150)
    assert not asked and stage.studio.at_machine.keys.line.itemText(0) == SIMULATED
    stage.connect("machine")
    wait(stage, lambda: stage.studio.at_machine.keys.line.findText("/dev/ttyUSB7") >= 0)
    stage.go(150)
    assert asked == ["ports"] and stage.studio.at_machine.keys.line.findText(SIMULATED) < 0  # once, beside the window
    stage.studio.window.docks["Operator terminal"].hide()
    stage.go(5)
    stage.studio.desk.bring("Operator terminal")
    wait(stage, lambda: len(asked) == 2)
    stage.go(150)
    assert len(asked) == 2
