"""The tuner for pictures: a step by hand, trials, a model with its prediction measured, the logbook and its report."""

from __future__ import annotations

import dataclasses as dc
import time
from collections.abc import Callable, Iterator

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QWidget

from codegen.setup_axis import Unit
from device.simulator.plant import Drive, Plant
from tests.device.tuning.test_dual import MACHINES
from tests.stage import Stage
from widgets.tuner.panel import AUTOMATIC, LOGBOOK, MANUAL, MODEL, TunerPanel

PATIENCE_S = 120  # of the processor, so that other work on the computer does not count


def tuner_scenes(stage: Stage) -> Iterator[tuple[str, QWidget]]:
    """On one axis in millimetres."""
    studio = stage.studio
    document = studio.session.document
    axis = dc.replace(document.setup.axes[0], unit=Unit.MM, counts_per_unit="500", reverse_limit="", forward_limit="")
    setup = dc.replace(document.setup, model="ssc2", axes=(axis,) * 4, serial_number="")
    studio.session.set_document(dc.replace(document, setup=setup), "A table")
    rig = stage.connect("simulator", "ssc2")
    rig.type("SH")
    studio.actions["layout_tune"].trigger()
    studio.actions["tune"].trigger()
    panel, part = studio.at_machine.tuning.panel, studio.at_machine.tuning
    _until(stage, lambda: panel.bode_plot is not None)
    for gains in (("6", "64"), ("12", "150")):
        for name, text in zip(("KP", "KD"), gains, strict=True):
            panel.manual.gains.fields[name].setText(text)
            panel.manual.gains.fields[name].textEdited.emit(text)
        _run(stage, panel)
    yield "tuner-manual", studio.window
    panel.open_page(AUTOMATIC)
    panel.box.drive.setCurrentIndex(1)
    _run(stage, panel)
    yield "tuner-automatic", studio.window
    panel.open_page(MODEL)
    _run(stage, panel)
    _until(stage, lambda: part.tuner.model.proposal is not None)
    _run(stage, panel, panel.model.run)
    yield "tuner-model", studio.window
    panel.open_page(LOGBOOK)
    page = panel.logbook
    page.runs.setCurrentRow(0)
    page.runs.item(2).setCheckState(Qt.CheckState.Checked)
    page.note.setText("Belt tightened")
    page.note.editingFinished.emit()
    stage.go()
    yield "tuner-logbook", studio.window
    page.report.click()
    stage.go()
    assert part.book.preview is not None
    yield "tuner-report", part.book.preview
    part.book.preview.close()
    panel.open_page(MODEL)
    _run(stage, panel, panel.model.compare)
    yield "tuner-moves", studio.window
    panel.results.error.setChecked(False)
    yield from _machines(stage, panel)
    panel.open_page(MANUAL)
    stage.connect("simulator", "ssc2").type("SH")
    studio.desk.arrange("Program")


def _machines(stage: Stage, panel: TunerPanel) -> Iterator[tuple[str, QWidget]]:
    """Axes of other kinds: one that hangs, a dual loop, one of those with weight on it, a drive in velocity mode."""
    window = stage.studio.window
    _connect(stage, Plant(gravity=0.5, coulomb_friction=0.004))
    panel.open_page(MANUAL)
    _run(stage, panel)
    yield "tuner-hanging", window
    panel.open_page(MODEL)
    _run(stage, panel)
    _until(stage, lambda: stage.studio.at_machine.tuning.tuner.model.proposal is not None)
    stage.go(30)
    yield "tuner-hanging-model", window
    _connect(stage, MACHINES["play, dry"], "DVX=1")
    panel.open_page(MODEL)
    _until(stage, lambda: "dual loop" in panel.box.words.text())
    yield "tuner-dual-model", window
    panel.open_page(AUTOMATIC)
    panel.box.drive.setCurrentIndex(1)
    _run(stage, panel)
    yield "tuner-dual", window
    _connect(stage, dc.replace(MACHINES["play, dry"], gravity=2.5), "DVX=1")
    panel.open_page(AUTOMATIC)
    _run(stage, panel)
    yield "tuner-dual-weight", window
    _connect(stage, Plant(drive=Drive.VELOCITY))
    panel.open_page(AUTOMATIC)
    panel.box.drive.setCurrentIndex(0)
    _run(stage, panel)
    _until(stage, lambda: "auto tune" in panel.result.text())
    yield "tuner-velocity", window


def _connect(stage: Stage, plant: Plant, *commands: str) -> None:
    stage.connect("simulator", "ssc2", plants={"X": plant}).type("SH", *commands)
    stage.go(20)


def _run(stage: Stage, panel: TunerPanel, button: QWidget | None = None) -> None:
    _until(stage, lambda: panel.box.words.text().startswith("X moves by"))
    if not panel.box.free.isChecked():
        panel.box.free.click()
    stage.go()
    (button or panel.box.begin).click()  # type: ignore[attr-defined]
    _until(stage, lambda: not panel.running)
    stage.go(30)


def _until(stage: Stage, true: Callable[[], object]) -> None:
    """Where a thread of its own works as well."""
    end = time.process_time() + PATIENCE_S
    while not true():
        assert time.process_time() < end
        stage.go(1)
        time.sleep(0.001)
