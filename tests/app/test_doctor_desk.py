"""The doctor's window, with mouse and keys, against a simulated controller behind a pseudo-terminal."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QTextBrowser

from app.help_pages import Pages
from app.search import Candidate
from device.doctor import Diagnosis, Trouble
from device.download import Job
from device.simulator.process import SimulatorProcess
from tests.device.test_latency import NO_PTY
from tests.slower import queued_s
from tests.stage import Stage
from widgets.connect.doctor import NO_PORT, DoctorWindow
from widgets.help.topic import topic_of

pytestmark = [NO_PTY, pytest.mark.paced]


@pytest.fixture(scope="module")
def machine() -> Iterator[SimulatorProcess]:
    with SimulatorProcess("ssc2", pty=True, baud=19200) as process:
        process.state()  # it has started
        yield process


def opened(stage: Stage, machine: SimulatorProcess) -> DoctorWindow:
    stage.ports[:] = [Candidate(machine.address, "Simulated", False)]
    stage.studio.actions["doctor"].trigger()
    stage.go()
    assert stage.studio.doctor.window is not None
    return stage.studio.doctor.window


def wait(stage: Stage, true: Callable[[], object], seconds: float = 8.0) -> None:
    """Real time passes, besides what other programs take."""
    end, queued = time.monotonic() + seconds, queued_s()
    while not true():
        assert time.monotonic() - (queued_s() - queued) < end
        stage.go(1)
        time.sleep(0.01)


def test_another_speed_with_its_switches_and_the_way_there(
    stage: Stage, machine: SimulatorProcess, monkeypatch: pytest.MonkeyPatch
) -> None:
    machine.stimulus("fault", "speed")
    monkeypatch.setattr("device.doctor.SPEEDS", (19200,))
    window = opened(stage, machine)
    QTest.mouseClick(window.examine, Qt.MouseButton.LeftButton)
    stage.go()
    assert window.busy.isVisible() and window.cancel.isVisible()
    wait(stage, lambda: not window.busy.isVisible())
    assert "answers at 19200 baud" in window.words()
    assert window.switches.isVisible()
    assert window.switches.words().endswith("1200 OFF, 9600 OFF, 19.2K ON, HSHK ON")
    wanted: list[tuple[str, int]] = []
    stage.studio.doctor.connect_wanted.connect(lambda port, baud: wanted.append((port, baud)))
    QTest.mouseClick(window.take, Qt.MouseButton.LeftButton)
    assert wanted == [(machine.address, 19200)]
    assert (stage.studio.settings.get("port"), stage.studio.settings.get("baud")) == (machine.address, 19200)
    machine.stimulus("fault", "none")


def test_an_examination_is_cancelled_by_the_keys(stage: Stage, machine: SimulatorProcess) -> None:
    machine.stimulus("fault", "silent")
    window = opened(stage, machine)
    QTest.keyClick(window.examine, Qt.Key.Key_Space)
    wait(stage, lambda: "Asking" in window.phase.text())
    window.cancel.setFocus()
    QTest.keyClick(window.cancel, Qt.Key.Key_Space)
    wait(stage, lambda: not window.busy.isVisible(), 1.5)
    assert "cancelled" in window.words()
    machine.stimulus("fault", "none")


def test_from_the_welcome_window_and_without_any_port(stage: Stage) -> None:
    stage.ports.clear()
    welcome = stage.studio.start.welcome_window()
    welcome.show_nothing("No controller answered.")
    stage.go()
    QTest.mouseClick(welcome.doctor, Qt.MouseButton.LeftButton)
    stage.go()
    window = stage.studio.doctor.window
    assert window is not None and window.isVisible()
    assert window.words() == NO_PORT
    assert not window.examine.isEnabled()


def test_every_control_of_it_has_a_name_and_f1_its_page(qapp: QApplication) -> None:
    window = DoctorWindow()
    window.show_ports([("/dev/ttyUSB0", "USB")], "")
    assert window.property("helpPage") == "Connecting"
    for each in (window.ports, window.busy):
        assert each.accessibleName()
    window.close()


def test_each_diagnosis_has_its_help(stage: Stage) -> None:
    """By a button, and by F1; its page is there."""
    desk = stage.studio.doctor
    desk.show()
    window = desk.window
    assert window is not None

    def told(trouble: Trouble) -> None:
        desk.job = Job()
        desk.job.future.set_result(Diagnosis(trouble, "A sentence."))
        stage.go()

    for trouble in Trouble:
        told(trouble)
        assert topic_of(window.examine) in Pages()
        assert window.more.isVisible() is (trouble is not Trouble.NONE)
    told(Trouble.SILENT)
    assert topic_of(window.examine) == "Troubleshooting"
    QTest.mouseClick(window.more, Qt.MouseButton.LeftButton)
    stage.go()
    assert stage.studio.desk.help is not None and stage.studio.desk.help.isVisible()
    assert "The controller does not answer" in stage.studio.desk.help.findChild(QTextBrowser).toPlainText()
