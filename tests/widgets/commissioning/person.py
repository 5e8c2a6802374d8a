"""A person who brings an axis to life: hands on mouse, keys and the simulated machine."""

from __future__ import annotations

import dataclasses as dc
from typing import Any

from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QComboBox, QLineEdit

from app.commissioning import Commissioning
from codegen.setup_axis import MotorType
from device.api import Kind
from device.commissioning.record import Finding, Record, Verdict, keep
from device.commissioning.steps import steps_for
from device.simulator.kernel import layout
from device.simulator.plant import Drive
from tests.device.commissioning.machine import bearing
from tests.stage import Stage
from widgets.commissioning.window import CommissioningWindow

LEFT = Qt.MouseButton.LeftButton
SERIAL = 1  # of a simulated controller


class Person:
    """Hands on mouse, keys and machine; `furthest` is how far the motor itself turned in a step that moves."""

    def __init__(
        self, stage: Stage, model: str = "ssc2", kind: Kind = Kind.SIMULATOR, done: int = 0, **faults: Any
    ) -> None:
        """`done`: so many steps were passed at an earlier time; with `drive=Drive.STEPPER` the axis is a stepper."""
        self.stage = stage
        stepper = faults.get("drive") is Drive.STEPPER
        found = {step.key: Finding(Verdict.PASSED, "Passed.") for step in steps_for(stepper, False)[:done]}
        assert keep(Record("X", model, SERIAL, findings=found), stage.studio.data / "commissioning") == ""
        setup = dc.replace(stage.studio.session.document.setup, model=model)
        if stepper:
            setup = setup.with_axis("X", dc.replace(setup.axis("X"), motor=MotorType.STEPPER_LOW))
        document = dc.replace(stage.studio.session.document, setup=setup)
        stage.studio.session.set_document(document, "Machine")
        stage.connect(kind.value, model, plants={"X": bearing(**faults)})
        stage.controller.take_control()
        stage.studio.actions["commissioning"].trigger()
        stage.go(10)
        self.furthest = 0.0

    @property
    def desk(self) -> Commissioning:
        return self.stage.studio.commissioning

    @property
    def window(self) -> CommissioningWindow:
        assert self.desk.window is not None
        return self.desk.window

    @property
    def place(self) -> float:
        return float(self.stage.rig.simulation.motion._parts[0][layout.MOTOR_X])

    def press(self, name: str) -> None:
        button = self.window.page.acts[name]
        assert button.isEnabled(), button.toolTip()
        QTest.mouseClick(button, LEFT)
        self.settle()

    def settle(self) -> None:
        """Until nothing is under way; how far the motor turns meanwhile is watched."""
        start = self.place
        end = self.stage.clock.now + 30
        while True:
            self.stage.go(1)
            self.furthest = max(self.furthest, abs(self.place - start))
            assert self.stage.clock.now < end
            if not self.desk.busy:
                break
        self.stage.go(4)

    def type(self, name: str, text: str) -> None:
        field = self.window.page.fields[name]
        if isinstance(field, QComboBox):
            field.setCurrentIndex(field.findData(text))
            return
        assert isinstance(field, QLineEdit)
        field.setFocus()
        field.selectAll()
        QTest.keyClicks(field, text)

    def next(self) -> None:
        QTest.mouseClick(self.window.next, LEFT)
        self.stage.go(2)

    def finding(self, key: str) -> tuple[Verdict, str]:
        found = self.desk.record.of(key)
        return found.verdict, found.sentence

    def push(self, counts: int, times: int = 5) -> None:
        """The axis is moved by hand, in strokes, each as long as a reading takes."""
        for _ in range(times):
            seen = self.desk.turned
            self.stage.rig.simulation.stimulus("position_x", counts / times)
            for _ in range(20):
                self.stage.go(1)
                if self.desk.turned is not seen:
                    break

    def trip(self, signal: str) -> None:
        """A switch is tripped by hand and let go."""
        for level in (0, 1):
            before = self.desk.switches
            self.stage.rig.simulation.stimulus(signal, level)
            for _ in range(20):
                self.stage.go(1)
                if self.desk.switches is not before:
                    break

    # ---- the steps

    def safety(self) -> None:
        self.press("off")
        self.stage.until(lambda: self.window.page.acts["safety"].isEnabled())
        for tick in self.window.page.ticks.values():
            QTest.mouseClick(tick, LEFT, pos=QPoint(14, tick.height() // 2))
        self.press("safety")

    def off(self) -> None:
        self.stage.type("MO X")
        self.stage.until(lambda: self.window.page.acts["begin_encoder"].isEnabled())

    def encoder(self, counts: int = 5000, distance: str = "5") -> None:
        self.press("begin_encoder")
        self.stage.until(lambda: self.window.page.acts["encoder"].isEnabled())  # where it is has been read
        self.push(counts)
        self.type("distance", distance)
        self.press("encoder")

    def switches(self, *signals: str) -> None:
        self.press("begin_switches")
        self.stage.until(lambda: self.desk.switches is not None and bool(self.desk.switches.rest))
        for signal in signals or ("fls_x", "rls_x", "home_x"):
            self.trip(signal)

    def guards(self) -> None:
        self.press("guards")
