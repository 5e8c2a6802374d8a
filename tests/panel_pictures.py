"""Scenes of single panels, for pictures."""

from __future__ import annotations

import dataclasses as dc
import time
from collections.abc import Callable, Iterator

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QScrollArea, QWidget

from codegen.rates import setting_words
from codegen.setup import Unit
from device.api import Kind
from tests.stage import Stage
from widgets.scope.body import Body


def event_scenes(stage: Stage) -> Iterator[tuple[str, QWidget]]:
    """A limit, an error of a program and a STOP; the first is selected."""
    stage.studio.desk.bring("Events")
    rig = stage.rig
    rig.type("SH", "JG 20000;BG X")
    stage.go(60)
    rig.simulation.stimulus("fls_x", 0)
    stage.go(60)
    rig.simulation.stimulus("fls_x", 1)
    rig.start("#A\nMO\nWT 500\nBG X\nEN")
    stage.go(90)
    stage.controller.stop()
    stage.go(30)
    stage.studio.at_machine.event_list.table.selectRow(1)
    stage.go()
    yield "panel-events", stage.studio.window


def display_scenes(stage: Stage) -> Iterator[tuple[str, QWidget]]:
    """An axis at its limit, a refused start, a latch that has tripped; then the rest of the panel, a name edited."""
    rig, display = stage.connect("simulator"), stage.studio.display
    rig.controller.take_control()
    rig.type("AL X", "JG 5000", "BG X")
    stage.go(10)
    for name, value in (("in1", 0.0), ("an2", 2.5), ("fls_x", 0.0)):
        rig.simulation.stimulus(name, value)
    stage.go(30)
    rig.result(rig.controller.ask("BG X"))
    stage.studio.desk.bring("Display")
    stage.go(90)
    yield "panel-display-codes", stage.studio.window
    display.outputs.edit(2)
    bar = display.findChild(QScrollArea).verticalScrollBar()
    bar.setValue(bar.maximum())
    stage.go(60)
    yield "panel-display-voltages", stage.studio.window


def replay_scenes(stage: Stage) -> Iterator[tuple[str, QWidget]]:
    """What the recorder keeps; then the same played, standing still in the middle of a move."""
    studio = stage.studio
    studio.desk.bring("Recorder")
    studio.recorder.flush()
    stage.go(70)
    yield "panel-recorder", studio.window
    studio.at_machine.recorded.replay_own()
    _in_real_time(stage, lambda: stage.controller.kind is Kind.REPLAY)
    tape, recorded = studio.at_machine.tape, studio.at_machine.recorded
    move = next(each for each in tape.rows if "STOP" in each.text)
    recorded.seek(move.place - 0.3)
    tape.play.click()
    _in_real_time(stage, lambda: stage.controller.last().has("position.x"))
    stage.go(5)
    yield "panel-replay", studio.window
    studio.connection.go_offline()


def _in_real_time(stage: Stage, true: Callable[[], object]) -> None:
    """A replay has a thread of its own."""
    for _ in range(2000):
        if true():
            return
        time.sleep(0.005)
        stage.go(1)
    raise AssertionError("the replay did not come")


def doctor_scenes(stage: Stage) -> Iterator[tuple[str, QWidget]]:
    """Before, meanwhile, and the two sorts of answer."""
    desk = stage.studio.doctor
    desk.show()
    window = desk.window
    assert window is not None
    stage.go()
    yield "doctor", window
    window.show_busy("Asking at 19200 baud", 0.4)
    stage.go()
    yield "doctor-busy", window
    there = setting_words(19200, None)
    sentence = f"The controller at /dev/ttyUSB0 answers at 19200 baud ({there}), not at 9600."
    window.show_diagnosis(sentence, ("Choose 19200 baud here.", "Or set the controller to 9600 baud."), 19200, False)
    stage.go()
    yield "doctor-speed", window
    steps = ("Is the controller switched on? Its power light must be lit.", "Use a straight-through cable.")
    window.show_diagnosis("Nothing answers at /dev/ttyUSB0, at no speed.", steps, None, False)
    stage.go()
    yield "doctor-silence", window
    window.close()


def commissioning_scenes(stage: Stage) -> Iterator[tuple[str, QWidget]]:
    """A feeder's axis with its motor leads exchanged, step by step up to the wrong polarity, and the report."""
    import dataclasses as dc

    from codegen.setup import Unit
    from device.api import Kind
    from device.simulator.plant import Drive
    from tests.widgets.commissioning.person import Person

    document = stage.studio.session.document
    axis = dc.replace(document.setup.axes[0], unit=Unit.MM, counts_per_unit="1000")
    setup = dc.replace(document.setup, name="Feeder", axes=(axis,) * 4)
    stage.studio.session.set_document(dc.replace(document, setup=setup), "A feeder")
    person = Person(stage, "ssc2", Kind.MACHINE, motor_reversed=True)
    person.safety()
    yield "commissioning-safety", person.window
    person.next()
    person.encoder(20_000)
    yield "commissioning-scale", person.window
    person.press("take_scale")
    person.next()
    person.press("begin_switches")
    stage.until(lambda: person.desk.switches is not None and bool(person.desk.switches.rest))
    person.trip("fls_x")
    yield "commissioning-switches", person.window
    person.trip("rls_x")
    person.trip("home_x")
    person.next()
    person.press("guards")
    person.next()
    person.press("polarity")
    yield "commissioning-polarity", person.window
    person.desk.show_report()
    assert person.desk.preview is not None
    stage.go()
    yield "commissioning-report", person.desk.preview
    person.desk.preview.close()
    person.window.close()
    before = stage.studio.session.document
    stepper = Person(stage, "ssc2", Kind.MACHINE, done=3, drive=Drive.STEPPER)
    stepper.press("stepper")
    stepper.next()
    stepper.press("pulses")
    yield "commissioning-stepper", stepper.window
    stepper.window.close()
    stage.studio.session.set_document(before, "A feeder")
    sine = Person(stage, "dmc1412", hall_inputs=5, hall_offset=30.0)
    sine.window.sine.setChecked(True)
    sine.desk.choose(4)
    stage.go()
    yield "commissioning-sine", sine.window
    sine.window.close()


def scope_scenes(stage: Stage) -> Iterator[tuple[str, QWidget]]:
    """A move that was waited for, with cursors; its spectrum; two axes over each other; live."""
    from device.capture import Channel
    from device.curves import Derived

    document = stage.studio.session.document
    axis = dc.replace(document.setup.axes[0], unit=Unit.MM, counts_per_unit="500", reverse_limit="", forward_limit="")
    setup = dc.replace(document.setup, model="ssc2", axes=(axis,) * 4)
    stage.studio.session.set_document(dc.replace(document, setup=setup), "A table")
    rig = stage.connect("simulator", "ssc2")
    rig.type("SH", "SP 40000", "AC 512000", "DC 512000")
    stage.studio.actions["scope"].trigger()
    dock = stage.studio.window.docks["Scope"]
    dock.resize(1180, 720)
    stage.go()
    body = stage.studio.at_machine.curves.body
    assert body is not None
    yield "scope-empty", dock
    wanted = (Channel("position", "X"), Channel("commanded", "X"), Channel("torque", "X"), Channel("position", "Y"))
    for slot, channel in zip(body.choices.slots, wanted, strict=True):
        slot.what.setCurrentIndex(slot.what.findText(channel.label))
    body.choices.derived[Derived.VELOCITY].setChecked(True)
    body.choices.begin.setCurrentIndex(1)
    stage.go()
    for distance in ("2500,1500", "4000,2500"):
        body.bar.capture.click()
        stage.until(lambda: body.bar.words.text().startswith("Waiting"), 30)
        stage.go(30)
        rig.controller.ask(f"PR {distance};BG")
        stage.until(lambda: "left" in body.bar.words.text() and body.shown is not None, 30)
        stage.until(lambda: stage.studio.at_machine.scope.job is None, 100)
        rig.type("DP 0,0")
        stage.go(3)
    body.kept.list.item(1).setCheckState(Qt.CheckState.Checked)
    body.bar.cursors.setChecked(True)
    stage.go(5)
    yield "scope-capture", dock
    body.side.setCurrentIndex(1)
    stage.go()
    yield "scope-captures", dock
    body.side.setCurrentIndex(0)
    for view, name in (("Spectrum", "spectrum"), ("X-Y", "x-y")):
        body.bar.views.setCurrentText(view)
        body.bar.upward.setCurrentText("Position Y")
        stage.go(3)
        yield f"scope-{name}", dock
    body.bar.views.setCurrentText("Over time")
    body.bar.live.click()
    stage.go(30)
    rig.controller.ask("PR -4000,-2500;BG")
    stage.go(120)
    yield "scope-live", dock
    body.bar.cursors.click()
    stage.go(3)
    yield "scope-live-held", dock
    body.bar.cursors.click()
    body.bar.views.setCurrentText("X-Y")
    stage.go(3)
    yield "scope-live-x-y", dock
    body.bar.views.setCurrentText("Over time")
    yield from _tracks(stage, body, dock)
    dock.resize(430, 560)
    stage.go(3)
    yield "scope-narrow", dock
    dock.resize(1180, 720)
    body.bar.live.click()
    dock.setFloating(False)
    stage.go()
    dock.bring()
    stage.go(3)
    yield "scope-docked", stage.studio.window
    dock.hide()


def _tracks(stage: Stage, body: Body, dock: QWidget) -> Iterator[tuple[str, QWidget]]:
    """Inputs, outputs and switches live, a lane for each."""
    for slot, words in zip(body.choices.slots, ("Position X", "Inputs", "Outputs", "Switches X"), strict=True):
        slot.what.setCurrentIndex(slot.what.findText(words))
    for number in (3, 4, 6, 3):
        for level in (0, 1):
            stage.rig.simulation.stimulus(f"in{number}", level)
            stage.go(8)
    yield "scope-tracks", dock
    for slot, words in zip(
        body.choices.slots, ("Position X", "Commanded position X", "Motor command X", "Position Y"), strict=True
    ):
        slot.what.setCurrentIndex(slot.what.findText(words))
    stage.go(3)


def teach_scenes(stage: Stage) -> Iterator[tuple[str, QWidget]]:
    """A glue path that is being played back, the window of Output, a way that was recorded whole."""
    import dataclasses as dc

    from codegen.setup import Unit
    from codegen.teach import Row, Table
    from widgets.parts.question import Question
    from widgets.teach.entries import OutputEntry

    studio, document = stage.studio, stage.studio.session.document
    axis = dc.replace(document.setup.axes[0], unit=Unit.MM, counts_per_unit="1000", reverse_limit="-50")
    axis = dc.replace(axis, forward_limit="200")
    names = ("Glue", "Lamp", *("",) * 6)
    setup = dc.replace(document.setup, model="ssc2", axes=(axis,) * 4, output_names=names)
    studio.session.set_document(dc.replace(document, setup=setup), "A glue table")
    rig = stage.connect("simulator", "ssc2")
    for number in (1, 2):
        rig.simulation.stimulus(f"an{number}", 2.5)
    studio.desk.bring("Teach")
    stage.go(10)
    teach, panel = studio.at_machine.teach, studio.at_machine.table
    pace = {"speed": "40", "acceleration": "512", "deceleration": "512"}
    corners = (("10", "5"), ("40.25", "5"), ("40.25", "25"), ("25", "31.875"), ("10", "25"), ("10", "5"))
    rows = [Row(x=x, y=y, **pace) for x, y in corners]
    rows[1:1] = [Row(output="1")]
    rows[5:5] = [Row(wait="-3")]
    teach.change(Table(("mm", "mm"), (*rows, Row(output="0x00"))))
    assert panel.parts is not None
    panel.parts.io_control.click()
    panel.parts.play.click()
    stage.go(10)
    asked = studio.window.findChildren(Question)[-1]
    yield "teach-play", asked
    asked.buttons["Play back"].click()
    rig.simulation.stimulus("in3", 1)
    stage.until(lambda: "waits" in panel.words(), 60)
    stage.go(5)
    panel.parts.fold.click()
    stage.go(2)
    yield "panel-teach", studio.window
    panel.parts.fold.click()
    panel.parts.halt.click()
    stage.go(30)
    panel.parts.output.click()
    entry = next(each for each in panel.findChildren(OutputEntry) if each.isVisible())
    stage.go(2)
    yield "teach-output", entry
    entry.close()
    arcs = (Row(x="40", y="20", sweep="120", through="on", **pace), Row(x="20", y="20", pause="500", **pace))
    teach.change(Table(("mm", "mm"), (Row(x="30", y="10", **pace), *arcs)))
    stage.go(5)
    panel.parts.view.go_to(1, 8)
    yield "panel-teach-way", panel
