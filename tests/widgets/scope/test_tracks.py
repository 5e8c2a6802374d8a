"""Inputs, outputs and switches are tracks: the bits that were chosen, named by the setup, read in words."""

from __future__ import annotations

import dataclasses as dc
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from codegen.models import MODELS
from device.capture import Capture, Channel
from device.capture_file import load, save
from tests.stage import Stage
from tests.widgets.scope.hands import choose, scope
from widgets.scope.bit_menu import BitMenu
from widgets.scope.body import Body
from widgets.scope.views import LEVELS

INPUTS, SWITCHES = Channel("inputs"), Channel("switches", "X")
NAMES = ("", "", "Clamp", *("",) * 5)


def given(body: Body) -> Capture:
    """1 s: input 3 goes off at 0.25 s and on at 0.75 s, input 6 on at 0.5 s; the forward limit is active from 0.5 s."""
    assert body._setup is not None
    setup = dc.replace(body._setup, input_names=NAMES)
    body.show_machine(MODELS["ssc2"], setup)
    count, dt = 512, 2 / 1024
    t = np.arange(count) * dt
    inputs = 0b0000_0001 + np.where((t >= 0.25) & (t < 0.75), 0, 0b100) + np.where(t >= 0.5, 0b10_0000, 0)
    switches = np.where(t >= 0.5, 0b0111, 0b1111)
    values = np.stack([t * 500, inputs, switches]).astype(float)
    channels = (Channel("position", "X"), INPUTS, SWITCHES)
    capture = Capture(channels, values, 1, 1000.0, model="ssc2", when="2026-11-23 08:00:00", setup=setup)
    body.add(capture)
    return capture


def shown(body: Body) -> tuple[str, ...]:
    return body.chart.strips[LEVELS].lanes.labels


def choose_bits(body: Body, slot: int, *labels: str) -> None:
    """By keys, in the menu behind Bits: it stays open while bits are ticked."""
    body.choices.slots[slot].tracks.click()
    menu = next(each for each in body.findChildren(BitMenu) if each.isVisible())
    for label in labels:
        for _ in range(12):
            QTest.keyClick(menu, Qt.Key.Key_Down)
            if menu.activeAction().text() == label:
                break
        QTest.keyClick(menu, Qt.Key.Key_Space)
        assert menu.isVisible()
    QTest.keyClick(menu, Qt.Key.Key_Escape)


def test_tracks_are_drawn_chosen_and_read(qapp: QApplication, body: Body, tmp_path: Path) -> None:
    capture = given(body)
    assert list(body.chart.strips) == ["Position", LEVELS]
    assert shown(body) == ("Input 3 Clamp", "Input 6", "Forward limit X")
    for slot, channel in zip(body.choices.slots, ("Position X", "Inputs", "Switches X"), strict=False):
        choose(slot.what, channel)
    assert [slot.tracks.isVisible() for slot in body.choices.slots] == [False, True, True, False]
    choose_bits(body, 1, "Input 1", "Input 3 Clamp")
    assert shown(body) == ("Input 1", "Input 3 Clamp", "Forward limit X") and body.choices.slots[1].bits == (0, 2)
    body.chart.show_cursors((0.3, 0.8))
    read = body.timings.reading
    assert (read("At A", "Input 3 Clamp"), read("At B", "Input 3 Clamp")) == ("off", "on")
    assert (read("At A", "Forward limit X"), read("At B", "Forward limit X")) == ("free", "at limit")
    assert read("On for", "Input 3 Clamp").startswith("50 ms (10 %)") and read("Edges", "Input 3 Clamp") == "1 ↑ 0 ↓"
    assert read("On for", "Input 1") == "500 ms (100 %)" and read("Edges", "Input 1") == "none"
    assert body.readings.reading("At A", "Position X") and "Inputs" not in body.readings.words()
    body.choices.slots[1].choose_bits(())
    assert list(body.chart.strips) == ["Position", "Inputs", LEVELS] and shown(body) == ("Forward limit X",)
    kept = body.state()
    body.choices.slots[1].choose_bits((7,))
    body.restore(kept)
    assert body.choices.slots[1].bits == () and body.choices.slots[2].bits is None
    body.choices.slots[1].choose_bits(None)
    save(tmp_path / "a.csv", capture)
    body.add(load(tmp_path / "a.csv"), "a.csv")
    assert shown(body) == ("Input 3 Clamp", "Input 6", "Forward limit X")
    x, y = body.chart.strips[LEVELS].items[0].getData()  # on top: lanes 2 to 3, off at 0.25 s, on at 0.75 s
    np.testing.assert_allclose(x[1:5], [0.25, 0.25, 0.75, 0.75], atol=1e-12)
    assert y[0] == y[1] == y[4] == y[5] > y[2] == y[3] > 2


def test_a_bit_over_a_position_says_where_it_changed(qapp: QApplication, body: Body) -> None:
    given(body)
    choose(body.bar.views, "X-Y")
    choose(body.bar.across, "Position X")
    choose(body.bar.upward, "Input 6")
    assert body.picture is not None
    (line,) = body.picture.lines
    on = line.x[line.y == 1]
    assert set(line.y) == {0.0, 1.0} and on.min() == pytest.approx(0.5, abs=1e-9)  # 500 counts a mm: 1 mm in 1 s


def test_strips_keep_a_height_that_can_be_read(qapp: QApplication, body: Body) -> None:
    """In a low dock they are reached by a bar at the side and never lie over each other."""
    channels = (*(Channel(what, "X") for what in ("position", "error", "torque")), INPUTS)
    values = np.tile(np.arange(4.0), (4, 1))
    body.add(Capture(channels, values, 1, 1000.0, model="ssc2", when="2026-11-23 08:00:00", setup=body._setup))
    body.resize(700, 150)
    for _ in range(3):
        qapp.processEvents()
    strips = list(body.chart.strips.values())
    assert all(strip.height() >= strip.minimumHeight() >= 60 for strip in strips)
    assert len(strips) == 4
    for upper, lower in pairwise(strips):
        assert upper.geometry().bottom() < lower.geometry().top()
    assert body.room.verticalScrollBar().maximum() > 0


def test_a_narrow_strip_names_all_of_its_curves(qapp: QApplication, body: Body) -> None:
    channels = tuple(Channel(what, axis) for axis in "XY" for what in ("position", "commanded"))
    values = np.tile(np.linspace(0, 100, 50), (4, 1))
    body.add(Capture(channels, values, 1, 1000.0, model="ssc2", when="2026-11-23 08:00:00", setup=body._setup))
    for width in (1180, 420):
        body.resize(width, 500)
        for _ in range(3):
            qapp.processEvents()
        (strip,) = body.chart.strips.values()
        legend = strip.legend
        assert legend.geometry().right() <= strip.width() and legend.height() >= legend.heightForWidth(legend.width())
        top = strip.getViewBox().sceneBoundingRect().top()
        assert legend.geometry().bottom() <= top + 6  # above the curves


def test_live_bits_are_tracks(stage: Stage) -> None:
    document = stage.studio.session.document
    setup = dc.replace(document.setup, input_names=NAMES)
    stage.studio.session.set_document(dc.replace(document, setup=setup), "Names")
    body = scope(stage)
    choose(body.choices.slots[0].what, "Inputs")
    choose(body.choices.slots[1].what, "–")
    QTest.mouseClick(body.bar.live, Qt.MouseButton.LeftButton)
    stage.go(15)
    assert shown(body) == ("Input 3 Clamp",)
    stage.rig.simulation.stimulus("in5", 0)
    stage.go(15)
    assert shown(body) == ("Input 3 Clamp", "Input 5")
    body.chart.show_cursors((0.1, stage.studio.at_machine.scope.roll.end - 0.05))
    assert (body.timings.reading("At A", "Input 5"), body.timings.reading("At B", "Input 5")) == ("on", "off")
    QTest.mouseClick(body.bar.live, Qt.MouseButton.LeftButton)
    stage.until(lambda: body.shown is not None, 10)
    stage.go(3)
    assert shown(body) == ("Input 3 Clamp", "Input 5")  # kept, and drawn as any other capture
