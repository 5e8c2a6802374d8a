"""Faults of a real line behind the whole studio: one clear sentence, grey panels, reading goes on, Control does not.

The machine is a simulator in a process of its own behind a pseudo-terminal; its port is a name that can be pulled out
and plugged into another process, as the system does with an adapter.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QAbstractButton, QApplication, QWidget

from app.compose import Studio
from app.connection import connector
from app.help_pages import Pages
from app.settings import Settings
from app.studio import begin
from device.api import Badge, Kind, State
from device.door import only_reads
from device.events import What
from device.link import NOISY, SILENT
from device.recorder import Recorder
from device.simulator.process import SimulatorProcess
from device.transport import LineSettings
from tests.app.hands import live, until
from tests.long import is_long
from widgets.panel import Panel

pytestmark = [pytest.mark.paced, pytest.mark.skipif(os.name != "posix", reason="pseudo-terminals")]
LEFT = Qt.MouseButton.LeftButton
RATES = (9600, 19200, 38400) if is_long() else (19200,)
PROGRAM = "#A\nN=0\n#B\nWT 200\nN=N+1\nJP #B\nEN"


class Bench:
    """A port, what is plugged into it, and a studio that is connected to it and in Control."""

    def __init__(self, folder: Path, application: QApplication, baud: int) -> None:
        self.folder, self.port, self.line = folder, folder / "ttyUSB0", LineSettings(baud=baud)
        self.machines: list[SimulatorProcess] = []
        self.walked: set[str] = set()  # panels whose buttons were all pressed while the line was lost
        self.machine = self.plug("ssc2")
        recorder = Recorder(folder / "recordings")
        connect = connector(folder / "programs", lambda: 600.0, recorder=recorder)
        self.studio = Studio(
            application, Settings(folder / "settings.json"), folder, connect, list, Pages(), recorder=recorder
        )
        self.studio.window.resize(1280, 900)
        self.studio.window.show()
        self.studio.tick.start()
        begin(self.studio, None, "offline")
        live(0.1)
        self.studio.connection.open(str(self.port), self.line)
        self.ready()
        controller = self.studio.connection.controller
        until(lambda: controller.last().has("position.x"), "the first reading")

    def plug(self, model: str, eeprom: str = "machine.json", **more: object) -> SimulatorProcess:
        """Another process behind the same name; what was there before is gone."""
        baud = more.get("baud", self.line.baud)
        assert isinstance(baud, int)
        made = SimulatorProcess(model, pty=True, baud=baud, eeprom=self.folder / eeprom)
        made.state()  # it serves
        new = self.folder / "new"
        new.symlink_to(made.address)
        new.replace(self.port)
        self.machines.append(made)
        return made

    def pull(self) -> None:
        """The adapter is out."""
        self.port.unlink(missing_ok=True)
        for machine in self.machines:
            machine.close()
        self.machines.clear()

    def ready(self) -> None:
        controller = self.studio.connection.controller
        until(lambda: controller.state is State.READY, "the controller to answer")

    def close(self) -> None:
        self.studio.close()
        self.studio.session.close()
        self.studio.window.hide()
        self.studio.window.deleteLater()
        self.pull()
        QApplication.processEvents()


@pytest.fixture(params=RATES)
def bench(request: pytest.FixtureRequest, tmp_path: Path, qapp: QApplication) -> Iterator[Bench]:
    made = Bench(tmp_path, qapp, request.param)
    yield made
    made.close()


def lost(bench: Bench, words: Callable[[str], bool]) -> None:
    """The state, the status bar, the events: one sentence; Watch; the panels grey."""
    studio, controller = bench.studio, bench.studio.connection.controller
    until(lambda: controller.state is State.LOST and words(controller.state_text), "the sentence of the loss")
    live(0.15)
    assert not controller.control and not studio.window.header.switch.control.isChecked()
    sentence = controller.state_text
    assert sentence.count("\n") == 0 and sentence.endswith((".", "?"))
    assert studio.window.status.link.text() == controller.state_text
    assert any(event.what is What.LOST for event in studio.at_machine.happened.events.all())
    assert "no link" in studio.window.header.stop.words[1]
    for name in ("download", "execute", "burn", "upload"):
        action = studio.actions.actions[name]
        assert not action.isEnabled() and "does not answer" in action.statusTip(), name
    heard = len(controller.traffic())
    grey(bench)
    sent = [each.text for each in controller.traffic()[heard:] if each.direction == ">" and each.source != "stop"]
    assert all(text == "\x12\x16" or only_reads(text.encode() + b"\r") for text in sent), sent


def whole(content: QWidget) -> None:
    """Panels come in pieces."""
    until(lambda: not isinstance(content, Panel) or content.making.done, "all of the panel")


SOME = ("Display", "Terminal", "Jog", "Variables", "X-Y view")  # in the everyday run
DIALOGS = ("…", "Connect", "Replay", "Open", "Save")


def grey(bench: Bench) -> None:
    """Each panel in front: its values are old, what would move is grey; whatever can be clicked changes nothing."""
    studio = bench.studio
    until(lambda: "stale" in studio.display.words(), "the display to get grey")
    assert bench.studio.connection.controller.state_text in studio.display.words()
    for title, dock in studio.window.docks.items():
        if title in bench.walked or not (is_long() or title in SOME):
            continue
        bench.walked.add(title)
        studio.desk.bring(title)
        whole(dock.content)
        live(0.02)
        for button in dock.content.findChildren(QAbstractButton):
            name = button.text() or button.accessibleName()
            if not button.isEnabled() or not button.isVisible() or any(each in name for each in DIALOGS):
                continue
            QTest.mouseClick(button, LEFT)
    jog = studio.at_machine.jog
    studio.desk.bring("Jog")
    QTest.mouseClick(jog.buttons[0], LEFT)  # all of its pages were looked at
    until(lambda: jog.one is not None and jog.pages.currentWidget() is jog.one, "the page of one axis")
    assert jog.one is not None and not jog.one.hold_forward.isEnabled() and jog.reason  # from the first moment
    studio.desk.bring("X-Y view")
    until(lambda: "old" in studio.at_machine.plane.words(), "the X-Y view to tell the age")
    studio.desk.bring("Variables")
    whole(studio.at_machine.values)
    live(0.1)
    assert not studio.at_machine.values.read.isEnabled()
    if studio.desk.question is not None:
        studio.desk.question.close()
    studio.desk.bring("Display")


def back(bench: Bench) -> None:
    """Reading goes on by itself, Control does not; panels show live values again."""
    studio, controller = bench.studio, bench.studio.connection.controller
    bench.ready()
    moment = controller.clock()
    until(lambda: controller.last().time("position.x") > moment, "fresh values")
    until(lambda: "stale" not in studio.display.words(), "the display to be fresh")
    live(0.1)
    assert not controller.control and controller.kind is Kind.MACHINE
    assert "connected" not in studio.window.status.link.text() and "reads/s" in studio.window.status.link.text()
    assert studio.actions.actions["take_control"].isEnabled() and not studio.actions.actions["download"].isEnabled()


def homed(bench: Bench) -> list[str]:
    return bench.studio.ear.homed_axes()


def test_a_cable_that_was_out_and_a_power_cycle(bench: Bench) -> None:
    studio, controller = bench.studio, bench.studio.connection.controller
    controller.take_control()
    job = controller.download(PROGRAM)
    until(lambda: job.future.done(), "the download")
    studio.display.homed_told.emit("X", True)
    until(lambda: homed(bench) == ["X"], "the homed mark")
    bench.machine.stimulus("fault", "silent")  # between cable and controller: the port is still there
    lost(bench, lambda words: words == SILENT)
    bench.machine.stimulus("fault", "none")
    back(bench)
    assert not homed(bench)  # where the axes are by now nobody saw
    assert controller.listing is not None  # but it ran on
    studio.display.homed_told.emit("X", True)
    controller.take_control()
    bench.pull()
    lost(bench, lambda words: "There is no port" in words and str(bench.port) in words)
    bench.machine = bench.plug("ssc2")
    back(bench)
    until(lambda: not homed(bench), "the homed mark to go")
    assert controller.listing is None and controller.program_badge is Badge.UNKNOWN
    said = [event.text for event in studio.at_machine.happened.events.all() if event.what is What.RESET]
    assert said == ["The controller was restarted: homed marks and the program badge are no longer known."]


@pytest.mark.skipif(not is_long(), reason="only in the long run")
def test_something_else_on_the_line(bench: Bench) -> None:
    """A foreign device, an echo, garbage at another speed, another controller."""
    studio, controller = bench.studio, bench.studio.connection.controller
    for fault in ("foreign", "echo"):
        controller.take_control()
        bench.machine.stimulus("fault", fault)
        lost(bench, lambda words: words == NOISY)
        bench.machine.stimulus("fault", "none")
        back(bench)
    assert bench.line.baud is not None
    controller.take_control()
    other = next(rate for rate in (9600, 38400) if rate != bench.line.baud)
    garbage = bench.plug("ssc2", "elsewhere.json", baud=other)
    garbage.stimulus("fault", "speed")
    bench.machines[0].close()
    lost(bench, lambda words: "check speed" in words or words == NOISY)
    bench.pull()
    bench.machine = bench.plug("dmc1412", "other.json")
    back(bench)
    assert controller.axes == "X"
    said = [event.text for event in studio.at_machine.happened.events.all() if event.what is What.RESET]
    assert said[-1].startswith("The controller is another one than before")
