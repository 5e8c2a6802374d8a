"""The window answers while the controller is worked with: connecting, downloading, reading back, losing the line."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from app.compose import Studio
from app.connection import connector
from app.help_pages import Pages
from app.loading import load
from app.settings import Settings
from codegen.instructions import Output, SingleAxisMove, Wait
from codegen.setup import Axis, Setup, Unit
from device.api import Badge, LineSettings, State, StopState
from device.recorder import Recorder
from device.simulator.process import SimulatorProcess
from tests.app.hands import until
from tests.app.pauses import LIMIT_MS, Heart, Ticks, too_long
from tests.long import count, is_long, record
from tests.slower import FULL_SPEED_MS, beside
from tests.stage import Stage
from widgets.teach.panel import SCREEN
from widgets.tuner.panel import MANUAL, MODEL

STEPS = 60
COMMAND = "pytest tests/app/test_speed.py"
CHANNELS = ("Position X", "Position Y", "Position error X", "Motor command X")


def long_program(session: object) -> None:
    """Some hundred lines."""
    for number in range(STEPS):
        kinds = (SingleAxisMove(distance="1", speed="5"), Output(output=str(number % 8 + 1)), Wait(time="20"))
        session.insert([kinds[number % 3]])  # type: ignore[attr-defined]


def working(stage: Stage) -> dict[str, float]:
    """Everything that goes over the line, the longest tick of each; the machine runs in virtual time."""
    ticks, studio = Ticks(stage), stage.studio
    rig = stage.connect("machine", studio.model(), answers=False)
    ticks.phase("longest tick while connecting", true=lambda: stage.controller.state is State.READY)
    stage.controller.take_control()
    ticks.phase("longest tick while downloading", studio.run.download, lambda: not studio.run.doing)
    assert stage.controller.program_badge is Badge.SAME
    rig.simulation.stimulus("in1", 0)
    ticks.phase("longest tick while running", studio.run.execute, then=90)
    ticks.phase("longest tick while uploading", studio.run.upload, lambda: not studio.run.doing)
    ticks.phase("longest tick while losing the line", rig.cut, lambda: stage.controller.state is State.LOST)
    rig.loopback.unplugged = False
    ticks.phase("longest tick while coming back", true=lambda: stage.controller.state is State.READY)
    return ticks.worst


@pytest.mark.alone
def test_no_tick_takes_long_whatever_the_controller_does(stage: Stage) -> None:
    """Time of the window's own thread on the processor, tick by tick."""
    long_program(stage.studio.session)
    for _ in range(3):  # fonts, icons and layouts are loaded once
        stage.go()
    assert too_long(COMMAND, lambda: working(stage), bare=is_long()) == {}


def captured(stage: Stage, ticks: Ticks) -> None:
    """Four channels, the trigger at once; then the same values in each view, and live."""
    studio = stage.studio
    studio.actions["scope"].trigger()
    stage.go(3)
    scope, body = studio.at_machine.scope, studio.at_machine.curves.body
    assert body is not None
    for slot, label in zip(body.choices.slots, CHANNELS, strict=True):
        slot.what.setCurrentIndex(slot.what.findText(label))
    body.choices.count.setValue(count(60, 500))
    stage.go(3)
    for turn in ("first", "next"):
        ticks.phase(f"longest tick of the {turn} capture", body.bar.capture.click, lambda: scope.job is None, then=5)
        assert body.shown is not None and body.shown.complete
    ticks.phase("longest tick while live values roll", body.bar.live.click, then=count(30, 900))
    assert scope.roll is not None
    body.bar.live.click()


def tuned(stage: Stage, ticks: Ticks) -> None:
    """A step, measured; in the long run an axis is identified too."""
    studio = stage.studio
    studio.actions["tune"].trigger()
    panel = studio.at_machine.tuning.panel
    stage.until(lambda: panel.step_plot is not None)
    panel.buttons[MANUAL].click()
    panel.box.seconds.setCurrentIndex(0)

    def begin(name: str) -> None:
        """The tick stays while what would happen stays the same: a second click would take it away."""
        stage.until(lambda: panel.box.words.text().startswith("X moves by"))
        if not panel.box.free.isChecked():
            panel.box.free.click()
        stage.go(2)
        assert panel.box.begin.isEnabled(), panel.box.begin.toolTip()
        ticks.phase(name, panel.box.begin.click, lambda: not panel.running, then=5)

    begin("longest tick of a tuner's step")
    assert panel.results.metrics.text().startswith("Rise")
    if is_long():
        panel.buttons[MODEL].click()
        stage.go(3)
        model = studio.at_machine.tuning.tuner.model
        before = model.proposal
        begin("longest tick while identifying")
        assert model.estimate is not None, panel.model.estimate.text()
        end = time.monotonic() + 60  # the mathematics takes real time
        while model.proposal is before:
            assert time.monotonic() < end
            ticks.phase("longest tick while identifying", then=1)
            time.sleep(0.001)


def taught(stage: Stage, ticks: Ticks) -> None:
    """The stick drives and the whole way is recorded; then it becomes rows."""
    studio = stage.studio
    studio.actions["teach"].trigger()
    stage.go(3)
    panel = studio.at_machine.table
    parts = panel.parts
    assert parts is not None
    parts.source.setCurrentIndex(parts.source.findData(SCREEN))
    parts.enable.setFocus()
    parts.enable.click()
    stage.go(10)
    assert panel.enabled, panel.words()
    parts.way.click()
    parts.stick.setFocus()
    QTest.keyPress(parts.stick, Qt.Key.Key_Right)
    ticks.phase("longest tick while a way is recorded", then=count(45, 900))
    QTest.keyRelease(parts.stick, Qt.Key.Key_Right)
    stage.go(15)
    ticks.phase("longest tick while a way becomes rows", parts.way.click, then=3)
    parts.enable.click()
    assert len(studio.at_machine.teach.table)


@pytest.mark.alone
def test_no_tick_takes_long_while_something_is_recorded(stage: Stage) -> None:
    """Captures, live values, tuning, teaching."""
    load()
    axis = Axis(unit=Unit.MM, counts_per_unit="1000", reverse_limit="-500", forward_limit="500")
    setup = Setup(model="ssc2").with_axis("X", axis).with_axis("Y", axis)
    stage.studio.session.set_setup(setup)
    stage.connect("simulator", "ssc2")
    stage.controller.take_control()
    stage.rig.type("SH")

    def recording() -> dict[str, float]:
        ticks = Ticks(stage)
        for part in (captured, tuned, taught):
            part(stage, ticks)
            stage.go(5)
        return ticks.worst

    assert too_long(COMMAND, recording, bare=is_long()) == {}


@pytest.fixture
def studio(tmp_path: Path, qapp: QApplication) -> Iterator[Studio]:
    """A studio with its own threads, timer, recorder and simulator process."""
    settings, recorder = Settings(tmp_path / "settings.json"), Recorder(tmp_path / "recordings")
    connect = connector(tmp_path / "programs", lambda: 600.0, recorder=recorder)
    studio = Studio(qapp, settings, tmp_path, connect, list, Pages(), recorder=recorder)
    studio.window.show()
    studio.tick.start()
    yield studio
    studio.close()
    studio.session.close()
    studio.window.hide()
    studio.window.deleteLater()


@pytest.mark.alone
def test_the_window_answers_while_the_link_works(studio: Studio) -> None:
    """True time, true threads: pauses longer than the limit are counted; one in a phase may be the system's."""
    heart, found = Heart(), {}
    studio.session.set_setup(Setup(model="ssc1").with_axis("X", Axis(unit=Unit.MM, counts_per_unit="1000")))
    long_program(studio.session)
    until(lambda: studio.window.isVisible(), "the window")
    studio.window.resize(1280, 800)
    for _ in range(20):
        QApplication.processEvents()

    def phase(name: str, begin: Callable[[], object], true: Callable[[], bool]) -> None:
        heart.start()
        begin()
        until(true, name)
        QTest.qWait(300)
        found[name] = heart.stop()

    def stopped() -> bool:
        return studio.connection.controller.stop_state is StopState.STOPPED

    before = beside()
    connect = partial(studio.connection.open_simulator, "ssc1", LineSettings(baud=19200))
    phase("connecting", connect, lambda: studio.connection.controller.state is State.READY)
    for turn in range(count(1, 5)):
        phase(f"downloading {turn}", studio.run.download, lambda: not studio.run.doing)
        assert studio.connection.controller.program_badge is Badge.SAME
        phase(f"uploading {turn}", studio.run.upload, lambda: not studio.run.doing)
        phase(f"stopping {turn}", studio.connection.stop, stopped)
    world = studio.connection.world
    assert world is not None
    with SimulatorProcess("ssc1", pty=os.name == "posix", baud=19200) as other:
        studio.doctor.show()
        assert studio.doctor.window is not None
        examined = partial(studio.doctor.examine, other.address)
        phase("examining a line", examined, lambda: studio.doctor.job is None)
        studio.doctor.window.close()
    ending = threading.Thread(target=world.close)  # type: ignore[attr-defined]
    phase("losing the line", ending.start, lambda: studio.connection.controller.state is State.LOST)
    ending.join()
    for name, pauses in found.items():
        record(f"longest pause of the window while {name}", "pytest tests/app/test_speed.py", None, pauses[0], "ms")
    print({name: [round(each, 1) for each in pauses[:4]] for name, pauses in found.items()})
    limit = LIMIT_MS * max(1.0, max(before, beside()) / FULL_SPEED_MS)
    assert {name: pauses[:3] for name, pauses in found.items() if pauses[1] > limit} == {}


@pytest.mark.alone
@pytest.mark.long
@pytest.mark.timeout(600)
def test_the_window_answers_from_the_start_on(studio: Studio) -> None:
    """True time: what is loaded beside the window, then each panel seen for the first time, a simulator connected."""
    heart, found = Heart(), {}
    studio.window.resize(1280, 800)
    until(lambda: studio.window.isVisible(), "the window")
    before = beside()

    def phase(name: str, begin: Callable[[], object], true: Callable[[], bool]) -> None:
        heart.start()
        begin()
        until(true, name)
        QTest.qWait(500)
        found[f"longest pause {name}"] = heart.stop()[:3]

    phase("after the start", lambda: None, lambda: studio.late.making.done)
    phase("while panels are loaded", lambda: studio.loading.begin(0), lambda: studio.loading.ready)
    connect = partial(studio.connection.open_simulator, "ssc2", LineSettings(baud=19200))
    phase("while connecting", connect, lambda: studio.connection.controller.state is State.READY)
    for title in studio.window.docks:
        phase(f"of the first look at {title}", partial(studio.late.bring, title), lambda: True)
    for name, pauses in found.items():
        record(name, COMMAND, None, pauses[0], "ms")
    print({name: [round(each, 1) for each in pauses] for name, pauses in found.items()})
    limit = LIMIT_MS * max(1.0, max(before, beside()) / FULL_SPEED_MS)
    too_long = {name: pauses for name, pauses in found.items() if pauses[0] > 2 * limit or pauses[1] > limit}
    assert not too_long  # one pause may have been lengthened by the system, but not for ever
