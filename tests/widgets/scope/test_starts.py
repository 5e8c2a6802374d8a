"""Captures that wait for an input or a level, by keys, on a controller with two channels; and what their times are."""

from __future__ import annotations

import numpy as np
import pytest

from device.capture import Channel
from device.curves import Derived
from tests.device.test_capture_kinds import SLOW
from tests.stage import Stage
from tests.widgets.scope.hands import SCALE, choose, click, enter, finished, scope
from widgets.scope.body import Body


def awaited(stage: Stage, body: Body, words: str) -> None:
    """Capture is pressed; it says what it waits for, and has recorded once round by then."""
    stage.go()
    click(body.bar.capture)
    stage.until(lambda: body.bar.words.text() == f"Waiting: {words}")
    assert body.bar.progress.isVisible() and body.bar.finish.isEnabled() and body.bar.cancel.isEnabled()
    stage.go(17)


def test_an_input_and_a_level_in_millimetres_begin_a_capture(stage: Stage) -> None:
    """TM 2000: a value each 4 samples is one in 4 · 2000/1 024 000 s = 7.8125 ms, and all speeds are half of what was
    sent (commands.md, TM)."""
    body = scope(stage, model="dmc1412")
    stage.rig.type("TM 2000", "SP 20000", "AC 256000", "DC 256000")
    choose(body.choices.slots[0].what, "Position X")
    choose(body.choices.slots[1].what, "Inputs")
    stage.until(lambda: body.choices.every.itemText(1) == "4 samples, 7.81 ms")
    choose(body.choices.every, body.choices.every.itemText(1))
    enter(body.choices.count, "66")
    assert body.choices.length.text() == f"{66 * 0.0078125:.3g} s"
    choose(body.choices.begin, "Edge of input")
    enter(body.choices.input, "3")
    choose(body.choices.edge, "goes off")
    enter(body.choices.before, "40")
    enter(body.choices.count, "63")
    assert body.choices.hint.text().startswith("To wait for a trigger the recording must last 0.5 s at least; this one")
    stage.go()
    assert not body.bar.capture.isEnabled()
    enter(body.choices.count, "66")
    assert "Found to the very value, because Inputs is recorded" in body.choices.hint.text()
    awaited(stage, body, "when input 3 goes off")
    stage.rig.simulation.stimulus("in3", 0)
    found = finished(stage)
    bits = found.of(Channel("inputs")).astype(int)
    assert found.interval_s == 4 * 2000 / 1_024_000 and found.early == 0
    assert bits[found.trigger - 1] & 4 and not bits[found.trigger] & 4
    assert (0.2 if SLOW else 0.4) * 66 <= found.trigger <= 0.75 * 66

    choose(body.choices.slots[1].what, "Commanded position X")
    choose(body.choices.begin, "Level")
    choose(body.choices.level_of, "Position X")
    choose(body.choices.edge, "rises above")
    enter(body.choices.level, "3.5")
    body.choices.derived[Derived.VELOCITY].click()
    body.choices.derived[Derived.FOLLOWING].click()
    awaited(stage, body, f"when Position X rises above {3.5 * SCALE:g}")
    stage.rig.controller.ask("PR 5000;BG X")
    found = finished(stage)
    place = found.of(Channel("position", "X"))
    assert place[found.trigger - 1] < 3.5 * SCALE <= place[found.trigger] and place[0] < 700
    assert body.picture is not None
    lines = {line.label: line for line in body.picture.lines}
    # SP 20000 is reached after 20000²/(2·256000) = 781 counts; at TM 2000 it is 10 000 counts/s, 20 mm/s
    speed = lines["Velocity X"]
    assert speed.unit == "mm/s" and speed.y[found.trigger] == pytest.approx(20, rel=0.05)
    off = lines["Following error X"]
    assert off.unit == "mm" and off.group == "Position error"
    np.testing.assert_allclose(off.y, (found.of(Channel("commanded", "X")) - place) / SCALE, atol=1e-12)
    assert body.chart.strips["Position"].getAxis("left").labelText == "Position, mm"
    assert float(lines["Position X"].x[found.trigger]) == 0.0
    assert np.diff(lines["Position X"].x) == pytest.approx(4 * 2000 / 1_024_000)
