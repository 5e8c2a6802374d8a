"""Two machines of the examples at work: the knife stays on the rounded rectangle, the press feeds as often as asked."""

from __future__ import annotations

import itertools
import math

from codegen import files
from codegen.generate import generate
from codegen.models import model
from device.simulator.simulation import Simulation
from resources import path

SAMPLE = 1000  # ticks at TM 1000
SECOND = 1024  # samples


def started(name: str) -> Simulation:
    """An example on the simulated controller, all inputs high."""
    document = files.load(path(f"examples/{name}.tlp"))
    simulation = Simulation(model(document.setup.model))
    listing = generate(document)
    assert listing.is_complete
    simulation.load_program(listing.text)
    for number in range(1, 9):
        simulation.stimulus(f"in{number}", 1)
    simulation.execute(0)
    return simulation


def off_the_rectangle(x: float, y: float) -> float:
    """Distance from a rounded rectangle of 100 x 60 mm, radius 10, whose lower left corner is (10, 10)."""
    across, along = abs(x - 60) - 40, abs(y - 40) - 20
    return math.hypot(max(across, 0), max(along, 0)) + min(max(across, along), 0) - 10


def test_the_knife_follows_the_rounded_rectangle() -> None:
    simulation = started("knife-table")
    down: list[tuple[float, float, float]] = []
    for _ in range(6 * SECOND // 8):
        simulation.advance(8 * SAMPLE)
        motion = simulation.unit.motion
        if simulation.state()["outputs"] & 1 and motion.path.moving:
            down.append((motion.reference(0) / 200, motion.reference(1) / 200, motion.reference(2) / 10))
    assert simulation.errors == []
    assert max(abs(off_the_rectangle(x, y)) for x, y, _ in down) < 0.05
    sides = {(round(x), round(y)) for x, y, _ in down}
    assert {(110, 40), (10, 40)} <= {(x, 40) for x, y in sides if abs(y - 40) < 2}  # both long ways round
    for (x, y, z), (x2, y2, z2) in itertools.pairwise(down):
        if math.hypot(x2 - x, y2 - y) > 0.5:  # the knife points along the way between two looks
            heading = math.degrees(math.atan2(y2 - y, x2 - x))
            assert abs(((z + z2) / 2 - heading + 180) % 360 - 180) < 1


def test_the_press_feeds_as_often_as_asked() -> None:
    simulation = started("press-feeder")
    simulation.advance(SECOND * SAMPLE // 2)
    simulation.stimulus("type", "3\\r")
    fed, cuts, before, on = 0.0, 0, 0, False
    for _ in range(4 * SECOND):
        simulation.advance(SAMPLE)
        place = simulation.unit.motion.reference(1)
        step = place - before
        fed += step if abs(step) < 1000 else 0  # renamed by a whole cycle, not moved
        before = place
        if bool(simulation.state()["outputs"] & 1) != on:
            on = not on
            cuts += on
    texts = [text for _, _, text in simulation.messages]
    assert simulation.errors == []
    assert any("DONE 0003" in text or "DONE  0003" in text for text in texts), texts
    assert cuts == 3
    assert abs(fed / 40 - 3 * 50) < 0.1  # three turns; it stops where the strip rests


def test_an_open_guard_stops_the_press_and_it_goes_on() -> None:
    simulation = started("press-feeder")
    simulation.advance(SECOND * SAMPLE // 2)
    simulation.stimulus("type", "4\\r")
    simulation.advance(SECOND * SAMPLE // 2)
    assert simulation.unit.motion.moving(0)
    simulation.stimulus("in2", 0)
    simulation.advance(SECOND * SAMPLE)
    assert not simulation.unit.motion.moving(0)
    simulation.stimulus("in2", 1)
    simulation.advance(SECOND * SAMPLE // 2)
    assert simulation.unit.motion.moving(0)
    simulation.advance(3 * SECOND * SAMPLE)
    assert any("0004" in text for _, _, text in simulation.messages) and simulation.errors == []
